//! Enough of a file to identify its columns: all of it, or pieces of a long log.

use std::fs::File;
use std::io::{self, Cursor, Read, Seek, SeekFrom};
use std::path::Path;

use sistership_columns::{ColumnData, RecordingSample};
use sistership_model::manifest::Missing;

use crate::findings::Findings;
use crate::limits::Limits;
use crate::mapping::{Mapping, WrittenTime};
use crate::preview::Preview;
use crate::read::{Visit, each_row};
use crate::source::{Content, Source};
use crate::stream;
use crate::table::{Start, Table, Target};
use crate::taker::RowsFile;
use crate::written_time::written_time;

/// Bytes of text beyond which pieces are looked at, and the size and number of these.
const WHOLE: u64 = 16 << 20;
const PIECE: u64 = 1 << 20;
const PIECES: u64 = 8;
/// Rows that are looked at.
const ROWS: usize = 100_000;

/// The columns of a file, and what time zero is in the calendar where the file says it.
#[derive(Debug, Default)]
pub(crate) struct FileSample {
    pub recording: RecordingSample,
    pub start: Option<Start>,
}

/// The columns of a file as they stand.
pub(crate) fn sample(name: &str, path: &Path, preview: &Preview) -> io::Result<FileSample> {
    let mut content = Source::open(name, path)?.content;
    if let Content::Csv(_) = content
        && std::fs::metadata(path)?.len() > WHOLE
    {
        content = Content::Csv(Box::new(Cursor::new(pieces(path)?)));
    }
    let time = written(preview);
    let mut mapping = Mapping {
        unidentified: Some(WrittenTime(time)),
        limits: Limits { rows: ROWS, ..Limits::default() },
        ..Mapping::canonical()
    };
    mapping.declared.sheet.clone_from(&preview.sheet);
    mapping.conventions.missing = Missing::Bridge;
    // What is wrong with the file is told when it is read for good.
    let mut findings = Findings::default();
    let table = each_row(content, &mapping, &mut findings, WholeVisit(&mapping));
    let mut table = table.flatten().unwrap_or_default();
    let start = table.start.take();
    Ok(FileSample { recording: recording(table, preview, time), start })
}

struct WholeVisit<'a>(&'a Mapping);

impl Visit for WholeVisit<'_> {
    type Output = Option<Table>;

    fn visit(self, file: impl RowsFile, _: &Findings) -> Self::Output {
        stream::whole(file, self.0, &mut Findings::default())
    }
}

/// The start of a long file and pieces of the rest, cut at line ends.
fn pieces(path: &Path) -> io::Result<Vec<u8>> {
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

/// Bytes up to the end of a line and with it.
fn end_of_line<'a>(mut bytes: impl Iterator<Item = &'a u8>) -> usize {
    bytes.position(|&byte| byte == b'\n').map_or(0, |at| at + 1)
}

/// The first column whose cells are dates, times of day or days of a sheet, and its unit.
fn written(preview: &Preview) -> Option<(usize, &'static str)> {
    (0..preview.names.len()).find_map(|at| {
        let cells: Vec<&str> =
            preview.rows.iter().filter_map(|row| row.get(at)).map(String::as_str).collect();
        written_time(&preview.names[at], &cells).map(|unit| (at, unit))
    })
}

fn recording(
    table: Table,
    preview: &Preview,
    time: Option<(usize, &'static str)>,
) -> RecordingSample {
    let rows = table.rows.len();
    let of_place = |at: usize| {
        let place = u16::try_from(at).unwrap_or(u16::MAX);
        let is_it = |target: Target| match target {
            Target::Time => time.is_some_and(|(written, _)| written == at),
            target => target == Target::Unidentified(place),
        };
        table.columns.iter().position(|column| is_it(column.target))
    };
    let columns = preview.names.iter().enumerate().map(|(at, header)| ColumnData {
        header: header.clone(),
        below: preview.units.get(at).filter(|unit| !unit.is_empty()).cloned(),
        values: of_place(at).map_or_else(|| vec![f64::NAN; rows], |k| table.values[k].clone()),
        written_time: time.filter(|(written, _)| *written == at).map(|(_, unit)| unit),
    });
    RecordingSample { columns: columns.collect(), breaks: Vec::new() }
}
