//! Zoo: laws, effects and vessels by name, embedded in the program and extended at run time.

mod entries;

use std::sync::Arc;

use include_dir::{Dir, include_dir};

use crate::effect::Effect;
use crate::error::FileError;
use crate::law::Law;
use crate::model::Model;
use crate::vessel::Vessel;
use entries::ZooEntries;

static MODELS: Dir<'_> = include_dir!("$CARGO_MANIFEST_DIR/../../../models");

/// Laws, effects and vessels by name. The embedded files are read when they are first requested:
/// most calls need one law and one ship.
#[derive(Debug, Clone)]
pub struct Zoo {
    laws: ZooEntries<Law>,
    effects: ZooEntries<Effect>,
    vessels: ZooEntries<Vessel>,
}

impl Default for Zoo {
    fn default() -> Self {
        Self {
            laws: ZooEntries::new(Law::parse),
            effects: ZooEntries::new(Effect::parse),
            vessels: ZooEntries::new(Vessel::parse),
        }
    }
}

impl Zoo {
    /// Returns the embedded laws, effects and vessels. A file that cannot be read would be missing;
    /// a test reads all of them and checks every model ([`Zoo::check`]).
    ///
    /// # Errors
    /// Returns an error for a file that is not text.
    pub fn load_embedded() -> Result<Self, FileError> {
        Ok(Self {
            laws: ZooEntries::from_folder(MODELS.get_dir("laws"), Law::parse)?,
            effects: ZooEntries::from_folder(MODELS.get_dir("effects"), Effect::parse)?,
            vessels: ZooEntries::from_folder(MODELS.get_dir("vessels"), Vessel::parse)?,
        })
    }

    /// Reads everything, and checks each model against its law.
    ///
    /// # Errors
    /// Returns the error of the first file that cannot be read or is not consistent.
    pub fn check_all(&self) -> Result<(), FileError> {
        let faults =
            [self.laws.first_fault(), self.effects.first_fault(), self.vessels.first_fault()];
        if let Some(fault) = faults.into_iter().flatten().next() {
            return Err(fault.clone());
        }
        // Documents are valid by themselves; models also depend on the law that they name.
        self.vessels().try_for_each(|vessel| self.check_models(vessel))
    }

    /// Adds a law, or replaces the one of the same name.
    ///
    /// # Errors
    /// The errors of [`Law::parse`].
    pub fn add_law(&mut self, file: &str, text: &str) -> Result<Arc<Law>, FileError> {
        let law = Arc::new(Law::parse(file, text)?);
        self.laws.insert(&law.name, text, Arc::clone(&law));
        Ok(law)
    }

    /// Adds an effect, or replaces the one of the same name.
    ///
    /// # Errors
    /// The errors of [`Effect::parse`].
    pub fn add_effect(&mut self, file: &str, text: &str) -> Result<Arc<Effect>, FileError> {
        let effect = Arc::new(Effect::parse(file, text)?);
        self.effects.insert(&effect.name, text, Arc::clone(&effect));
        Ok(effect)
    }

    /// Adds a vessel, or replaces the one of the same name; each of its models is checked against
    /// its law.
    ///
    /// # Errors
    /// The errors of [`Vessel::parse`] and [`Model::published`].
    pub fn add_vessel(&mut self, file: &str, text: &str) -> Result<Arc<Vessel>, FileError> {
        let vessel = Arc::new(Vessel::parse(file, text)?);
        let in_file = |error| FileError { file: file.to_owned(), ..error };
        self.check_models(&vessel).map_err(in_file)?;
        self.vessels.insert(vessel.name(), text, Arc::clone(&vessel));
        Ok(vessel)
    }

    /// Checks that each model of a vessel is consistent with its law.
    ///
    /// # Errors
    /// Returns an error that names the model and the field.
    pub fn check_models(&self, vessel: &Vessel) -> Result<(), FileError> {
        vessel
            .file
            .models
            .iter()
            .try_for_each(|model| self.published_model(vessel, Some(&model.name)).map(|_| ()))
    }

    /// Returns a published model of a vessel, by default its first.
    ///
    /// # Errors
    /// Returns an error that names the missing law, model, parameter or coefficient.
    pub fn published_model(&self, vessel: &Vessel, name: Option<&str>) -> Result<Model, FileError> {
        let models = &vessel.file.models;
        let wanted = name
            .map_or_else(|| models.first(), |name| models.iter().find(|model| model.name == name));
        let law_name = wanted.map_or("", |model| model.law.as_str());
        match self.laws.get(law_name) {
            Some(law) => Model::from_published(vessel, name, law),
            // There is no such model: the constructor reports it.
            None if wanted.is_none() => Model::from_published(vessel, name, &Law::empty_law()),
            None => Err(FileError {
                file: vessel.name().to_owned(),
                line: None,
                field: "models.law".into(),
                message: format!(
                    "there is no law `{law_name}`; choose one of {}",
                    self.laws.names().join(", ")
                ),
                further: Vec::new(),
            }),
        }
    }

    /// Returns a model by `ship` or `ship/model`.
    ///
    /// # Errors
    /// Returns an error that names what is not in the zoo, and the known ones.
    pub fn find_model(&self, name: &str) -> Result<Model, FileError> {
        let (ship, model) =
            name.split_once('/').map_or((name, None), |(ship, model)| (ship, Some(model)));
        let vessel = self.vessels.get(ship).ok_or_else(|| self.unknown_ship_error(ship))?;
        self.published_model(vessel, model)
    }

    /// Error of an unknown ship.
    pub fn unknown_ship_error(&self, name: &str) -> FileError {
        let message = format!(
            "there is no such ship in the zoo and no such file; the zoo has {}",
            self.vessels.names().join(", ")
        );
        FileError {
            file: name.to_owned(),
            line: None,
            field: String::new(),
            message,
            further: Vec::new(),
        }
    }

    /// Law by name.
    pub fn law(&self, name: &str) -> Option<&Arc<Law>> {
        self.laws.get(name)
    }

    /// Effect by name.
    pub fn effect(&self, name: &str) -> Option<&Arc<Effect>> {
        self.effects.get(name)
    }

    /// Vessel by name.
    pub fn vessel(&self, name: &str) -> Option<&Arc<Vessel>> {
        self.vessels.get(name)
    }

    /// Every law, in the order of names.
    pub fn laws(&self) -> impl Iterator<Item = &Arc<Law>> {
        self.laws.read_all()
    }

    /// Every effect, in the order of names.
    pub fn effects(&self) -> impl Iterator<Item = &Arc<Effect>> {
        self.effects.read_all()
    }

    /// Every vessel, in the order of names.
    pub fn vessels(&self) -> impl Iterator<Item = &Arc<Vessel>> {
        self.vessels.read_all()
    }

    /// Text of a law's file.
    pub fn law_text(&self, name: &str) -> Option<&str> {
        self.laws.document_text(name)
    }

    /// Text of an effect's file.
    pub fn effect_text(&self, name: &str) -> Option<&str> {
        self.effects.document_text(name)
    }

    /// Text of a vessel's file.
    pub fn vessel_text(&self, name: &str) -> Option<&str> {
        self.vessels.document_text(name)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn every_embedded_file_reads_by_the_name_of_its_document() {
        let zoo = Zoo::load_embedded().unwrap();
        zoo.check_all().unwrap_or_else(|error| panic!("{error}"));
        for (folder, known) in [
            ("laws", zoo.laws().map(|law| law.name.clone()).collect::<Vec<_>>()),
            ("effects", zoo.effects().map(|effect| effect.name.clone()).collect()),
            ("vessels", zoo.vessels().map(|vessel| vessel.name().to_owned()).collect()),
        ] {
            let yaml = MODELS.get_dir(folder).unwrap().files().filter(|file| {
                file.path().extension().is_some_and(|extension| extension == "yaml")
            });
            assert_eq!(known.len(), yaml.count());
            for name in known {
                let path = format!("{folder}/{name}.yaml");
                assert!(MODELS.get_file(&path).is_some(), "{name} should be {path}");
            }
        }
    }

    #[test]
    fn a_fault_of_a_file_is_found_by_the_check() {
        let mut zoo = Zoo::load_embedded().unwrap();
        let text = zoo.vessel_text("mariner").unwrap().replace("law: abkowitz", "law: none-such");
        assert!(zoo.add_vessel("m.yaml", &text).unwrap_err().to_string().contains("none-such"));
        let text = zoo.law_text("low-speed").unwrap().replace("name: low-speed", "name: abkowitz");
        zoo.add_law("law.yaml", &text).unwrap();
        assert!(zoo.check_all().is_err());
    }
}
