//! Segments of a file that manifests define by their times.

use std::path::{Component, Path};

use sistership_model::manifest::{FileTime, ManifestTrial};

use crate::stamp::{DateOrder, StampDate, parse_stamp};
use crate::table::TimeOrigin;

/// Seconds of a day.
const DAY_S: f64 = 86_400.0;

/// Segment of a file by its first and last time.
#[derive(Debug, Clone, PartialEq)]
pub struct FileSegment {
    /// First time; by default that of the first row of the file.
    pub from: Option<FileTime>,
    /// Last time; by default that of the last row.
    pub to: Option<FileTime>,
}

/// First and last time in seconds of the file.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct TimeWindow {
    pub from_s: f64,
    pub to_s: f64,
}

/// Fault of a segment.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub(crate) enum SegmentFault {
    #[error("`{field}` must be a finite number of seconds")]
    NotFinite { field: &'static str },
    #[error("`from` ({from}) must be before `to` ({to})")]
    Empty { from: FileTime, to: FileTime },
    #[error(
        "`{field}`: `{text}` is not a time; write it as 2024-05-01T09:30:00Z, 09:30:00, or in \
         seconds"
    )]
    NoTime { field: &'static str, text: String },
    #[error("`{field}`: `{text}` is a clock time, but the file's times are seconds; give seconds")]
    NoClock { field: &'static str, text: String },
    #[error("`{field}`: `{text}` has a date, but the file has times of day only; omit the date")]
    NoDate { field: &'static str, text: String },
    #[error("`from`: {from_s} s lies after the last row of the file, at {last_s} s")]
    After { from_s: f64, last_s: f64 },
    #[error("`to`: {to_s} s lies before the first row of the file, at {first_s} s")]
    Before { to_s: f64, first_s: f64 },
    #[error(
        "`from`: {from_s} s lies before the first row of the file, at {first_s} s; omit it to \
         read from there"
    )]
    Early { from_s: f64, first_s: f64 },
    #[error(
        "`to`: {to_s} s lies after the last row of the file, at {last_s} s; omit it to read up to \
         there"
    )]
    Late { to_s: f64, last_s: f64 },
    #[error("overlaps with `{other}`; the same data would count twice")]
    Overlap { other: String },
    #[error("no row of the file lies between {from_s} s and {to_s} s")]
    NoRow { from_s: f64, to_s: f64 },
    #[error(
        "the form of the file's times is ambiguous; declare the unit of `t` (`s`, `excel`, \
         `day/month/year`, `month/day/year`), so that a segment can be found"
    )]
    Open,
}

impl SegmentFault {
    /// Returns the field with the fault; the first if both have it.
    fn fault_field(&self) -> &'static str {
        match self {
            Self::NotFinite { field } | Self::NoTime { field, .. } => field,
            _ => "from",
        }
    }
}

impl FileSegment {
    /// Returns the segment of an entry; `None` if the entry is a whole file.
    pub(crate) fn from_trial(trial: &ManifestTrial) -> Option<Self> {
        let (from, to) = (trial.from.clone(), trial.to.clone());
        trial.is_segment().then_some(Self { from, to })
    }

    /// Returns the segment in seconds of a file with the given start.
    pub(crate) fn time_window(
        &self,
        start: Option<&TimeOrigin>,
    ) -> Result<TimeWindow, SegmentFault> {
        let told = |time: &Option<FileTime>, field, after_s: f64| match time {
            Some(time) => file_seconds(time, field, start, after_s).map(Some),
            None => Ok(None),
        };
        let from_s = told(&self.from, "from", 0.0)?;
        // A time of day of the end is the first one after the start.
        let to_s = told(&self.to, "to", from_s.unwrap_or(0.0))?;
        if let (Some(from), Some(to)) = (&self.from, &self.to)
            && from_s >= to_s
        {
            return Err(SegmentFault::Empty { from: from.clone(), to: to.clone() });
        }
        let (from_s, to_s) = (from_s.unwrap_or(f64::NEG_INFINITY), to_s.unwrap_or(f64::INFINITY));
        Ok(TimeWindow { from_s, to_s })
    }
}

/// Returns a time in seconds of the file; a time of day is the first after `after_s`.
fn file_seconds(
    time: &FileTime,
    field: &'static str,
    start: Option<&TimeOrigin>,
    after_s: f64,
) -> Result<f64, SegmentFault> {
    let text = match time {
        FileTime::Seconds(seconds) if seconds.is_finite() => return Ok(*seconds),
        FileTime::Seconds(_) => return Err(SegmentFault::NotFinite { field }),
        FileTime::Clock(text) => text.clone(),
    };
    let Some(stamp) = parse_stamp(&text, DateOrder::Open) else {
        return Err(SegmentFault::NoTime { field, text });
    };
    let Some(start) = start else { return Err(SegmentFault::NoClock { field, text }) };
    match stamp.date {
        StampDate::Known(_) if !start.dated => Err(SegmentFault::NoDate { field, text }),
        StampDate::Known(day) => Ok(stamp.seconds_after(day) - start.at_s),
        // Day and month cannot be distinguished in a single date.
        StampDate::Either(_) => Err(SegmentFault::NoTime { field, text }),
        StampDate::Absent => {
            let since = stamp.seconds_after(0) - (start.at_s + after_s);
            Ok(after_s + since.rem_euclid(DAY_S))
        }
    }
}

impl TimeWindow {
    /// Compares the window with the first and the last time of the file; returns the fault, if
    /// there is one.
    pub(crate) fn window_fault(&self, first_s: f64, last_s: f64) -> Option<SegmentFault> {
        let Self { from_s, to_s } = *self;
        if from_s > last_s {
            Some(SegmentFault::After { from_s, last_s })
        } else if to_s < first_s {
            Some(SegmentFault::Before { to_s, first_s })
        } else if from_s.is_finite() && from_s < first_s {
            Some(SegmentFault::Early { from_s, first_s })
        } else if to_s.is_finite() && to_s > last_s {
            Some(SegmentFault::Late { to_s, last_s })
        } else {
            None
        }
    }
}

/// Returns the fault of an entry that can be found without its file: the field, and the message.
pub(crate) fn segment_problem(
    trial: &ManifestTrial,
    earlier: &[ManifestTrial],
) -> Option<(String, String)> {
    let stretch = FileSegment::from_trial(trial)?;
    // Any start serves to compare two times with each other.
    let clock = |dated| TimeOrigin { text: String::new(), at_s: 0.0, dated };
    let window = match stretch.time_window(Some(&clock(true))) {
        Ok(window) => window,
        // A clock time and seconds can only be compared with the start of the file.
        Err(SegmentFault::Empty { .. }) if !stretch.is_of_one_kind() => return None,
        Err(fault) => return Some((fault.fault_field().to_owned(), fault.to_string())),
    };
    let overlaps = |other: &&ManifestTrial| {
        let others = FileSegment::from_trial(other).filter(|_| same_file(&other.file, &trial.file));
        let others = others.filter(|others| others.is_comparable(&stretch));
        let others = others.and_then(|others| others.time_window(Some(&clock(true))).ok());
        others.is_some_and(|others| others.from_s < window.to_s && window.from_s < others.to_s)
    };
    let other = earlier.iter().find(overlaps)?.trial_label();
    Some(("from".into(), SegmentFault::Overlap { other }.to_string()))
}

impl FileSegment {
    fn is_of_one_kind(&self) -> bool {
        let is_clock = |time: &FileTime| matches!(time, FileTime::Clock(_));
        self.from.as_ref().map(is_clock) == self.to.as_ref().map(is_clock)
    }

    /// Returns true if both segments are given in seconds.
    fn is_comparable(&self, other: &Self) -> bool {
        let mut times = [&self.from, &self.to, &other.from, &other.to].into_iter().flatten();
        times.all(|time| matches!(time, FileTime::Seconds(_)))
    }
}

/// Returns true if two paths name the same file: `a.csv` is `./a.csv`.
pub(crate) fn same_file(one: &str, other: &str) -> bool {
    let plain = |path| {
        Path::new(path).components().filter(|part| *part != Component::CurDir).collect::<Vec<_>>()
    };
    plain(one) == plain(other)
}

#[cfg(test)]
#[path = "stretches_tests.rs"]
mod tests;
