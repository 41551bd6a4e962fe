//! A drawing of a ship to scale, from its particulars: waterplane from above, and side view.
//!
//! Parts that the particulars do not describe have a plain shape: the form of the hull between bow
//! and stern is not the ship's own.

use sistership_model::particulars::Particulars;
use sistership_report::plots::{HullOutline, Shape, SvgPlot};

use crate::language::say;
use crate::numbers::format_stated;
use crate::picture::{line_shape, polygon_shape, text_shape};

const WIDTH: f64 = 640.0;
const MARGIN: f64 = 26.0;
/// Distance between the two views.
const GAP: f64 = 46.0;

/// Mapping of the ship's metres to the drawing.
struct DrawingFrame {
    per_metre: f64,
    lpp_m: f64,
}

impl DrawingFrame {
    /// Returns the x coordinate of a point forward of midship; the aft perpendicular is at the
    /// left.
    fn x_at(&self, forward_m: f64) -> f64 {
        MARGIN + (0.5 * self.lpp_m + forward_m) * self.per_metre
    }
}

/// Returns the drawing; `None` if length or beam are unknown.
pub(super) fn draw_ship(particulars: &Particulars, title: &str) -> Option<SvgPlot> {
    let hull = HullOutline::from_particulars(particulars)?;
    let known = |name: &str| particulars.get(name).map(|quantity| quantity.value);
    let frame = DrawingFrame { per_metre: (WIDTH - 2.0 * MARGIN) / hull.lpp_m, lpp_m: hull.lpp_m };
    let middle = 22.0 + 0.5 * hull.beam_m * frame.per_metre;
    let mut shapes = top_view(&frame, hull, middle, known("x_g_m"));
    let mut bottom = middle + 0.5 * hull.beam_m * frame.per_metre + 20.0;
    if let Some(draught) = known("draught_m") {
        // Without a moulded depth the side view shows a freeboard of half the draught.
        let depth = known("depth_moulded_m").unwrap_or(1.5 * draught).max(draught);
        let water = bottom + GAP + (depth - draught) * frame.per_metre;
        shapes.extend(side_view(&frame, &known, draught, depth, water));
        bottom = water + draught * frame.per_metre + 22.0;
    }
    shapes.extend(scale_bar(&frame, bottom + 6.0));
    let label = say("drawing-label").with("title", title);
    let label = label.with("length", format_stated(hull.lpp_m, 4));
    let label = label.with("beam", format_stated(hull.beam_m, 4)).into();
    Some(SvgPlot { width: WIDTH, height: bottom + 30.0, label, shapes })
}

fn top_view(
    frame: &DrawingFrame,
    hull: HullOutline,
    middle: f64,
    x_g_m: Option<f64>,
) -> Vec<Shape> {
    let corners: Vec<(f64, f64)> = hull
        .corners_at((0.0, 0.0), 0.0)
        .into_iter()
        .map(|(forward, right)| (frame.x_at(forward), middle + right * frame.per_metre))
        .collect();
    let (aft, fore) = (frame.x_at(-0.5 * frame.lpp_m), frame.x_at(0.5 * frame.lpp_m));
    let half = 0.5 * hull.beam_m * frame.per_metre;
    let mut shapes = vec![
        polygon_shape(&corners, "body"),
        line_shape((aft - 10.0, middle), (fore + 10.0, middle), "axis"),
        line_shape(
            (frame.x_at(0.0), middle - half - 4.0),
            (frame.x_at(0.0), middle + half + 4.0),
            "axis",
        ),
        text_shape(
            (aft, middle - half - 8.0),
            format!("Lpp {} m", format_stated(frame.lpp_m, 4)),
            "small",
        ),
        text_shape(
            (frame.x_at(0.0) + 5.0, middle - half - 8.0),
            say("drawing-midship").with("beam", format_stated(hull.beam_m, 4)),
            "small",
        ),
    ];
    if let Some(x_g) = x_g_m {
        shapes.push(Shape::Dot { at: (frame.x_at(x_g), middle), radius: 3.2, class: "part" });
        let words = say("drawing-gravity").with("distance", format_stated(x_g, 3));
        shapes.push(text_shape((frame.x_at(x_g), middle + half + 14.0), words, "small mid"));
    }
    shapes
}

fn side_view(
    frame: &DrawingFrame,
    known: &dyn Fn(&str) -> Option<f64>,
    draught: f64,
    depth: f64,
    water: f64,
) -> Vec<Shape> {
    let scale = frame.per_metre;
    let (aft, fore) = (frame.x_at(-0.5 * frame.lpp_m), frame.x_at(0.5 * frame.lpp_m));
    let (keel, deck) = (water + draught * scale, water - (depth - draught) * scale);
    let overhang = 0.03 * frame.lpp_m * scale;
    let rise = 0.45 * draught * scale;
    let body = [
        (aft - overhang * 0.5, deck),
        (fore + overhang * 0.7, deck),
        (fore, water),
        (fore - overhang * 0.4, keel),
        (frame.x_at(-0.42 * frame.lpp_m), keel),
        (frame.x_at(-0.47 * frame.lpp_m), keel - rise),
        (aft, water),
    ];
    let mut shapes = vec![
        polygon_shape(&body, "body"),
        line_shape((aft - 14.0, water), (fore + 14.0, water), "water"),
        line_shape((fore + 12.0, water), (fore + 12.0, keel), "measure"),
    ];
    let draught_words = say("drawing-draught").with("draught", format_stated(draught, 3));
    shapes.push(text_shape((fore + 12.0, keel + 13.0), draught_words, "small end"));
    shapes.extend(rudder_shape(frame, known, draught, keel));
    if let Some(diameter) = known("propeller_diameter_m") {
        let (x, half) = (frame.x_at(-0.475 * frame.lpp_m), 0.5 * diameter * scale);
        let at = (x - 1.5, keel - 2.0 * half - 0.02 * draught * scale);
        shapes.push(Shape::Rect { at, size: (3.0, 2.0 * half), class: "part" });
    }
    let words = stern_text(known);
    if !words.is_empty() {
        shapes.push(text_shape((aft, keel + 13.0), words, "small"));
    }
    shapes
}

/// Returns the rudder as a rectangle: its height as stated, otherwise from area and aspect ratio.
fn rudder_shape(
    frame: &DrawingFrame,
    known: &dyn Fn(&str) -> Option<f64>,
    draught: f64,
    keel: f64,
) -> Option<Shape> {
    let area = known("rudder_area_m2")?;
    let ratio = known("rudder_aspect_ratio").unwrap_or(1.5);
    // Not much higher than the draught, whatever the particulars say.
    let height = known("rudder_height_m").unwrap_or((area * ratio).sqrt()).min(1.2 * draught);
    let scale = frame.per_metre;
    let at = (frame.x_at(-0.5 * frame.lpp_m) - 0.5 * area / height * scale, keel - height * scale);
    Some(Shape::Rect { at, size: (area / height * scale, height * scale), class: "part" })
}

fn stern_text(known: &dyn Fn(&str) -> Option<f64>) -> String {
    let text = |name: &str| known(name).map(|value| format_stated(value, 3));
    let rudder = text("rudder_area_m2").map(|area| say("drawing-rudder").with("area", area));
    let diameter = text("propeller_diameter_m");
    let propeller = diameter.map(|of| say("drawing-propeller").with("diameter", of));
    rudder.into_iter().chain(propeller).map(String::from).collect::<Vec<_>>().join(", ")
}

/// Returns a bar of a round length.
fn scale_bar(frame: &DrawingFrame, y: f64) -> [Shape; 4] {
    let length = sistership_report::plots::axes::nice_step(0.12 * frame.lpp_m);
    let (from, to) = (MARGIN, MARGIN + length * frame.per_metre);
    [
        line_shape((from, y), (to, y), "measure"),
        line_shape((from, y - 3.0), (from, y + 3.0), "measure"),
        line_shape((to, y - 3.0), (to, y + 3.0), "measure"),
        text_shape((to + 6.0, y + 3.5), format!("{} m", format_stated(length, 2)), "small"),
    ]
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use sistership_model::Zoo;

    #[test]
    fn every_ship_of_the_zoo_with_length_and_beam_can_be_drawn() {
        let zoo = Zoo::load_embedded().unwrap();
        let hulls = zoo
            .vessels()
            .filter(|vessel| HullOutline::from_particulars(&vessel.particulars).is_some());
        let heights = hulls.map(|vessel| draw_ship(&vessel.particulars, "").unwrap().height);
        let heights: Vec<f64> = heights.collect();
        assert!(heights.len() > 20 && heights.iter().all(|height| (60.0..500.0).contains(height)));
    }

    #[test]
    fn without_a_beam_nothing_is_drawn() {
        assert!(draw_ship(&Particulars::new(), "").is_none());
    }
}
