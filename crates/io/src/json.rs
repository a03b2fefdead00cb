//! What JSON readers share: where in a file an error is.

use crate::error::{LoadError, Spot};

/// An error of the JSON parser, with its line and column.
pub(crate) fn located(error: &serde_json::Error, spot: Spot) -> LoadError {
    let text = error.to_string();
    let message = text.rsplit_once(" at line ").map_or(text.as_str(), |(message, _)| message);
    Spot { line: error.line(), column: error.column(), ..spot }.error(message)
}

/// The text without the mark some editors put before it.
pub(crate) fn without_mark(bytes: &[u8]) -> &[u8] {
    bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_error_has_its_line_and_column_once() {
        let error = serde_json::from_str::<Vec<u8>>("[1,\n  x]").expect_err("no number");
        let text = located(&error, Spot::file("a.json")).to_string();
        assert_eq!(text, "a.json:2:3: expected value");
    }
}
