//! Why a command stopped, and its exit code.

use std::io::ErrorKind;

use venation::{document, error, io};

use super::bench;

/// Why a command stopped.
#[derive(Debug)]
pub(crate) enum Failure {
    /// Something nobody foresaw.
    Unexpected(String),
    /// Bad arguments or input.
    Input(String),
    /// Files would be overwritten.
    Exists(String),
    /// Some items of a batch failed; each was reported when it did.
    Partial(String),
    /// Whoever read stdout has gone.
    BrokenPipe,
}

impl Failure {
    pub(crate) fn code(&self) -> u8 {
        match self {
            Self::Unexpected(_) => 1,
            Self::Input(_) => 2,
            Self::Exists(_) => 3,
            Self::Partial(_) => 4,
            Self::BrokenPipe => 0,
        }
    }

    pub(crate) fn message(&self) -> Option<&str> {
        match self {
            Self::Unexpected(m) | Self::Input(m) | Self::Exists(m) | Self::Partial(m) => Some(m),
            Self::BrokenPipe => None,
        }
    }
}

impl From<std::io::Error> for Failure {
    /// For writes to stdout only: files have their own error, which names them.
    fn from(error: std::io::Error) -> Self {
        match error.kind() {
            ErrorKind::BrokenPipe => Self::BrokenPipe,
            _ => Self::Unexpected(format!("stdout: {error}")),
        }
    }
}

impl From<io::Error> for Failure {
    /// Only where another path would do is it the arguments' fault: a full disk may have room tomorrow.
    fn from(error: io::Error) -> Self {
        match &error {
            io::Error::WouldOverwrite { .. } => {
                Self::Exists(format!("{error}; --force overwrites"))
            }
            io::Error::Write { source, .. } => match source.kind() {
                ErrorKind::NotADirectory
                | ErrorKind::IsADirectory
                | ErrorKind::PermissionDenied
                | ErrorKind::ReadOnlyFilesystem
                | ErrorKind::InvalidFilename
                | ErrorKind::InvalidInput => Self::Input(error.to_string()),
                _ => Self::Unexpected(error.to_string()),
            },
            _ => Self::Unexpected(error.to_string()),
        }
    }
}

impl From<error::Error> for Failure {
    fn from(error: error::Error) -> Self {
        Self::Input(error.to_string())
    }
}

impl From<io::batch::BatchError> for Failure {
    fn from(error: io::batch::BatchError) -> Self {
        Self::Input(error.to_string())
    }
}

impl From<bench::Error> for Failure {
    fn from(error: bench::Error) -> Self {
        Self::Input(error.to_string())
    }
}

impl From<document::DocumentError> for Failure {
    fn from(error: document::DocumentError) -> Self {
        Self::Input(error.to_string())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_other_arguments_mend_is_their_fault() {
        let code = |kind: ErrorKind| {
            Failure::from(io::Error::Write { path: "leaf.png".into(), source: kind.into() }).code()
        };
        for kind in [ErrorKind::NotADirectory, ErrorKind::IsADirectory, ErrorKind::PermissionDenied]
        {
            assert_eq!(code(kind), 2, "{kind}");
        }
        for kind in [ErrorKind::StorageFull, ErrorKind::TimedOut, ErrorKind::Other] {
            assert_eq!(code(kind), 1, "{kind}");
        }
        let taken = io::Error::WouldOverwrite { folder: "out".into(), files: vec!["a".into()] };
        assert_eq!(Failure::from(taken).code(), 3);
    }
}
