//! Range of motion covered by trials, and excursions of simulations from it.

use std::collections::BTreeMap;

use sistership_formula::{Comparison, Expr, Function};
use sistership_model::law::Law;
use sistership_model::trial::{Channel, Trial};
use sistership_model::validity::{EXCURSION_TOLERANCE, Excursion, HalfSpace, Region};

use crate::covered_environment::covered_environment;
use crate::state::{StateVector, Trajectory, at};

/// Channels that bound a region, with their places in the state; revolutions are not part of it.
const BOUNDED_CHANNELS: [(Channel, Option<usize>); 5] = [
    (Channel::U, Some(at::U)),
    (Channel::V, Some(at::V)),
    (Channel::R, Some(at::R)),
    (Channel::Delta, Some(at::DELTA)),
    (Channel::N, None),
];

/// Returns the region of `u, v, r, delta` and, where the law has revolutions, `n` that trials
/// covered, and the wind and depth that they recorded. Channels that one of the trials lacks are
/// left out.
pub fn covered_region(trials: &[&Trial], law: &Law) -> Option<Region> {
    let bounds =
        |channel: Channel| channel != Channel::N || law.inputs.contains_key(channel.name());
    let column = |channel: Channel| -> Option<(String, Vec<f64>)> {
        let columns: Option<Vec<&[f64]>> =
            trials.iter().map(|trial| trial.channel(channel)).collect();
        Some((channel.name().to_owned(), columns?.concat()))
    };
    let columns: BTreeMap<String, Vec<f64>> = BOUNDED_CHANNELS
        .into_iter()
        .filter(|(channel, _)| bounds(*channel))
        .filter_map(|(channel, _)| column(channel))
        .collect();
    Some(Region { environment: covered_environment(trials), ..Region::from_samples(&columns)? })
}

/// Returns the distance of a motion from a region, in half ranges, as a formula of its channels; 0
/// inside. Directions along an unknown channel are left out.
pub fn distance_formula(region: &Region, is_known: &dyn Fn(&str) -> bool) -> Expr {
    let known = |face: &HalfSpace<'_>| face.terms.iter().all(|term| is_known(term.channel));
    // The distance from a convex region is the largest one over its directions.
    let faces = region.half_spaces();
    let furthest = faces.iter().filter(|face| known(face)).map(distance_beyond);
    let furthest = furthest.fold(Expr::Number(0.0), |a, b| Expr::Call(Function::Max, vec![a, b]));
    // Distances up to the slack count as inside.
    let parts = [furthest.clone(), Expr::Number(EXCURSION_TOLERANCE), furthest, Expr::Number(0.0)];
    Expr::If(Comparison::Greater, Box::new(parts))
}

/// Formula of the distance outside along one direction, below zero inside.
fn distance_beyond(face: &HalfSpace<'_>) -> Expr {
    let number = |value: f64| Box::new(Expr::Number(value));
    let along = face.terms.iter().fold(Expr::Number(0.0), |sum, term| {
        let channel = Box::new(Expr::Name(term.channel.to_owned()));
        let from_centre = Expr::Subtract(channel, number(term.centre));
        Expr::Add(Box::new(sum), Box::new(from_centre.times(Expr::Number(term.factor))))
    });
    let below = Expr::Subtract(number(face.bounds[0]), Box::new(along.clone()));
    let above = Expr::Subtract(Box::new(along), number(face.bounds[1]));
    Expr::Call(Function::Max, vec![below, above])
}

/// Returns the excursion of a motion from a region; `None` if it stays inside.
pub fn find_excursion(region: &Region, track: &Trajectory) -> Option<Excursion> {
    let of_state = |state: &StateVector, n_rps: f64, name: &str| {
        let (_, place) =
            BOUNDED_CHANNELS.into_iter().find(|(channel, _)| channel.name() == name)?;
        Some(place.map_or(n_rps, |place| state[place]))
    };
    region.find_excursion(&track.t_s, &|k, name| of_state(&track.states[k], track.n_rps[k], name))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::Ship;
    use crate::manoeuvre::{ManoeuvreSettings, simulate_turn, simulate_zigzag};
    use crate::state::RECORDED_CHANNELS;
    use sistership_model::Zoo;

    fn recorded(track: &Trajectory) -> Trial {
        let columns = RECORDED_CHANNELS[..6].iter().chain(&[(Channel::Delta, at::DELTA)]);
        let channels =
            columns.map(|&(channel, place)| (channel, track.state_column(place))).collect();
        Trial { t_s: track.t_s.clone(), channels, ..Trial::default() }
    }

    #[test]
    fn a_hard_turn_leaves_what_a_zigzag_covered() {
        let zoo = Zoo::load_embedded().unwrap();
        let model = zoo.find_model("mariner").unwrap();
        let law = zoo.law(&model.law).unwrap();
        let ship = Ship::new(&model, law).unwrap();
        let settings = ManoeuvreSettings::default();
        let trial = recorded(&simulate_zigzag(&ship, 10.0, 10.0, &settings).unwrap().track);
        let region = covered_region(&[&trial], law).unwrap();
        assert!(!region.ranges.contains_key("n"), "the Mariner's law takes no revolutions");
        assert_eq!(
            find_excursion(&region, &simulate_zigzag(&ship, 10.0, 10.0, &settings).unwrap().track),
            None
        );
        let hard =
            find_excursion(&region, &simulate_turn(&ship, 35.0, &settings).unwrap().track).unwrap();
        assert!(hard.first_s < 10.0 && hard.share > 0.9 && hard.beyond > 1.0, "{hard:?}");
    }
}
