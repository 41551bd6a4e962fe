//! Accuracy against published tables and independent reference data. Figures are printed;
//! `--nocapture` shows them.

mod esso_osaka;
mod family;
mod paper_v;
mod plain;
mod reference_tracks;
mod similarity;
