//! Linear regressions of a law: groups of axes that the mass matrix couples, and the unknowns of
//! each regression.
//!
//! As published, accelerations are regressed: `acceleration = M^-1 (scale sum(c_i phi_i) + rest)`.
//! Axes that the mass matrix couples have their coefficients mixed by `M^-1`; where they have the
//! same terms, one common set of regressors serves all of them and the coefficients are unmixed
//! afterwards (Kanazawa 2023, Eqs. 5.9-5.10). Where their terms differ, the force on each axis is
//! regressed instead.

use std::borrow::Cow;

use nalgebra::{DMatrix, DVector};
use sistership_model::Model;
use sistership_model::coefficient::Axis;
use sistership_model::law::Law;
use sistership_simulation::equations::{EquationLowering, EquationsOfMotion};
use sistership_simulation::tape::Tape;

use super::outcome::RefineError;
use sistership_numerics::{PriorMetric, RegressionMoments};

/// One regression: its axes, the coefficients of each axis, and the outputs of the tape that hold
/// its parts.
#[derive(Debug, Clone)]
pub struct RegressionBlock {
    /// The axes it solves for.
    pub axes: Vec<Axis>,
    /// Names of the coefficients by axis; the same place in each is the same regressor.
    pub names: Vec<Vec<String>>,
    /// Outputs of the tape with the regressors, without scale, in the order of the names.
    pub(crate) terms: Vec<usize>,
    /// Precision of each regressor's prior as a multiple of the common one: more than 1 for
    /// deviations of submodels.
    pub shrinkage: Vec<f64>,
    /// Joint precision of the prior at strength 1, in the units of the regressors, where a source
    /// determines one.
    pub(crate) precision: Option<DMatrix<f64>>,
    /// Outputs with the scale, by axis.
    pub(crate) scales: Vec<usize>,
    /// Outputs with the rest, by axis.
    pub(crate) rests: Vec<usize>,
    /// Outputs with the rows of the mass matrix of these axes, over all coupled axes; none for
    /// zeros.
    pub(crate) mass: Vec<Vec<Option<usize>>>,
    /// The axes of the mass matrix' columns.
    pub(crate) columns: Vec<Axis>,
    /// Outputs with the accelerations that effects add to the axes of `columns`; none where they
    /// add nothing.
    pub(crate) additions: Vec<Option<usize>>,
    /// Matrix from the coefficients of the axes to the unknowns of the regression.
    pub mixing: DMatrix<f64>,
    /// Inverse of `mixing`: from the unknowns of the regression to the coefficients of the axes.
    pub(crate) unmixing: DMatrix<f64>,
}

/// All regressions of a law, and the tape that evaluates their parts.
#[derive(Debug, Clone)]
pub struct RegressionBlocks {
    /// The regressions.
    pub blocks: Vec<RegressionBlock>,
    pub(crate) tape: Tape,
    /// Inputs of the tape after the states, with their defaults.
    pub(crate) inputs: Vec<(String, Option<f64>)>,
}

impl RegressionBlocks {
    /// Creates the regressions for the coefficients that a source model has.
    ///
    /// # Errors
    /// Returns an error with the quantity that the model lacks, or the coefficient that the law
    /// does not have.
    pub fn new(model: &Model, law: &Law) -> Result<Self, RefineError> {
        let equations = EquationsOfMotion::from_law(model, Cow::Borrowed(law));
        if let Some(blocks) = Self::from_equations(&equations, true)? {
            return Ok(blocks);
        }
        // Mass or scales change during a run: there is no constant mixture to undo, so forces are
        // regressed.
        let forces = Self::from_equations(&equations, false)?;
        forces.ok_or_else(|| {
            RefineError::Law(format!(
                "law `{}` is not linear in its coefficients \
                                                       and cannot be regressed; choose the method \
                                                       `trajectory` or `cma-es`",
                law.name
            ))
        })
    }

    /// The regressions of some equations; axes are solved together only where `allow_common`.
    /// `None` if the mixing matrix of a common regression is not constant.
    fn from_equations(
        equations: &EquationsOfMotion<'_>,
        allow_common: bool,
    ) -> Result<Option<Self>, RefineError> {
        let names = equations.tape_input_names();
        let mut lowering = EquationLowering::new(equations, &names);
        let mut blocks = Vec::new();
        for group in coupled_groups(equations.law()) {
            for axes in split_group(equations, &group, allow_common) {
                blocks.extend(build_block(equations, &mut lowering, axes, &group)?);
            }
        }
        let tape = lowering.finish();
        // The mixing matrices need the finished tape, on which mass and scales are evaluated.
        for block in &mut blocks {
            let Some(mixing) = mixing_matrix(block, &tape, names.len()) else { return Ok(None) };
            block.unmixing =
                invert_mixing(&mixing).ok_or_else(|| singular_error(equations.law(), block))?;
            block.mixing = mixing;
        }
        Ok(Some(Self { blocks, tape, inputs: equations.law_inputs() }))
    }
}

/// Groups of axes that the mass matrix couples.
fn coupled_groups(law: &Law) -> Vec<Vec<Axis>> {
    let mut groups: Vec<Vec<Axis>> = Vec::new();
    for axis in law.axes.keys().copied() {
        let touches = |group: &Vec<Axis>| {
            group
                .iter()
                .any(|&o| law.mass.contains_key(&(axis, o)) || law.mass.contains_key(&(o, axis)))
        };
        // An axis joins all groups that it touches into one: connected components of the coupling.
        let (mut joined, apart): (Vec<_>, Vec<_>) = groups.into_iter().partition(touches);
        let mut group: Vec<Axis> = joined.drain(..).flatten().collect();
        group.push(axis);
        groups = apart;
        groups.push(group);
    }
    groups
}

/// The part of a coefficient's name after its axis.
fn term_suffix(name: &str) -> &str {
    name.split_once('_').map_or(name, |(_, suffix)| suffix)
}

/// Splits a group into the sets of axes that are solved together: the whole group if its axes have
/// the same terms, else single axes.
fn split_group(
    equations: &EquationsOfMotion<'_>,
    group: &[Axis],
    allow_common: bool,
) -> Vec<Vec<Axis>> {
    let terms = |axis: Axis| -> Vec<_> {
        let term =
            |name: &String| (term_suffix(name).to_owned(), equations.unscaled_regressor(name).ok());
        equations.axis_coefficients(axis).map(term).collect()
    };
    // Terms are the same if they have the same names after the axis and the same formulas.
    let same = allow_common && group.windows(2).all(|pair| terms(pair[0]) == terms(pair[1]));
    if same { vec![group.to_vec()] } else { group.iter().map(|&axis| vec![axis]).collect() }
}

/// The regression of some axes of a group; `None` if they have no coefficients. Mixing matrices are
/// the identity here, since they can be evaluated only on the finished tape.
fn build_block(
    equations: &EquationsOfMotion<'_>,
    lowering: &mut EquationLowering<'_>,
    axes: Vec<Axis>,
    group: &[Axis],
) -> Result<Option<RegressionBlock>, RefineError> {
    let law = equations.law();
    let names: Vec<Vec<String>> =
        axes.iter().map(|&axis| equations.axis_coefficients(axis).cloned().collect()).collect();
    if names[0].is_empty() {
        return Ok(None);
    }
    // Axes of a common regression have the same terms: those of the first axis serve all.
    let mut terms = Vec::new();
    for name in &names[0] {
        terms.push(lowering.add_output(&equations.unscaled_regressor(name)?)?);
    }
    let scales = axes
        .iter()
        .map(|axis| lowering.add_output(&law.axes[axis].scale))
        .collect::<Result<_, _>>()?;
    let rests = axes
        .iter()
        .map(|axis| lowering.add_output(&law.axes[axis].rest))
        .collect::<Result<_, _>>()?;
    let mut mass = Vec::new();
    for &axis in &axes {
        mass.push(
            group
                .iter()
                .map(|&other| lowering.add_mass_entry(axis, other))
                .collect::<Result<Vec<_>, _>>()?,
        );
    }
    let unmixed = DMatrix::identity(axes.len(), axes.len());
    let additions = lowering.add_effect_accelerations(group)?;
    let shrinkage = names[0]
        .iter()
        .map(|name| law.deviation_submodel(name).map_or(1.0, |submodel| submodel.shrinkage))
        .collect();
    Ok(Some(RegressionBlock {
        axes,
        names,
        terms,
        shrinkage,
        precision: None,
        scales,
        rests,
        mass,
        columns: group.to_vec(),
        mixing: unmixed.clone(),
        unmixing: unmixed,
        additions,
    }))
}

impl RegressionBlock {
    /// Number of regressors.
    pub fn regressor_count(&self) -> usize {
        self.terms.len()
    }

    /// Number of columns of its table: regressors, then targets.
    pub(crate) fn column_count(&self) -> usize {
        self.regressor_count() + self.axes.len()
    }

    /// Metric of its prior: the joint precision where a source determines one, else the sizes of
    /// the regressors in `moments`.
    pub(crate) fn prior_metric(&self, moments: &RegressionMoments) -> PriorMetric {
        let earned = self.precision.as_ref().and_then(PriorMetric::of_precision);
        earned.unwrap_or_else(|| PriorMetric::of_regressors(moments, &self.shrinkage))
    }

    /// Variance of each regressor over an envelope, or over the trials where that is larger, times
    /// its shrinkage.
    pub(super) fn regressor_sizes(
        &self,
        envelope: &RegressionMoments,
        trials: &RegressionMoments,
    ) -> DVector<f64> {
        let moves = |j: usize| envelope.regressor_variance(j).max(trials.regressor_variance(j));
        DVector::from_fn(self.regressor_count(), |j, _| self.shrinkage[j] * moves(j))
    }

    /// Returns true if the force on one axis of a coupled group is regressed, not the
    /// accelerations.
    pub(crate) fn is_force(&self) -> bool {
        self.axes.len() < self.columns.len()
    }
}

/// The inverse of a mixing matrix; none where it is singular.
fn invert_mixing(mixing: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    let (rows, columns) = mixing.shape();
    let inverse = mixing.clone().lu().solve(&DMatrix::identity(rows, columns))?;
    inverse.iter().all(|value| value.is_finite()).then_some(inverse)
}

/// The error for a mixing matrix that has no inverse.
fn singular_error(law: &Law, block: &RegressionBlock) -> RefineError {
    let axes: Vec<String> = block.axes.iter().map(|axis| format!("{axis:?}")).collect();
    RefineError::Law(format!(
        "the coefficients of the axes {} of law `{}` cannot be determined: the mass matrix with \
         the scales of these axes is singular; check the scales in the law, and mass, inertia and \
         added masses of the ship",
        axes.join(", "),
        law.name
    ))
}

/// The mixing matrix `M^-1 diag(scale_k / scale_0)`; the scale of the first axis stays in the
/// regressors. `None` if it is not constant.
fn mixing_matrix(block: &RegressionBlock, tape: &Tape, inputs: usize) -> Option<DMatrix<f64>> {
    let q = block.axes.len();
    if q == 1 {
        return Some(DMatrix::identity(1, 1));
    }
    let entry =
        |output: Option<usize>| output.map_or(Some(0.0), |output| tape.constant_output(output));
    let mut mass = DMatrix::zeros(q, q);
    for (row, column) in (0..q).flat_map(|row| (0..q).map(move |column| (row, column))) {
        mass[(row, column)] = entry(block.mass[row][column])?;
    }
    // Ratios of scales are compared at two arbitrary inputs without special values; scales that are
    // proportional give the same ratios at both.
    let ratios = |at: f64| {
        let values =
            tape.evaluate_point(&(0..inputs).map(|i| at + 0.1 * i as f64).collect::<Vec<f64>>());
        DVector::from_iterator(
            q,
            block.scales.iter().map(|&scale| values[scale] / values[block.scales[0]]),
        )
    };
    let (here, there) = (ratios(0.7), ratios(1.9));
    let constant = here.iter().zip(there.iter()).all(|(a, b)| (a - b).abs() <= 1e-9 * a.abs());
    if !constant {
        return None;
    }
    mass.lu().solve(&DMatrix::from_diagonal(&here))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use sistership_model::Zoo;

    use super::*;

    #[test]
    fn a_mixture_that_cannot_be_undone_is_refused_with_its_axes() {
        let regular = DMatrix::from_row_slice(2, 2, &[2.0, 1.0, 1.0, 1.0]);
        let one = invert_mixing(&regular).unwrap() * &regular;
        assert!((one - DMatrix::identity(2, 2)).amax() < 1e-12);
        assert!(invert_mixing(&DMatrix::from_row_slice(2, 2, &[1.0, 2.0, 2.0, 4.0])).is_none());
        assert!(invert_mixing(&DMatrix::from_row_slice(1, 1, &[f64::NAN])).is_none());
        let zoo = Zoo::load_embedded().unwrap();
        let law = zoo.law("abkowitz").unwrap();
        let blocks = RegressionBlocks::new(&zoo.find_model("mariner").unwrap(), law).unwrap();
        let coupled = blocks.blocks.iter().find(|block| block.axes.len() == 2).unwrap();
        let refusal = singular_error(law, coupled).to_string();
        assert!(refusal.contains("axes Y, N of law `abkowitz`"), "{refusal}");
    }
}
