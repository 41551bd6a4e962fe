//! The one binary: see `sistership --help`.

use std::process::ExitCode;

fn main() -> ExitCode {
    sistership::run()
}
