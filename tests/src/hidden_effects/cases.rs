//! What is hidden: single effects at three strengths, pairs, what no library has, and nothing.

mod listed;

use super::truth::{Hidden, Manoeuvre, Sailing, Unlisted};
use listed::{PAIRS, SINGLES, hidden};

/// One diagnosis.
#[derive(Debug, Clone)]
pub struct Case {
    pub label: String,
    pub kind: Kind,
    pub hidden: Hidden,
    /// Of the noise; the same whatever part of the table is run.
    pub seed: u64,
}

/// What should come out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Kind {
    /// The name of the effect at a share of its full strength.
    Single(f64),
    /// Both names.
    Pair,
    /// No name, but this channel between these times, s.
    Unlisted(&'static str, f64, f64),
    /// Nothing at all.
    Clean,
}

/// Shares of the full strength.
pub const STRENGTHS: [f64; 3] = [1.0, 0.5, 0.3];

/// Which part of the table is run.
pub struct Part {
    pub cases: Option<Vec<String>>,
    pub strengths: Vec<f64>,
    pub seeds: u64,
    /// Whether the targets are judged on it.
    pub is_judged: bool,
}

/// Strengths and seeds where nothing else is said: the weakest, once. The whole table takes an
/// hour.
const DEFAULT_STRENGTHS: [f64; 1] = [0.3];
const DEFAULT_SEEDS: u64 = 1;
const ALL_SEEDS: u64 = 3;

impl Part {
    /// As the environment says.
    pub fn of_environment() -> Self {
        let list = |name: &str| {
            Some(std::env::var(name).ok()?.split(',').map(str::to_owned).collect::<Vec<_>>())
        };
        let seeds = std::env::var("DIAGNOSIS_SEEDS").ok().map(|text| text.parse::<u64>().unwrap());
        let cases = list("DIAGNOSIS_CASES");
        let strengths = list("DIAGNOSIS_STRENGTHS");
        let is_judged =
            cases.is_none() && strengths.is_none() && seeds.is_none_or(|seeds| seeds >= ALL_SEEDS);
        let strengths = strengths.map(|all| all.iter().map(|text| text.parse().unwrap()).collect());
        let default = if seeds.is_none() { DEFAULT_STRENGTHS.to_vec() } else { STRENGTHS.to_vec() };
        Self {
            cases,
            strengths: strengths.unwrap_or(default),
            seeds: seeds.unwrap_or(DEFAULT_SEEDS),
            is_judged,
        }
    }

    fn has(&self, case: &Case, number: u64) -> bool {
        let named = |wanted: &String| {
            case.label == *wanted || case.label.split(['/', '+']).next() == Some(wanted.as_str())
        };
        let strength = if let Kind::Single(share) = case.kind {
            self.strengths.contains(&share)
        } else {
            true
        };
        // Clean trials are few in the table and must tell 5 % from none.
        let seeds = if case.kind == Kind::Clean {
            if self.seeds >= ALL_SEEDS { 20 } else { 7 * self.seeds }
        } else {
            self.seeds
        };
        strength
            && number < seeds
            && self.cases.as_ref().is_none_or(|wanted| wanted.iter().any(named))
    }
}

/// The cases of a part.
pub fn cases(part: &Part) -> Vec<Case> {
    let all = every_kind().into_iter().enumerate();
    let seeded = all.flat_map(|(row, case)| {
        (0..20).map(move |n| (n, Case { seed: 100 * (row as u64 + 1) + n, ..case.clone() }))
    });
    seeded.filter(|(number, case)| part.has(case, *number)).map(|(_, case)| case).collect()
}

fn every_kind() -> Vec<Case> {
    let case = |label: &str, kind, hidden| Case { label: label.to_owned(), kind, hidden, seed: 0 };
    let singles = SINGLES.iter().flat_map(|label| {
        STRENGTHS.map(|share| case(label, Kind::Single(share), hidden(&[label], share)))
    });
    let pairs = PAIRS.iter().map(|pair| case(&pair.join("+"), Kind::Pair, hidden(pair, 1.0)));
    let clean = case("clean", Kind::Clean, Hidden::default());
    let mut all: Vec<Case> =
        singles.chain(pairs).chain(STRENGTHS.into_iter().flat_map(unlisted)).collect();
    all.push(clean);
    all
}

fn unlisted(share: f64) -> [Case; 3] {
    let case = |label: &str, channel, from_s, unlisted| {
        let hidden = Hidden { unlisted: Some(unlisted), ..Hidden::default() };
        Case {
            label: format!("{label}/{share}"),
            kind: Kind::Unlisted(channel, from_s, 650.0),
            hidden,
            seed: 0,
        }
    };
    [
        case("thrust-loss", "u", 325.0, Unlisted::ThrustLoss { share: 0.3 * share }),
        case(
            "oscillating-moment",
            "r",
            0.0,
            Unlisted::OscillatingMoment { amplitude_rad_s2: 5e-5 * share },
        ),
        case("heading-force", "v", 0.0, Unlisted::HeadingForce { amplitude_m_s2: 0.01 * share }),
    ]
}

/// The new trials: two zigzags and a turn at two headings.
pub fn programme() -> Vec<Sailing> {
    let manoeuvres =
        [Manoeuvre::Zigzag(10.0, 10.0), Manoeuvre::Zigzag(20.0, 10.0), Manoeuvre::Turn(12.0)];
    let at = |manoeuvre| {
        [0.0, 90.0].map(|heading_deg| Sailing { manoeuvre, heading_deg, execute_s: 60.0 })
    };
    manoeuvres.into_iter().flat_map(at).collect()
}
