//! Clean sets that are not silent, by ship and by the least evidence of what is named.

use std::collections::BTreeMap;

use crate::outcome::Outcome;

/// Evidence (natural logarithm) at which alarms are counted; the first is the default.
const LEVELS: [f64; 4] = [5.0, 6.0, 8.0, 10.0];

/// Prints the sets of each ship, then the shares of all.
pub fn print(outcomes: &[Outcome]) {
    let mut ships: BTreeMap<&str, Vec<&Outcome>> = BTreeMap::new();
    outcomes.iter().for_each(|outcome| ships.entry(&outcome.ship).or_default().push(outcome));
    println!("\n| ship | sets | silent | alarms |\n| --- | --: | --: | --- |");
    for (ship, sets) in &ships {
        let alarms: Vec<&&Outcome> = sets.iter().filter(|set| !set.is_silent()).collect();
        let described: Vec<String> = alarms.iter().map(|alarm| alarm.description()).collect();
        let silent = sets.len() - alarms.len();
        println!("| {ship} | {} | {silent} | {} |", sets.len(), described.join("; "));
    }
    println!("\n| | {} |", LEVELS.map(|level| format!("evidence {level}")).join(" | "));
    println!("| --- |{}", " --: |".repeat(LEVELS.len()));
    let row = |name: &str, is_alarm: &dyn Fn(&Outcome, f64) -> bool| {
        let count = |level: f64| outcomes.iter().filter(|set| is_alarm(set, level)).count();
        let cells = LEVELS.map(|level| format!("{} of {}", count(level), outcomes.len()));
        println!("| {name} | {} |", cells.join(" | "));
    };
    row("named", &|set, level| set.largest_evidence() >= level);
    row("unexplained", &|set, _| set.is_unexplained());
    row("either", &|set, level| set.largest_evidence() >= level || set.is_unexplained());
}
