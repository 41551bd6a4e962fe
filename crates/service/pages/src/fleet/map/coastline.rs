//! Land of the earth as polygons, and what of it lies within a view.

use std::sync::LazyLock;

/// Smallest area of land that is drawn, deg²: less than a hundredth of a pixel.
const LEAST_AREA: f64 = 1e-6;

/// Rings of land, longitude and latitude in deg.
static LAND: LazyLock<Vec<Vec<(f64, f64)>>> =
    LazyLock::new(|| parse_rings(include_str!("coastline.txt")));

/// Rectangle of longitudes and latitudes, deg.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct GeographicView {
    pub west: f64,
    pub east: f64,
    pub south: f64,
    pub north: f64,
}

impl GeographicView {
    /// Returns the view with a margin, a share of its size, on each side.
    pub fn widened(self, share: f64) -> Self {
        let (x, y) = (share * (self.east - self.west), share * (self.north - self.south));
        Self {
            west: self.west - x,
            east: self.east + x,
            south: self.south - y,
            north: self.north + y,
        }
    }
}

/// Parses rings: the first point in tenths of a degree, then differences.
fn parse_rings(text: &str) -> Vec<Vec<(f64, f64)>> {
    let lines = text.lines().filter(|line| !line.starts_with('#'));
    lines.map(parse_ring).collect()
}

fn parse_ring(line: &str) -> Vec<(f64, f64)> {
    let pairs = line.split(' ').filter_map(|pair| pair.split_once(','));
    let steps = pairs.filter_map(|(east, north)| Some((east.parse().ok()?, north.parse().ok()?)));
    let sum = |at: &mut (i32, i32), (east, north): (i32, i32)| {
        *at = (at.0 + east, at.1 + north);
        Some((0.1 * f64::from(at.0), 0.1 * f64::from(at.1)))
    };
    steps.scan((0, 0), sum).collect()
}

/// Returns the polygons of land within a view.
pub(super) fn visible_land(view: &GeographicView) -> Vec<Vec<(f64, f64)>> {
    let clipped = LAND.iter().map(|ring| clip_ring(ring, view));
    // Of land around a sea the clipping leaves lines along the sides.
    clipped.filter(|ring| ring_area(ring).abs() > LEAST_AREA).collect()
}

/// Area of a polygon, deg²; positive anticlockwise.
fn ring_area(ring: &[(f64, f64)]) -> f64 {
    let next = ring.iter().cycle().skip(1);
    let twice: f64 = ring.iter().zip(next).map(|(a, b)| a.0 * b.1 - b.0 * a.1).sum();
    0.5 * twice
}

/// Clips a polygon at the four sides of a view (Sutherland and Hodgman 1974).
fn clip_ring(ring: &[(f64, f64)], view: &GeographicView) -> Vec<(f64, f64)> {
    let west = clip_side(ring, |point| point.0 - view.west);
    let east = clip_side(&west, |point| view.east - point.0);
    let south = clip_side(&east, |point| point.1 - view.south);
    clip_side(&south, |point| view.north - point.1)
}

/// Keeps the part of a polygon where a linear function of the point is not negative.
fn clip_side(ring: &[(f64, f64)], inside: impl Fn((f64, f64)) -> f64) -> Vec<(f64, f64)> {
    let Some(&last) = ring.last() else { return Vec::new() };
    let (mut before, mut kept) = (last, Vec::with_capacity(ring.len()));
    for &point in ring {
        let (from, to) = (inside(before), inside(point));
        // The edge crosses the side between points of different signs.
        if (from < 0.0) != (to < 0.0) {
            let share = from / (from - to);
            let along = |a: f64, b: f64| a + share * (b - a);
            kept.push((along(before.0, point.0), along(before.1, point.1)));
        }
        if to >= 0.0 {
            kept.push(point);
        }
        before = point;
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    fn view(west: f64, east: f64, south: f64, north: f64) -> GeographicView {
        GeographicView { west, east, south, north }
    }

    /// Area of polygons, deg²; holes count negative.
    fn area(rings: &[Vec<(f64, f64)>]) -> f64 {
        rings.iter().map(|ring| ring_area(ring)).sum::<f64>().abs()
    }

    #[test]
    fn land_and_sea_are_where_they_are() {
        assert!(LAND.len() > 100 && LAND.iter().all(|ring| ring.len() > 2));
        // Inland Germany, and the middle of the North Sea.
        assert!((area(&visible_land(&view(9.0, 11.0, 50.0, 52.0))) - 4.0).abs() < 1e-9);
        assert!(visible_land(&view(2.0, 4.0, 55.5, 56.5)).is_empty());
        // Land has 149 of the 510 million km²; by degrees that is less because the poles count more.
        let share = area(&visible_land(&view(-180.0, 180.0, -60.0, 85.0))) / (360.0 * 145.0);
        assert!((0.25..0.45).contains(&share), "{share}");
    }

    #[test]
    fn a_polygon_is_cut_at_the_sides() {
        let square = [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)];
        let cut = clip_ring(&square, &view(-1.0, 1.0, 1.0, 9.0));
        assert_eq!(area(&[cut]), 3.0);
        assert!(clip_ring(&square, &view(5.0, 6.0, 0.0, 4.0)).is_empty());
    }
}
