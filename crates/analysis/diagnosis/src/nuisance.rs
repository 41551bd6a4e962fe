//! Free coefficients of a diagnosis, and their prior.

use std::collections::BTreeMap;
use std::sync::Arc;

use nalgebra::{DMatrix, DVector};
use sistership_formula::Expr;
use sistership_model::coefficient::{Axis, CoefficientName};
use sistership_model::effect::EffectForm;
use sistership_model::law::Law;
use sistership_model::trial::Channel;
use sistership_model::uncertainty::Uncertainty;
use sistership_model::{Effect, Model, Trial};

use super::coefficient_prior::CoefficientPrior;
use super::thresholds::THRESHOLDS;
use sistership_filtering::{FilterColumns, NuisanceColumn, NuisanceKind};
use sistership_identification::refine::RefineError;

/// Terms of a grammar that a model lacks, by name.
pub type TermForms = BTreeMap<String, Arc<EffectForm>>;

/// Terms of the library's grammars on trials: all that the model lacks.
pub fn missing_terms(
    model: &Model,
    law: &Law,
    effects: &[Arc<Effect>],
    trials: &[&Trial],
) -> Vec<(String, Arc<EffectForm>)> {
    let has = |channel: Channel| trials.iter().all(|trial| trial.channel(channel).is_some());
    let axes: Vec<Axis> = law.axes.keys().copied().collect();
    let known = |name: &str| model.coefficients.contains_key(name);
    let of = |effect: &Arc<Effect>| -> Vec<(String, Arc<EffectForm>)> {
        let forms = effect
            .grammar
            .as_ref()
            .map(|grammar| grammar.list_forms(&axes, &known, &has))
            .unwrap_or_default();
        forms.into_iter().map(|form| (effect.name.clone(), form)).collect()
    };
    effects.iter().flat_map(of).collect()
}

/// Terms that are learned together with the coefficients: all of the grammars, and a constant on
/// each axis. They include what the law's own form cannot follow on clean trials, so that it is not
/// attributed to an effect later.
pub fn learned_terms(
    model: &Model,
    law: &Law,
    effects: &[Arc<Effect>],
    trials: &[&Trial],
) -> TermForms {
    let axes: Vec<Axis> = law.axes.keys().copied().collect();
    let known = |name: &str| model.coefficients.contains_key(name);
    let constants = effects
        .iter()
        .filter_map(|effect| effect.grammar.as_ref())
        .flat_map(|g| g.constant_forms(&axes, &known));
    let terms = missing_terms(model, law, effects, trials).into_iter().map(|(_, form)| form);
    terms.chain(constants).map(|form| (form.file.name.clone(), form)).collect()
}

/// Regressor of a term, in N (N m) per unit of its coefficient, in the names of a law.
pub fn term_regressor(model: &Model, form: &EffectForm) -> Option<(Axis, Expr)> {
    // A term acts on one axis and has one parameter.
    let (axis, force) = form.forces.iter().next()?;
    let speed = model.speed_m_s.or_else(|| {
        sistership_model::particulars::particular_value(&model.particulars, "service_speed_m_s")
    });
    let parameter = form.parameters.keys().next()?;
    // The approach speed is inserted as a number, and the coefficient is 1 in its regressor.
    let plain = |name: &str| match name {
        "approach_speed_m_s" => Some(Expr::Number(speed.unwrap_or(1.0))),
        name if name == parameter => Some(Expr::Number(1.0)),
        _ => None,
    };
    Some((*axis, force.replace_names(&plain)))
}

/// Prior of the coefficients before any trial: the model's own within a share of each, or of the
/// deviation that the grammar gives a term of its axis; terms that it lacks within the grammar's
/// deviation. Virtual masses are fixed: trials would seem to determine them, but would determine
/// the error of the law. Their uncertainty is part of the standard errors (`covariance`).
pub fn uncalibrated_prior(
    model: &Model,
    columns: &[NuisanceColumn],
    terms: &TermForms,
    slack: f64,
) -> CoefficientPrior {
    let of_axis = |axis: Axis| {
        let of = terms.values().find(|form| form.forces.contains_key(&axis));
        of.and_then(|form| form.parameters.values().next())
            .map_or(THRESHOLDS.calibration.fallback_deviation, |parameter| {
                parameter.prior_deviation
            })
    };
    let deviation = |nuisance: &NuisanceColumn| match nuisance.kind {
        NuisanceKind::Own(axis) => {
            // A coefficient near zero keeps a share of the usual deviation of its axis.
            slack
                * model
                    .coefficient(&nuisance.name)
                    .abs()
                    .max(THRESHOLDS.calibration.least_prior_share * of_axis(axis))
        }
        NuisanceKind::Lacked(axis) => slack * of_axis(axis),
        NuisanceKind::Mass(..) => THRESHOLDS.calibration.mass_prior,
    };
    let precisions = DVector::from_iterator(
        columns.len(),
        columns.iter().map(|nuisance| deviation(nuisance).powi(-2)),
    );
    CoefficientPrior {
        information: DMatrix::from_diagonal(&precisions),
        weighted_mean: DVector::zeros(columns.len()),
    }
}

/// Prior of the coefficients by the model's own trials, for the columns that it names.
///
/// # Errors
/// Returns the errors of [`Uncertainty::root`].
pub fn learned_prior(uncertainty: &Uncertainty) -> Result<CoefficientPrior, RefineError> {
    let rows =
        uncertainty.information_root().map_err(|error| RefineError::Law(error.to_string()))?;
    let size = rows.len();
    // The root is stored row by row from the diagonal, in units of the scales.
    let entry =
        |i: usize, j: usize| if j >= i { rows[i][j - i] / uncertainty.scales[j] } else { 0.0 };
    let root = DMatrix::from_fn(size, size, entry);
    let offset = DVector::from_column_slice(&uncertainty.offset);
    Ok(CoefficientPrior {
        information: root.transpose() * &root,
        weighted_mean: root.transpose() * offset,
    })
}

/// Columns of a model with an uncertainty: those that it names; otherwise its own coefficients.
pub fn model_columns(model: &Model, law: &Law) -> Vec<NuisanceColumn> {
    let own = FilterColumns::nuisance_columns(model, law, &[]);
    let Some(uncertainty) = &model.uncertainty else { return own };
    let of_model = |name: &str| own.iter().find(|nuisance| nuisance.name == name).cloned();
    let lacked = |name: &str| {
        let axis = CoefficientName::parse(name, &law.extra_factors()).ok()?.axis;
        Some(NuisanceColumn { name: name.to_owned(), kind: NuisanceKind::Lacked(axis) })
    };
    uncertainty.names.iter().filter_map(|name| of_model(name).or_else(|| lacked(name))).collect()
}
