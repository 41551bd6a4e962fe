//! Drift of the fleet over the last weeks, as a small chart.

use sistership_jobs::Archive;
use sistership_jobs::condition::{DRIFT_LIMIT, RecentDrift};
use sistership_report::plots::{Shape, SvgPlot};

use crate::date::format_day;
use crate::error::Result;
use crate::language::say;
use crate::numbers::format_significant;
use crate::picture::{line_shape, text_shape};

/// Number of diagnoses that are read.
const READ_DIAGNOSES: i64 = 2000;
/// Number of weeks in the chart.
const WEEKS: usize = 12;
/// One week, µs.
const WEEK_US: i64 = 7 * 86_400_000_000;
const SIZE: (f64, f64) = (420.0, 132.0);
/// Distances of the bars from the edges: left, top, right, bottom.
const MARGIN: (f64, f64, f64, f64) = (34.0, 16.0, 6.0, 22.0);

/// Drift of the diagnoses of a week.
#[derive(Debug, Clone, Copy, PartialEq)]
struct WeekDrift {
    /// Median of the ratios.
    median: f64,
    count: usize,
}

/// Returns the chart: for each week the median ratio of unexplained force on new trials to that on
/// the fitted ones. `None` if fewer than two weeks have a diagnosis.
///
/// # Errors
/// Returns an error if the store fails.
pub(super) async fn drift_trend(archive: &Archive) -> Result<Option<SvgPlot>> {
    let rows = archive.store.diagnoses().list_newest(READ_DIAGNOSES).await?;
    let now_us = archive.store.now_us();
    let ratio = |drift: &str| serde_json::from_str::<RecentDrift>(drift).ok();
    let found =
        rows.iter().filter_map(|row| Some((row.created_us, ratio(row.drift.as_deref()?)?.ratio)));
    // A median, since a single ship out of order must not hide the others.
    let weeks = weekly_medians(found, now_us);
    let known = weeks.iter().flatten().count();
    // One bar shows no trend.
    Ok((known >= 2).then(|| draw_weeks(&weeks, now_us)))
}

/// Medians of the last weeks, the oldest first.
fn weekly_medians(
    ratios: impl Iterator<Item = (i64, f64)>,
    now_us: i64,
) -> [Option<WeekDrift>; WEEKS] {
    let mut weeks: [Vec<f64>; WEEKS] = Default::default();
    for (at_us, ratio) in ratios {
        // Clocks of several servers differ: what lies in the future counts as of now.
        let age = usize::try_from((now_us - at_us).max(0) / WEEK_US).unwrap_or(WEEKS);
        if age < WEEKS {
            weeks[WEEKS - 1 - age].push(ratio);
        }
    }
    weeks.map(|mut own| {
        own.sort_by(f64::total_cmp);
        let median = own.get(own.len() / 2).copied()?;
        Some(WeekDrift { median, count: own.len() })
    })
}

fn draw_weeks(weeks: &[Option<WeekDrift>; WEEKS], now_us: i64) -> SvgPlot {
    // The limit stays in the chart even where all ships are far below it.
    let most = weeks.iter().flatten().map(|week| week.median).fold(1.5 * DRIFT_LIMIT, f64::max);
    let (left, top, right, bottom) = MARGIN;
    let (width, height) = (SIZE.0 - left - right, SIZE.1 - top - bottom);
    let y = |ratio: f64| top + height * (1.0 - ratio / most);
    let step = width / WEEKS as f64;
    let mut shapes = vec![
        line_shape((left, y(0.0)), (left + width, y(0.0)), "zero"),
        line_shape((left, y(DRIFT_LIMIT)), (left + width, y(DRIFT_LIMIT)), "limit"),
        text_shape((left - 5.0, y(0.0) + 3.5), "0", "tick end"),
        text_shape(
            (left - 5.0, y(DRIFT_LIMIT) + 3.5),
            format_significant(DRIFT_LIMIT, 2),
            "tick end",
        ),
    ];
    for (index, week) in weeks.iter().enumerate() {
        let Some(week) = week else { continue };
        let class = if week.median > DRIFT_LIMIT { "bar over" } else { "bar" };
        let (x, above) = (left + step * index as f64, y(week.median));
        let size = (0.7 * step, (y(0.0) - above).max(1.0));
        shapes.push(Shape::Rect { at: (x + 0.15 * step, above), size, class });
        shapes.push(text_shape((x + 0.5 * step, above - 3.0), week.count.to_string(), "tick mid"));
    }
    shapes.push(text_shape(
        (left, SIZE.1 - 6.0),
        format_day(now_us - WEEKS as i64 * WEEK_US),
        "tick",
    ));
    shapes.push(text_shape((left + width, SIZE.1 - 6.0), say("board-today"), "tick end"));
    let last = weeks.iter().flatten().last().map_or(0.0, |week| week.median);
    let label = say("board-drift-label").with("last", format_significant(last, 2));
    let label = label.with("limit", format_significant(DRIFT_LIMIT, 2)).into();
    SvgPlot { width: SIZE.0, height: SIZE.1, label, shapes }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn diagnoses_count_in_their_week() {
        let now_us = 100 * WEEK_US;
        let ratios = [(now_us, 1.0), (now_us - 1, 3.0), (now_us - 2, 2.5), (0, 9.0)];
        let ratios = ratios.into_iter().chain([(now_us - 3 * WEEK_US, 0.5)]);
        let weeks = weekly_medians(ratios, now_us);
        assert_eq!(weeks[WEEKS - 1], Some(WeekDrift { median: 2.5, count: 3 }));
        assert_eq!(weeks[WEEKS - 4], Some(WeekDrift { median: 0.5, count: 1 }));
        assert_eq!(weeks.iter().flatten().count(), 2, "older ones are left out");
    }
}
