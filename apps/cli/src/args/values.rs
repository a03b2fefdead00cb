//! Values on the command line.

/// Numbers between commas.
pub(crate) type Numbers<const N: usize> = [u32; N];

/// Columns and rows: x0, x1, y0, y1.
pub(crate) type Window = Numbers<4>;

/// Which frames.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Frames {
    /// The first.
    pub(crate) first: u32,
    /// None after this.
    pub(crate) last: u32,
    /// From one to the next.
    pub(crate) step: u32,
}

impl Frames {
    /// Their numbers.
    pub(crate) fn numbers(self) -> impl Iterator<Item = u32> {
        (self.first..=self.last).step_by(self.step as usize)
    }
}

pub(super) fn resolution(text: &str) -> Result<[u32; 2], String> {
    let (width, height) = text.split_once(['x', '×']).ok_or("two numbers with an x between")?;
    let number = |text: &str| text.parse().map_err(|_| format!("{text:?} is no number of pixels"));
    Ok([number(width)?, number(height)?])
}

pub(super) fn window(text: &str) -> Result<Window, String> {
    numbers(text)
}

pub(super) fn pixel(text: &str) -> Result<Numbers<2>, String> {
    numbers(text)
}

fn numbers<const N: usize>(text: &str) -> Result<Numbers<N>, String> {
    let parts: Result<Vec<u32>, _> = text.split(',').map(|part| part.trim().parse()).collect();
    let wrong = || format!("{N} whole numbers with commas between are expected");
    parts.ok().and_then(|parts| parts.try_into().ok()).ok_or_else(wrong)
}

pub(super) fn frames(text: &str) -> Result<Frames, String> {
    /// More than days of film.
    const MOST: u32 = 10_000_000;
    let wrong = || "expected is A, A-B or A-BxS, as in 0-47x2".to_owned();
    let number = |text: &str| text.parse::<u32>().map_err(|_| wrong());
    let (range, step) = match text.split_once('x') {
        Some((range, step)) => (range, number(step)?),
        None => (text, 1),
    };
    let (first, last) = match range.split_once('-') {
        Some((first, last)) => (number(first)?, number(last)?),
        None => (number(range)?, number(range)?),
    };
    if step == 0 {
        return Err("a step of 0 never ends".into());
    }
    if last < first || last > MOST {
        return Err(format!("frames must ascend, and end by {MOST}"));
    }
    Ok(Frames { first, last, step })
}

pub(super) fn threads(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(count) if count <= 1024 => Ok(count),
        _ => Err("0 to 1024 threads".into()),
    }
}

pub(super) fn batch(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(count) if (1..=65_536).contains(&count) => Ok(count),
        _ => Err("1 to 65536 rays".into()),
    }
}

pub(super) fn rays(text: &str) -> Result<usize, String> {
    match text.replace('_', "").parse() {
        Ok(count) if (1..=100_000_000).contains(&count) => Ok(count),
        _ => Err("1 to 100000000 rays".into()),
    }
}

pub(super) fn rounds(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(count) if (1..=1000).contains(&count) => Ok(count),
        _ => Err("1 to 1000 rounds".into()),
    }
}

pub(super) fn finite(text: &str) -> Result<f32, String> {
    match text.parse::<f32>() {
        Ok(number) if number.is_finite() => Ok(number),
        _ => Err("a number is expected".into()),
    }
}

pub(super) fn positive(text: &str) -> Result<f32, String> {
    finite(text).and_then(|x| if x > 0.0 { Ok(x) } else { Err("more than 0 is expected".into()) })
}

pub(super) fn limit(text: &str) -> Result<f32, String> {
    finite(text).and_then(|x| if x >= 0.0 { Ok(x) } else { Err("0 or more is expected".into()) })
}

pub(super) fn part(text: &str) -> Result<f32, String> {
    let within = |x| if (0.0..=1.0).contains(&x) { Ok(x) } else { Err("0 to 1".to_owned()) };
    finite(text).and_then(within)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_are_a_range_with_a_step() {
        let check = |text, expected: &[u32]| {
            assert_eq!(frames(text).map(|f| f.numbers().collect::<Vec<_>>()), Ok(expected.into()));
        };
        check("7", &[7]);
        check("0-3", &[0, 1, 2, 3]);
        check("1-6x2", &[1, 3, 5]);
        for wrong in ["", "a", "3-1", "1-2x0", "1-", "-1", "1-99999999999", "0-20000000"] {
            assert!(frames(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn sizes_and_windows_are_whole_numbers() {
        assert_eq!(resolution("640x480"), Ok([640, 480]));
        assert_eq!(window("0,10, 2,8"), Ok([0, 10, 2, 8]));
        assert!(resolution("640").is_err() && resolution("-1x2").is_err());
        assert!(window("1,2,3").is_err() && pixel("1,x").is_err());
    }
}
