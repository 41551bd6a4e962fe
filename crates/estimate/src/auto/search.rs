//! Successive halving over entrants (Karnin, Koren, Somekh 2013, ICML, Algorithm 3; Jamieson and Talwalkar 2016, AISTATS,
//! Algorithm 1): on each rung a share of them goes on to the next, costlier estimator.

use std::time::Instant;

use sistership_model::Vessel;
use sistership_model::trial::Trial;

use super::choice::{chosen, factor, standard_error};
use super::entrant::Entrant;
use super::ladder::{Ladder, Line, Rung};
use crate::refine::{Extent, Progress, RefineError, Request, Settings, Weighed, in_parts, weigh};
use crate::transfer::approach_of;

/// One in so many goes on to the next rung.
const SHARE: usize = 3;
/// Fewer trials are left out in parts.
const FEW: usize = 3;
/// Strength of a prior that keeps the source.
const KEPT: f64 = 1e9;

/// What is searched.
#[derive(Debug, Clone, Copy)]
pub struct Search<'a> {
    /// The ship.
    pub target: &'a Vessel,
    /// What enters.
    pub entrants: &'a [Entrant],
    /// Trials that may be fitted; none that is kept out.
    pub trials: &'a [&'a Trial],
    /// Settings but the method.
    pub settings: &'a Settings,
}

/// What was taken, and how it is refined explicitly.
#[derive(Debug, Clone)]
pub struct Winner {
    /// Its place among the entrants.
    pub entrant: usize,
    /// Settings that name its method.
    pub settings: Settings,
    /// What was tried.
    pub ladder: Ladder,
}

/// A candidate with where it came from.
struct Tried {
    entrant: usize,
    rung: Rung,
    weighed: Weighed,
    cost_s: f64,
}

/// Searches the best entrant and estimator.
///
/// # Errors
/// It was cancelled, a setting is refused, or nothing could be simulated to its end.
pub fn search(search: &Search<'_>, progress: Progress<'_>) -> Result<Winner, RefineError> {
    let parts = few_in_parts(search);
    let trials: Vec<&Trial> =
        if parts.is_empty() { search.trials.to_vec() } else { parts.iter().collect() };
    let search = Search { trials: &trials, ..*search };
    let mut tried = Vec::new();
    let (known, alone): (Vec<usize>, Vec<usize>) = (0..search.entrants.len())
        .partition(|entrant| search.entrants[*entrant].source_law.is_some());
    climb(&search, Rung::CarriedOver, &known, (0.0, 0.2), &mut tried, progress)?;
    let mut next = leading(&tried, Rung::CarriedOver);
    next.extend(alone);
    climb(&search, Rung::Weak, &next, (0.2, 0.3), &mut tried, progress)?;
    let next = leading(&tried, Rung::Weak);
    climb(&search, Rung::Trajectory, &next, (0.5, 0.5), &mut tried, progress)?;
    taken(&search, &tried)
}

/// Weighs entrants on a rung, whose progress begins at a fraction of the whole and takes a span of it.
fn climb(
    search: &Search<'_>,
    rung: Rung,
    entrants: &[usize],
    (begin, span): (f64, f64),
    tried: &mut Vec<Tried>,
    progress: Progress<'_>,
) -> Result<(), RefineError> {
    let share = span / entrants.len().max(1) as f64;
    for (k, &entrant) in entrants.iter().enumerate() {
        let from = begin + share * k as f64;
        let told = |fraction: f64, what: &str| progress(from + share * fraction, what);
        let begun = Instant::now();
        let weighed = on_rung(search, rung, &search.entrants[entrant], &told)?;
        tried.push(Tried { entrant, rung, weighed, cost_s: begun.elapsed().as_secs_f64() });
    }
    Ok(())
}

/// What an entrant gives on a rung; one that cannot be fitted is out with the reason.
fn on_rung(
    search: &Search<'_>,
    rung: Rung,
    entrant: &Entrant,
    progress: Progress<'_>,
) -> Result<Weighed, RefineError> {
    let settings = settings_on(search.settings, rung);
    let request = Request {
        target: search.target,
        source: &entrant.source,
        source_law: entrant.source_law.as_deref(),
        law: &entrant.law,
        trials: search.trials,
        settings: &settings,
    };
    let extent = if rung == Rung::CarriedOver { Extent::Source } else { Extent::Estimator };
    match weigh(&request, extent, progress) {
        Err(error @ (RefineError::Cancelled | RefineError::Setting { .. })) => Err(error),
        Err(error) => Ok(out(error.to_string())),
        Ok(weighed) => {
            let wanted = usize::from(rung != Rung::CarriedOver);
            let one = weighed.into_iter().nth(wanted);
            Ok(one.unwrap_or_else(|| out("the trials allow no fit".to_owned())))
        }
    }
}

fn out(reason: String) -> Weighed {
    let step = String::new();
    Weighed { step, error: None, each: Default::default(), coefficients: 0, reason: Some(reason) }
}

/// Settings by which an entrant is fitted on a rung; carried over, a prior so strong that the source stays.
fn settings_on(settings: &Settings, rung: Rung) -> Settings {
    let mut settings = Settings { method: rung.method(), ..settings.clone() };
    if rung == Rung::CarriedOver {
        settings.strengths = vec![KEPT];
        settings.families = vec![crate::refine::Family::Own];
    }
    settings
}

/// The entrants with the least errors on a rung, one in [`SHARE`].
fn leading(tried: &[Tried], rung: Rung) -> Vec<usize> {
    let finite = |one: &Tried| Some((one.entrant, one.weighed.error?));
    let on_rung = tried.iter().filter(|one| one.rung == rung);
    let mut order: Vec<(usize, f64)> = on_rung.filter_map(finite).collect();
    order.sort_by(|a, b| a.1.total_cmp(&b.1));
    order.truncate(order.len().div_ceil(SHARE));
    order.into_iter().map(|(entrant, _)| entrant).collect()
}

/// The trials in parts as long as simulations run between restarts, where there are few; else nothing.
fn few_in_parts(search: &Search<'_>) -> Vec<Trial> {
    if search.trials.len() >= FEW {
        return Vec::new();
    }
    let lengths = search.target.particular("lpp_m").zip(approach_of(search.trials));
    let ten_lengths_s = lengths.map(|(l, approach)| 10.0 * l / approach.speed_m_s);
    let part_s = search.settings.restart_s.or(ten_lengths_s);
    part_s.map_or_else(Vec::new, |part_s| in_parts(search.trials, part_s))
}

fn taken(search: &Search<'_>, tried: &[Tried]) -> Result<Winner, RefineError> {
    let weighed: Vec<Weighed> = tried.iter().map(|one| one.weighed.clone()).collect();
    let best = chosen(&weighed).ok_or_else(|| {
        let reasons: Vec<String> = weighed.iter().filter_map(|one| one.reason.clone()).collect();
        RefineError::Diverged(reasons.join("; "))
    })?;
    let count = weighed.iter().filter(|one| one.error.is_some()).count();
    let line = |(place, one): (usize, &Tried)| line(search, one, place == best, count);
    let ladder = Ladder { lines: tried.iter().enumerate().map(line).collect() };
    let settings = settings_on(search.settings, tried[best].rung);
    Ok(Winner { entrant: tried[best].entrant, settings, ladder })
}

fn line(search: &Search<'_>, tried: &Tried, chosen: bool, count: usize) -> Line {
    let entrant = &search.entrants[tried.entrant];
    let factor = factor(count);
    let outcome = if chosen {
        format!("the simplest that none of {count} beats by {factor:.1} standard errors")
    } else {
        "not told apart from what is simpler, or worse".to_owned()
    };
    Line {
        source: entrant.source_name().map(str::to_owned),
        law: entrant.law.name.clone(),
        rung: tried.rung,
        coefficients: tried.weighed.coefficients,
        error: tried.weighed.error,
        standard_error: standard_error(&tried.weighed),
        cost_s: tried.cost_s,
        chosen,
        reason: tried.weighed.reason.clone().unwrap_or(outcome),
    }
}
