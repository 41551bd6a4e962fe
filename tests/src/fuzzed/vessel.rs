//! Vessels.

use sistership_model::Vessel;

/// A vessel that is read has particulars that are numbers.
pub fn run(data: &[u8]) {
    let Some(vessel) = super::text(data).and_then(|text| Vessel::parse("fuzz.yaml", text).ok())
    else {
        return;
    };
    assert!(!vessel.name().is_empty(), "a vessel without a name");
    for name in ["lpp_m", "beam_m", "draught_m"] {
        assert!(vessel.particular(name).is_none_or(f64::is_finite), "{name} is no number");
    }
}
