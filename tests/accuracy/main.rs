//! Accuracy against published tables and independent reference data. Figures are printed; `--nocapture` shows them.

mod paper_v;
mod esso_osaka;
mod reference_tracks;
mod similarity;
