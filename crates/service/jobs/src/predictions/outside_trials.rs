//! Wind, current and depth of a request of which the model's trials tell nothing.

use serde_json::{Value, json};
use sistership_model::environment::UncoveredInput;

/// An answer that names them, where there are any.
pub(crate) fn with_outside_trials(mut answer: Value, uncovered: &[UncoveredInput]) -> Value {
    if !uncovered.is_empty() {
        answer["outside_trials"] = json!(uncovered);
    }
    answer
}
