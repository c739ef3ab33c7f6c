//! All integration tests in one binary, so that a small machine links once.

mod files;
