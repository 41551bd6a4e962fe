//! A diagnosis that was not computed.

use std::collections::BTreeMap;

use sistership_diagnosis::{
    ChangeCourse, ConfoundedEffect, DetectionLimit, Diagnosis, DiscrepancyLevel, EffectChange,
    HypothesisReport, LimitedBy, ManoeuvreOutcome, MissingEffect, NextTrial, OriginKind,
    RemainderDependence, RemainderOrigin, ResidualSeries, Settings, TrialErrors,
    UnexplainedSegment, ValueWithError, VariableDependence, Verdict,
};
use sistership_model::effect::ActsOn;
use sistership_model::quantity::Quantity;
use sistership_model::trial::{Channel, Trial};
use sistership_model::{Model, Zoo};
use sistership_simulation::metrics::{ManoeuvreMetrics, TurningMetrics};

use crate::diagnosis::{DiagnosisInput, render_diagnosis};
use crate::{RenderedReport, VersionLabel};

pub struct Case {
    zoo: Zoo,
    model: Model,
    trials: Vec<Trial>,
    pub diagnosis: Diagnosis,
}

impl Case {
    pub fn new() -> Self {
        let zoo = Zoo::load_embedded().unwrap();
        let model = zoo.find_model("mariner").unwrap();
        let mut after = model.clone();
        after.coefficients.insert("Y_v".into(), Quantity::new(-0.012, "fitted"));
        let trials = vec![trial("zz<1>", 0.2), trial("turn", 0.3)];
        Self { diagnosis: diagnosis(after), zoo, model, trials }
    }

    pub fn render(&self) -> RenderedReport {
        let trials: Vec<&Trial> = self.trials.iter().collect();
        let label =
            |number| VersionLabel { ship: "mariner".into(), number, sha256: "ab".repeat(32) };
        let law = self.zoo.law(&self.model.law).unwrap();
        let (of, made) = (Some(label(1)), Some(label(3)));
        let input = DiagnosisInput {
            diagnosis: &self.diagnosis,
            model: &self.model,
            law,
            trials: &trials,
            of,
            made,
        };
        render_diagnosis(&input).unwrap()
    }
}

/// Ten minutes of gentle turns by a formula.
fn trial(name: &str, rudder: f64) -> Trial {
    let mut trial =
        Trial { name: name.into(), manoeuvre: Some("zigzag 10/10".into()), ..Trial::default() };
    for k in 0..600 {
        let t = f64::from(k);
        let (r, psi) = (0.005 * (t / 40.0).sin(), 0.2 * (1.0 - (t / 40.0).cos()));
        let sample = [7.7, -20.0 * r, r, psi, 7.7 * t, 0.5 * t, rudder * (t / 40.0).sin()];
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
    }
    trial
}

fn errors(scale: f64) -> BTreeMap<String, f64> {
    let all = [("u", 0.04), ("v", 0.05), ("r", 0.001), ("psi", 0.02), ("x", 12.0), ("y", 9.0)];
    all.map(|(channel, error)| (channel.to_owned(), scale * error)).into()
}

fn values(all: &[(&str, f64, f64)]) -> BTreeMap<String, ValueWithError> {
    all.iter().map(|&(name, value, se)| (name.to_owned(), ValueWithError { value, se })).collect()
}

fn current() -> MissingEffect {
    MissingEffect {
        name: "current".into(),
        form: "constant".into(),
        meaning: "one current for all trials".into(),
        acts_on: ActsOn::Inflow,
        parameters: values(&[
            ("north_m_s", 0.425, 0.02),
            ("east_m_s", 0.425, 0.02),
            ("speed_m_s", 0.601, 0.02),
            ("towards_deg", 45.2, 1.9),
        ]),
        evidence: 41.2,
        in_model: BTreeMap::new(),
        confounded_with: vec![ConfoundedEffect {
            name: "wind".into(),
            angle_deg: 4.1,
            behind: 1.2,
        }],
    }
}

fn hypothesis(effects: &[&str], evidence: f64, taken: bool) -> HypothesisReport {
    let effects = effects.iter().map(|&effect| effect.to_owned()).collect();
    HypothesisReport {
        effects,
        evidence,
        held_out: taken.then_some(30.5),
        parameters: current().parameters,
        taken,
        refused: None,
    }
}

/// One judged twice on the way, and so many others that the last are folded away.
fn hypotheses() -> Vec<HypothesisReport> {
    let first = [
        ("current/constant", 41.2, true),
        ("current/constant", 41.0, false),
        ("wind/constant", 40.0, false),
    ];
    let mut all: Vec<HypothesisReport> =
        first.map(|(effect, evidence, taken)| hypothesis(&[effect], evidence, taken)).into();
    all.extend((0..12).map(|k| {
        hypothesis(
            &["wave-drift/towards", &format!("missing-term/Y_{k}")],
            3.0 - f64::from(k),
            false,
        )
    }));
    all
}

fn residual(trial: &str, channel: &str) -> ResidualSeries {
    let t_s: Vec<f64> = (0..300).map(|k| 2.0 * f64::from(k)).collect();
    let before: Vec<f64> = t_s.iter().map(|t| 0.002 * (t / 60.0).sin()).collect();
    let after = before.iter().map(|value| 0.1 * value).collect();
    let (band, variable) = (vec![0.0005; t_s.len()], t_s.iter().map(|t| t / 100.0).collect());
    ResidualSeries {
        trial: trial.into(),
        channel: channel.into(),
        t_s,
        before,
        after,
        band,
        against: "psi".into(),
        variable,
    }
}

fn sailed() -> ManoeuvreOutcome {
    let turn = |advance_m| {
        ManoeuvreMetrics::Turn(TurningMetrics {
            rudder_deg: 20.0,
            advance_m: Some(advance_m),
            transfer_m: Some(300.0),
            tactical_diameter_m: Some(700.0),
            steady_radius_m: Some(330.0),
            max_advance_m: 620.0,
            max_transfer_m: 720.0,
            speed_loss_m_s: 2.0,
        })
    };
    ManoeuvreOutcome {
        trial: "turn".into(),
        measured: turn(600.0),
        before: Some(turn(540.0)),
        after: Some(turn(597.0)),
    }
}

fn limits() -> Vec<DetectionLimit> {
    let limit = |effect: &str, parameter: &str, size, limited_by| DetectionLimit {
        effect: effect.into(),
        form: "constant".into(),
        parameter: parameter.into(),
        size,
        usual: 0.03,
        limited_by,
    };
    vec![
        limit("rudder-offset", "offset_rad", Some(0.002), None),
        limit("wave-drift", "north", None, Some(LimitedBy::Model)),
    ]
}

/// A rudder that was hit in a turn.
fn damage() -> EffectChange {
    EffectChange {
        effect: "rudder-damage".into(),
        form: "share-lost".into(),
        meaning: "a share of the rudder's angle does nothing".into(),
        trial: "turn".into(),
        course: ChangeCourse::Begins,
        at_s: Some(310.0),
        between_s: Some([300.0, 320.0]),
        parameters: [("share_lost_percent".to_owned(), ValueWithError { value: 35.0, se: 2.0 })]
            .into(),
        evidence: 80.0,
        or: Vec::new(),
    }
}

/// A moment that is missing, more likely than a compass that wanders.
fn origins() -> Vec<RemainderOrigin> {
    let one = |of: OriginKind, channel: &str, evidence: f64, first_in: usize| RemainderOrigin {
        of,
        channel: channel.to_owned(),
        evidence,
        first_in,
        trials: 2,
    };
    vec![one(OriginKind::Acceleration, "r", 412.3, 2), one(OriginKind::Readings, "psi", 96.0, 0)]
}

/// What follows the rudder, and the heading less.
fn depends_on() -> RemainderDependence {
    let variable = |variable: &str, share: f64| VariableDependence {
        variable: variable.to_owned(),
        share,
        at: vec![-0.3, 0.0, 0.3],
        remainder: vec![-2e-4, 0.0, 1e-4],
    };
    let variables = vec![variable("delta", 0.6), variable("psi", 0.2)];
    RemainderDependence { channel: "r".to_owned(), explained: 0.7, variables }
}

fn diagnosis(after: Model) -> Diagnosis {
    let residuals = ["zz<1>", "turn"]
        .into_iter()
        .flat_map(|name| [residual(name, "u"), residual(name, "r")])
        .collect();
    let stretch = UnexplainedSegment {
        channel: "r".into(),
        rms_over_noise: 3.1,
        trial: "turn".into(),
        from_s: 300.0,
        to_s: 500.0,
    };
    let level =
        DiscrepancyLevel { channel: "r".into(), expected: Some(1e-5), before: 8e-5, after: 1.1e-5 };
    let separates = vec!["wind".to_owned(), "current".to_owned()];
    let next = NextTrial {
        manoeuvre: "zigzag 10/10".into(),
        speed_m_s: 7.0,
        heading_deg: 90.0,
        separates,
        expected: 12.0,
    };
    Diagnosis {
        verdict: Verdict::Effects,
        effects: vec![current()],
        unexplained: vec![stretch],
        patterns: Vec::new(),
        history: None,
        changes: vec![damage()],
        origins: origins(),
        depends_on: vec![depends_on()],
        limits: limits(),
        cannot_tell: BTreeMap::from([("wave-drift".to_owned(), LimitedBy::Model)]),
        prior_odds: BTreeMap::from([("current".to_owned(), 0.5), ("wave-drift".to_owned(), 0.15)]),
        next_trial: Some(next),
        before: errors(1.0),
        after: errors(0.2),
        noise: errors(0.1),
        how: "each trial left out in turn".into(),
        diagnosed: "mariner/abkowitz".into(),
        hypotheses: hypotheses(),
        trials: vec![TrialErrors { trial: "turn".into(), before: errors(1.1), after: errors(0.3) }],
        manoeuvres: vec![sailed()],
        residuals,
        discrepancies: vec![level],
        model: Some(after),
        settings: Settings::default(),
        remarks: vec!["a remark".into()],
    }
}
