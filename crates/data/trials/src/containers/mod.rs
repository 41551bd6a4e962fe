//! How files hold their bytes: pages of Parquet, elements of MATLAB 5, the archive of a workbook.
//! What each declares is held against limits before anything is unpacked.

pub mod archive;
pub mod mat_elements;
pub mod pages;
mod parquet_format;
