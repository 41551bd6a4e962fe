//! Classes of condition in words.

use sistership_jobs::search::urgency::UrgencyClass;

/// Returns a class of condition in words.
pub(crate) fn class_label(class: UrgencyClass) -> &'static str {
    match class {
        UrgencyClass::DoesNotHold => "does not hold",
        UrgencyClass::Unknown => "not diagnosed",
        UrgencyClass::NoModel => "no model",
        UrgencyClass::Holds => "holds",
    }
}
