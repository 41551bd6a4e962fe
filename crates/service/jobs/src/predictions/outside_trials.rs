//! Wind, current and depth of a request that the model's trials do not cover.

use serde_json::{Value, json};
use sistership_model::environment::UncoveredInput;

/// Adds them to an answer, if there are any.
pub(crate) fn with_outside_trials(mut answer: Value, uncovered: &[UncoveredInput]) -> Value {
    if !uncovered.is_empty() {
        answer["outside_trials"] = json!(uncovered);
    }
    answer
}
