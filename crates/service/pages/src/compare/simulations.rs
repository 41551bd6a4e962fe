//! Simulated manoeuvres of each version of a comparison.

use sistership_simulation::Ship;
use sistership_simulation::manoeuvre::{
    ManoeuvreSettings, StandardManoeuvres, simulate_standard_manoeuvres, simulate_turn,
    simulate_zigzag,
};

use crate::language::say;
use crate::named::NamedVersion;
use crate::plot::{LINES, PlotTrack};

/// Standard manoeuvres of a version.
pub(super) struct VersionManoeuvres {
    pub figures: Option<StandardManoeuvres>,
    pub turn: Option<PlotTrack>,
    pub zigzag: Option<PlotTrack>,
    pub notes: Vec<String>,
}

impl VersionManoeuvres {
    /// Simulates a version; its position in the comparison decides the line style. A model that
    /// cannot be simulated gives a note only.
    pub fn simulate_version(version: &NamedVersion, place: usize) -> Self {
        let label = version.label();
        match Ship::new(&version.document.model, &version.law) {
            Ok(ship) => Self::simulate_ship(&ship, &label, place),
            Err(error) => Self {
                figures: None,
                turn: None,
                zigzag: None,
                notes: vec![
                    say("compare-not-simulated")
                        .with("version", label)
                        .with("reason", error.to_string())
                        .into(),
                ],
            },
        }
    }

    fn simulate_ship(ship: &Ship, label: &str, place: usize) -> Self {
        let settings = ManoeuvreSettings::default();
        let style = LINES[place % LINES.len()];
        let figures = simulate_standard_manoeuvres(ship, &settings);
        let notes = figures.failures.iter().map(|failure| format!("{label}: {failure}")).collect();
        let track = |track| PlotTrack::from_simulation(style, label, &track, ship.has_roll());
        Self {
            // The tracks are those of single manoeuvres; a manoeuvre that fails is absent, and its
            // failure is among the notes.
            turn: simulate_turn(ship, 35.0, &settings).ok().map(|turn| track(turn.track)),
            zigzag: simulate_zigzag(ship, 20.0, 20.0, &settings)
                .ok()
                .map(|zigzag| track(zigzag.track)),
            figures: Some(figures),
            notes,
        }
    }
}
