//! Review of a contributed ship.

use serde::Serialize;
use sistership_model::{FileError, Vessel, Zoo};
use sistership_simulation::Ship;

use crate::validation::appraisal::{ModelAppraisal, appraise_vessel};
use crate::validation::finding::{ReviewFinding, Severity};
use crate::validation::{particulars, physics};

/// A contributed ship with the findings on it, and its models.
#[derive(Debug, Clone, Serialize)]
pub struct ShipReview {
    /// The ship.
    pub ship: String,
    /// One line for people.
    pub title: String,
    /// Findings, the most severe first.
    pub findings: Vec<ReviewFinding>,
    /// Its models.
    pub models: Vec<ModelAppraisal>,
}

impl ShipReview {
    /// Returns true if the file can be accepted.
    pub fn is_acceptable(&self) -> bool {
        self.findings.iter().all(|finding| finding.severity != Severity::Refused)
    }
}

/// Checks a vessel whose file can be read: its particulars, its sources, and the behaviour of each
/// model.
///
/// # Errors
/// Returns an error with the model that does not fit its law.
pub fn review_ship(zoo: &Zoo, vessel: &Vessel) -> Result<ShipReview, FileError> {
    let models = appraise_vessel(zoo, vessel)?;
    let mut findings = particulars::particular_findings(vessel);
    findings.extend(source_findings(vessel));
    findings.extend(duplicate_finding(zoo, vessel));
    for appraisal in &models {
        findings.extend(physics_findings(zoo, appraisal, vessel)?);
        findings.extend(missed_figures(appraisal));
    }
    findings.sort();
    Ok(ShipReview {
        ship: vessel.name().to_owned(),
        title: vessel.file.title.clone(),
        findings,
        models,
    })
}

fn physics_findings(
    zoo: &Zoo,
    appraisal: &ModelAppraisal,
    vessel: &Vessel,
) -> Result<Vec<ReviewFinding>, FileError> {
    let name = appraisal.model.split_once('/').map(|(_, name)| name);
    let model = zoo.published_model(vessel, name)?;
    let ship = zoo.law(&model.law).and_then(|law| Ship::new(&model, law).ok());
    Ok(ship.map_or_else(Vec::new, |ship| physics::check_physics(&ship, appraisal)))
}

/// Findings on sources that cannot be located or have no licence.
fn source_findings(vessel: &Vessel) -> Vec<ReviewFinding> {
    let mut found = Vec::new();
    for (key, source) in &vessel.file.sources {
        let about = format!("sources.{key}");
        let traced = source.doi.is_some() || source.citation.contains("github.com");
        if !traced {
            let message = "has neither a DOI nor a repository: check that it can be found";
            found.push(ReviewFinding::for_review(&about, message));
        }
        if source.citation.contains("github.com") && !vessel.file.licences.contains_key(key) {
            found.push(ReviewFinding::for_review(
                &about,
                "`licences` does not state its licence; add it",
            ));
        }
    }
    found
}

fn duplicate_finding(zoo: &Zoo, vessel: &Vessel) -> Option<ReviewFinding> {
    zoo.vessel(vessel.name()).map(|known| {
        let message = format!("the zoo has a ship of this name already: {}", known.file.title);
        ReviewFinding::for_review("name", message)
    })
}

/// Findings on published trials that a model does not meet.
fn missed_figures(appraisal: &ModelAppraisal) -> Vec<ReviewFinding> {
    let said = |missed: &crate::validation::FigureComparison| {
        let sailed = missed.sailed.map_or("nothing".to_owned(), |value| format!("{value:.2}"));
        let message = format!(
            "{}: simulated {sailed} {}, published {:.2} (allowed difference {:.2})",
            missed.figure, missed.unit, missed.published, missed.limit
        );
        let name = appraisal.model.split_once('/').map_or("", |(_, name)| name);
        ReviewFinding::for_review(format!("models.{name}"), message)
    };
    appraisal.comparisons.iter().filter(|one| !one.is_within()).map(said).collect()
}
