//! Review of a contributed ship.

use serde::Serialize;
use sistership_model::{FileError, Vessel, Zoo};
use sistership_simulation::Ship;

use crate::validation::appraisal::{Appraisal, appraise_vessel};
use crate::validation::finding::{Finding, Severity};
use crate::validation::{particulars, physics};

/// A contributed ship with the findings on it, and its models.
#[derive(Debug, Clone, Serialize)]
pub struct Review {
    /// The ship.
    pub ship: String,
    /// One line for people.
    pub title: String,
    /// Findings, the most severe first.
    pub findings: Vec<Finding>,
    /// Its models.
    pub models: Vec<Appraisal>,
}

impl Review {
    /// Returns true if the file can be accepted.
    pub fn is_taken(&self) -> bool {
        self.findings.iter().all(|finding| finding.severity != Severity::Refused)
    }
}

/// Checks a vessel whose file can be read: its particulars, its sources, and the behaviour of each
/// model.
///
/// # Errors
/// Returns an error with the model that does not fit its law.
pub fn review(zoo: &Zoo, vessel: &Vessel) -> Result<Review, FileError> {
    let models = appraise_vessel(zoo, vessel)?;
    let mut findings = particulars::check(vessel);
    findings.extend(sources(vessel));
    findings.extend(already_there(zoo, vessel));
    for appraisal in &models {
        findings.extend(by_physics(zoo, appraisal, vessel)?);
        findings.extend(missed(appraisal));
    }
    findings.sort();
    Ok(Review {
        ship: vessel.name().to_owned(),
        title: vessel.file.title.clone(),
        findings,
        models,
    })
}

fn by_physics(
    zoo: &Zoo,
    appraisal: &Appraisal,
    vessel: &Vessel,
) -> Result<Vec<Finding>, FileError> {
    let name = appraisal.model.split_once('/').map(|(_, name)| name);
    let model = zoo.published(vessel, name)?;
    let ship = zoo.law(&model.law).and_then(|law| Ship::new(&model, law).ok());
    Ok(ship.map_or_else(Vec::new, |ship| physics::check(&ship, appraisal)))
}

/// Findings on sources that cannot be located or have no licence.
fn sources(vessel: &Vessel) -> Vec<Finding> {
    let mut found = Vec::new();
    for (key, source) in &vessel.file.sources {
        let about = format!("sources.{key}");
        let traced = source.doi.is_some() || source.citation.contains("github.com");
        if !traced {
            let message = "has neither a DOI nor a repository: can it be found?";
            found.push(Finding::look(&about, message));
        }
        if source.citation.contains("github.com") && !vessel.file.licences.contains_key(key) {
            found.push(Finding::look(&about, "`licences` does not say on what terms it stands"));
        }
    }
    found
}

fn already_there(zoo: &Zoo, vessel: &Vessel) -> Option<Finding> {
    zoo.vessel(vessel.name()).map(|known| {
        let message = format!("the zoo has a ship of this name: {}", known.file.title);
        Finding::look("name", message)
    })
}

/// Findings on published trials that a model does not meet.
fn missed(appraisal: &Appraisal) -> Vec<Finding> {
    let said = |missed: &crate::validation::Comparison| {
        let sailed = missed.sailed.map_or("nothing".to_owned(), |value| format!("{value:.2}"));
        let message = format!(
            "{}: sails {sailed} {}, published {:.2} (allowed {:.2})",
            missed.figure, missed.unit, missed.published, missed.limit
        );
        let name = appraisal.model.split_once('/').map_or("", |(_, name)| name);
        Finding::look(format!("models.{name}"), message)
    };
    appraisal.comparisons.iter().filter(|one| !one.is_within()).map(said).collect()
}
