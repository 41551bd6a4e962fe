//! What shapes the rows of a ship's regressions.

use std::collections::BTreeMap;

use sistership_identification::refine::{Blocks, RefineError};
use sistership_model::quantity::Quantity;
use sistership_model::version::sha256;
use sistership_model::{Law, Model};

use super::beside::BesideLaw;

/// The format of [`TrialStatistics`](super::TrialStatistics).
pub const FORMAT: &str = "sistership-statistics/1";

/// The regressions of a model with its effects, without the values of its coefficients: two models
/// that differ in those only have one frame, unless they have a learned correction.
#[derive(Debug, Clone)]
pub struct Frame {
    /// Time over which accelerations are differenced, s.
    pub difference_s: f64,
    pub(super) blocks: Blocks,
    /// What was learned beside the law.
    pub(super) beside: Option<BesideLaw>,
    /// Everything that shapes a row, as text.
    shape: String,
}

impl Frame {
    /// Of a model by the law whose file has the hash `law_sha256`. Without `difference_s`, a tenth
    /// of the time in which the ship sails its length.
    ///
    /// # Errors
    /// Names what the model does not give: the weights of a learned correction among it.
    pub fn new(
        model: &Model,
        law: &Law,
        law_sha256: &str,
        difference_s: Option<f64>,
    ) -> Result<Self, RefineError> {
        let dressed = law
            .with_effects(model)
            .map_err(|(field, message)| RefineError::Law(format!("{field}: {message}")))?;
        let difference_s = difference_s.or_else(|| tenth_of_a_length(model)).ok_or_else(|| {
            let message = format!("`{}` has no length or speed from which to take it", model.name);
            RefineError::Setting { field: "difference_s".into(), message }
        })?;
        Ok(Self {
            difference_s,
            blocks: Blocks::new(model, &dressed)?,
            beside: BesideLaw::new(model, law)?,
            shape: shape(model, law_sha256, difference_s),
        })
    }

    /// What the statistics of a trial, named by the hash of its samples, are kept under.
    pub fn key(&self, trial_sha256: &str) -> String {
        sha256(format!("{trial_sha256}\n{}", self.shape).as_bytes())
    }
}

fn tenth_of_a_length(model: &Model) -> Option<f64> {
    let length = model.particulars.get("lpp_m")?.value;
    model.speed_m_s.filter(|speed| *speed > 0.0).map(|speed| 0.1 * length / speed)
}

/// The debug form of a double is the shortest text that reads back as the same one.
fn shape(model: &Model, law_sha256: &str, difference_s: f64) -> String {
    let mut text = format!("{FORMAT}\n{law_sha256}\npublished {difference_s:?}\n");
    let mut write = |title: &str, values: &BTreeMap<String, Quantity>| {
        text.push_str(title);
        values
            .iter()
            .for_each(|(name, quantity)| text.push_str(&format!(" {name}={:?}", quantity.value)));
        text.push('\n');
    };
    write("particulars", &model.particulars);
    write("parameters", &model.parameters);
    for effect in &model.effects {
        let form = format!("effect {}/{}", effect.name, effect.form.name);
        write(&form, &effect.parameters);
    }
    if let Some(branch) = &model.branch {
        // What a correction is told of the law depends on the coefficients, too.
        write(&format!("correction {}", branch.weights_sha256), &model.coefficients);
    }
    text.push_str(&model.coefficients.keys().map(String::as_str).collect::<Vec<_>>().join(" "));
    text
}
