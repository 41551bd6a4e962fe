//! Proposal of the trial that would distinguish effects that these trials cannot: each of a set of
//! manoeuvres is simulated with the model and the effects found, and its additional evidence is
//! computed in advance.

use rayon::prelude::*;
use sistership_model::{Law, Trial};
use sistership_simulation::Ship;
use sistership_simulation::manoeuvre::{ManoeuvreSettings, simulate_turn, simulate_zigzag};
use sistership_simulation::state::at;

use super::as_recorded::trial_from_track;
use super::confounded::EffectResponses;
use super::filtered_base::FilteredBase;
use super::hypothesis::JudgedHypothesis;
use super::linearised_trials::LinearisedTrials;
use super::outcome::{MissingEffect, NextTrial};
use super::search::HypothesisSearch;
use super::thresholds::{PlannedHelm, THRESHOLDS};
use super::values::model_with_effects;
use sistership_filtering::{EffectCandidate, FilterColumns, GramMatrix, filter_part};
use sistership_identification::refine::RefineError;

/// A possible trial.
#[derive(Clone, Copy)]
struct PlannedManoeuvre {
    helm: PlannedHelm,
    speed_m_s: f64,
    heading_deg: f64,
}

/// Returns the trial that best separates an effect found from those that are confounded with it;
/// none where nothing has to be separated, or the ship cannot carry out any of the planned
/// manoeuvres.
///
/// # Errors
/// Returns an error that names what the model lacks, or one if the information is not positive.
pub(super) fn propose_next_trial(
    search: &HypothesisSearch<'_>,
    base: &FilteredBase<'_>,
    judged: &JudgedHypothesis,
    found: &[MissingEffect],
) -> Result<Option<NextTrial>, RefineError> {
    // The effect with the smallest angle to another one is the most doubtful.
    let doubtful = found.iter().filter(|found| !found.confounded_with.is_empty());
    let doubtful = doubtful
        .min_by(|a, b| a.confounded_with[0].angle_deg.total_cmp(&b.confounded_with[0].angle_deg));
    let Some(doubtful) = doubtful else { return Ok(None) };
    let is_doubtful = |candidate: &EffectCandidate| candidate.effect == doubtful.name;
    let Some(place) = judged.candidates.iter().position(is_doubtful) else { return Ok(None) };
    let doubt = SeparationProblem::new(search, base, judged, (place, doubtful));
    let ship = Ship::new(&model_with_effects(search.model, &judged.candidates, None), search.law)?;
    let gain = |planned: &PlannedManoeuvre| {
        Ok(doubt.separation_evidence(&ship, planned)?.map(|gain| (gain, *planned)))
    };
    let gains: Vec<Option<(f64, PlannedManoeuvre)>> =
        planned_manoeuvres(base).par_iter().map(gain).collect::<Result<_, RefineError>>()?;
    let best = gains.into_iter().flatten().max_by(|a, b| a.0.total_cmp(&b.0));
    let separates = std::iter::once(doubtful.name.clone())
        .chain(doubtful.confounded_with.iter().map(|other| other.name.clone()));
    Ok(best.map(|(expected, best)| NextTrial {
        manoeuvre: best.helm.name.to_owned(),
        speed_m_s: (10.0 * best.speed_m_s).round() / 10.0,
        heading_deg: best.heading_deg,
        separates: separates.collect(),
        expected,
    }))
}

fn planned_manoeuvres(base: &FilteredBase<'_>) -> Vec<PlannedManoeuvre> {
    let approach = base.workspace.speed_m_s;
    let given = THRESHOLDS.next_trial;
    let of = |helm: PlannedHelm, share: f64| {
        given.headings_deg.map(|heading_deg| PlannedManoeuvre {
            helm,
            speed_m_s: share * approach,
            heading_deg,
        })
    };
    given
        .manoeuvres
        .into_iter()
        .flat_map(|helm| given.speeds.into_iter().flat_map(move |share| of(helm, share)))
        .collect()
}

/// An effect found and those confounded with it, with the information of the trials on them and on
/// the coefficients; other columns do not matter for their separation.
struct SeparationProblem<'d, 'a> {
    search: &'d HypothesisSearch<'a>,
    base: &'d FilteredBase<'a>,
    judged: &'d JudgedHypothesis,
    place: usize,
    names: Vec<&'d str>,
    columns: FilterColumns,
    total: GramMatrix,
}

impl<'d, 'a> SeparationProblem<'d, 'a> {
    fn new(
        search: &'d HypothesisSearch<'a>,
        base: &'d FilteredBase<'a>,
        judged: &'d JudgedHypothesis,
        (place, doubtful): (usize, &'d MissingEffect),
    ) -> Self {
        let names: Vec<&str> =
            doubtful.confounded_with.iter().map(|other| other.name.as_str()).collect();
        let all = base.workspace.columns();
        let is_asked = |candidate: &EffectCandidate| {
            names.contains(&candidate.effect.as_str())
                || judged
                    .candidates
                    .iter()
                    .any(|found| found.candidate_key() == candidate.candidate_key())
        };
        let kept: Vec<usize> =
            (0..all.candidates.len()).filter(|&at| is_asked(&all.candidates[at])).collect();
        let places: Vec<usize> = (0..all.nuisance.len())
            .chain(kept.iter().flat_map(|&at| all.candidate_columns(at)))
            .collect();
        let candidates = kept.iter().map(|&at| all.candidates[at].clone()).collect();
        let total =
            base.total_products(judged.level.min(base.levels.len() - 1)).select_columns(&places);
        let columns = FilterColumns { nuisance: all.nuisance.clone(), candidates };
        Self { search, base, judged, place, names, columns, total }
    }

    /// Least evidence against the other effects after a planned trial; none where the ship cannot
    /// carry it out, or no other effect is confounded then.
    fn separation_evidence(
        &self,
        ship: &Ship,
        planned: &PlannedManoeuvre,
    ) -> Result<Option<f64>, RefineError> {
        let Some(trial) = simulate_trial(self.base, (ship, self.search.law), planned) else {
            return Ok(None);
        };
        // The planned trial is added to the information of the recorded ones.
        let mut total = self.total.clone();
        total.add(&self.planned_products(&trial)?);
        let mut others = self.search.other_candidates(&self.judged.candidates);
        others.retain(|other| self.names.contains(&other.effect.as_str()));
        let responses =
            EffectResponses::new(self.search, &self.columns, self.judged, (others, &total))?;
        Ok(responses.least_evidence_against(self.place, &self.names))
    }

    /// Products of the columns over a planned trial.
    fn planned_products(&self, trial: &Trial) -> Result<GramMatrix, RefineError> {
        let Self { search, base, judged, columns, .. } = self;
        let trials = [trial];
        let workspace = LinearisedTrials::with_given_instruments(
            &search.calibrated_model,
            columns.clone(),
            &trials,
            search.least_step_s,
            &base.workspace.noise,
        )?;
        let discrepancies =
            base.levels[judged.level.min(base.levels.len() - 1)].level_discrepancies();
        let width = 1 + workspace.columns().len();
        let parts = workspace.linearised_parts().iter().flatten();
        let grams: Vec<GramMatrix> = parts
            .map(|part| filter_part(part, &base.workspace.noise, discrepancies))
            .collect::<Result<_, _>>()?;
        Ok(GramMatrix::sum_parts(&grams, width))
    }
}

/// A trial as it would be recorded, without noise; none where the ship leaves the range in which it
/// can be simulated.
fn simulate_trial(
    base: &FilteredBase<'_>,
    (ship, law): (&Ship, &Law),
    planned: &PlannedManoeuvre,
) -> Option<Trial> {
    let workspace = &base.workspace;
    let settings = ManoeuvreSettings {
        speed_m_s: Some(planned.speed_m_s),
        duration_s: Some(THRESHOLDS.next_trial.duration * workspace.lpp_m / workspace.speed_m_s),
        run_in_s: THRESHOLDS.next_trial.run_in * workspace.lpp_m / workspace.speed_m_s,
        ..ManoeuvreSettings::default()
    };
    let PlannedHelm { rudder_deg: rudder, switch_deg, .. } = planned.helm;
    let track = match switch_deg {
        Some(switch) => simulate_zigzag(ship, rudder, switch, &settings).ok()?.track,
        None => simulate_turn(ship, rudder, &settings).ok()?.track,
    };
    // All are planned ahead: a model that turns astern in them is simulated far from its trials,
    // and what it would tell there is no expectation.
    let is_ahead = track.state_column(at::U).iter().all(|u| *u > 0.0);
    let model = workspace.trials.first().filter(|_| is_ahead)?;
    let mut trial = trial_from_track(&track, model, planned.heading_deg.to_radians());
    law.set_actuators(&mut trial);
    Some(trial)
}
