//! The confusion table and the figures.

use std::collections::BTreeMap;

use crate::cases::Kind;
use crate::outcome::Outcome;

/// Prints the table of each ship, then the figures beside their targets.
pub fn print(outcomes: &[Outcome]) {
    let mut ships: BTreeMap<&str, Vec<&Outcome>> = BTreeMap::new();
    outcomes.iter().for_each(|outcome| ships.entry(&outcome.ship).or_default().push(outcome));
    println!(
        "\n| ship | hidden | verdict | named, first things first |\n| --- | --- | --- | --- |"
    );
    for (ship, outcomes) in &ships {
        for outcome in outcomes {
            println!(
                "| {ship} | {} | {} | {} |",
                outcome.case.label,
                outcome.verdict,
                named(outcome)
            );
        }
    }
    println!("\n| | {} | all | target |", ships.keys().copied().collect::<Vec<_>>().join(" | "));
    println!("| --- |{} ---: | ---: |", " ---: |".repeat(ships.len()));
    let all: Vec<&Outcome> = outcomes.iter().collect();
    for figure in FIGURES {
        let cells = ships.values().chain([&all]).map(|outcomes| figure.cell(outcomes));
        let cells: Vec<String> = cells.collect();
        println!("| {} | {} | {} |", figure.name, cells.join(" | "), figure.target);
    }
    sizes(&ships, &all);
    let mut wall: Vec<f64> = outcomes.iter().map(|outcome| outcome.wall_s).collect();
    wall.sort_by(f64::total_cmp);
    if let (Some(middle), Some(most)) = (wall.get(wall.len() / 2), wall.last()) {
        println!("\na diagnosis: {middle:.1} s in the median, at most {most:.1} s");
    }
}

fn named(outcome: &Outcome) -> String {
    let open = outcome.open.as_ref().filter(|_| outcome.is_unexplained());
    let open = open.map(|(channel, from, to)| {
        format!("open: {channel}, {:.0} to {:.0} %", 100.0 * from, 100.0 * to)
    });
    outcome.named.iter().cloned().chain(open).collect::<Vec<_>>().join(", ")
}

/// A share of some cases.
struct Figure {
    name: &'static str,
    of: fn(&Outcome) -> bool,
    right: fn(&Outcome) -> bool,
    target: &'static str,
}

const FIGURES: [Figure; 10] = [
    Figure {
        name: "single: right name first",
        of: is_single,
        right: Outcome::is_first,
        target: "",
    },
    Figure {
        name: "single not below its limit: right name first",
        of: |outcome| is_single(outcome) && !outcome.below_limit,
        right: Outcome::is_first,
        target: "95 %",
    },
    Figure {
        name: "single: exactly the right set",
        of: is_single,
        right: Outcome::is_exact,
        target: "85 %",
    },
    Figure { name: "pair: both names", of: is_pair, right: Outcome::has_all, target: "75 %" },
    Figure {
        name: "pair: exactly the right set",
        of: is_pair,
        right: Outcome::is_exact,
        target: "",
    },
    Figure {
        name: "control: nothing named",
        of: is_clean,
        right: |o| o.named.is_empty(),
        target: "95 %",
    },
    Figure {
        name: "control: not unexplained",
        of: is_clean,
        right: |o| !o.is_unexplained(),
        target: "",
    },
    Figure {
        name: "unlisted: unexplained",
        of: is_unlisted,
        right: Outcome::is_unexplained,
        target: "85 %",
    },
    Figure {
        name: "unlisted: channel and time",
        of: is_unlisted,
        right: Outcome::is_right_place,
        target: "85 %",
    },
    Figure {
        name: "changes: right names and times",
        of: |outcome| matches!(outcome.case.kind, Kind::Change(_)),
        right: Outcome::is_right_change,
        target: "",
    },
];

fn is_single(outcome: &Outcome) -> bool {
    outcome.case.kind == Kind::Single
}

fn is_pair(outcome: &Outcome) -> bool {
    outcome.case.kind == Kind::Pair
}

fn is_clean(outcome: &Outcome) -> bool {
    outcome.case.kind == Kind::Clean
}

fn is_unlisted(outcome: &Outcome) -> bool {
    matches!(outcome.case.kind, Kind::Unlisted(..))
}

impl Figure {
    fn cell(&self, outcomes: &[&Outcome]) -> String {
        let of: Vec<&&Outcome> = outcomes.iter().filter(|outcome| (self.of)(outcome)).collect();
        let right = of.iter().filter(|outcome| (self.right)(outcome)).count();
        format!("{right} of {}", of.len())
    }
}

/// Sizes within three standard errors.
fn sizes(ships: &BTreeMap<&str, Vec<&Outcome>>, all: &[&Outcome]) {
    let cell = |outcomes: &[&Outcome]| {
        let off: Vec<f64> = outcomes.iter().flat_map(|o| &o.estimates).map(|e| e.off).collect();
        format!("{} of {}", off.iter().filter(|off| off.abs() <= 3.0).count(), off.len())
    };
    let cells: Vec<String> = ships.values().map(|outcomes| cell(outcomes)).collect();
    println!(
        "| sizes within three standard errors | {} | {} | 90 % |",
        cells.join(" | "),
        cell(all)
    );
}
