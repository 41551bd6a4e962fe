//! Exports run as programs.

use std::path::Path;
use std::process::Command;

use super::Track;

/// What a program prints.
pub fn run(command: &mut Command) -> String {
    let output = command.output().unwrap();
    let error = String::from_utf8_lossy(&output.stderr);
    // 1 is the answer of a model that leaves the physical range; what was sailed is printed.
    assert!(matches!(output.status.code(), Some(0 | 1)), "{command:?}: {error}");
    String::from_utf8(output.stdout).unwrap()
}

/// The track of a file of C with its own example.
pub fn by_c(folder: &Path, code: &[u8], arguments: &[String]) -> Track {
    std::fs::write(folder.join("model.c"), code).unwrap();
    Track::read(&compiled(folder, "model.c", arguments))
}

/// What the program of a file of C in a folder prints.
pub fn compiled(folder: &Path, file: &str, arguments: &[String]) -> String {
    let program = folder.join("model");
    let options = ["-std=c99", "-Wall", "-Wextra", "-Werror", "-O0", "-DSISTERSHIP_EXAMPLE"];
    let compiled = Command::new("cc")
        .current_dir(folder)
        .args(options)
        .args([file, "-o", "model", "-lm"])
        .output()
        .unwrap();
    assert!(compiled.status.success(), "{}", String::from_utf8_lossy(&compiled.stderr));
    run(Command::new(program).args(arguments))
}
