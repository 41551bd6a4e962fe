//! Tables of the report of a refinement.

mod coefficients;
mod further;
mod measured_figures;
mod provenance;
mod results;

pub(crate) use coefficients::coefficient_table;
pub(crate) use further::further_table;
pub(crate) use measured_figures::measured_table;
pub(crate) use provenance::{parameters_table, particulars_table, settings_table};
pub(crate) use results::{
    criteria_table, error_table, option_table, pass_cell, turn_table, zigzag_table,
};
