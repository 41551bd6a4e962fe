//! Which hypothesis is most probable: every effect alone, then those together that improve on it.

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;
use sistership_model::law::Law;
use sistership_model::{Model, Trial};

use super::Request;
use super::base::Base;
use super::discount::discount;
use super::evidence::{Estimate, Fixed, Fixing, Level, Reduced};
use super::learned::Learned;
use super::nuisance::Terms;
use super::workspace::Workspace;
use crate::residual::{Candidate, Columns, Discrepancies, Gram, Nuisance};
use sistership_estimate::refine::RefineError;

/// Rounds in which a hypothesis is linearised anew where it stands.
const ROUNDS: usize = 3;
/// Evidence that makes no difference.
const SAME: f64 = 0.5;

/// What stays the same while hypotheses change.
#[derive(Clone)]
pub(super) struct Search<'a> {
    pub model: &'a Model,
    /// Its law, without effects.
    pub law: &'a Law,
    /// The model as its own trials have calibrated it.
    pub learned: Learned,
    /// By how much, by column; and by how much before any hypothesis shifted it further.
    pub calibrated: Vec<f64>,
    pub calibrated_at_first: Vec<f64>,
    pub terms: Terms,
    pub trials: &'a [&'a Trial],
    pub nuisance: Vec<Nuisance>,
    pub fixed: Fixed,
    pub expected: Discrepancies,
    /// Levels of the discrepancy that are weighed.
    pub levels: Vec<Level>,
    pub least_step_s: Option<f64>,
    /// Forms of the library's effects that can be tried.
    pub listed: Vec<Candidate>,
    /// Terms that the model lacks.
    pub freed: Vec<Candidate>,
    /// Logarithm of the prior probability of each form among all.
    pub log_priors: std::collections::BTreeMap<String, f64>,
}

/// An effect that may be missing, by one linearisation.
#[derive(Clone)]
pub(super) struct Likely {
    pub evidence: f64,
    /// Discounted by the effect's false-alarm level.
    pub believed: f64,
    /// The level of the discrepancy at which it is most probable, among those of the base.
    pub level: usize,
    pub candidate: Candidate,
}

/// A hypothesis where it is most probable.
#[derive(Debug, Clone)]
pub(super) struct Judged {
    pub candidates: Vec<Candidate>,
    /// Logarithm of the probability of the readings and of the hypothesis itself.
    pub log_evidence: f64,
    pub covariance: DMatrix<f64>,
    /// The level of the discrepancy, among those of the base that it was judged beside.
    pub level: usize,
    /// Change of the coefficients.
    pub shift: DVector<f64>,
    /// Products of each trial under the most probable discrepancies, at `stood`.
    pub grams: Vec<Gram>,
    /// Where the candidates stood when the columns were made.
    pub stood: Vec<Candidate>,
}

impl<'a> Search<'a> {
    /// The discrepancies at a level.
    pub fn discrepancies(&self, level: Level) -> Discrepancies {
        let scaled = |d: &sistership_model::uncertainty::Discrepancy| {
            let (deviation, white) = (d.deviation * level.factor, d.white * level.factor);
            sistership_model::uncertainty::Discrepancy { deviation, white, ..*d }
        };
        self.expected.iter().map(scaled).collect()
    }

    /// Trials and columns made ready.
    ///
    /// # Errors
    /// Names what the model or a trial lacks.
    pub fn workspace(&self, candidates: Vec<Candidate>) -> Result<Workspace<'a>, RefineError> {
        let columns = Columns { nuisance: self.nuisance.clone(), candidates };
        Workspace::new(&self.learned, columns, self.trials, self.least_step_s)
    }

    /// Effects that are taken with all others beside them, at some of the levels.
    ///
    /// # Errors
    /// Names what the model or a trial lacks.
    pub fn base(&self, taken: &[Candidate], levels: &[Level]) -> Result<Base<'a>, RefineError> {
        let has_column = |candidate: &&Candidate| !self.nuisance.iter().any(|n| n.name == candidate.form.file.name);
        let others = self.others(taken).into_iter().filter(has_column).cloned();
        let workspace = self.workspace(taken.iter().cloned().chain(others).collect())?;
        let levels = levels.iter().map(|&level| (level, self.discrepancies(level))).collect();
        Ok(Base::new(taken, workspace, levels))
    }

    /// Effects that are taken, with nothing beside them.
    ///
    /// # Errors
    /// Names what the model or a trial lacks.
    pub fn bare(&self, taken: &[Candidate], levels: &[Level]) -> Result<Base<'a>, RefineError> {
        let levels = levels.iter().map(|&level| (level, self.discrepancies(level))).collect();
        Ok(Base::new(taken, self.workspace(taken.to_vec())?, levels))
    }

    /// How far coefficients have given way to the trials that are diagnosed.
    pub fn given_way(&self) -> Vec<f64> {
        self.calibrated.iter().zip(&self.calibrated_at_first).map(|(now, before)| now - before).collect()
    }

    /// No form of an effect is tried any more.
    pub fn forget(&mut self, effect: &str) {
        self.listed.retain(|candidate| candidate.effect != effect);
        self.freed.retain(|candidate| candidate.effect != effect);
    }

    /// Every effect of which none is taken.
    pub fn others(&self, taken: &[Candidate]) -> Vec<&Candidate> {
        let is_other = |candidate: &&Candidate| !taken.iter().any(|kept| kept.effect == candidate.effect);
        self.listed.iter().chain(&self.freed).filter(is_other).collect()
    }

    /// The evidence of each other effect together with those taken, from one linearisation at the absence of all others,
    /// most probable first.
    pub fn screen(&self, base: &Base<'_>) -> Vec<Likely> {
        let others = self.others(&base.taken);
        let showing = |candidate: &&Candidate| base.workspace.columns().showing(candidate);
        let columns = base.taken.iter().flat_map(|kept| showing(&kept)).chain(others.iter().flat_map(showing));
        let places: Vec<usize> = (0..self.nuisance.len()).chain(columns).collect();
        let at_level = |level: usize| Some((level, Reduced::new(&base.total(level).select(&places), &self.fixed)?));
        let reduced: Vec<(usize, Reduced)> = (0..base.levels.len()).into_par_iter().filter_map(at_level).collect();
        self.screened(base, &others, &reduced)
    }

    fn screened(&self, base: &Base<'_>, others: &[&Candidate], reduced: &[(usize, Reduced)]) -> Vec<Likely> {
        let kept: Vec<usize> = (0..base.taken.iter().map(|kept| kept.at.len()).sum()).collect();
        let mut first = kept.len();
        let mut one = |candidate: &&Candidate| {
            let places: Vec<usize> = kept.iter().copied().chain(first..first + candidate.at.len()).collect();
            first += candidate.at.len();
            let fixing: Vec<Fixing> = base.taken.iter().chain([*candidate]).flat_map(priors).collect();
            let gain = |(level, reduced): &(usize, Reduced)| {
                let gain = reduced.estimate(&places, &fixing)?.gain;
                Some((base.levels[*level].level.log_prior - 0.5 * reduced.deviance + gain, *level))
            };
            let (evidence, level) = reduced.iter().filter_map(gain).max_by(|a, b| a.0.total_cmp(&b.0))?;
            let believed = self.believed(reduced, &kept, &places[kept.len()..], base, candidate);
            let prior = self.log_prior(candidate);
            Some(Likely { evidence: evidence + prior, believed: believed? + prior, level, candidate: (*candidate).clone() })
        };
        let mut screened: Vec<Likely> = others.iter().filter_map(&mut one).collect();
        screened.sort_by(|a, b| b.evidence.total_cmp(&a.evidence));
        screened
    }

    /// The discounted evidence of an effect beside those of a base, at the level at which it says most.
    fn believed(
        &self,
        reduced: &[(usize, Reduced)],
        kept: &[usize],
        own: &[usize],
        base: &Base<'_>,
        candidate: &Candidate,
    ) -> Option<f64> {
        let (others, fixing): (Vec<Fixing>, Vec<Fixing>) = (base.taken.iter().flat_map(priors).collect(), priors(candidate));
        let columns: Vec<usize> = (0..own.len()).collect();
        let gain = |(_, reduced): &(usize, Reduced)| {
            let given = reduced.given(kept, &others, own)?.discounted(self.discount(candidate));
            Some(given.estimate(&columns, &fixing)?.gain)
        };
        // The least: what is said at one level only is not said.
        reduced.iter().filter_map(gain).min_by(f64::total_cmp)
    }

    /// The evidence for one of the effects judged together, given the others: discounted by its false-alarm level on clean trials,
    /// after what the number of hypotheses costs.
    pub fn evidence(&self, judged: &Judged, place: usize) -> Option<f64> {
        let candidate = &judged.candidates[place];
        let sizes: Vec<usize> = judged.stood.iter().map(|stood| stood.at.len()).collect();
        let first: usize = sizes[..place].iter().sum();
        let own: Vec<usize> = (first..first + sizes[place]).collect();
        let others: Vec<usize> = (0..sizes.iter().sum()).filter(|column| !own.contains(column)).collect();
        let fixing: Vec<Fixing> = judged.stood.iter().flat_map(priors).collect();
        let of = |columns: &[usize]| columns.iter().map(|&column| fixing[column]).collect::<Vec<_>>();
        let width = judged.grams.first()?.products.nrows();
        let reduced = Reduced::new(&Gram::sum(&judged.grams, width), &self.fixed)?.given(&others, &of(&others), &own)?;
        let reduced = reduced.discounted(self.discount(candidate));
        let estimate = reduced.estimate(&(0..own.len()).collect::<Vec<_>>(), &of(&own))?;
        let stood = judged.stood[place].at.iter().zip(candidate.form.parameters.values());
        let absent = reduced.at(&stood.map(|(at, parameter)| parameter.absent - at).collect::<Vec<_>>().into());
        Some(estimate.gain - absent + self.log_prior(candidate))
    }

    /// The factor by which the information on an effect is discounted.
    pub fn discount(&self, candidate: &Candidate) -> f64 {
        discount(self.model.uncertainty.as_ref(), candidate, self.trials.len())
    }

    fn log_prior(&self, candidate: &Candidate) -> f64 {
        self.log_priors.get(&candidate.key()).copied().unwrap_or_default()
    }

    /// The effects of a base alone, at the level at which they are most probable.
    ///
    /// # Errors
    /// Says that the information is not positive.
    pub fn alone(&self, base: &Base<'_>) -> Result<(usize, Judged), RefineError> {
        let places: Vec<usize> = (0..base.taken.iter().map(|kept| kept.at.len()).sum()).collect();
        let grams = |level: usize| match base.taken.len() {
            0 => Ok::<_, RefineError>(base.alone(level)),
            _ => Ok(base.stand(&self.learned, &base.taken)?.grams(level)),
        };
        let at = |level: usize| Some((level, self.judged(base, &base.taken, level, grams(level).ok()?, &places)?));
        let best = (0..base.levels.len()).filter_map(at).max_by(|a, b| a.1.log_evidence.total_cmp(&b.1.log_evidence));
        best.ok_or_else(not_positive)
    }

    /// A hypothesis beside the effects of a base, linearised anew where it stands until it stays there. What one linearisation
    /// promises of a step is not believed before it has been seen from where the step leads: an instrument's error multiplies the
    /// motion, so that promises are many times too high, or of the wrong sign.
    ///
    /// # Errors
    /// Names what a trial lacks.
    pub fn judge(&self, base: &Base<'_>, candidate: &Candidate, level: usize) -> Result<Judged, RefineError> {
        let absent = [base.taken.as_slice(), std::slice::from_ref(candidate)].concat();
        let promised = self.at(base, &absent, level)?;
        let mut best = self.at(base, &promised.1.candidates, promised.0)?;
        if best.1.log_evidence < promised.1.log_evidence - SAME {
            let less = self.at(base, &halfway(&absent, &promised.1.candidates), promised.0)?;
            best = if less.1.log_evidence > best.1.log_evidence { less } else { best };
        }
        for _ in 1..ROUNDS {
            let next = self.at(base, &best.1.candidates, best.0)?;
            let gain = next.1.log_evidence - best.1.log_evidence;
            best = if gain > 0.0 { next } else { break };
            if gain < SAME {
                break;
            }
        }
        Ok(best.1)
    }

    /// This search with the model as a hypothesis teaches it.
    ///
    /// # Errors
    /// Says that the information is not positive.
    pub fn calibrated_by(&self, request: &Request<'_>, judged: &Judged) -> Result<Self, RefineError> {
        let size = self.nuisance.len();
        let total = Gram::sum(&judged.grams, judged.grams.first().map_or(0, |gram| gram.products.nrows()));
        let moved = judged.candidates.iter().zip(&judged.stood).flat_map(|(c, s)| c.at.iter().zip(&s.at).map(|(a, b)| a - b));
        let cross = total.products.view((1, 1 + size), (size, total.products.ncols() - 1 - size));
        let right = total.products.view((1, 0), (size, 1)).column(0) - cross * DVector::from_iterator(cross.ncols(), moved);
        let known = Fixed {
            information: total.products.view((1, 1), (size, size)) + &self.fixed.information,
            weighted_mean: right + &self.fixed.weighted_mean,
        };
        let shift = known.expected_shift(&self.nuisance).ok_or_else(not_positive)?;
        let calibrated: Vec<f64> = self.calibrated.iter().zip(&shift).map(|(before, more)| before + more).collect();
        Ok(Self {
            learned: Learned::new(request.model, request.law, &self.terms, &self.nuisance, &calibrated)?,
            fixed: self.fixed.clone().from(&shift),
            calibrated,
            ..self.clone()
        })
    }

    /// Where candidates stand, at a level or the one below, whichever is more probable.
    fn at(&self, base: &Base<'_>, candidates: &[Candidate], level: usize) -> Result<(usize, Judged), RefineError> {
        let stand = base.stand(&self.learned, candidates)?;
        let places: Vec<usize> = (0..candidates.iter().map(|candidate| candidate.at.len()).sum()).collect();
        let at = |level: usize| Some((level, self.judged(base, candidates, level, stand.grams(level), &places)?));
        let levels = level.saturating_sub(1)..=level;
        let best = levels.filter_map(at).max_by(|a, b| a.1.log_evidence.total_cmp(&b.1.log_evidence));
        best.ok_or_else(not_positive)
    }

    fn judged(
        &self,
        base: &Base<'_>,
        candidates: &[Candidate],
        level: usize,
        grams: Vec<Gram>,
        places: &[usize],
    ) -> Option<Judged> {
        let priors: Vec<Fixing> = candidates.iter().flat_map(priors).collect();
        let total = Gram::sum(&grams, grams.first()?.products.nrows());
        let reduced = Reduced::new(&total, &self.fixed)?;
        let estimate = reduced.estimate(places, &priors)?;
        let prior: f64 = candidates.iter().map(|candidate| self.log_prior(candidate)).sum();
        Some(Judged {
            log_evidence: base.levels[level].level.log_prior - 0.5 * reduced.deviance + estimate.gain + prior,
            candidates: placed(candidates.to_vec(), &estimate),
            stood: candidates.to_vec(),
            shift: &reduced.shift - &reduced.answers * &estimate.mean,
            covariance: estimate.covariance,
            level,
            grams,
        })
    }
}

fn not_positive() -> RefineError {
    RefineError::Data("the trials' information is not positive".into())
}

impl Judged {
    /// Logarithm of the probability of some of the trials under this hypothesis, and its estimate there.
    pub fn of_trials(&self, fixed: &Fixed, keep: &dyn Fn(usize) -> bool) -> Option<(f64, Vec<Candidate>)> {
        let width = self.grams.first()?.products.nrows();
        let kept = self.grams.iter().enumerate().filter(|(trial, _)| keep(*trial)).map(|(_, gram)| gram);
        let reduced = Reduced::new(&Gram::sum(kept, width), fixed)?;
        let columns: Vec<usize> = (0..width - 1 - fixed.weighted_mean.len()).collect();
        let priors: Vec<Fixing> = self.stood.iter().flat_map(priors).collect();
        let estimate = reduced.estimate(&columns, &priors)?;
        Some((estimate.gain - 0.5 * reduced.deviance, placed(self.stood.clone(), &estimate)))
    }

    /// How probable each trial is by a fit on the others: the sum of the logarithms.
    pub fn held_out(&self, fixed: &Fixed) -> Option<f64> {
        let (all, ..) = self.of_trials(fixed, &|_| true)?;
        let without = |trial: usize| Some(all - self.of_trials(fixed, &|other| other != trial)?.0);
        (0..self.grams.len()).map(without).sum()
    }
}

/// Between two places of the same candidates.
fn halfway(from: &[Candidate], to: &[Candidate]) -> Vec<Candidate> {
    let between = |(from, to): (&Candidate, &Candidate)| {
        let at = from.at.iter().zip(&to.at).map(|(from, to)| 0.5 * (from + to)).collect();
        Candidate { at, ..to.clone() }
    };
    from.iter().zip(to).map(between).collect()
}

/// The priors of a candidate's parameters, as distances from where it stands.
pub(super) fn priors(candidate: &Candidate) -> Vec<Fixing> {
    let one = |(at, parameter): (&f64, &sistership_model::effect::EffectParameter)| Fixing {
        mean: parameter.prior_mean - at,
        deviation: parameter.prior_deviation,
    };
    candidate.at.iter().zip(candidate.form.parameters.values()).map(one).collect()
}

/// Candidates at an estimate, within the bounds of their parameters.
fn placed(mut candidates: Vec<Candidate>, estimate: &Estimate) -> Vec<Candidate> {
    let mut means = estimate.mean.iter();
    for candidate in &mut candidates {
        let parameters = candidate.form.parameters.values();
        for ((at, parameter), mean) in candidate.at.iter_mut().zip(parameters).zip(&mut means) {
            *at = (*at + mean).clamp(parameter.bounds[0], parameter.bounds[1]);
        }
    }
    candidates
}
