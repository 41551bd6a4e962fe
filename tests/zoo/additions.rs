//! A new law, a new vessel, a new coefficient set and a new effect at run time: files, and no Rust.

use sistership_model::Zoo;
use sistership_model::trial::Channel;
use sistership_simulation::Ship;
use sistership_simulation::manoeuvre::{ManoeuvreSettings, simulate_turn};

/// Nomoto's first-order law with a quadratic resistance: nothing the program knows.
const LAW: &str = "
kind: law
name: nomoto
title: First-order steering law
sources: { nomoto-1957: { citation: 'Nomoto et al. 1957, On the steering qualities of ships' } }
inputs: { delta: { unit: rad } }
parameters:
  T: { unit: s, meaning: time constant }
  U0: { unit: m/s, meaning: approach speed, role: approach_speed }
factors: { r: r, delta: delta, u: u - U0 }
axes:
  X: { scale: mass_kg/T, terms: [X_u] }
  Y: { scale: mass_kg/T, terms: [{ Y_v: v }] }
  N: { scale: mass_kg*lpp_m^2/T, terms: [N_r, { N_delta: delta/T }] }
mass:
  X: { X: mass_kg }
  Y: { Y: mass_kg }
  N: { N: mass_kg*lpp_m^2 }
";

const VESSEL: &str = "
kind: vessel
name: barge
title: A barge of the test
category: barge
sources: { test: { citation: made for this test } }
particulars: { source: test, values: { lpp_m: 60.0, beam_m: 12.0, draught_m: 3.0, displacement_m3: 1800.0 } }
models:
  - name: slow
    law: nomoto
    status: published
    speed_m_s: 4.0
    parameters: { source: test, values: { T: 20.0 } }
    coefficients: { source: test, values: { X_u: -1.0, Y_v: -1.0, N_r: -1.0, N_delta: 0.6 } }
  - name: quick
    law: nomoto
    status: published
    speed_m_s: 4.0
    parameters: { source: test, values: { T: 20.0 } }
    coefficients: { source: test, values: { X_u: -1.0, Y_v: -1.0, N_r: -1.0, N_delta: 1.2 } }
";

/// A coefficient set for a law that the program carries.
const SISTER: &str = "
kind: vessel
name: little-sister
title: A vessel on the Abkowitz law
category: dry-cargo
sources: { test: { citation: made for this test } }
conventions: { rudder_positive: port_turn }
particulars: { source: test, values: { lpp_m: 120.0, beam_m: 18.0, draught_m: 6.0, service_speed_m_s: 7.0, displacement_m3: 8000.0, yaw_gyradius_ratio: 0.25, x_g_m: 0.0 } }
models:
  - name: own
    law: abkowitz
    status: published
    speed_m_s: 7.0
    parameters: { source: test, values: { X_udot: -42.0e-5, Y_vdot: -748.0e-5, Y_rdot: 0.0, N_vdot: 0.0, N_rdot: -43.8e-5 } }
    coefficients:
      source: test
      values: { X_u: -184.0e-5, Y_v: -1160.0e-5, Y_r: -499.0e-5, N_v: -264.0e-5, N_r: -166.0e-5, Y_delta: 278.0e-5, N_delta: -139.0e-5, N_v|v|: -100.0e-5 }
";

/// A ship on the general polynomial: powers, absolute values, sine and cosine of the rudder, terms
/// that nobody listed.
const POLYNOMIAL: &str = "
kind: vessel
name: polynomial-ship
title: A vessel on the general polynomial
category: dry-cargo
sources: { test: { citation: made for this test } }
particulars: { source: test, values: { lpp_m: 120.0, beam_m: 18.0, draught_m: 6.0, displacement_m3: 8000.0, yaw_gyradius_ratio: 0.25, x_g_m: 0.0 } }
models:
  - name: own
    law: polynomial
    status: published
    speed_m_s: 7.0
    revolutions_rps: 1.5
    parameters: { source: test, values: { X_udot: -42.0e-5, Y_vdot: -748.0e-5, Y_rdot: 0.0, N_vdot: 0.0, N_rdot: -43.8e-5 } }
    coefficients:
      source: test
      values:
        X_uu: -0.0005
        X_nn: \"0.0005*(7.0/(1.5*120.0))^2\"
        X_cosdelta: -0.001
        Y_uv: -0.0116
        Y_v|v|: -0.05
        Y_ur: -0.005
        Y_sindelta: -0.0028
        N_uv: -0.0026
        N_ur: -0.0017
        N_r|r|: -0.001
        N_sindelta: 0.0014
";

#[test]
fn the_general_polynomial_sails() {
    let mut zoo = Zoo::load_embedded().unwrap_or_else(|error| panic!("{error}"));
    zoo.add_vessel("polynomial-ship.yaml", POLYNOMIAL).unwrap_or_else(|error| panic!("{error}"));
    let model = zoo.find_model("polynomial-ship").unwrap_or_else(|error| panic!("{error}"));
    let ship = Ship::new(&model, zoo.law(&model.law).expect("in the zoo"))
        .unwrap_or_else(|error| panic!("{error}"));
    let sailed = simulate_turn(&ship, 20.0, &ManoeuvreSettings::default())
        .unwrap_or_else(|stopped| panic!("{stopped}"));
    assert!(
        sailed.metrics.tactical_diameter_m.is_some_and(|m| m > 120.0 && m < 2000.0),
        "{:?}",
        sailed.metrics
    );
    assert!(sailed.metrics.speed_loss_m_s > 0.0);
}

#[test]
fn a_new_law_vessel_and_coefficient_set_are_files() {
    let mut zoo = Zoo::load_embedded().unwrap_or_else(|error| panic!("{error}"));
    zoo.add_law("nomoto.yaml", LAW).unwrap_or_else(|error| panic!("{error}"));
    zoo.add_vessel("barge.yaml", VESSEL).unwrap_or_else(|error| panic!("{error}"));
    zoo.add_vessel("little-sister.yaml", SISTER).unwrap_or_else(|error| panic!("{error}"));
    let rate = |name: &str| {
        let model = zoo.find_model(name).unwrap_or_else(|error| panic!("{error}"));
        let ship = Ship::new(&model, zoo.law(&model.law).expect("added"))
            .unwrap_or_else(|error| panic!("{error}"));
        let sailed = simulate_turn(&ship, 20.0, &ManoeuvreSettings::default())
            .unwrap_or_else(|stopped| panic!("{name}: {stopped}"));
        sailed.track.last().expect("a state")[sistership_simulation::state::at::R]
    };
    // Nomoto: the steady yaw rate is K delta, here 0.6/20 and 1.2/20 of 20 deg.
    assert!((rate("barge/slow") - 0.03 * 20_f64.to_radians()).abs() < 1e-4);
    assert!((rate("barge/quick") - 0.06 * 20_f64.to_radians()).abs() < 1e-4);
    assert!(
        rate("little-sister") > 0.0,
        "positive rudder turns to starboard whatever the source counts"
    );
}

/// The last file that the README of the effects shows.
fn effect_of_the_readme() -> &'static str {
    let readme = include_str!("../../models/effects/README.md");
    let example = readme.rsplit("```yaml\n").next().expect("an example");
    example.split("```").next().expect("its end")
}

#[test]
fn the_effect_that_the_readme_shows_reads() {
    let mut zoo = Zoo::load_embedded().unwrap_or_else(|error| panic!("{error}"));
    assert!(zoo.effect("compass-offset").is_none(), "the example is not in the library");
    let text = effect_of_the_readme();
    let added =
        zoo.add_effect("compass-offset.yaml", text).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(zoo.effect("compass-offset"), Some(&added));
    assert!(added.forms[0].measures.contains_key(&Channel::Psi));
    let wrong = text.replace("psi + offset_rad", "psi + offset_rad*u");
    let refused = zoo
        .add_effect("compass-offset.yaml", &wrong)
        .expect_err("a heading has no speed")
        .to_string();
    assert!(
        refused.starts_with("compass-offset.yaml:19: forms.constant.measures.psi"),
        "{refused}"
    );
}

#[test]
fn the_file_that_the_readme_explains_reads() {
    let readme = include_str!("../../models/effects/README.md");
    let text = readme.split("```").nth(1).expect("an example").trim_start_matches("yaml");
    let mut zoo = Zoo::load_embedded().unwrap_or_else(|error| panic!("{error}"));
    let added = zoo.add_effect("my-effect.yaml", text).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(added.forms[0].parameters["share"].start, 0.05);
}
