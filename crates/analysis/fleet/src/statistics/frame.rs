//! Frame of the statistics of a ship: everything that determines the rows of its regressions.

use std::collections::BTreeMap;

use sistership_identification::refine::{RefineError, RegressionBlocks};
use sistership_model::quantity::Quantity;
use sistership_model::version::sha256_hex;
use sistership_model::{Law, Model};

use super::correction_additions::CorrectedLaw;

/// Format of [`TrialStatistics`](super::TrialStatistics).
pub const FORMAT: &str = "sistership-statistics/1";

/// Regressions of a model with its effects, without the values of its coefficients: two models that
/// differ only in these have the same frame, unless they have a learned correction.
#[derive(Debug, Clone)]
pub struct RegressionFrame {
    /// Time over which accelerations are differenced, s.
    pub difference_s: f64,
    pub(super) blocks: RegressionBlocks,
    /// Learned correction, if the model has one.
    pub(super) beside: Option<CorrectedLaw>,
    /// Everything that determines a row, as text.
    shape: String,
}

impl RegressionFrame {
    /// Creates the frame of a model under the law whose file has the hash `law_sha256`. The default
    /// of `difference_s` is a tenth of the time in which the ship travels its length.
    ///
    /// # Errors
    /// Returns an error that names the missing part of the model, such as the weights of a learned
    /// correction.
    pub fn new(
        model: &Model,
        law: &Law,
        law_sha256: &str,
        difference_s: Option<f64>,
    ) -> Result<Self, RefineError> {
        let dressed = law
            .with_effects(model)
            .map_err(|(field, message)| RefineError::Law(format!("{field}: {message}")))?;
        // The default is part of the frame, so that the key contains its value.
        let difference_s = difference_s.or_else(|| tenth_of_a_length(model)).ok_or_else(|| {
            let message = format!(
                "`{}` has no length or speed from which it could be derived; \
                                   give it",
                model.name
            );
            RefineError::Setting { field: "difference_s".into(), message }
        })?;
        Ok(Self {
            difference_s,
            blocks: RegressionBlocks::new(model, &dressed)?,
            beside: CorrectedLaw::new(model, law)?,
            shape: frame_text(model, law_sha256, difference_s),
        })
    }

    /// Key of the statistics of a trial, which is named by the hash of its samples.
    pub fn statistics_key(&self, trial_sha256: &str) -> String {
        sha256_hex(format!("{trial_sha256}\n{}", self.shape).as_bytes())
    }
}

fn tenth_of_a_length(model: &Model) -> Option<f64> {
    let length = model.particulars.get("lpp_m")?.value;
    model.speed_m_s.filter(|speed| *speed > 0.0).map(|speed| 0.1 * length / speed)
}

/// Text of everything that determines a row. The debug form of a double is the shortest text that
/// reads back as the same one.
fn frame_text(model: &Model, law_sha256: &str, difference_s: f64) -> String {
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
    // The weights are named by their hash.
    if let Some(branch) = &model.branch {
        // The inputs of a correction may include the law's accelerations, which depend on the
        // coefficients.
        write(&format!("correction {}", branch.weights_sha256), &model.coefficients);
    }
    text.push_str(&model.coefficients.keys().map(String::as_str).collect::<Vec<_>>().join(" "));
    text
}
