//! The whole library and the program, from outside. One binary, so a small machine links once.

mod arguments; // mistakes in arguments, and what is said of them
mod batches; // many leaves: shards, killed runs, atlases, dry runs
mod cli; // the command line as a person types it: messages, exit codes, files
mod closed; // closed venation: loops that close, against the same reference
mod easel; // a leaf painted again and again
mod emergence; // straight, symmetric, ordered veins from growth alone
mod files; // what is written, read back by independent readers
mod fitting; // real leaves to parameters and silhouettes
mod golden; // expected pictures, which are also the README's
mod guides; // veins laid by architecture, in every preset
mod imports; // outlines from files, odd and broken ones too
mod inspect; // measures of leaves, and graphs for other programs
mod layers; // who may use whom
mod margins; // teeth and instances of every preset, from outside
mod material; // light, seasons, films and wounds
mod morph; // one leaf turning into another
mod presets; // every leaf that comes with venation
mod reference; // open and closed venation, slow and obvious
mod resuming; // `--skip-existing`: what a run goes on with, and what it refuses
mod rows; // the rows of `inspect`, in whole leaves
mod sample_leaf; // an artificial leaf with veins, for tests of what comes after growth
mod shell; // schema, completions, manual
mod support;
mod textures; // what painting promises
mod veins; // growth against an obvious reference, node by node
