//! Log odds of an assignment by relations between columns.

use std::cell::RefCell;
use std::collections::HashMap;
use std::rc::Rc;

use crate::hypothesis::Assignment;
use crate::relation::{Fit, LEAST, Observed, Relation};
use crate::role::Role;
use crate::rudder;
use crate::signals::Signals;
use crate::track::Track;

/// Relations between the columns of a recording, with results cached by assignment.
pub(crate) struct Physics<'a> {
    pub observed: Observed<'a>,
    tracks: RefCell<HashMap<[i64; 9], Option<Rc<Track>>>>,
    rudders: RefCell<HashMap<(usize, usize, bool), rudder::Steering>>,
}

impl<'a> Physics<'a> {
    pub(crate) fn new(signals: &'a Signals) -> Self {
        Self::read(Observed { signals, is_told: false })
    }

    /// Returns the relations with the figures that are shown to the user.
    pub(crate) fn with_figures(signals: &'a Signals) -> Self {
        Self::read(Observed { signals, is_told: true })
    }

    fn read(observed: Observed<'a>) -> Self {
        Self { observed, tracks: RefCell::default(), rudders: RefCell::default() }
    }

    /// Returns every relation between the columns of an assignment.
    pub(crate) fn relations(&self, of: &Assignment) -> Vec<Relation> {
        let mut all = Vec::new();
        if self.observed.signals.scales.is_empty() {
            return all;
        }
        // Without blocks of a time column no relation can be computed.
        let rates = [
            (Role::Psi, Role::R, "turns as fast as the yaw rate says"),
            (Role::Phi, Role::P, "rolls as fast as the roll rate says"),
            (Role::X, Role::VNorth, "moves as fast as the velocity north says"),
            (Role::Y, Role::VEast, "moves as fast as the velocity east says"),
        ];
        for (whole, rate, text) in rates {
            all.extend(self.rate(of, whole, rate, text));
        }
        all.extend(self.track(of).iter().flat_map(|track| track.relations(self.observed, of)));
        all.extend(self.steering(of));
        all.extend(self.propulsion(of));
        all.extend(self.heel(of));
        all.extend(self.alike(of));
        all
    }

    /// Returns the sum of the log odds of all relations.
    pub(crate) fn odds(&self, of: &Assignment) -> f64 {
        self.relations(of).iter().map(|relation| relation.odds).sum()
    }

    /// Relation of a quantity with its rate: the change over blocks against the integral of the
    /// rate.
    pub(crate) fn rate(
        &self,
        of: &Assignment,
        whole: Role,
        rate: Role,
        text: &str,
    ) -> Option<Relation> {
        let ((i, fi), (j, fj)) = (of.find(whole)?, of.find(rate)?);
        let fj = fj * of.time_factor;
        let each = self.observed.signals.scales.iter().filter_map(|scale| {
            Fit::new(&scale.columns[i].change, fi, &scale.columns[j].integral, fj)
        });
        // The scale on which the two agree best: coarse blocks for slow motions, fine ones for fast
        // turns.
        let best = each.min_by(|a, b| a.left.total_cmp(&b.left))?;
        let figure = self.observed.figure(|| format!("{text} ({:.2} times)", best.slope));
        let roles = [whole, rate, Role::Other];
        Some(Relation { roles, odds: best.odds(1e-5), figure })
    }

    /// Returns the track of positions and heading of an assignment, from the cache where it is
    /// known.
    pub(crate) fn track(&self, of: &Assignment) -> Option<Rc<Track>> {
        let pairs = [(Role::X, Role::Y), (Role::Latitude, Role::Longitude)];
        let (x, y) = pairs.into_iter().find(|(x, y)| of.has(*x) && of.has(*y))?;
        // The key holds every column and factor on which the track depends; factors as integers of
        // 1e-9, since floating-point numbers are no keys.
        let place = |role: Role| match of.find(role) {
            Some((at, factor)) => [at as i64, (factor * 1e9) as i64],
            None => [-1, 0],
        };
        let ([a, b], [c, d]) = (place(x), place(y));
        let ([e, f], [g, h]) = (place(Role::Psi), place(Role::Course));
        let key = [a, b, c, d, e, f, g, h, (of.time_factor * 1e9) as i64];
        let made = || Track::new(self.observed.signals, of, (x, y)).map(Rc::new);
        self.tracks.borrow_mut().entry(key).or_insert_with(made).clone()
    }

    fn steering(&self, of: &Assignment) -> Option<Relation> {
        let (r, fr) = of.find(Role::R)?;
        let rudder =
            [Role::Delta, Role::DeltaS, Role::DeltaP].into_iter().find(|role| of.has(*role))?;
        let (delta, fd) = of.find(rudder)?;
        let reversed = (fr < 0.0) != (fd < 0.0);
        let made = || rudder::Steering::new(self.observed.signals, r, delta, reversed);
        let steering = *self.rudders.borrow_mut().entry((r, delta, reversed)).or_insert_with(made);
        Some(steering.relation(rudder, self.observed))
    }

    /// Relation of revolutions with speed and turning by their sizes.
    fn propulsion(&self, of: &Assignment) -> Option<Relation> {
        let n = [Role::N, Role::NS, Role::NP].into_iter().find(|role| of.has(*role))?;
        let speed = [Role::U, Role::Speed, Role::UWater, Role::VNorth];
        let speed = speed.into_iter().find(|role| of.has(*role))?;
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
        let odds = (2.0 - 0.5 * off * off).clamp(LEAST, 2.0);
        let ahead = speed_m_s / revolutions.max(1e-9);
        let figure = self.observed.figure(|| format!("{ahead:.2} m ahead a turn"));
        Some(Relation { roles: [n, Role::Other, Role::Other], odds, figure })
    }

    /// Relation of roll angle and yaw rate: a turning ship heels, to one side or the other.
    fn heel(&self, of: &Assignment) -> Option<Relation> {
        let ((i, _), (j, _)) = (of.find(Role::Phi)?, of.find(Role::R)?);
        let correlation = self.correlation(i, j).abs();
        let odds = 4.0 * (correlation - 0.3).max(0.0);
        let figure =
            self.observed.figure(|| format!("heels with the yaw rate by {correlation:.2}"));
        Some(Relation { roles: [Role::Phi, Role::R, Role::Other], odds, figure })
    }

    /// Returns the correlation of the means over coarse blocks.
    fn correlation(&self, i: usize, j: usize) -> f64 {
        let means =
            |at: usize| self.observed.signals.scales.first().map(|scale| &scale.columns[at].mean);
        means(i).zip(means(j)).map_or(0.0, |(a, b)| rudder::correlation(a, b))
    }

    /// Relations between two instruments of one quantity.
    fn alike(&self, of: &Assignment) -> Vec<Relation> {
        let pairs = [
            (Role::U, Role::UWater, 0.01),
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
                let fit = Fit::new(a, fi, b, fj)?;
                let (odds, share) = (fit.odds(floor), 100.0 * fit.left.sqrt());
                let told = || format!("shows what its twin does, within {share:.0} %");
                let figure = self.observed.figure(told);
                Some(Relation { roles: [one, other, Role::Other], odds, figure })
            })
            .collect()
    }
}
