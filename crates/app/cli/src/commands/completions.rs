//! `sistership completions`: completions of the command line for a shell.

use clap::{Args, Command};
use clap_complete::Shell;

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

/// Runs the command for a program.
///
/// # Errors
/// Returns an error if standard output cannot be written.
pub fn run(arguments: &CompletionsArguments, program: Command) -> Result<(), Failure> {
    let script = completion_script(arguments.shell, program);
    output::print_result(false, &(), || script)
}

fn completion_script(shell: Shell, mut program: Command) -> String {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut program, "sistership", &mut script);
    String::from_utf8_lossy(&script).into_owned()
}

#[cfg(test)]
mod tests {
    use clap::Arg;

    use super::*;

    #[test]
    fn every_shell_completes_commands_and_flags() {
        for shell in [Shell::Bash, Shell::Zsh, Shell::Fish, Shell::PowerShell, Shell::Elvish] {
            let refine = Command::new("refine").arg(Arg::new("held").long("held-out"));
            let script = completion_script(shell, Command::new("program").subcommand(refine));
            assert!(script.contains("refine") && script.contains("held-out"), "{shell}");
        }
    }
}
