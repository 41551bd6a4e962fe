//! NetCDF files of before version 4: variables of one dimension are columns.

use std::io;

use netcdf_reader::{NcAttrValue, NcFile, NcType, NcVariable};

use super::cf_units::{CfTime, cf_time, plain_cf_unit};
use crate::column_source::{ColumnSource, FileColumn};
use crate::limits::FileLimits;

/// NetCDF file whose variables are listed.
pub(crate) struct NetCdfColumns {
    file: NcFile,
    columns: Vec<FileColumn>,
    /// For a variable of time, its unit and epoch.
    times: Vec<Option<CfTime>>,
}

fn invalid_data(error: impl std::fmt::Display) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidData, error.to_string())
}

impl NetCdfColumns {
    /// Lists the variables of a file.
    ///
    /// # Errors
    /// Returns an error if the file is damaged or holds more than the limits allow.
    pub(crate) fn open(bytes: Vec<u8>, limits: FileLimits) -> io::Result<Self> {
        let file = NcFile::from_bytes(&bytes).map_err(invalid_data)?;
        let (mut columns, mut times) = (Vec::new(), Vec::new());
        for variable in file.variables().map_err(invalid_data)? {
            let length = variable.num_elements().map_err(invalid_data)?;
            if variable.ndim() != 1 || *variable.dtype() == NcType::Char {
                continue;
            }
            if length > limits.unpacked_bytes as u64 / 8 {
                return Err(invalid_data(format!("`{}` holds more than is read", variable.name())));
            }
            let unit = text_attribute(variable, "units");
            let time = cf_time(&unit);
            let shown = if time.is_some() { "unix".into() } else { plain_cf_unit(&unit) };
            columns.push(FileColumn {
                name: variable.name().to_owned(),
                unit: shown,
                length: usize::try_from(length).map_err(invalid_data)?,
            });
            times.push(time);
        }
        Ok(Self { file, columns, times })
    }
}

impl ColumnSource for NetCdfColumns {
    fn columns(&self) -> &[FileColumn] {
        &self.columns
    }

    fn read_numbers(&mut self, wanted: &[usize]) -> io::Result<Vec<Vec<f64>>> {
        let read = |&at: &usize| {
            let name = &self.columns[at].name;
            let values = self.file.read_variable_unpacked_masked(name).map_err(invalid_data)?;
            let since = |value: f64| match self.times[at] {
                Some(time) => time.epoch_s + value * time.unit_s,
                None => value,
            };
            Ok(values.iter().map(|&value| since(value)).collect())
        };
        wanted.iter().map(read).collect()
    }
}

fn text_attribute(variable: &NcVariable, name: &str) -> String {
    match variable.attribute(name).map(|attribute| &attribute.value) {
        Some(NcAttrValue::Chars(text)) => text.clone(),
        Some(NcAttrValue::Strings(texts)) => texts.first().cloned().unwrap_or_default(),
        _ => String::new(),
    }
}
