//! Ships whose laws no law of the zoo contains, with trials that they sailed and files as people
//! have them.
//!
//! Each ship is an ordinary differential equation of this crate, integrated with Runge-Kutta at 0.1
//! s; nothing of it is lowered from a law file. The hull is linear (regression, or slender-body
//! theory) with a strip-wise cross-flow drag, the rudder a wing with lift and drag in a slipstream,
//! and the resistance that of the ITTC friction line. `causes` has what may be hidden in their
//! trials. `foreign` has ships of eight kinds of propulsion by equations of its own.

pub mod causes;
pub mod clarke;
pub mod container;
pub mod cross_flow;
pub mod dimensions;
pub mod family;
pub mod ferry;
pub mod files;
pub mod foreign;
pub mod instruments;
pub mod manoeuvre;
pub mod model_tanker;
pub mod motion;
pub mod propeller;
pub mod resistance;
pub mod rudder;
pub mod single_screw;
pub mod stability;
pub mod stalled;
pub mod tanker;
pub mod twin_screw;

use sistership_model::Trial;

use instruments::Instruments;
use manoeuvre::Manoeuvre;
use motion::Truth;

/// Trials that a ship sailed, as its instruments recorded them; each by a random number of its own.
pub fn trials(
    ship: &dyn Truth,
    manoeuvres: &[Manoeuvre],
    instruments: &Instruments,
    seed: u64,
) -> Vec<Trial> {
    let one = |(index, manoeuvre): (usize, &Manoeuvre)| {
        let mut rng = crate::synthetic::replica(seed, 100 + index);
        let name = format!("{}.csv", manoeuvre.name());
        instruments.record(ship, &name, &manoeuvre.sailed(ship), &mut rng)
    };
    manoeuvres.iter().enumerate().map(one).collect()
}
