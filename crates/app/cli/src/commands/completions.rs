//! `sistership completions`: completions of the command line for a shell.

use clap::{Args, CommandFactory};
use clap_complete::Shell;

use crate::arguments::Arguments;
use crate::failure::Failure;
use crate::output;

const EXAMPLES: &str = "\
Examples:
  sistership completions bash > ~/.local/share/bash-completion/completions/sistership
  sistership completions zsh  > ~/.zfunc/_sistership
  sistership completions fish > ~/.config/fish/completions/sistership.fish";

/// Print completions of the command line for a shell.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct CompletionsArguments {
    /// The shell.
    shell: Shell,
}

/// Runs the command.
///
/// # Errors
/// Returns an error if standard output cannot be written.
pub fn run(arguments: &CompletionsArguments) -> Result<(), Failure> {
    let script = completion_script(arguments.shell);
    output::print_result(false, &(), || script)
}

fn completion_script(shell: Shell) -> String {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut Arguments::command(), "sistership", &mut script);
    String::from_utf8_lossy(&script).into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_shell_completes_commands_and_flags() {
        for shell in [Shell::Bash, Shell::Zsh, Shell::Fish, Shell::PowerShell, Shell::Elvish] {
            let script = completion_script(shell);
            assert!(script.contains("refine") && script.contains("held-out"), "{shell}");
        }
    }
}
