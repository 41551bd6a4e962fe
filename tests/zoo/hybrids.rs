//! Derived laws: those of the zoo are what their declarations give, and they sail.

use std::path::PathBuf;

use sistership_model::effect::AppliedEffect;
use sistership_model::hybrid::{LawDerivation, derive_law};
use sistership_model::quantity::Quantity;
use sistership_model::{Model, Zoo};
use sistership_simulation::Ship;
use sistership_simulation::plant::PlantWorkspace;
use sistership_simulation::state::{StateVector, Trajectory, at};
use sistership_simulation::{Method, ship};

fn models() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../models")
}

fn derived(name: &str) -> LawDerivation {
    let path = models().join("hybrids").join(format!("{name}.yaml"));
    let text = std::fs::read_to_string(&path)
        .unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    derive_law(&path.display().to_string(), &text).unwrap_or_else(|error| panic!("{error}"))
}

fn declarations() -> Vec<String> {
    let entries = std::fs::read_dir(models().join("hybrids")).expect("models/hybrids");
    let names =
        entries.map(|entry| entry.expect("an entry").file_name().into_string().expect("a name"));
    names.filter_map(|name| name.strip_suffix(".yaml").map(str::to_owned)).collect()
}

#[test]
fn hybrids_of_the_zoo_are_what_their_declarations_give() {
    let names = declarations();
    assert!(names.len() >= 2, "{names:?}");
    for name in names {
        let derived = derived(&name);
        let path = models().join("laws").join(format!("{name}.yaml"));
        if std::env::var_os("UPDATE_LAWS").is_some() {
            std::fs::write(&path, &derived.text)
                .unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        }
        let stored = std::fs::read_to_string(&path).unwrap_or_default();
        assert!(
            stored == derived.text,
            "{} is not current: run this test with UPDATE_LAWS=1",
            path.display()
        );
    }
}

#[test]
fn unknowns_of_the_hybrids_of_the_zoo() {
    let zoo = Zoo::load_embedded().unwrap_or_else(|error| panic!("{error}"));
    let count = |name: &str| {
        derived(name).count_unknowns(&zoo).expect("its effects are in the zoo").unknowns
    };
    assert_eq!(count("hybrid-vectwin"), 193, "Miyauchi 2024, Table 4: second order, Submodel-3");
    // 13 terms of X, 14 of Y and of N in four quadrants, three of inertia, ten of wind.
    assert_eq!(count("hybrid-single-screw"), 4 * 41 + 3 + 10);
}

/// The Esso Osaka 3 m model on the derived law; `values` are its coefficients.
fn esso_osaka(values: &str) -> Ship {
    let (zoo, model) = esso_osaka_model(values);
    Ship::new(&model, zoo.law(&model.law).expect("derived"))
        .unwrap_or_else(|error| panic!("{error}"))
}

fn esso_osaka_model(values: &str) -> (Zoo, Model) {
    let mut zoo = Zoo::load_embedded().unwrap_or_else(|error| panic!("{error}"));
    let law = derived("hybrid-single-screw");
    zoo.add_law("derived.yaml", &law.text).unwrap_or_else(|error| panic!("{error}"));
    let models = format!(
        "models:\n  - name: hybrid\n    law: hybrid-single-screw\n    status: published\n    \
         speed_m_s: 0.5\n    revolutions_rps: 10.0\n    parameters: {{ source: wakita-2022, \
         values: {{ m_x: 0.05, m_y: 0.9, I_zz_plus_J_zz: 0.11 }} }}\n    coefficients: {{ source: \
         wakita-2022, values: {{ {values} }} }}\n"
    );
    let vessel =
        zoo.vessel_text("esso-osaka-3m").expect("in the zoo").replace("models: []", &models);
    zoo.add_vessel("esso.yaml", &vessel).unwrap_or_else(|error| panic!("{error}"));
    let model = zoo.find_model("esso-osaka-3m").unwrap_or_else(|error| panic!("{error}"));
    (zoo, model)
}

#[test]
fn without_coefficients_the_esso_osaka_model_keeps_its_way() {
    let ship = esso_osaka("");
    let mut start = StateVector::zeros();
    start[at::U] = 0.5;
    let run = ship::RunSettings { start, duration_s: 100.0, step_s: 0.1, method: Method::Rk4 };
    let mut track = Trajectory::default();
    let order = ship::HelmOrder { delta_rad: 0.3, n_rps: 10.0 };
    ship.simulate_orders(run, &mut track, |_, _| Some(order))
        .unwrap_or_else(|stopped| panic!("{stopped}"));
    let last = track.states.last().expect("sailed");
    assert!(
        (last[at::X] - 50.0).abs() < 1e-9 && last[at::Y].abs() < 1e-12 && last[at::R].abs() < 1e-12,
        "{last:?}"
    );
}

#[test]
fn a_deviation_acts_in_its_quadrant_alone() {
    let ship = esso_osaka(
        "\"X_u|u|\": -0.02, \"X_u|u|@backing\": -0.03, \"X_n|n|@crash-astern\": 1.0e-4, X_n: 0.001",
    );
    let rate = |u: f64, n: f64| {
        let mut state = StateVector::zeros();
        state[at::U] = u;
        ship.rate_at(&state, 0.0, n, &mut PlantWorkspace::default())[at::U]
    };
    // Bis system: forces by m g, velocities by sqrt(g L), revolutions by sqrt(g/L); m (1 + m_x) is
    // moved.
    let (g, lpp) = (9.806_65, 3.0);
    let force = |u: f64, n: f64, x_uu: f64, x_nn: f64| {
        let (u, n) = (u / f64::sqrt(g * lpp), n * f64::sqrt(lpp / g));
        (x_uu * u * u.abs() + 0.001 * n + x_nn * n * n.abs()) * g / 1.05
    };
    for (u, n, x_uu, x_nn) in [
        (0.5, 8.0, -0.02, 0.0),
        (0.5, -8.0, -0.02, 1e-4),
        (-0.5, -8.0, -0.05, 0.0),
        (-0.5, 8.0, -0.02, 0.0),
    ] {
        let wanted = force(u, n, x_uu, x_nn);
        assert!(
            (rate(u, n) - wanted).abs() < 1e-12 * (1.0 + wanted.abs()),
            "{u} {n}: {} {wanted}",
            rate(u, n)
        );
    }
}

#[test]
fn a_current_moves_the_conditions_with_the_water() {
    let (zoo, mut model) = esso_osaka_model("\"X_u|u|@backing\": -0.03");
    let effect = zoo.effect("current").expect("in the zoo");
    let form = effect.forms[0].as_ref();
    let parameters = [("north_m_s", 0.4), ("east_m_s", 0.0)]
        .map(|(name, value)| (name.to_owned(), Quantity::new(value, "test")));
    model.effects.push(AppliedEffect {
        name: effect.name.clone(),
        acts_on: effect.acts_on,
        form: form.file.clone(),
        parameters: parameters.into(),
    });
    let ship = Ship::new(&model, zoo.law(&model.law).expect("derived"))
        .unwrap_or_else(|error| panic!("{error}"));
    let mut state = StateVector::zeros();
    state[at::U] = 0.2;
    // Ahead over the ground, but astern through water that follows it at 0.4 m/s.
    let drag = ship.rate_at(&state, 0.0, -8.0, &mut PlantWorkspace::default())[at::U];
    let wanted = 0.03 * 0.2_f64.powi(2) / (9.806_65 * 3.0) * 9.806_65 / 1.05;
    assert!((drag - wanted).abs() < 1e-12, "{drag} {wanted}");
}
