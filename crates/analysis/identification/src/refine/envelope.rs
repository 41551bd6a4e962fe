//! Operating envelope of a model with the accelerations that its source predicts there: the states
//! of the trials, and those of the source's own standard manoeuvres.

use std::collections::BTreeMap;
use std::sync::Arc;

use sistership_model::Model;
use sistership_model::coefficient::Axis;
use sistership_model::law::Law;
use sistership_model::trial::{Channel, Trial};
use sistership_simulation::Ship;
use sistership_simulation::manoeuvre::{
    ManoeuvreSettings, STANDARD_MANOEUVRES, simulate_manoeuvre_batch,
};
use sistership_simulation::plant::{LawInputs, MAX_INPUTS, PlantWorkspace};
use sistership_simulation::state::{RECORDED_CHANNELS, StateVector, Trajectory, at};

use super::blocks::{RegressionBlock, RegressionBlocks};
use super::outcome::RefineError;
use super::rows::{RegressionTable, known_tables};
use super::thresholds::{SOURCE, SPEED_SCALES};
use sistership_numerics::{RegressionMoments, merge_trials};
use sistership_priors::transfer::prepare_ship;

/// Accelerations of a model at the states of an envelope: by group, those of each axis in the order
/// of [`Axis`].
pub(super) type EnvelopeRates = Vec<[Vec<f64>; 4]>;

/// Accelerations of a ship of a population at the states of an envelope.
#[derive(Debug)]
pub(super) struct MemberRates {
    /// Its model's name.
    pub name: String,
    /// Its accelerations.
    pub rates: EnvelopeRates,
}

/// States in which a model will be used, with the accelerations that a source predicts there.
#[derive(Debug, Clone)]
pub(super) struct OperatingEnvelope {
    /// Name of the source.
    pub source: String,
    /// Name of the source's law.
    pub law: String,
    /// True if the source has roll.
    pub roll: bool,
    /// Revolutions of the source at its approach, 1/s; 0 if it states none.
    pub n_rps: f64,
    /// True if its propeller turns at these revolutions because a trial records none.
    pub at_own_revolutions: bool,
    /// Description of the shift towards another model, for reports; none without one.
    pub mixed: Option<String>,
    /// Groups of samples: one for each trial and each manoeuvre.
    pub groups: Vec<SampleGroup>,
    /// Number of groups at the speed of the trials, which come first.
    pub at_speed: usize,
}

/// The samples of a trial or of a manoeuvre, with the source's accelerations at each.
#[derive(Debug, Clone)]
pub(super) struct SampleGroup {
    /// States and inputs; time is the sample's number.
    pub samples: Trial,
    /// Accelerations by axis, in the order of [`Axis`].
    rates: [Vec<f64>; 4],
    /// Weight of each sample.
    pub weight: f64,
}

impl SampleGroup {
    /// The source's acceleration of an axis at each sample.
    fn axis_rate(&self, axis: Axis) -> &[f64] {
        &self.rates[axis as usize]
    }

    /// Statistics of the accelerations of several models at these samples, one set for each
    /// regression.
    ///
    /// Targets are linear in accelerations. Their response to each axis' acceleration is the same
    /// for every model, so that it is evaluated once, with an acceleration of one.
    fn model_moments(
        &self,
        blocks: &RegressionBlocks,
        models: &[&[Vec<f64>; 4]],
    ) -> Result<Vec<RegressionMoments>, RefineError> {
        // Targets at zero acceleration, and at an acceleration of one in each axis: the difference
        // is the response to that axis.
        let (zero, one) = (vec![0.0; self.samples.len()], vec![1.0; self.samples.len()]);
        let mut at_rest = known_tables(blocks, &self.samples, &|_| &zero)?;
        let alone = |axis: Axis| {
            known_tables(blocks, &self.samples, &|of| if of == axis { &one } else { &zero })
        };
        // Only the axes that are regressed have an acceleration that matters.
        let axes: Vec<Axis> = blocks.blocks.iter().flat_map(|block| block.axes.clone()).collect();
        let alone: Vec<(Axis, Vec<RegressionTable>)> = axes
            .into_iter()
            .map(|axis| Ok((axis, alone(axis)?)))
            .collect::<Result<_, RefineError>>()?;
        let of_block =
            |(place, (block, table)): (usize, (&RegressionBlock, &mut RegressionTable))| {
                let rest = table.split_off(block.regressor_count());
                zero_rounding(table);
                for rates in models {
                    for (target, rest) in rest.iter().enumerate() {
                        let mut column = rest.clone();
                        for (axis, tables) in &alone {
                            let moved = &tables[place][block.regressor_count() + target];
                            let rates = &rates[*axis as usize];
                            column.iter_mut().enumerate().for_each(|(k, value)| {
                                *value += (moved[k] - rest[k]) * rates[k];
                            });
                        }
                        table.push(column);
                    }
                }
                RegressionMoments::about_zero(table, block.regressor_count(), self.weight)
            };
        Ok(blocks.blocks.iter().zip(&mut at_rest).enumerate().map(of_block).collect())
    }

    fn source_moments(
        &self,
        blocks: &RegressionBlocks,
    ) -> Result<Vec<RegressionMoments>, RefineError> {
        let mut tables = known_tables(blocks, &self.samples, &|axis| self.axis_rate(axis))?;
        let one = |(block, table): (&RegressionBlock, &mut RegressionTable)| {
            zero_rounding(&mut table[..block.regressor_count()]);
            RegressionMoments::about_zero(table, block.regressor_count(), self.weight)
        };
        Ok(blocks.blocks.iter().zip(&mut tables).map(one).collect())
    }
}

impl OperatingEnvelope {
    /// Creates the envelope of a source that is transferred to the ship, by the source's own law.
    /// The trials together have the same weight as the manoeuvres.
    ///
    /// # Errors
    /// Returns an error if the source cannot be simulated, or neither trials nor manoeuvres have a
    /// state that it covers.
    pub fn new(source: &Model, law: &Law, trials: &[&Trial]) -> Result<Self, RefineError> {
        let ship = prepare_ship(source, law, trials)?;
        let asked = SourceResponse::new(&ship, source, law);
        let recorded = trials
            .iter()
            .filter_map(|trial| asked.sample_group(trial.depth_m, asked.recorded_points(trial)));
        let sailed = simulate_manoeuvre_batch(
            &ship,
            &STANDARD_MANOEUVRES.map(|manoeuvre| (manoeuvre, &[][..])),
            &ManoeuvreSettings::default(),
        );
        let sailed: Vec<Trajectory> =
            sailed.into_iter().flatten().map(|sailed| sailed.track).collect();
        let at_scale = |scale: f64| {
            let group = |track: &Trajectory| {
                asked.sample_group(None, scaled_points(asked.track_points(track), scale))
            };
            sailed.iter().filter_map(group).collect::<Vec<SampleGroup>>()
        };
        let recorded: Vec<SampleGroup> = recorded.collect();
        let [sailed, slower] = match cover_slower(trials) {
            true => [at_scale(1.0), Vec::new()],
            false => SPEED_SCALES.map(at_scale),
        };
        if recorded.is_empty() && sailed.is_empty() {
            return Err(RefineError::Data(format!(
                "`{}` completes neither the standard manoeuvres nor the trials; choose another \
                 source",
                source.name
            )));
        }
        // Trials and manoeuvres at each speed are weighted separately: each counts as
        // `SOURCE.samples` samples.
        let mut groups: Vec<SampleGroup> =
            [recorded, sailed].into_iter().flat_map(with_equal_weight).collect();
        let at_speed = groups.len();
        groups.extend(with_equal_weight(slower));
        Ok(Self {
            source: source.name.clone(),
            law: law.name.clone(),
            roll: law.has_roll(),
            n_rps: source.revolutions_rps.unwrap_or(0.0),
            at_own_revolutions: asked.propeller
                && trials.iter().any(|trial| trial.channel(Channel::N).is_none()),
            mixed: None,
            groups,
            at_speed,
        })
    }

    /// Returns the states at which a law holds: one that is expanded about the approach speed holds
    /// only about it.
    pub fn for_law(self: Arc<Self>, law: &Law) -> Arc<Self> {
        if law.approach_speed_parameter().is_none() || self.at_speed == self.groups.len() {
            return self;
        }
        let mut own = Arc::unwrap_or_clone(self);
        own.groups.truncate(own.at_speed);
        Arc::new(own)
    }

    /// Returns the same states with the accelerations of each axis shifted by a share of the
    /// difference to another model, which runs at the same fraction of its own revolutions.
    ///
    /// # Errors
    /// Returns an error if the other model cannot be set up or does not cover a state.
    pub fn shifted_towards(
        &self,
        (model, law): (&Model, &Law),
        shares: &[f64; 4],
        trials: &[&Trial],
    ) -> Result<Self, RefineError> {
        let said = self.model_rates((model, law), trials)?;
        let mut moved = self.clone();
        for (group, rates) in moved.groups.iter_mut().zip(&said) {
            for ((own, other), share) in group.rates.iter_mut().zip(rates).zip(shares) {
                // `own + share (other - own)`: a share of 0 keeps the source, a share of 1 gives
                // the other model.
                own.iter_mut().zip(other).for_each(|(own, other)| *own += share * (other - *own));
            }
        }
        Ok(moved)
    }

    /// Returns the accelerations of another model at the same states, at the same fraction of its
    /// own revolutions.
    ///
    /// # Errors
    /// Returns an error if the other model cannot be set up or does not cover a state.
    pub fn model_rates(
        &self,
        (model, law): (&Model, &Law),
        trials: &[&Trial],
    ) -> Result<EnvelopeRates, RefineError> {
        let ship = prepare_ship(model, law, trials)?;
        let asked = SourceResponse::new(&ship, model, law);
        let of_group = |group: &SampleGroup| {
            let mut points = asked.recorded_points(&group.samples);
            // Both propellers then work at the same fraction of their own self-propulsion point.
            for (_, n_rps) in points.iter_mut().filter(|_| self.n_rps > 0.0) {
                *n_rps *= asked.n_rps / self.n_rps;
            }
            let message = || {
                format!("`{}` gives no finite accelerations in a state of the trials", model.name)
            };
            let rates = asked.point_rates(&points, group.samples.depth_m);
            rates.ok_or_else(|| RefineError::Data(message()))
        };
        self.groups.iter().map(of_group).collect()
    }

    /// Returns the statistics of the accelerations of several models at these states for the
    /// regressions of a law: each model's accelerations are targets of their own, one model after
    /// the other.
    ///
    /// # Errors
    /// Returns an error if the law has an input that the states do not have.
    pub fn model_moments(
        &self,
        blocks: &RegressionBlocks,
        models: &[&EnvelopeRates],
    ) -> Result<Vec<RegressionMoments>, RefineError> {
        let of_group = |(place, group): (usize, &SampleGroup)| {
            let said: Vec<&[Vec<f64>; 4]> = models.iter().map(|rates| &rates[place]).collect();
            group.model_moments(blocks, &said)
        };
        let groups: Vec<Vec<RegressionMoments>> =
            self.groups.iter().enumerate().map(of_group).collect::<Result<_, _>>()?;
        Ok(merge_trials(&groups, |_| true).unwrap_or_default())
    }

    /// Returns the statistics of the source's accelerations for the regressions of a law, by group
    /// and regression.
    ///
    /// # Errors
    /// Returns an error if the law has an input that the trials do not record.
    pub fn group_moments(
        &self,
        blocks: &RegressionBlocks,
    ) -> Result<Vec<Vec<RegressionMoments>>, RefineError> {
        self.groups.iter().map(|group| group.source_moments(blocks)).collect()
    }
}

#[cfg(test)]
impl OperatingEnvelope {
    /// Sum of the squared differences of the accelerations of an axis at the same states.
    pub fn distance(&self, other: &Self, axis: Axis) -> f64 {
        let pairs = self.groups.iter().zip(&other.groups);
        let values =
            pairs.flat_map(|(one, other)| one.axis_rate(axis).iter().zip(other.axis_rate(axis)));
        values.map(|(one, other)| (one - other).powi(2)).sum()
    }
}

/// Groups with the weights by which together they count as much as [`SOURCE`]'s samples.
fn with_equal_weight(mut groups: Vec<SampleGroup>) -> Vec<SampleGroup> {
    let all: usize = groups.iter().map(|group| group.samples.len()).sum();
    groups.iter_mut().for_each(|group| group.weight = SOURCE.samples as f64 / all as f64);
    groups
}

/// A state with its revolutions, 1/s.
type OperatingPoint = (StateVector, f64);

/// A source whose accelerations are evaluated.
struct SourceResponse<'a> {
    ship: &'a Ship,
    /// True if its law has a propeller; else it holds for the revolutions of the approach.
    propeller: bool,
    n_rps: f64,
    /// Lowest speed that it covers, m/s.
    least_m_s: f64,
}

impl<'a> SourceResponse<'a> {
    fn new(ship: &'a Ship, source: &Model, law: &Law) -> Self {
        // A law that is an expansion about the approach speed does not hold far below it.
        let expanded = law.approach_speed_parameter().is_some();
        let least_m_s = if expanded { SOURCE.least_speed * ship.approach_speed_m_s() } else { 0.0 };
        Self {
            ship,
            propeller: ship.has_propeller(),
            n_rps: source.revolutions_rps.unwrap_or(0.0),
            least_m_s,
        }
    }

    /// The states that a trial recorded; empty if it lacks a velocity or the rudder.
    fn recorded_points(&self, trial: &Trial) -> Vec<OperatingPoint> {
        let need = [Channel::U, Channel::V, Channel::R, Channel::Delta];
        if need.iter().any(|channel| trial.channel(*channel).is_none()) {
            return Vec::new();
        }
        // Channels that are not recorded stay zero.
        let columns: Vec<(usize, &[f64])> = RECORDED_CHANNELS
            .iter()
            .chain(&[(Channel::Delta, at::DELTA)])
            .filter_map(|&(channel, place)| Some((place, trial.channel(channel)?)))
            .collect();
        let one = |k: usize| {
            let mut state = StateVector::zeros();
            columns.iter().for_each(|(place, column)| state[*place] = column[k]);
            (state, trial.channel(Channel::N).map_or(self.n_rps, |n| n[k]))
        };
        sample_places(trial.len()).map(one).collect()
    }

    /// The states of a simulated track.
    fn track_points(&self, track: &Trajectory) -> Vec<OperatingPoint> {
        sample_places(track.t_s.len()).map(|k| (track.states[k], track.n_rps[k])).collect()
    }

    /// Returns true if the source covers a state: fast enough, and not with the propeller stopped
    /// or reversed.
    fn covers_point(&self, (state, n_rps): &OperatingPoint) -> bool {
        state[at::U] > self.least_m_s && (!self.propeller || *n_rps > 0.0)
    }

    /// The group of the points that the source covers, turned to heading north; `None` if there are
    /// none or an acceleration is not finite.
    fn sample_group(
        &self,
        depth_m: Option<f64>,
        mut points: Vec<OperatingPoint>,
    ) -> Option<SampleGroup> {
        points.retain(|point| self.covers_point(point));
        // The heading matters only relative to the wind, which `calm` gives for a heading of north.
        points.iter_mut().for_each(|(state, _)| state[at::PSI] = 0.0);
        let rates = self.point_rates(&points, depth_m).filter(|_| !points.is_empty())?;
        Some(SampleGroup { samples: self.sample_trial(&points, depth_m), rates, weight: 1.0 })
    }

    /// Its accelerations by axis; `None` if one is not finite.
    fn point_rates(
        &self,
        points: &[OperatingPoint],
        depth_m: Option<f64>,
    ) -> Option<[Vec<f64>; 4]> {
        let mut work = PlantWorkspace::default();
        let rate = |point: &OperatingPoint| {
            self.ship.rate_with(&point.0, &self.law_inputs(point, depth_m), &mut work)
        };
        // Rates of the state vector; the rates of the velocities are the accelerations.
        let rates: Vec<StateVector> = points.iter().map(rate).collect();
        let of = |place: usize| rates.iter().map(|rate| rate[place]).collect::<Vec<f64>>();
        let rates = [at::U, at::V, at::P, at::R].map(of);
        rates.iter().flatten().all(|rate| rate.is_finite()).then_some(rates)
    }

    /// The inputs of the source's law at a point.
    fn law_inputs(&self, (state, n_rps): &OperatingPoint, depth_m: Option<f64>) -> LawInputs {
        // The apparent wind is zero, so that the accelerations are those of the hull, rudder and
        // propeller alone.
        let (wind_m_s, wind_from) = calm_wind(state);
        let mut inputs = [0.0; MAX_INPUTS];
        for (value, (name, default)) in inputs.iter_mut().zip(self.ship.law_inputs()) {
            *value = match name {
                "delta" => state[at::DELTA],
                "n" => *n_rps,
                "wind_speed" => wind_m_s,
                "wind_from" => wind_from,
                "depth" => depth_m.or(default).unwrap_or(0.0),
                _ => default.unwrap_or(0.0),
            };
        }
        inputs
    }

    /// The points as a trial that a law's regressions can read.
    fn sample_trial(&self, points: &[OperatingPoint], depth_m: Option<f64>) -> Trial {
        let states = [
            (Channel::U, at::U),
            (Channel::V, at::V),
            (Channel::R, at::R),
            (Channel::P, at::P),
            (Channel::Phi, at::PHI),
        ];
        let column =
            |place: usize| points.iter().map(|(state, _)| state[place]).collect::<Vec<f64>>();
        let columns = states.into_iter().chain([(Channel::Delta, at::DELTA)]);
        let mut channels: BTreeMap<Channel, Vec<f64>> =
            columns.map(|(channel, place)| (channel, column(place))).collect();
        // Without a propeller the source holds for its approach revolutions, whatever was recorded.
        let n = points.iter().map(|(_, n_rps)| if self.propeller { *n_rps } else { self.n_rps });
        channels.insert(Channel::N, n.collect());
        let (wind_m_s, wind_from) = points.iter().map(|(state, _)| calm_wind(state)).unzip();
        channels.extend([(Channel::WindSpeed, wind_m_s), (Channel::WindFrom, wind_from)]);
        Trial {
            t_s: (0..points.len()).map(|k| k as f64).collect(),
            channels,
            depth_m,
            ..Trial::default()
        }
    }
}

/// True if the trials themselves reach the revolutions of the slowest of [`SPEED_SCALES`].
fn cover_slower(trials: &[&Trial]) -> bool {
    let recorded = trials.iter().filter_map(|trial| trial.channel(Channel::N)).flatten();
    let [least, most] = recorded.fold([f64::INFINITY, 0.0], |[least, most]: [f64; 2], n_rps| {
        [least.min(n_rps.abs()), most.max(n_rps.abs())]
    });
    SPEED_SCALES.iter().all(|scale| least <= scale * most)
}

/// The points at another speed of the ship and its propeller, with the same angles: the ratios of
/// drift, turning and advance, on which nondimensional forces depend, stay.
fn scaled_points(mut points: Vec<OperatingPoint>, scale: f64) -> Vec<OperatingPoint> {
    for (state, n_rps) in &mut points {
        [at::U, at::V, at::P, at::R].into_iter().for_each(|place| state[place] *= scale);
        *n_rps *= scale;
    }
    points
}

/// Speed and direction of the wind that makes the apparent wind zero. The source's aerodynamic
/// forces do not enter the prior. The heading is north.
fn calm_wind(state: &StateVector) -> (f64, f64) {
    let (u, v) = (state[at::U], state[at::V]);
    (u.hypot(v), (-v).atan2(-u))
}

/// Places of at most [`SOURCE`]`.samples` samples of a group, evenly spread.
fn sample_places(count: usize) -> impl Iterator<Item = usize> {
    (0..count).step_by(count.div_ceil(SOURCE.samples).max(1))
}

/// Sets regressors that are nothing but rounding error to zero: the source gives no information on
/// them.
fn zero_rounding(regressors: &mut [Vec<f64>]) {
    let size = |column: &Vec<f64>| column.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    let least = SOURCE.rounding * regressors.iter().map(size).fold(0.0, f64::max);
    regressors.iter_mut().filter(|column| size(column) < least).for_each(|column| column.fill(0.0));
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use sistership_model::Zoo;

    use super::*;

    #[test]
    fn slower_states_are_for_laws_that_hold_there() {
        let zoo = Zoo::load_embedded().unwrap();
        let model = zoo.find_model("kvlcc2").unwrap();
        let law = zoo.law(&model.law).unwrap();
        let envelope = Arc::new(OperatingEnvelope::new(&model, law, &[]).unwrap());
        let count = STANDARD_MANOEUVRES.len();
        assert_eq!((envelope.at_speed, envelope.groups.len()), (count, 2 * count));
        let fastest = |groups: &[SampleGroup]| {
            let speeds = groups.iter().flat_map(|group| &group.samples.channels[&Channel::U]);
            speeds.copied().fold(0.0, f64::max)
        };
        let [fast, slow] = [&envelope.groups[..count], &envelope.groups[count..]].map(fastest);
        assert!((slow / fast - 0.5).abs() < 1e-6, "{slow} {fast}");
        let groups = |name: &str| envelope.clone().for_law(zoo.law(name).unwrap()).groups.len();
        assert_eq!((groups("low-speed"), groups("abkowitz")), (2 * count, count));
    }
}
