//! A few cases of the confusion table, which `--example hidden_effects` prints whole.

use sistership_tests::hidden_effects::confusion::named;

#[test]
fn a_weak_current_is_named() {
    assert_eq!(named("current", 0.3).first().map(String::as_str), Some("current"));
}

#[test]
fn an_askew_rudder_is_named() {
    assert_eq!(named("rudder-offset", 0.3).first().map(String::as_str), Some("rudder-offset"));
}

#[test]
fn nothing_is_named_where_nothing_is_hidden() {
    assert_eq!(named("clean", 1.0), Vec::<String>::new());
}
