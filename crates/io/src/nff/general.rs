//! Numbers as the programs of the standard scenes print them.

use std::fmt;

/// Shown with six digits, like `%g` in C: no zeros at the end, and with an exponent where
/// that is shorter.
#[derive(Clone, Copy, Debug)]
pub(super) struct General(pub(super) f32);

impl fmt::Display for General {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let number = f64::from(self.0);
        if number == 0.0 || !number.is_finite() {
            return write!(f, "{}", self.0);
        }
        // Rounding may carry into the exponent, so it comes first.
        let rounded = format!("{number:.5e}");
        let (digits, exponent) = rounded.split_once('e').unwrap_or((&rounded, "0"));
        let exponent: i32 = exponent.parse().unwrap_or(0);
        let trim = |text: &str| {
            let whole = text.contains('.');
            let text = if whole { text.trim_end_matches('0').trim_end_matches('.') } else { text };
            text.to_owned()
        };
        if (-4..6).contains(&exponent) {
            let places = (5 - exponent) as usize;
            f.write_str(&trim(&format!("{number:.places$}")))
        } else {
            let sign = if exponent < 0 { '-' } else { '+' };
            write!(f, "{}e{sign}{:02}", trim(digits), exponent.abs())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_look_as_printed_by_c() {
        let cases = [
            (0.0, "0"),
            (1.0, "1"),
            (-0.5, "-0.5"),
            (0.166_666_67, "0.166667"),
            (100_000.0, "100000"),
            (1_000_000.0, "1e+06"),
            (999_999.5, "1e+06"),
            (123_456.0, "123456"),
            (0.000_1, "0.0001"),
            (0.000_012_34, "1.234e-05"),
            (0.006_172_84, "0.00617284"),
            (-1.5e20, "-1.5e+20"),
            (3.0827, "3.0827"),
        ];
        for (number, text) in cases {
            assert_eq!(General(number).to_string(), text);
        }
    }
}
