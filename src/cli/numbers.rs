//! Numbers of the command line.

use clap::Command;

/// Lets every option take a negative number, so that its limits are told and not that there is no option
/// `-1`.
pub(super) fn negative_too(program: Command) -> Command {
    program.mut_subcommands(|command| {
        command.mut_args(|arg| {
            let takes_value = !arg.is_positional() && arg.get_action().takes_values();
            arg.allow_negative_numbers(takes_value)
        })
    })
}

/// Reads a whole number within limits.
///
/// # Errors
///
/// The limits, in words.
pub(super) fn whole<T: TryFrom<u64>, const MIN: u64, const MAX: u64>(
    text: &str,
) -> Result<T, String> {
    let number = text.trim().parse().ok().filter(|number| (MIN..=MAX).contains(number));
    let number = number.and_then(|number: u64| T::try_from(number).ok());
    number.ok_or_else(|| format!("it takes a whole number from {MIN} to {MAX}"))
}

/// Any seed.
pub(super) fn seed(text: &str) -> Result<u64, String> {
    whole::<u64, 0, { u64::MAX }>(text)
}

/// So many threads: those beyond any machine's take minutes to start and make nothing faster.
pub(super) fn threads(text: &str) -> Result<usize, String> {
    whole::<usize, 1, 1024>(text)
}
