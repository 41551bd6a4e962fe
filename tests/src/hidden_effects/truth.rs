//! The true ship: SR108 by the law of Son and Nomoto, with something hidden that no model of it has
//! been told.

#[cfg(test)]
mod checks;
mod instruments;
mod sailing;
mod weather;

use std::sync::LazyLock;

use sistership_model::effect::AppliedEffect;
use sistership_model::quantity::Quantity;
use sistership_model::{Model, Trial, Zoo};

pub use sailing::{Manoeuvre, Sailing, TrueShip};
pub use weather::Weather;

/// The ships, laws and effects that everybody knows.
pub static ZOO: LazyLock<Zoo> =
    LazyLock::new(|| Zoo::load_embedded().unwrap_or_else(|error| panic!("{error}")));

/// What the trials hide.
#[derive(Debug, Clone, Default)]
pub struct Hidden {
    /// Effects of the library, with their true parameters.
    pub effects: Vec<AppliedEffect>,
    /// The true wind where there is one, and whether the trials record it.
    pub wind: Option<Weather>,
    /// The trials have no wind sensor.
    pub no_wind_sensor: bool,
    /// Something that is not in the library.
    pub unlisted: Option<Unlisted>,
}

/// Effects that are not in the library.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Unlisted {
    /// From half time on the propeller gives less thrust by this share; the rudder's inflow stays.
    ThrustLoss { share: f64 },
    /// A yaw moment that oscillates with a period of 60 s, as the angular acceleration it gives,
    /// rad/s2.
    OscillatingMoment { amplitude_rad_s2: f64 },
    /// A sway force by the cosine of three times the heading, as the acceleration it gives, m/s2.
    HeadingForce { amplitude_m_s2: f64 },
}

/// An effect of the library with values of its parameters; those that are not given are absent.
pub fn effect(name: &str, form: &str, values: &[(&str, f64)]) -> AppliedEffect {
    let effect = ZOO.effect(name).unwrap_or_else(|| panic!("no effect `{name}`"));
    let listed = effect.forms.iter().find(|known| known.file.name == form).cloned();
    let spelled = || {
        let axes = [
            sistership_model::coefficient::Axis::X,
            sistership_model::coefficient::Axis::Y,
            sistership_model::coefficient::Axis::N,
        ];
        let terms = effect.grammar.as_ref()?.list_forms(&axes, &|_| false, &|_| true);
        terms.into_iter().find(|term| term.file.name == form)
    };
    let form = listed.or_else(spelled).unwrap_or_else(|| panic!("no form `{form}` of `{name}`"));
    assert!(
        values.iter().all(|(name, _)| form.parameters.contains_key(*name)),
        "{values:?} of {}",
        form.file.name
    );
    let value = |name: &str, absent: f64| {
        values.iter().find(|(known, _)| *known == name).map_or(absent, |&(_, value)| value)
    };
    let parameters = form.parameters.iter();
    let parameters = parameters
        .map(|(name, p)| (name.clone(), Quantity::new(value(name, p.absent), "the truth")))
        .collect();
    AppliedEffect {
        name: name.into(),
        acts_on: effect.acts_on,
        parameters,
        form: form.file.clone(),
    }
}

/// Sails a programme and records it; the same seed gives the same noise.
pub fn trials(hidden: &Hidden, programme: &[Sailing], seed: u64) -> Vec<Trial> {
    let ship = TrueShip::new(hidden);
    let one = |(k, sailing): (usize, &Sailing)| {
        instruments::record(&ship, sailing, seed.wrapping_mul(1000) + k as u64)
    };
    programme.iter().enumerate().map(one).collect()
}

/// SR108 as published.
pub fn published() -> Model {
    ZOO.find_model("sr108").unwrap_or_else(|error| panic!("{error}"))
}
