//! Log odds of an assignment by relations between columns.

use std::cell::RefCell;
use std::collections::HashMap;
use std::rc::Rc;

use crate::hypothesis::Assignment;
use crate::relation::{ColumnRelation, MIN_ODDS, RelationInput, SeriesFit};
use crate::role::Role;
use crate::rudder;
use crate::signals::{BlockScale, RecordingSignals};
use crate::track::GroundTrack;

/// Part of the largest revolutions within which they are constant.
const STEADY: f64 = 0.03;
/// Usual part of the sway in the surge of a recording of manoeuvres, and the standard deviation of
/// its natural logarithm.
const DRIFT: f64 = 0.15;
const DRIFT_SCATTER: f64 = 0.9;

/// Relations between the columns of a recording, with results cached by assignment.
pub(crate) struct PhysicalEvidence<'a> {
    pub observed: RelationInput<'a>,
    tracks: RefCell<HashMap<[i64; 9], Option<Rc<GroundTrack>>>>,
    rudders: RefCell<HashMap<(usize, usize, bool), rudder::SteeringEvidence>>,
}

impl<'a> PhysicalEvidence<'a> {
    pub(crate) fn new(signals: &'a RecordingSignals) -> Self {
        Self::from_input(RelationInput { signals, is_told: false })
    }

    /// Returns the relations with the figures that are shown to the user.
    pub(crate) fn with_figures(signals: &'a RecordingSignals) -> Self {
        Self::from_input(RelationInput { signals, is_told: true })
    }

    fn from_input(observed: RelationInput<'a>) -> Self {
        Self { observed, tracks: RefCell::default(), rudders: RefCell::default() }
    }

    /// Returns every relation between the columns of an assignment.
    pub(crate) fn find_relations(&self, of: &Assignment) -> Vec<ColumnRelation> {
        let mut all = Vec::new();
        if self.observed.signals.scales.is_empty() {
            return all;
        }
        // Without blocks of a time column no relation can be computed.
        let rates = [
            (Role::Psi, Role::R, "its rate agrees with the yaw rate"),
            (Role::Phi, Role::P, "its rate agrees with the roll rate"),
            (Role::X, Role::VNorth, "its rate agrees with the velocity north"),
            (Role::Y, Role::VEast, "its rate agrees with the velocity east"),
        ];
        for (whole, rate, text) in rates {
            all.extend(self.rate_relation(of, whole, rate, text));
        }
        all.extend(
            self.find_track(of).iter().flat_map(|track| track.track_relations(self.observed, of)),
        );
        all.extend(self.steering_relation(of));
        all.extend(self.propulsion_relation(of));
        all.extend(self.heel_relation(of));
        all.extend(self.drift_relation(of));
        all.extend(self.speed_order(of));
        all.extend(self.turning_loss(of));
        all.extend(self.twin_relations(of));
        all
    }

    /// Returns the sum of the log odds of all relations.
    pub(crate) fn total_odds(&self, of: &Assignment) -> f64 {
        self.find_relations(of).iter().map(|relation| relation.odds).sum()
    }

    /// Relation of a quantity with its rate: the change over blocks against the integral of the
    /// rate.
    pub(crate) fn rate_relation(
        &self,
        of: &Assignment,
        whole: Role,
        rate: Role,
        text: &str,
    ) -> Option<ColumnRelation> {
        let ((i, fi), (j, fj)) = (of.find(whole)?, of.find(rate)?);
        let fj = fj * of.time_factor;
        let each = self.observed.signals.scales.iter().filter_map(|scale| {
            SeriesFit::new(&scale.columns[i].change, fi, &scale.columns[j].integral, fj)
        });
        // The scale on which the two agree best: coarse blocks for slow motions, fine ones for fast
        // turns.
        let best = each.min_by(|a, b| a.left.total_cmp(&b.left))?;
        let figure = self.observed.format_figure(|| format!("{text} (ratio {:.2})", best.slope));
        let roles = [whole, rate, Role::Other];
        Some(ColumnRelation { roles, odds: best.capped_odds(1e-5), figure })
    }

    /// Returns the track of positions and heading of an assignment, from the cache where it is
    /// known.
    pub(crate) fn find_track(&self, of: &Assignment) -> Option<Rc<GroundTrack>> {
        let pairs = [(Role::X, Role::Y), (Role::Latitude, Role::Longitude)];
        let (x, y) = pairs.into_iter().find(|(x, y)| of.has_role(*x) && of.has_role(*y))?;
        // The key holds every column and factor on which the track depends; factors as integers of
        // 1e-9, since floating-point numbers are no keys.
        let place = |role: Role| match of.find(role) {
            Some((at, factor)) => [at as i64, (factor * 1e9) as i64],
            None => [-1, 0],
        };
        let ([a, b], [c, d]) = (place(x), place(y));
        let ([e, f], [g, h]) = (place(Role::Psi), place(Role::Course));
        let key = [a, b, c, d, e, f, g, h, (of.time_factor * 1e9) as i64];
        let made = || GroundTrack::new(self.observed.signals, of, (x, y)).map(Rc::new);
        self.tracks.borrow_mut().entry(key).or_insert_with(made).clone()
    }

    fn steering_relation(&self, of: &Assignment) -> Option<ColumnRelation> {
        let (r, fr) = of.find(Role::R)?;
        let rudder = [Role::Delta, Role::DeltaS, Role::DeltaP]
            .into_iter()
            .find(|role| of.has_role(*role))?;
        let (delta, fd) = of.find(rudder)?;
        let reversed = (fr < 0.0) != (fd < 0.0);
        let made = || rudder::SteeringEvidence::new(self.observed.signals, r, delta, reversed);
        let steering = *self.rudders.borrow_mut().entry((r, delta, reversed)).or_insert_with(made);
        Some(steering.to_relation(rudder, self.observed))
    }

    /// Relation of revolutions with speed and turning by their sizes.
    fn propulsion_relation(&self, of: &Assignment) -> Option<ColumnRelation> {
        let n = [Role::N, Role::NS, Role::NP].into_iter().find(|role| of.has_role(*role))?;
        let speed = [Role::U, Role::Speed, Role::UWater, Role::VNorth];
        let speed = speed.into_iter().find(|role| of.has_role(*role))?;
        let ((i, fi), (j, fj)) = (of.find(n)?, of.find(speed)?);
        let revolutions = self.observed.signals.summaries[i].largest * fi;
        let speed_m_s = self.observed.signals.summaries[j].largest * fj.abs();
        let turning =
            of.find(Role::R).map(|(k, fk)| self.observed.signals.summaries[k].largest * fk.abs());
        // A tight turn has a diameter of about 2.5 ship lengths, hence r L / u = 0.8; with the
        // speed lost in the turn, 0.4 of the largest speed. A propeller advances by about 2 % of
        // the length per revolution.
        let length = 0.4 * speed_m_s / turning.filter(|r| *r > 1e-4)?;
        let advance = speed_m_s / revolutions.max(1e-9) / length.clamp(0.5, 300.0);
        let off = (advance.max(1e-12) / 0.02).ln();
        let sized = (2.0 - 0.5 * off * off).clamp(MIN_ODDS, 2.0);
        let summary = &self.observed.signals.summaries[i];
        // Revolutions that change take the speed with them; a temperature does not.
        let driven = match summary.spread > STEADY * summary.largest {
            true => {
                let together = (3.0 * self.block_correlation(i, j) - 1.0).clamp(-1.5, 1.5);
                together + self.drive_odds(j, i)
            }
            false => 0.0,
        };
        let odds = sized + driven;
        let ahead = speed_m_s / revolutions.max(1e-9);
        let figure = self.observed.format_figure(|| format!("{ahead:.2} m ahead per revolution"));
        Some(ColumnRelation { roles: [n, Role::Other, Role::Other], odds, figure })
    }

    /// Returns the log odds of revolutions that drive a speed, which follows them with a lag: the
    /// partial correlation with the acceleration in `du/dt = a u + b n + c` is above zero, and below
    /// zero with the roles exchanged.
    fn drive_odds(&self, speed: usize, revolutions: usize) -> f64 {
        let partial = |scale: &BlockScale| {
            let (u, n) = (&scale.columns[speed], &scale.columns[revolutions]);
            rudder::partial_correlation(&u.change, [&u.integral, &n.integral, &scale.duration])
        };
        let partials = self.observed.signals.scales.iter().map(partial);
        let partial = partials.max_by(|a, b| a.abs().total_cmp(&b.abs())).unwrap_or(0.0);
        (6.0 * (partial - 0.15)).clamp(-3.0, 2.5)
    }

    /// Relation of roll angle and yaw rate: a turning ship heels, to one side or the other.
    fn heel_relation(&self, of: &Assignment) -> Option<ColumnRelation> {
        let ((i, _), (j, _)) = (of.find(Role::Phi)?, of.find(Role::R)?);
        let correlation = self.block_correlation(i, j).abs();
        let odds = 4.0 * (correlation - 0.3).max(0.0);
        let figure = self
            .observed
            .format_figure(|| format!("heel correlates with the yaw rate ({correlation:.2})"));
        Some(ColumnRelation { roles: [Role::Phi, Role::R, Role::Other], odds, figure })
    }

    /// Relation of sway with yaw rate and surge: the stern of a turning ship is carried outwards, to
    /// port in a turn to starboard, by some tenths of the speed ahead.
    fn drift_relation(&self, of: &Assignment) -> Option<ColumnRelation> {
        let ((i, fi), (j, fj)) = (of.find(Role::V)?, of.find(Role::R)?);
        let correlation = -self.block_correlation(i, j) * fi.signum() * fj.signum();
        // Bounded so that it does not outweigh the usual sign.
        let turned = (4.0 * (correlation - 0.25)).clamp(-0.8, 2.5);
        let largest = |at: usize| self.observed.signals.summaries[at].largest;
        let sized = of.find(Role::U).map_or(0.0, |(k, fk)| {
            let part = (largest(i) * fi.abs() / (largest(k) * fk.abs()).max(1e-9)).max(1e-9);
            -(0.5 * ((part / DRIFT).ln() / DRIFT_SCATTER).powi(2)).min(4.0)
        });
        let told = || format!("drifts against the yaw rate by {correlation:.2}");
        let figure = self.observed.format_figure(told);
        let roles = [Role::V, Role::R, Role::Other];
        Some(ColumnRelation { roles, odds: turned + sized, figure })
    }

    /// Relation of surge, or of the speed over ground where there is none, with yaw rate: a turning
    /// ship loses speed.
    fn turning_loss(&self, of: &Assignment) -> Option<ColumnRelation> {
        let ahead = [Role::U, Role::Speed].into_iter().find(|&role| of.find(role).is_some())?;
        let ((i, fi), (j, _)) = (of.find(ahead)?, of.find(Role::R)?);
        let scale = self.observed.signals.scales.first()?;
        let turning: Vec<f64> = scale.columns[j].mean.iter().map(|rate| rate.abs()).collect();
        let speeds = &scale.columns[i].mean;
        let correlation = -rudder::pearson_correlation(speeds, &turning) * fi.signum();
        let odds = (4.0 * (correlation - 0.25)).clamp(-1.5, 2.5);
        let figure =
            self.observed.format_figure(|| format!("falls as the ship turns, by {correlation:.2}"));
        Some(ColumnRelation { roles: [ahead, Role::R, Role::Other], odds, figure })
    }

    /// Relation of the speed over ground with the speed ahead, which is a part of it.
    fn speed_order(&self, of: &Assignment) -> Option<ColumnRelation> {
        let ((i, fi), (j, fj)) = (of.find(Role::Speed)?, of.find(Role::U)?);
        let scale = self.observed.signals.scales.first()?;
        let mean = |at: usize, factor: f64| -> f64 {
            scale.columns[at].mean.iter().map(|value| (value * factor).abs()).sum()
        };
        let (speed, ahead) = (mean(i, fi), mean(j, fj));
        let odds = if ahead > speed { -3.0 } else { 0.0 };
        let figure = self.observed.format_figure(|| format!("{:.3} of it is ahead", ahead / speed));
        Some(ColumnRelation { roles: [Role::Speed, Role::U, Role::Other], odds, figure })
    }

    /// Returns the correlation of the means over coarse blocks.
    fn block_correlation(&self, i: usize, j: usize) -> f64 {
        let means =
            |at: usize| self.observed.signals.scales.first().map(|scale| &scale.columns[at].mean);
        means(i).zip(means(j)).map_or(0.0, |(a, b)| rudder::pearson_correlation(a, b))
    }

    /// Relations between two instruments of one quantity.
    fn twin_relations(&self, of: &Assignment) -> Vec<ColumnRelation> {
        let pairs = [
            (Role::U, Role::UWater, 0.01),
            (Role::Speed, Role::UWater, 0.01),
            (Role::V, Role::VWater, 0.05),
            (Role::Speed, Role::U, 0.01),
            (Role::DeltaS, Role::DeltaP, 0.02),
            (Role::NS, Role::NP, 0.02),
        ];
        pairs
            .into_iter()
            .filter_map(|(one, other, floor)| {
                let ((i, fi), (j, fj)) = (of.find(one)?, of.find(other)?);
                let scale = self.observed.signals.scales.first()?;
                let (a, b) = (&scale.columns[i].mean, &scale.columns[j].mean);
                let fit = SeriesFit::new(a, fi, b, fj)?;
                let odds = match other {
                    // A current may part them.
                    Role::UWater if one == Role::Speed => fit.instrument_odds(floor).max(0.0),
                    Role::UWater | Role::VWater => fit.instrument_odds(floor),
                    _ => fit.capped_odds(floor),
                };
                let share = 100.0 * fit.left.sqrt();
                let told =
                    || format!("agrees with the column of the other side within {share:.0} %");
                let figure = self.observed.format_figure(told);
                Some(ColumnRelation { roles: [one, other, Role::Other], odds, figure })
            })
            .collect()
    }
}
