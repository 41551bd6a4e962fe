//! What is hidden in which trials.

use rand::RngExt;
use sistership_tests::synthetic::replica;
use sistership_tests::truth::causes::{Course, Hidden};
use sistership_tests::truth::manoeuvre::Manoeuvre;

use crate::arguments::Arguments;
use crate::changing::changes;
use crate::listed::{other_authors, pairs, singles, steady_winds, unlisted};
use crate::ships::TrueShip;

/// What should come out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Kind {
    Single,
    /// The name of an effect at a share of its detection limit.
    AtLimit(f64),
    Pair,
    /// No name, but this channel from this share of the trial on.
    Unlisted(&'static str, f64),
    /// One of these effects as a change, from this share of the trial on; in whole trials where
    /// there is none.
    Change(Option<f64>),
    Clean,
    /// The same, with manoeuvres that are drawn by the seed.
    CleanSet,
}

/// A parameter by its name in the document, with the truth where the library's form has one.
pub type Size = (&'static str, f64);

/// One diagnosis.
#[derive(Debug, Clone)]
pub struct Case {
    pub label: String,
    pub kind: Kind,
    /// Names of the library's effects that are right.
    pub names: Vec<&'static str>,
    pub hidden: Hidden,
    pub sizes: Vec<Size>,
    pub seed: u64,
}

/// Clean sets of trials, for each set of random numbers.
const CLEAN: u64 = 3;

/// The cases of a ship.
pub fn cases(ship: &TrueShip, arguments: &Arguments) -> Vec<Case> {
    let mut all = Vec::new();
    let sets = (0..arguments.clean_sets).map(|set| 500 + set);
    all.extend(sets.map(|seed| Case { kind: Kind::CleanSet, ..clean(seed) }));
    let seeds = if all.is_empty() { arguments.seeds } else { 0 };
    for seed in 0..seeds {
        if !arguments.winds.is_empty() {
            all.extend(of_winds(ship, &arguments.winds, 50 * seed));
            continue;
        }
        if arguments.changes {
            all.extend(of_changes(ship, 50 * seed));
            continue;
        }
        for share in &arguments.sizes {
            all.extend(of_ship(ship, *share, 50 * seed));
        }
        all.extend((0..CLEAN).map(|k| clean(40 + k + 50 * seed)));
    }
    for case in &mut all {
        case.seed += 1000 * ship.seed;
    }
    all.into_iter().filter(|case| arguments.has(&case.label)).collect()
}

fn of_ship(ship: &TrueShip, share: f64, first: u64) -> Vec<Case> {
    let all = singles(&*ship.truth, share).into_iter().chain(pairs(&*ship.truth, share));
    // Seeds go by the place: further cases come last.
    let all = all.chain(unlisted(share)).chain(other_authors(&*ship.truth, share));
    let mut all: Vec<Case> = all.collect();
    for (place, case) in all.iter_mut().enumerate() {
        case.seed = first + place as u64;
        if share != 1.0 {
            case.label = format!("{} x{share}", case.label);
        }
    }
    all
}

/// Steady winds that trials record.
fn of_winds(ship: &TrueShip, speeds_m_s: &[f64], first: u64) -> Vec<Case> {
    let mut all: Vec<Case> =
        speeds_m_s.iter().flat_map(|speed| steady_winds(ship.truth.dimensions(), *speed)).collect();
    all.iter_mut().enumerate().for_each(|(place, case)| case.seed = first + place as u64);
    all
}

/// What begins within trials, or between them.
fn of_changes(ship: &TrueShip, first: u64) -> Vec<Case> {
    let mut all = changes(ship.truth.dimensions());
    all.iter_mut().enumerate().for_each(|(place, case)| case.seed = first + place as u64);
    all
}

/// Nothing hidden.
pub fn clean(seed: u64) -> Case {
    let (label, names) = ("clean".to_owned(), Vec::new());
    Case { label, kind: Kind::Clean, names, hidden: Hidden::default(), sizes: Vec::new(), seed }
}

/// Trials of a drawn set.
const DRAWN: usize = 3;

/// The new trials of a case.
pub fn courses(case: &Case) -> Vec<Course> {
    match case.kind {
        Kind::CleanSet => drawn(case.seed),
        _ => programme(),
    }
}

/// Zigzags, turns, turns that end and random orders, at random angles and headings.
fn drawn(seed: u64) -> Vec<Course> {
    let mut rng = replica(seed, 900);
    let course = |_| {
        let side = if rng.random_bool(0.5) { 1.0 } else { -1.0 };
        let angle = rng.random_range(10.0_f64..35.0).round();
        let manoeuvre = match rng.random_range(0..4) {
            0 => Manoeuvre::Zigzag(side * angle.min(25.0), rng.random_range(8.0_f64..20.0).round()),
            1 => Manoeuvre::Turn(side * angle),
            2 => Manoeuvre::PullOut(side * angle),
            _ => Manoeuvre::Random(angle, rng.random_range(10..10_000)),
        };
        Course { manoeuvre, heading_deg: rng.random_range(0.0_f64..360.0).round() }
    };
    (0..DRAWN).map(course).collect()
}

/// Two zigzags and a turn at two headings.
fn programme() -> Vec<Course> {
    let manoeuvres =
        [Manoeuvre::Zigzag(10.0, 10.0), Manoeuvre::Zigzag(20.0, 20.0), Manoeuvre::Turn(15.0)];
    let at = |manoeuvre| [0.0, 90.0].map(|heading_deg| Course { manoeuvre, heading_deg });
    manoeuvres.into_iter().flat_map(at).collect()
}
