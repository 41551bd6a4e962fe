//! The law that is fitted: Abkowitz-MMG of third order for one screw and one rudder, in four
//! submodels.

use sistership_model::hybrid::derive_law;
use sistership_model::quantity::Quantity;
use sistership_model::{Law, Model};

/// As in `models/hybrids`, of third order, with submodels that a ship meets which goes ahead all
/// the time: the rudder stalled, the propeller loaded more or less than in steady motion.
const DECLARATION: &str = "
kind: hybrid
name: hybrid-race
title: Abkowitz-MMG hybrid of third order for one propeller and one rudder, by stall and by the load of the propeller
order: 3
scaling: bis
actuators:
  n: { kind: propeller }
  delta: { kind: rudder, angle: sine_versine }
rules: { symmetry: parity, constant: true, signed_squares: false, trigonometric_powers: drop, squares: as_described }
submodels:
  stalled: { when: ['abs(delta) - 20*pi/180 >= 0'], meaning: the rudder beyond 20 degrees, shrinkage: 4.0 }
  accelerating: { when: ['n*lpp_m - 75*u >= 0'], meaning: the propeller loaded more than in steady motion, shrinkage: 4.0 }
  slowing: { when: ['n*lpp_m - 50*u < 0'], meaning: the propeller loaded less, shrinkage: 4.0 }
";

pub fn hybrid() -> Law {
    derive_law("hybrid-race.yaml", DECLARATION).unwrap_or_else(|error| panic!("{error}")).law
}

/// The model with no coefficient but zero. Masses are those of the truth, by the mass of the ship.
pub fn blank(truth: &Model, law: &Law) -> Model {
    let mut model = truth.clone();
    law.name.clone_into(&mut model.law);
    model.name = format!("{}/{}", model.ship, law.name);
    let of = |name: &str| truth.parameters[name].value;
    let value = |name: &str| {
        sistership_model::particulars::particular_value(&truth.particulars, name)
            .expect("a particular of the ship")
    };
    let own = value("mass_kg")
        / (0.5 * value("water_density_kg_m3") * value("lpp_m").powi(2) * value("draught_m"));
    let inertia = [
        ("m_x", of("m_x") / own),
        ("m_y", of("m_y") / own),
        ("I_zz_plus_J_zz", of("k_zz").powi(2) + of("J_z") / own),
    ];
    model.parameters = law
        .parameters
        .keys()
        .map(|name| {
            let known = inertia.iter().find(|(own, _)| own == name).map(|(_, value)| *value);
            let value = known
                .or_else(|| law.derived_parameter(name, &model.particulars))
                .expect("a parameter of the law");
            (name.clone(), Quantity::new(value, "the truth"))
        })
        .collect();
    model.coefficients = law
        .coefficient_names()
        .into_iter()
        .map(|name| (name, Quantity::new(0.0, "nothing known")))
        .collect();
    model
}
