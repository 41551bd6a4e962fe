//! Successive halving over entrants (Karnin, Koren, Somekh 2013, ICML, Algorithm 3; Jamieson and
//! Talwalkar 2016, AISTATS, Algorithm 1): on each rung a share of them goes on to the next,
//! costlier estimator.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

use rayon::prelude::*;

use crate::entrant::{Entrant, HeldBy};
use crate::ladder::Rung;
use crate::taken::{Winner, taken};
use crate::thresholds::SEARCH;
use crate::tried::{Search, Tried, chosen_of, on_rung, request, ridge_of, settings_on, weighed_on};
use sistership_assessment::uncertainty::Sampling;
use sistership_identification::refine::{
    MonotoneProgress, Progress, RefineError, Settings, SourceEnvelopes, Weighed, refine_wanted,
};
use sistership_priors::transfer::approach_of;

/// Searches the best entrant and estimator.
///
/// # Errors
/// It was cancelled, a setting is refused, or nothing could be simulated to its end.
pub fn search(search: &Search<'_>, progress: Progress<'_>) -> Result<Winner, RefineError> {
    let settings = searched_by(search);
    climbed(&Search { settings: &settings, ..*search }, progress)
}

/// Samples on which a search has the noise model learned, where nothing else is asked.
pub fn calibration_samples() -> usize {
    SEARCH.calibration
}

/// What the search sets beside what is asked of it.
fn searched_by(search: &Search<'_>) -> Settings {
    let (settings, fitted) = (search.settings, search.fitted());
    let length_s = search.target.particular("lpp_m").zip(approach_of(&fitted));
    let few = fitted.len() < SEARCH.few;
    let lengths_s = |lengths: f64| length_s.map(|(l, approach)| lengths * l / approach.speed_m_s);
    Settings {
        restart_s: settings.restart_s.or(lengths_s(SEARCH.restart)),
        longer_restarts_s: longer_restarts_s(search, &lengths_s),
        smoothing_s: settings.smoothing_s.or(lengths_s(SEARCH.smoothing)),
        part_s: settings.part_s.or_else(|| lengths_s(SEARCH.part).filter(|_| !few)),
        in_parts: settings.in_parts || few,
        hydrostatic_roll: true,
        plane_source: true,
        steering_from_trials: true,
        steering_above_noise: true,
        recorded_terms: true,
        recorded_revolutions: true,
        posterior_by_folds: true,
        folds_pooled: true,
        economical: true,
        expected_rates: true,
        reading_interval: true,
        calibration_samples: settings.calibration_samples.or(Some(SEARCH.calibration)),
        bands: Sampling { within_steps: true, figures_only: true, ..settings.bands },
        ..settings.clone()
    }
}

/// The restart interval at which a bias shows: longer than every trial, so that each is simulated
/// as a whole; as long as parts where some laws have trials left out in those, so that all
/// candidates have the same.
fn longer_restarts_s(search: &Search<'_>, lengths_s: &dyn Fn(f64) -> Option<f64>) -> Vec<f64> {
    let (settings, fitted) = (search.settings, search.fitted());
    if !settings.longer_restarts_s.is_empty() || settings.in_parts || fitted.len() < SEARCH.few {
        return settings.longer_restarts_s.clone();
    }
    let longest_s = fitted.iter().map(|trial| trial.duration_s()).fold(0.0, f64::max);
    let has_roll = search.entrants.iter().any(|entrant| entrant.law.has_roll());
    let longer_s = match has_roll && fitted.len() < settings.folds {
        true => lengths_s(SEARCH.part),
        false => lengths_s(1.0).map(|length_s| longest_s + length_s),
    };
    longer_s.into_iter().collect()
}

fn climbed(search: &Search<'_>, progress: Progress<'_>) -> Result<Winner, RefineError> {
    let progress = MonotoneProgress::new(progress);
    let progress: Progress<'_> = &|fraction, what| progress.tell(fraction, what);
    let (mut tried, known) = (Vec::new(), SourceEnvelopes::default());
    let which = |is: &dyn Fn(&Entrant) -> bool| -> Vec<usize> {
        (0..search.entrants.len()).filter(|entrant| is(&search.entrants[*entrant])).collect()
    };
    let mut alone = which(&|entrant| entrant.source_law.is_none());
    let population = which(&|entrant| entrant.held_by == HeldBy::Population);
    carried_over((search, &known), &mut tried, progress)?;
    let mut next = leading_by_law(search, &tried);
    // Parts of one manoeuvre tell nothing of others, and without a source nothing else does.
    if search.settings.in_parts && !next.is_empty() {
        alone.clear();
    }
    next.extend(alone);
    // What ships have in common says little of one as it is, and much of how far it may be.
    next.extend(population);
    // The reference is reported whatever comes of it.
    next.extend(search.reference().filter(|reference| !next.contains(reference)));
    climb((search, &known), Rung::Weak, &next, (0.1, 0.4), &mut tried, progress)?;
    let next = leading(search, &tried);
    descend((search, &known), &next, (0.5, 0.4), &mut tried, progress)?;
    taken(search, tried, progress)
}

/// Weighs each source as carried over, by its own law where that is fitted: what another law says
/// in its place is an imitation of that, and needed only where that does not sail.
fn carried_over(
    (search, known): (&Search<'_>, &SourceEnvelopes),
    tried: &mut Vec<Tried>,
    progress: Progress<'_>,
) -> Result<(), RefineError> {
    let mut by_source: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
    let as_it_is = |entrant: &&Entrant| entrant.held_by != HeldBy::Population;
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
            climb((search, known), Rung::CarriedOver, &[entrant], span, tried, progress)?;
            if tried.last().is_some_and(|one| one.weighed.error.is_some()) {
                break;
            }
        }
    }
    Ok(())
}

/// Weighs entrants on a rung side by side; its progress begins at a fraction of the whole and takes
/// a span of it.
fn climb(
    (search, known): (&Search<'_>, &SourceEnvelopes),
    rung: Rung,
    entrants: &[usize],
    (begin, span): (f64, f64),
    tried: &mut Vec<Tried>,
    progress: Progress<'_>,
) -> Result<(), RefineError> {
    let done = AtomicUsize::new(0);
    let one = |&entrant: &usize| {
        let named = search.entrants[entrant].name();
        let told = |_: f64, what: &str| {
            let share = done.load(Ordering::Relaxed) as f64 / entrants.len() as f64;
            progress(begin + span * share, &format!("{named}: {what}"))
        };
        let settings = search.entrants[entrant].settings(search.settings);
        let tried = weighed_on((search, known), (entrant, rung), &settings, &told)?;
        done.fetch_add(1, Ordering::Relaxed);
        Ok(tried)
    };
    let weighed: Result<Vec<Tried>, RefineError> =
        entrants.par_iter().with_max_len(1).map(one).collect();
    tried.extend(weighed?);
    Ok(())
}

/// Fits trajectories, each entrant within the one before it: what an entrant has prepared is kept
/// until all have been weighed, and made into a refinement where it is what is taken then.
fn descend(
    (search, known): (&Search<'_>, &SourceEnvelopes),
    entrants: &[usize],
    (begin, span): (f64, f64),
    tried: &mut Vec<Tried>,
    progress: Progress<'_>,
) -> Result<(), RefineError> {
    let Some((&entrant, others)) = entrants.split_first() else { return Ok(()) };
    let share = span / entrants.len() as f64;
    let rest = (begin + share, span - share);
    let named = search.entrants[entrant].name();
    let told =
        |fraction: f64, what: &str| progress(begin + share * fraction, &format!("{named}: {what}"));
    let own = search.entrants[entrant].settings(search.settings);
    let settings = settings_on(&own, Rung::Trajectory, ridge_of(tried, entrant));
    let (begun, place) = (Instant::now(), tried.len());
    let note = |tried: &mut Vec<Tried>, weighed: Weighed| {
        let (cost_s, rung) = (begun.elapsed().as_secs_f64(), Rung::Trajectory);
        let (refinement, roll_strength, refusal) = (None, None, None);
        tried.push(Tried { entrant, rung, weighed, refinement, cost_s, roll_strength, refusal });
        descend((search, known), others, rest, tried, progress)
    };
    let is_taken = |all: &[Weighed]| {
        note(tried, on_rung(Rung::Trajectory, Ok(all.to_vec()))?)?;
        Ok(chosen_of(search, tried) == Some(place))
    };
    let request = request(search, entrant, &settings);
    let made = refine_wanted((&request, known), is_taken, &told);
    match made {
        Ok((_, refinement)) => tried[place].refinement = refinement,
        Err(error) => {
            let refused = on_rung(Rung::Trajectory, Err(error))?;
            match tried.get_mut(place) {
                Some(weighed) => weighed.weighed = refused,
                None => note(tried, refused)?,
            }
        }
    }
    Ok(())
}

/// Entrants with their errors at the shortest restart interval, the least first; those that did not
/// sail are left out. What goes wrong in whole trials the next stage may put right.
fn ordered<'a>(tried: impl Iterator<Item = &'a Tried>) -> Vec<(usize, f64)> {
    let sailed = tried.filter(|one| one.weighed.error.is_some());
    let mut order: Vec<(usize, f64)> =
        sailed.filter_map(|one| Some((one.entrant, one.weighed.shortest?))).collect();
    order.sort_by(|a, b| a.1.total_cmp(&b.1));
    order
}

/// Of each law the sources that lead as carried over, one in [`SEARCH`]`.share`: how well a source
/// is carried over says which source serves a law best, but not how well a law can be fitted.
fn leading_by_law(search: &Search<'_>, tried: &[Tried]) -> Vec<usize> {
    let order = ordered(tried.iter());
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

/// The entrants that lead in weak form: trajectories seldom gain more than
/// [`SEARCH`]`.trajectory_gain`. A population, which is near wherever other ships hold the law,
/// takes the place of none of the others.
fn leading(search: &Search<'_>, tried: &[Tried]) -> Vec<usize> {
    let order = ordered(tried.iter().filter(|one| one.rung == Rung::Weak));
    let least = order.first().map_or(0.0, |(_, error)| *error);
    let near = order.into_iter().filter(|(_, error)| *error <= SEARCH.trajectory_gain * least);
    let is_population = |entrant: &usize| search.entrants[*entrant].held_by == HeldBy::Population;
    let (population, others): (Vec<usize>, Vec<usize>) =
        near.map(|(entrant, _)| entrant).partition(is_population);
    others.into_iter().take(SEARCH.trajectories).chain(population).collect()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use sistership_identification::testing::{mariner, trials};
    use sistership_model::Zoo;
    use sistership_model::trial::Trial;

    #[test]
    fn whole_trials_are_simulated_where_they_are_held_out_whole() {
        let (zoo, (model, law)) = (Zoo::embedded().unwrap(), mariner());
        let sailed = trials(&model, &law, 0.0);
        let target = zoo.vessel("mariner").unwrap();
        let intervals = |count: usize| {
            let trials: Vec<&Trial> = sailed.iter().take(count).collect();
            let settings = &Settings::default();
            let search =
                Search { target, entrants: &[], trials: &trials, population: &[], settings };
            let searched = searched_by(&search);
            (searched.restart_s.unwrap(), searched.longer_restarts_s)
        };
        let (shortest_s, longer_s) = intervals(4);
        let longest_s = sailed.iter().map(Trial::duration_s).fold(0.0, f64::max);
        assert!(longer_s.len() == 1 && longer_s[0] > longest_s, "{longer_s:?}");
        assert!(longest_s > shortest_s);
        assert_eq!(intervals(2).1, Vec::<f64>::new(), "parts of two trials");
    }
}
