//! The result of a refinement, with everything that its user must be able to defend.

use sistership_model::Model;
use sistership_model::estimated_particulars::describe_estimates;
use sistership_model::quantity::Quantity;

use super::candidate::CandidateFit;
use super::cma_es::SearchReport;
use super::outcome::{CoefficientChange, HeldOut, RefineError, Refinement, RefinementManoeuvres};
use super::problem::RefinementProblem;
use super::ridge::CoefficientFit;
use super::settings::RefinementSettings;
use super::simulated::simulate_all;
use super::thresholds::SELECTION;
use sistership_priors::rolling::roll_remark;

/// The chosen candidate among all, its model and its fit; no fit if the source was kept.
pub(super) struct ChosenCandidate {
    pub candidates: Vec<CandidateFit>,
    pub best: usize,
    pub model: Model,
    pub fitted: Option<CoefficientFit>,
    /// Fault of the model with the propeller stopped or reversed.
    pub propulsion_fault: Option<String>,
    /// Manoeuvre in which the model leaves the physical range, beyond the rudder angles of its
    /// trials.
    pub range_fault: Option<String>,
}

/// Builds the refinement from the chosen candidate.
///
/// # Errors
/// Returns an error if a trial lacks a channel.
pub(super) fn assemble_refinement(
    problem: &RefinementProblem<'_>,
    taken: ChosenCandidate,
    manoeuvres: RefinementManoeuvres,
) -> Result<Refinement, RefineError> {
    let ChosenCandidate { candidates, best, model, fitted, propulsion_fault, range_fault } = taken;
    let held_out = held_out_errors(problem, &candidates, best, &model)?;
    let lambdas = candidates[best].option.lambda.clone();
    let (condition_number, collinear_groups) = fitted
        .as_ref()
        .map_or((1.0, Vec::new()), |fit| (fit.condition_number, fit.collinear_groups.clone()));
    let mut remarks = refinement_remarks(problem, best, &lambdas);
    remarks.extend(model.propulsion.as_ref().map(sistership_propulsion::describe_balance));
    remarks.extend(propulsion_fault.map(|fault| format!("IMPLAUSIBLE propulsion: {fault}")));
    remarks.extend(range_fault.map(|fault| {
        format!(
            "OUTSIDE the rudder angles of the trials the model leaves the physical range: {fault}"
        )
    }));
    if candidates[best].search.is_some() {
        remarks.push(SEARCHED.to_owned());
    }
    // The report of a search is kept even if another candidate was chosen.
    let search = candidates[best]
        .search
        .clone()
        .or_else(|| candidates.iter().find_map(|one| one.search.clone()));
    Ok(Refinement {
        ship: problem.transferred.ship.clone(),
        source: problem.source.to_owned(),
        method: problem.settings.method.name().to_owned(),
        coefficients: coefficient_changes(problem, &model, fitted.as_ref()),
        model,
        transferred: problem.transferred.clone(),
        settings: reproducible_settings(&problem.settings, search.as_ref()),
        search,
        condition_number,
        collinear_groups,
        held_out,
        options: candidates.into_iter().map(|one| one.option).collect(),
        manoeuvres,
        remarks,
    })
}

/// The settings that reproduce the refinement: a search that ended by time gets the number of its
/// evaluations as its budget, since elapsed time cannot be reproduced.
fn reproducible_settings(
    settings: &RefinementSettings,
    search: Option<&SearchReport>,
) -> RefinementSettings {
    let mut settings = settings.clone();
    if let (Some(given), Some(search)) = (&mut settings.cma_es, search) {
        (given.evaluations, given.wall_s, given.cpu_s) = (search.evaluations, None, None);
    }
    settings
}

/// Errors of source and refined model on held-out trials, and how these were held out.
fn held_out_errors(
    problem: &RefinementProblem<'_>,
    candidates: &[CandidateFit],
    best: usize,
    model: &Model,
) -> Result<HeldOut, RefineError> {
    // Without trials that are kept out of the fit altogether, cross-validation has the errors.
    if problem.judged.is_empty() {
        // The text must not claim a cross-validation that a single trial does not allow.
        let how = if problem.training.len() == 1 {
            "a single trial cannot be held out: these are errors on the fitted trial".to_owned()
        } else {
            let what = match problem.whole.len() {
                whole if whole == problem.training.len() => format!("{whole} trials"),
                whole => format!("{} parts of {whole} trials", problem.training.len()),
            };
            format!(
                "each of {what} is simulated by a model fitted without it ({} folds)",
                problem.fold_count()
            )
        };
        return Ok(HeldOut {
            source: candidates[0].errors.rmse_by_channel(),
            refined: candidates[best].errors.rmse_by_channel(),
            how,
        });
    }
    let source =
        simulate_all(problem, &problem.judged, std::slice::from_ref(&problem.transferred), &|_| 0)?
            .total;
    let refined =
        simulate_all(problem, &problem.judged, std::slice::from_ref(model), &|_| 0)?.total;
    let names: Vec<&str> = problem.judged.iter().map(|trial| trial.name.as_str()).collect();
    Ok(HeldOut {
        source: source.rmse_by_channel(),
        refined: refined.rmse_by_channel(),
        how: format!("held out of fit and selection: {}", names.join(", ")),
    })
}

/// Change of every coefficient from the transferred source to the model.
fn coefficient_changes(
    problem: &RefinementProblem<'_>,
    model: &Model,
    fitted: Option<&CoefficientFit>,
) -> Vec<CoefficientChange> {
    let one = |(name, quantity): (&String, &Quantity)| {
        let source = problem.transferred.coefficient(name);
        let fitted = fitted.and_then(|fit| fit.coefficients.get(name));
        let prior = fitted.map_or(0.0, |f| f.prior_deviation);
        // The unit is for display only; a coefficient without a derivable dimension has none.
        let unit = problem
            .law
            .coefficient_dimension(name)
            .map_or_else(|_| "?".to_owned(), |d| d.to_string());
        CoefficientChange {
            name: name.clone(),
            unit,
            source,
            refined: quantity.value,
            standard_error: fitted.map_or(0.0, |f| f.standard_error),
            moved_sd: if prior > 0.0 { (quantity.value - source) / prior } else { 0.0 },
        }
    };
    let coefficients = model.coefficients.iter().map(one);
    coefficients.chain(parameter_changes(problem, fitted)).collect()
}

/// Change of every parameter that was fitted from the transferred source.
fn parameter_changes<'a>(
    problem: &'a RefinementProblem<'_>,
    fitted: Option<&'a CoefficientFit>,
) -> impl Iterator<Item = CoefficientChange> + 'a {
    let all = fitted.into_iter().flat_map(|fit| &fit.parameters);
    all.filter_map(move |(name, fitted)| {
        let source = problem.transferred.parameters.get(name)?.value;
        Some(CoefficientChange {
            name: name.clone(),
            unit: problem.law.parameters.get(name)?.unit.clone(),
            source,
            refined: fitted.value,
            standard_error: fitted.standard_error,
            moved_sd: (fitted.value - source) / fitted.prior_deviation,
        })
    })
}

/// Remarks for the reader of the refinement.
fn refinement_remarks(
    problem: &RefinementProblem<'_>,
    best: usize,
    lambdas: &[f64],
) -> Vec<String> {
    let mut remarks = Vec::new();
    let strongest =
        problem.settings.ranges.iter().map(|range| range.lambda_max).fold(0.0, f64::max);
    if lambdas.iter().any(|lambda| *lambda > SELECTION.strongest_share * strongest) {
        let what = "the strongest prior allowed was selected for an acceleration: its \
                    coefficients are those of the source, all multiplied by 1 - alpha";
        remarks.push(format!("{what}; their standard errors are not meaningful"));
    }
    remarks.extend(problem.measure.describe_prior(&problem.transferred, problem.law));
    remarks.extend(roll_remark(&problem.transferred));
    if best == 0 {
        remarks.push(
            "no option is better than the source on held-out manoeuvres: the source is kept \
             unchanged"
                .to_owned(),
        );
    }
    if problem.training.len() == 1 {
        remarks
            .push("there is only one trial: only the most conservative range was used".to_owned());
    }
    remarks.extend(describe_estimates(&problem.transferred.particulars));
    remarks
}

/// Remark on a search.
const SEARCHED: &str = "an evolutionary search gives no standard errors and no confidence bands; \
                        its fits without the held-out trials start at the optimum of all trials, \
                        so that held-out errors are somewhat too small unless the budget is large";
