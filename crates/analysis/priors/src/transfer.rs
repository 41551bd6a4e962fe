//! Transfer of a source model to another ship.

use std::collections::BTreeSet;

use crate::estimated::estimated_parameter;

use crate::estimates::particulars::{complete_particulars, estimate_particular};
use sistership_formula::Expr;
use sistership_formula::units::Dimension;
use sistership_model::estimated_particulars::SCALED;
use sistership_model::law::Law;
pub use sistership_model::law::TrialApproach;
use sistership_model::model::{DERIVED_SOURCE, ModelKind};
use sistership_model::particulars::{self, Particulars};
use sistership_model::quantity::Quantity;
use sistership_model::trial::{Channel, Trial};
use sistership_model::vessel::Status;
use sistership_model::{Model, Vessel};
use sistership_simulation::{PlantError, Ship};

/// Source of a coefficient that has the typical value of its law.
pub const TYPICAL_SOURCE: &str = "typical value of the law";

/// Speeds within this share of the approach speed are on the approach.
pub(crate) const NEAR_APPROACH: f64 = 0.1;

/// Returns the approach of a set of trials: the median speed at their first samples, with the typical
/// revolutions of the trials that begin near that speed; where trials start from rest, the typical
/// speed and revolutions under way. `None` without velocities.
pub fn trial_approach(trials: &[&Trial]) -> Option<TrialApproach> {
    let mut starts: Vec<f64> = trials.iter().filter_map(|trial| start_speed(trial)).collect();
    let mut speeds: Vec<f64> = trials
        .iter()
        .flat_map(|trial| trial.channel(Channel::U).into_iter().flatten().copied())
        .collect();
    let (start, under_way) = (median_value(&mut starts)?, typical_value(&mut speeds)?);
    // Half of the speed under way separates a start from rest from a steady approach.
    let is_steady = start > 0.5 * under_way;
    let speed_m_s = if is_steady { start } else { under_way };
    // Slower trials have fewer revolutions, which do not belong to this approach.
    let is_near = |trial: &&&Trial| {
        let near = |start: f64| (start / speed_m_s - 1.0).abs() <= NEAR_APPROACH;
        !is_steady || start_speed(trial).is_some_and(near)
    };
    let mut revolutions: Vec<f64> =
        trials.iter().filter(is_near).flat_map(|trial| shaft_revolutions(trial)).collect();
    (speed_m_s > 0.0).then(|| TrialApproach {
        speed_m_s,
        n_rps: typical_value(&mut revolutions).filter(|n| *n > 0.0),
    })
}

/// Speed at the first sample, m/s.
fn start_speed(trial: &Trial) -> Option<f64> {
    Some(trial.channel(Channel::U)?.first()?.hypot(*trial.channel(Channel::V)?.first()?))
}

/// Revolutions of every shaft at every sample, 1/s.
fn shaft_revolutions(trial: &Trial) -> impl Iterator<Item = f64> {
    Channel::SHAFTS
        .into_iter()
        .flat_map(|shaft| trial.channel(shaft).into_iter().flatten().copied())
}

/// Median; the root mean square where trials stop, go astern or turn on the spot, so that the median
/// is near zero.
fn typical_value(values: &mut [f64]) -> Option<f64> {
    let mean_square =
        values.iter().map(|value| value * value).sum::<f64>() / values.len().max(1) as f64;
    let (median, rms) = (median_value(values)?, mean_square.sqrt());
    Some(if median > 0.5 * rms { median } else { rms })
}

/// Median; `None` of no values.
pub(crate) fn median_value(values: &mut [f64]) -> Option<f64> {
    let middle = values.len() / 2;
    (!values.is_empty()).then(|| *values.select_nth_unstable_by(middle, f64::total_cmp).1)
}

/// Transfers a source model to the target's particulars. Values that the law needs and the target
/// does not state are estimated, or scaled from the source by Froude's law, and marked so;
/// parameters with a unit that do not follow from particulars and the steering gear's rate are
/// scaled likewise.
pub fn transfer_model(
    source: &Model,
    law: &Law,
    target: &Vessel,
    approach: Option<TrialApproach>,
) -> Model {
    let ratio = length_ratio(source, target);
    let particulars = complete_for_law(law, target, Some(source));
    let service = particulars::particular_value(&particulars, "service_speed_m_s");
    let froude = source.speed_m_s.map(|speed| speed * ratio.sqrt());
    let speed = approach.map(|a| a.speed_m_s).or(service).or(froude);
    let mut model = source.transfer_to(law, target.name(), &particulars, speed);
    scale_parameters(&mut model, law, ratio);
    model.speed_m_s = speed;
    // Revolutions scale with 1/sqrt(length ratio), and then with the speed at constant advance
    // ratio.
    let scaled_n = source
        .revolutions_rps
        .zip(froude)
        .zip(speed)
        .map(|((n, froude), speed)| n / ratio.sqrt() * speed / froude);
    model.revolutions_rps = approach.and_then(|a| a.n_rps).or(scaled_n);
    // Under Froude's law angular rates scale with 1/sqrt(length ratio), times with its inverse.
    model.steering.rate_deg_s = source.steering.rate_deg_s / ratio.sqrt();
    model.steering.time_constant_s = source.steering.time_constant_s * ratio.sqrt();
    model.steering.source = Some(format!("scaled from {}", source.name));
    model
}

/// Scales the parameters with a unit that are still the source's by Froude's law.
fn scale_parameters(model: &mut Model, law: &Law, ratio: f64) {
    for (name, parameter) in law.parameters.iter().filter(|(_, one)| !one.is_approach_speed) {
        // Parameters that follow from the target's particulars are not the source's any more.
        let follows = law.derived_parameter(name, &model.particulars).is_some();
        if let Some(quantity) = model.parameters.get_mut(name).filter(|_| !follows) {
            quantity.value *= froude_factor(parameter.dimension, ratio);
        }
    }
}

/// Factor of a quantity by Froude's law, for ships whose lengths have a ratio.
fn froude_factor(dimension: Dimension, ratio: f64) -> f64 {
    ratio.powf(dimension.length + 3.0 * dimension.mass + 0.5 * dimension.time)
}

/// Ratio of the lengths of target and source; 1 where one is not known.
fn length_ratio(source: &Model, target: &Vessel) -> f64 {
    let there = particulars::particular_value(&source.particulars, "lpp_m");
    target.particular("lpp_m").zip(there).map_or(1.0, |(here, there)| here / there)
}

/// Error for a parameter of a law without a value.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("`{name}` of law `{law}` cannot be derived from the particulars of {ship}")]
pub struct UnknownParameter {
    /// The parameter.
    pub name: String,
    /// The law.
    pub law: String,
    /// The ship.
    pub ship: String,
}

/// Creates a model with zero coefficients, with values that the target does not state scaled from a
/// source.
///
/// # Errors
/// Returns an error that names a parameter of the law that does not follow from the particulars.
pub fn blank_from_source(
    law: &Law,
    target: &Vessel,
    source: &Model,
    approach: Option<TrialApproach>,
) -> Result<Model, UnknownParameter> {
    let particulars = complete_for_law(law, target, Some(source));
    fill_model(law, (target, &particulars), approach, &|name| same_parameter(law, name, source))
}

/// Parameter of a source with the same name, if it has no unit and so does not depend on size.
fn same_parameter(law: &Law, name: &str, source: &Model) -> Option<Quantity> {
    let is_bare = law.parameters.get(name).is_some_and(|parameter| parameter.unit == "1");
    let value = source.parameters.get(name).filter(|_| is_bare)?.value;
    Some(Quantity::new(value, format!("as of {}", source.name)))
}

/// Creates a model of a law for a ship of which only the particulars are known. Coefficients have the
/// law's typical values, with their deviation over ships as standard error; where it has none they
/// are zero, so that a prior with this mean is a plain ridge.
///
/// # Errors
/// Returns an error that names a parameter of the law that does not follow from the particulars.
pub fn blank_model(
    law: &Law,
    target: &Vessel,
    approach: Option<TrialApproach>,
) -> Result<Model, UnknownParameter> {
    let particulars = complete_for_law(law, target, None);
    let mut model = fill_model(law, (target, &particulars), approach, &|_| None)?;
    for (name, coefficient) in &mut model.coefficients {
        let Some(typical) = law.typical_value(name, &particulars, approach) else { continue };
        *coefficient = Quantity {
            standard_error: Some(typical.deviation),
            ..Quantity::new(typical.value, TYPICAL_SOURCE)
        };
    }
    Ok(model)
}

/// Creates a blank model; values that do not follow from the particulars are given by the caller,
/// or estimated.
fn fill_model(
    law: &Law,
    (target, particulars): (&Vessel, &Particulars),
    approach: Option<TrialApproach>,
    given: &dyn Fn(&str) -> Option<Quantity>,
) -> Result<Model, UnknownParameter> {
    let zero = |name: &String| (name.clone(), Quantity::new(0.0, "unknown"));
    let parameter = |name: &String| {
        // The law's approach speed is that of the trials.
        let own = if law.approach_speed_parameter() == Some(name) {
            approach.map(|a| a.speed_m_s)
        } else {
            None
        };
        // In this order: approach, particulars, the caller's value, a published estimate.
        let derived = own.or_else(|| law.derived_parameter(name, particulars));
        let value = derived.map(|value| Quantity::new(value, DERIVED_SOURCE));
        let value =
            value.or_else(|| given(name)).or_else(|| estimated_parameter(law, name, target));
        let unknown = || UnknownParameter {
            name: name.clone(),
            law: law.name.clone(),
            ship: target.name().to_owned(),
        };
        Ok((name.clone(), value.ok_or_else(unknown)?))
    };
    Ok(Model {
        kind: ModelKind::Model,
        name: format!("{}/{}", target.name(), law.name),
        ship: target.name().to_owned(),
        law: law.name.clone(),
        status: Status::Transferred,
        note: Some("no source: a law whose coefficients are fitted to the trials alone".to_owned()),
        sources: Default::default(),
        speed_m_s: approach
            .map(|a| a.speed_m_s)
            .or_else(|| particulars::particular_value(particulars, "service_speed_m_s")),
        revolutions_rps: approach.and_then(|a| a.n_rps),
        revolutions_loss: None,
        steering: Default::default(),
        particulars: particulars.clone(),
        parameters: law
            .parameters
            .keys()
            .map(parameter)
            .collect::<Result<_, UnknownParameter>>()?,
        coefficients: law.axes.values().flat_map(|axis| axis.terms.keys().map(zero)).collect(),
        effects: Vec::new(),
        uncertainty: None,
        posterior: None,
        validity: None,
        propulsion: None,
        branch: None,
    })
}

/// Particulars of the mass and its distribution in the plane: the ship's own, independent of the
/// source of its coefficients. Metacentric height and the radius in roll belong to the coefficients
/// of roll instead: ships scatter about their regression by half of it.
const LOADING: [&str; 6] = [
    "block_coefficient",
    "displacement_m3",
    "mass_kg",
    "x_g_m",
    "yaw_gyradius_ratio",
    "water_density_kg_m3",
];

/// Returns the target's particulars with those that a law needs and the target does not state: the
/// distribution of its mass by regressions; geometry scaled from the source whose coefficients
/// depend on it, and by regressions where the source does not state it either; values without a
/// regression are the source's.
pub fn complete_for_law(law: &Law, target: &Vessel, source: Option<&Model>) -> Particulars {
    let needed = needed_particulars(law);
    let (loading, geometry): (Vec<&str>, Vec<&str>) =
        needed.iter().map(String::as_str).partition(|name| LOADING.contains(name));
    let mut particulars = target.particulars.clone();
    // In this order: a loading by regression takes precedence over the source's, a geometry of the
    // source over one by regression.
    complete_particulars(&mut particulars, loading.iter().copied());
    for name in geometry.iter().chain(&loading) {
        scale_particular(&mut particulars, target, source, name);
    }
    complete_particulars(&mut particulars, geometry);
    particulars
}

/// Two ships scatter about a regression independently: their difference by the root of two.
const DIFFERENCE: f64 = std::f64::consts::SQRT_2;

fn scale_particular(
    particulars: &mut Particulars,
    target: &Vessel,
    source: Option<&Model>,
    name: &str,
) {
    let is_known = particulars::stated_value(particulars, name).is_some();
    let Some(source) = source.filter(|_| !is_known) else { return };
    let (Some(value), Some(dimension)) = (
        particulars::particular_value(&source.particulars, name),
        particulars::particular_dimension(name),
    ) else {
        return;
    };
    let value = value * froude_factor(dimension, length_ratio(source, target));
    let mut quantity = Quantity::new(value, format!("{SCALED}{}", source.name));
    // The scatter of the regression, or that of a common ratio where no regression applies.
    let scatter = estimate_particular(particulars, name).and_then(|one| one.standard_error);
    let scatter = scatter.unwrap_or(relative_scatter(dimension) * value.abs());
    quantity.standard_error = Some(DIFFERENCE * scatter);
    particulars.insert(name.to_owned(), quantity);
}

/// Scatter where no regression applies for lack of main dimensions: that of ships of the zoo about
/// a common ratio to a power of the length, 0.62 for displacements (34 ships), 0.13 to 0.30 for
/// diameters, heights and areas (17 to 22).
fn relative_scatter(dimension: Dimension) -> f64 {
    if dimension.length + 3.0 * dimension.mass > 2.5 { 0.62 } else { 0.3 }
}

/// Particulars that a law's formulas use, those of its parameters included.
fn needed_particulars(law: &Law) -> BTreeSet<String> {
    let axes =
        law.axes.values().flat_map(|axis| axis.terms.values().chain([&axis.scale, &axis.rest]));
    let parameters = law.parameters.values().filter_map(|parameter| parameter.from.as_ref());
    let formulas: Vec<&Expr> =
        law.values.values().chain(law.mass.values()).chain(axes).chain(parameters).collect();
    let names = formulas
        .into_iter()
        .flat_map(|expr| expr.mentioned_names().into_iter().map(str::to_owned).collect::<Vec<_>>());
    names.filter(|name| particulars::particular_dimension(name).is_some()).collect()
}

/// Prepares a ship whose envelope covers the speeds of the trials.
///
/// # Errors
/// Returns an error if the model cannot be simulated.
pub fn prepare_ship(model: &Model, law: &Law, trials: &[&Trial]) -> Result<Ship, PlantError> {
    widen_envelope(Ship::new(model, law), trials)
}

/// Prepares a ship whose envelope covers the speeds of the trials, for all models that have the
/// same names of coefficients.
///
/// # Errors
/// Returns an error if the model cannot be simulated.
pub fn prepare_sister_ships(
    model: &Model,
    law: &Law,
    trials: &[&Trial],
) -> Result<Ship, PlantError> {
    let mut ship = widen_envelope(Ship::with_open_coefficients(model, law), trials)?;
    ship.disable_excursions();
    Ok(ship)
}

fn widen_envelope(ship: Result<Ship, PlantError>, trials: &[&Trial]) -> Result<Ship, PlantError> {
    let mut ship = ship?;
    // The range covers astern speeds by their magnitude.
    let fastest = trials
        .iter()
        .flat_map(|t| t.channel(Channel::U).into_iter().flatten())
        .fold(0.0_f64, |a, b| a.max(b.abs()));
    ship.set_envelope_speed(fastest);
    Ok(ship)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_approach_has_the_revolutions_of_either_shaft() {
        let trial = |channels: [(Channel, f64); 3]| Trial {
            t_s: vec![0.0, 1.0],
            channels: channels.map(|(channel, value)| (channel, vec![value; 2])).into(),
            ..Trial::default()
        };
        let motion = |shaft| trial([(Channel::U, 1.5), (Channel::V, 0.0), (shaft, 18.0)]);
        for shaft in Channel::SHAFTS {
            let approach = trial_approach(&[&motion(shaft)]);
            assert_eq!(approach, Some(TrialApproach { speed_m_s: 1.5, n_rps: Some(18.0) }));
        }
        assert_eq!(trial_approach(&[&motion(Channel::Delta)]).and_then(|one| one.n_rps), None);
    }

    #[test]
    fn slower_trials_leave_the_revolutions_of_the_approach_as_they_are() {
        let motion = |speed: f64, n_rps: f64| {
            let channels = [
                (Channel::U, vec![speed, 0.8 * speed, 0.7 * speed]),
                (Channel::V, vec![0.0; 3]),
                (Channel::N, vec![n_rps; 3]),
            ];
            Trial { channels: channels.into(), ..Trial::default() }
        };
        let slow = [motion(4.8, 1.8), motion(4.7, 1.7)];
        let all = [motion(8.0, 3.0), motion(8.1, 3.1), motion(7.9, 2.9)].into_iter().chain(slow);
        let all: Vec<Trial> = all.collect();
        let approach = trial_approach(&all.iter().collect::<Vec<_>>());
        assert_eq!(approach, Some(TrialApproach { speed_m_s: 7.9, n_rps: Some(3.0) }));
    }
}
