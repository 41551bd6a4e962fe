//! Relations of positions and heading with velocities: north axis, units, signs, ground or water.

use crate::hypothesis::Assignment;
use crate::relation::{ColumnRelation, PER_FOLD, RelationInput, SeriesFit, residual_odds};
use crate::role::Role;
use crate::signals::RecordingSignals;

/// Mean radius of the earth, m.
const EARTH: f64 = 6.371e6;
/// Fraction of the squares that positions leave unexplained at best: antenna and log are at
/// different places of the ship.
const FLOOR: f64 = 2e-3;
/// Largest log odds of a direction that a straight line would explain as well.
const STRAIGHT: f64 = 4.0;
/// Range of the mean speed of a track, m/s, the standard deviation, in natural logarithms, outside
/// it, and the largest loss of log odds.
const SLOWEST: f64 = 0.15;
const FASTEST: f64 = 25.0;
const FADE: f64 = 0.45;
const MAX_LOSS: f64 = 14.0;
/// Largest log odds of a course along which the track lies no better than along the heading.
const ALONG: f64 = 2.0;
/// Largest speed of a current as a fraction of the ship's speed.
const CURRENT: f64 = 0.4;

/// Steps of a track over the blocks of the finer scale, in earth-fixed and ship-fixed axes.
#[derive(Debug, Clone)]
pub(crate) struct GroundTrack {
    roles: (Role, Role),
    /// Displacements north and east, m.
    north: Vec<f64>,
    east: Vec<f64>,
    /// Displacements along the heading and to starboard, m, where there is a heading.
    ship: Option<(Vec<f64>, Vec<f64>)>,
    psi: Vec<f64>,
    /// Length of each step, m.
    length: Vec<f64>,
}

impl GroundTrack {
    /// Computes the steps of the positions of an assignment; returns `None` if they do not move.
    pub(crate) fn new(
        signals: &RecordingSignals,
        of: &Assignment,
        roles: (Role, Role),
    ) -> Option<Self> {
        let scale = signals.scales.last()?;
        let ((i, fi), (j, fj)) = (of.find(roles.0)?, of.find(roles.1)?);
        // Local plane: metres per radian of latitude, and of longitude at the median latitude.
        let metres = match roles.0 {
            Role::Latitude => (EARTH, EARTH * (signals.summaries[i].median * fi).cos()),
            _ => (1.0, 1.0),
        };
        let scaled = |at: usize, factor: f64| -> Vec<f64> {
            scale.columns[at].change.iter().map(|change| change * factor).collect()
        };
        let (north, east) = (scaled(i, fi * metres.0), scaled(j, fj * metres.1));
        let moved: f64 = north.iter().chain(&east).map(|step| step * step).sum();
        let psi: Vec<f64> = match of.find(Role::Psi) {
            Some((k, fk)) => scale.columns[k].mean.iter().map(|psi| psi * fk).collect(),
            None => Vec::new(),
        };
        let ship = (!psi.is_empty()).then(|| {
            let each = north.iter().zip(&east).zip(&psi);
            each.map(|((n, e), psi)| (n * psi.cos() + e * psi.sin(), e * psi.cos() - n * psi.sin()))
                .unzip()
        });
        let length = north.iter().zip(&east).map(|(n, e)| n.hypot(*e)).collect();
        (moved > 0.0).then_some(Self { roles, north, east, ship, psi, length })
    }

    /// Returns the relations with heading, course and velocities.
    pub(crate) fn track_relations(
        &self,
        observed: RelationInput<'_>,
        of: &Assignment,
    ) -> Vec<ColumnRelation> {
        let mut all: Vec<ColumnRelation> = self.heading_relation(observed).into_iter().collect();
        if let Some((along, across)) = &self.ship {
            let body = [(Role::U, along, "along"), (Role::V, across, "across")];
            all.extend(body.iter().filter_map(|&(role, steps, text)| {
                self.velocity_relation(observed, of, role, steps, text)
            }));
            all.extend(self.water_relation(observed, of, along));
        }
        all.extend(self.velocity_relation(observed, of, Role::Speed, &self.length, "over ground"));
        // Metres north and east have a relation with their rates of their own.
        if self.roles.0 == Role::Latitude {
            all.extend(self.velocity_relation(observed, of, Role::VNorth, &self.north, "north"));
            all.extend(self.velocity_relation(observed, of, Role::VEast, &self.east, "east"));
        }
        all.extend(self.pace_relation(observed, of));
        all.extend(self.course_relation(observed, of));
        all
    }

    /// Returns the sum of the log odds of the relations of the track.
    pub(crate) fn track_odds(&self, observed: RelationInput<'_>, of: &Assignment) -> f64 {
        self.track_relations(observed, of).iter().map(|relation| relation.odds).sum()
    }

    /// Relation of the track with the heading: a ship moves mainly along its heading.
    fn heading_relation(&self, observed: RelationInput<'_>) -> Option<ColumnRelation> {
        let (along, across) = self.ship.as_ref()?;
        let (ahead, aside): (f64, f64) = (sum_of_squares(along), sum_of_squares(across));
        let part = aside / (ahead + aside);
        let astern: f64 = along.iter().filter(|step| **step < 0.0).map(|step| step * step).sum();
        // A track that goes mostly astern counts against the heading.
        let backwards = if astern > 0.5 * ahead { 6.0 } else { 0.0 };
        // With random directions half of the squares would lie across the heading.
        let line = self.off_line();
        let odds = (-PER_FOLD * (2.0 * part).max(1e-3).ln())
            .min(STRAIGHT - PER_FOLD * (part.max(1e-4) / line.max(1e-4)).ln())
            .clamp(-12.0, 14.0)
            - backwards;
        let told =
            || format!("{:.1} % of the squared velocity is across the heading", 100.0 * part);
        let figure = observed.format_figure(told);
        Some(ColumnRelation { roles: [self.roles.0, self.roles.1, Role::Psi], odds, figure })
    }

    /// Relation of the track with the speeds of ships, which only counts against it: any two columns
    /// make a track of some speed.
    fn pace_relation(
        &self,
        observed: RelationInput<'_>,
        of: &Assignment,
    ) -> Option<ColumnRelation> {
        let seconds: f64 = observed.signals.scales.last()?.duration.iter().sum();
        let pace = self.length.iter().sum::<f64>() / (seconds * of.time_factor).max(1e-9);
        let out = (SLOWEST / pace.max(1e-9)).max(pace / FASTEST).max(1.0);
        // A log-normal tail, as of values outside the range of a quantity.
        let odds = -(0.5 * (out.ln() / FADE).powi(2)).min(MAX_LOSS);
        let figure = observed.format_figure(|| format!("moves with {pace:.2} m/s"));
        Some(ColumnRelation { roles: [self.roles.0, self.roles.1, Role::Other], odds, figure })
    }

    /// Returns the fraction of the squares across the best straight line: the smaller eigenvalue of
    /// the 2 by 2 moment matrix of the steps, divided by its trace.
    fn off_line(&self) -> f64 {
        let (nn, ee) = (sum_of_squares(&self.north), sum_of_squares(&self.east));
        let ne: f64 = self.north.iter().zip(&self.east).map(|(n, e)| n * e).sum();
        let half = (0.25 * (nn - ee).powi(2) + ne * ne).sqrt();
        ((0.5 * (nn + ee) - half) / (nn + ee).max(1e-300)).max(0.0)
    }

    fn velocity_relation(
        &self,
        observed: RelationInput<'_>,
        of: &Assignment,
        role: Role,
        steps: &[f64],
        text: &str,
    ) -> Option<ColumnRelation> {
        let (at, factor) = of.find(role)?;
        let factor = factor * of.time_factor;
        let integral = &observed.signals.scales.last()?.columns[at].integral;
        let fit = SeriesFit::new(steps, 1.0, integral, factor)?;
        let times = fit.slope;
        let told = || format!("speed of the positions {text} is {times:.2} times its value");
        let figure = observed.format_figure(told);
        let roles = [self.roles.0, self.roles.1, role];
        Some(ColumnRelation { roles, odds: fit.capped_odds(FLOOR), figure })
    }

    /// Relation of the track with the speed through the water: the track less a steady current of
    /// two components.
    fn water_relation(
        &self,
        observed: RelationInput<'_>,
        of: &Assignment,
        along: &[f64],
    ) -> Option<ColumnRelation> {
        let (at, factor) = of.find(Role::UWater)?;
        let scale = observed.signals.scales.last()?;
        let integral = &scale.columns[at].integral;
        let factor = factor * of.time_factor;
        let seconds: Vec<f64> = scale.duration.iter().map(|t| t * of.time_factor).collect();
        let rest: Vec<f64> = along.iter().zip(integral).map(|(a, b)| a - factor * b).collect();
        // Displacement by a current of 1 m/s north (c) and east (s), along the heading.
        let (c, s): (Vec<f64>, Vec<f64>) =
            self.psi.iter().zip(&seconds).map(|(psi, t)| (t * psi.cos(), t * psi.sin())).unzip();
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let (cc, cs, ss) = (dot(&c, &c), dot(&c, &s), dot(&s, &s));
        let (cr, sr) = (dot(&c, &rest), dot(&s, &rest));
        let determinant = cc * ss - cs * cs;
        if determinant <= 1e-9 * cc * ss {
            return None;
        }
        // Least squares for the two components of the current.
        let north = (ss * cr - cs * sr) / determinant;
        let east = (cc * sr - cs * cr) / determinant;
        let left: f64 = rest
            .iter()
            .zip(c.iter().zip(&s))
            .map(|(rest, (c, s))| (rest - north * c - east * s).powi(2))
            .sum();
        let figure = observed.format_figure(|| {
            format!(
                "agrees with the track minus a current of {:.2} m/s towards {:.0} deg",
                north.hypot(east),
                east.atan2(north).to_degrees().rem_euclid(360.0)
            )
        });
        // Compared with a current alone, which explains a steady speed as well.
        let alone = dot(along, along)
            - (cc * dot(&s, along).powi(2) - 2.0 * cs * dot(&c, along) * dot(&s, along)
                + ss * dot(&c, along).powi(2))
                / determinant;
        let all = sum_of_squares(along).max(1e-300);
        let speed = (all / along.len().max(1) as f64).sqrt()
            / (dot(&seconds, &seconds) / seconds.len().max(1) as f64).sqrt();
        let fast = if north.hypot(east) > CURRENT * speed { 10.0 } else { 0.0 };
        let odds = residual_odds((left / all).max(FLOOR))
            .min(2.0 + residual_odds((left / alone.max(1e-9 * all)).max(FLOOR)))
            - 4.0
            - fast;
        Some(ColumnRelation { roles: [Role::UWater, Role::Psi, Role::Other], odds, figure })
    }

    fn course_relation(
        &self,
        observed: RelationInput<'_>,
        of: &Assignment,
    ) -> Option<ColumnRelation> {
        let (at, factor) = of.find(Role::Course)?;
        let course = &observed.signals.scales.last()?.columns[at].mean;
        let steps = self.north.iter().zip(&self.east);
        let (mut said, mut all) = (0.0, 0.0);
        for ((n, e), course) in steps.zip(course) {
            said += n * (course * factor).cos() + e * (course * factor).sin();
            all += n.hypot(*e);
        }
        let off = 1.0 - said / all.max(1e-300);
        let (north, east): (f64, f64) = (self.north.iter().sum(), self.east.iter().sum());
        let straight = 1.0 - north.hypot(east) / all.max(1e-300);
        let odds = (-PER_FOLD * off.max(1e-4).ln())
            .min(STRAIGHT - PER_FOLD * (off.max(1e-4) / straight.max(1e-4)).ln())
            .min(ALONG + PER_FOLD * (self.off_heading().max(1e-4) / off.max(1e-4)).ln())
            .clamp(-8.0, 20.0);
        let told = || format!("{:.1} % of the distance made good is along it", 100.0 * (1.0 - off));
        let figure = observed.format_figure(told);
        Some(ColumnRelation { roles: [self.roles.0, self.roles.1, Role::Course], odds, figure })
    }
}

impl GroundTrack {
    /// Returns the part of the way made good that does not lie along the heading; 1 without one.
    fn off_heading(&self) -> f64 {
        let steps = self.north.iter().zip(&self.east).zip(&self.psi);
        let along: f64 = steps.map(|((n, e), psi)| n * psi.cos() + e * psi.sin()).sum();
        1.0 - along / self.length.iter().sum::<f64>().max(1e-300)
    }
}

fn sum_of_squares(values: &[f64]) -> f64 {
    values.iter().map(|value| value * value).sum()
}
