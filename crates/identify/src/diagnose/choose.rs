//! From single effects to those that are missing together.

use rayon::prelude::*;

use super::search::{Judged, Search};
use super::settings::Settings;
use crate::refine::RefineError;
use crate::residual::Candidate;

/// How many of the most probable by one linearisation are judged where they stand.
const JUDGED: usize = 8;
/// How many companions of a taken effect are.
const COMPANIONS: usize = 4;

/// Every hypothesis that was judged; the first is the model alone.
pub(super) struct Choice {
    pub alone: Judged,
    pub tried: Vec<Judged>,
    /// Place of the one taken; none where the model alone stands.
    pub taken: Option<usize>,
}

/// Judges single effects, then what stands together with the best, exchanging each of a set for every other.
///
/// # Errors
/// Names what a trial lacks.
pub(super) fn choose(search: &Search<'_>, candidates: &[Candidate], settings: &Settings) -> Result<Choice, RefineError> {
    let alone = search.judge(&[])?;
    let mut choice = Choice { alone, tried: Vec::new(), taken: None };
    for _ in 0..settings.most_effects {
        let kept = choice.kept();
        let found = companions(search, &kept, candidates)?;
        let better = most_probable(&found).filter(|&best| choice.accepts(search, &found[best], settings));
        choice.take(found, better);
        if better.is_none() {
            break;
        }
        choice.exchange(search, candidates)?;
    }
    Ok(choice)
}

fn most_probable(found: &[Judged]) -> Option<usize> {
    (0..found.len()).max_by(|&a, &b| found[a].log_evidence.total_cmp(&found[b].log_evidence))
}

fn companions(search: &Search<'_>, base: &[Candidate], candidates: &[Candidate]) -> Result<Vec<Judged>, RefineError> {
    let others: Vec<Candidate> =
        candidates.iter().filter(|c| !base.iter().any(|kept| kept.effect == c.effect)).cloned().collect();
    let screened = search.screen(base, &others)?;
    let count = if base.is_empty() { JUDGED } else { COMPANIONS };
    let likely: Vec<Candidate> = screened.into_iter().take(count).map(|(_, candidate)| candidate).collect();
    let judge = |candidate: &Candidate| search.judge(&[base, std::slice::from_ref(candidate)].concat());
    likely.par_iter().map(judge).collect()
}

impl Choice {
    fn kept(&self) -> Vec<Candidate> {
        self.taken.map(|taken| self.tried[taken].candidates.clone()).unwrap_or_default()
    }

    fn take(&mut self, found: Vec<Judged>, best: Option<usize>) {
        self.taken = best.map(|best| self.tried.len() + best).or(self.taken);
        self.tried.extend(found);
    }

    /// Undoes a wrong first step: each of those taken together is exchanged for whatever is more probable in its place.
    fn exchange(&mut self, search: &Search<'_>, candidates: &[Candidate]) -> Result<(), RefineError> {
        let kept = self.kept();
        if kept.len() < 2 {
            return Ok(());
        }
        for place in 0..kept.len() {
            let mut base = kept.clone();
            base.remove(place);
            let found = companions(search, &base, candidates)?;
            let better = most_probable(&found).filter(|&best| found[best].log_evidence > self.best().log_evidence + 1.0);
            self.take(found, better);
        }
        Ok(())
    }

    pub(super) fn best(&self) -> &Judged {
        self.taken.map_or(&self.alone, |taken| &self.tried[taken])
    }

    /// A hypothesis is taken where it is more probable by enough, also on trials that its fit has not seen.
    fn accepts(&self, search: &Search<'_>, found: &Judged, settings: &Settings) -> bool {
        let before = self.best();
        let held_out = |judged: &Judged| judged.held_out(&search.fixed).unwrap_or(f64::NEG_INFINITY);
        found.log_evidence - before.log_evidence > settings.least_evidence && held_out(found) > held_out(before)
    }
}
