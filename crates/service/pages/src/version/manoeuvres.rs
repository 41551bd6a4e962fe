//! The standard manoeuvres on the page of a version.
//!
//! A version never changes, and neither do its manoeuvres: their simulation takes most of the
//! page's time, and is done once.

use std::sync::Arc;

use askama::Template as _;
use quick_cache::Weighter;
use quick_cache::sync::Cache;
use sistership_jobs::version::VersionDocument;
use sistership_model::Law;
use sistership_report::plots::HullOutline;
use sistership_simulation::manoeuvre::{
    Manoeuvre, ManoeuvreSettings, STANDARD_MANOEUVRES, StandardManoeuvres,
    simulate_manoeuvre_batch, simulate_standard_with_tracks,
};
use sistership_simulation::{PlantError, Ship, Trajectory};

use super::figures::{self, CriterionRow, FigureRow};
use crate::error::Result;
use crate::language::{Language, say};
use crate::plot::{LINES, PlotTrack, track_chart};

/// Memory of the cache, bytes.
const CACHE_BYTES: u64 = 32 << 20;
/// Estimated number of versions in the cache.
const CACHED_VERSIONS: usize = 500;
/// Manoeuvres in the plots, by their index among the standard manoeuvres, and the keys of their
/// names.
const PLOTTED: [(usize, &str); 3] =
    [(0, "plot-turn-starboard"), (1, "plot-turn-port"), (4, "plot-zigzag-line")];
/// Zigzag among them, which has a chart of its own.
const ZIGZAG: &str = PLOTTED[2].1;

/// Cache of manoeuvres by the version's id; the least recently used are removed first.
#[derive(Debug)]
pub struct ManoeuvreCache(Cache<String, Arc<ManoeuvreResults>, ManoeuvreSize>);

/// Manoeuvres on the page.
#[derive(Debug)]
pub(super) struct ManoeuvreResults {
    pub figures: Vec<FigureRow>,
    pub criteria: Vec<CriterionRow>,
    pub banded: bool,
    pub wide: bool,
    pub notes: Vec<String>,
    /// Name and chart of the turning circles and of the zigzag, HTML.
    pub charts: Vec<(String, String)>,
}

#[derive(Debug, Clone)]
struct ManoeuvreSize;

impl Weighter<String, Arc<ManoeuvreResults>> for ManoeuvreSize {
    fn weight(&self, _: &String, manoeuvres: &Arc<ManoeuvreResults>) -> u64 {
        let drawn: usize = manoeuvres.charts.iter().map(|(_, chart)| chart.len()).sum();
        // Estimated bytes of one row.
        let row = 300;
        (drawn + row * (manoeuvres.figures.len() + manoeuvres.criteria.len() + 1)) as u64
    }
}

impl Default for ManoeuvreCache {
    fn default() -> Self {
        Self(Cache::with_weighter(CACHED_VERSIONS, CACHE_BYTES, ManoeuvreSize))
    }
}

impl ManoeuvreCache {
    /// Returns the manoeuvres of a version, from the cache if possible.
    ///
    /// # Errors
    /// Returns an error if a plot cannot be rendered.
    pub(super) fn get_or_simulate(
        &self,
        id: &str,
        document: &VersionDocument,
        law: &Law,
    ) -> Result<Arc<ManoeuvreResults>> {
        // Names of figures and charts are in the language of the page.
        let key = format!("{id} {}", Language::current().code());
        if let Some(known) = self.0.get(&key) {
            return Ok(known);
        }
        let manoeuvres = Arc::new(ManoeuvreResults::from_version(document, law)?);
        // Two requests at a time may both simulate; the results are equal.
        self.0.insert(key, Arc::clone(&manoeuvres));
        Ok(manoeuvres)
    }
}

impl ManoeuvreResults {
    /// Name of each criterion, and whether it is met.
    pub fn verdicts(&self) -> Vec<(&str, Option<bool>)> {
        self.criteria.iter().map(|row| (row.key.as_str(), row.pass)).collect()
    }

    fn from_version(document: &VersionDocument, law: &Law) -> Result<Self> {
        let model = &document.model;
        // A model that cannot be simulated still has its page, with the reason among the notes.
        let (figures, tracks) = match simulate_manoeuvres(document, law) {
            Ok((figures, tracks)) => (figures, tracks),
            Err(error) => {
                let failures = vec![error.to_string()];
                (StandardManoeuvres { failures, ..StandardManoeuvres::default() }, Vec::new())
            }
        };
        let notes = figures.failures.clone();
        let (figures, criteria) = figures::figure_rows(&figures, &document.report);
        let (zigzags, circles): (Vec<PlotTrack>, Vec<PlotTrack>) =
            tracks.into_iter().partition(|track| track.name == say(ZIGZAG).to_string());
        let hull = HullOutline::from_particulars(&model.particulars);
        let mut charts = Vec::new();
        for (key, tracks) in [("plot-turns", circles), ("plot-zigzag", zigzags)] {
            let name = String::from(say(key));
            if !tracks.is_empty() {
                let chart = track_chart(&tracks, hull, &name).render()?;
                charts.push((name, chart));
            }
        }
        Ok(Self {
            banded: figures.iter().any(|figure| !figure.band.is_empty()),
            wide: figures.iter().any(|figure| figure.wide),
            figures,
            criteria,
            notes,
            charts,
        })
    }
}

/// Returns the figures, from the report if it has them, and the tracks.
fn simulate_manoeuvres(
    document: &VersionDocument,
    law: &Law,
) -> std::result::Result<(StandardManoeuvres, Vec<PlotTrack>), PlantError> {
    let ship = Ship::new(&document.model, law)?;
    let settings = ManoeuvreSettings::default();
    let (figures, tracks) = match reported_figures(document) {
        Some(figures) => (figures, simulate_plotted(&ship, &settings)),
        None => {
            let (figures, mut all) = simulate_standard_with_tracks(&ship, &settings);
            (figures, PLOTTED.map(|(place, _)| all[place].take()).into_iter().collect())
        }
    };
    let named = tracks.into_iter().zip(PLOTTED).zip(LINES);
    let tracks = named.filter_map(|((track, (_, name)), style)| {
        Some(PlotTrack::from_simulation(style, say(name), &track?, ship.has_roll()))
    });
    Ok((figures, tracks.collect()))
}

/// Returns the figures of the report, which were simulated when the version was made.
fn reported_figures(document: &VersionDocument) -> Option<StandardManoeuvres> {
    let refined = document.report.pointer("/manoeuvres/refined")?;
    serde_json::from_value(refined.clone()).ok()
}

fn simulate_plotted(ship: &Ship, settings: &ManoeuvreSettings) -> Vec<Option<Trajectory>> {
    let manoeuvres: [(Manoeuvre, &[f64]); 3] =
        PLOTTED.map(|(place, _)| (STANDARD_MANOEUVRES[place], &[][..]));
    let sailed = simulate_manoeuvre_batch(ship, &manoeuvres, settings);
    sailed.into_iter().map(|sailed| Some(sailed.ok()?.track)).collect()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use serde_json::json;
    use sistership_jobs::derive::published_document;
    use sistership_model::Zoo;
    use sistership_simulation::manoeuvre::simulate_standard_manoeuvres;

    #[test]
    fn manoeuvres_are_sailed_once_and_as_the_report_has_them_where_it_does() {
        let zoo = Zoo::load_embedded().unwrap();
        let (vessel, law) = (zoo.vessel("mariner").unwrap(), zoo.law("abkowitz").unwrap());
        let name = &vessel.file.models[0].name;
        let mut document = published_document(vessel, name, law, "", "").unwrap();
        let known = ManoeuvreCache::default();
        let first = known.get_or_simulate("a", &document, law).unwrap();
        assert!(Arc::ptr_eq(&first, &known.get_or_simulate("a", &document, law).unwrap()));
        let names: Vec<&str> = first.charts.iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(names, ["Turning circles, 35 deg", "Zigzag 20/20"]);
        let ship = Ship::new(&document.model, law).unwrap();
        let refined = simulate_standard_manoeuvres(&ship, &ManoeuvreSettings::default());
        document.report = json!({ "manoeuvres": { "refined": refined } });
        let reported = known.get_or_simulate("b", &document, law).unwrap();
        let values = |of: &ManoeuvreResults| {
            of.figures.iter().map(|row| row.value.clone()).collect::<Vec<_>>()
        };
        assert_eq!(values(&reported), values(&first));
        assert_eq!(reported.charts, first.charts);
    }
}
