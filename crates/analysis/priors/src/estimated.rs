//! Published estimates of a law's parameters that neither particulars nor source give.
//!
//! The law `low-speed` has formulas for mass, inertia and added masses of any ship: a radius of
//! gyration of a quarter of the length, a twentieth of the mass added in surge, and Clarke, Gedling
//! and Hine (1983) for sway and yaw. A parameter of another law with the same name and meaning is
//! estimated by the same formula.

use std::sync::LazyLock;

use sistership_model::Vessel;
use sistership_model::law::Law;
use sistership_model::quantity::Quantity;

static ESTIMATES: LazyLock<Option<Law>> = LazyLock::new(|| {
    Law::parse("low-speed", include_str!("../../../../models/laws/low-speed.yaml")).ok()
});

/// Estimate of a law's parameter, with a source that marks it as one.
pub(crate) fn estimated_parameter(law: &Law, name: &str, target: &Vessel) -> Option<Quantity> {
    let prior = law.parameters.get(name)?.prior;
    clarke_estimate(law, name, target)
        .or_else(|| prior.map(|prior| Quantity::new(prior.value, "mean of its prior in the law")))
}

fn clarke_estimate(law: &Law, name: &str, target: &Vessel) -> Option<Quantity> {
    let estimates = ESTIMATES.as_ref()?;
    let (wanted, known) = (law.parameters.get(name)?, estimates.parameters.get(name)?);
    // The same name may have another meaning in another law: dimension and meaning must agree.
    let is_same = known.dimension == wanted.dimension && known.meaning.starts_with(&wanted.meaning);
    let value = estimates.derived_parameter(name, &target.particulars).filter(|_| is_same)?;
    Some(Quantity::new(value, "estimated by Clarke et al. 1983, as in the law low-speed"))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use sistership_model::Zoo;

    #[test]
    fn added_masses_of_another_law_are_estimated_near_those_published() {
        let zoo = Zoo::load_embedded().unwrap();
        let (mariner, law) = (zoo.vessel("mariner").unwrap(), zoo.law("abkowitz").unwrap());
        let published = zoo.find_model("mariner/abkowitz").unwrap();
        for name in ["X_udot", "Y_vdot", "N_rdot"] {
            let estimate = estimated_parameter(law, name, mariner).unwrap().value;
            let ratio = estimate / published.parameters[name].value;
            assert!((0.5..2.0).contains(&ratio), "{name}: {ratio}");
        }
        assert!(estimated_parameter(law, "U0", mariner).is_none());
    }
}
