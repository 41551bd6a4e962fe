#![allow(clippy::unwrap_used)]
//! The report of a diagnosis made by hand: what it says, that nothing leaks out of its text, that
//! it says it the same twice.

mod made_up;

use sistership_diagnosis::{ValueWithError, Verdict};

use crate::RenderedReport;
use made_up::Case;

#[test]
fn a_current_is_said_in_one_sentence() {
    let RenderedReport { html, json } = Case::new().render();
    assert_eq!(json["sentence"], "Your model lacks: current (0.60 m/s towards 45 deg).");
    assert!(html.contains("Your model lacks: current (0.60 m/s towards 45 deg)."));
    assert!(html.contains("Carry out a zigzag 10/10 at 7.00 m/s (13.6 kn) on a heading of 90 deg"));
    assert!(html.contains("0.601") && html.contains("equally plausible"));
    assert_eq!(
        (json["verdict"].as_str(), json["version"]["made"]["number"].as_i64()),
        (Some("effects"), Some(3))
    );
    assert!(json["model"]["effects"].is_array() || json["model"].is_object());
}

#[test]
fn what_could_not_be_told_is_said_with_its_cause() {
    let RenderedReport { html, json } = Case::new().render();
    let open = "These trials cannot tell: wave drift (until the model is refined further).";
    assert_eq!(json["summary"][2], open);
    assert!(html.contains(open));
    // The limit of the offset in degrees.
    assert!(html.contains("<td class=\"num\">0.11</td>"));
}

#[test]
fn every_part_is_there_and_in_order() {
    let html = Case::new().render().html;
    let ids = [
        "effects",
        "unexplained",
        "evidence",
        "limits",
        "errors",
        "sailed",
        "trials",
        "against",
        "remaining",
        "words",
        "provenance",
    ];
    let places: Vec<usize> =
        ids.iter().map(|id| html.find(&format!("<section id=\"{id}\"")).unwrap()).collect();
    assert!(places.is_sorted());
    // Trajectory, series and residual of each trial; one scatter for each acceleration; a curve for
    // each variable on which what is left depends.
    assert_eq!(html.matches("class=\"plot\"").count(), 2 * 3 + 2 + 2);
    assert!(html.contains(
        "The most probable origin is yaw, a force or moment that the model lacks (evidence 412, \
         largest in 2 of 2 trials); the readings of the heading (96)."
    ));
    assert!(
        html.contains("class=\"band\"")
            && html.contains("class=\"stretch\"")
            && html.contains("class=\"cloud refined\"")
    );
}

#[test]
fn each_hypothesis_is_shown_once_and_the_last_are_folded_away() {
    let html = Case::new().render().html;
    let evidence = &html[html.find("<section id=\"evidence\"").unwrap()
        ..html.find("<section id=\"limits\"").unwrap()];
    assert_eq!(
        evidence.matches("<td>current").count() + evidence.matches(">current<").count(),
        1,
        "{evidence}"
    );
    assert!(evidence.contains("wave drift (towards) + missing term (Y_0)"), "{evidence}");
    assert!(
        evidence.contains("<summary>2 less probable hypotheses</summary>")
            && evidence.contains("against it")
    );
}

#[test]
fn effects_are_named_as_people_call_them() {
    let mut case = Case::new();
    let found = &mut case.diagnosis.effects[0];
    (found.name, found.form) = ("rudder-offset".into(), "constant".into());
    let values = [("offset_deg", 1.46, 0.02), ("offset_rad", 0.025_48, 0.000_35)];
    found.parameters =
        values.map(|(name, value, se)| (name.to_owned(), ValueWithError { value, se })).into();
    let RenderedReport { html, json } = case.render();
    assert_eq!(json["sentence"], "Your model lacks: rudder offset (1.5 deg).");
    let effects = &html[html.find("<section id=\"effects\"").unwrap()
        ..html.find("<section id=\"evidence\"").unwrap()];
    assert!(
        effects.contains("<code>offset_deg</code>") && !effects.contains("offset_rad"),
        "one angle, one row"
    );
    let found = &mut case.diagnosis.effects[0];
    (found.name, found.form) = ("missing-term".into(), "N_v|v|".into());
    found.parameters =
        [("N_v_abs_v".to_owned(), ValueWithError { value: -0.0021, se: 0.0003 })].into();
    assert_eq!(case.render().json["sentence"], "Your model lacks: missing term N_v|v| (−0.0021).");
}

#[test]
fn parameters_fitted_once_more_in_the_new_version_stand_beside_those_found() {
    let mut case = Case::new();
    assert!(!case.render().html.contains("in the new version"));
    case.diagnosis.effects[0].in_model =
        [("speed_m_s".to_owned(), ValueWithError { value: 0.587, se: 0.011 })].into();
    let html = case.render().html;
    assert!(html.contains("in the new version"));
    let row = |parameter: &str| {
        let rest = &html[html.find(&format!("<code>{parameter}</code>")).unwrap()..];
        rest[..rest.find("</tr>").unwrap()].to_owned()
    };
    let found = row("speed_m_s");
    assert!(["0.601", "0.587", "0.011"].iter().all(|value| found.contains(value)), "{found}");
    let other = row("towards_deg");
    assert_eq!(
        other.matches('–').count(),
        2,
        "what was not fitted there has no value and no error: {other}"
    );
}

#[test]
fn the_page_says_where_it_comes_from() {
    let html = Case::new().render().html;
    let provenance = &html[html.find("<section id=\"provenance\"").unwrap()..];
    for part in [
        "a remark",
        "least_evidence",
        "published",
        "600",
        "delta",
        "Effects included already",
        "Created by Sistership",
    ] {
        assert!(provenance.contains(part), "{part}");
    }
}

#[test]
fn the_page_is_self_contained_and_repeats() {
    let case = Case::new();
    let first = case.render();
    assert_eq!(first, case.render());
    for outside in
        ["<script src", "<link", "src=", "url(", "@import", "http://", "https://", "zz<1>"]
    {
        assert!(!first.html.contains(outside), "{outside}");
    }
    assert!(first.html.contains("zz&#60;1&#62;") && first.html.len() < 1_500_000);
}

#[test]
fn a_model_that_holds_is_said_to_hold() {
    let mut case = Case::new();
    case.diagnosis.verdict = Verdict::Complete;
    (case.diagnosis.effects, case.diagnosis.unexplained, case.diagnosis.model) =
        (Vec::new(), Vec::new(), None);
    case.diagnosis.next_trial = None;
    let RenderedReport { html, json } = case.render();
    assert!(json["sentence"].as_str().unwrap().starts_with("Your model holds"));
    assert!(
        !html.contains("<section id=\"effects\"")
            && html.contains("Nothing was added to the model")
    );
}

#[test]
fn what_nothing_explains_is_placed() {
    let mut case = Case::new();
    case.diagnosis.verdict = Verdict::Unexplained;
    case.diagnosis.effects = Vec::new();
    case.diagnosis.model = None;
    let changed = case.render().json["sentence"].as_str().unwrap().to_owned();
    assert!(changed.contains("throughout: in turn rudder damage (35 %) begins at"), "{changed}");
    case.diagnosis.changes = Vec::new();
    let sentence = case.render().json["sentence"].as_str().unwrap().to_owned();
    assert!(
        sentence
            .contains("no known effect explains, most of all in yaw of turn from 300 s to 500 s"),
        "{sentence}"
    );
}

#[test]
fn nothing_to_show_is_no_fault() {
    let mut case = Case::new();
    case.diagnosis.residuals = Vec::new();
    (case.diagnosis.manoeuvres, case.diagnosis.hypotheses) = (Vec::new(), Vec::new());
    (case.diagnosis.before, case.diagnosis.after) = Default::default();
    let html = case.render().html;
    assert!(
        html.contains("No hypothesis could be tested") && !html.contains("<section id=\"against\"")
    );
}
