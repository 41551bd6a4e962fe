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
    /// The source's share of `hessian`.
    pub of_source: DMatrix<f64>,
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
        Self { hessian, weak: weak.into(), of_source, source: source.into() }
    }

    /// Returns the prior with the unknowns of parameters after the coefficients; the weak form
    /// keeps the source's values.
    pub(super) fn with_parameters(self, parameters: &[BoundedParameter]) -> Self {
        let (first, size) = (self.weak.len(), self.weak.len() + parameters.len());
        let mut prior = Self {
            hessian: self.hessian.resize(size, size, 0.0),
            of_source: self.of_source.resize(size, size, 0.0),
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
            inverse[(k, k)].sqrt() * scales[k] / (pull + source_pull(pull)).sqrt()
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
