//! The same work without a server, on files: the forms and keys that scripts depend on.

use sistership_tests::binary;

use super::sea_trials::{NAME, csv, manifest, ship, trials};

/// A folder with the ship, its trials and their manifest.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let trials = trials();
    for trial in &trials {
        std::fs::write(folder.path().join(&trial.name), csv(trial)).expect("written");
    }
    std::fs::write(folder.path().join("trials.yaml"), manifest(&trials)).expect("written");
    std::fs::write(folder.path().join("ship.yaml"), ship()).expect("written");
    folder
}

#[test]
fn refine_simulate_manoeuvre_on_files() {
    let folder = folder();
    let path = |name: &str| folder.path().join(name).display().to_string();
    let (ship, trials, model) = (path("ship.yaml"), path("trials.yaml"), path("model.yaml"));
    let checked = binary::json(&["check", &trials, "--json"], 0);
    assert_eq!(checked["trials"].as_array().map(Vec::len), Some(4));
    let refined = binary::json(
        &[
            "refine", "--ship", &ship, "--source", "mariner", "--trials", &trials, "--out", &model,
            "--json",
        ],
        0,
    );
    assert_eq!(
        (refined["ship"].as_str(), refined["method"].as_str()),
        (Some(NAME), Some("published"))
    );
    for key in ["settings", "condition_number", "held_out", "coefficients", "source", "model"] {
        assert!(!refined[key].is_null(), "{key} is missing");
    }
    for key in ["name", "source", "refined", "standard_error", "moved_sd"] {
        assert!(!refined["coefficients"][0][key].is_null(), "coefficients[].{key} is missing");
    }
    let simulated = binary::json(
        &["simulate", "--model", &model, "--trials", &trials, "--restart-s", "100", "--json"],
        0,
    );
    for trial in simulated["trials"].as_array().expect("trials") {
        assert_eq!(trial["diverged"], false);
        assert!(
            ["u", "v", "r", "psi", "x", "y"].iter().all(|channel| trial["rmse"][channel].is_f64()),
            "{trial}"
        );
        assert!(trial["standardised_mse"].is_f64() && trial["duration_s"].is_f64());
    }
    let sailed = binary::json(&["manoeuvre", "--model", &model, "--all", "--json"], 0);
    assert!(
        sailed["turns"][0]["tactical_diameter_m"].is_f64()
            && sailed["zigzags"][0]["first_overshoot_deg"].is_f64()
    );
    assert!(sailed["imo"][0]["pass"].is_boolean());
}

#[test]
fn similar_ranks_as_published() {
    let ranking = binary::json(&["similar", "kvlcc2", "--json"], 0);
    let of = |ship: &str| {
        ranking["ranking"]
            .as_array()
            .expect("a ranking")
            .iter()
            .find(|r| r["ship"] == ship)
            .expect("ranked")["correlation"]
            .clone()
    };
    for (ship, printed) in
        [("mariner", -0.576), ("esso-tanker", 0.851), ("sr108", -0.887), ("pcc", -0.723)]
    {
        assert!((of(ship).as_f64().expect("a number") - printed).abs() < 6e-4, "{ship}");
    }
}

#[test]
fn exit_status_tells_a_wrong_call_from_a_refusal() {
    assert_eq!(
        binary::run(&["refine", "--ship", "mariner"]).status.code(),
        Some(2),
        "a missing argument"
    );
    let unknown =
        binary::run(&["refine", "--ship", "mariner", "--law", "low-sped", "--trials", "none.csv"]);
    let message = String::from_utf8_lossy(&unknown.stderr).into_owned();
    assert_eq!(unknown.status.code(), Some(1));
    assert!(
        message.contains("low-sped") && message.contains("low-speed"),
        "the laws are listed: {message}"
    );
    let unknown = binary::run(&["similar", "marriner"]);
    let message = String::from_utf8_lossy(&unknown.stderr).into_owned();
    assert_eq!(unknown.status.code(), Some(1));
    assert!(message.contains("mariner"), "a close name is suggested: {message}");
}

#[test]
fn a_law_is_derived_from_a_list_of_actuators() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let declaration = concat!(env!("CARGO_MANIFEST_DIR"), "/../models/hybrids/hybrid-vectwin.yaml");
    let law = folder.path().join("law.yaml").display().to_string();
    let derived = binary::json(&["derive", declaration, "--out", &law, "--json"], 0);
    assert_eq!(
        (derived["unknowns"].as_u64(), derived["coefficient_sets"].as_u64()),
        (Some(193), Some(3)),
        "{derived}"
    );
    assert_eq!(derived["rules"][3]["rule"], "A: symmetry");
    assert_eq!(derived["law"]["axes"]["X"]["terms"][4], "X_u|u|");
    let text = std::fs::read_to_string(&law).expect("written");
    sistership_model::Law::parse(&law, &text).unwrap_or_else(|error| panic!("{error}"));
}

#[test]
fn a_law_and_a_vessel_are_added_by_files() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    std::fs::create_dir_all(folder.path().join("vessels")).expect("a folder");
    let copy = sistership_model::Zoo::load_embedded()
        .unwrap_or_else(|error| panic!("{error}"))
        .vessel_text("mariner")
        .expect("in the zoo")
        .replace("name: mariner", "name: marina");
    std::fs::write(folder.path().join("vessels/marina.yaml"), copy).expect("written");
    let zoo = folder.path().display().to_string();
    let sailed = binary::json(
        &["manoeuvre", "--zoo", &zoo, "--model", "marina", "--turn", "20", "--json"],
        0,
    );
    assert!(sailed["turns"][0]["advance_m"].as_f64() > Some(100.0), "{sailed}");
}

/// A ship without trials and without a model: estimated, sailed, written as a vessel of a zoo of
/// one's own, and found there.
#[test]
fn a_ship_without_trials_is_estimated_and_joins_a_zoo() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = |name: &str| folder.path().join(name).display().to_string();
    let (ship, model) = (path("coaster.yaml"), path("estimate.yaml"));
    let text = "kind: vessel\nname: coaster\ntitle: A coaster\ncategory: general-cargo\nsources: { \
                a: { citation: made for this test } }\nparticulars: { source: a, values: { lpp_m: \
                80.0, beam_m: 13.0, draught_m: 5.0, block_coefficient: 0.72, service_speed_m_s: \
                6.0 } }\n";
    std::fs::write(&ship, text).expect("written");
    let estimated = binary::json(&["estimate", "--ship", &ship, "--out", &model, "--json"], 0);
    assert_eq!(estimated["status"], "estimated");
    for key in ["law", "speed_m_s", "revolutions_rps", "manoeuvres", "bands", "values", "model"] {
        assert!(!estimated[key].is_null(), "{key} is missing");
    }
    let band = &estimated["bands"][0];
    assert!(band["low"].as_f64() < band["high"].as_f64(), "{band}");
    let sailed = binary::json(&["manoeuvre", "--model", &model, "--all", "--json"], 0);
    assert!(sailed["turns"][0]["tactical_diameter_m"].is_f64(), "{sailed}");
    let own = path("zoo");
    let page = path("coaster.md");
    let add = ["zoo", "add", &ship, "--into", &own, "--page", &page, "--json"];
    let added = binary::json(&add, 0);
    assert_eq!((added["taken"].as_bool(), added["ship"].as_str()), (Some(true), Some("coaster")));
    let page = std::fs::read_to_string(page).expect("written");
    assert!(page.contains("| lpp_m | 80 | a |"), "{page}");
    let cited = binary::json(&["zoo", "cite", "coaster", "--zoo", &own, "--json"], 0);
    let entry = &cited["@graph"][0];
    assert_eq!((&entry["@type"], &entry["identifier"]), (&"Dataset".into(), &"coaster".into()));
    let similar = binary::json(&["similar", "coaster", "--zoo", &own, "--json"], 0);
    assert_eq!(similar["target"], "coaster");
    let listed = binary::json(&["zoo", "list", "wpcc", "--json"], 0);
    assert_eq!(listed["models"][0]["standing"], "disputed");
}
