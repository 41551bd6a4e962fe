//! Model: a law with coefficients for one ship, in canonical signs, as it is stored, exchanged and
//! simulated.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::branch::CorrectionDocument;
use crate::effect::{AppliedEffect, EffectForm, apply_effects, qualified_name};
use crate::error::{ErrorContext, FileError};
use crate::law::limits::check_count;
use crate::law::{Law, MAX_COEFFICIENTS, MAX_EFFECTS};
use crate::manifest::RudderSign;
use crate::particulars::{self, Particulars};
use crate::posterior::Posterior;
use crate::propulsion::Propulsion;
use crate::quantity::Quantity;
use crate::source::Source;
use crate::uncertainty::Uncertainty;
use crate::validity::Region;
use crate::vessel::{PublishedModelFile, Status, Steering, Vessel};

/// A model document. Positive rudder turns the ship to starboard; parameters and coefficients are
/// in the law's units.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Model {
    /// Always `model`.
    pub kind: ModelKind,
    /// Its name, `ship/model`.
    pub name: String,
    /// The ship of the model.
    pub ship: String,
    /// The law of motion.
    pub law: String,
    /// Origin of its figures.
    pub status: Status,
    /// A remark.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub note: Option<String>,
    /// Publications by key.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub sources: BTreeMap<String, Source>,
    /// The approach speed to which it belongs, m/s.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub speed_m_s: Option<f64>,
    /// The propeller revolutions at that speed, 1/s.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub revolutions_rps: Option<f64>,
    /// The share of these revolutions that the engine loses by the share of the speed that a
    /// manoeuvre takes, at the same order: 0 for a governor, 1 at a constant advance ratio.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub revolutions_loss: Option<f64>,
    /// The steering gear.
    #[serde(default)]
    pub steering: Steering,
    /// Particulars of the ship, SI.
    pub particulars: Particulars,
    /// Nonlinear parameters of the law.
    pub parameters: BTreeMap<String, Quantity>,
    /// Coefficients of the law.
    pub coefficients: BTreeMap<String, Quantity>,
    /// Effects that change the law from outside.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub effects: Vec<AppliedEffect>,
    /// Information of the coefficients and remaining discrepancy of the fit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub uncertainty: Option<Uncertainty>,
    /// Joint uncertainty of the coefficients.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub posterior: Option<Posterior>,
    /// The motion that its trials covered.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub validity: Option<Region>,
    /// Resistance and thrust outside the range covered by its trials.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub propulsion: Option<Propulsion>,
    /// Learned correction of the law; its weights are stored separately, under the hash that it
    /// names.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub branch: Option<CorrectionDocument>,
}

/// The word `model`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum ModelKind {
    /// The only one.
    Model,
}

/// Source key of parameters that follow from particulars by the law's own formula.
pub const DERIVED_SOURCE: &str = "derived-from-particulars";

impl Model {
    /// Reads and checks a model document against its law.
    ///
    /// # Errors
    /// Returns an error with file, line and field of the first fault.
    pub fn parse(
        file: &str,
        text: &str,
        law_of: &dyn Fn(&str) -> Option<Law>,
    ) -> Result<Self, FileError> {
        let blame = ErrorContext::new(file, text);
        let model: Self = blame.deserialize()?;
        let law = law_of(&model.law).ok_or_else(|| {
            blame.field_error("law", format!("the law `{}` is not in the zoo", model.law))
        })?;
        particulars::check_particulars(&model.particulars)
            .map_err(|(name, e)| blame.field_error(&format!("particulars.{name}"), e))?;
        model.check_against(&law).map_err(|(field, e)| blame.field_error(&field, e))?;
        Ok(model)
    }

    /// Creates a published model of a vessel, converted to canonical signs; by default its first
    /// one.
    ///
    /// # Errors
    /// Returns an error that names the model, parameter or coefficient that is missing or unknown.
    pub fn from_published(
        vessel: &Vessel,
        name: Option<&str>,
        law: &Law,
    ) -> Result<Self, FileError> {
        // The text of the vessel is not available here, so that errors have no line.
        let blame = ErrorContext::new(vessel.name(), "");
        let raw = find_published_file(vessel, name).map_err(|e| blame.field_error("models", e))?;
        let path = |section: &str| format!("models.{}.{section}", raw.name);
        let keys = vessel.source_keys();
        let section = |what: &str, section: &crate::quantity::Section| {
            section
                .resolve_values(&keys)
                .map_err(|(name, e)| blame.field_error(&format!("{}.{name}", path(what)), e))
        };
        let mut model = Self {
            kind: ModelKind::Model,
            name: format!("{}/{}", vessel.name(), raw.name),
            ship: vessel.name().to_owned(),
            law: raw.law.clone(),
            status: raw.status,
            note: raw.note.clone(),
            sources: vessel.file.sources.clone(),
            speed_m_s: raw.speed_m_s,
            revolutions_rps: raw.revolutions_rps,
            revolutions_loss: None,
            steering: raw.steering.clone(),
            particulars: vessel.particulars.clone(),
            parameters: section("parameters", &raw.parameters)?,
            coefficients: section("coefficients", &raw.coefficients)?,
            effects: Vec::new(),
            uncertainty: None,
            posterior: None,
            validity: None,
            propulsion: None,
            branch: None,
        };
        // Parameters are completed before the check, and the check precedes the change of signs,
        // which needs known names.
        model.complete_parameters(law);
        model
            .check_against(law)
            .map_err(|(field, e)| blame.field_error(&format!("models.{}.{field}", raw.name), e))?;
        if vessel.file.conventions.rudder_positive == RudderSign::PortTurn {
            model.flip_rudder(law);
        }
        Ok(model)
    }

    /// Transfers this model to another ship: the same coefficients in the law's own scaling, the
    /// particulars of that ship, and every parameter that the law derives from particulars
    /// recomputed for it. `approach_speed_m_s` replaces the speed about which the law is expanded,
    /// which belongs to the trials.
    pub fn transfer_to(
        &self,
        law: &Law,
        ship: &str,
        particulars: &Particulars,
        approach_speed_m_s: Option<f64>,
    ) -> Self {
        let mut model = self.clone();
        model.name = format!("{ship}/{}", self.law);
        model.ship = ship.to_owned();
        model.status = Status::Transferred;
        model.note = Some(format!("transferred from {}", self.name));
        model.particulars = particulars.clone();
        // Effects and uncertainty belong to the trials of the source model.
        model.effects = Vec::new();
        (model.uncertainty, model.posterior, model.validity) = (None, None, None);
        (model.propulsion, model.branch, model.revolutions_loss) = (None, None, None);
        for name in law.parameters.keys() {
            if let Some(value) = law.derived_parameter(name, particulars) {
                model.parameters.insert(name.clone(), Quantity::new(value, DERIVED_SOURCE));
            }
        }
        if let Some(speed) = approach_speed_m_s {
            model.set_approach_speed(law, speed);
        }
        model
    }

    /// Returns the model without its learned correction.
    pub fn without_correction(&self) -> Self {
        Self { branch: None, ..self.clone() }
    }

    /// Sets the speed about which the law is expanded, m/s.
    pub fn set_approach_speed(&mut self, law: &Law, speed_m_s: f64) {
        self.speed_m_s = Some(speed_m_s);
        if let Some(name) = law.approach_speed_parameter() {
            self.parameters.insert(name.to_owned(), Quantity::new(speed_m_s, "approach-speed"));
        }
    }

    /// Value of a coefficient; zero if the model does not have it.
    pub fn coefficient(&self, name: &str) -> f64 {
        self.coefficients.get(name).map_or(0.0, |quantity| quantity.value)
    }

    /// Coefficient or parameter of that name.
    pub fn named_value(&self, name: &str) -> Option<&Quantity> {
        self.coefficients.get(name).or_else(|| self.parameters.get(name))
    }

    /// Coefficient or parameter of that name, to be changed.
    pub fn named_value_mut(&mut self, name: &str) -> Option<&mut Quantity> {
        let Self { coefficients, parameters, .. } = self;
        coefficients.get_mut(name).or_else(|| parameters.get_mut(name))
    }

    /// Joint uncertainty of the coefficients; `None` if they have changed since they were
    /// estimated.
    pub fn valid_posterior(&self) -> Option<&Posterior> {
        self.posterior
            .as_ref()
            .filter(|p| p.belongs_to(|name| self.named_value(name).map(|quantity| quantity.value)))
    }

    /// Checks that the law has every name and that every parameter has a value.
    ///
    /// # Errors
    /// Returns the field at fault and the reason.
    pub fn check_against(&self, law: &Law) -> Result<(), (String, String)> {
        check_count("coefficients", self.coefficients.len(), MAX_COEFFICIENTS)?;
        for name in self.coefficients.keys() {
            law.scaled_regressor(name)
                .map_err(|e| (format!("coefficients.values.{name}"), e.to_string()))?;
        }
        let unknown = self.parameters.keys().find(|name| !law.parameters.contains_key(*name));
        if let Some(name) = unknown {
            let known: Vec<&str> = law.parameters.keys().map(String::as_str).collect();
            let message =
                format!("law `{}` has no such parameter; it has {}", law.name, known.join(", "));
            return Err((format!("parameters.values.{name}"), message));
        }
        let values = self.parameters.iter().chain(&self.coefficients);
        if let Some((name, quantity)) =
            values.into_iter().find(|(_, quantity)| !quantity.value.is_finite())
        {
            return Err((
                format!("values.{name}"),
                format!("{} is not a finite number", quantity.value),
            ));
        }
        if let Some((name, parameter)) =
            law.parameters.iter().find(|(name, _)| !self.parameters.contains_key(*name))
        {
            return Err((
                format!("parameters.values.{name}"),
                missing_parameter_message(name, parameter),
            ));
        }
        if self.revolutions_loss.is_some_and(|loss| !(0.0..=1.0).contains(&loss)) {
            return Err(("revolutions_loss".to_owned(), "give a share from 0 to 1".to_owned()));
        }
        if let Some(uncertainty) = &self.uncertainty {
            uncertainty.check_lists().map_err(|e| ("uncertainty".to_owned(), e.to_string()))?;
        }
        if let Some(posterior) = &self.posterior {
            posterior.check_lists().map_err(|e| ("posterior".to_owned(), e.to_string()))?;
        }
        if let Some(region) = &self.validity {
            region.check_bounds().map_err(|e| ("validity".to_owned(), e.to_string()))?;
        }
        if let Some(branch) = &self.branch {
            branch.check_document().map_err(|e| ("branch".to_owned(), e.to_string()))?;
        }
        law.with_effects(self).map(|_| ())
    }

    fn complete_parameters(&mut self, law: &Law) {
        for (name, parameter) in &law.parameters {
            if self.parameters.contains_key(name) {
                continue;
            }
            // The approach speed belongs to the model; other parameters follow from particulars.
            let value = if parameter.is_approach_speed { self.speed_m_s } else { None };
            let value = value.or_else(|| law.derived_parameter(name, &self.particulars));
            if let Some(value) = value {
                self.parameters.insert(name.clone(), Quantity::new(value, DERIVED_SOURCE));
            }
        }
    }

    /// Converts coefficients with positive rudder to port to canonical signs.
    fn flip_rudder(&mut self, law: &Law) {
        let odd = law.odd_factors_in_rudder().collect();
        for (name, quantity) in &mut self.coefficients {
            if law.is_odd_in(name, &odd) {
                quantity.value = -quantity.value;
            }
        }
    }
}

impl Law {
    /// Returns this law with the propulsion and the effects of a model.
    ///
    /// # Errors
    /// Returns the field of the model at fault and the reason.
    pub fn with_effects(&self, model: &Model) -> Result<Self, (String, String)> {
        check_count("effects", model.effects.len(), MAX_EFFECTS)?;
        let mut forms = Vec::new();
        for effect in &model.effects {
            let field = |(field, message): (String, String)| {
                (format!("effects.{}.{field}", effect.name), message)
            };
            forms.push((effect, effect.checked_form().map_err(field)?));
        }
        let listed: Vec<(&str, &EffectForm)> =
            forms.iter().map(|(effect, form)| (effect.name.as_str(), form)).collect();
        // Propulsion comes first: effects act on the law that includes it.
        let propelled = model.propulsion.as_ref().map(|own| self.with_propulsion(own));
        let propelled = propelled.transpose()?;
        let mut law = propelled.as_ref().unwrap_or(self).with_forms(model, &listed);
        if !listed.is_empty() || model.propulsion.is_some() {
            law.check_depth().map_err(|message| ("effects".to_owned(), message))?;
        }
        // The forms were added at their absence; the parameters get the values of the model here.
        for (effect, _) in &forms {
            for (name, quantity) in &effect.parameters {
                law.dressing
                    .parameters
                    .insert(qualified_name(&effect.name, &effect.form.name, name), quantity.value);
            }
        }
        Ok(law)
    }

    /// Returns this law with forms of effects at the absence of each; `model` gives the
    /// particulars.
    pub fn with_forms(&self, model: &Model, forms: &[(&str, &EffectForm)]) -> Self {
        apply_effects(self, &model.particulars, model.speed_m_s, forms)
    }
}

fn missing_parameter_message(name: &str, parameter: &crate::law::LawParameter) -> String {
    let derivation = match &parameter.from {
        Some(from) => format!(
            " or the particulars from which it is derived: {}",
            from.mentioned_names().into_iter().collect::<Vec<_>>().join(", ")
        ),
        None => String::new(),
    };
    format!("give `{name}` ({}, unit {}){derivation}", parameter.meaning, parameter.unit)
}

fn find_published_file<'a>(
    vessel: &'a Vessel,
    name: Option<&str>,
) -> Result<&'a PublishedModelFile, String> {
    let models = &vessel.file.models;
    if models.is_empty() {
        return Err(format!(
            "`{}` has particulars only and no model; refine a source model against its trials",
            vessel.name()
        ));
    }
    let Some(name) = name else { return Ok(&models[0]) };
    models.iter().find(|model| model.name == name).ok_or_else(|| {
        let known: Vec<&str> = models.iter().map(|model| model.name.as_str()).collect();
        format!("`{}` has no model `{name}`; it has {}", vessel.name(), known.join(", "))
    })
}
