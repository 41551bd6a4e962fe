#![allow(clippy::unwrap_used)]
//! A report of made-up trials: what it says, that it says it the same way twice, and that nothing
//! leaks out of its text.

use sistership_identification::refine::{Refinement, RefinementSettings, RefinementSpec, refine};
use sistership_model::trial::{Channel, Trial};
use sistership_model::{Vessel, Zoo};
use sistership_priors::source::rank_similar;

use super::{RefinementInput, render_refinement};
use crate::rendered::{RenderedReport, VersionLabel};

/// A record of a ship that answers its rudder, by a formula and not by the law that is fitted.
fn trial(name: &str, period_s: f64, rudder: f64) -> Trial {
    let mut trial = Trial { name: name.into(), ..Trial::default() };
    let (mut r, mut psi, mut x, mut y) = (0.0, 0.0_f64, 0.0, 0.0);
    for k in 0..700 {
        let t = f64::from(k);
        let delta = if t < 20.0 {
            0.0
        } else {
            rudder * (std::f64::consts::TAU * (t - 20.0) / period_s).sin()
        };
        let (u, v) = (7.5 - 400.0 * r * r, -25.0 * r);
        let sample = [u, v, r, psi, x, y, delta];
        let channels = [
            Channel::U,
            Channel::V,
            Channel::R,
            Channel::Psi,
            Channel::X,
            Channel::Y,
            Channel::Delta,
        ];
        channels
            .into_iter()
            .zip(sample)
            .for_each(|(channel, value)| trial.channels.entry(channel).or_default().push(value));
        trial.t_s.push(t);
        r += (0.04 * delta - r) / 25.0;
        x += u * psi.cos() - v * psi.sin();
        y += u * psi.sin() + v * psi.cos();
        psi += r;
    }
    trial
}

struct Case {
    zoo: Zoo,
    vessel: Vessel,
    trials: Vec<Trial>,
    refinement: Refinement,
}

impl Case {
    fn new(names: &[&str]) -> Self {
        let zoo = Zoo::load_embedded().unwrap();
        let mut vessel = Vessel::clone(zoo.vessel("sr108").unwrap());
        vessel.file.title = "<script>alert(\"a & b\")</script>".into();
        let trials: Vec<Trial> = names
            .iter()
            .enumerate()
            .map(|(k, name)| trial(name, 110.0 + 47.0 * k as f64, 0.1 + 0.06 * k as f64))
            .collect();
        let (source, settings) = (
            zoo.find_model("mariner").unwrap(),
            RefinementSettings { lambda_count: 5, ..RefinementSettings::default() },
        );
        let given: Vec<&Trial> = trials.iter().collect();
        let law = zoo.law(&source.law).unwrap();
        let request = RefinementSpec {
            target: &vessel,
            source: &source,
            source_law: None,
            law,
            trials: &given,
            population: &[],
            settings: &settings,
        };
        let refinement = refine(&request, &|_, _| true).unwrap();
        Self { zoo, vessel, trials, refinement }
    }

    fn render(&self) -> RenderedReport {
        let trials: Vec<&Trial> = self.trials.iter().collect();
        let similarity = rank_similar(&self.zoo, &self.vessel, None, &[]);
        let version = VersionLabel { ship: "sr108".into(), number: 7, sha256: "ab".repeat(32) };
        let law = self.zoo.law(&self.refinement.model.law).unwrap();
        let (refinement, similarity) = (&self.refinement, Some(&similarity));
        render_refinement(&RefinementInput {
            refinement,
            law,
            vessel: &self.vessel,
            trials: &trials,
            similarity,
            ladder: None,
            version: Some(version),
        })
        .unwrap()
    }
}

#[test]
fn the_same_input_gives_the_same_self_contained_page() {
    let case = Case::new(&["zz<1>", "turn & back", "free"]);
    let first = case.render();
    assert_eq!(first, case.render());
    assert!(
        !first.html.contains("zz<1>") && first.html.matches("<script>").count() == 1,
        "text from outside must be escaped"
    );
    assert!(
        ["&#60;script", "zz&#60;1&#62;", "turn &#38; back"]
            .iter()
            .all(|text| first.html.contains(text))
    );
    for outside in ["<link", "src=", "url(", "@import", "http://", "https://"] {
        assert!(!first.html.contains(outside), "{outside}");
    }
    assert!(first.html.len() < 1_500_000);
}

#[test]
fn a_page_says_what_a_reader_asks() {
    let case = Case::new(&["zigzag", "turn"]);
    let RenderedReport { html, json } = case.render();
    let ids = [
        "acceptance",
        "errors",
        "trials",
        "coefficients",
        "options",
        "manoeuvres",
        "source",
        "provenance",
    ];
    let places: Vec<usize> =
        ids.iter().map(|id| html.find(&format!("<section id=\"{id}\"")).unwrap()).collect();
    assert!(places.is_sorted());
    assert!(html.contains(&"ab".repeat(32)) && html.contains("transferred from mariner/abkowitz"));
    assert_eq!(html.matches("class=\"plot\"").count(), 2 * 2 + 3);
    assert_eq!(json["headline"]["version"]["number"], 7);
    assert_eq!(json["coefficients"]["axes"][0]["axis"], "X");
    assert_eq!(json["manoeuvres"]["imo"].as_array().unwrap().len(), 6);
    let heading = json["errors"]["rows"]
        .as_array()
        .unwrap()
        .iter()
        .find(|row| row["channel"] == "psi")
        .unwrap();
    let factor = heading["source"].as_f64().unwrap() / heading["refined"].as_f64().unwrap();
    assert!(
        (factor - heading["factor"].as_f64().unwrap()).abs() < 1e-9 && heading["unit"] == "deg"
    );
}

#[test]
fn a_single_trial_is_not_said_to_be_left_out() {
    let case = Case::new(&["turn"]);
    let RenderedReport { html, json } = case.render();
    assert_eq!(json["errors"]["on_fitted_trial"], true);
    let verdict = json["headline"]["verdict"].as_str().unwrap();
    assert!(!verdict.contains("On held-out manoeuvres"), "{verdict}");
    assert!(html.contains("not how well it predicts another"));
}

#[test]
fn a_trial_without_a_channel_is_left_out_of_the_plots() {
    let mut case = Case::new(&["zigzag", "turn"]);
    case.trials[0].channels.remove(&Channel::Delta);
    case.trials[1].channels.remove(&Channel::X);
    let RenderedReport { html, json } = case.render();
    assert_eq!(json["replays"].as_array().unwrap().len(), 1);
    assert!(html.contains("id=\"trials\""));
}

#[test]
fn a_source_that_is_kept_is_said_to_be_kept() {
    let mut case = Case::new(&["zigzag", "turn"]);
    case.refinement.options.iter_mut().for_each(|option| option.chosen = option.step == "source");
    assert!(
        case.render().json["headline"]["verdict"]
            .as_str()
            .unwrap()
            .contains("the source model is kept unchanged")
    );
}
