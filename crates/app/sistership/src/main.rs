//! The one binary: see `sistership --help`. It is a package of its own, since the level at which it
//! is built is that of the link-time optimiser for all the others (docs/evidence/size.md).

use std::process::ExitCode;

fn main() -> ExitCode {
    sistership_cli::run()
}
