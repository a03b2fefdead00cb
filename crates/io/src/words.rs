//! The words of a text file, each with its place.

#[cfg(test)]
mod tests;

use std::borrow::Cow;

use crate::error::{LoadError, Spot};
use crate::load::Source;

/// Goes through a text word by word.
#[derive(Clone, Debug)]
pub(crate) struct Words<'a> {
    source: &'a Source,
    bytes: &'a [u8],
    at: usize,
    line: usize,
    line_start: usize,
    /// Begins what runs to the end of a line and is no word.
    comment: Option<u8>,
    /// Whether a backslash at the end of a line takes the next one to it.
    joined: bool,
}

/// A word and where it is.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Word<'a> {
    pub(crate) bytes: &'a [u8],
    pub(crate) line: usize,
    pub(crate) column: usize,
}

impl<'a> Words<'a> {
    /// All words of a text.
    pub(crate) fn new(bytes: &'a [u8], source: &'a Source) -> Self {
        // Some editors put this before any text.
        let at = if bytes.starts_with(b"\xef\xbb\xbf") { 3 } else { 0 };
        Self { source, bytes, at, line: 1, line_start: at, comment: None, joined: false }
    }

    /// The words from a place on that begins a line.
    pub(crate) fn starting(bytes: &'a [u8], source: &'a Source, at: usize, line: usize) -> Self {
        let at = at.min(bytes.len());
        Self { at, line, line_start: at, ..Self::new(bytes, source) }
    }

    /// The same without what follows a `#`.
    pub(crate) fn with_comments(self) -> Self {
        Self { comment: Some(b'#'), ..self }
    }

    /// The same with lines joined that end in a backslash.
    pub(crate) fn with_joined_lines(self) -> Self {
        Self { joined: true, ..self }
    }

    /// The next word on whatever line.
    #[inline]
    pub(crate) fn next(&mut self) -> Option<Word<'a>> {
        loop {
            if let Some(word) = self.on_line() {
                return Some(word);
            }
            if !self.end_line() {
                return None;
            }
        }
    }

    /// The next word of this line.
    #[inline]
    pub(crate) fn on_line(&mut self) -> Option<Word<'a>> {
        self.skip_blanks();
        let start = self.at;
        while let Some(&byte) = self.bytes.get(self.at) {
            if byte.is_ascii_whitespace() || Some(byte) == self.comment || self.joint() > 0 {
                break;
            }
            self.at += 1;
        }
        let bytes = &self.bytes[start..self.at];
        (!bytes.is_empty()).then_some(Word {
            bytes,
            line: self.line,
            column: start - self.line_start + 1,
        })
    }

    /// All that is left of this line as one text, without blanks at its ends or a comment set
    /// off by blanks.
    pub(crate) fn rest(&mut self) -> Cow<'a, str> {
        self.skip_blanks();
        let start = self.at;
        let mut end = start;
        while self.line_end() == 0 && self.at < self.bytes.len() {
            let byte = self.bytes[self.at];
            let blank = byte.is_ascii_whitespace();
            if Some(byte) == self.comment && (self.at == start || end < self.at) {
                break;
            }
            self.at += 1;
            if !blank {
                end = self.at;
            }
        }
        String::from_utf8_lossy(&self.bytes[start..end])
    }

    /// Goes to the start of the next line; false if there is none.
    pub(crate) fn end_line(&mut self) -> bool {
        while self.at < self.bytes.len() {
            let (joint, end) = (self.joint(), self.line_end());
            if joint > 0 {
                self.begin_line(joint);
            } else if end > 0 {
                self.begin_line(end);
                return true;
            } else {
                self.at += 1;
            }
        }
        false
    }

    /// The next word, which must be a number.
    #[inline]
    pub(crate) fn number(&mut self, what: &str) -> Result<f32, LoadError> {
        let word = self.expect(what)?;
        word.number().ok_or_else(|| self.unfit(&word, what))
    }

    /// The next word, which must be a whole number.
    #[inline]
    pub(crate) fn whole(&mut self, what: &str) -> Result<i64, LoadError> {
        let word = self.expect(what)?;
        word.whole().ok_or_else(|| self.unfit(&word, what))
    }

    /// Three numbers.
    pub(crate) fn triple(&mut self, what: &str) -> Result<[f32; 3], LoadError> {
        Ok([self.number(what)?, self.number(what)?, self.number(what)?])
    }

    /// The next word, which must be there.
    #[inline]
    pub(crate) fn expect(&mut self, what: &str) -> Result<Word<'a>, LoadError> {
        self.next()
            .ok_or_else(|| self.here().error(format!("the file ends where {what} should be")))
    }

    /// That a word is not what it should be.
    #[cold]
    pub(crate) fn unfit(&self, word: &Word<'_>, what: &str) -> LoadError {
        self.spot(word).error(format!("expected {what}, found {word}"))
    }

    /// Where a word is.
    pub(crate) fn spot(&self, word: &Word<'_>) -> Spot {
        Spot { line: word.line, column: word.column, ..self.source.spot() }
    }

    /// Where the next word is looked for.
    pub(crate) fn here(&self) -> Spot {
        let column = self.at - self.line_start + 1;
        Spot { line: self.line, column, ..self.source.spot() }
    }

    /// The line the next word is looked for on.
    pub(crate) fn line(&self) -> usize {
        self.line
    }

    /// How many bytes have been gone through.
    pub(crate) fn offset(&self) -> usize {
        self.at
    }

    /// How many bytes are left.
    pub(crate) fn left(&self) -> usize {
        self.bytes.len() - self.at
    }

    #[inline]
    fn skip_blanks(&mut self) {
        while let Some(&byte) = self.bytes.get(self.at) {
            let joint = self.joint();
            if joint > 0 {
                self.begin_line(joint);
            } else if byte.is_ascii_whitespace() && self.line_end() == 0 {
                self.at += 1;
            } else {
                return;
            }
        }
    }

    /// Length of the end of a line here, or 0.
    #[inline]
    fn line_end(&self) -> usize {
        match self.bytes.get(self.at) {
            Some(b'\n') => 1,
            Some(b'\r') if self.bytes.get(self.at + 1) == Some(&b'\n') => 2,
            Some(b'\r') => 1,
            _ => 0,
        }
    }

    /// Length of a backslash and the end of the line it hides here, or 0.
    #[inline]
    fn joint(&self) -> usize {
        if !self.joined || self.bytes[self.at] != b'\\' {
            return 0;
        }
        match self.bytes.get(self.at + 1..).unwrap_or_default() {
            [b'\r', b'\n', ..] => 3,
            [b'\n' | b'\r', ..] => 2,
            _ => 0,
        }
    }

    fn begin_line(&mut self, skipped: usize) {
        self.at += skipped;
        self.line += 1;
        self.line_start = self.at;
    }
}

impl Word<'_> {
    /// The number it is.
    #[inline]
    pub(crate) fn number(&self) -> Option<f32> {
        std::str::from_utf8(self.bytes).ok()?.parse().ok()
    }

    /// The whole number it is; `3.0` is one.
    #[inline]
    pub(crate) fn whole(&self) -> Option<i64> {
        let text = std::str::from_utf8(self.bytes).ok()?;
        text.parse().ok().or_else(|| {
            let number: f64 = text.parse().ok()?;
            (number.trunc() == number && number.abs() < 1e15).then_some(number as i64)
        })
    }
}

impl std::fmt::Display for Word<'_> {
    /// In quotes, not at any length, without control characters.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        /// Most bytes shown.
        const SHOWN: usize = 40;
        let text = String::from_utf8_lossy(&self.bytes[..self.bytes.len().min(SHOWN)]);
        let text: String = text
            .chars()
            .map(|c| if c.is_control() { char::REPLACEMENT_CHARACTER } else { c })
            .collect();
        let more = if self.bytes.len() > SHOWN { "…" } else { "" };
        write!(f, "`{text}{more}`")
    }
}
