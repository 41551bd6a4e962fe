//! HDF5 files, and with them MATLAB 7.3 and NetCDF-4: vectors, columns of matrices and fields of
//! tables are columns, named by their paths.

use std::io;

use hdf5_reader::group::Group;
use hdf5_reader::{Dataset, Datatype, Hdf5File, OpenOptions};

use super::cf_units::{CfScale, cf_time, plain_cf_unit};
use crate::column_source::{ColumnSource, FileColumn};
use crate::limits::FileLimits;

/// Largest number of columns of a matrix, of columns and of groups of a file, and depth of groups.
const MAX_MATRIX_COLUMNS: u64 = 200;
const MAX_COLUMNS: usize = 10_000;
const MAX_GROUPS: usize = 10_000;
const MAX_DEPTH: usize = 8;

/// Place of a column in a dataset.
struct ColumnPlace {
    dataset: usize,
    /// Index of its first element, and the distance to the next.
    first: usize,
    stride: usize,
    length: usize,
    /// Byte of an element at which its number begins, and the type of the number.
    offset: usize,
    kind: Datatype,
}

/// HDF5 file whose columns are listed.
pub(crate) struct Hdf5Columns {
    datasets: Vec<Dataset>,
    columns: Vec<FileColumn>,
    places: Vec<ColumnPlace>,
    is_matlab: bool,
    /// Number of groups that were visited: links may lead to the same group again and again.
    groups: usize,
}

fn invalid_data(error: impl std::fmt::Display) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidData, error.to_string())
}

impl Hdf5Columns {
    /// Lists the columns of a file.
    ///
    /// # Errors
    /// Returns an error if the file is damaged or holds more than the limits allow.
    pub(crate) fn open(bytes: Vec<u8>, limits: FileLimits) -> io::Result<Self> {
        let is_matlab = bytes.starts_with(b"MATLAB 7.3");
        // Chunks are unpacked one by one; a column must fit into memory, unpacked.
        let options = OpenOptions::default()
            .with_chunk_cache_bytes(0)
            .with_max_chunk_bytes(limits.unpacked_bytes)
            .with_max_read_bytes(limits.unpacked_bytes);
        let file = Hdf5File::from_vec_with_options(bytes, options).map_err(invalid_data)?;
        let mut columns = Self {
            datasets: Vec::new(),
            columns: Vec::new(),
            places: Vec::new(),
            is_matlab,
            groups: 0,
        };
        columns.add_group(&file.root_group().map_err(invalid_data)?, "", 0)?;
        Ok(columns)
    }

    fn add_group(&mut self, group: &Group, path: &str, depth: usize) -> io::Result<()> {
        self.groups += 1;
        if depth > MAX_DEPTH || self.groups > MAX_GROUPS {
            return Err(invalid_data("its groups are nested deeper than is read"));
        }
        let (groups, datasets) = group.members().map_err(invalid_data)?;
        for dataset in datasets {
            self.add_dataset(dataset, path)?;
        }
        // `#refs#` and `#subsystem#` hold MATLAB's own objects.
        for inner in groups.iter().filter(|inner| !inner.name().starts_with('#')) {
            self.add_group(inner, &format!("{path}{}.", inner.name()), depth + 1)?;
        }
        Ok(())
    }

    fn add_dataset(&mut self, dataset: Dataset, path: &str) -> io::Result<()> {
        // MATLAB's texts are numbers of two bytes, its cells references.
        if text_attribute(&dataset, "MATLAB_class").is_some_and(|class| class == "char") {
            return Ok(());
        }
        let name = format!("{path}{}", dataset.name());
        let shape = dataset.shape().to_vec();
        let fields = number_fields(dataset.dtype());
        // MATLAB stores the transpose: its columns are the rows of the file.
        let [rows, count] = match *shape.as_slice() {
            [length] => [length, 1],
            [one, length] if one == 1 || length == 1 => [one.max(length), 1],
            [count, rows] if self.is_matlab => [rows, count],
            [rows, count] => [rows, count],
            _ => return Ok(()),
        };
        if rows < 2 || count > MAX_MATRIX_COLUMNS || fields.is_empty() {
            return Ok(());
        }
        let (rows, count) = (to_index(rows)?, to_index(count)?);
        let unit = text_attribute(&dataset, "units").or_else(|| text_attribute(&dataset, "unit"));
        for at in 0..count {
            let (first, stride) = if self.is_matlab { (at * rows, 1) } else { (at, count) };
            let base = if count == 1 { name.clone() } else { format!("{name}(:,{})", at + 1) };
            for (field, offset, kind) in &fields {
                let name = if field.is_empty() { base.clone() } else { format!("{base}.{field}") };
                if self.columns.len() == MAX_COLUMNS {
                    return Err(invalid_data("it has more columns than are read"));
                }
                self.columns.push(FileColumn {
                    name,
                    unit: shown_unit(unit.as_deref().unwrap_or_default()),
                    length: rows,
                });
                self.places.push(ColumnPlace {
                    dataset: self.datasets.len(),
                    first,
                    stride,
                    length: rows,
                    offset: *offset,
                    kind: kind.clone(),
                });
            }
        }
        self.datasets.push(dataset);
        Ok(())
    }

    fn read_column(&self, place: &ColumnPlace, bytes: &[u8]) -> io::Result<Vec<f64>> {
        let dataset = &self.datasets[place.dataset];
        let size = dataset.raw_element_size().map_err(invalid_data)?;
        let scale = column_scale(dataset);
        let number = |k: usize| {
            let start = (place.first + k * place.stride) * size + place.offset;
            let raw = decode_number(bytes.get(start..).unwrap_or_default(), &place.kind);
            scale.scaled_value(raw)
        };
        Ok((0..place.length).map(number).collect())
    }
}

impl ColumnSource for Hdf5Columns {
    fn columns(&self) -> &[FileColumn] {
        &self.columns
    }

    fn read_numbers(&mut self, wanted: &[usize]) -> io::Result<Vec<Vec<f64>>> {
        let mut data = vec![Vec::new(); wanted.len()];
        for (at, dataset) in self.datasets.iter().enumerate() {
            let here = |&column: &usize| self.places[column].dataset == at;
            if !wanted.iter().any(here) {
                continue;
            }
            // The bytes of one dataset are in memory at a time.
            let bytes = dataset.read_raw_bytes().map_err(invalid_data)?;
            for (position, &column) in wanted.iter().enumerate().filter(|(_, column)| here(column))
            {
                data[position] = self.read_column(&self.places[column], &bytes)?;
            }
        }
        Ok(data)
    }
}

fn to_index(length: u64) -> io::Result<usize> {
    usize::try_from(length).map_err(invalid_data)
}

/// Returns the numbers of an element: itself, or the fields of a table, with byte and type of each.
fn number_fields(kind: &Datatype) -> Vec<(String, usize, Datatype)> {
    match kind {
        kind if is_number(kind) => vec![(String::new(), 0, kind.clone())],
        Datatype::Compound { fields, .. } => {
            let numbers = fields.iter().filter(|field| is_number(&field.datatype));
            let of = |field: &hdf5_reader::CompoundField| {
                (field.name.clone(), field.byte_offset as usize, field.datatype.clone())
            };
            numbers.map(of).collect()
        }
        _ => Vec::new(),
    }
}

fn is_number(kind: &Datatype) -> bool {
    match kind {
        Datatype::FloatingPoint { size, .. } => matches!(size, 4 | 8),
        Datatype::FixedPoint { size, .. } => matches!(size, 1 | 2 | 4 | 8),
        _ => false,
    }
}

/// Returns a number of at most eight bytes; NaN where the bytes end before it.
fn decode_number(bytes: &[u8], kind: &Datatype) -> f64 {
    let (size, order, signed) = match kind {
        Datatype::FloatingPoint { size, byte_order } => (*size as usize, byte_order, None),
        Datatype::FixedPoint { size, byte_order, signed, .. } => {
            (*size as usize, byte_order, Some(*signed))
        }
        _ => return f64::NAN,
    };
    let Some(bytes) = bytes.get(..size).filter(|_| size <= 8) else { return f64::NAN };
    let mut little = [0; 8];
    little[..size].copy_from_slice(bytes);
    if *order == hdf5_reader::ByteOrder::BigEndian {
        little[..size].reverse();
    }
    let whole = u64::from_le_bytes(little);
    // Shifted to the top and back, so that the sign is extended.
    let shift = 64 - 8 * size as u32;
    match signed {
        Some(true) => (((whole << shift) as i64) >> shift) as f64,
        Some(false) => whole as f64,
        None if size == 4 => f64::from(f32::from_bits(whole as u32)),
        None => f64::from_bits(whole),
    }
}

fn text_attribute(dataset: &Dataset, name: &str) -> Option<String> {
    dataset.attribute(name).ok()?.read_string().ok()
}

/// Returns scale and gaps of the numbers, as the conventions for NetCDF state them.
fn column_scale(dataset: &Dataset) -> CfScale {
    let number = |name: &str| dataset.attribute(name).ok()?.read_as_f64().ok();
    let unit = text_attribute(dataset, "units").unwrap_or_default();
    CfScale {
        factor: number("scale_factor").unwrap_or(1.0),
        offset: number("add_offset").unwrap_or(0.0),
        gap: number("_FillValue").or_else(|| number("missing_value")),
        time: cf_time(&unit),
    }
}

/// Returns the unit in which the numbers are returned.
fn shown_unit(unit: &str) -> String {
    if cf_time(unit).is_some() { "unix".into() } else { plain_cf_unit(unit) }
}
