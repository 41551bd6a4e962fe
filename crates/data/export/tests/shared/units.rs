//! Functional mock-up units unpacked, and programs that load them as importers do.

use std::io::Read;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Compilers of a program of C, and how its programs are started.
#[derive(Debug, Clone, Copy)]
pub struct Machine {
    compiler: &'static str,
    libraries: &'static [&'static str],
    starter: &'static [&'static str],
    /// Folders and extension of the libraries of FMUs for it, by version of FMI.
    folders: [&'static str; 2],
    extension: &'static str,
    /// Before a path in a URI or in an argument.
    drive: &'static str,
}

/// This machine.
pub const LINUX: Machine = Machine {
    compiler: "cc",
    libraries: &["-ldl", "-lm"],
    starter: &[],
    folders: ["linux64", "x86_64-linux"],
    extension: "so",
    drive: "",
};

/// Windows, by MinGW-w64 and Wine.
pub const WINDOWS: Machine = Machine {
    compiler: "x86_64-w64-mingw32-gcc",
    libraries: &[],
    starter: &["/usr/lib/wine/wine64"],
    folders: ["win64", "x86_64-windows"],
    extension: "dll",
    drive: "Z:",
};

/// Linux on ARM, by a cross compiler and QEMU.
pub const ARM: Machine = Machine {
    compiler: "aarch64-linux-gnu-gcc",
    libraries: &["-ldl", "-lm"],
    starter: &["qemu-aarch64", "-L", "/usr/aarch64-linux-gnu"],
    folders: ["aarch64-linux", "aarch64-linux"],
    extension: "so",
    drive: "",
};

impl Machine {
    /// Whether its compiler and its starter are installed.
    pub fn is_here(&self) -> bool {
        let answers = |program: &&str| Command::new(program).arg("--version").output().is_ok();
        std::iter::once(&self.compiler).chain(self.starter.first()).all(answers)
    }

    /// Compiles a program of `tests/importer` into a folder.
    pub fn importer(&self, source: &str, folder: &Path, options: &[&str]) -> PathBuf {
        let crate_folder = Path::new(env!("CARGO_MANIFEST_DIR"));
        let program = folder.join(format!("{source}{}.exe", options.concat()));
        let compiled = Command::new(self.compiler)
            .args(["-std=gnu99", "-Wall", "-Wextra", "-Werror", "-O1", "-I"])
            .arg(crate_folder.join("runtime"))
            .args(options)
            .arg(crate_folder.join("tests/importer").join(format!("{source}.c")))
            .args([Path::new("-o"), &program])
            .args(self.libraries)
            .output()
            .unwrap();
        assert!(compiled.status.success(), "{}", String::from_utf8_lossy(&compiled.stderr));
        program
    }

    /// A command that runs an importer on an unpacked FMU: library and folder are its arguments.
    pub fn command(&self, program: &Path, version: &str, unit: &Path) -> Command {
        let mut words = self.starter.to_vec();
        words.push(program.to_str().unwrap());
        let mut command = Command::new(words[0]);
        let folder = unit.join("binaries").join(self.folders[usize::from(version == "fmi3")]);
        let library = files(&folder).into_iter().next().unwrap();
        assert_eq!(library.extension().unwrap(), self.extension);
        // A URI has a slash before the drive, FMI 3.0 has a plain path.
        let slash = if version == "fmi2" && !self.drive.is_empty() { "/" } else { "" };
        command.args(&words[1..]).env("WINEDEBUG", "-all");
        command.arg(format!("{}{}", self.drive, library.display()));
        command.arg(format!("{slash}{}{}", self.drive, unit.display()));
        command
    }
}

fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).unwrap();
    entries.map(|entry| entry.unwrap().path()).collect()
}

/// Unpacks an archive into a folder.
pub fn unpack(bytes: &[u8], folder: &Path) {
    let mut archive = zip::ZipArchive::new(std::io::Cursor::new(bytes)).unwrap();
    for index in 0..archive.len() {
        let mut file = archive.by_index(index).unwrap();
        let place = folder.join(file.enclosed_name().unwrap());
        std::fs::create_dir_all(place.parent().unwrap()).unwrap();
        let mut bytes = Vec::new();
        file.read_to_end(&mut bytes).unwrap();
        std::fs::write(place, bytes).unwrap();
    }
}

/// The value reference of a variable in the description of an unpacked FMU.
pub fn reference(unit: &Path, name: &str) -> String {
    let description = std::fs::read_to_string(unit.join("modelDescription.xml")).unwrap();
    let variable = description.lines().find(|line| line.contains(&format!("name=\"{name}\"")));
    let variable = variable.unwrap_or_else(|| panic!("no variable {name}"));
    let after = variable.split("valueReference=\"").nth(1).unwrap();
    after.split('"').next().unwrap().to_owned()
}
