//! Containers of files: pages of Parquet, elements of MATLAB 5, the archive of a workbook. Declared
//! sizes are checked against limits before anything is unpacked.

mod announced_strings;
pub mod archive;
pub mod mat_elements;
pub mod pages;
mod parquet_format;
