//! What a simulation is surrounded by where nobody recorded it: a steady current, a steady wind.

use std::collections::BTreeMap;

use sistership_model::effect::AppliedEffect;
use sistership_model::quantity::Quantity;

use crate::library::library;

/// The form of an effect that is the same everywhere and always, with its velocity to the north and
/// the east, m/s: of the current where it goes, of the wind where it comes from; `source` is who
/// says so. None where the library has no such form.
pub fn steady(name: &str, [north, east]: [f64; 2], source: &str) -> Option<AppliedEffect> {
    let effect = library().ok()?.effects.iter().find(|effect| effect.name == name)?;
    let form = effect.forms.iter().find(|form| form.file.name == "constant")?;
    let value = |value: f64| Quantity::new(value, source);
    let parameters = BTreeMap::from([
        ("north_m_s".to_owned(), value(north)),
        ("east_m_s".to_owned(), value(east)),
    ]);
    let (acts_on, form) = (effect.acts_on, form.file.clone());
    Some(AppliedEffect { name: name.to_owned(), acts_on, parameters, form })
}
