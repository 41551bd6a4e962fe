//! Application of effects to a law. The result is a law, so that every consumer of laws accepts it.

use super::form::EffectForm;
use crate::law::{Law, LawInput, LawParameter, STATES};
use crate::particulars::{self, Particulars};
use crate::trial::Channel;
use sistership_formula::Expr;

/// Name of an effect's parameter (or value) in a law that includes the effect.
pub fn qualified_name(effect: &str, form: &str, name: &str) -> String {
    format!("{effect}/{form}.{name}")
}

/// Name of the input for a recorded channel that is a state of some laws.
fn recorded_input(channel: &str) -> String {
    format!("recorded.{channel}")
}

/// Returns the channel that records an input of a law, if any.
pub fn input_channel(input: &str) -> Option<Channel> {
    Channel::by_name(input.strip_prefix("recorded.").unwrap_or(input))
}

/// The input for the time since the start of the trial, s; effects call it `t`, which laws may use
/// for the thrust deduction.
pub const TIME_INPUT: &str = "recorded.t";

/// Returns a law with forms of effects, each at its absence, for a ship of these particulars; the
/// speed is the approach speed of the model's trials.
pub fn apply_effects(
    law: &Law,
    particulars: &Particulars,
    speed_m_s: Option<f64>,
    forms: &[(&str, &EffectForm)],
) -> Law {
    let mut dressed = law.clone();
    // Effects on the inflow are applied before forces are added: an added force depends on the
    // motion over the ground.
    let (inflow, others): (Vec<_>, Vec<_>) =
        forms.iter().partition(|(_, form)| !form.sees.is_empty());
    for (effect, form) in inflow.into_iter().chain(others) {
        EffectApplier { effect, form, particulars, speed_m_s, has_roll: law.has_roll() }
            .apply_effect(&mut dressed);
    }
    dressed
}

struct EffectApplier<'a> {
    effect: &'a str,
    form: &'a EffectForm,
    particulars: &'a Particulars,
    /// Approach speed; the service speed is the default.
    speed_m_s: Option<f64>,
    has_roll: bool,
}

impl EffectApplier<'_> {
    fn apply_effect(&self, law: &mut Law) {
        self.add_inputs(law);
        self.add_parameters(law);
        for (name, expr) in &self.form.values {
            law.add_value(self.qualified_name(name), self.qualify_expr(expr));
        }
        // The law uses the replacement, whose own formula uses the original name.
        for (name, expr) in &self.form.sees {
            let seen = format!("{}/{}.seen.{name}", self.effect, self.form.file.name);
            law.rename_in_forces(name, &seen);
            law.add_value(seen, self.qualify_expr(expr));
        }
        for (axis, expr) in &self.form.forces {
            if let Some(axis) = law.axes.get_mut(axis) {
                axis.rest =
                    Expr::Add(Box::new(axis.rest.clone()), Box::new(self.qualify_expr(expr)));
            }
        }
        law.dressing
            .accelerations
            .extend(self.form.accelerates.iter().map(|(axis, e)| (*axis, self.qualify_expr(e))));
        law.dressing.coefficients.extend(
            self.form.coefficients.iter().map(|(name, e)| (name.clone(), self.qualify_expr(e))),
        );
        law.dressing
            .lags
            .extend(self.form.lags.iter().map(|(name, e)| (name.clone(), self.qualify_expr(e))));
        law.dressing
            .bands
            .extend(self.form.bands.iter().map(|(name, e)| (name.clone(), self.qualify_expr(e))));
        law.dressing
            .measures
            .extend(self.form.measures.iter().map(|(channel, e)| (*channel, self.qualify_expr(e))));
    }

    fn add_parameters(&self, law: &mut Law) {
        for (name, parameter) in &self.form.parameters {
            let unit =
                self.form.file.parameters.get(name).map(|p| p.unit.clone()).unwrap_or_default();
            let meaning = format!("{name} of {}", self.effect);
            let known = LawParameter {
                dimension: parameter.dimension,
                unit,
                meaning,
                from: None,
                is_approach_speed: false,
                prior: None,
            };
            law.parameters.insert(self.qualified_name(name), known);
            // The effect is absent until the values of a model are set.
            law.dressing.parameters.insert(self.qualified_name(name), parameter.absent);
        }
        for (name, expr) in &self.form.particulars {
            law.add_value(self.qualified_name(name), self.qualify_expr(expr));
        }
    }

    /// Adds channels that the law does not use yet as inputs; their defaults mean no wind, no roll,
    /// deep water.
    fn add_inputs(&self, law: &mut Law) {
        let mentioned = self.form.acting_formulas().flat_map(|expr| {
            expr.mentioned_names().into_iter().map(str::to_owned).collect::<Vec<_>>()
        });
        for name in mentioned.collect::<Vec<_>>() {
            let input = self.input_name(&name);
            let channel = input_channel(&input);
            let dimension = if input == TIME_INPUT {
                Some(sistership_formula::units::Dimension::TIME)
            } else {
                channel.map(Channel::dimension)
            };
            // States and positions are simulated: they are not inputs.
            let is_state =
                STATES.iter().any(|(state, _)| *state == input) || input == "x" || input == "y";
            let (Some(dimension), false) = (dimension, is_state || law.inputs.contains_key(&input))
            else {
                continue;
            };
            // Infinite depth means deep water.
            let still = if channel == Some(Channel::Depth) { f64::INFINITY } else { 0.0 };
            law.inputs.insert(input, LawInput { dimension, default: Some(still), helm: None });
        }
    }

    /// Name of an input; roll is a recorded input where the law does not simulate it.
    fn input_name(&self, name: &str) -> String {
        let is_recorded = name == "t" || !self.has_roll && (name == "phi" || name == "p");
        if is_recorded { recorded_input(name) } else { name.to_owned() }
    }

    fn qualified_name(&self, name: &str) -> String {
        qualified_name(self.effect, &self.form.file.name, name)
    }

    fn qualify_expr(&self, expr: &Expr) -> Expr {
        expr.replace_names(&|name| self.replacement_for(name))
    }

    fn replacement_for(&self, name: &str) -> Option<Expr> {
        let form = self.form;
        // The formula of a particular is used only if the ship does not state it.
        let stands_in = form.particulars.contains_key(name) && !self.particulars.contains_key(name);
        if name == "approach_speed_m_s" {
            let service = particulars::particular_value(self.particulars, "service_speed_m_s");
            return Some(Expr::Number(self.speed_m_s.or(service).unwrap_or(1.0)));
        }
        let own = form.parameters.contains_key(name) || form.values.contains_key(name) || stands_in;
        let renamed = if own { self.qualified_name(name) } else { self.input_name(name) };
        (renamed != name).then_some(Expr::Name(renamed))
    }
}

impl Law {
    /// Replaces a state or an input by another name in all formulas of forces; kinematics keep the
    /// original name.
    pub(crate) fn rename_in_forces(&mut self, name: &str, by: &str) {
        let rename = |expr: &mut Expr| {
            *expr = expr.replace_names(&|found| (found == name).then(|| Expr::Name(by.to_owned())))
        };
        self.values.values_mut().for_each(rename);
        self.factors.values_mut().for_each(rename);
        self.mass.values_mut().for_each(rename);
        for axis in self.axes.values_mut() {
            axis.terms.values_mut().for_each(rename);
            rename(&mut axis.scale);
            rename(&mut axis.rest);
        }
        self.dressing.straight.iter_mut().for_each(|straight| straight.follow_rename(name, by));
    }
}
