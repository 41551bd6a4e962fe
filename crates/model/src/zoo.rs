//! The zoo: laws, effects and vessels by name, embedded in the program and extended at run time.

use std::collections::BTreeMap;
use std::sync::Arc;

use include_dir::{Dir, include_dir};
use rayon::prelude::*;

use crate::effect::Effect;
use crate::error::FileError;
use crate::law::Law;
use crate::model::Model;
use crate::vessel::Vessel;

static MODELS: Dir<'_> = include_dir!("$CARGO_MANIFEST_DIR/../../models");

/// Laws, effects and vessels by name.
#[derive(Debug, Clone, Default)]
pub struct Zoo {
    laws: BTreeMap<String, Arc<Law>>,
    effects: BTreeMap<String, Arc<Effect>>,
    vessels: BTreeMap<String, Arc<Vessel>>,
    texts: BTreeMap<String, String>,
}

impl Zoo {
    /// The laws, effects and vessels that the program carries.
    ///
    /// # Errors
    /// The first file that does not read; a test keeps this from happening in a release.
    pub fn embedded() -> Result<Self, FileError> {
        let mut zoo = Self::default();
        let (laws, (effects, vessels)) = rayon::join(
            || parsed("laws", Law::parse),
            || {
                rayon::join(
                    || parsed("effects", Effect::parse),
                    || parsed("vessels", Vessel::parse),
                )
            },
        );
        for (_, text, law) in laws {
            zoo.keep_law(Arc::new(law?), text);
        }
        for (_, text, effect) in effects {
            zoo.keep_effect(Arc::new(effect?), text);
        }
        let checked: Vec<Result<(), FileError>> = vessels
            .par_iter()
            .map(|(file, _, vessel)| match vessel {
                Ok(vessel) => zoo.check_file(file, vessel),
                Err(error) => Err(error.clone()),
            })
            .collect();
        for ((_, text, vessel), checked) in vessels.into_iter().zip(checked) {
            checked?;
            zoo.keep_vessel(Arc::new(vessel?), text);
        }
        Ok(zoo)
    }

    /// Adds a law, or replaces the one of the same name.
    ///
    /// # Errors
    /// As [`Law::parse`].
    pub fn add_law(&mut self, file: &str, text: &str) -> Result<Arc<Law>, FileError> {
        let law = Arc::new(Law::parse(file, text)?);
        self.keep_law(Arc::clone(&law), text);
        Ok(law)
    }

    fn keep_law(&mut self, law: Arc<Law>, text: &str) {
        self.texts.insert(format!("law {}", law.name), text.to_owned());
        self.laws.insert(law.name.clone(), law);
    }

    /// Adds an effect, or replaces the one of the same name.
    ///
    /// # Errors
    /// As [`Effect::parse`].
    pub fn add_effect(&mut self, file: &str, text: &str) -> Result<Arc<Effect>, FileError> {
        let effect = Arc::new(Effect::parse(file, text)?);
        self.keep_effect(Arc::clone(&effect), text);
        Ok(effect)
    }

    fn keep_effect(&mut self, effect: Arc<Effect>, text: &str) {
        self.texts.insert(format!("effect {}", effect.name), text.to_owned());
        self.effects.insert(effect.name.clone(), effect);
    }

    /// Adds a vessel, or replaces the one of the same name; each of her models is checked against
    /// its law.
    ///
    /// # Errors
    /// As [`Vessel::parse`] and [`Model::published`].
    pub fn add_vessel(&mut self, file: &str, text: &str) -> Result<Arc<Vessel>, FileError> {
        let vessel = Arc::new(Vessel::parse(file, text)?);
        self.check_file(file, &vessel)?;
        self.keep_vessel(Arc::clone(&vessel), text);
        Ok(vessel)
    }

    fn check_file(&self, file: &str, vessel: &Vessel) -> Result<(), FileError> {
        self.check_models(vessel).map_err(|error| FileError { file: file.to_owned(), ..error })
    }

    fn keep_vessel(&mut self, vessel: Arc<Vessel>, text: &str) {
        self.texts.insert(format!("vessel {}", vessel.name()), text.to_owned());
        self.vessels.insert(vessel.name().to_owned(), vessel);
    }

    /// Checks that each model of a vessel fits its law.
    ///
    /// # Errors
    /// Names the model and the field.
    pub fn check_models(&self, vessel: &Vessel) -> Result<(), FileError> {
        vessel
            .file
            .models
            .iter()
            .try_for_each(|model| self.published(vessel, Some(&model.name)).map(|_| ()))
    }

    /// A published model of a vessel, by default her first.
    ///
    /// # Errors
    /// Says which law, model, parameter or coefficient is missing.
    pub fn published(&self, vessel: &Vessel, name: Option<&str>) -> Result<Model, FileError> {
        let models = &vessel.file.models;
        let wanted = name
            .map_or_else(|| models.first(), |name| models.iter().find(|model| model.name == name));
        let law_name = wanted.map_or("", |model| model.law.as_str());
        match self.laws.get(law_name) {
            Some(law) => Model::published(vessel, name, law),
            None if wanted.is_none() => Model::published(vessel, name, &Law::empty()),
            None => Err(FileError {
                file: vessel.name().to_owned(),
                line: None,
                field: "models.law".into(),
                message: format!(
                    "there is no law `{law_name}`; there are {}",
                    self.law_names().join(", ")
                ),
            }),
        }
    }

    /// A model by `ship` or `ship/model`.
    ///
    /// # Errors
    /// Says what is not in the zoo, and what is.
    pub fn model(&self, name: &str) -> Result<Model, FileError> {
        let (ship, model) =
            name.split_once('/').map_or((name, None), |(ship, model)| (ship, Some(model)));
        let vessel = self.vessels.get(ship).ok_or_else(|| self.no_ship(ship))?;
        self.published(vessel, model)
    }

    /// The refusal of a ship that is not here.
    pub fn no_ship(&self, name: &str) -> FileError {
        let known: Vec<&str> = self.vessels.keys().map(String::as_str).collect();
        let message = format!(
            "there is no such ship in the zoo and no such file; the zoo has {}",
            known.join(", ")
        );
        FileError { file: name.to_owned(), line: None, field: String::new(), message }
    }

    /// A law by name.
    pub fn law(&self, name: &str) -> Option<&Arc<Law>> {
        self.laws.get(name)
    }

    /// An effect by name.
    pub fn effect(&self, name: &str) -> Option<&Arc<Effect>> {
        self.effects.get(name)
    }

    /// A vessel by name.
    pub fn vessel(&self, name: &str) -> Option<&Arc<Vessel>> {
        self.vessels.get(name)
    }

    /// Every law, by name.
    pub fn laws(&self) -> impl Iterator<Item = &Arc<Law>> {
        self.laws.values()
    }

    /// Every effect, by name.
    pub fn effects(&self) -> impl Iterator<Item = &Arc<Effect>> {
        self.effects.values()
    }

    /// Every vessel, by name.
    pub fn vessels(&self) -> impl Iterator<Item = &Arc<Vessel>> {
        self.vessels.values()
    }

    /// The text of a law's file.
    pub fn law_text(&self, name: &str) -> Option<&str> {
        self.texts.get(&format!("law {name}")).map(String::as_str)
    }

    /// The text of an effect's file.
    pub fn effect_text(&self, name: &str) -> Option<&str> {
        self.texts.get(&format!("effect {name}")).map(String::as_str)
    }

    /// The text of a vessel's file.
    pub fn vessel_text(&self, name: &str) -> Option<&str> {
        self.texts.get(&format!("vessel {name}")).map(String::as_str)
    }

    fn law_names(&self) -> Vec<&str> {
        self.laws.keys().map(String::as_str).collect()
    }
}

/// A file with its text, and what was made of it.
type Parsed<T> = (&'static str, &'static str, Result<T, FileError>);

/// Parses the files of a folder on all cores, in their order.
fn parsed<T: Send>(
    folder: &str,
    parse: impl Fn(&str, &str) -> Result<T, FileError> + Sync,
) -> Vec<Parsed<T>> {
    let files: Vec<(&str, &str)> = yaml_files(folder).collect();
    files.into_par_iter().map(|(file, text)| (file, text, parse(file, text))).collect()
}

fn yaml_files(folder: &str) -> impl Iterator<Item = (&'static str, &'static str)> {
    let files = MODELS.get_dir(folder).map(Dir::files).into_iter().flatten();
    files
        .filter(|file| file.path().extension().is_some_and(|extension| extension == "yaml"))
        .filter_map(|file| Some((file.path().to_str()?, file.contents_utf8()?)))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn every_embedded_file_reads() {
        let zoo = Zoo::embedded().unwrap_or_else(|error| panic!("{error}"));
        for ship in [
            "mariner",
            "sr108",
            "kvlcc2",
            "kvlcc2-7m",
            "kcs",
            "esso-tanker",
            "pcc",
            "esso-osaka-3m",
        ] {
            assert!(zoo.vessel(ship).is_some(), "{ship} is missing");
        }
    }
}
