//! A simulation that leaves the physical range stops with a reason; it never returns infinities.

use proptest::prelude::*;
use sistership_simulation::manoeuvre::{ManoeuvreSettings, simulate_turn};
use sistership_simulation::state::straight_state;
use sistership_simulation::{HelmOrder, Method, RunSettings, Trajectory};

use super::{SHIPS, model, ready};

proptest! {
    #![proptest_config(ProptestConfig::with_cases(30))]
    #[test]
    fn wild_coefficients_stop_with_a_reason(factor in 1.0..200.0_f64, ship in 0..SHIPS.len(), which in 0..40_usize, rudder in -35.0..35.0_f64) {
        let (mut model, law) = model(SHIPS[ship]);
        let index = which % model.coefficients.len();
        if let Some(quantity) = model.coefficients.values_mut().nth(index) {
            quantity.value *= -factor;
        }
        let ship = ready(&model, &law);
        let mut track = Trajectory::default();
        let run = RunSettings { start: straight_state(ship.approach_speed_m_s()), duration_s: 300.0, step_s: 0.5, method: Method::Rk4 };
        let n_rps = ship.revolutions_at(ship.approach_speed_m_s());
        let sailed = ship.simulate_orders(run, &mut track, |_, _| Some(HelmOrder { delta_rad: rudder.to_radians(), n_rps }));
        prop_assert!(track.states.iter().all(|state| state.iter().all(|value| value.is_finite())));
        if let Err(stopped) = sailed {
            prop_assert!(!stopped.reason.is_empty() && stopped.t_s.is_finite());
        }
    }
}

#[test]
fn a_sign_error_is_reported_with_time_and_reason() {
    let (mut model, law) = model("mariner");
    model.coefficients.get_mut("N_r").expect("a coefficient").value *= -5.0;
    let stopped = simulate_turn(&ready(&model, &law), 35.0, &ManoeuvreSettings::default())
        .expect_err("it cannot sail so");
    assert!(
        stopped.to_string().contains("yaw rate") || stopped.to_string().contains("speed"),
        "{stopped}"
    );
}
