//! Estimate of a ship: a model of the law `mmg`, with its uncertainty.

use std::collections::BTreeMap;

use nalgebra::{DMatrix, DVector};
use sistership_model::estimated_particulars::ESTIMATED;
use sistership_model::law::Law;
use sistership_model::model::{DERIVED_SOURCE, ModelKind};
use sistership_model::particulars::Particulars;
use sistership_model::posterior::Posterior;
use sistership_model::quantity::Quantity;
use sistership_model::source::Source;
use sistership_model::vessel::{Status, Steering};
use sistership_model::{Model, Vessel};

use crate::estimates::LAW;
use crate::estimates::balance::StraightCourse;
use crate::estimates::combined::{CombinedEstimate, mixture_covariance};
use crate::estimates::error::EstimateError;
use crate::estimates::inputs::FormulaInputs;
use crate::estimates::library::RegressionLibrary;
use crate::estimates::limits;
use crate::estimates::particulars::complete_particulars;
use crate::estimates::propeller::ThrustParabola;

/// Particulars that regressions give where the ship does not state them.
const REPLACED: [&str; 6] = [
    "rudder_area_m2",
    "rudder_height_m",
    "propeller_diameter_m",
    "x_g_m",
    "yaw_gyradius_ratio",
    "propeller_pitch_ratio",
];
/// The particular that is estimated from the speed where it is not given.
const FULLNESS: &str = "block_coefficient";
/// Values that other formulas need.
const FIRST: [&str; 5] = ["m_x", "m_y", "J_z", "w_P0", "t_P"];
const PARAMETERS: [&str; 12] = [
    "C_1", "C_2", "x_P", "x_R", "t_R", "a_H", "x_H", "gamma_R", "l_R", "epsilon", "kappa",
    "f_alpha",
];
const COEFFICIENTS: [&str; 17] = [
    "X_0", "X_vv", "X_vr", "X_rr", "X_vvvv", "Y_v", "Y_r", "Y_vvv", "Y_vvr", "Y_vrr", "Y_rrr",
    "N_v", "N_r", "N_vvv", "N_vvr", "N_vrr", "N_rrr",
];
/// Source key of values that are chosen so that thrust and resistance balance.
const BALANCE: &str = "thrust-balance";

/// Uncertainty of one value, with its regressions.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct EstimateSpread {
    /// Name of the coefficient, parameter or particular.
    pub name: String,
    /// Estimate.
    pub mean: f64,
    /// Standard deviation.
    pub deviation: f64,
    /// Value of each regression.
    pub given: BTreeMap<String, f64>,
}

/// Estimate of a ship.
#[derive(Debug, Clone)]
pub struct ShipEstimate {
    /// Model with the status estimated; its posterior is that of the coefficients.
    pub model: Model,
    /// Particulars that the ship does not state, then parameters.
    pub(crate) around: Vec<CombinedEstimate>,
    pub(crate) around_covariance: DMatrix<f64>,
    pub(crate) coefficients: Vec<CombinedEstimate>,
    pub(crate) coefficients_covariance: DMatrix<f64>,
    pub(crate) thrust: ThrustCurve,
}

/// Thrust of a propeller by its pitch.
#[derive(Debug, Clone)]
pub(crate) struct ThrustCurve {
    series: crate::estimates::propeller::PropellerSeries,
    blades: Option<f64>,
}

impl ThrustCurve {
    pub(crate) fn thrust_at(&self, pitch_ratio: f64) -> ThrustParabola {
        self.series.fit_thrust(pitch_ratio.clamp(0.4, 1.4), self.blades)
    }
}

/// Estimates a ship at a speed.
///
/// # Errors
/// Returns an error that names the particulars that are missing.
pub fn estimate_ship(
    library: &RegressionLibrary,
    vessel: &Vessel,
    law: &Law,
    speed_m_s: f64,
) -> Result<ShipEstimate, EstimateError> {
    let ship = vessel.name();
    let mut particulars = vessel.particulars.clone();
    complete_particulars(&mut particulars, [FULLNESS]);
    let at = |particulars: &Particulars| apply_regressions(library, ship, particulars, speed_m_s);
    let RegressionResults { around, coefficients, blades } = at(&particulars)?;
    let [by_around, by_coefficients] = fullness_effect(&particulars, &at)?;
    // The error of an estimated block coefficient moves all values together: a rank-one term.
    let spread = |values: &[CombinedEstimate], effect: &DVector<f64>| {
        mixture_covariance(values) + effect * effect.transpose()
    };
    let mut estimate = ShipEstimate {
        model: empty_model(library, vessel, speed_m_s),
        around_covariance: spread(&around, &by_around),
        coefficients_covariance: spread(&coefficients, &by_coefficients),
        around,
        coefficients,
        thrust: ThrustCurve { series: library.series.clone(), blades },
    };
    estimate.fill_model(&particulars)?;
    estimate
        .model
        .check_against(law)
        .map_err(|(field, message)| EstimateError::Law(format!("{ship}: {field}: {message}")))?;
    Ok(estimate)
}

/// Values of all regressions for a ship.
struct RegressionResults {
    around: Vec<CombinedEstimate>,
    coefficients: Vec<CombinedEstimate>,
    blades: Option<f64>,
}

fn apply_regressions(
    library: &RegressionLibrary,
    ship: &str,
    particulars: &Particulars,
    speed_m_s: f64,
) -> Result<RegressionResults, EstimateError> {
    let mut inputs = FormulaInputs::new(ship, particulars, speed_m_s)?;
    let (mut around, mut coefficients) = (Vec::new(), Vec::new());
    // Particulars first: the formulas of parameters use them.
    for name in REPLACED {
        if inputs.get(name).is_none() {
            push_estimate(library, ship, &mut inputs, &mut around, name)?;
        }
    }
    // Between the steps: the next formulas use values that follow from the particulars.
    set_derived(&mut inputs);
    // In this order: later formulas use earlier values.
    for name in FIRST.into_iter().chain(PARAMETERS) {
        push_estimate(library, ship, &mut inputs, &mut around, name)?;
    }
    for name in COEFFICIENTS {
        push_estimate(library, ship, &mut inputs, &mut coefficients, name)?;
    }
    Ok(RegressionResults { around, coefficients, blades: inputs.get("propeller_blades") })
}

/// Changes of parameters and of coefficients by one standard error of an estimated block
/// coefficient; zero where it is stated.
fn fullness_effect(
    particulars: &Particulars,
    at: &dyn Fn(&Particulars) -> Result<RegressionResults, EstimateError>,
) -> Result<[DVector<f64>; 2], EstimateError> {
    let estimated = particulars.get(FULLNESS).filter(|one| one.source.starts_with(ESTIMATED));
    let error = estimated.and_then(|one| one.standard_error).unwrap_or(0.0);
    let moved = |by: f64| {
        let mut other = particulars.clone();
        other.get_mut(FULLNESS).into_iter().for_each(|one| one.value += by);
        at(&other)
    };
    // Central difference over one standard error to either side.
    let (fuller, finer) = (moved(error)?, moved(-error)?);
    let half = |more: &[CombinedEstimate], less: &[CombinedEstimate]| {
        let pairs = more.iter().zip(less).map(|(a, b)| 0.5 * (a.mean - b.mean));
        DVector::from_iterator(more.len(), pairs)
    };
    Ok([half(&fuller.around, &finer.around), half(&fuller.coefficients, &finer.coefficients)])
}

fn push_estimate(
    library: &RegressionLibrary,
    ship: &str,
    inputs: &mut FormulaInputs,
    into: &mut Vec<CombinedEstimate>,
    name: &str,
) -> Result<(), EstimateError> {
    let given = library.regression_values(name, &|name| inputs.get(name));
    let missing = || EstimateError::NotGiven { ship: ship.to_owned(), name: name.to_owned() };
    let mut combined = CombinedEstimate::from_regressions(name, given).ok_or_else(missing)?;
    // Limited before it becomes an input of other formulas.
    combined.mean = limits::clamp_parameter(name, combined.mean);
    inputs.set(name, combined.mean);
    into.push(combined);
    Ok(())
}

/// Sets values that follow from the estimated particulars.
fn set_derived(inputs: &mut FormulaInputs) {
    let of = |name: &str| inputs.get(name).unwrap_or(0.0);
    let (area, height, x_g, length) =
        (of("rudder_area_m2"), of("rudder_height_m"), of("x_g_m"), of("L"));
    inputs.set("x_G", x_g / length);
    inputs.set("rudder_aspect_ratio", height * height / area);
}

fn empty_model(library: &RegressionLibrary, vessel: &Vessel, speed_m_s: f64) -> Model {
    let mut sources: BTreeMap<String, Source> = vessel.file.sources.clone();
    for one in &library.regressions {
        sources.insert(one.name.clone(), one.source.clone());
    }
    sources.insert(library.series.name.clone(), library.series.source.clone());
    Model {
        kind: ModelKind::Model,
        name: format!("{}/estimate", vessel.name()),
        ship: vessel.name().to_owned(),
        law: LAW.to_owned(),
        status: Status::Estimated,
        note: Some("estimated from particulars by published regressions, not measured".into()),
        sources,
        speed_m_s: Some(speed_m_s),
        revolutions_rps: None,
        revolutions_loss: None,
        steering: estimated_steering(vessel),
        particulars: Particulars::new(),
        parameters: BTreeMap::new(),
        coefficients: BTreeMap::new(),
        effects: Vec::new(),
        uncertainty: None,
        posterior: None,
        validity: None,
        propulsion: None,
        branch: None,
    }
}

/// Steering gear of the ship where one of its models states it; otherwise that of SOLAS, scaled to
/// the ship's size.
fn estimated_steering(vessel: &Vessel) -> Steering {
    let stated = vessel.file.models.first().map(|model| model.steering.clone());
    // By Froude's law, a model of scale s turns the rudder sqrt(s) times as fast as its full-scale
    // ship.
    let scaled = || {
        let full = Steering::default();
        let scale = vessel.file.scale.unwrap_or(1.0);
        Steering { rate_deg_s: full.rate_deg_s * scale.sqrt(), ..full }
    };
    stated.unwrap_or_else(scaled)
}

impl ShipEstimate {
    /// Uncertainty of each value.
    pub fn value_spreads(&self) -> Vec<EstimateSpread> {
        let of = |values: &[CombinedEstimate], covariance: &DMatrix<f64>| -> Vec<EstimateSpread> {
            let spread = |(k, one): (usize, &CombinedEstimate)| EstimateSpread {
                name: one.name.clone(),
                mean: one.mean,
                deviation: covariance[(k, k)].sqrt(),
                given: one
                    .given
                    .iter()
                    .map(|given| (given.regression.clone(), given.value))
                    .collect(),
            };
            values.iter().enumerate().map(spread).collect()
        };
        let mut all = of(&self.coefficients, &self.coefficients_covariance);
        all.extend(of(&self.around, &self.around_covariance));
        all
    }

    /// Sets particulars, parameters and coefficients of the model to the means.
    fn fill_model(&mut self, stated: &Particulars) -> Result<(), EstimateError> {
        self.model.particulars = stated.clone();
        let around: Vec<f64> = self.around.iter().map(|one| one.mean).collect();
        let deviations: Vec<f64> =
            self.around_covariance.diagonal().iter().map(|variance| variance.sqrt()).collect();
        let quantity = |one: &CombinedEstimate, deviation: f64| {
            let mut quantity = Quantity::new(
                one.mean,
                one.leading_regression().map_or("", |given| &given.regression),
            );
            quantity.standard_error = Some(deviation);
            let names: Vec<&str> =
                one.given.iter().map(|given| given.regression.as_str()).collect();
            quantity.note = (names.len() > 1).then(|| format!("mean of {}", names.join(", ")));
            quantity
        };
        let model = with_around(&self.model, &self.around, &around, &|k| {
            quantity(&self.around[k], deviations[k])
        });
        self.model = model;
        for (k, one) in self.coefficients.iter().enumerate() {
            let deviation = self.coefficients_covariance[(k, k)].sqrt();
            self.model.coefficients.insert(one.name.clone(), quantity(one, deviation));
        }
        // After all parameters are set: the revolutions depend on them.
        self.model = self.balance_thrust(self.model.clone())?;
        self.model.posterior =
            Some(coefficient_posterior(&self.coefficients, &self.coefficients_covariance));
        Ok(())
    }

    /// Model with other particulars and parameters, in the order of `around`.
    pub(crate) fn with_values(&self, around: &[f64]) -> Model {
        with_around(&self.model, &self.around, around, &|k| Quantity::new(around[k], "draw"))
    }

    /// Model with the propeller's thrust and the revolutions that balance its resistance.
    pub(crate) fn balance_thrust(&self, mut model: Model) -> Result<Model, EstimateError> {
        let particular = |name: &str| {
            sistership_model::particulars::particular_value(&model.particulars, name).unwrap_or(0.0)
        };
        let parameter = |name: &str| model.parameters.get(name).map_or(0.0, |one| one.value);
        let speed_m_s = model.speed_m_s.unwrap_or(0.0);
        let thrust = self.thrust.thrust_at(particular("propeller_pitch_ratio"));
        let straight = StraightCourse {
            lpp_m: particular("lpp_m"),
            draught_m: particular("draught_m"),
            speed_m_s,
            x_0: model.coefficient("X_0"),
            t_p: parameter("t_P"),
            w_p0: parameter("w_P0"),
            diameter_m: particular("propeller_diameter_m"),
            thrust,
        };
        let revolutions = straight.revolutions_rps().ok_or_else(|| EstimateError::NoBalance {
            ship: model.ship.clone(),
            diameter_m: straight.diameter_m,
            speed_m_s,
        })?;
        model.revolutions_rps = Some(revolutions);
        // Thrust coefficients are those of the series at the ship's pitch ratio.
        for (name, value) in [("k_0", thrust.k_0), ("k_1", thrust.k_1), ("k_2", thrust.k_2)] {
            model.parameters.insert(name.into(), Quantity::new(value, "wageningen-b"));
        }
        if let Some(note) = &mut model.note
            && !note.contains(BALANCE)
        {
            note.push_str("; revolutions by thrust balance");
        }
        Ok(model)
    }
}

/// Assigns values of `around` to particulars or to parameters of the law.
fn with_around(
    base: &Model,
    around: &[CombinedEstimate],
    values: &[f64],
    quantity: &dyn Fn(usize) -> Quantity,
) -> Model {
    let mut model = base.clone();
    for (k, one) in around.iter().enumerate() {
        let of = || Quantity { value: values[k], ..quantity(k) };
        match one.name.as_str() {
            // The estimate is the same to both sides.
            "C_2" => insert_both(&mut model, ["C_2_plus", "C_2_minus"], &of),
            "gamma_R" => insert_both(&mut model, ["gamma_R_plus", "gamma_R_minus"], &of),
            name if REPLACED.contains(&name) => {
                let mut quantity = of();
                quantity.source = format!("{ESTIMATED}{}", quantity.source);
                model.particulars.insert(name.to_owned(), quantity);
            }
            name => {
                model.parameters.insert(name.to_owned(), of());
            }
        }
    }
    derive_parameters(&mut model);
    model
}

fn insert_both(model: &mut Model, names: [&str; 2], of: &dyn Fn() -> Quantity) {
    for name in names {
        model.parameters.insert(name.to_owned(), of());
    }
}

/// Sets parameters of the law that follow from particulars.
fn derive_parameters(model: &mut Model) {
    let of = |name: &str| {
        sistership_model::particulars::particular_value(&model.particulars, name).unwrap_or(0.0)
    };
    // A rudder lower than the propeller is entirely in the slipstream.
    let eta = (of("propeller_diameter_m") / of("rudder_height_m")).min(1.0);
    let derived = [
        ("m", of("mass_kg")),
        ("x_G", of("x_g_m")),
        ("k_zz", of("yaw_gyradius_ratio")),
        ("eta", eta),
    ];
    for (name, value) in derived {
        model.parameters.insert(name.to_owned(), Quantity::new(value, DERIVED_SOURCE));
    }
}

/// Covariance of the coefficients in the form of a model's posterior.
fn coefficient_posterior(values: &[CombinedEstimate], covariance: &DMatrix<f64>) -> Posterior {
    let deviations: Vec<f64> = covariance.diagonal().iter().map(|v| v.sqrt()).collect();
    let correlation = DMatrix::from_fn(values.len(), values.len(), |i, j| {
        covariance[(i, j)] / (deviations[i] * deviations[j])
    });
    // Without a Cholesky factor the coefficients are independent.
    let identity = || DMatrix::identity(values.len(), values.len());
    let root = correlation.cholesky().map_or_else(identity, |cholesky| cholesky.l());
    Posterior {
        names: values.iter().map(|one| one.name.clone()).collect(),
        values: values.iter().map(|one| one.mean).collect(),
        deviations,
        root_correlation: Posterior::format_rows(values.len(), &|i, j| root[(i, j)]),
    }
}
