//! Successive halving over candidates (Karnin, Koren, Somekh 2013, ICML, Algorithm 3; Jamieson and
//! Talwalkar 2016, AISTATS, Algorithm 1): at each stage a share of them goes on to the next, more
//! expensive estimator.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

use rayon::prelude::*;

use crate::candidate::{CandidatePrior, PHYSICAL_LAW, SelectionCandidate};
use crate::evaluation::{
    CandidateSearch, EvaluatedCandidate, candidate_request, chosen_place, evaluate_candidate,
    last_ridge, stage_evaluation, stage_settings,
};
use crate::selection::{SelectedCandidate, select_candidate};
use crate::selection_report::SelectionStage;
use crate::thresholds::SEARCH;
use sistership_identification::refine::{
    CandidateEvaluation, MonotoneProgress, Progress, RefineError, RefinementSettings,
    SourceEnvelopes, refine_if_wanted,
};
use sistership_priors::transfer::trial_approach;

/// Returns the best candidate and estimator with its refinement.
///
/// # Errors
/// Returns an error if it was cancelled, a setting is refused, or nothing could be simulated to its
/// end.
pub fn search_candidates(
    search: &CandidateSearch<'_>,
    progress: Progress<'_>,
) -> Result<SelectedCandidate, RefineError> {
    let settings = search_settings(search);
    run_stages(&CandidateSearch { settings: &settings, ..*search }, progress)
}

/// Default number of samples on which a search learns the noise model.
pub fn calibration_samples() -> usize {
    SEARCH.calibration
}

/// The settings of the search: the requested ones with the defaults of the search.
fn search_settings(search: &CandidateSearch<'_>) -> RefinementSettings {
    let (settings, fitted) = (search.settings, search.fitted_trials());
    let length_s = search.target.particular("lpp_m").zip(trial_approach(&fitted));
    let few = fitted.len() < SEARCH.few;
    let lengths_s = |lengths: f64| length_s.map(|(l, approach)| lengths * l / approach.speed_m_s);
    RefinementSettings {
        restart_s: settings.restart_s.or(lengths_s(SEARCH.restart)),
        longer_restarts_s: longer_restarts_s(search, &lengths_s),
        smoothing_s: settings.smoothing_s.or(lengths_s(SEARCH.smoothing)),
        part_s: settings.part_s.or_else(|| lengths_s(SEARCH.part).filter(|_| !few)),
        hold_out_parts: settings.hold_out_parts || few,
        calibration_samples: settings.calibration_samples.or(Some(SEARCH.calibration)),
        ..settings.clone()
    }
}

/// The longer restart interval, at which a bias shows: longer than every trial, so that each is
/// simulated as a whole. There is none where some laws have trials held out in parts, since all
/// candidates have the same interval and parts are hardly longer than the shortest one.
fn longer_restarts_s(
    search: &CandidateSearch<'_>,
    lengths_s: &dyn Fn(f64) -> Option<f64>,
) -> Vec<f64> {
    let (settings, fitted) = (search.settings, search.fitted_trials());
    let has_roll = search.entrants.iter().any(|entrant| entrant.law.has_roll());
    let in_parts = settings.hold_out_parts
        || fitted.len() < SEARCH.few
        || has_roll && fitted.len() < settings.folds;
    if !settings.longer_restarts_s.is_empty() || in_parts {
        return settings.longer_restarts_s.clone();
    }
    let longest_s = fitted.iter().map(|trial| trial.duration_s()).fold(0.0, f64::max);
    lengths_s(1.0).map(|length_s| longest_s + length_s).into_iter().collect()
}

/// Passes the candidates through the stages and selects one.
fn run_stages(
    search: &CandidateSearch<'_>,
    progress: Progress<'_>,
) -> Result<SelectedCandidate, RefineError> {
    let progress = MonotoneProgress::new(progress);
    let progress: Progress<'_> = &|fraction, what| progress.report_fraction(fraction, what);
    let (mut tried, known) = (Vec::new(), SourceEnvelopes::default());
    let which = |is: &dyn Fn(&SelectionCandidate) -> bool| -> Vec<usize> {
        (0..search.entrants.len()).filter(|entrant| is(&search.entrants[*entrant])).collect()
    };
    let mut alone = which(&|entrant| entrant.source_law.is_none());
    let population = which(&|entrant| entrant.held_by == CandidatePrior::Population);
    evaluate_transferred((search, &known), &mut tried, progress)?;
    let mut next = leading_by_law(search, &tried);
    // Parts of one manoeuvre have no information on other manoeuvres, and without a source there is
    // no other information.
    if search.settings.hold_out_parts && !next.is_empty() {
        alone.clear();
    }
    next.extend(alone);
    // A population is not evaluated as transferred: its mean describes a single ship poorly, but
    // its scatter describes well how far a ship may differ.
    next.extend(population);
    // The reference is always evaluated, for the report.
    next.extend(search.reference_candidate().filter(|reference| !next.contains(reference)));
    evaluate_at_stage(
        (search, &known),
        SelectionStage::Weak,
        &next,
        (0.1, 0.4),
        &mut tried,
        progress,
    )?;
    let next = leading_candidates(search, &tried);
    fit_trajectories((search, &known), &next, (0.5, 0.4), &mut tried, progress)?;
    select_candidate(search, tried, progress)
}

/// Evaluates each source as transferred, by its own law if that is among the fitted ones; by
/// another law, which only approximates it, if its own one cannot be simulated.
fn evaluate_transferred(
    (search, known): (&CandidateSearch<'_>, &SourceEnvelopes),
    tried: &mut Vec<EvaluatedCandidate>,
    progress: Progress<'_>,
) -> Result<(), RefineError> {
    let mut by_source: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
    let as_it_is = |entrant: &&SelectionCandidate| entrant.held_by != CandidatePrior::Population;
    for (place, entrant) in search.entrants.iter().enumerate().filter(|(_, e)| as_it_is(e)) {
        entrant.source_name().into_iter().for_each(|source| {
            by_source.entry(source).or_default().push(place);
        });
    }
    let share = 0.1 / by_source.len().max(1) as f64;
    for (k, entrants) in by_source.into_values().enumerate() {
        let (begin, each) = (share * k as f64, share / entrants.len() as f64);
        for (j, entrant) in entrants.into_iter().enumerate() {
            let span = (begin + each * j as f64, each);
            evaluate_at_stage(
                (search, known),
                SelectionStage::CarriedOver,
                &[entrant],
                span,
                tried,
                progress,
            )?;
            if tried.last().is_some_and(|one| one.weighed.error.is_some()) {
                break;
            }
        }
    }
    Ok(())
}

/// Evaluates candidates at a stage in parallel; progress begins at a fraction of the whole and
/// takes a span of it.
fn evaluate_at_stage(
    (search, known): (&CandidateSearch<'_>, &SourceEnvelopes),
    rung: SelectionStage,
    entrants: &[usize],
    (begin, span): (f64, f64),
    tried: &mut Vec<EvaluatedCandidate>,
    progress: Progress<'_>,
) -> Result<(), RefineError> {
    // Only a counter for progress: no other data depend on it, so that relaxed ordering suffices.
    let done = AtomicUsize::new(0);
    let one = |&entrant: &usize| {
        let named = search.entrants[entrant].name();
        let told = |_: f64, what: &str| {
            let share = done.load(Ordering::Relaxed) as f64 / entrants.len() as f64;
            progress(begin + span * share, &format!("{named}: {what}"))
        };
        let settings = search.entrants[entrant].candidate_settings(search.settings);
        let tried = evaluate_candidate((search, known), (entrant, rung), &settings, &told)?;
        done.fetch_add(1, Ordering::Relaxed);
        Ok(tried)
    };
    let weighed: Result<Vec<EvaluatedCandidate>, RefineError> =
        // One task a candidate; results keep the candidates' order.
        entrants.par_iter().with_max_len(1).map(one).collect();
    tried.extend(weighed?);
    Ok(())
}

/// Fits trajectories, each candidate within the callback of the one before: the data that a
/// candidate has prepared are kept until all have been evaluated, and become its refinement if it
/// is the chosen one.
fn fit_trajectories(
    (search, known): (&CandidateSearch<'_>, &SourceEnvelopes),
    entrants: &[usize],
    (begin, span): (f64, f64),
    tried: &mut Vec<EvaluatedCandidate>,
    progress: Progress<'_>,
) -> Result<(), RefineError> {
    let Some((&entrant, others)) = entrants.split_first() else { return Ok(()) };
    let share = span / entrants.len() as f64;
    let rest = (begin + share, span - share);
    let named = search.entrants[entrant].name();
    let told =
        |fraction: f64, what: &str| progress(begin + share * fraction, &format!("{named}: {what}"));
    let own = search.entrants[entrant].candidate_settings(search.settings);
    let settings = stage_settings(&own, SelectionStage::Trajectory, last_ridge(tried, entrant));
    // The candidate's place among all, by which it recognises itself as the chosen one.
    let (begun, place) = (Instant::now(), tried.len());
    let note = |tried: &mut Vec<EvaluatedCandidate>, weighed: CandidateEvaluation| {
        let (cost_s, rung) = (begun.elapsed().as_secs_f64(), SelectionStage::Trajectory);
        let (refinement, roll_strength, refusal) = (None, None, None);
        tried.push(EvaluatedCandidate {
            entrant,
            rung,
            weighed,
            refinement,
            cost_s,
            roll_strength,
            refusal,
        });
        fit_trajectories((search, known), others, rest, tried, progress)
    };
    // `note` evaluates the other candidates by recursion before this one learns whether it is
    // chosen.
    let is_taken = |all: &[CandidateEvaluation]| {
        note(tried, stage_evaluation(SelectionStage::Trajectory, Ok(all.to_vec()))?)?;
        Ok(chosen_place(search, tried) == Some(place))
    };
    let request = candidate_request(search, entrant, &settings);
    let made = refine_if_wanted((&request, known), is_taken, &told);
    match made {
        Ok((_, refinement)) => tried[place].refinement = refinement,
        Err(error) => {
            let refused = stage_evaluation(SelectionStage::Trajectory, Err(error))?;
            // The fit may have failed before or after its evaluation was stored.
            match tried.get_mut(place) {
                Some(weighed) => weighed.weighed = refused,
                None => note(tried, refused)?,
            }
        }
    }
    Ok(())
}

/// Candidates with their errors at the shortest restart interval, the least first; those that
/// diverged are omitted. Errors in whole trials are not used here, since the next stage may correct
/// them.
fn order_by_error<'a>(tried: impl Iterator<Item = &'a EvaluatedCandidate>) -> Vec<(usize, f64)> {
    let sailed = tried.filter(|one| one.weighed.error.is_some());
    let mut order: Vec<(usize, f64)> =
        sailed.filter_map(|one| Some((one.entrant, one.weighed.shortest?))).collect();
    order.sort_by(|a, b| a.1.total_cmp(&b.1));
    order
}

/// The leading transferred sources of each law, one in [`SEARCH`]`.share`: the error of a
/// transferred source shows which source suits a law best, but not how well a law can be fitted.
fn leading_by_law(search: &CandidateSearch<'_>, tried: &[EvaluatedCandidate]) -> Vec<usize> {
    let order = order_by_error(tried.iter());
    let sources = order.iter().filter_map(|(entrant, _)| search.entrants[*entrant].source_name());
    let mut by_law: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
    for source in sources {
        for (place, entrant) in search.entrants.iter().enumerate() {
            if entrant.source_name() == Some(source) {
                by_law.entry(&entrant.law.name).or_default().push(place);
            }
        }
    }
    let first = |entrants: Vec<usize>| {
        let count = entrants.len().div_ceil(SEARCH.share);
        entrants.into_iter().take(count)
    };
    by_law.into_values().flat_map(first).collect()
}

/// The leading candidates in weak form: trajectories seldom gain more than
/// [`SEARCH`]`.trajectory_gain`. A population, which is near the least error wherever other ships
/// determine the law, does not displace any of the others, nor do the best candidate of the physical
/// law and the one without a source.
fn leading_candidates(search: &CandidateSearch<'_>, tried: &[EvaluatedCandidate]) -> Vec<usize> {
    let fitted = order_by_error(tried.iter().filter(|one| one.rung == SelectionStage::Weak));
    let least = fitted.first().map_or(0.0, |(_, error)| *error);
    let near = fitted.iter().copied().filter(|(_, error)| *error <= SEARCH.trajectory_gain * least);
    let is_population =
        |entrant: &usize| search.entrants[*entrant].held_by == CandidatePrior::Population;
    let (population, others): (Vec<usize>, Vec<usize>) =
        near.map(|(entrant, _)| entrant).partition(is_population);
    let mut leading: Vec<usize> = others.into_iter().take(SEARCH.trajectories).collect();
    // The weak form keeps the nonlinear parameters of the physical law at the means of their priors,
    // so that its error does not show what trajectories gain.
    let physical = |entrant: &usize| search.entrants[*entrant].law.name == PHYSICAL_LAW;
    let mut of_law = fitted.iter().map(|(entrant, _)| *entrant).filter(physical);
    let first = of_law.next();
    // Nor does it show what the prior of a typical ship does in trajectories.
    let typical = of_law.find(|entrant| search.entrants[*entrant].source_law.is_none());
    let physical: Vec<usize> = first.into_iter().chain(typical).collect();
    let further = physical.into_iter().filter(|entrant| !leading.contains(entrant));
    let further: Vec<usize> = further.collect();
    leading.extend(further);
    leading.extend(population);
    leading
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use sistership_identification::testing::{mariner_model, simulated_trials};
    use sistership_model::Zoo;
    use sistership_model::trial::Trial;

    use crate::preference::Preference;

    #[test]
    fn whole_trials_are_simulated_where_they_are_held_out_whole() {
        let (zoo, (model, law)) = (Zoo::load_embedded().unwrap(), mariner_model());
        let sailed = simulated_trials(&model, &law, 0.0);
        let target = zoo.vessel("mariner").unwrap();
        let rolling = SelectionCandidate {
            source: model.clone(),
            source_law: None,
            law: zoo.law("abkowitz-roll").unwrap().clone(),
            held_by: CandidatePrior::Source,
        };
        let intervals = |count: usize, entrants: &[SelectionCandidate]| {
            let trials: Vec<&Trial> = sailed.iter().take(count).collect();
            let settings = &RefinementSettings::default();
            let search = CandidateSearch {
                target,
                entrants,
                trials: &trials,
                population: &[],
                settings,
                preference: Preference::default(),
            };
            let searched = search_settings(&search);
            (searched.restart_s.unwrap(), searched.longer_restarts_s)
        };
        let (shortest_s, longer_s) = intervals(4, &[]);
        let longest_s = sailed.iter().map(Trial::duration_s).fold(0.0, f64::max);
        assert!(longer_s.len() == 1 && longer_s[0] > longest_s, "{longer_s:?}");
        assert!(longest_s > shortest_s);
        assert_eq!(intervals(2, &[]).1, Vec::<f64>::new(), "parts of two trials");
        assert_eq!(intervals(4, &[rolling]).1, Vec::<f64>::new(), "parts of laws with roll");
    }
}
