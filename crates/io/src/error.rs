//! What is wrong with a file, and where.

use std::fmt;
use std::path::PathBuf;

/// A place in a file.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Spot {
    /// The file.
    pub path: PathBuf,
    /// Line, from 1; 0 if the file has none or it does not matter.
    pub line: usize,
    /// Byte of the line, from 1; 0 if it does not matter.
    pub column: usize,
}

/// Why a file cannot be read.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{}: {}{}", self.spot, self.message, Hint(self.hint.as_ref()))]
pub struct LoadError {
    /// Where.
    pub spot: Spot,
    /// What is wrong, in one line.
    pub message: String,
    /// What to do about it.
    pub hint: Option<String>,
}

/// Something in a file that was passed over or put right.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Warning {
    /// Where.
    pub spot: Spot,
    /// What was found and what was done, in one line.
    pub message: String,
}

struct Hint<'a>(Option<&'a String>);

impl Spot {
    /// A whole file.
    #[must_use]
    pub fn file(path: impl Into<PathBuf>) -> Self {
        Self { path: path.into(), line: 0, column: 0 }
    }

    /// An error here.
    #[must_use]
    pub fn error(self, message: impl Into<String>) -> LoadError {
        LoadError { spot: self, message: message.into(), hint: None }
    }

    /// A warning here.
    #[must_use]
    pub fn warning(self, message: impl Into<String>) -> Warning {
        Warning { spot: self, message: message.into() }
    }
}

impl LoadError {
    /// The same with an advice.
    #[must_use]
    pub fn hint(mut self, hint: impl Into<String>) -> Self {
        self.hint = Some(hint.into());
        self
    }
}

impl fmt::Display for Spot {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.path.display())?;
        if self.line > 0 {
            write!(f, ":{}", self.line)?;
            if self.column > 0 {
                write!(f, ":{}", self.column)?;
            }
        }
        Ok(())
    }
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.spot, self.message)
    }
}

impl fmt::Display for Hint<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.map_or(Ok(()), |hint| write!(f, " (hint: {hint})"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_error_is_one_line_with_its_place() {
        let spot = Spot { line: 3, column: 7, ..Spot::file("a/b.nff") };
        let error = spot.error("no such thing").hint("try another");
        assert_eq!(error.to_string(), "a/b.nff:3:7: no such thing (hint: try another)");
        assert_eq!(Spot::file("b").warning("odd").to_string(), "b: odd");
    }
}
