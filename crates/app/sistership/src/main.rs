//! Sistership's only binary: see `sistership --help`. It is a separate package, because its
//! optimisation level is that of the link-time optimiser for all others (docs/evidence/size.md).

use std::process::ExitCode;

fn main() -> ExitCode {
    sistership_cli::run()
}
