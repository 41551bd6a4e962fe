//! The targets that the table is held against.

use super::super::cases::{Kind, STRENGTHS};
use super::outcome::Outcome;

/// Prints every figure beside its target, and gives those that miss it.
pub fn print(outcomes: &[Outcome]) -> Vec<String> {
    let mut misses = Vec::new();
    {
        let mut judge = |what: String, share: Option<(usize, usize)>, least: f64| {
            let Some((right, count)) = share.filter(|(_, count)| *count > 0) else { return };
            let share = right as f64 / count as f64;
            let line = format!(
                "{what}: {right} of {count}, {:.1} % (target {:.0} %)",
                100.0 * share,
                100.0 * least
            );
            println!("{line}");
            if share < least {
                misses.push(line);
            }
        };
        println!();
        for (share, least) in STRENGTHS.into_iter().zip([0.95, 0.95, 0.8]) {
            judge(
                format!("right name first at {share:.1}"),
                count(outcomes, |o| o.kind == Kind::Single(share), Outcome::is_right),
                least,
            );
        }
        judge(
            "nothing named on clean trials".into(),
            count(outcomes, |o| o.kind == Kind::Clean, |o| o.named.is_empty()),
            0.95,
        );
        judge(
            "both names of a pair".into(),
            count(outcomes, |o| o.kind == Kind::Pair, Outcome::is_right),
            0.8,
        );
        let is_unlisted = |outcome: &Outcome| matches!(outcome.kind, Kind::Unlisted(..));
        judge("unlisted: unexplained".into(), count(outcomes, is_unlisted, Outcome::is_right), 0.9);
        judge(
            "unlisted: right channel and time".into(),
            count(outcomes, is_unlisted, Outcome::is_right_place),
            0.9,
        );
        let off: Vec<f64> = outcomes
            .iter()
            .flat_map(|outcome| &outcome.parameters)
            .map(|estimate| estimate.off().abs())
            .collect();
        let within = off.iter().filter(|off| **off <= 3.0).count();
        judge("parameters within three standard errors".into(), Some((within, off.len())), 0.9);
    }
    misses.extend(ratios(outcomes));
    misses
}

fn count(
    outcomes: &[Outcome],
    of: impl Fn(&Outcome) -> bool,
    right: impl Fn(&Outcome) -> bool,
) -> Option<(usize, usize)> {
    let of: Vec<&Outcome> = outcomes.iter().filter(|outcome| of(outcome)).collect();
    Some((of.iter().filter(|outcome| right(outcome)).count(), of.len()))
}

/// Held-out errors against those of a model that knows the effect, where the right one was named.
fn ratios(outcomes: &[Outcome]) -> Option<String> {
    let mut ratios: Vec<f64> = outcomes
        .iter()
        .filter(|outcome| outcome.is_right())
        .filter_map(|outcome| outcome.ratio)
        .collect();
    ratios.sort_by(f64::total_cmp);
    let at =
        |share: f64| ratios.get(((ratios.len() as f64 - 1.0) * share).round() as usize).copied();
    let (median, ninetieth) = (at(0.5)?, at(0.9)?);
    let line = format!(
        "error after by that with the effect known: median {median:.2}, 90 % below {ninetieth:.2} \
         (target 1.3)"
    );
    println!("{line}");
    (ninetieth > 1.3).then_some(line)
}
