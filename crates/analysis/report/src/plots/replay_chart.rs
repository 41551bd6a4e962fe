//! Chart of a trial with both simulations: track over the ground, and channels over time.

use sistership_simulation::recorded::TrialReplay;

use super::series::{panel_channels, series_plot};
use super::trajectory::trajectory_plot;
use super::{ChartLine, LiveChart, lines};
use crate::replayed::ReplayedTrial;

/// Returns track and channels of a trial; `names` are those of the measurement and both models.
pub(crate) fn replay_chart(replayed: &ReplayedTrial<'_>, names: [&str; 3]) -> LiveChart {
    let plots = vec![trajectory_plot(replayed), series_plot(replayed)];
    LiveChart::new(plots, &chart_lines(replayed, names), replayed.hull)
}

/// Returns the lines of a chart with the displayed channels and the positions; `names` are those of
/// the measurement and of both models.
fn chart_lines(replayed: &ReplayedTrial<'_>, names: [&str; 3]) -> Vec<ChartLine> {
    let mut lines: Vec<ChartLine> = ["measured", "source", "refined"]
        .into_iter()
        .zip(names)
        .map(|(class, name)| empty_line(replayed, class, name))
        .collect();
    let mut add = |class: &str, quantity: &str, values: Vec<f64>| {
        if let Some(line) = lines.iter_mut().find(|line| line.class == class) {
            line.quantities.push((quantity.to_owned(), values));
        }
    };
    for line in lines::position_lines(replayed) {
        let (north, east) = line.values.into_iter().unzip();
        add(line.class, "x", north);
        add(line.class, "y", east);
    }
    for (channel, quantity) in panel_channels(replayed.rolls) {
        for line in lines::channel_lines(replayed, channel, quantity.factor) {
            add(line.class, channel.name(), line.values);
        }
    }
    lines
}

fn empty_line(replayed: &ReplayedTrial<'_>, class: &'static str, name: &str) -> ChartLine {
    let times = &replayed.trial.t_s;
    let at = |run: &TrialReplay| run.samples.iter().map(|sample| times[*sample]).collect();
    let t_s = match class {
        "source" => at(&replayed.source),
        "refined" => at(&replayed.refined),
        _ => times.clone(),
    };
    ChartLine { class, name: name.to_owned(), t_s, quantities: Vec::new() }
}
