//! `sistership manual`: manual pages of the commands.

use std::path::{Path, PathBuf};

use clap::{Args, Command};
use clap_mangen::Man;

use crate::failure::{Failure, about_file};
use crate::output::print_note;

const EXAMPLES: &str = "\
Examples:
  sistership manual --out ~/.local/share/man/man1";

/// Write the manual pages of all commands.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct ManualArguments {
    /// Folder for the pages, `sistership.1` and one for each command; it is created if it is
    /// missing.
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
}

/// Runs the command for a program.
///
/// # Errors
/// Returns an error if the folder or a page cannot be written.
pub fn run(arguments: &ManualArguments, mut program: Command) -> Result<(), Failure> {
    let folder = &arguments.out;
    std::fs::create_dir_all(folder).map_err(|error| about_file(folder, error))?;
    program.build();
    let pages = write_pages(&program, "sistership", folder)?;
    print_note(&format!("{pages} pages written to {}", folder.display()));
    Ok(())
}

/// Writes the page of a command and those of its subcommands; returns their number.
fn write_pages(command: &Command, name: &str, folder: &Path) -> Result<usize, Failure> {
    let path = folder.join(format!("{name}.1"));
    let refused = |error| about_file(&path, error);
    let mut page = Vec::new();
    Man::new(command.clone()).title(name).render(&mut page).map_err(refused)?;
    std::fs::write(&path, page).map_err(refused)?;
    let mut pages = 1;
    for below in command.get_subcommands().filter(|below| !is_left_out(below)) {
        pages += write_pages(below, &format!("{name}-{}", below.get_name()), folder)?;
    }
    Ok(pages)
}

/// True for clap's own `help`, and for hidden commands.
fn is_left_out(command: &Command) -> bool {
    command.get_name() == "help" || command.is_hide_set()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use clap::Arg;

    use super::*;

    #[test]
    fn each_command_has_a_page() {
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().join("man1");
        let refine = Command::new("refine").arg(Arg::new("held").long("held-out"));
        let create = Command::new("create").about("a foundation");
        let family = Command::new("family").subcommand(create);
        let program = Command::new("sistership").subcommands([refine, family]);
        run(&ManualArguments { out: out.clone() }, program).unwrap();
        let page = |name: &str| std::fs::read_to_string(out.join(name)).unwrap();
        assert!(page("sistership.1").contains("refine"));
        assert!(page("sistership-refine.1").contains(r"\-\-held\-out"));
        assert!(page("sistership-family-create.1").contains("foundation"));
        assert!(!out.join("sistership-help.1").exists());
    }
}
