//! The prior of the trajectory form: the weak form, and the source that is its prior.

use std::collections::BTreeMap;

use nalgebra::{DMatrix, DVector};

use super::super::blocks::{RegressionBlock, RegressionBlocks};
use super::parameters::BoundedParameter;
use super::thresholds::TRAJECTORY;
use sistership_numerics::RegressionMoments;

/// The prior by the weak form, as the minimum and the Hessian of its cost, and by the source.
#[derive(Debug, Clone)]
pub(in super::super) struct WeakFormPrior {
    /// Half the second derivative of the weak form's cost, each acceleration divided by its mean
    /// square; it includes the source's share.
    pub hessian: DMatrix<f64>,
    pub weak: DVector<f64>,
    /// The source's share of `hessian`, or its own where the weak form is no prior.
    pub of_source: DMatrix<f64>,
    /// True if the weak form is a prior, within which the source has its share.
    has_weak_form: bool,
    source: DVector<f64>,
}

impl WeakFormPrior {
    /// Creates the prior for the coefficients `names` from the statistics of the weak form, with
    /// the strength `lambda` of the source; `values` gives the weak form's coefficient and the
    /// source's.
    pub fn new(
        names: &[String],
        blocks: &RegressionBlocks,
        moments: &[RegressionMoments],
        values: &dyn Fn(&str) -> (f64, f64),
        lambda: f64,
    ) -> Self {
        let place: BTreeMap<&str, usize> =
            names.iter().enumerate().map(|(k, name)| (name.as_str(), k)).collect();
        let size = names.len();
        let (mut hessian, mut of_source) = (DMatrix::zeros(size, size), DMatrix::zeros(size, size));
        for (block, moments) in blocks.blocks.iter().zip(moments) {
            let raw = moments.raw_products();
            // Targets follow the regressors: the diagonal there has the square of each
            // acceleration.
            let weights: Vec<f64> = (block.regressor_count()..raw.nrows())
                .map(|t| 1.0 / raw[(t, t)].max(f64::MIN_POSITIVE))
                .collect();
            add_block(&mut hessian, block, (&raw, &weights), &place);
            if let Some(precision) = &block.precision {
                add_block(&mut of_source, block, (precision, &weights), &place);
            }
        }
        for (block, name, shrinkage) in blocks.blocks.iter().flat_map(named_coefficients) {
            // Without a joint precision each coefficient is measured by its own curvature.
            if let (None, Some(&k)) = (&block.precision, place.get(name.as_str())) {
                of_source[(k, k)] = shrinkage * hessian[(k, k)];
            }
        }
        of_source *= lambda;
        hessian += &of_source;
        let (weak, source): (Vec<f64>, Vec<f64>) = names.iter().map(|name| values(name)).unzip();
        let (weak, source) = (weak.into(), source.into());
        Self { hessian, weak, of_source, has_weak_form: true, source }
    }

    /// Returns the prior with the unknowns of parameters after the coefficients; the weak form
    /// keeps the source's values.
    pub(super) fn with_parameters(self, parameters: &[BoundedParameter]) -> Self {
        let (first, size) = (self.weak.len(), self.weak.len() + parameters.len());
        let mut prior = Self {
            hessian: self.hessian.resize(size, size, 0.0),
            of_source: self.of_source.resize(size, size, 0.0),
            has_weak_form: self.has_weak_form,
            weak: self.weak.resize_vertically(size, 0.0),
            source: self.source.resize_vertically(size, 0.0),
        };
        for (k, parameter) in (first..).zip(parameters) {
            let precision = TRAJECTORY.parameter_share / parameter.unknown_deviation().powi(2);
            prior.hessian[(k, k)] = precision;
            prior.of_source[(k, k)] = precision;
            prior.weak[k] = parameter.source_unknown();
            prior.source[k] = parameter.source_unknown();
        }
        prior
    }

    /// Returns the prior by the source alone, with the deviations over ships of coefficients that
    /// have typical values and those of parameters. The weak form is then the start only: what it
    /// makes of noise and of a bias of instruments is no knowledge of the ship.
    pub(super) fn without_weak_form(
        mut self,
        names: &[String],
        deviations: &BTreeMap<String, f64>,
        parameters: &[BoundedParameter],
    ) -> Self {
        let typical = names.iter().map(|name| deviations.get(name).copied());
        let own = parameters.iter().map(|one| Some(one.unknown_deviation()));
        for (k, deviation) in typical.chain(own).enumerate() {
            if let Some(deviation) = deviation {
                self.of_source[(k, k)] = TRAJECTORY.typical_share / deviation.powi(2);
            }
        }
        self.hessian.fill(0.0);
        self.has_weak_form = false;
        self
    }

    /// Returns true if the weak form is a prior, which the strongest pull gives.
    pub(super) fn has_weak_form(&self) -> bool {
        self.has_weak_form
    }

    /// Strength of the source for a pull, within the weak form and directly.
    pub(super) fn source_strength(&self, pull: f64) -> f64 {
        if self.has_weak_form { pull + source_pull(pull) } else { source_pull(pull) }
    }

    /// Cost of one deviation of a typical ship for a pull; `None` where the weak form is a prior.
    pub(super) fn typical_strength(&self, pull: f64) -> Option<f64> {
        (!self.has_weak_form).then(|| TRAJECTORY.typical_share * source_pull(pull))
    }

    /// Returns its cost at coefficients, for a pull towards the weak form.
    pub fn cost(&self, at: &DVector<f64>, pull: f64) -> f64 {
        let (weak, source) = (at - &self.weak, at - &self.source);
        pull * weak.dot(&(&self.hessian * &weak))
            + source_pull(pull) * source.dot(&(&self.of_source * &source))
    }

    /// Adds its Hessian and gradient to normal equations.
    pub fn add_to_equations(
        &self,
        at: &DVector<f64>,
        pull: f64,
        hessian: &mut DMatrix<f64>,
        gradient: &mut DVector<f64>,
    ) {
        *hessian += &self.hessian * pull + &self.of_source * source_pull(pull);
        gradient.gemv(pull, &self.hessian, &(at - &self.weak), 1.0);
        gradient.gemv(source_pull(pull), &self.of_source, &(at - &self.source), 1.0);
    }

    /// Standard deviations of the coefficients by the source alone, within the weak form and
    /// directly, for an error of the motion of its own size.
    pub fn coefficient_deviations(&self, pull: f64) -> DVector<f64> {
        // Scaled to a diagonal of ones before it is inverted, since coefficients differ by orders
        // of magnitude.
        let scales = self.of_source.diagonal().map(|own| 1.0 / own.max(1e-300).sqrt());
        let unit = DMatrix::from_fn(scales.len(), scales.len(), |i, j| {
            self.of_source[(i, j)] * scales[i] * scales[j]
        });
        let free = DMatrix::identity(scales.len(), scales.len());
        let inverse = unit.cholesky().map_or(free, |root| root.inverse());
        DVector::from_fn(scales.len(), |k, _| {
            inverse[(k, k)].sqrt() * scales[k] / self.source_strength(pull).sqrt()
        })
    }
}

/// Pull of the source relative to its strength in the weak form, for a pull towards the weak form:
/// at most 1, and less where the weak form pulls little.
pub(super) fn source_pull(pull: f64) -> f64 {
    pull / (1.0 + pull)
}

/// Coefficients of a block, with the factor of the source's strength on each.
fn named_coefficients(
    block: &RegressionBlock,
) -> impl Iterator<Item = (&RegressionBlock, &String, f64)> {
    block.names.iter().flat_map(move |own| {
        own.iter().zip(&block.shrinkage).map(move |(name, factor)| (block, name, *factor))
    })
}

/// Adds the products of regressors, weighted by the effect of each coefficient on each
/// acceleration.
fn add_block(
    into: &mut DMatrix<f64>,
    block: &RegressionBlock,
    (products, weights): (&DMatrix<f64>, &[f64]),
    place: &BTreeMap<&str, usize>,
) {
    let placed = |names: &Vec<String>| {
        names.iter().map(|name| place.get(name.as_str()).copied()).collect::<Vec<_>>()
    };
    let places: Vec<Vec<Option<usize>>> = block.names.iter().map(placed).collect();
    for (a, rows) in places.iter().enumerate() {
        for (b, columns) in places.iter().enumerate() {
            let shared: f64 = weights
                .iter()
                .enumerate()
                .map(|(t, w)| w * block.mixing[(t, a)] * block.mixing[(t, b)])
                .sum();
            for (j, column) in columns.iter().enumerate() {
                for (i, row) in rows.iter().enumerate() {
                    let (Some(row), Some(column)) = (row, column) else { continue };
                    into[(*row, *column)] += shared * products[(i, j)];
                }
            }
        }
    }
}
