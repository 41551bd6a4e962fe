//! Trials that a craft is refined on, and manoeuvres by which the result is judged.

use super::simulate::Run;
use crate::truth::manoeuvre::Manoeuvre;

/// Slowest speed of the unseen manoeuvres by that of the slower trials.
const BELOW: [f64; 2] = [0.85, 0.9];

/// Speed of the slower trials by full speed: craft of odd seeds have two speeds, those of even
/// seeds one, so that their revolutions hardly change.
pub fn slow_speed(seed: u64) -> f64 {
    if seed.is_multiple_of(2) { 1.0 } else { 0.55 + 0.05 * (seed % 4) as f64 }
}

/// Trials in the order in which they are added: first what a yard has first, all at full speed but
/// four at a slower one, by full speed.
pub fn programme(slow: f64) -> [Run; 12] {
    let repeated = Manoeuvre::Zigzag(20.0, 20.0);
    let tenth = if slow < 1.0 { repeated } else { Manoeuvre::Random(35.0, 2) };
    [
        run(Manoeuvre::Zigzag(20.0, 20.0), 1.0),
        run(Manoeuvre::Turn(35.0), 1.0),
        run(Manoeuvre::Zigzag(-10.0, 10.0), 1.0),
        run(Manoeuvre::Turn(-35.0), 1.0),
        run(Manoeuvre::Zigzag(10.0, 10.0), slow),
        run(Manoeuvre::Turn(20.0), slow),
        run(Manoeuvre::Zigzag(-20.0, 20.0), 1.0),
        run(Manoeuvre::Random(25.0, 1), 1.0),
        run(Manoeuvre::Turn(-20.0), slow),
        run(tenth, slow),
        run(Manoeuvre::PullOut(-20.0), 1.0),
        run(Manoeuvre::Turn(-15.0), 1.0),
    ]
}

/// Manoeuvres that no refinement is given: other angles, and speeds between and below.
pub fn unseen(slow: f64) -> [Run; 6] {
    let below = slow * BELOW[usize::from(slow < 1.0)];
    let between = if slow < 1.0 { 0.5 * (1.0 + slow) } else { 0.5 * (1.0 + below) };
    [
        run(Manoeuvre::Zigzag(15.0, 15.0), 1.0),
        run(Manoeuvre::Zigzag(-15.0, 10.0), between),
        run(Manoeuvre::Turn(28.0), 1.0),
        run(Manoeuvre::Turn(-25.0), between),
        run(Manoeuvre::PullOut(-30.0), 1.0),
        run(Manoeuvre::Random(30.0, 3), below),
    ]
}

/// One trial more than any refinement is given, for a diagnosis.
pub fn further() -> Run {
    run(Manoeuvre::Zigzag(-20.0, 10.0), 1.0)
}

fn run(manoeuvre: Manoeuvre, speed: f64) -> Run {
    Run { manoeuvre, speed }
}
