//! Tables of the report of a refinement.

mod coefficients;
mod further;
mod provenance;
mod results;
mod sailed;

pub(crate) use coefficients::coefficient_table;
pub(crate) use further::further_table;
pub(crate) use provenance::{parameters_table, particulars_table, settings_table};
pub(crate) use results::{criteria_table, error_table, option_table, turn_table, zigzag_table};
pub(crate) use sailed::measured_table;
