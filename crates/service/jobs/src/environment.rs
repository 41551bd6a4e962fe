//! Environment of a simulation: a steady current, a steady wind.

use std::collections::BTreeMap;

use sistership_model::effect::AppliedEffect;
use sistership_model::quantity::Quantity;

use crate::library::embedded_library;

/// Returns the constant form of an effect, with its velocity components to north and east, m/s: for
/// the current where it flows to, for the wind where it comes from; `source` is the citation.
/// `None` if the library has no such form.
pub fn steady_effect(name: &str, [north, east]: [f64; 2], source: &str) -> Option<AppliedEffect> {
    let effect = embedded_library().ok()?.effects.iter().find(|effect| effect.name == name)?;
    let form = effect.forms.iter().find(|form| form.file.name == "constant")?;
    let value = |value: f64| Quantity::new(value, source);
    let parameters = BTreeMap::from([
        ("north_m_s".to_owned(), value(north)),
        ("east_m_s".to_owned(), value(east)),
    ]);
    let (acts_on, form) = (effect.acts_on, form.file.clone());
    Some(AppliedEffect { name: name.to_owned(), acts_on, parameters, form })
}
