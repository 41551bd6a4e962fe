//! Evaluation of candidates at the stages, and the settings of each.

use std::time::Instant;

use sistership_model::Vessel;
use sistership_model::trial::Trial;

use crate::choice::chosen;
use crate::entrant::{Entrant, HeldBy};
use crate::ladder::Rung;
use crate::thresholds::SEARCH;
use sistership_identification::refine::{
    Extent, Family, Member, Progress, RefineError, Refinement, Request, Settings, SourceEnvelopes,
    Weighed, weigh,
};

/// Inputs of the search.
#[derive(Debug, Clone, Copy)]
pub struct Search<'a> {
    /// The ship.
    pub target: &'a Vessel,
    /// Candidates.
    pub entrants: &'a [Entrant],
    /// All trials; those that the settings hold out are not used.
    pub trials: &'a [&'a Trial],
    /// Ships of the population.
    pub population: &'a [Member],
    /// Settings except the method.
    pub settings: &'a Settings,
}

impl<'a> Search<'a> {
    /// Returns the trials that are used.
    pub(super) fn fitted(&self) -> Vec<&'a Trial> {
        let held_out = &self.settings.held_out;
        self.trials.iter().copied().filter(|trial| !held_out.contains(&trial.name)).collect()
    }

    /// Returns the place of the reference: the most similar eligible ship by correlation, under its
    /// own law if that can be fitted, with the source as l2 prior. `None` without such a ship.
    pub(super) fn reference(&self) -> Option<usize> {
        let is_source = |one: &Entrant| one.source_law.is_some() && one.held_by == HeldBy::Source;
        self.entrants.iter().position(is_source)
    }
}

/// An evaluated candidate, with its stage.
pub(super) struct Tried {
    pub entrant: usize,
    pub rung: Rung,
    pub weighed: Weighed,
    /// Its refinement, if that was computed with the evaluation.
    pub refinement: Option<Refinement>,
    pub cost_s: f64,
    /// Factor of roll's prior on the likeliest strength; none for a factor of 1.
    pub roll_strength: Option<f64>,
    /// Reason why it is excluded after its evaluation, if so.
    pub refusal: Option<String>,
}

/// Returns the request that refines a candidate by some settings.
pub(super) fn request<'a>(
    search: &Search<'a>,
    entrant: usize,
    settings: &'a Settings,
) -> Request<'a> {
    let entrant = &search.entrants[entrant];
    Request {
        target: search.target,
        source: &entrant.source,
        source_law: entrant.source_law.as_deref(),
        law: &entrant.law,
        trials: search.trials,
        population: search.population,
        settings,
    }
}

/// Returns the evaluation of a candidate at a stage; a candidate that cannot be fitted is excluded
/// with the reason.
pub(super) fn on_rung(
    rung: Rung,
    weighed: Result<Vec<Weighed>, RefineError>,
) -> Result<Weighed, RefineError> {
    let (of_source, of_fit) = (0, 1);
    // Evaluations are those of the source and of the best fit, in this order.
    let wanted = if rung == Rung::CarriedOver { of_source } else { of_fit };
    match weighed {
        // Cancellation and wrong settings end the search; all other errors exclude the candidate
        // alone.
        Err(error @ (RefineError::Cancelled | RefineError::Setting { .. })) => Err(error),
        Err(error) => Ok(Weighed::refused(error.to_string())),
        Ok(all) => {
            let no_fit = || Weighed::refused("the trials allow no fit".to_owned());
            Ok(all.into_iter().nth(wanted).unwrap_or_else(no_fit))
        }
    }
}

/// Evaluates a candidate at a stage by its settings.
pub(super) fn weighed_on(
    (search, known): (&Search<'_>, &SourceEnvelopes),
    (entrant, rung): (usize, Rung),
    settings: &Settings,
    progress: Progress<'_>,
) -> Result<Tried, RefineError> {
    let begun = Instant::now();
    let extent = if rung == Rung::CarriedOver { Extent::Source } else { Extent::Estimator };
    let settings = settings_on(settings, rung, None);
    let weighed = weigh((&request(search, entrant, &settings), known), extent, progress);
    let weighed = on_rung(rung, weighed)?;
    let cost_s = begun.elapsed().as_secs_f64();
    let roll_strength = settings.roll_strength;
    Ok(Tried { entrant, rung, weighed, refinement: None, cost_s, roll_strength, refusal: None })
}

/// Returns the place of the chosen candidate among those that were not refused.
pub(super) fn chosen_of(search: &Search<'_>, tried: &[Tried]) -> Option<usize> {
    let is_held = |one: &Tried| search.entrants[one.entrant].held_by == HeldBy::Population;
    let left: Vec<(usize, &Tried)> =
        tried.iter().enumerate().filter(|(_, one)| one.refusal.is_none()).collect();
    let all: Vec<_> = left.iter().map(|(_, one)| (&one.weighed, is_held(one))).collect();
    chosen(&all).map(|place| left[place].0)
}

/// Family and strength of a candidate's last evaluation.
pub(super) fn ridge_of(tried: &[Tried], entrant: usize) -> Option<(Family, f64)> {
    // Later stages come later in the list.
    tried.iter().rev().find(|one| one.entrant == entrant)?.weighed.ridge
}

/// Returns the settings by which a candidate is fitted at a stage. As transferred, the prior is so
/// strong that the source stays; in weak form few strengths are tried; trajectories start near the
/// best of those.
pub(super) fn settings_on(
    settings: &Settings,
    rung: Rung,
    ridge: Option<(Family, f64)>,
) -> Settings {
    // Families and strengths that the request names take precedence over those of the stage.
    let mut settings = Settings { method: rung.method(), ..settings.clone() };
    let (families, strengths) = match (rung, ridge) {
        (Rung::CarriedOver, _) => (vec![Family::Own], vec![SEARCH.kept]),
        (Rung::Weak, _) | (Rung::Trajectory, None) => (Vec::new(), SEARCH.strengths.to_vec()),
        (Rung::Trajectory, Some((family, lambda))) => {
            (vec![family], SEARCH.near.map(|factor| factor * lambda).to_vec())
        }
    };
    if settings.families.is_empty() {
        settings.families = families;
    }
    if settings.strengths.is_empty() {
        settings.strengths = strengths;
    }
    settings
}

/// Returns the settings that give one weak form and no other: the others have been tried already.
pub(super) fn settings_of(settings: &Settings, ridge: Option<(Family, f64)>) -> Settings {
    let mut settings = settings.clone();
    if let Some((family, lambda)) = ridge {
        settings.families = vec![family];
        settings.strengths = vec![lambda];
    }
    settings_on(&settings, Rung::Weak, None)
}
