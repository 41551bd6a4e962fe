//! Trials at constant revolutions, and the propeller stopped and reversed: whatever the law that is
//! fitted, a ship comes to rest, stops and goes astern.

use sistership_identification::refine::{
    EstimationMethod as Estimator, RefinementSettings, RefinementSpec, TermFamily, refine,
};
use sistership_model::trial::{Channel, Trial};
use sistership_model::{Model, Vessel, Zoo};
use sistership_simulation::state::{StateVector, Trajectory, at, straight_state};
use sistership_simulation::{HelmOrder, Method, RunSettings, Ship};
use sistership_tests::truth;
use sistership_tests::truth::container::container;
use sistership_tests::truth::family;
use sistership_tests::truth::instruments::Instruments;
use sistership_tests::truth::manoeuvre::Manoeuvre;
use sistership_tests::truth::motion::{Truth, sail_from};
use sistership_tests::truth::stalled::Stalled;

/// Sources and the laws that are fitted: one without revolutions, a polynomial in them, the
/// source's own propeller.
const CASES: [(&str, &str); 3] =
    [("mariner", "abkowitz"), ("kvlcc2", "low-speed"), ("kvlcc2", "mmg")];
/// Duration in `L/U`: a resistance by the square of the speed leaves a tenth of it after nine times
/// mass over resistance, which is up to 58 `L/U` (0.35 by 0.006, as in the check of propulsion).
const LENGTHS: f64 = 525.0;

fn trials(ship: &dyn Truth) -> Vec<Trial> {
    let manoeuvres =
        [Manoeuvre::Zigzag(20.0, 20.0), Manoeuvre::Turn(35.0), Manoeuvre::Zigzag(-10.0, 10.0)];
    truth::trials(ship, &manoeuvres, &Instruments::of(ship), 7)
}

fn refined(zoo: &Zoo, target: &Vessel, (source, law): (&str, &str), trials: &[&Trial]) -> Model {
    let source = zoo.find_model(source).unwrap_or_else(|error| panic!("{error}"));
    let settings = RefinementSettings {
        method: Estimator::Weak,
        families: vec![TermFamily::Own],
        strengths: vec![1.0, 1e-2, 1e-4],
        ..RefinementSettings::default()
    };
    let request = RefinementSpec {
        target,
        source: &source,
        source_law: zoo.law(&source.law).map(|law| &**law),
        law: zoo.law(law).expect("a law of the zoo"),
        trials,
        population: &[],
        settings: &settings,
    };
    let made = refine(&request, &|_, _| true);
    made.unwrap_or_else(|error| panic!("{}, {law}: {error}", source.name)).model
}

/// The states after an order, by the number of revolutions ahead.
fn sailed(ship: &Ship, start: f64, turns: f64) -> Vec<StateVector> {
    let speed = ship.approach_speed_m_s();
    let length_s = ship.lpp_m() / speed;
    let order = HelmOrder { delta_rad: 0.0, n_rps: turns * ship.revolutions_at(speed) };
    let run = RunSettings {
        start: straight_state(start * speed),
        duration_s: LENGTHS * length_s,
        step_s: 0.1 * length_s,
        method: Method::Rk4,
    };
    let mut track = Trajectory::default();
    ship.simulate_orders(run, &mut track, |_, _| Some(order))
        .unwrap_or_else(|error| panic!("{error}"));
    track.states
}

fn stops_and_goes_astern(ship: &Ship, named: &str) {
    let speed = ship.approach_speed_m_s();
    let shares = |start: f64, turns: f64| -> Vec<f64> {
        sailed(ship, start, turns).iter().map(|state| state[at::U] / speed).collect()
    };
    let coasting = shares(1.0, 0.0);
    let falls = coasting.windows(2).all(|two| two[1] < two[0] + 1e-3);
    let left = coasting.last().copied().unwrap_or(1.0);
    assert!(falls && (-0.01..0.1).contains(&left), "{named}: {left} of the speed is left");
    let (reversed, astern) = (shares(1.0, -1.0), shares(0.0, -1.0));
    for (what, shares) in [("reversed", reversed), ("astern", astern)] {
        let last = shares.last().copied().unwrap_or(1.0);
        assert!((-1.2..-0.1).contains(&last), "{named}: {what}, ends at {last}");
    }
}

#[test]
fn what_is_fitted_at_constant_revolutions_stops_and_goes_astern() {
    let zoo = Zoo::load_embedded().unwrap_or_else(|error| panic!("{error}"));
    let ships: [Box<dyn Truth>; 2] =
        [Box::new(Stalled(container())), Box::new(family::single_screw(5))];
    for truth in ships {
        let (size, trials) = (truth.dimensions(), trials(&*truth));
        let trials: Vec<&Trial> = trials.iter().collect();
        let target = Vessel::parse("truth", &truth::files::vessel(size));
        let target = target.unwrap_or_else(|error| panic!("{error}"));
        for case in CASES {
            let (model, law) = (refined(&zoo, &target, case, &trials), zoo.law(case.1));
            let law = law.expect("a law of the zoo");
            let named = format!("{} by {case:?}", size.name);
            let ship = Ship::new(&model, law).unwrap_or_else(|error| panic!("{error}"));
            stops_and_goes_astern(&ship, &named);
            println!("{named}: {:?}", half_time(&ship, &*truth));
            let covered = model.validity.and_then(|region| region.ranges.get("n").copied());
            assert!(covered.is_some() || trials[0].channel(Channel::N).is_none(), "{named}");
        }
    }
}

/// Times in which half of the speed is lost, by that in which the ship sails its length: of a
/// model, and of the ship itself.
fn half_time(ship: &Ship, truth: &dyn Truth) -> [usize; 2] {
    let speed = ship.approach_speed_m_s();
    let own = sailed(ship, 1.0, 0.0);
    let size = truth.dimensions();
    let track = sail_from(
        truth,
        straight_state(size.speed_m_s),
        60.0 * size.length_time_s(),
        0.0,
        |_, _| 0.0,
    );
    let after = |states: &[StateVector], each: f64| {
        let at_half = states.iter().position(|state| state[at::U] < 0.5 * speed);
        (at_half.unwrap_or(states.len()) as f64 * each) as usize
    };
    [after(&own, 0.1), after(&track.states, 0.1 / size.length_time_s())]
}
