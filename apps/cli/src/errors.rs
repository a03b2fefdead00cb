//! What went wrong, in one line, and the exit code.

use std::fmt;
use std::io;

use nestray::io::error::LoadError;
use nestray::io::write::WriteError;
use nestray::render::options::RenderError;

/// Why the program ends early.
#[derive(Debug)]
pub(crate) struct Failure {
    /// Exit code.
    pub(crate) code: u8,
    message: String,
    hint: Option<String>,
}

impl Failure {
    /// Something could not be done.
    pub(crate) const FAILED: u8 = 1;
    /// It was asked for in the wrong way.
    pub(crate) const USAGE: u8 = 2;
    /// A scene, plan or file of rays cannot be read.
    pub(crate) const UNREADABLE: u8 = 3;
    /// Answers that must be the same are not.
    pub(crate) const DIFFERENT: u8 = 4;
    /// It was interrupted.
    pub(crate) const INTERRUPTED: u8 = 130;

    pub(crate) fn new(code: u8, message: impl fmt::Display) -> Self {
        Self { code, message: message.to_string(), hint: None }
    }

    pub(crate) fn usage(message: impl fmt::Display) -> Self {
        Self::new(Self::USAGE, message)
    }

    /// The same with an advice.
    pub(crate) fn hint(mut self, hint: impl Into<String>) -> Self {
        self.hint = Some(hint.into());
        self
    }

    /// Says it on the error stream.
    pub(crate) fn report(&self) {
        eprintln!("nestray: {self}");
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // Names of files and what is in them may hold line ends.
        let line = |text: &str| text.split(['\n', '\r']).collect::<Vec<_>>().join(" ");
        write!(f, "{}", line(&self.message))?;
        self.hint.as_ref().map_or(Ok(()), |hint| write!(f, " (hint: {})", line(hint)))
    }
}

impl From<LoadError> for Failure {
    fn from(error: LoadError) -> Self {
        Self::new(Self::UNREADABLE, error)
    }
}

impl From<WriteError> for Failure {
    fn from(error: WriteError) -> Self {
        let code = match error {
            WriteError::Unknown { .. } => Self::USAGE,
            _ => Self::FAILED,
        };
        Self::new(code, error)
    }
}

impl From<RenderError> for Failure {
    fn from(error: RenderError) -> Self {
        let code = match error {
            RenderError::Scene(_) => Self::UNREADABLE,
            RenderError::Threads(_) => Self::FAILED,
            _ => Self::USAGE,
        };
        Self::new(code, error)
    }
}

/// A file that cannot be written; nobody listening any more is no error.
pub(crate) fn unless_closed(written: io::Result<()>, name: &str) -> Result<(), Failure> {
    match written {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            Err(Failure::new(Failure::FAILED, format!("{name}: cannot be written: {error}")))
        }
        _ => Ok(()),
    }
}
