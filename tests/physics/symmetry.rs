//! Port and starboard: a mirrored motion has mirrored accelerations, for every ship without its
//! declared asymmetries.

use proptest::prelude::*;
use sistership_model::coefficient::{Axis, CoefficientName};
use sistership_model::{Law, Model};
use sistership_simulation::StateVector;
use sistership_simulation::plant::PlantWorkspace;
use sistership_simulation::state::at;

use super::{SHIPS, model, ready};

/// Drops the biases a single screw gives and sets paired parameters equal, which is what makes a
/// ship symmetric.
fn symmetric(mut model: Model, law: &Law) -> Model {
    let odd = |name: &CoefficientName| {
        name.factors
            .iter()
            .filter(|f| {
                !f.absolute
                    && matches!(f.symbol.as_str(), "v" | "r" | "phi" | "p" | "delta" | "beta")
            })
            .count()
            % 2
            == 1
    };
    model.coefficients.retain(|name, _| {
        CoefficientName::parse(name, &law.extra_factors())
            .is_ok_and(|parsed| (parsed.axis != Axis::X) == odd(&parsed))
    });
    for (name, twin) in law.mirrors.iter().filter(|(name, twin)| name != twin) {
        let value = model.parameters.get(twin).map_or(0.0, |quantity| quantity.value);
        if let Some(quantity) = model.parameters.get_mut(name) {
            quantity.value = value;
        }
    }
    model
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]
    #[test]
    fn mirrored_motion_has_mirrored_accelerations(u in 0.3..1.2_f64, v in -0.3..0.3_f64, r in -0.6..0.6_f64, phi in -0.2..0.2_f64, delta in -0.6..0.6_f64) {
        for name in SHIPS {
            let (model, law) = model(name);
            let model = symmetric(model, &law);
            let ship = ready(&model, &law);
            let (speed, length) = (ship.approach_speed_m_s(), ship.lpp_m());
            let mut state = StateVector::zeros();
            state[at::U] = u * speed;
            state[at::V] = v * speed;
            state[at::R] = r * speed / length;
            if law.has_roll() {
                state[at::PHI] = phi;
                state[at::P] = 0.3 * phi * speed / length;
            }
            let mut mirrored = state;
            for odd in [at::V, at::R, at::PHI, at::P] {
                mirrored[odd] = -mirrored[odd];
            }
            let n = ship.revolutions_at(speed);
            let mut work = PlantWorkspace::default();
            let here = ship.rate_at(&state, delta, n, &mut work);
            let there = ship.rate_at(&mirrored, -delta, n, &mut work);
            for (index, sign) in [(at::U, 1.0), (at::V, -1.0), (at::R, -1.0), (at::P, -1.0)] {
                let scale = here[index].abs().max(1e-9);
                prop_assert!((here[index] - sign * there[index]).abs() < 1e-9 * scale.max(1.0), "{name} {index}: {} {}", here[index], there[index]);
            }
        }
    }
}
