//! The term families of a refinement, each with its regressions, statistics and training sets.

use std::collections::BTreeMap;

use rayon::prelude::*;
use sistership_model::Model;
use sistership_model::coefficient::Axis;
use sistership_model::trial::{Channel, Trial};

use super::blocks::Blocks;
use super::constraints::Limits;
use super::family::Family;
use super::outcome::RefineError;
use super::parts::slice;
use super::posterior::{Errors, Rows, errors, rows};
use super::published::{Choices, Fitted, Fold, most_likely};
use super::rows::{Table, trial_moments, trial_tables};
use super::selection::Task;
use super::settings::{Method, Range};
use super::weak::{Windows, weak_moments, weak_tables};
use crate::regression::{Choice, Moments};

/// One family of terms.
pub(super) struct Variant {
    /// Which.
    pub family: Family,
    /// The source carried over, with these terms.
    pub model: Model,
    /// Its regressions.
    pub blocks: Blocks,
    /// Its statistics, by trial and regression.
    pub moments: Vec<Vec<Moments>>,
    /// What its coefficients must keep to, if anything.
    pub limits: Option<Limits>,
}

impl Variant {
    /// Coefficients fitted by a training set, within the limits.
    ///
    /// # Errors
    /// Names the limits that cannot be kept together.
    pub fn solve(&self, fold: &Fold<'_>, choices: &Choices) -> Result<BTreeMap<String, Fitted>, String> {
        let mut fitted = fold.solve(choices);
        let Some(limits) = &self.limits else { return Ok(fitted) };
        let (names, curvature) = fold.curvature(choices);
        let solution = fitted.iter().map(|(name, fitted)| (name.clone(), fitted.value)).collect();
        let prior = |name: &str| fitted.get(name).map_or(0.0, |fitted| fitted.prior_deviation);
        let nearest = limits.nearest(&solution, &names, &curvature, &prior)?;
        nearest.into_iter().for_each(|(name, value)| {
            fitted.get_mut(&name).into_iter().for_each(|fitted| fitted.value = value);
        });
        Ok(fitted)
    }
}

impl Task<'_> {
    /// The families that the settings name and that differ from each other; one that has too few samples is left out,
    /// unless it is the first.
    pub(super) fn variants(&self) -> Result<Vec<Variant>, RefineError> {
        let families = if self.settings.families.is_empty() { &[Family::Own][..] } else { &self.settings.families };
        let mut variants = Vec::new();
        for &family in families {
            let Some(model) = family.of(&self.transferred, self.law) else { continue };
            match self.variant(family, model) {
                Ok(variant) => variants.push(variant),
                Err(RefineError::Data(_)) if !variants.is_empty() => {}
                Err(error) => return Err(error),
            }
        }
        Ok(variants)
    }

    fn variant(&self, family: Family, mut model: Model) -> Result<Variant, RefineError> {
        let mut blocks = Blocks::new(&model, self.law)?;
        let moments = self.moments(&blocks)?;
        if let Some(all) = merged(&moments, |_| true) {
            self.measure.hold(&mut blocks, &mut model, &all)?;
        }
        let limits = self.limits(&model)?;
        Ok(Variant { family, model, blocks, moments, limits })
    }

    /// What the settings ask of a model's coefficients.
    fn limits(&self, model: &Model) -> Result<Option<Limits>, RefineError> {
        let asked = &self.settings.constraints;
        if asked.is_empty() {
            return Ok(None);
        }
        let speeds = self.whole.iter().flat_map(|trial| trial.channel(Channel::U).into_iter().flatten());
        let speeds = speeds.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], u| [low.min(*u), high.max(*u)]);
        let limits = Limits::new(asked, model, self.law, speeds);
        limits.map(Some).map_err(|message| RefineError::Setting { field: "constraints".into(), message })
    }

    fn moments(&self, blocks: &Blocks) -> Result<Vec<Vec<Moments>>, RefineError> {
        let one = |trial: &&sistership_model::Trial| match self.windows() {
            Some(windows) => weak_moments(blocks, trial, windows),
            None => trial_moments(blocks, trial, self.settings.difference_s),
        };
        let moments: Vec<Vec<Moments>> = self.training.par_iter().map(one).collect::<Result<_, _>>()?;
        let samples: f64 = moments.iter().map(|m| m.first().map_or(0.0, |m| m.count)).sum();
        let widest = blocks.blocks.iter().map(super::Block::regressors).max().unwrap_or(0) as f64;
        // A prior as strong as a source's lets windows be fewer than a difference a sample, which are far from independent.
        let least = match (self.measure.is_source(), self.windows()) {
            (true, _) => 1.0,
            (false, Some(_)) => widest,
            (false, None) => 4.0 * widest,
        };
        if samples < least {
            let message = format!("{samples:.0} samples are too few for {widest} coefficients an axis; give at least {least}");
            return Err(RefineError::Data(message));
        }
        Ok(moments)
    }

    /// How far a ridge's coefficients on all trials may be from the truth.
    pub(super) fn errors(&self, variant: &Variant, choices: &Choices) -> Result<Option<Errors>, RefineError> {
        let Some(all) = merged(&variant.moments, |_| true) else { return Ok(None) };
        Ok(errors(&variant.blocks, &all, &self.rows(&variant.blocks)?, &variant.model, choices))
    }

    /// The rows behind a variant's statistics. Differences of neighbouring samples share most of what they say: they are merged
    /// over the time of a difference.
    fn rows(&self, blocks: &Blocks) -> Result<Rows, RefineError> {
        let windows = self.windows();
        let parts = |trial: &&Trial| trial.segments().into_iter().map(|part| slice(trial, part)).collect::<Vec<_>>();
        let parts: Vec<Trial> = self.training.iter().flat_map(parts).filter(|part| part.len() > 1).collect();
        let one = |part: &Trial| match windows {
            Some(windows) => weak_tables(blocks, part, windows),
            None => trial_tables(blocks, part, self.settings.difference_s),
        };
        let tables: Vec<Vec<Table>> = parts.par_iter().map(one).collect::<Result<_, _>>()?;
        let interval_s = parts.first().map_or(1.0, Trial::interval_s);
        let merged = windows.is_none().then(|| self.settings.difference_s.map_or(1.0, |s| (s / interval_s).round()));
        Ok(rows(blocks, &tables, merged.unwrap_or(1.0) as usize, windows.is_none()))
    }

    /// The windows of the weak form; none where differences are taken.
    fn windows(&self) -> Option<Windows> {
        if self.settings.method == Method::Published {
            return None;
        }
        let length_s = self.settings.window_s.unwrap_or(0.0);
        Some(Windows { length_s, hop_s: self.settings.hop_s.unwrap_or(0.1 * length_s) })
    }

    /// Training sets with whole manoeuvres left out; a single trial can only judge itself.
    pub(super) fn folds<'f>(&self, variant: &'f Variant) -> Result<Vec<Fold<'f>>, RefineError> {
        let nothing = || RefineError::Data("a fold has no sample".into());
        let one = |fold: usize| {
            let inside = |trial: usize| self.training.len() == 1 || self.fold_of(trial) != fold;
            let training = merged(&variant.moments, inside).ok_or_else(nothing)?;
            let left_out = merged(&variant.moments, |trial| self.fold_of(trial) == fold).ok_or_else(nothing)?;
            Ok(Fold::new(&variant.blocks, &variant.model, &training, &left_out))
        };
        (0..self.fold_count()).map(one).collect()
    }

    /// The same strength for every acceleration but roll's: of roll a source of the plane says nothing, so that its strength
    /// is the one with the greatest marginal likelihood on all training samples. Windows left out would do only where
    /// every fold keeps something that excites roll.
    pub(super) fn common_choices(&self, variant: &Variant, lambda: f64) -> Result<Choices, RefineError> {
        let rolls = variant.blocks.blocks.iter().any(|block| block.axes.contains(&Axis::K));
        let free = Range { lambda_min: 1e-9, lambda_max: 1.0, alpha_max: 0.0 };
        let tuned = if rolls {
            let all = merged(&variant.moments, |_| true).ok_or_else(|| RefineError::Data("the trials have no sample".into()))?;
            most_likely(&variant.blocks, &all, &variant.model, &free, 50)
        } else {
            Choices::new()
        };
        let of_axis = |b: usize, (target, axis): (usize, &Axis)| match axis {
            Axis::K => tuned[b][target],
            _ => Choice { lambda, alpha: 0.0 },
        };
        let of_block = |b: usize| variant.blocks.blocks[b].axes.iter().enumerate().map(|axis| of_axis(b, axis)).collect();
        Ok((0..variant.blocks.blocks.len()).map(of_block).collect())
    }
}

/// The statistics of some trials together, one set per regression.
pub(super) fn merged(moments: &[Vec<Moments>], keep: impl Fn(usize) -> bool) -> Option<Vec<Moments>> {
    let kept: Vec<&Vec<Moments>> = moments.iter().enumerate().filter(|(trial, _)| keep(*trial)).map(|(_, m)| m).collect();
    let blocks = kept.first()?.len();
    (0..blocks).map(|block| Moments::sum(kept.iter().map(|m| &m[block]))).collect()
}
