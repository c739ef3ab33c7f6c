//! The whole library and the program, from outside. One binary, so a small machine links once.

mod cli; // the command line as a person types it: messages, exit codes, files
mod layers; // who may use whom
mod presets; // every leaf that comes with venation
mod support;
