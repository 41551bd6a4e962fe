//! Candidate trials of a design.

use sistership_simulation::manoeuvre::Manoeuvre;

use crate::thresholds::THRESHOLDS;

/// A candidate trial.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct ManoeuvreCandidate {
    /// Manoeuvre by the rudder.
    pub manoeuvre: Manoeuvre,
    /// Approach speed by that of the model.
    pub speed: f64,
    /// Heading of the approach, deg.
    pub heading_deg: f64,
}

/// Rudder angles of turns, deg: from the initial turn to hard over.
const TURNS_DEG: [f64; 5] = [10.0, 15.0, 20.0, 25.0, 35.0];

/// Rudder and change of heading of zigzags, deg: those of IMO, gentler and harder ones, and two
/// with more rudder than heading.
const ZIGZAGS_DEG: [(f64, f64); 6] =
    [(5.0, 5.0), (10.0, 10.0), (20.0, 10.0), (20.0, 20.0), (30.0, 30.0), (35.0, 20.0)];

/// Manoeuvres of IMO MSC.137(76), in the usual order of sea trials.
const STANDARD: [Manoeuvre; 6] = [
    Manoeuvre::Turn { rudder: 35.0 },
    Manoeuvre::Turn { rudder: -35.0 },
    Manoeuvre::Zigzag { rudder: 10.0, switch: 10.0 },
    Manoeuvre::Zigzag { rudder: -10.0, switch: 10.0 },
    Manoeuvre::Zigzag { rudder: 20.0, switch: 20.0 },
    Manoeuvre::Zigzag { rudder: -20.0, switch: 20.0 },
];

/// Returns all manoeuvres to both sides, at all speeds, and on several headings where an external
/// influence is present.
pub(crate) fn all_candidates(has_outside: bool) -> Vec<ManoeuvreCandidate> {
    let turns = TURNS_DEG.into_iter().map(|rudder| Manoeuvre::Turn { rudder });
    let zigzag = |(rudder, switch): (f64, f64)| Manoeuvre::Zigzag { rudder, switch };
    let one_side = turns.chain(ZIGZAGS_DEG.map(zigzag));
    // Both sides are candidates, as a ship need not be symmetric.
    let both = one_side.flat_map(|manoeuvre| [manoeuvre, mirror_manoeuvre(manoeuvre)]);
    // Without an external influence all headings give the same information.
    let headings = &THRESHOLDS.headings_deg[..if has_outside { 3 } else { 1 }];
    let at = |manoeuvre: Manoeuvre| {
        let speeds = THRESHOLDS.speeds.into_iter();
        speeds.flat_map(move |speed| {
            headings.iter().map(move |&heading_deg| ManoeuvreCandidate {
                manoeuvre,
                speed,
                heading_deg,
            })
        })
    };
    both.flat_map(at).collect()
}

fn mirror_manoeuvre(manoeuvre: Manoeuvre) -> Manoeuvre {
    match manoeuvre {
        Manoeuvre::Turn { rudder } => Manoeuvre::Turn { rudder: -rudder },
        Manoeuvre::Zigzag { rudder, switch } => Manoeuvre::Zigzag { rudder: -rudder, switch },
    }
}

/// Indices among candidates of the IMO manoeuvres at full speed, on the first heading.
pub(crate) fn standard_indices(candidates: &[ManoeuvreCandidate]) -> Vec<usize> {
    let place = |manoeuvre: Manoeuvre| {
        candidates.iter().position(|one| one.manoeuvre == manoeuvre && one.speed == 1.0)
    };
    STANDARD.into_iter().filter_map(place).collect()
}
