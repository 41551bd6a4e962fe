//! Channels that a law needs and a trial does not have, all of them at once.

use std::fmt;

use sistership_model::coefficient::Axis;
use sistership_model::effect::{TIME_INPUT, input_channel};
use sistership_model::law::Law;
use sistership_model::manifest::VelocityFrame;
use sistership_model::trial::{Channel, Trial};

/// Channel that is missing.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MissingChannel {
    /// Name in manifests, or that of an input for which there is no channel.
    pub name: String,
    /// Reason why the law needs it.
    pub why: &'static str,
    /// Advice to the user.
    pub remedy: String,
}

impl fmt::Display for MissingChannel {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(out, "`{}` is missing: {}; {}", self.name, self.why, self.remedy)
    }
}

/// Returns every channel that the law needs and the trial does not have.
pub fn missing_channels(law: &Law, trial: &Trial) -> Vec<MissingChannel> {
    let state = "it is part of the initial state of a simulation";
    let mut needed: Vec<(Channel, &'static str)> =
        vec![(Channel::U, state), (Channel::V, state), (Channel::R, state)];
    if law.inputs.contains_key(Channel::Delta.name()) {
        needed.push((Channel::Delta, "it is the steering input"));
    }
    if law.axes.contains_key(&Axis::K) {
        let rolls = "the law has roll";
        needed.extend([(Channel::Phi, rolls), (Channel::P, rolls)]);
    }
    let mut lacks = Vec::new();
    for (name, input) in law.inputs.iter().filter(|(name, _)| name.as_str() != TIME_INPUT) {
        match input_channel(name) {
            Some(channel) => needed.extend(required_input(trial, channel, input.default)),
            None if input.default.is_none() => lacks.push(MissingChannel {
                name: name.clone(),
                why: "it is an input of the law",
                remedy: "trials have no channel for it; choose another law".into(),
            }),
            None => {}
        }
    }
    // A channel may be needed for several reasons; only the first is reported.
    for (at, &(channel, why)) in needed.iter().enumerate() {
        let named_before = needed[..at].iter().any(|&(before, _)| before == channel);
        if !named_before && trial.channel(channel).is_none() {
            lacks.push(MissingChannel {
                name: channel.name().into(),
                why,
                remedy: channel_remedy(trial, channel),
            });
        }
    }
    lacks
}

/// Returns an input that must be recorded: it has no default, and is no constant of the trial.
fn required_input(
    trial: &Trial,
    channel: Channel,
    default: Option<f64>,
) -> Option<(Channel, &'static str)> {
    let constant = channel == Channel::Depth && trial.depth_m.is_some();
    (default.is_none() && !constant).then_some((channel, "it is an input of the law"))
}

fn channel_remedy(trial: &Trial, channel: Channel) -> String {
    let has = |channels: &[Channel]| channels.iter().all(|&one| trial.channel(one).is_some());
    let derived = match channel {
        Channel::U | Channel::V => has(&[Channel::X, Channel::Y, Channel::Psi]),
        Channel::R => has(&[Channel::Psi]),
        _ => false,
    };
    let by_log = channel == Channel::V && trial.velocity == VelocityFrame::Water;
    match channel {
        Channel::V if by_log && derived => "declare `derive: [u, v]`: both follow from positions \
                                            and heading over the ground, in addition to the speed \
                                            through the water"
            .into(),
        _ if derived => format!("map its column, or declare `derive: [{channel}]`"),
        Channel::Depth => "map its column, or give `depth_m` of the trial".into(),
        Channel::N => {
            "map its column, or give `n_rps` of the trial where they were constant".into()
        }
        Channel::U | Channel::V => {
            format!("map its column, or position and heading and declare `derive: [{channel}]`")
        }
        _ => "map its column".into(),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use sistership_model::Zoo;

    use super::*;

    #[test]
    fn everything_that_is_missing_is_named_at_once() {
        let zoo = Zoo::load_embedded().unwrap();
        let law = zoo.law("abkowitz").unwrap();
        let mut trial = Trial { t_s: vec![0.0; 3], ..Trial::default() };
        for channel in [Channel::X, Channel::Y, Channel::Psi] {
            trial.channels.insert(channel, vec![0.0; 3]);
        }
        let names: Vec<String> =
            missing_channels(law, &trial).into_iter().map(|lack| lack.name).collect();
        assert_eq!(names[..4], ["u", "v", "r", "delta"]);
        let text = missing_channels(law, &trial)[2].to_string();
        assert!(text.contains("derive: [r]"), "{text}");
        for channel in Channel::all_channels() {
            trial.channels.insert(channel, vec![0.0; 3]);
        }
        assert_eq!(missing_channels(law, &trial), []);
    }
}
