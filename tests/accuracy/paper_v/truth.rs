//! The true ship: SR108 by the law of Son and Nomoto, sailed as in Paper V, section 4.2.

use std::ops::Range;

use sistership_model::trial::{Channel, Trial};
use sistership_model::{Model, Zoo};
use sistership_simulation::state::{RECORDED_CHANNELS, StateVector, at, straight_state};
use sistership_simulation::{HelmOrder, Method, RunSettings, Ship, Trajectory};

/// Sampling interval and Euler step, s.
pub const STEP_S: f64 = 0.5;
/// The samples from the start of predictions, 6 s after the execution, to the end.
pub const PREDICTED: Range<usize> = 132..1301;
/// The samples that are fitted.
pub const FITTED: Range<usize> = 132..132 + 1161;
/// When the rudder is executed, s.
const EXECUTE_S: f64 = 60.0;
/// How long every manoeuvre is recorded, s.
const DURATION_S: f64 = 650.0;

/// SR108 at certain revolutions.
pub struct Truth {
    /// The model of it that is the truth.
    pub model: Model,
    /// Its speed in steady running, m/s.
    pub speed_m_s: f64,
    /// Its revolutions, 1/s.
    pub n_rps: f64,
    ship: Ship,
}

impl Truth {
    /// At given revolutions.
    pub fn new(zoo: &Zoo, n_rpm: f64) -> Self {
        let model = zoo.find_model("sr108").unwrap_or_else(|error| panic!("{error}"));
        let law = zoo.law(&model.law).expect("the law of a zoo model");
        let ship = Ship::new(&model, law).expect("a ready ship");
        let n_rps = n_rpm / 60.0;
        // Thrust and resistance balance at the same advance ratio whatever the speed.
        let speed_m_s = n_rps / ship.revolutions_at(1.0);
        Self { model, speed_m_s, ship, n_rps }
    }

    /// A turning circle.
    pub fn turn(&self, rudder_deg: f64) -> Trajectory {
        self.sail(|_| rudder_deg.to_radians())
    }

    /// A zigzag, first to starboard.
    pub fn zigzag(&self, rudder_deg: f64, heading_deg: f64) -> Trajectory {
        let mut side = 1.0;
        self.sail(|state| {
            if side * state[at::PSI] >= heading_deg.to_radians() {
                side = -side;
            }
            side * rudder_deg.to_radians()
        })
    }

    /// The product's manoeuvres do not take a step as long as the paper's.
    fn sail(&self, mut rudder: impl FnMut(&StateVector) -> f64) -> Trajectory {
        let run = RunSettings {
            start: straight_state(self.speed_m_s),
            duration_s: DURATION_S,
            step_s: STEP_S,
            method: Method::Euler,
        };
        let mut track = Trajectory::default();
        let bridge = |t_s: f64, state: &StateVector| {
            let delta_rad = if t_s >= EXECUTE_S { rudder(state) } else { 0.0 };
            Some(HelmOrder { delta_rad, n_rps: self.n_rps })
        };
        self.ship
            .simulate_orders(run, &mut track, bridge)
            .unwrap_or_else(|stopped| panic!("the true ship {stopped}"));
        track
    }
}

/// A part of a track as a trial without measurement errors.
pub fn recorded(track: &Trajectory, samples: Range<usize>) -> Trial {
    let column = |(channel, index): (Channel, usize)| {
        (channel, track.state_column(index)[samples.clone()].to_vec())
    };
    let channels =
        RECORDED_CHANNELS.into_iter().chain([(Channel::Delta, at::DELTA)]).map(column).collect();
    Trial { t_s: track.t_s[samples.clone()].to_vec(), channels, ..Trial::default() }
}
