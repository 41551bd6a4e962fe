//! Resolution of `SHIP` and `MODEL`: an entry of the zoo, or a YAML file.

use std::path::Path;
use std::sync::Arc;

use sistership_model::{FileError, Law, Model, Vessel, Zoo};

use crate::failure::{Failure, about_file};
use crate::output::print_note;
use crate::suggestions::close_names;
use crate::weights;
use crate::zoo::read_text_file;

/// Returns the vessel that `SHIP` names.
///
/// # Errors
/// Returns an error if it is neither a ship of the zoo nor a valid vessel file.
pub fn resolve_ship(zoo: &Zoo, name: &str) -> Result<Arc<Vessel>, Failure> {
    if let Some(vessel) = zoo.vessel(name) {
        return Ok(Arc::clone(vessel));
    }
    let path = Path::new(name);
    if path.is_file() {
        return vessel_file(zoo, path);
    }
    // A model's name where a ship is needed: the message names the ship.
    if let Some((ship, _)) = name.split_once('/').filter(|(ship, _)| zoo.vessel(ship).is_some()) {
        return Err(Failure::Refused(format!(
            "`{name}` is a model, but a ship is needed here: give `{ship}`"
        )));
    }
    Err(unknown_name(name, zoo.vessels().map(|vessel| vessel.name().to_owned()).collect()))
}

/// Reads the vessel of a file.
///
/// # Errors
/// Returns an error if it is no vessel file, or cannot be parsed.
pub fn vessel_file(zoo: &Zoo, path: &Path) -> Result<Arc<Vessel>, Failure> {
    let text = read_text_file(path)?;
    match kind_of(&text) {
        DocumentKind::Named(kind) if kind == "model" => Err(about_file(
            path,
            "is a model, but a ship is needed here: give a file of `kind: \
                                  vessel`",
        )),
        DocumentKind::Named(kind) if kind != "vessel" => Err(about_file(
            path,
            format!(
                "is of `kind: {kind}`, but a ship is needed here: give a \
                                          file of `kind: vessel`"
            ),
        )),
        DocumentKind::None => {
            Err(about_file(path, "is not a ship file: it has no line `kind: vessel`"))
        }
        _ => Ok(Arc::new(read_vessel(zoo, path, &text)?)),
    }
}

fn read_vessel(zoo: &Zoo, path: &Path, text: &str) -> Result<Vessel, FileError> {
    let shown = path.display().to_string();
    let vessel = Vessel::parse(&shown, text)?;
    // The zoo checks the models against its laws, but does not know the path of the file.
    zoo.check_models(&vessel).map_err(|error| FileError { file: shown, ..error })?;
    Ok(vessel)
}

/// Returns the model that `MODEL` names, and its law.
///
/// # Errors
/// Returns an error if it is neither a model of the zoo nor a file with one.
pub fn resolve_model(zoo: &Zoo, name: &str) -> Result<(Model, Arc<Law>), Failure> {
    let ship = name.split_once('/').map_or(name, |(ship, _)| ship);
    let path = Path::new(name);
    // Names of the zoo have precedence over files, as for ships.
    let model = if zoo.vessel(ship).is_some() {
        zoo.find_model(name)?
    } else if path.is_file() {
        model_file(zoo, path)?
    } else {
        return Err(unknown_name(name, model_names(zoo, name.contains('/'))));
    };
    let law = law_of(zoo, &model)?;
    Ok((model, law))
}

/// Returns the model that `MODEL` names without its learned correction, and its law; notes if a
/// correction was removed.
///
/// # Errors
/// Returns an error if it is neither a model of the zoo nor a file with one.
pub fn resolve_foundation(zoo: &Zoo, name: &str) -> Result<(Model, Arc<Law>), Failure> {
    let (model, law) = resolve_model(zoo, name)?;
    if model.branch.is_some() {
        print_note(&format!(
            "{name}: the learned correction is not used; only the law and the coefficients are"
        ));
    }
    Ok((model.without_correction(), law))
}

/// Returns the law of a model.
///
/// # Errors
/// Returns an error if the zoo does not have it.
pub fn law_of(zoo: &Zoo, model: &Model) -> Result<Arc<Law>, Failure> {
    let missing =
        || Failure::Refused(format!("{}: the law `{}` is not in the zoo", model.name, model.law));
    zoo.law(&model.law).cloned().ok_or_else(missing)
}

fn model_file(zoo: &Zoo, path: &Path) -> Result<Model, Failure> {
    const WANTED: &str = "a model file is of `kind: model`, or of `kind: vessel` with models";
    let text = read_text_file(path)?;
    let shown = path.display().to_string();
    match kind_of(&text) {
        DocumentKind::Named(kind) if kind == "vessel" => {
            let vessel = read_vessel(zoo, path, &text)?;
            Ok(zoo
                .published_model(&vessel, None)
                .map_err(|error| FileError { file: shown, ..error })?)
        }
        DocumentKind::Named(kind) if kind != "model" => {
            Err(about_file(path, format!("is of `kind: {kind}`; {WANTED}")))
        }
        DocumentKind::None => Err(about_file(path, format!("is not a model file: {WANTED}"))),
        _ => {
            let law_of = |law: &str| zoo.law(law).map(|law| (**law).clone());
            let mut model = Model::parse(&shown, &text, &law_of)?;
            // Weights are looked for next to the model file.
            weights::attach_weights(path, &mut model)?;
            Ok(model)
        }
    }
}

/// Checks the kind of a file; `what` is a noun for that kind, with article.
///
/// # Errors
/// Returns an error if the file has another kind or none.
pub fn check_kind(path: &Path, text: &str, kind: &str, what: &str) -> Result<(), Failure> {
    match kind_of(text) {
        DocumentKind::Named(found) if found != kind => {
            Err(about_file(path, format!("is of `kind: {found}`; {what} is of `kind: {kind}`")))
        }
        DocumentKind::None => Err(about_file(
            path,
            format!("is not a {}: it has no line `kind: {kind}`", without_article(what)),
        )),
        _ => Ok(()),
    }
}

/// Removes the article of a noun.
fn without_article(what: &str) -> &str {
    what.split_once(' ').map_or(what, |(_, noun)| noun)
}

/// Kind of a document.
enum DocumentKind {
    Named(String),
    /// It has no `kind`.
    None,
    /// It is no YAML; parsing it as the wanted kind reports the line.
    Broken,
}

fn kind_of(text: &str) -> DocumentKind {
    match sistership_model::yaml::read_document::<serde_yaml::Value>(text) {
        Err(_) => DocumentKind::Broken,
        Ok(document) => document
            .get("kind")
            .and_then(|kind| kind.as_str())
            .map_or(DocumentKind::None, |kind| DocumentKind::Named(kind.to_owned())),
    }
}

/// Lists the ships with a model, or `ship/model` for each model.
fn model_names(zoo: &Zoo, full: bool) -> Vec<String> {
    let of_ship = |vessel: &Arc<Vessel>| -> Vec<String> {
        let ship = vessel.name();
        let models = &vessel.file.models;
        if full {
            models.iter().map(|model| format!("{ship}/{}", model.name)).collect()
        } else {
            vec![ship.to_owned()]
        }
    };
    zoo.vessels().filter(|vessel| !vessel.file.models.is_empty()).flat_map(of_ship).collect()
}

fn unknown_name(name: &str, known: Vec<String>) -> Failure {
    // Suggestions first; the whole list only if there are none.
    let close: Vec<String> =
        close_names(name, &known).into_iter().map(|known| format!("`{known}`")).collect();
    let hint = if close.is_empty() {
        format!("the zoo has {}", known.join(", "))
    } else {
        format!("did you mean {}?", close.join(" or "))
    };
    Failure::Refused(format!("`{name}` is neither a name in the zoo nor a file; {hint}"))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn message<T: std::fmt::Debug>(result: Result<T, Failure>) -> String {
        result.unwrap_err().message().unwrap().to_owned()
    }

    #[test]
    fn names_of_the_zoo_are_found_and_slips_corrected() {
        let zoo = Zoo::load_embedded().unwrap();
        assert_eq!(resolve_ship(&zoo, "mariner").unwrap().name(), "mariner");
        assert_eq!(resolve_model(&zoo, "mariner").unwrap().0.law, "abkowitz");
        assert!(message(resolve_ship(&zoo, "marinr")).contains("did you mean `mariner`?"));
        assert!(message(resolve_ship(&zoo, "kvlcc")).contains("`kvlcc2` or `kvlcc2-7m`"));
        assert!(message(resolve_ship(&zoo, "zzz")).contains("the zoo has"));
        assert!(message(resolve_ship(&zoo, "mariner/abkowitz")).contains("is a model"));
        assert!(message(resolve_model(&zoo, "marinr/abkowitz")).contains("`mariner/abkowitz`"));
        assert!(message(resolve_model(&zoo, "esso-osaka-3m")).contains("particulars only"));
    }

    #[test]
    fn files_are_read_by_their_kind() {
        let zoo = Zoo::load_embedded().unwrap();
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("m.yaml");
        let file = path.to_str().unwrap();
        std::fs::write(&path, zoo.vessel_text("mariner").unwrap()).unwrap();
        assert_eq!(resolve_model(&zoo, file).unwrap().0, zoo.find_model("mariner").unwrap());
        std::fs::write(&path, serde_yaml::to_string(&zoo.find_model("mariner").unwrap()).unwrap())
            .unwrap();
        assert_eq!(resolve_model(&zoo, file).unwrap().0, zoo.find_model("mariner").unwrap());
        assert!(message(resolve_ship(&zoo, file)).contains("is a model"));
        std::fs::write(&path, "t_s,u_m_s\n0,1\n").unwrap();
        assert!(
            message(resolve_ship(&zoo, file)).contains("is not a ship file")
                && message(resolve_model(&zoo, file)).contains("is not a model file")
        );
        std::fs::write(&path, "kind: vessel\nname: [\n").unwrap();
        assert!(message(resolve_ship(&zoo, file)).contains("m.yaml:"));
    }
}
