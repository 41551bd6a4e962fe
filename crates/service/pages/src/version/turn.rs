//! Turning circle of a version as a small picture, for lists and fields that offer versions.

use std::sync::Arc;

use quick_cache::sync::Cache;
use sistership_jobs::Archive;
use sistership_jobs::aliases::CHAMPION;
use sistership_jobs::archive::version_document;
use sistership_jobs::version::VersionDocument;
use sistership_model::Law;
use sistership_report::plots::path_data;
use sistership_simulation::Ship;
use sistership_simulation::manoeuvre::{
    ManoeuvreSettings, STANDARD_MANOEUVRES, simulate_manoeuvre_batch,
};

use crate::error::Result;
use crate::plot::{LINES, PlotTrack};

/// Width and height of the picture, in its own units.
const SIDE: f64 = 48.0;
/// Distance of the track from the edges.
const MARGIN: f64 = 4.0;
/// Number of points of the track.
const POINTS: usize = 60;
/// Number of pictures in the cache, of about a kilobyte each.
const CACHED_PICTURES: usize = 2000;

/// Cache of pictures by the version's id. A version never changes, and neither does its picture.
#[derive(Debug)]
pub struct TurnCache(Cache<String, Arc<str>>);

impl Default for TurnCache {
    fn default() -> Self {
        Self(Cache::new(CACHED_PICTURES))
    }
}

/// Picture from the cache, or what it is drawn from.
pub enum TurnInputs {
    /// SVG.
    Known(Arc<str>),
    /// The version.
    Open(Box<TurnVersion>),
}

/// Version whose picture is to be drawn.
pub struct TurnVersion {
    id: String,
    document: VersionDocument,
    law: Law,
}

/// Reads the inputs of the picture of a version, by default of the champion.
///
/// # Errors
/// Returns an error if there is no such version or the store fails.
pub async fn gather_turn(
    archive: &Archive,
    known: &TurnCache,
    ship: &str,
    number: Option<i64>,
) -> Result<TurnInputs> {
    let store = &archive.store;
    let number = match number {
        Some(number) => number,
        None => store.aliases().get(ship, CHAMPION).await?.version_number,
    };
    // The head is enough for a picture that is known: documents are large.
    let head = store.versions().get_head(ship, number).await?;
    if let Some(picture) = known.0.get(&head.id) {
        return Ok(TurnInputs::Known(picture));
    }
    let mut document = version_document(&store.versions().get(ship, number).await?)?;
    archive.attach_weights(&mut document.model).await?;
    let law = archive.law_by_hash(&document.model.law, document.recipe.law_sha256()).await?;
    Ok(TurnInputs::Open(Box::new(TurnVersion { id: head.id, document, law })))
}

impl TurnInputs {
    /// Returns the picture, SVG, and keeps it in the cache.
    pub fn render_svg(self, known: &TurnCache) -> Arc<str> {
        match self {
            Self::Known(picture) => picture,
            Self::Open(version) => {
                let picture: Arc<str> = draw_track(&version.turn_track()).into();
                known.0.insert(version.id, Arc::clone(&picture));
                picture
            }
        }
    }
}

impl TurnVersion {
    /// Returns the positions of a turn of 35 degrees to starboard; empty if it cannot be simulated.
    fn turn_track(&self) -> Vec<(f64, f64)> {
        let Ok(ship) = Ship::new(&self.document.model, &self.law) else { return Vec::new() };
        let turn = [(STANDARD_MANOEUVRES[0], &[][..])];
        let run = simulate_manoeuvre_batch(&ship, &turn, &ManoeuvreSettings::default());
        let track = run.into_iter().next().and_then(std::result::Result::ok).map(|run| run.track);
        let track = track.map(|track| PlotTrack::from_simulation(LINES[0], "", &track, false));
        track.and_then(|track| track.positions()).unwrap_or_default()
    }
}

/// Draws positions `(north, east)`, north up, as large as the picture allows.
fn draw_track(positions: &[(f64, f64)]) -> String {
    let every = positions.len().div_ceil(POINTS).max(1);
    let points: Vec<(f64, f64)> =
        positions.iter().step_by(every).map(|(north, east)| (*east, -north)).collect();
    let range = |of: fn(&(f64, f64)) -> f64| {
        points.iter().map(of).fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
            (low.min(value), high.max(value))
        })
    };
    let (x, y) = (range(|point| point.0), range(|point| point.1));
    let scale = (SIDE - 2.0 * MARGIN) / (x.1 - x.0).max(y.1 - y.0).max(1e-9);
    let place =
        |value: f64, (low, high): (f64, f64)| 0.5 * SIDE + scale * (value - 0.5 * (low + high));
    let placed: Vec<(f64, f64)> =
        points.iter().map(|point| (place(point.0, x), place(point.1, y))).collect();
    let d = path_data(&placed, |_, _| false);
    // The colour has enough contrast to light and dark pages; styles of pages do not reach it.
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {SIDE} {SIDE}\"><path d=\"{d}\" \
         fill=\"none\" stroke=\"#3f8cc4\" stroke-width=\"2\" stroke-linejoin=\"round\"/></svg>"
    )
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use sistership_jobs::derive::published_document;
    use sistership_model::Zoo;

    use super::*;

    #[test]
    fn a_turn_fills_a_small_picture_and_is_drawn_once() {
        let zoo = Zoo::load_embedded().unwrap();
        let (vessel, law) = (zoo.vessel("mariner").unwrap(), zoo.law("abkowitz").unwrap());
        let name = &vessel.file.models[0].name;
        let document = published_document(vessel, name, law, "", "").unwrap();
        let version = TurnVersion { id: "a".to_owned(), document, law: Law::clone(law) };
        // A turn to starboard goes ahead and to the east.
        let track = version.turn_track();
        let furthest = track.iter().map(|(_, east)| *east).fold(0.0, f64::max);
        assert!(furthest > 100.0, "{furthest}");
        let known = TurnCache::default();
        let picture = TurnInputs::Open(Box::new(version)).render_svg(&known);
        assert!(picture.contains("d=\"M") && picture.len() < 1500, "{} bytes", picture.len());
        assert!(Arc::ptr_eq(&picture, &known.0.get("a").unwrap()));
        assert!(draw_track(&[]).contains("<path d=\"\""), "{}", draw_track(&[]));
    }
}
