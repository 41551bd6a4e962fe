//! The figures by which predictions are judged.

use sistership_model::{Model, Zoo};
use sistership_simulation::Ship;
use sistership_simulation::manoeuvre::{ManoeuvreSettings, simulate_standard_manoeuvres};

/// Tactical diameter in ship lengths and first overshoots at 10/10 and 20/20 in deg, to starboard.
#[derive(Debug, Clone, Copy)]
pub struct Figures([Option<f64>; 3]);

/// What a figure that is not reached counts, as the logarithm of a ratio.
const NOT_REACHED: f64 = 1.6;
/// Overshoots below this differ by nothing that is seen, deg.
const LEAST_DEG: f64 = 0.5;

impl Figures {
    /// Of the three figures.
    pub fn new(figures: [Option<f64>; 3]) -> Self {
        Self(figures)
    }

    /// Whether all are reached.
    pub fn complete(&self) -> bool {
        self.0.iter().all(Option::is_some)
    }

    /// The weighted mean of the logarithms; where one has no figure, the other's.
    pub fn between(&self, other: &Self, share: f64) -> Self {
        Self(std::array::from_fn(|k| match (self.0[k], other.0[k]) {
            (Some(a), Some(b)) => Some((share * a.ln() + (1.0 - share) * b.ln()).exp()),
            (a, b) => a.or(b),
        }))
    }
}

/// Sails a model; none where the law lacks what the ship does not give.
pub fn sailed(zoo: &Zoo, model: &Model) -> Option<Figures> {
    let ship = Ship::new(model, zoo.law(&model.law)?).ok()?;
    let settings = ManoeuvreSettings { reversals_within_steps: true, ..Default::default() };
    let all = simulate_standard_manoeuvres(
        &ship,
        &ManoeuvreSettings { step_s: Some(step(&ship)), ..settings },
    );
    let turn = all.turns.iter().find(|turn| turn.rudder_deg > 0.0);
    let zigzag = |rudder: f64| {
        let zigzag = all.zigzags.iter().find(|zigzag| zigzag.rudder_deg == rudder);
        zigzag?.first_overshoot_deg.map(|angle| angle.max(LEAST_DEG))
    };
    let diameter = turn.and_then(|turn| turn.tactical_diameter_m).filter(|metres| *metres > 0.0);
    Some(Figures([diameter.map(|metres| metres / ship.lpp_m()), zigzag(10.0), zigzag(20.0)]))
}

fn step(ship: &Ship) -> f64 {
    0.04 * ship.lpp_m() / ship.approach_speed_m_s()
}

/// The mean of the absolute logarithms of the ratios: 0.1 is about 10 %.
pub fn error(predicted: &Figures, own: &Figures) -> f64 {
    let one = |(predicted, own): (Option<f64>, Option<f64>)| {
        let own = own?;
        Some(predicted.map_or(NOT_REACHED, |predicted| (predicted / own).ln().abs()))
    };
    let errors: Vec<f64> = predicted.0.into_iter().zip(own.0).filter_map(one).collect();
    errors.iter().sum::<f64>() / errors.len() as f64
}
