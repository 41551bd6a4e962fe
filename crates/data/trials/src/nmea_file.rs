//! NMEA 0183 logs: sentences of several instruments become series, and these become one table.
//!
//! Only some sentences contain the time. The time of a line without it is interpolated, by line
//! numbers, between the lines before and after that have it. If the log has its own time before
//! each sentence, that is used instead.

use std::collections::{BTreeMap, BTreeSet};
use std::io::{BufRead, BufReader, Read};

use crate::calendar::{DAY, SECOND, format_iso};
use crate::findings::Findings;
use crate::mapping::Mapping;
use crate::nmea_sentence::{NmeaLine, NmeaSentence, parse_line};
use crate::series::{SensorSeries, join_series};
use crate::stamp::{DateOrder, StampDate, parse_stamp};
use crate::table::{ColumnTarget, RawQuantity, Table, TableColumn, TimeOrigin};
use crate::units::UnitKind;

/// Largest time between two marks, ns, for lines between them to have a time.
const LONGEST: i64 = 5 * SECOND;
/// Half a day, ns: a time that is earlier by more belongs to the next day.
const MIDNIGHT: i64 = DAY / 2;
/// Largest number of days of a log; a clock that goes back more often is out of order.
const DAYS: i64 = 1000;

/// Reads every sentence that is of use for a trial.
pub(crate) fn read_nmea(
    input: impl Read,
    mapping: &Mapping,
    findings: &mut Findings,
) -> Option<Table> {
    let mut log = NmeaLog::default();
    if let Err(message) = for_each_line(input, mapping, |row, text| log.add_line(row, text)) {
        findings.error(None, None, message);
        return None;
    }
    log.into_table(findings)
}

/// Returns the sentences at the start of a log with their contents, such as `GPGGA` with
/// `latitude`.
pub(crate) fn sentence_contents(start: &str) -> Vec<(String, ColumnTarget)> {
    let mut found = BTreeSet::new();
    for text in start.lines() {
        if let NmeaLine::Sentence(sentence) = parse_line(text) {
            let name = format!("{}{}", sentence.talker, sentence.kind);
            let readings = sentence.usable_readings().into_iter();
            found.extend(readings.map(|(target, _)| (target, name.clone())));
        }
    }
    found.into_iter().map(|(target, name)| (name, target)).collect()
}

/// Returns upper bounds of the number of rows and of columns.
pub(crate) fn measure_nmea(input: impl Read, mapping: &Mapping) -> Option<(usize, usize)> {
    let mut rows = 0;
    for_each_line(input, mapping, |row, _| {
        rows = row;
        Ok(())
    })
    .ok()?;
    // A line gives at most four readings, which are stored with their times before they are on one
    // time base.
    Some((rows, 24))
}

fn for_each_line(
    input: impl Read,
    mapping: &Mapping,
    mut each: impl FnMut(usize, &str) -> Result<(), String>,
) -> Result<(), String> {
    let (mut input, mut bytes) = (BufReader::new(input), Vec::new());
    for row in 1.. {
        bytes.clear();
        let most = mapping.limits.line_bytes as u64;
        let read = input.by_ref().take(most).read_until(b'\n', &mut bytes);
        let read = read.map_err(|error| format!("cannot be read: {error}"))?;
        if read == 0 {
            return Ok(());
        }
        // The limit was reached before a line end.
        if read as u64 == most {
            return Err(format!("line {row} is longer than {most} bytes"));
        }
        if row > mapping.limits.rows {
            return Err(format!("the log has more than {} lines; split it", mapping.limits.rows));
        }
        each(row, &String::from_utf8_lossy(&bytes))?;
    }
    Ok(())
}

/// Origin of a series: sentences of one kind from one talker, such as `HEHDT`.
type SeriesOrigin = (ColumnTarget, [u8; 5]);

/// Largest number of lines that wait for the next mark.
const PENDING: usize = 10_000;

#[derive(Default)]
struct SeriesReadings {
    t: Vec<f64>,
    values: Vec<f64>,
    rows: Vec<u32>,
}

/// Line whose time is known at the next mark.
struct PendingLine {
    row: usize,
    readings: Vec<(SeriesOrigin, f64)>,
}

#[derive(Default)]
struct NmeaLog {
    /// First mark, from which time is counted, and last mark: line and ns, continuous over
    /// midnights.
    first: Option<i64>,
    last: Option<(usize, i64)>,
    /// Midnight of the day of the first mark, ns since 1970.
    midnight: Option<i64>,
    days: i64,
    /// True if the log has its own time before each sentence.
    own: bool,
    pending: Vec<PendingLine>,
    series: BTreeMap<SeriesOrigin, SeriesReadings>,
    damaged: (usize, usize),
    timeless: usize,
}

impl NmeaLog {
    fn add_line(&mut self, row: usize, text: &str) -> Result<(), String> {
        match parse_line(text) {
            NmeaLine::Sentence(sentence) => self.add_sentence(row, sentence),
            NmeaLine::Damaged => {
                self.damaged =
                    (self.damaged.0 + 1, if self.damaged.0 == 0 { row } else { self.damaged.1 });
            }
            NmeaLine::Other => {}
        }
        Ok(())
    }

    fn add_sentence(&mut self, row: usize, sentence: NmeaSentence) {
        let own =
            parse_stamp(sentence.before.trim().trim_end_matches([',', ';', ':']), DateOrder::Open);
        // The first sentence decides whether the log has times of its own; later ones must agree
        // with it.
        let own = own.filter(|_| self.own || self.last.is_none());
        self.own = self.own || own.is_some();
        let of_day = match own {
            Some(stamp) => Some(stamp.of_day),
            None if self.own => None,
            None => sentence.time_of_day(),
        };
        if let Some(of_day) = of_day {
            let midnight = own.and_then(|stamp| match stamp.date {
                StampDate::Known(day) => Some(day * DAY),
                _ => None,
            });
            self.add_mark(row, of_day, midnight);
        }
        if let (None, false, Some(midnight)) = (self.midnight, self.own, sentence.date_midnight()) {
            self.midnight = Some(midnight - self.days * DAY);
        }
        let mut talker = [0; 5];
        talker[..2].copy_from_slice(sentence.talker.as_bytes());
        talker[2..].copy_from_slice(sentence.kind.as_bytes());
        let readings = sentence.usable_readings().into_iter();
        let readings: Vec<(SeriesOrigin, f64)> =
            readings.map(|(target, value)| ((target, talker), value)).collect();
        match self.last {
            _ if readings.is_empty() => {}
            // A line before the first mark has no time.
            None => self.timeless += 1,
            Some((_, now)) if of_day.is_some() => self.store_readings(row, now, readings),
            Some(_) if self.pending.len() == PENDING => self.timeless += 1,
            Some(_) => self.pending.push(PendingLine { row, readings }),
        }
    }

    /// Adds a line with a known time; the lines since the previous mark obtain theirs.
    fn add_mark(&mut self, row: usize, of_day: i64, midnight: Option<i64>) {
        let mut now = of_day + self.days * DAY;
        if let Some((_, last)) = self.last {
            if last - now > MIDNIGHT && self.days < DAYS {
                self.days += 1;
                now += DAY;
            }
            // Sentences of the same fix repeat its time.
            if now <= last {
                return;
            }
        } else {
            self.midnight = midnight;
        }
        self.first.get_or_insert(now);
        let pending = std::mem::take(&mut self.pending);
        if let Some((line, last)) = self.last {
            if now - last > LONGEST {
                self.timeless += pending.len();
            } else {
                for PendingLine { row: at, readings } in pending {
                    // Linear in line numbers: lines are assumed to arrive at a constant rate
                    // between two marks.
                    let share = (at - line) as f64 / (row - line) as f64;
                    self.store_readings(at, last + (share * (now - last) as f64) as i64, readings);
                }
            }
        }
        self.last = Some((row, now));
    }

    fn store_readings(&mut self, row: usize, at: i64, readings: Vec<(SeriesOrigin, f64)>) {
        let t = (at - self.first.unwrap_or(at)) as f64 / SECOND as f64;
        for (origin, value) in readings {
            let series = self.series.entry(origin).or_default();
            // A series must increase strictly in time for the interpolation that follows.
            if series.t.last().is_none_or(|&last| last < t) {
                series.t.push(t);
                series.values.push(value);
                series.rows.push(u32::try_from(row).unwrap_or(u32::MAX));
            }
        }
    }

    /// Selects one series for each target: that of the origin with most readings.
    fn select_series(
        &mut self,
        findings: &mut Findings,
    ) -> BTreeMap<ColumnTarget, (String, SeriesReadings)> {
        let mut chosen: BTreeMap<ColumnTarget, (String, SeriesReadings)> = BTreeMap::new();
        for ((target, origin), readings) in std::mem::take(&mut self.series) {
            let origin = String::from_utf8_lossy(&origin).into_owned();
            let most = chosen.get(&target).map_or(0, |(_, other)| other.t.len());
            if readings.t.len() > most
                && let Some((other, _)) = chosen.insert(target, (origin.clone(), readings))
            {
                let message = format!("{} is read from {origin}, not from {other}", target.name());
                findings.warning(None, Some(&origin), message);
            }
        }
        chosen
    }

    fn into_table(mut self, findings: &mut Findings) -> Option<Table> {
        self.timeless += self.pending.len();
        self.report_losses(findings);
        let mut chosen = self.select_series(findings);
        // A single rudder is reported as the starboard one, and the yaw rate is that of the ship,
        // whichever talker reports it.
        let base = base_target(&chosen)?;
        let times = chosen.get(&base)?;
        let mut table = Table { rows: times.1.rows.clone(), ..Table::default() };
        table.columns.push(si_column(ColumnTarget::Time, "UTC"));
        table.values.push(times.1.t.clone());
        table.start = self.start_time();
        if let Some(start) = &table.start {
            let message = format!("time is relative to {}", start.text);
            findings.warning(None, Some("UTC"), message);
        }
        let (name, readings) = chosen.remove(&base)?;
        table.columns.push(si_column(base, &name));
        table.values.push(readings.values);
        let others = chosen.into_iter().map(|(target, (name, readings))| SensorSeries {
            column: si_column(target, &name),
            t: readings.t,
            values: readings.values,
        });
        join_series(&mut table, others.collect(), findings);
        Some(table)
    }

    fn start_time(&self) -> Option<TimeOrigin> {
        let first = self.first?;
        let at = self.midnight.unwrap_or(0) + first;
        let text = match self.midnight {
            Some(_) if self.own => format_iso(at),
            Some(_) => format!("{}Z", format_iso(at)),
            None => format_iso(at).split_off("1970-01-01T".len()),
        };
        Some(TimeOrigin { text, at_s: at as f64 / SECOND as f64, dated: self.midnight.is_some() })
    }

    fn report_losses(&self, findings: &mut Findings) {
        if self.series.is_empty() {
            let what = match self.last {
                None => {
                    "there is no time: neither in sentences (GGA, RMC or ZDA) nor in the log \
                     before them"
                }
                Some(_) => "no sentence has data for a channel of a trial",
            };
            findings.error(None, None, what);
        }
        let (damaged, first) = self.damaged;
        if damaged > 0 {
            let message =
                format!("{damaged} sentences skipped: their checksum is wrong or missing");
            findings.warning(Some(first), None, message);
        }
        if self.timeless > 0 {
            let message = format!("{} sentences skipped: their time is unknown", self.timeless);
            findings.warning(None, None, message);
        }
        let how = match self.own {
            true => "times are those of the log, before each sentence",
            false => {
                "sentences without a time get one by interpolation over their lines; their delay \
                 is unknown"
            }
        };
        findings.warning(None, None, how);
    }
}

/// Returns the series whose times the table has: positions, or the series with most readings.
fn base_target(chosen: &BTreeMap<ColumnTarget, (String, SeriesReadings)>) -> Option<ColumnTarget> {
    let latitude = ColumnTarget::Raw(RawQuantity::Latitude);
    if chosen.contains_key(&latitude) {
        return Some(latitude);
    }
    let most = chosen.iter().max_by_key(|(_, (_, readings))| readings.t.len());
    most.map(|(&target, _)| target)
}

fn si_column(target: ColumnTarget, name: &str) -> TableColumn {
    TableColumn {
        index: 0,
        header: name.to_owned(),
        target,
        unit: UnitKind::from_target(target).canonical_unit().into(),
        to_si: 1.0,
        at_rest: 0.0,
    }
}

#[cfg(test)]
#[path = "nmea_file_tests.rs"]
mod tests;
