//! Accuracy against published tables and independent reference data. Figures are printed; `--nocapture` shows them.

mod reference_tracks;
