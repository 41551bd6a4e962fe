//! The prime system: a geometrically similar ship sails the same path in lengths.

use sistership_model::quantity::Quantity;
use sistership_model::{Vessel, Zoo};
use sistership_priors::transfer::transfer_model;
use sistership_simulation::manoeuvre::{ManoeuvreSettings, simulate_turn};

use super::{model, ready};

/// The vessel at another scale: lengths by the ratio, speeds by its root.
fn scaled(vessel: &Vessel, ratio: f64) -> Vessel {
    let mut scaled = vessel.clone();
    scaled.file.name = "scaled".into();
    for (name, quantity) in &mut scaled.particulars {
        let dimension =
            sistership_model::particulars::particular_dimension(name).expect("a known particular");
        let density = name == "water_density_kg_m3";
        let exponent = if density {
            0.0
        } else {
            dimension.length + 3.0 * dimension.mass + 0.5 * dimension.time
        };
        *quantity = Quantity::new(quantity.value * ratio.powf(exponent), "scaled for the test");
    }
    scaled
}

#[test]
fn a_scaled_ship_turns_the_same_circle_in_lengths() {
    let zoo = Zoo::load_embedded().unwrap_or_else(|error| panic!("{error}"));
    for name in ["mariner", "kvlcc2", "esso-tanker", "sr108"] {
        let (source, law) = model(name);
        let vessel = zoo.vessel(name).expect("in the zoo");
        let model = transfer_model(&source, &law, &scaled(vessel, 1.0 / 25.0), None);
        let turned = |model: &sistership_model::Model| {
            let ship = ready(model, &law);
            let metrics = simulate_turn(&ship, 20.0, &ManoeuvreSettings::default())
                .unwrap_or_else(|stopped| panic!("{name}: {stopped}"))
                .metrics;
            [metrics.advance_m, metrics.tactical_diameter_m, metrics.steady_radius_m]
                .map(|m| m.expect("a full turn") / ship.lpp_m())
        };
        // The approach speed of the copy is that of its scaled service speed, so the original is
        // given its own as well.
        let mut original = source.clone();
        if let Some(speed) = vessel.particular("service_speed_m_s") {
            original.revolutions_rps =
                source.revolutions_rps.zip(source.speed_m_s).map(|(n, own)| n * speed / own);
            original.set_approach_speed(&law, speed);
        }
        for (small, large) in turned(&model).into_iter().zip(turned(&original)) {
            assert!((small / large - 1.0).abs() < 0.01, "{name}: {small} against {large} lengths");
        }
    }
}
