//! Map of the fleet: ships at the positions of their newest trials, with coast lines of Natural
//! Earth. Nothing is loaded from elsewhere.

mod coastline;

use askama::Template;
use sistership_jobs::Archive;
use sistership_jobs::search::position::{ShipPosition, count_positions, fleet_positions};
use sistership_jobs::search::urgency::UrgencyClass;
use sistership_report::plots::path_data;

use self::coastline::{GeographicView, visible_land};
use super::class_label::class_label;
use crate::error::Result;
use crate::language::{say, say_word};
use crate::numbers::format_fixed;

/// Largest number of ships on the map; the page stays small with any fleet.
const MOST_SHIPS: i64 = 100;
/// Size in units of the drawing.
const SIZE: (f64, f64) = (640.0, 340.0);
/// Margin around the ships, of their extent.
const MARGIN: f64 = 0.15;
/// Least height of the view, deg of latitude: coast lines at 1:110 million have nothing smaller.
const LEAST_HEIGHT_DEG: f64 = 8.0;
/// Latitudes beyond which the map does not go, deg.
const LAST_LATITUDE_DEG: f64 = 84.0;
/// Distances between lines of the grid, deg.
const GRID_STEPS: [f64; 6] = [1.0, 2.0, 5.0, 10.0, 20.0, 30.0];

/// The map with the list of its ships.
pub(super) struct FleetMap {
    /// Drawing, SVG.
    pub drawing: String,
    pub ships: Vec<MapRow>,
    /// Number of ships of the fleet with a position.
    pub placed: i64,
}

/// A ship in the list below the map.
pub(super) struct MapRow {
    pub name: String,
    pub title: String,
    pub class: UrgencyClass,
    /// Latitude and longitude in words.
    pub position: String,
}

#[derive(Template)]
#[template(path = "fleet_map.html")]
struct MapDrawing<'a> {
    size: (f64, f64),
    land: String,
    grid: Vec<GridLine>,
    marks: Vec<MapMark<'a>>,
}

/// Line of equal latitude or longitude, with its label.
struct GridLine {
    from: (f64, f64),
    to: (f64, f64),
    at: (f64, f64),
    label: String,
}

/// A ship on the map.
struct MapMark<'a> {
    ship: &'a str,
    says: String,
    class: &'static str,
    /// Shape of its condition, path data.
    d: String,
}

impl FleetMap {
    /// Reads the positions of the fleet, and draws them; `None` if no ship has one.
    ///
    /// # Errors
    /// Returns an error if the store fails or the map cannot be rendered.
    pub async fn read(archive: &Archive) -> Result<Option<Self>> {
        let ships = fleet_positions(archive, MOST_SHIPS).await?;
        if ships.is_empty() {
            return Ok(None);
        }
        let placed = count_positions(archive).await?;
        let drawing = draw_ships(&ships)?;
        let ships = ships.into_iter().map(MapRow::from_position).collect();
        Ok(Some(Self { drawing, ships, placed }))
    }
}

impl<'a> MapMark<'a> {
    fn new(ship: &'a ShipPosition, view: &GeographicView) -> Self {
        let at = view_place(view, ship.position.longitude_deg, ship.position.latitude_deg);
        Self {
            ship: &ship.ship,
            says: say("map-mark")
                .with("ship", &ship.title)
                .with("condition", class_label(ship.class))
                .into(),
            class: ship.class.name(),
            d: mark_shape(ship.class, at),
        }
    }
}

impl MapRow {
    fn from_position(ship: ShipPosition) -> Self {
        let (north, east) = (ship.position.latitude_deg, ship.position.longitude_deg);
        let position = format!("{}, {}", latitude_text(north, 1), longitude_text(east, 1));
        Self { name: ship.ship, title: ship.title, class: ship.class, position }
    }
}

fn latitude_text(degrees: f64, digits: usize) -> String {
    let direction = if degrees < 0.0 { "S" } else { "N" };
    let (size, direction) = (degrees.abs(), say_word("map-direction", direction));
    format!("{}° {direction}", format_fixed(size, digits))
}

fn longitude_text(degrees: f64, digits: usize) -> String {
    let direction = if degrees < 0.0 { "W" } else { "E" };
    let (size, direction) = (degrees.abs(), say_word("map-direction", direction));
    format!("{}° {direction}", format_fixed(size, digits))
}

fn draw_ships(ships: &[ShipPosition]) -> Result<String> {
    let view = fleet_view(ships);
    let place = |(east, north): (f64, f64)| view_place(&view, east, north);
    // The most urgent ships are drawn last, above the others.
    let marks = ships.iter().rev().map(|ship| MapMark::new(ship, &view)).collect();
    let outline = |ring: Vec<(f64, f64)>| {
        let points: Vec<(f64, f64)> = ring.into_iter().map(place).collect();
        path_data(&points, |_, _| false) + "Z"
    };
    // A little further, so that the edges of the drawing are no coast lines.
    let land = visible_land(&view.widened(0.02)).into_iter().map(outline).collect();
    Ok(MapDrawing { size: SIZE, land, grid: grid_lines(&view), marks }.render()?)
}

/// Returns the extent of the ships with a margin, in the proportions of the drawing.
fn fleet_view(ships: &[ShipPosition]) -> GeographicView {
    let range = |values: &mut dyn Iterator<Item = f64>| {
        values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
            (low.min(value), high.max(value))
        })
    };
    let (west, east) = range(&mut ships.iter().map(|ship| ship.position.longitude_deg));
    let (south, north) = range(&mut ships.iter().map(|ship| ship.position.latitude_deg));
    let middle = (0.5 * (west + east), 0.5 * (south + north));
    // Degrees of longitude are shorter by the cosine of the latitude (plate carrée, true there).
    let shrink = middle.1.to_radians().cos().max(0.1);
    let needed = (east - west) * shrink * SIZE.1 / SIZE.0;
    let height = (north - south).max(needed) * (1.0 + 2.0 * MARGIN);
    let height = height.clamp(LEAST_HEIGHT_DEG, 2.0 * LAST_LATITUDE_DEG);
    // A fleet all around the earth fills the width whatever the proportions.
    let widest = (height * SIZE.0 / SIZE.1 / shrink).max((east - west) * (1.0 + 2.0 * MARGIN));
    let width = widest.min(360.0);
    // A view that reaches beyond the edges of the map is moved inside.
    let shift =
        |at: f64, half: f64, edge: f64| at.clamp(half - edge, (edge - half).max(half - edge));
    let x = shift(middle.0, 0.5 * width, 180.0);
    let y = shift(middle.1, 0.5 * height, LAST_LATITUDE_DEG);
    GeographicView {
        west: x - 0.5 * width,
        east: x + 0.5 * width,
        south: y - 0.5 * height,
        north: y + 0.5 * height,
    }
}

/// Returns the place of a position in the drawing.
fn view_place(view: &GeographicView, east: f64, north: f64) -> (f64, f64) {
    let across = (east - view.west) / (view.east - view.west);
    let down = (view.north - north) / (view.north - view.south);
    (SIZE.0 * across, SIZE.1 * down)
}

/// Returns the shape of a condition: a cross, a triangle, a square or a circle.
fn mark_shape(class: UrgencyClass, (x, y): (f64, f64)) -> String {
    match class {
        UrgencyClass::DoesNotHold => format!("M{:.1} {:.1}l10 10m0 -10l-10 10", x - 5.0, y - 5.0),
        UrgencyClass::Unknown => format!("M{:.1} {:.1}l5.5 9.5h-11z", x, y - 6.0),
        UrgencyClass::NoModel => format!("M{:.1} {:.1}h9v9h-9z", x - 4.5, y - 4.5),
        UrgencyClass::Holds => {
            format!("M{:.1} {:.1}a5 5 0 1 0 10 0a5 5 0 1 0 -10 0z", x - 5.0, y)
        }
    }
}

/// Returns lines of equal latitude and longitude, about five along the longer side.
fn grid_lines(view: &GeographicView) -> Vec<GridLine> {
    let wanted = (view.east - view.west) / 5.0;
    let step = GRID_STEPS.into_iter().find(|step| *step >= wanted).unwrap_or(60.0);
    let between = |low: f64, high: f64| {
        let first = (low / step).ceil() as i32;
        (first..=(high / step).floor() as i32).map(move |k| step * f64::from(k))
    };
    let meridian = |east: f64| {
        let x = view_place(view, east, view.north).0;
        let label = longitude_text(east, 0);
        GridLine { from: (x, 0.0), to: (x, SIZE.1), at: (x + 3.0, SIZE.1 - 5.0), label }
    };
    let parallel = |north: f64| {
        let y = view_place(view, view.west, north).1;
        GridLine {
            from: (0.0, y),
            to: (SIZE.0, y),
            at: (3.0, y - 3.0),
            label: latitude_text(north, 0),
        }
    };
    let meridians = between(view.west, view.east).map(meridian);
    meridians.chain(between(view.south, view.north).map(parallel)).collect()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use sistership_trials::GeographicPosition;

    use super::*;

    fn ship(name: &str, latitude_deg: f64, longitude_deg: f64) -> ShipPosition {
        ShipPosition {
            ship: name.to_owned(),
            title: name.to_uppercase(),
            class: UrgencyClass::DoesNotHold,
            position: GeographicPosition { latitude_deg, longitude_deg },
        }
    }

    #[test]
    fn the_view_holds_all_ships_and_stays_on_the_map() {
        for ships in [
            vec![ship("a", 57.9, 9.8)],
            vec![ship("a", 57.9, 9.8), ship("b", 1.2, 103.9)],
            vec![ship("a", -60.0, -179.0), ship("b", 80.0, 179.0)],
        ] {
            let view = fleet_view(&ships);
            assert!(view.west >= -180.0 - 1e-9 && view.east <= 180.0 + 1e-9, "{view:?}");
            for ship in &ships {
                let GeographicPosition { latitude_deg, longitude_deg } = ship.position;
                let (x, y) = view_place(&view, longitude_deg, latitude_deg);
                assert!((0.0..=SIZE.0).contains(&x) && (0.0..=SIZE.1).contains(&y), "{x} {y}");
            }
        }
    }

    #[test]
    fn a_ship_is_a_link_at_its_place_among_land() {
        let drawing = draw_ships(&[ship("a", 57.9, 9.8)]).unwrap();
        assert!(drawing.contains("href=\"/ships/a\"") && drawing.contains("A: does not hold"));
        // In the middle of the view, 5 units from the corner of the cross.
        assert!(drawing.contains("M315.0 165.0l10 10"), "{drawing}");
        assert!(drawing.contains("class=\"land\" d=\"M"), "{drawing}");
        assert!(drawing.len() < 20_000, "{} bytes", drawing.len());
        assert_eq!(latitude_text(-33.86, 1), "33.9° S");
    }
}
