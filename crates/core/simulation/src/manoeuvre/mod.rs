//! The standard manoeuvres, sailed by a model.

mod figures;
mod further;
mod helm;
mod pull_out;
mod reversing;
mod spiral;
mod standard;
mod steady;
mod stopping;

use serde::{Deserialize, Serialize};

pub use figures::Figure;
pub use further::{AskedSpiral, FurtherAsked, FurtherManoeuvres, further};
pub use helm::{Manoeuvre, Sailed, sail_together};
pub use pull_out::{PullOut, pull_out};
pub use reversing::{NotReversing, check_reversing};
pub use spiral::spiral;
pub use standard::{
    STANDARD, StandardManoeuvres, Turn, Zigzag, standard, standard_of_sisters, standard_with_tracks,
};
pub use stopping::{AsternOrder, NoStopping, Stopping, stop};

use crate::envelope::Stopped;
use crate::integrate::Method;
use crate::ship::{Run, Ship};
use crate::state::StateVector;

/// How manoeuvres are sailed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ManoeuvreSettings {
    /// Approach speed, m/s; the model's own where absent.
    pub speed_m_s: Option<f64>,
    /// Propeller revolutions, 1/s; those of steady running at the approach speed where absent.
    pub n_rps: Option<f64>,
    /// Longest duration, s; enough for a turn of three times round where absent.
    pub duration_s: Option<f64>,
    /// Step, s; where absent 0.1 s, or a fiftieth of the time in which a small ship sails its
    /// length.
    pub step_s: Option<f64>,
    /// Integration method.
    pub method: Method,
    /// Run straight for this long before the rudder is executed, s.
    pub run_in_s: f64,
    /// Whether a zigzag's rudder is reversed when the heading is reached within a step, and not at
    /// the step's end: what coarse steps need for overshoots that differ little.
    pub reversals_within_steps: bool,
    /// Whether the initial turns end soon after the change of heading that is asked for, and not
    /// three times round: their figure needs no more.
    pub figures_only: bool,
}

impl Default for ManoeuvreSettings {
    fn default() -> Self {
        Self {
            speed_m_s: None,
            n_rps: None,
            duration_s: None,
            step_s: None,
            method: Method::Rk4,
            run_in_s: 0.0,
            reversals_within_steps: false,
            figures_only: false,
        }
    }
}

impl ManoeuvreSettings {
    fn speed(&self, ship: &Ship) -> f64 {
        self.speed_m_s.unwrap_or(ship.approach_speed_m_s())
    }

    fn revolutions(&self, ship: &Ship) -> f64 {
        self.n_rps.unwrap_or_else(|| ship.revolutions_at(self.speed(ship)))
    }

    /// Scaled so that a small model and a large ship sail as far: 60 of its lengths.
    fn duration(&self, ship: &Ship) -> f64 {
        self.duration_s.unwrap_or_else(|| 60.0 * ship.lpp_m() / self.speed(ship)) + self.run_in_s
    }

    /// The step, s.
    pub fn step(&self, ship: &Ship) -> f64 {
        let default = 0.1_f64.min(0.02 * ship.lpp_m() / self.speed(ship));
        self.step_s.unwrap_or(default)
    }

    fn run(&self, ship: &Ship, start: StateVector) -> Run {
        let (duration_s, step_s) = (self.duration(ship), self.step(ship));
        Run { start, duration_s, step_s, method: self.method }
    }
}

/// Sails a turning circle.
///
/// # Errors
/// Says when and why the motion left the physical range.
pub fn turn(ship: &Ship, rudder_deg: f64, settings: &ManoeuvreSettings) -> Result<Turn, Stopped> {
    let turn = Manoeuvre::Turn { rudder: rudder_deg };
    Turn::of(sail_together(ship, &[(turn, &[])], settings).remove(0)?, rudder_deg)
}

/// Sails a zigzag of four reversals.
///
/// # Errors
/// Says when and why the motion left the physical range.
pub fn zigzag(
    ship: &Ship,
    rudder_deg: f64,
    switch_deg: f64,
    settings: &ManoeuvreSettings,
) -> Result<Zigzag, Stopped> {
    zigzags(ship, &[(rudder_deg, switch_deg)], settings).remove(0)
}

/// Zigzags side by side: rudder and heading at which it is reversed, deg. The errors are those of
/// [`zigzag`], each its own.
pub fn zigzags(
    ship: &Ship,
    angles: &[(f64, f64)],
    settings: &ManoeuvreSettings,
) -> Vec<Result<Zigzag, Stopped>> {
    let of = |&(rudder, switch): &(f64, f64)| (Manoeuvre::Zigzag { rudder, switch }, &[] as &[_]);
    let all: Vec<_> = angles.iter().map(of).collect();
    let sailed = sail_together(ship, &all, settings).into_iter().zip(angles);
    sailed.map(|(track, (rudder, switch))| Zigzag::of(track?, *rudder, *switch)).collect()
}
