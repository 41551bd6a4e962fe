//! Dependence of the unexplained remainder on recorded variables: a random forest is trained on the
//! remainder of an acceleration, and evaluated on parts of the trials that it has not seen.
//!
//! A term of the law that would explain the same is evaluated before, as the effect `missing-term`.

use sistership_learned::{LearnedDependence, TrainingSample, learn_dependence};
use sistership_model::Trial;
use sistership_model::branch::Learner;
use sistership_model::trial::Channel;

use super::outcome::{
    OriginKind, RemainderDependence, RemainderOrigin, ResidualSeries, UnexplainedSegment,
    VariableDependence,
};
use super::series::recorded_values;
use super::thresholds::THRESHOLDS;

/// Name of time among the variables; a beginning or an end depends on it.
const TIME_VARIABLE: &str = "t";

/// Dependence of the remainder of each acceleration that has an unexplained segment or is the
/// origin of one.
pub(super) fn remainder_dependence(
    trials: &[&Trial],
    residuals: &[ResidualSeries],
    (unexplained, origins): (&[UnexplainedSegment], &[RemainderOrigin]),
) -> Vec<RemainderDependence> {
    let is_origin = |channel: &str| {
        let first = origins.first().filter(|origin| origin.of == OriginKind::Acceleration);
        first.is_some_and(|origin| origin.channel == channel)
    };
    // A heading that is not followed belongs to the yaw acceleration.
    let is_of = |stretch: &UnexplainedSegment, channel: &str| {
        stretch.channel == channel || (stretch.channel == "psi" && channel == "r")
    };
    let is_left = |channel: &str| unexplained.iter().any(|stretch| is_of(stretch, channel));
    let mut channels: Vec<&str> = residuals.iter().map(|series| &*series.channel).collect();
    channels.sort_unstable();
    channels.dedup();
    // The origin is listed first.
    channels.sort_by_key(|channel| !is_origin(channel));
    channels
        .into_iter()
        .filter(|channel| is_left(channel) || is_origin(channel))
        .filter_map(|channel| {
            let of = |series: &&ResidualSeries| series.channel == channel;
            channel_dependence(trials, channel, &residuals.iter().filter(of).collect::<Vec<_>>())
        })
        .collect()
}

fn channel_dependence(
    trials: &[&Trial],
    channel: &str,
    series: &[&ResidualSeries],
) -> Option<RemainderDependence> {
    // Too few samples to train on half of them.
    let samples: usize = series.iter().map(|one| one.t_s.len()).sum();
    if samples < THRESHOLDS.dependence.samples {
        return None;
    }
    let variables = usable_variables(trials, series);
    let halves = [0, 1].map(|half| sample_half(&variables, series, half));
    let learner = forest_learner(variables.len());
    // Trained on each half and evaluated on the other one.
    let told: Vec<LearnedDependence> = [(0, 1), (1, 0)]
        .into_iter()
        .filter_map(|(seen, unseen)| {
            let points = THRESHOLDS.dependence.points;
            learn_dependence(&learner, &halves[seen], &halves[unseen], points, 1)
        })
        .collect();
    let first = told.first()?;
    let mean = |of: &dyn Fn(&LearnedDependence) -> f64| {
        told.iter().map(of).sum::<f64>() / told.len() as f64
    };
    let mut all: Vec<VariableDependence> = variables
        .iter()
        .enumerate()
        .map(|(place, (name, _))| VariableDependence {
            variable: (*name).to_owned(),
            share: mean(&|told| told.inputs[place].rise),
            at: first.inputs[place].at.clone(),
            remainder: first.inputs[place].answer.clone(),
        })
        .filter(|variable| variable.share > THRESHOLDS.dependence.share)
        .collect();
    all.sort_by(|a, b| b.share.total_cmp(&a.share));
    all.truncate(THRESHOLDS.dependence.shown);
    let explained = mean(&|told| told.explained).max(0.0);
    // A forest that explains hardly more than the mean has found no dependence.
    let variables = if explained > THRESHOLDS.dependence.share { all } else { Vec::new() };
    Some(RemainderDependence { channel: channel.to_owned(), explained, variables })
}

fn forest_learner(variables: usize) -> Learner {
    let threshold = &THRESHOLDS.dependence;
    Learner::RandomForest {
        trees: threshold.trees,
        tried: variables.div_ceil(3),
        leaf: threshold.leaf,
        depth: threshold.depth,
    }
}

/// A variable by name, with its values along each series.
type VariableSeries = (&'static str, Vec<Vec<f64>>);

/// Variables that every series has and that vary, and time.
fn usable_variables(trials: &[&Trial], series: &[&ResidualSeries]) -> Vec<VariableSeries> {
    let along = |channel: &Channel| -> Option<VariableSeries> {
        let values: Option<Vec<Vec<f64>>> =
            series.iter().map(|one| recorded_values(trials, one, *channel)).collect();
        Some((channel.name(), values?))
    };
    let varies = |(_, values): &VariableSeries| {
        let all = values.iter().flatten();
        let (low, high) = all
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(*x), high.max(*x)));
        high - low > 1e-9
    };
    let since = |one: &&ResidualSeries| one.t_s.iter().map(|t| t - one.t_s[0]).collect();
    let time = (TIME_VARIABLE, series.iter().map(since).collect());
    let channels = THRESHOLDS.series.variables.iter().filter_map(along);
    channels.filter(varies).chain([time]).collect()
}

/// Samples of every second block of each series, or all of every second series where they are
/// short: neighbours in time are alike, so that single samples would not be independent.
fn sample_half(
    variables: &[VariableSeries],
    series: &[&ResidualSeries],
    half: usize,
) -> TrainingSample {
    let taken = |(place, values): (usize, &Vec<f64>)| -> Vec<f64> {
        let blocks = THRESHOLDS.dependence.blocks;
        // Short series are not divided: each belongs to one half.
        let is_short = values.len() < THRESHOLDS.dependence.block * blocks;
        let block = |k: usize| if is_short { place } else { k * blocks / values.len() };
        let kept = values.iter().enumerate().filter(|(k, _)| block(*k) % 2 == half);
        kept.map(|(_, value)| *value).collect()
    };
    let column = |(_, values): &VariableSeries| values.iter().enumerate().flat_map(taken).collect();
    TrainingSample {
        columns: variables.iter().map(column).collect(),
        targets: series.iter().map(|one| &one.after).enumerate().flat_map(taken).collect(),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use std::collections::BTreeMap;

    /// A trial in which the rudder and the heading swing at their own pace, and what is left of its
    /// yaw acceleration by a formula of both.
    fn case(left: fn(f64, f64, f64) -> f64) -> (Trial, ResidualSeries) {
        let t_s: Vec<f64> = (0..240).map(|k| 2.0 * f64::from(k)).collect();
        let of = |period: f64| t_s.iter().map(|t| (t / period).sin() * 0.3).collect::<Vec<f64>>();
        let channels: BTreeMap<Channel, Vec<f64>> =
            [(Channel::Delta, of(11.0)), (Channel::V, of(7.0)), (Channel::Psi, of(23.0))]
                .into_iter()
                .collect();
        let after =
            (0..240).map(|k| left(channels[&Channel::Delta][k], channels[&Channel::V][k], t_s[k]));
        let series = ResidualSeries {
            trial: "a".into(),
            channel: "r".into(),
            after: after.collect(),
            before: vec![0.0; 240],
            band: vec![0.0; 240],
            against: String::new(),
            variable: Vec::new(),
            t_s: t_s.clone(),
        };
        (Trial { name: "a".into(), t_s, channels, ..Trial::default() }, series)
    }

    fn stretch() -> UnexplainedSegment {
        UnexplainedSegment {
            channel: "r".into(),
            rms_over_noise: 5.0,
            trial: "a".into(),
            from_s: 0.0,
            to_s: 480.0,
        }
    }

    fn told(left: fn(f64, f64, f64) -> f64) -> RemainderDependence {
        let (trial, series) = case(left);
        remainder_dependence(&[&trial], &[series], (&[stretch()], &[])).remove(0)
    }

    #[test]
    fn a_force_of_the_rudder_is_told_with_its_shape() {
        let told = told(|delta, _, _| 1e-3 * delta * delta.abs());
        assert!(told.explained > 0.8, "{told:?}");
        let first = &told.variables[0];
        assert_eq!(first.variable, "delta");
        assert!(first.remainder.first() < first.remainder.last(), "{first:?}");
    }

    #[test]
    fn what_begins_is_told_by_time() {
        let told = told(|_, _, t| if t > 240.0 { 1e-3 } else { 0.0 });
        assert_eq!(told.variables[0].variable, "t");
    }

    #[test]
    fn time_is_that_of_the_trial() {
        let (first, one) = case(|_, _, t| if t > 240.0 { 1e-3 } else { 0.0 });
        let late = |t: &mut f64| *t += 9e4;
        let mut second = Trial { name: "b".into(), ..first.clone() };
        let mut other = ResidualSeries { trial: "b".into(), ..one.clone() };
        second.t_s.iter_mut().for_each(late);
        other.t_s.iter_mut().for_each(late);
        let psi = UnexplainedSegment { channel: "psi".into(), ..stretch() };
        let told = remainder_dependence(&[&first, &second], &[one, other], (&[psi], &[])).remove(0);
        let time = &told.variables[0];
        assert!(time.variable == "t" && time.at.iter().all(|t| *t < 480.0), "{time:?}");
    }

    #[test]
    fn the_origin_is_asked_first() {
        let (trial, yaw) = case(|delta, _, _| delta);
        let sway = ResidualSeries { channel: "v".into(), ..yaw.clone() };
        let origin = RemainderOrigin {
            of: OriginKind::Acceleration,
            channel: "v".into(),
            evidence: 9.0,
            first_in: 1,
            trials: 1,
        };
        let told = remainder_dependence(&[&trial], &[yaw, sway], (&[stretch()], &[origin]));
        let channels: Vec<&str> = told.iter().map(|one| &*one.channel).collect();
        assert_eq!(channels, ["v", "r"]);
    }

    #[test]
    fn too_few_samples_are_not_asked() {
        let (trial, mut series) = case(|delta, _, _| delta);
        series.t_s.truncate(20);
        series.after.truncate(20);
        assert!(remainder_dependence(&[&trial], &[series], (&[stretch()], &[])).is_empty());
    }

    #[test]
    fn nothing_is_asked_where_nothing_is_left() {
        let (trial, series) = case(|delta, _, _| delta);
        assert!(remainder_dependence(&[&trial], &[series], (&[], &[])).is_empty());
    }
}
