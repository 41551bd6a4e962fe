//! Number of unknowns of a hybrid: Miyauchi 2024, Eq. 34 and Table 4.

use serde::Serialize;

use super::derivation::LawDerivation;
use super::file::EffectUse;
use super::rules::SelectionStep;
use crate::Zoo;

/// Unknowns of a derived law, rule by rule.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct UnknownCounts {
    /// Number of terms after each rule.
    pub rules: Vec<RuleCount>,
    /// Number of sets of coefficients: the shared one and those of the submodels.
    pub coefficient_sets: usize,
    /// Number of coefficients in all sets.
    pub coefficients: usize,
    /// Parameters that do not follow from particulars: added masses and the moment of inertia.
    pub parameters: Vec<String>,
    /// Parameters of the effects used with the law.
    pub effects: Vec<EffectUnknowns>,
    /// Total number of unknowns.
    pub unknowns: usize,
}

/// Number of terms by axis after a rule.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RuleCount {
    /// The rule.
    pub rule: &'static str,
    /// Its setting in words.
    pub setting: String,
    /// Terms of the surge force.
    #[serde(rename = "X")]
    pub x: usize,
    /// Terms of the sway force.
    #[serde(rename = "Y")]
    pub y: usize,
    /// Terms of the yaw moment.
    #[serde(rename = "N")]
    pub n: usize,
    /// Sum over the axes.
    pub total: usize,
}

/// Unknowns of an effect.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct EffectUnknowns {
    /// The effect.
    pub effect: String,
    /// Its form.
    pub form: String,
    /// Number of its parameters.
    pub unknowns: usize,
}

impl LawDerivation {
    /// Counts the unknowns; `zoo` supplies the effects.
    ///
    /// # Errors
    /// Returns the field of the declaration that names an effect or form that is not in the zoo,
    /// and the known ones.
    pub fn count_unknowns(&self, zoo: &Zoo) -> Result<UnknownCounts, (String, String)> {
        let effects = self.effect_unknowns(zoo)?;
        let parameters: Vec<String> = self
            .law
            .parameters
            .iter()
            .filter(|(_, parameter)| parameter.from.is_none())
            .map(|(name, _)| name.clone())
            .collect();
        let coefficients = self.law.coefficient_names().len();
        let of_effects: usize = effects.iter().map(|effect| effect.unknowns).sum();
        Ok(UnknownCounts {
            rules: self.rule_counts(),
            coefficient_sets: 1 + self.law.submodels.len(),
            coefficients,
            unknowns: coefficients + parameters.len() + of_effects,
            parameters,
            effects,
        })
    }

    fn rule_counts(&self) -> Vec<RuleCount> {
        let count = |step: &SelectionStep| {
            let [x, y, n] = step.terms;
            RuleCount { rule: step.rule, setting: step.setting.clone(), x, y, n, total: x + y + n }
        };
        self.steps.iter().map(count).collect()
    }

    fn effect_unknowns(&self, zoo: &Zoo) -> Result<Vec<EffectUnknowns>, (String, String)> {
        let one = |used: &EffectUse| {
            let fault = |message| ("effects".to_owned(), message);
            let names =
                || zoo.effects().map(|effect| effect.name.clone()).collect::<Vec<_>>().join(", ");
            let effect = zoo.effect(&used.effect);
            let effect = effect.ok_or_else(|| {
                fault(format!("there is no effect `{}`; choose one of {}", used.effect, names()))
            })?;
            let forms = || {
                effect
                    .forms
                    .iter()
                    .map(|form| form.file.name.clone())
                    .collect::<Vec<_>>()
                    .join(", ")
            };
            let form = effect.forms.iter().find(|form| form.file.name == used.form);
            let form = form.ok_or_else(|| {
                fault(format!("`{}` has no form `{}`; it has {}", used.effect, used.form, forms()))
            })?;
            Ok(EffectUnknowns {
                effect: used.effect.clone(),
                form: used.form.clone(),
                unknowns: form.parameters.len(),
            })
        };
        self.file.effects.iter().map(one).collect()
    }
}
