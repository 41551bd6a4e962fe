//! Arguments and tables of stopping, pull-outs and spirals.

use clap::Args;
use sistership_simulation::manoeuvre::{
    AsternOrder, FurtherManoeuvres, FurtherSelection, SpiralSelection,
};
use sistership_simulation::metrics::{PullOutMetrics, SpiralMetrics, SpiralPoint, StoppingMetrics};

use crate::table::{TextTable, format_number, format_optional};
use crate::values::{not_negative, positive, rudder_deg};

/// Manoeuvres in addition to turns and zigzags.
#[derive(Debug, Args)]
pub struct FurtherArguments {
    /// A full astern stop, if the law covers a reversed propeller.
    #[arg(long, conflicts_with = "all")]
    stop: bool,
    /// Revolutions astern per second in a stop; by default as many as ahead.
    #[arg(long, value_name = "N", value_parser = positive, allow_negative_numbers = true)]
    astern_rps: Option<f64>,
    /// Duration of the reversal in a stop.
    #[arg(long, value_name = "SECONDS", value_parser = not_negative, default_value = "0", allow_negative_numbers = true)]
    reversal_s: f64,
    /// A pull-out: a steady turn with this rudder, then amidships; repeatable.
    #[arg(long, value_name = "DEG", value_parser = rudder_deg, allow_negative_numbers = true, conflicts_with = "all")]
    pull_out: Vec<f64>,
    /// A direct and a reverse spiral.
    #[arg(long, conflicts_with = "all")]
    spiral: bool,
}

impl FurtherArguments {
    /// Number of tracks that the manoeuvres give.
    pub fn track_count(&self) -> usize {
        usize::from(self.stop) + self.pull_out.len()
    }

    /// True if one of them is requested.
    pub fn is_requested(&self) -> bool {
        self.track_count() > 0 || self.spiral
    }

    /// Largest rudder angle that is ordered, deg.
    pub fn largest_deg(&self) -> f64 {
        self.pull_out.iter().fold(0.0, |most, angle| most.max(angle.abs()))
    }

    /// Returns the manoeuvres to simulate; with `usual` those of the standard set.
    pub fn requested_manoeuvres(&self, usual: bool) -> FurtherSelection {
        // The settings of a stop also apply to the stop of the standard set.
        let order = AsternOrder { astern_rps: self.astern_rps, reversal_s: self.reversal_s };
        if usual {
            return FurtherSelection { stop: Some(order), ..FurtherSelection::default_selection() };
        }
        FurtherSelection {
            stop: self.stop.then_some(order),
            pull_outs_deg: self.pull_out.clone(),
            spiral: if self.spiral { SpiralSelection::Always } else { SpiralSelection::Never },
        }
    }
}

/// Formats the results as tables with titles.
pub fn further_tables(further: &FurtherManoeuvres, lpp_m: f64) -> Vec<(String, TextTable)> {
    let mut tables = Vec::new();
    if let Some(stop) = &further.stopping {
        tables.push(("Full astern stop".to_owned(), stopping_table(stop, lpp_m)));
    }
    // The residual rates after pull-outs to both sides tell whether the ship is straight-line
    // stable.
    if !further.pull_outs.is_empty() {
        let verdict = match further.straight_line_stable {
            Some(true) => ": stable on a straight course",
            Some(false) => ": NOT stable on a straight course",
            None => "",
        };
        tables.push((format!("Pull-outs{verdict}"), pull_out_table(&further.pull_outs)));
    }
    if let Some(spiral) = &further.spiral {
        tables.push((spiral_title(spiral), spiral_table(spiral)));
    }
    tables
}

fn stopping_table(stop: &StoppingMetrics, lpp_m: f64) -> TextTable {
    let mut table = TextTable::new([
        "astern 1/s",
        "track reach m",
        "L",
        "head reach m",
        "L",
        "to starboard m",
        "heading deg",
        "time s",
    ]);
    let lengths = |metres: Option<f64>| format_optional(metres.map(|metres| metres / lpp_m));
    table.add_row([
        format_number(stop.astern_rps),
        format_optional(stop.track_reach_m),
        lengths(stop.track_reach_m),
        format_optional(stop.head_reach_m),
        lengths(stop.head_reach_m),
        format_optional(stop.lateral_deviation_m),
        format_optional(stop.heading_change_deg),
        format_optional(stop.time_s),
    ]);
    table
}

fn pull_out_table(all: &[PullOutMetrics]) -> TextTable {
    let mut table = TextTable::new([
        "rudder deg",
        "steady rate deg/s",
        "residual rate deg/s",
        "residual rate L/U",
    ]);
    for one in all {
        table.add_row([
            format_number(one.rudder_deg),
            format_number(one.turning_rate_deg_s),
            format_optional(one.residual_rate_deg_s),
            format_optional(one.residual_rate_by_length),
        ]);
    }
    table
}

fn spiral_title(spiral: &SpiralMetrics) -> String {
    format!(
        "Spirals: width of the loop {:.1} deg in the reverse spiral, {:.1} deg in the direct \
         spiral; height {:.2} deg/s; recommended width at most {:.1} deg",
        spiral.loop_width_deg,
        spiral.direct_loop_width_deg,
        spiral.loop_height_deg_s,
        spiral.width_limit_deg
    )
}

fn spiral_table(spiral: &SpiralMetrics) -> TextTable {
    let mut table = TextTable::new([
        "direct: rudder deg",
        "rate deg/s",
        "reverse: rudder deg",
        "rate deg/s",
        "not steady",
    ]);
    let cells = |point: Option<&SpiralPoint>| {
        [point.map(|point| point.rudder_deg), point.map(|point| point.rate_deg_s)]
            .map(format_optional)
    };
    // The two spirals have different numbers of points: the shorter column ends in empty cells.
    for k in 0..spiral.direct.len().max(spiral.reverse.len()) {
        let (direct, reverse) = (spiral.direct.get(k), spiral.reverse.get(k));
        let moving = [(direct, "direct"), (reverse, "reverse")]
            .into_iter()
            .filter(|(point, _)| point.is_some_and(|point| !point.steady));
        let moving: Vec<&str> = moving.map(|(_, name)| name).collect();
        table.add_row(cells(direct).into_iter().chain(cells(reverse)).chain([moving.join(", ")]));
    }
    table
}
