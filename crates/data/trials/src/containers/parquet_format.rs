//! Kinds of value of the fields of a Parquet footer and page header (parquet-format 2.12,
//! `parquet.thrift`).
//!
//! The library reads a field by its number and ignores the kind that the file declares. Where the
//! two differ, it continues at another byte than a reader that follows the kinds, so that the
//! checks of such a reader would be worthless. A file in which they differ is refused.

/// Kinds of Thrift's compact protocol; a truth value is 1 or 2.
const TRUTH: u8 = 1;
const BYTE: u8 = 3;
const I16: u8 = 4;
const I32: u8 = 5;
const I64: u8 = 6;
const BINARY: u8 = 8;
const LIST: u8 = 9;
const STRUCT: u8 = 12;

/// Kind of a field, and of the entries of a list.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct FieldKind {
    kind: u8,
    entries: u8,
}

impl FieldKind {
    /// Both truth values, 1 and 2, are of one kind.
    pub fn is_kind(self, kind: u8) -> bool {
        self.kind == if kind == 2 { TRUTH } else { kind }
    }

    pub fn holds_entries(self, entries: u8) -> bool {
        self.entries == entries
    }
}

/// Kinds of fields by their path of field numbers; `None` for fields that the format does not
/// define.
pub(crate) type FieldFormat = fn(&[i16]) -> Option<FieldKind>;

fn scalar_kind(kind: u8) -> Option<FieldKind> {
    Some(FieldKind { kind, entries: 0 })
}

fn list_kind(entries: u8) -> Option<FieldKind> {
    Some(FieldKind { kind: LIST, entries })
}

/// `FileMetaData`.
pub(crate) fn footer_field(path: &[i16]) -> Option<FieldKind> {
    match path {
        [1] => scalar_kind(I32),
        [2 | 4 | 5 | 7] => list_kind(STRUCT),
        [3] => scalar_kind(I64),
        [6 | 9] => scalar_kind(BINARY),
        [8] | [7, _] => scalar_kind(STRUCT),
        // Lists add nothing to the path: the fields of an entry follow the field of the list.
        [2, rest @ ..] => schema_element(rest),
        [4, rest @ ..] => row_group(rest),
        [5, rest @ ..] => key_value(rest),
        _ => None,
    }
}

fn key_value(path: &[i16]) -> Option<FieldKind> {
    if matches!(path, [1 | 2]) { scalar_kind(BINARY) } else { None }
}

/// `SchemaElement`, with its `LogicalType`.
fn schema_element(path: &[i16]) -> Option<FieldKind> {
    match path {
        [1 | 2 | 3 | 5 | 6 | 7 | 8 | 9] => scalar_kind(I32),
        [4] | [10, 17 | 18, 1] => scalar_kind(BINARY),
        [10] | [10, _] | [10, 7 | 8, 2] | [10, 7 | 8, 2, _] => scalar_kind(STRUCT),
        [10, 5, 1 | 2] | [10, 18, 2] => scalar_kind(I32),
        [10, 7 | 8, 1] | [10, 10, 2] => scalar_kind(TRUTH),
        [10, 10 | 16, 1] => scalar_kind(BYTE),
        _ => None,
    }
}

/// `RowGroup`, with its `SortingColumn`s and `ColumnChunk`s.
fn row_group(path: &[i16]) -> Option<FieldKind> {
    match path {
        [1 | 4] => list_kind(STRUCT),
        [2 | 3 | 5 | 6] => scalar_kind(I64),
        [7] => scalar_kind(I16),
        [4, 1] => scalar_kind(I32),
        [4, 2 | 3] => scalar_kind(TRUTH),
        [1, rest @ ..] => column_chunk(rest),
        _ => None,
    }
}

fn column_chunk(path: &[i16]) -> Option<FieldKind> {
    match path {
        [1 | 9] => scalar_kind(BINARY),
        [2 | 4 | 6] => scalar_kind(I64),
        [3 | 8] => scalar_kind(STRUCT),
        [5 | 7] => scalar_kind(I32),
        [3, rest @ ..] => column_metadata(rest),
        _ => None,
    }
}

/// `ColumnMetaData`, with its statistics.
fn column_metadata(path: &[i16]) -> Option<FieldKind> {
    match path {
        [1 | 4 | 15] => scalar_kind(I32),
        [2] => list_kind(I32),
        [3] => list_kind(BINARY),
        [5 | 6 | 7 | 9 | 10 | 11 | 14] | [16, 1] => scalar_kind(I64),
        [8 | 13] => list_kind(STRUCT),
        [12 | 16 | 17] => scalar_kind(STRUCT),
        [8, rest @ ..] => key_value(rest),
        [12, rest @ ..] => statistics(rest),
        [13, 1..=3] => scalar_kind(I32),
        [16, 2 | 3] => list_kind(I64),
        _ => None,
    }
}

fn statistics(path: &[i16]) -> Option<FieldKind> {
    match path {
        [1 | 2 | 5 | 6] => scalar_kind(BINARY),
        [3 | 4 | 9] => scalar_kind(I64),
        [7 | 8] => scalar_kind(TRUTH),
        _ => None,
    }
}

/// `PageHeader`.
pub(crate) fn page_header_field(path: &[i16]) -> Option<FieldKind> {
    match path {
        [1..=4] | [5, 1..=4] | [7, 1 | 2] | [8, 1..=6] => scalar_kind(I32),
        [5..=8] | [5, 5] | [8, 8] => scalar_kind(STRUCT),
        [7, 3] | [8, 7] => scalar_kind(TRUTH),
        [5, 5, rest @ ..] | [8, 8, rest @ ..] => statistics(rest),
        _ => None,
    }
}
