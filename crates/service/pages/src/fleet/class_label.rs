//! Classes of condition in words.

use sistership_jobs::search::urgency::UrgencyClass;

use crate::language::say_word;

/// Returns a class of condition in words.
pub(crate) fn class_label(class: UrgencyClass) -> String {
    say_word("condition-class", class.name())
}
