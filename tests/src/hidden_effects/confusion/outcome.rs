//! What a diagnosis made of a case.

use sistership_diagnosis::{
    Diagnosis, MissingEffect, RemainderDependence, UnexplainedSegment, ValueWithError,
    VariableDependence, Verdict,
};
use sistership_model::Trial;
use sistership_model::effect::AppliedEffect;

use super::super::cases::{Case, Kind};
use super::known;

/// A parameter of an effect that was found.
pub struct Estimate {
    name: String,
    value: ValueWithError,
    truth: f64,
}

impl Estimate {
    fn line(&self) -> String {
        format!(
            "{} {:.4e} for {:.4e} ({:+.1} se)",
            self.name,
            self.value.value,
            self.truth,
            self.off()
        )
    }

    /// How many standard errors it is off.
    pub fn off(&self) -> f64 {
        (self.value.value - self.truth) / self.value.se
    }
}

/// What came out of a case.
pub struct Outcome {
    pub label: String,
    pub kind: Kind,
    /// What should be named.
    pub truth: Vec<String>,
    /// What was named, first things first.
    pub named: Vec<String>,
    pub verdict: Verdict,
    pub unexplained: Vec<UnexplainedSegment>,
    /// On what depends what is left.
    pub depends_on: Vec<RemainderDependence>,
    pub parameters: Vec<Estimate>,
    /// Against a model that knows the effects.
    pub ratio: Option<f64>,
    pub seconds: f64,
    seed: u64,
    evidence: Vec<String>,
}

impl Outcome {
    pub fn new(case: &Case, diagnosis: &Diagnosis, trials: &[&Trial], seconds: f64) -> Self {
        let effects = &case.hidden.effects;
        let hides = matches!(case.kind, Kind::Single(_) | Kind::Pair);
        let evidence =
            |found: &MissingEffect| format!("{}/{} {:.0}", found.name, found.form, found.evidence);
        Self {
            label: case.label.clone(),
            kind: case.kind,
            truth: effects.iter().map(|effect| effect.name.clone()).collect(),
            named: diagnosis.effects.iter().map(|found| found.name.clone()).collect(),
            verdict: diagnosis.verdict,
            unexplained: diagnosis.unexplained.clone(),
            depends_on: diagnosis.depends_on.clone(),
            parameters: effects
                .iter()
                .flat_map(|effect| deviations(effect, &diagnosis.effects))
                .collect(),
            ratio: if hides { known::ratio(diagnosis, effects, trials) } else { None },
            seconds,
            seed: case.seed,
            evidence: diagnosis.effects.iter().map(evidence).collect(),
        }
    }

    pub fn is_right(&self) -> bool {
        match self.kind {
            Kind::Single(_) => self.named.first() == self.truth.first(),
            Kind::Pair => self.truth.iter().all(|name| self.named.contains(name)),
            Kind::Unlisted(..) => self.verdict == Verdict::Unexplained,
            Kind::Clean => self.named.is_empty() && self.verdict == Verdict::Complete,
        }
    }

    /// Whether the strongest of what is unexplained is of the right channel, with its middle in the
    /// right time.
    pub fn is_right_place(&self) -> bool {
        let Kind::Unlisted(channel, from_s, to_s) = self.kind else { return false };
        let strongest =
            self.unexplained.iter().max_by(|a, b| a.rms_over_noise.total_cmp(&b.rms_over_noise));
        let holds = |found: &UnexplainedSegment| {
            let middle_s = 0.5 * (found.from_s + found.to_s);
            found.channel == channel && from_s <= middle_s && middle_s <= to_s
        };
        self.is_right() && strongest.is_some_and(holds)
    }

    /// The share of the strength, the pair, the unlisted effect.
    pub fn line(&self) -> String {
        let off: Vec<String> = self.parameters.iter().map(Estimate::line).collect();
        let open = |u: &UnexplainedSegment| {
            format!("{} {:.1} {:.0}-{:.0} s", u.channel, u.rms_over_noise, u.from_s, u.to_s)
        };
        let open: Vec<String> = self.unexplained.iter().take(3).map(open).collect();
        let left: Vec<String> = self.depends_on.iter().map(left).collect();
        format!(
            "{} {} {:?} seed {}: {:?} [{}] open [{}] by [{}] ratio {:.2} {} {:.1} s",
            if self.is_right() { "  " } else { "X " },
            self.label,
            self.kind,
            self.seed,
            self.verdict,
            self.evidence.join(", "),
            open.join(", "),
            left.join(", "),
            self.ratio.unwrap_or(f64::NAN),
            off.join(", "),
            self.seconds
        )
    }
}

/// `v 0.62: psi 0.90, u 0.11`: the channel, the share explained, variables with their shares.
fn left(of: &RemainderDependence) -> String {
    let one =
        |variable: &VariableDependence| format!("{} {:.2}", variable.variable, variable.share);
    let variables: Vec<String> = of.variables.iter().map(one).collect();
    format!("{} {:.2}: {}", of.channel, of.explained, variables.join(", "))
}

/// How far the parameters of an effect that was found in its true form are from the truth, in
/// standard errors.
fn deviations(effect: &AppliedEffect, found: &[MissingEffect]) -> Vec<Estimate> {
    let Some(found) =
        found.iter().find(|found| found.name == effect.name && found.form == effect.form.name)
    else {
        return Vec::new();
    };
    let off = |(name, truth): (&String, &sistership_model::quantity::Quantity)| {
        Some(Estimate {
            name: name.clone(),
            value: *found.parameters.get(name)?,
            truth: truth.value,
        })
    };
    effect.parameters.iter().filter_map(off).collect()
}
