//! Who stands at the helm during a manoeuvre, and the sailing of many at once.

use super::ManoeuvreSettings;
use crate::envelope::Stopped;
use crate::sailing::{Sailing, sail_all};
use crate::ship::{Order, Ship};
use crate::state::{StateVector, Trajectory, at, straight};

/// A manoeuvre by its angles, deg.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Manoeuvre {
    /// A turning circle.
    Turn {
        /// Rudder.
        rudder: f64,
    },
    /// A zigzag of four reversals.
    Zigzag {
        /// Rudder, to the side of the first execute.
        rudder: f64,
        /// Change of heading at which the rudder is reversed.
        switch: f64,
    },
}

impl std::fmt::Display for Manoeuvre {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Turn { rudder } => write!(out, "turn {rudder} deg"),
            Self::Zigzag { rudder, switch } => write!(out, "zigzag {rudder}/{switch}"),
        }
    }
}

/// What was sailed.
#[derive(Debug)]
pub struct Sailed {
    /// From the execution of the rudder on.
    pub after: Trajectory,
    /// With the run before it.
    pub track: Trajectory,
    /// When the rudder was reversed, s since it was executed.
    pub reversals_s: Vec<f64>,
}

/// Sails manoeuvres in lockstep, each by a sister with her own coefficients ([`Ship::sister`]); none for a ship with hers.
///
/// Each fails by itself where the motion leaves the physical range, and says when and why.
pub fn sail_together(
    ship: &Ship,
    manoeuvres: &[(Manoeuvre, &[f64])],
    settings: &ManoeuvreSettings,
) -> Vec<Result<Sailed, Stopped>> {
    let run = settings.run(ship, straight(settings.speed(ship)));
    let mut helms: Vec<Helm> =
        manoeuvres.iter().map(|(manoeuvre, _)| Helm::new(ship, *manoeuvre, settings)).collect();
    let sailings = helms.iter_mut().zip(manoeuvres).map(|(helm, (_, coefficients))| {
        Sailing::new(run, coefficients, |t_s, state: &StateVector| helm.order(t_s, state))
    });
    let sailings = sailings.collect();
    let sailed = sail_all(ship, settings.method, sailings);
    let one = |(helm, sailed): (Helm, crate::sailing::Sailed)| match sailed.stopped {
        Some(stopped) => Err(stopped),
        None => {
            let after = after(&sailed.track, settings.run_in_s);
            Ok(Sailed { after, track: sailed.track, reversals_s: helm.reversals_s })
        }
    };
    helms.into_iter().zip(sailed).map(one).collect()
}

/// Carries out a manoeuvre.
struct Helm {
    manoeuvre: Manoeuvre,
    n_rps: f64,
    run_in_s: f64,
    /// Whether it goes on when all is seen.
    goes_on: bool,
    reversals_s: Vec<f64>,
}

impl Helm {
    fn new(ship: &Ship, manoeuvre: Manoeuvre, settings: &ManoeuvreSettings) -> Self {
        let (n_rps, run_in_s) = (settings.revolutions(ship), settings.run_in_s);
        Self {
            manoeuvre,
            n_rps,
            run_in_s,
            goes_on: settings.duration_s.is_some(),
            reversals_s: Vec::new(),
        }
    }

    /// The order at a time; none when all is seen.
    fn order(&mut self, t_s: f64, state: &StateVector) -> Option<Order> {
        let since_s = t_s - self.run_in_s;
        let rudder_deg = if since_s < -1e-9 { 0.0 } else { self.rudder_deg(since_s, state) };
        let order = Order { delta_rad: rudder_deg.to_radians(), n_rps: self.n_rps };
        (self.goes_on || !self.is_done(state)).then_some(order)
    }

    /// A zigzag reverses the rudder at the first step at which the heading has reached the switching angle.
    fn rudder_deg(&mut self, since_s: f64, state: &StateVector) -> f64 {
        let (rudder, switch) = match self.manoeuvre {
            Manoeuvre::Turn { rudder } => return rudder,
            Manoeuvre::Zigzag { rudder, switch } => (rudder, switch),
        };
        let sign = |reversals: usize| if reversals.is_multiple_of(2) { 1.0 } else { -1.0 };
        if sign(self.reversals_s.len()) * rudder.signum() * state[at::PSI].to_degrees() >= switch {
            self.reversals_s.push(since_s);
        }
        sign(self.reversals_s.len()) * rudder
    }

    fn is_done(&self, state: &StateVector) -> bool {
        match self.manoeuvre {
            Manoeuvre::Turn { .. } => state[at::PSI].abs() > 3.0 * std::f64::consts::TAU,
            Manoeuvre::Zigzag { .. } => self.reversals_s.len() > 4,
        }
    }
}

/// The part of a track from a time on, with time counted from there.
fn after(track: &Trajectory, from_s: f64) -> Trajectory {
    let keep = |index: &usize| track.t_s[*index] >= from_s - 1e-9;
    let mut result = Trajectory::default();
    for k in (0..track.t_s.len()).filter(keep) {
        result.push(track.t_s[k] - from_s, track.states[k], track.n_rps[k]);
    }
    result
}
