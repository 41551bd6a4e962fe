//! What a diagnosis made of a case.

use serde_json::Value;

use crate::cases::{Case, Kind};
use crate::diagnosed::Durations;
use crate::limits;

/// A size that was found beside the true one.
#[derive(Debug, Clone)]
pub struct Estimate {
    pub name: String,
    /// By how many standard errors it is off.
    pub off: f64,
}

/// What came out of a case.
pub struct Outcome {
    pub ship: String,
    pub case: Case,
    /// First things first.
    pub named: Vec<String>,
    pub verdict: String,
    pub estimates: Vec<Estimate>,
    /// Changes: effect, and at which share of the trial where they begin or end within it.
    pub changes: Vec<(String, Option<f64>)>,
    /// What no effect explains: the acceleration or the readings from which it comes, and from when
    /// to when it is strongest, by its trial.
    pub open: Option<(String, f64, f64)>,
    /// Whether the smallest size that would have been shown is above what was hidden.
    pub below_limit: bool,
    pub wall_s: f64,
    /// Evidence of what is named.
    evidence: Vec<f64>,
    /// Accelerations with what they go with, where no segment stands out.
    patterns: Vec<String>,
}

impl Outcome {
    pub fn new(
        ship: String,
        case: Case,
        answer: &Value,
        durations_s: &Durations,
        wall_s: f64,
    ) -> Self {
        let effects = answer["effects"].as_array().cloned().unwrap_or_default();
        let name = |effect: &Value| effect["name"].as_str().unwrap_or_default().to_owned();
        let evidence = |effect: &Value| effect["evidence"].as_f64().unwrap_or_default();
        let right = effects.iter().filter(|effect| case.names.contains(&name(effect).as_str()));
        Self {
            named: effects.iter().map(name).collect(),
            verdict: answer["verdict"].as_str().unwrap_or_default().to_owned(),
            estimates: right.flat_map(|effect| estimates(effect, &case)).collect(),
            changes: changes(&answer["changes"], durations_s),
            open: strongest(answer, durations_s),
            below_limit: limits::is_below(&answer["limits"], &case),
            evidence: effects.iter().map(evidence).collect(),
            patterns: answer["patterns"].as_array().into_iter().flatten().map(pattern).collect(),
            ship,
            case,
            wall_s,
        }
    }

    /// Whether the name that comes first is one of those hidden.
    pub fn is_first(&self) -> bool {
        self.named.first().is_some_and(|name| self.case.names.contains(&name.as_str()))
    }

    /// Whether what is named is what is hidden, no more and no less; nothing of what has no name.
    pub fn is_exact(&self) -> bool {
        self.named.len() == self.case.names.len()
            && self.named.iter().all(|name| self.case.names.contains(&name.as_str()))
    }

    /// Whether all that is hidden is among what is named.
    pub fn has_all(&self) -> bool {
        self.case.names.iter().all(|name| self.named.iter().any(|named| named == name))
    }

    /// Whether something is called unexplained.
    pub fn is_unexplained(&self) -> bool {
        self.verdict == "unexplained"
    }

    /// Whether it is so in the right channel, with its middle in the right time.
    pub fn is_right_place(&self) -> bool {
        let Kind::Unlisted(channel, from) = self.case.kind else { return false };
        let holds = |(open, begins, ends): &(String, f64, f64)| {
            open == channel && 0.5 * (begins + ends) >= 0.8 * from
        };
        self.is_unexplained() && self.open.as_ref().is_some_and(holds)
    }

    /// Whether every change has a right name and, where it begins within trials, the right time.
    pub fn is_right_change(&self) -> bool {
        let Kind::Change(from) = self.case.kind else { return false };
        let is_right = |(name, at): &(String, Option<f64>)| {
            let near = |(at, from): (&f64, f64)| (at - from).abs() <= 0.05;
            self.case.names.contains(&name.as_str())
                && at.is_some() == from.is_some()
                && at.as_ref().zip(from).is_none_or(near)
        };
        !self.changes.is_empty() && self.changes.iter().all(is_right)
    }

    fn is_right(&self) -> bool {
        match self.case.kind {
            Kind::Single | Kind::Pair => self.is_exact(),
            Kind::AtLimit(share) => self.is_first() == (share > 1.0),
            Kind::Unlisted(..) => self.is_right_place(),
            Kind::Change(_) => self.is_right_change(),
            Kind::Clean | Kind::CleanSet => self.is_silent(),
        }
    }

    /// Returns true if nothing is named and nothing is unexplained.
    pub fn is_silent(&self) -> bool {
        self.named.is_empty() && !self.is_unexplained()
    }

    /// Evidence of the most evident effect; minus infinity where none is named.
    pub fn largest_evidence(&self) -> f64 {
        self.evidence.iter().copied().fold(f64::NEG_INFINITY, f64::max)
    }

    /// Names with their evidence, and what is unexplained.
    pub fn description(&self) -> String {
        let named = self.named.iter().zip(&self.evidence);
        let named = named.map(|(name, evidence)| format!("{name} {evidence:.0}"));
        let open = self.open.as_ref().filter(|_| self.is_unexplained());
        let open = open.map(|(channel, ..)| match self.patterns.is_empty() {
            true => format!("unexplained {channel}"),
            false => format!("unexplained {}", self.patterns.join(", ")),
        });
        named.chain(open).collect::<Vec<_>>().join(", ")
    }

    pub fn line(&self) -> String {
        let off = |estimate: &Estimate| format!("{} {:+.1} se", estimate.name, estimate.off);
        let off: Vec<String> = self.estimates.iter().map(off).collect();
        let open = self.open.as_ref().map(|(channel, from, to)| {
            format!(" open {channel} {:.0}-{:.0} %", 100.0 * from, 100.0 * to)
        });
        let at = |(name, at): &(String, Option<f64>)| match at {
            Some(at) => format!("{name} at {:.0} %", 100.0 * at),
            None => format!("{name} in one trial"),
        };
        let changes: Vec<String> = self.changes.iter().map(at).collect();
        let changes = if changes.is_empty() { String::new() } else { changes.join(", ") + "; " };
        format!(
            "{} {:22} {:28} {}: [{}]{} {changes}{}{} {:.1} s",
            if self.is_right() { " " } else { "X" },
            self.ship,
            self.case.label,
            self.verdict,
            self.description(),
            open.unwrap_or_default(),
            off.join(", "),
            if self.below_limit { " below the limit" } else { "" },
            self.wall_s
        )
    }
}

/// An acceleration, what it goes with, and the evidence for it.
fn pattern(told: &Value) -> String {
    let text = |name: &str| told[name].as_str().unwrap_or_default().to_owned();
    let evidence = told["evidence"].as_f64().unwrap_or_default();
    format!("{} by {} {evidence:.0}", text("channel"), text("variable"))
}

fn estimates(effect: &Value, case: &Case) -> Vec<Estimate> {
    let one = |(name, truth): &(&str, f64)| {
        let value = &effect["parameters"][*name];
        let off = (value["value"].as_f64()? - truth) / value["se"].as_f64()?;
        Some(Estimate { name: (*name).to_owned(), off })
    };
    case.sizes.iter().filter_map(one).collect()
}

fn changes(changes: &Value, durations_s: &Durations) -> Vec<(String, Option<f64>)> {
    let one = |change: &Value| {
        let name = change["effect"].as_str().unwrap_or_default().to_owned();
        (name, change["at_s"].as_f64().and_then(|at_s| share(change, at_s, durations_s)))
    };
    changes.as_array().into_iter().flatten().map(one).collect()
}

/// A time of a trial, by how long it is.
fn share(told: &Value, t_s: f64, durations_s: &Durations) -> Option<f64> {
    Some(t_s / durations_s.get(told["trial"].as_str()?)?)
}

fn strongest(answer: &Value, durations_s: &Durations) -> Option<(String, f64, f64)> {
    let first = answer["unexplained"].as_array()?.first()?;
    let share = |name: &str| share(first, first[name].as_f64()?, durations_s);
    let origin = &answer["origins"][0];
    let channel = origin["channel"].as_str()?;
    let readings = if origin["of"] == "readings" { "readings of " } else { "" };
    Some((format!("{readings}{channel}"), share("from_s")?, share("to_s")?))
}
