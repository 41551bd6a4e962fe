//! Inputs of a law under an order of helm and revolutions.
//!
//! A manoeuvre orders a helm angle `delta` and revolutions `n`. A law whose inputs are single
//! actuators states what each of them does then, so that a craft with any number of actuators can
//! carry out every manoeuvre: two thrusters that steer by their difference have
//! `n*(1 + delta/(35*pi/180))` to port and `n*(1 - delta/(35*pi/180))` to starboard.

use super::definition::{Law, LawInput};
use crate::trial::{Channel, Trial};
use sistership_formula::units::Dimension;
use sistership_formula::{Expr, builtin_constant};

/// Names of the orders.
const HELM: &str = "delta";
const REVOLUTIONS: &str = "n";

/// Dimension of a name that a helm formula may use.
pub(super) fn order_dimension(name: &str) -> Option<Dimension> {
    match name {
        HELM => Some(Dimension::NONE),
        REVOLUTIONS => Some(Dimension::RATE),
        _ => builtin_constant(name).map(|(_, dimension)| dimension),
    }
}

/// Value of a helm formula at a helm angle, rad, and revolutions, 1/s.
pub fn helm_value(helm: &Expr, delta_rad: f64, n_rps: f64) -> f64 {
    let order = |name: &str| match name {
        HELM => Some(delta_rad),
        REVOLUTIONS => Some(n_rps),
        _ => None,
    };
    // Names are checked when the law is read, so that every one has a value.
    helm.value(&order).unwrap_or(f64::NAN)
}

impl Law {
    /// Inputs that follow the orders by a formula, with their places among the inputs.
    pub fn helm_inputs(&self) -> impl Iterator<Item = (usize, &str, &Expr)> {
        let inputs = self.inputs.iter().enumerate();
        inputs
            .filter_map(|(place, (name, input))| Some((place, name.as_str(), input.helm.as_ref()?)))
    }

    /// Returns true if the helm acts on the law, as an input or by the formula of one.
    pub fn follows_helm(&self) -> bool {
        self.follows_order(HELM)
    }

    /// Returns true if ordered revolutions act on the law, as an input or by the formula of one.
    pub fn follows_revolutions(&self) -> bool {
        self.follows_order(REVOLUTIONS)
    }

    /// Returns true if the difference of actuators steers and no angle does.
    pub fn steers_by_difference(&self) -> bool {
        let is_angle = |(name, input): (&String, &LawInput)| {
            name == HELM || input.helm.is_some() && input.dimension == Dimension::NONE
        };
        self.follows_helm() && !self.inputs.iter().any(is_angle)
    }

    fn follows_order(&self, order: &str) -> bool {
        let mut helms = self.helm_inputs();
        self.inputs.contains_key(order)
            || helms.any(|(_, _, helm)| helm.mentioned_names().contains(order))
    }

    /// Sets in a record of ordered helm and revolutions the channels of the actuators that follow
    /// them.
    pub fn set_actuators(&self, record: &mut Trial) {
        set_actuators(self.helm_inputs().map(|(_, name, helm)| (name, helm)), record);
    }
}

/// Sets in a record of ordered helm and revolutions the channels of inputs with their helm formulas.
pub fn set_actuators<'a>(helms: impl Iterator<Item = (&'a str, &'a Expr)>, record: &mut Trial) {
    for (name, helm) in helms {
        let Some(channel) = Channel::by_name(name) else { continue };
        let order = |of: Channel, k: usize| record.channel(of).map_or(0.0, |values| values[k]);
        let at = |k: usize| helm_value(helm, order(Channel::Delta, k), order(Channel::N, k));
        let values = (0..record.len()).map(at).collect();
        record.channels.insert(channel, values);
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::Zoo;

    #[test]
    fn full_helm_stops_the_inner_thruster_and_doubles_the_outer_one() {
        let zoo = Zoo::load_embedded().unwrap();
        let law = zoo.law("differential-thrust").unwrap();
        assert!(law.steers_by_difference() && law.follows_revolutions());
        let channels = [(Channel::Delta, vec![35_f64.to_radians()]), (Channel::N, vec![10.0])];
        let mut record = Trial { t_s: vec![0.0], channels: channels.into(), ..Trial::default() };
        law.set_actuators(&mut record);
        let side = |channel| record.channel(channel).unwrap()[0];
        assert!((side(Channel::NP) - 20.0).abs() < 1e-12 && side(Channel::NS).abs() < 1e-12);
    }

    #[test]
    fn a_rudder_law_follows_its_own_inputs() {
        let zoo = Zoo::load_embedded().unwrap();
        let law = zoo.law("low-speed").unwrap();
        assert!(law.follows_helm() && !law.steers_by_difference());
        assert_eq!(law.helm_inputs().count(), 0);
        let pair = zoo.law("hybrid-vectwin").unwrap();
        assert!(pair.follows_helm() && !pair.steers_by_difference(), "two rudders");
    }

    #[test]
    fn a_formula_of_other_names_is_refused() {
        let text = include_str!("../../../../../models/laws/differential-thrust.yaml");
        let wrong = text.replace("n*(1 + delta", "n*(1 + u*delta");
        let error = Law::parse("law", &wrong).unwrap_err().to_string();
        assert!(error.contains("inputs.n_p"), "{error}");
    }
}
