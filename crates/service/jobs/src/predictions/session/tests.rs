#![allow(clippy::unwrap_used)]

use std::time::Duration;

use serde_json::{Value, json};
use sistership_model::posterior::Posterior;
use sistership_model::{Law, Model, Zoo};
use sistership_simulation::integrate::Method;
use sistership_simulation::state::{at, straight_state};
use sistership_simulation::{HelmOrder, RunSettings, Ship, Trajectory};

use super::{PredictionSession, SessionLimits, SessionRequest, SessionTable, StepsRequest};
use crate::predictions::error::{PredictionError, Result};

const MOST: usize = 200_000;

fn of(ship: &str) -> (Model, std::sync::Arc<Law>) {
    let zoo = Zoo::load_embedded().unwrap();
    let model = zoo.find_model(ship).unwrap();
    let law = zoo.law(&model.law).unwrap().clone();
    (model, law)
}

/// The Mariner with a posterior of two coefficients.
fn sure_by(deviation: f64) -> (Model, std::sync::Arc<Law>) {
    let (mut model, law) = of("mariner");
    let names: Vec<String> = ["N_delta", "Y_delta"].map(str::to_owned).to_vec();
    let values: Vec<f64> = names.iter().map(|name| model.coefficient(name)).collect();
    let deviations = values.iter().map(|value| deviation * value.abs()).collect();
    let root_correlation = Posterior::format_rows(2, &|i, j| [[1.0, 0.0], [-0.6, 0.8]][i][j]);
    model.posterior = Some(Posterior { names, values, deviations, root_correlation });
    (model, law)
}

fn session(
    (model, law): &(Model, std::sync::Arc<Law>),
    mut asked: Value,
) -> Result<PredictionSession> {
    asked["model"] = json!("m");
    let asked: SessionRequest = serde_json::from_value(asked).unwrap();
    PredictionSession::new(&asked, model, law)
}

fn steps(asked: Value) -> StepsRequest {
    serde_json::from_value(asked).unwrap()
}

fn field(error: PredictionError) -> String {
    match error {
        PredictionError::Field { field, .. } => field,
        other => panic!("{other}"),
    }
}

fn last(answer: &Value, column: &str) -> f64 {
    answer["trajectory"][column].as_array().unwrap().last().unwrap().as_f64().unwrap()
}

#[test]
fn steps_are_those_of_a_run_under_the_same_orders() {
    let (model, law) = of("mariner");
    let ship = Ship::new(&model, &law).unwrap();
    let speed = ship.approach_speed_m_s();
    let run = RunSettings {
        start: straight_state(speed),
        duration_s: 60.0,
        step_s: 0.1,
        method: Method::Rk4,
    };
    let n_rps = ship.revolutions_at(speed);
    let order = |t_s: f64, _: &_| {
        Some(HelmOrder { delta_rad: if t_s < 29.95 { 0.3 } else { -0.2 }, n_rps })
    };
    let mut track = Trajectory::default();
    ship.simulate_orders(run, &mut track, order).unwrap();
    let mut session = session(&(model, law), json!({})).unwrap();
    let port = json!({ "orders": { "delta_rad": -0.2 }, "dt_s": 0.1, "steps": 300 });
    session
        .simulate(&steps(json!({ "orders": { "delta_rad": 0.3 }, "dt_s": 0.5, "steps": 60 })), MOST)
        .unwrap();
    let answer = session.simulate(&steps(port), MOST).unwrap();
    for (column, place) in
        [("psi_rad", at::PSI), ("x_m", at::X), ("u_m_s", at::U), ("delta_rad", at::DELTA)]
    {
        let (ours, theirs) = (last(&answer, column), track.states[600][place]);
        assert!((ours - theirs).abs() < 1e-9 * theirs.abs().max(1.0), "{column}: {ours} {theirs}");
    }
    assert_eq!(answer["trajectory"]["t_s"].as_array().unwrap().len(), 300);
    assert!((last(&answer, "t_s") - 60.0).abs() < 1e-9);
}

#[test]
fn the_rudder_moves_as_the_gear_does() {
    let mariner = of("mariner");
    let gear = Ship::new(&mariner.0, &mariner.1).unwrap().steering_gear();
    let mut session = session(&mariner, json!({})).unwrap();
    let hard = json!({ "orders": { "delta_rad": 3.0 }, "dt_s": 1.0 });
    let answer = session.simulate(&steps(hard), MOST).unwrap();
    let rate = gear.rate_rad_s().min(gear.limit_rad() / gear.time_constant_s().max(0.1));
    assert!(last(&answer, "delta_rad") <= rate * 1.0 + 1e-9);
    let answer = session.simulate(&steps(json!({ "dt_s": 1.0, "steps": 100 })), MOST).unwrap();
    assert!((last(&answer, "delta_rad") - gear.limit_rad()).abs() < 1e-3);
}

/// Galilei's principle: in a uniform current, with the water's velocity added to that at the start,
/// the track is that of still water, carried along.
#[test]
fn a_current_carries_a_ship_along_with_the_water() {
    let mariner = of("mariner");
    let turn = json!({ "orders": { "delta_rad": 0.3 }, "dt_s": 1.0, "steps": 120 });
    let sail = |v_m_s: f64, current: Value| {
        let start = json!({ "u_m_s": 7.7, "v_m_s": v_m_s });
        let asked = json!({ "start": start, "current": current });
        session(&mariner, asked).unwrap().simulate(&steps(turn.clone()), MOST).unwrap()
    };
    let still = sail(0.0, Value::Null);
    let east = json!({ "speed_m_s": 1.0, "towards_rad": std::f64::consts::FRAC_PI_2 });
    let carried = sail(1.0, east);
    let moved = |column: &str| last(&carried, column) - last(&still, column);
    assert!((moved("y_m") - 120.0).abs() < 1e-3, "{}", moved("y_m"));
    assert!(moved("x_m").abs() < 1e-3, "{}", moved("x_m"));
    assert!(moved("psi_rad").abs() < 1e-5, "{}", moved("psi_rad"));
}

/// Worked by hand of mariner.m of MSS, in the prime system: wind of 20 m/s from starboard at 7.7175
/// m/s ahead gives Y' = -0.8 0.0012 0.1 sqrt(U^2 + W^2) W / U^2 = -6.910e-4 and N' = -0.08 0.0012
/// 0.1 2 W/U = -4.976e-5; with m - Y_vdot = 1546e-5, m x_G - Y_rdot = -9.00e-5, m x_G - N_vdot =
/// -23.00e-5 and I_z - N_rdot = 83.0e-5 that is v_dot' = -0.04512 and r_dot' = -0.07245.
#[test]
fn a_wind_from_starboard_pushes_to_port_and_turns_away_from_itself() {
    let mariner = of("mariner");
    let first = json!({ "dt_s": 0.01 });
    let sail = |wind: Value| {
        let asked = json!({ "start": { "u_m_s": 7.7175 }, "wind": wind });
        session(&mariner, asked).unwrap().simulate(&steps(first.clone()), MOST).unwrap()
    };
    let still = sail(Value::Null);
    let from = std::f64::consts::FRAC_PI_2;
    let blown = sail(json!({ "speed_m_s": 20.0, "from_rad": from }));
    let gained = |column: &str| (last(&blown, column) - last(&still, column)) / 0.01;
    let (v_dot, r_dot) = (gained("v_m_s"), gained("r_rad_s"));
    let (length, speed) = (160.93, 7.7175_f64);
    let by_hand = (-0.04512 * speed.powi(2) / length, -0.07245 * (speed / length).powi(2));
    // Damping acts by then: by 0.01 s it has taken 0.1 % of the yaw, by 0.1 s it had taken 1 %.
    assert!((v_dot / by_hand.0 - 1.0).abs() < 0.003, "{v_dot} {by_hand:?}");
    assert!((r_dot / by_hand.1 - 1.0).abs() < 0.003, "{r_dot} {by_hand:?}");
}

#[test]
fn the_band_holds_the_ship_and_widens_with_the_posterior() {
    let turn = json!({ "orders": { "delta_rad": 0.3 }, "dt_s": 1.0, "steps": 120 });
    let width = |deviation: f64| {
        let mut session = session(&sure_by(deviation), json!({ "draws": 40, "seed": 3 })).unwrap();
        let answer = session.simulate(&steps(turn.clone()), MOST).unwrap();
        assert_eq!(
            (&answer["band"]["drawn"], &answer["band"]["sailing"]),
            (&json!(40), &json!(40))
        );
        let end = |end: &str| answer["band"][end]["psi_rad"][119].as_f64().unwrap();
        let heading = last(&answer, "psi_rad");
        assert!(end("low") < heading && heading < end("high"));
        end("high") - end("low")
    };
    let ratio = width(0.1) / width(0.05);
    assert!((1.8..2.2).contains(&ratio), "{ratio}");
    assert_eq!(width(0.05), width(0.05));
}

#[test]
fn a_motion_that_leaves_what_is_physical_is_told_and_stays_told() {
    let (mut model, law) = of("mariner");
    // Yaw damping turned round: a law that diverges.
    model.coefficients.get_mut("N_r").unwrap().value *= -30.0;
    let mut session = session(&(model, law), json!({})).unwrap();
    let asked = || steps(json!({ "orders": { "delta_rad": 0.3 }, "dt_s": 1.0, "steps": 10_000 }));
    let answer = session.simulate(&asked(), MOST).unwrap();
    assert!(answer["stopped"]["reason"].is_string(), "{}", answer["stopped"]);
    assert!(answer["trajectory"]["t_s"].as_array().unwrap().len() < 10_000);
    let again = session.simulate(&asked(), MOST).unwrap();
    assert_eq!(again["stopped"], answer["stopped"]);
    assert_eq!(again["trajectory"]["t_s"], json!([]));
    assert!(session.current_view()["x_m"].is_number());
    let (rows, ended) = session.simulate_rows(&asked(), 0, 64, MOST).unwrap();
    assert!((rows.len(), ended) == (1, true) && rows[0]["stopped"].is_object());
}

#[test]
fn orders_of_any_size_never_end_in_something_else_than_an_answer() {
    let zoo = Zoo::load_embedded().unwrap();
    for vessel in zoo.vessels().filter(|vessel| !vessel.file.models.is_empty()) {
        let ship = vessel.name();
        let mut session = session(&of(ship), json!({})).unwrap();
        for n_rps in [0.0, -1e3, 1e150, -1e300] {
            let asked = json!({ "orders": { "delta_rad": n_rps, "n_rps": n_rps }, "dt_s": 60.0,
                "steps": 5 });
            let answer = session.simulate(&steps(asked), MOST).unwrap();
            assert!(serde_json::to_string(&answer).unwrap().len() > 10, "{ship}");
        }
    }
}

/// Issue 22: one step under 0.2 ms of server time. The least of many, as this machine has others to
/// serve; reading the request and writing the answer are in it. This crate is not optimised in
/// tests; decision 25 has the figures with more draws.
#[test]
fn a_step_takes_less_than_a_fifth_of_a_millisecond() {
    let asked = br#"{ "orders": { "delta_rad": 0.3, "n_rps": 1.2 }, "dt_s": 0.1 }"#;
    for draws in [None, Some(20)] {
        let of = if draws.is_some() { sure_by(0.05) } else { of("mariner") };
        let mut session = session(&of, json!({ "draws": draws })).unwrap();
        let mut least = Duration::MAX;
        for _ in 0..500 {
            let start = std::time::Instant::now();
            let asked: StepsRequest = serde_json::from_slice(asked).unwrap();
            let answer = session.simulate(&asked, MOST).unwrap();
            std::hint::black_box(serde_json::to_string(&answer).unwrap());
            least = least.min(start.elapsed());
        }
        println!("a step beside {} draws: {least:?}", draws.unwrap_or(0));
        assert!(least < Duration::from_micros(200), "{draws:?}: {least:?}");
    }
}

#[test]
fn what_cannot_be_is_refused_by_field_and_changes_nothing() {
    let mariner = of("mariner");
    let refused = |asked: Value| session(&mariner, asked).map(drop).map_err(field).unwrap_err();
    assert_eq!(refused(json!({ "draws": 10 })), "draws");
    assert_eq!(refused(json!({ "delta_rad": 2.0 })), "delta_rad");
    assert_eq!(refused(json!({ "start": { "u_m_s": 1e300 } })), "start");
    assert_eq!(refused(json!({ "start": { "u_m_s": 5.0, "phi_rad": 3.0 } })), "start");
    let mut session = session(&mariner, json!({})).unwrap();
    let mut sail = |asked: Value| session.simulate(&steps(asked), MOST).map_err(field).unwrap_err();
    let unknown = json!({ "orders": { "delta_rad": 0.3, "inputs": { "bow": 1.0 } }, "dt_s": 1.0 });
    assert_eq!(sail(unknown), "orders.inputs.bow");
    assert_eq!(sail(json!({ "dt_s": 60.0, "steps": 10_000 })), "steps");
    assert_eq!(session.current_view()["orders"]["delta_rad"], 0.0);
}

#[test]
fn sessions_are_few_their_owner_s_and_end_when_idle() {
    let mariner = of("mariner");
    let open = |sessions: &SessionTable, id: &str, owner: &str| {
        sessions.open(id, owner, json!({}), session(&mariner, json!({})).unwrap()).map(drop)
    };
    let idle = Duration::from_millis(300);
    let sessions = SessionTable::new(SessionLimits { all: 3, of_one: 2, idle });
    open(&sessions, "a", "ann").unwrap();
    open(&sessions, "b", "ann").unwrap();
    let many = open(&sessions, "c", "ann").unwrap_err();
    assert!(many.to_string().starts_with("you have 2"), "{many}");
    open(&sessions, "d", "bob").unwrap();
    let many = open(&sessions, "e", "bob").unwrap_err();
    assert!(many.to_string().starts_with("this server has 3"), "{many}");
    assert!(matches!(sessions.find_session("a", "bob"), Err(PredictionError::NoSession(_))));
    assert!(sessions.close("a", "bob").is_err());
    sessions.close("a", "ann").unwrap();
    open(&sessions, "e", "bob").unwrap();
    let handle = sessions.find_session("b", "ann").unwrap();
    let busy = handle.with_session(|_| sessions.find_session("b", "ann")?.with_session(|_| Ok(())));
    assert!(matches!(busy, Err(PredictionError::SessionBusy)));
    std::thread::sleep(idle);
    assert_eq!(sessions.list_sessions("ann"), []);
}
