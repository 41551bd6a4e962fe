//! Zoo of a run: the embedded one, with the given folders.

use std::path::{Path, PathBuf};

use sistership_model::Zoo;

use crate::failure::{Failure, about_file};

/// Environment variable with folders of further laws, effects and vessels, separated as in `PATH`.
const FOLDERS_VARIABLE: &str = "SISTERSHIP_ZOO";

/// Loads the embedded zoo with the folders of the environment and of the command line, in this
/// order.
///
/// # Errors
/// Returns an error that names the file that cannot be parsed.
pub fn load_zoo(folders: &[PathBuf]) -> Result<Zoo, Failure> {
    let mut zoo = Zoo::load_embedded()?;
    let named = std::env::var_os(FOLDERS_VARIABLE).unwrap_or_default();
    let named = std::env::split_paths(&named).filter(|folder| !folder.as_os_str().is_empty());
    for folder in named.chain(folders.iter().cloned()) {
        add_folder(&mut zoo, &folder)?;
    }
    Ok(zoo)
}

fn add_folder(zoo: &mut Zoo, folder: &Path) -> Result<(), Failure> {
    let of = |kind: &str| yaml_files(&folder.join(kind));
    let (laws, effects, vessels) = (of("laws")?, of("effects")?, of("vessels")?);
    if laws.is_empty() && effects.is_empty() && vessels.is_empty() {
        return Err(about_file(
            folder,
            "is not a zoo folder: it has neither laws/*.yaml nor effects/*.yaml nor vessels/*.yaml",
        ));
    }
    // Laws first: models of vessels refer to them.
    for path in laws {
        zoo.add_law(&path.display().to_string(), &read_text_file(&path)?)?;
    }
    for path in effects {
        zoo.add_effect(&path.display().to_string(), &read_text_file(&path)?)?;
    }
    for path in vessels {
        zoo.add_vessel(&path.display().to_string(), &read_text_file(&path)?)?;
    }
    Ok(())
}

/// Lists the YAML files of a folder, sorted by name; empty if there is no such folder.
fn yaml_files(folder: &Path) -> Result<Vec<PathBuf>, Failure> {
    if !folder.is_dir() {
        return Ok(Vec::new());
    }
    let entries = std::fs::read_dir(folder).and_then(Iterator::collect::<Result<Vec<_>, _>>);
    let entries =
        entries.map_err(|error| about_file(folder, format!("cannot be read: {error}")))?;
    let mut files: Vec<PathBuf> =
        entries.into_iter().map(|entry| entry.path()).filter(|path| is_yaml(path)).collect();
    files.sort();
    Ok(files)
}

fn is_yaml(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension == "yaml" || extension == "yml")
}

/// Reads the text of a file.
///
/// # Errors
/// Returns an error if it cannot be read or is no UTF-8 text.
pub fn read_text_file(path: &Path) -> Result<String, Failure> {
    std::fs::read_to_string(path)
        .map_err(|error| about_file(path, format!("cannot be read: {error}")))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn a_folder_extends_the_zoo_and_faults_name_its_file() {
        let folder = tempfile::tempdir().unwrap();
        let mut zoo = Zoo::load_embedded().unwrap();
        assert!(
            add_folder(&mut zoo, folder.path())
                .unwrap_err()
                .message()
                .unwrap()
                .contains("is not a zoo folder")
        );
        std::fs::create_dir(folder.path().join("vessels")).unwrap();
        let vessel =
            zoo.vessel_text("mariner").unwrap().replace("name: mariner", "name: mariner-two");
        std::fs::write(folder.path().join("vessels/two.yaml"), &vessel).unwrap();
        add_folder(&mut zoo, folder.path()).unwrap();
        assert!(zoo.vessel("mariner-two").is_some());
        std::fs::create_dir(folder.path().join("effects")).unwrap();
        let effect = zoo.effect_text("current").unwrap().replace("name: current", "name: tide");
        std::fs::write(folder.path().join("effects/tide.yaml"), &effect).unwrap();
        add_folder(&mut zoo, folder.path()).unwrap();
        assert!(zoo.effect("tide").is_some());
        std::fs::write(folder.path().join("vessels/three.yaml"), "kind: vessel\n").unwrap();
        assert!(
            add_folder(&mut zoo, folder.path())
                .unwrap_err()
                .message()
                .unwrap()
                .contains("vessels/three.yaml")
        );
    }
}
