//! Sample of a file for the identification of its columns: all of it, or pieces of a long log.

use std::fs::File;
use std::io::{self, Cursor, Read, Seek, SeekFrom};
use std::path::Path;

use sistership_columns::{ColumnData, RecordingSample};
use sistership_model::manifest::MissingValues;

use crate::cell_value::common_unit;
use crate::findings::Findings;
use crate::limits::FileLimits;
use crate::mapping::{Mapping, WrittenTime};
use crate::preview::FilePreview;
use crate::read::{RowsVisitor, each_row};
use crate::row_sink::RowSource;
use crate::stream;
use crate::table::{ColumnTarget, Table, TimeOrigin};
use crate::trial_file::{InputContent, TrialFile};
use crate::written_time::written_time;

/// Size of text, bytes, beyond which only pieces are read, and the size and number of these.
const WHOLE: u64 = 16 << 20;
const PIECE: u64 = 1 << 20;
const PIECES: u64 = 8;
/// Largest number of rows that are examined.
const ROWS: usize = 100_000;

/// Columns of a file, and the calendar time of time zero, if the file contains it.
#[derive(Debug, Default)]
pub(crate) struct FileSample {
    pub recording: RecordingSample,
    pub start: Option<TimeOrigin>,
}

/// Reads the columns of a file unconverted.
pub(crate) fn sample_file(
    name: &str,
    path: &Path,
    preview: &FilePreview,
) -> io::Result<FileSample> {
    let mut content = TrialFile::open(name, path)?.content;
    if let InputContent::Csv(_) = content
        && std::fs::metadata(path)?.len() > WHOLE
    {
        // Pieces from the whole file: its start alone may show no manoeuvre.
        content = InputContent::Csv(Box::new(Cursor::new(read_pieces(path)?)));
    }
    let time = find_written_time(preview);
    let mut mapping = Mapping {
        unidentified: Some(WrittenTime(time)),
        limits: FileLimits { rows: ROWS, ..FileLimits::default() },
        ..Mapping::with_canonical_names()
    };
    mapping.part.clone_from(&preview.part);
    mapping.conventions.missing = MissingValues::Bridge;
    // Findings are ignored here: they are reported when the trial is read with its manifest.
    let mut findings = Findings::default();
    let table = each_row(content, &mapping, &mut findings, WholeVisitor(&mapping));
    let mut table = table.flatten().unwrap_or_default();
    let start = table.start.take();
    Ok(FileSample { recording: recording_sample(table, preview, time), start })
}

struct WholeVisitor<'a>(&'a Mapping);

impl RowsVisitor for WholeVisitor<'_> {
    type Output = Option<Table>;

    fn visit_rows(self, file: impl RowSource, _: &Findings) -> Self::Output {
        stream::read_whole(file, self.0, &mut Findings::default())
    }
}

/// Reads the start of a long file and pieces of the rest, cut at line ends.
fn read_pieces(path: &Path) -> io::Result<Vec<u8>> {
    let mut file = File::open(path)?;
    let length = file.metadata()?.len();
    let mut text = Vec::new();
    for piece in 0..PIECES {
        file.seek(SeekFrom::Start(length / PIECES * piece))?;
        let mut part = Vec::new();
        file.by_ref().take(PIECE).read_to_end(&mut part)?;
        let first = if piece == 0 { 0 } else { end_of_line(part.iter()) };
        let last = part.len() - end_of_line(part.iter().rev()).saturating_sub(1);
        text.extend_from_slice(part.get(first..last).unwrap_or_default());
    }
    Ok(text)
}

/// Returns the number of bytes up to and including the first line end; 0 without one.
fn end_of_line<'a>(mut bytes: impl Iterator<Item = &'a u8>) -> usize {
    bytes.position(|&byte| byte == b'\n').map_or(0, |at| at + 1)
}

/// Returns the index and unit of the first column whose cells are dates, times of day or days of a
/// sheet.
fn find_written_time(preview: &FilePreview) -> Option<(usize, &'static str)> {
    (0..preview.names.len()).find_map(|at| {
        let cells: Vec<&str> =
            preview.rows.iter().filter_map(|row| row.get(at)).map(String::as_str).collect();
        written_time(&preview.names[at], &cells).map(|unit| (at, unit))
    })
}

/// Returns the unit of a column that the file states: in a row of units, or in every cell.
fn written_unit(preview: &FilePreview, at: usize) -> Option<String> {
    let below = preview.units.get(at).filter(|unit| !unit.is_empty()).cloned();
    let cells = preview.rows.iter().filter_map(|row| row.get(at)).map(String::as_str);
    below.or_else(|| common_unit(cells))
}

fn recording_sample(
    table: Table,
    preview: &FilePreview,
    time: Option<(usize, &'static str)>,
) -> RecordingSample {
    let rows = table.rows.len();
    let of_place = |at: usize| {
        let place = u16::try_from(at).unwrap_or(u16::MAX);
        let is_it = |target: ColumnTarget| match target {
            ColumnTarget::Time => time.is_some_and(|(written, _)| written == at),
            target => target == ColumnTarget::Unidentified(place),
        };
        table.columns.iter().position(|column| is_it(column.target))
    };
    let columns = preview.names.iter().enumerate().map(|(at, header)| ColumnData {
        header: header.clone(),
        below: written_unit(preview, at),
        // A column that is empty throughout is absent from the table: NaN takes its place.
        values: of_place(at).map_or_else(|| vec![f64::NAN; rows], |k| table.values[k].clone()),
        written_time: time.filter(|(written, _)| *written == at).map(|(_, unit)| unit),
    });
    RecordingSample { columns: columns.collect(), breaks: Vec::new() }
}
