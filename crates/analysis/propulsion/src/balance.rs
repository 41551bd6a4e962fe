//! The surge balance of a model, from its trials and prior knowledge of the ship.
//!
//! The self-propulsion point is that of the trials. With `s` the ratio of the advance ratio there
//! to that of zero thrust and `c` the tangent of the advance angle, the derivative of surge by the
//! speed there is `-(R/u)(2/(1 + h^4) + s/(1 - s) - c^2/(1 + c^2))`, `h` the speed by that of the hump
//! of the resistance: the derivative from the trials gives the
//! resistance `R`, and the estimate from particulars gives it beforehand. Both are weighted by
//! their precision.

use std::collections::BTreeMap;

use sistership_model::propulsion::Propulsion;
use sistership_model::quantity::Quantity;
use sistership_model::{Law, Model, Trial, particulars};

use crate::covered::{
    ApproachEngine, CoveredRange, covered_orders, covered_speed_ratios, covered_speeds,
    covered_turning,
};
use crate::slope::{UncertainValue, surge_derivative};
use crate::straight_surge::StraightSurge;
use crate::thresholds::BALANCE;
use crate::waves::{MovingHull, hump_ratio};

/// Evidence on a model's propulsion.
#[derive(Debug, Clone, Copy)]
pub struct PropulsionEvidence<'a> {
    /// The model, with its posterior where there is one.
    pub model: &'a Model,
    /// Its law.
    pub law: &'a Law,
    /// Source of the refinement, transferred to the ship by a law with a propeller of its own.
    pub source: Option<SourcePropeller<'a>>,
    /// Estimate of the ship from its particulars, of the law `mmg`.
    pub estimate: Option<&'a Model>,
    /// Trials on which it was fitted.
    pub trials: &'a [&'a Trial],
}

/// A source model of a law with a propeller of its own.
#[derive(Debug, Clone, Copy)]
pub struct SourcePropeller<'a> {
    /// The source, transferred to the ship.
    pub model: &'a Model,
    /// Its law.
    pub law: &'a Law,
}

/// The propeller at the self-propulsion point.
#[derive(Debug, Clone, Copy)]
struct SelfPropulsionPoint {
    /// Advance ratio relative to that of zero thrust.
    loading: f64,
    /// `J/(0.7 pi)`.
    advance: f64,
    source: &'static str,
}

const TYPICAL: &str = "typical value (no estimate from particulars)";
const OF_SOURCE: &str = "propeller and resistance of the source";
const ESTIMATED: &str = "estimated from particulars";
const TRIALS: &str = "self-propulsion point of the trials";
const RANGE: &str = "range of the trials";
const CHOSEN: &str = "docs/evidence/propulsion.md";

/// Returns the balance of a model; `None` if its speed or revolutions at the approach, or its
/// length, are not known.
pub fn model_balance(of: &PropulsionEvidence<'_>) -> Option<Propulsion> {
    let approach = of.model.speed_m_s.filter(|speed| *speed > 0.0)?;
    let n_rps = of.model.revolutions_rps.filter(|n_rps| *n_rps > 0.0)?;
    let speed = steady_speed(of, [approach, n_rps]);
    let working = working_point(of);
    let mut parameters: BTreeMap<String, Quantity> = BTreeMap::new();
    let mut add = |name: &str, quantity| parameters.insert(name.to_owned(), quantity);
    add("resistance", approach_resistance(of, working, [speed, n_rps])?);
    add("speed", Quantity::new(speed, TRIALS));
    add("revolutions", Quantity::new(n_rps, TRIALS));
    add("loading", Quantity::new(working.loading, working.source));
    add("advance", Quantity::new(working.advance, working.source));
    let hump = known_particular(of, "lpp_m").map_or(0.0, |length_m| hump_ratio(length_m, speed));
    add("hump", Quantity::new(hump, CHOSEN));
    add("backing", Quantity::new(BALANCE.backing, CHOSEN));
    // The engine's response is by the speed of the approach.
    let loss = of.model.revolutions_loss.unwrap_or(0.0) * speed / approach;
    add("loss", Quantity::new(loss, TRIALS));
    let engine = ApproachEngine { speed_m_s: speed, n_rps, loss };
    let [seen_from, seen_to] = covered_speed_ratios(of.trials, [speed, n_rps]);
    let [v_to, r_to] = covered_turning(of.trials, speed);
    let takes = f64::from(u8::from(of.law.inputs.contains_key("n")));
    let covered = [
        ("seen_from", seen_from),
        ("seen_to", seen_to),
        ("v_to", v_to),
        ("r_to", r_to),
        ("takes_revolutions", takes),
    ];
    for (name, value) in covered {
        add(name, Quantity::new(value, RANGE));
    }
    add_range(&mut parameters, "order", covered_orders(of.trials, engine));
    add_range(&mut parameters, "u", covered_speeds(of.trials, approach));
    Some(Propulsion { parameters })
}

/// The self-propulsion point of the source, else of the estimate, else a typical one.
fn working_point(of: &PropulsionEvidence<'_>) -> SelfPropulsionPoint {
    let source = of.source.and_then(|source| self_propulsion_point(source.model, OF_SOURCE));
    let estimated = || self_propulsion_point(of.estimate?, ESTIMATED);
    source.or_else(estimated).unwrap_or(SelfPropulsionPoint {
        loading: BALANCE.loading,
        advance: BALANCE.advance,
        source: TYPICAL,
    })
}

/// Returns the speed at which the model is steady at the revolutions of the approach, within the
/// speeds of the trials: trials at low speed need not begin in a steady motion. The speed of the
/// approach if the model has none.
fn steady_speed(of: &PropulsionEvidence<'_>, [approach_m_s, n_rps]: [f64; 2]) -> f64 {
    let [_, from, to, _] = covered_speeds(of.trials, approach_m_s);
    let surge = StraightSurge::new(of.model, of.law, n_rps).ok();
    let steady = surge.and_then(|surge| surge.steady_speed([from.max(0.5 * approach_m_s), to]));
    steady.unwrap_or(approach_m_s)
}

/// Returns true if only the trials determine the effect of the propeller: the law takes no
/// revolutions, or coefficients multiply them. A law of several actuators has their thrust in all
/// quadrants.
pub fn needs_balance(law: &Law) -> bool {
    let is_one = law.helm_inputs().next().is_none();
    is_one && (law.factors.contains_key("n") || !law.inputs.contains_key("n"))
}

fn add_range(parameters: &mut BTreeMap<String, Quantity>, of: &str, range: CoveredRange) {
    let names = ["none_below", "full_from", "full_to", "none_above"];
    for (name, value) in names.into_iter().zip(range) {
        parameters.insert(format!("{of}_{name}"), Quantity::new(value, RANGE));
    }
}

/// The self-propulsion point of a model by its parameters, where thrust and resistance balance;
/// `None` if a quantity is missing.
fn self_propulsion_point(model: &Model, source: &'static str) -> Option<SelfPropulsionPoint> {
    let parameter = |name: &str| model.parameters.get(name).map(|quantity| quantity.value);
    let diameter_m = particulars::particular_value(&model.particulars, "propeller_diameter_m")?;
    let inflow = (1.0 - parameter("w_P0")?) * model.speed_m_s?;
    // Advance ratio `J = u_P / (n D)` at the model's approach.
    let ratio = inflow / (model.revolutions_rps? * diameter_m);
    let [k_0, k_1, k_2] = [parameter("k_0")?, parameter("k_1")?, parameter("k_2")?];
    // The smaller positive root of k_0 + k_1 J + k_2 J^2, which falls from k_0 above zero.
    let root = (k_1 * k_1 - 4.0 * k_0 * k_2).sqrt();
    let zero = 2.0 * k_0 / (root - k_1);
    let [least, most] = BALANCE.loadings;
    let loading = ratio / zero;
    (loading.is_finite() && loading > 0.0).then(|| SelfPropulsionPoint {
        loading: loading.clamp(least, most),
        advance: ratio / (0.7 * std::f64::consts::PI),
        source,
    })
}

/// Resistance at the self-propulsion point, N; `None` without the length of the ship.
fn approach_resistance(
    of: &PropulsionEvidence<'_>,
    working: SelfPropulsionPoint,
    at: [f64; 2],
) -> Option<Quantity> {
    let PriorResistance { known, waves } = prior_resistance(of, at[0])?;
    let SelfPropulsionPoint { loading, advance, source } = working;
    let square = advance * advance;
    let hump = known_particular(of, "lpp_m").map_or(0.0, |length_m| hump_ratio(length_m, at[0]));
    // The power of the speed with which the resistance rises falls from 2 to 0 about the hump.
    let power = 2.0 / (1.0 + hump.powi(4));
    let factor = power + loading / (1.0 - loading) - square / (1.0 + square);
    let of_slope = surge_derivative(of.model, of.law, at).map(|slope| {
        let (mean, by) = (-slope.mean * at[0] / factor, at[0] / factor);
        // The formula itself is uncertain by a share of the resistance, besides the posterior: the
        // slope of wave resistance is steep before the hump and level behind it.
        let own = BALANCE.slope_deviation.hypot(waves) * mean.abs().max(known.mean);
        UncertainValue { mean, deviation: (slope.deviation * by).hypot(own) }
    });
    // A resistance that is not positive is an error of the fit: the prior knowledge alone is used.
    let Some(fitted) = of_slope.filter(|figure| figure.mean > 0.0) else {
        return Some(value_quantity(known, format!("{source}; not determined by the trials")));
    };
    let source = format!("{source}, and the surge damping in the trials");
    Some(value_quantity(weighted_mean(known, fitted), source))
}

/// Prior knowledge of the resistance, N, and the share of waves in it.
struct PriorResistance {
    known: UncertainValue,
    waves: f64,
}

fn value_quantity(figure: UncertainValue, source: String) -> Quantity {
    Quantity { standard_error: Some(figure.deviation), ..Quantity::new(figure.mean, source) }
}

/// The mean of two figures, weighted by their precisions.
fn weighted_mean(a: UncertainValue, b: UncertainValue) -> UncertainValue {
    let [p, q] = [a, b].map(|figure| figure.deviation.powi(-2));
    UncertainValue { mean: (p * a.mean + q * b.mean) / (p + q), deviation: (p + q).powf(-0.5) }
}

/// Prior knowledge of the resistance; `None` without the length of the ship.
fn prior_resistance(of: &PropulsionEvidence<'_>, speed_m_s: f64) -> Option<PriorResistance> {
    let (level, waves) = (known_resistance(of, speed_m_s)?, known_waves(of, speed_m_s));
    let share = waves.mean / (waves.mean + level.mean);
    // A source makes the waves of its own speed, which the resistance of a fast ship is not.
    let source = of.source.filter(|_| share < 0.5);
    let known = match source.and_then(|source| source_resistance(source, speed_m_s)) {
        Some(source) => source,
        None => UncertainValue {
            mean: level.mean + waves.mean,
            deviation: level.deviation.hypot(waves.deviation),
        },
    };
    Some(PriorResistance { known, waves: share })
}

/// Resistance of the source by its coefficient `X_0`, N; `None` if its law has none.
fn source_resistance(source: SourcePropeller<'_>, speed_m_s: f64) -> Option<UncertainValue> {
    let n_rps = source.model.revolutions_rps?;
    let surge = StraightSurge::new(source.model, source.law, n_rps).ok()?;
    let place = surge.coefficients.iter().position(|name| name == "X_0")?;
    let x_0 = source.model.coefficients.get("X_0")?.value;
    let mean = -x_0 * surge.terms(speed_m_s)[place];
    let deviation = BALANCE.estimate_deviation * mean;
    (mean > 0.0).then_some(UncertainValue { mean, deviation })
}

/// Value of a particular of the model, else of the estimate.
fn known_particular(of: &PropulsionEvidence<'_>, name: &str) -> Option<f64> {
    let particulars =
        [Some(&of.model.particulars), of.estimate.map(|estimate| &estimate.particulars)];
    particulars.into_iter().flatten().find_map(|own| particulars::particular_value(own, name))
}

fn water_density(of: &PropulsionEvidence<'_>) -> f64 {
    known_particular(of, "water_density_kg_m3").unwrap_or(1025.0)
}

/// Wave resistance, N; zero without the displacement.
fn known_waves(of: &PropulsionEvidence<'_>, speed_m_s: f64) -> UncertainValue {
    let value = |name: &str| known_particular(of, name).filter(|value| *value > 0.0);
    let hull = value("lpp_m").zip(value("displacement_m3"));
    hull.map_or(UncertainValue { mean: 0.0, deviation: 0.0 }, |(length_m, displacement_m3)| {
        let density_kg_m3 = water_density(of);
        MovingHull { length_m, displacement_m3, density_kg_m3, speed_m_s }.wave_resistance()
    })
}

/// Resistance without waves by the estimate, else a typical one, N; `None` without the length of the
/// ship.
fn known_resistance(of: &PropulsionEvidence<'_>, speed_m_s: f64) -> Option<UncertainValue> {
    let density = water_density(of);
    let length_m = known_particular(of, "lpp_m").filter(|length_m| *length_m > 0.0)?;
    let draught_m = known_particular(of, "draught_m").unwrap_or(0.05 * length_m);
    let unit = 0.5 * density * length_m * draught_m * speed_m_s.powi(2);
    let estimated = of.estimate.and_then(|estimate| estimate.coefficients.get("X_0"));
    Some(match estimated.filter(|x_0| x_0.value < 0.0) {
        Some(x_0) => {
            let mean = -x_0.value * unit;
            // The stated error of the regression, at least the usual one of estimates.
            let stated = x_0.standard_error.unwrap_or(0.0) * unit;
            UncertainValue { mean, deviation: stated.max(BALANCE.estimate_deviation * mean) }
        }
        None => {
            let mean = BALANCE.resistance * unit;
            UncertainValue { mean, deviation: 0.5 * mean }
        }
    })
}
