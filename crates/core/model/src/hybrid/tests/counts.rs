//! The unknowns of Miyauchi 2024, Table 4.

use super::super::UnknownCounts;
use super::{PRINTED, vectwin};
use crate::Zoo;

const WIND: &str = "effects: [{ effect: wind, form: measured }]\n";

fn count(order: u32, scheme: &str, rules: &str) -> UnknownCounts {
    let zoo = Zoo::load_embedded().unwrap();
    vectwin(order, &format!("submodels: {scheme}\n{WIND}{rules}")).count_unknowns(&zoo).unwrap()
}

#[test]
fn the_counts_of_table_4() {
    let table = [
        (2, "ahead_astern", 133),
        (2, "ahead_stalled_astern", 193),
        (2, "ahead_astern_stalled", 253),
        (3, "ahead_astern", 413),
        (3, "ahead_stalled_astern", 613),
    ];
    for (order, scheme, unknowns) in table {
        assert_eq!(count(order, scheme, PRINTED).unknowns, unknowns, "order {order}, {scheme}");
    }
}

/// At third order the counts of Table 4 need the squares of the starboard cosine that Eqs. 15 and
/// 16 print and that modification B, as the text has it, drops: four terms on Y and on N.
#[test]
fn the_text_alone_gives_other_counts_at_third_order() {
    for (scheme, described, printed) in
        [("ahead_astern", 397, 413), ("ahead_stalled_astern", 589, 613)]
    {
        assert_eq!(count(3, scheme, "").unknowns, described);
        assert_eq!(count(3, scheme, PRINTED).unknowns, printed);
    }
    assert_eq!(count(2, "ahead_astern_stalled", "").unknowns, 253);
}

#[test]
fn the_count_is_the_sum_of_its_parts() {
    let unknowns = count(2, "ahead_stalled_astern", "");
    assert_eq!((unknowns.coefficient_sets, unknowns.coefficients), (3, 180));
    assert_eq!(unknowns.parameters, ["m_x", "m_y", "I_zz_plus_J_zz"]);
    assert_eq!(unknowns.effects.iter().map(|effect| effect.unknowns).collect::<Vec<_>>(), [10]);
    let by_rule: Vec<[usize; 4]> =
        unknowns.rules.iter().map(|rule| [rule.x, rule.y, rule.n, rule.total]).collect();
    assert_eq!(by_rule[0], [45, 45, 45, 135]);
    assert_eq!(by_rule[1], [44, 44, 44, 132]);
    assert_eq!(by_rule.last(), Some(&[20, 20, 20, 60]));
}

#[test]
fn an_effect_that_is_not_there_is_named() {
    let zoo = Zoo::load_embedded().unwrap();
    let fault = |uses: &str| {
        vectwin(1, &format!("effects: [{uses}]\n")).count_unknowns(&zoo).unwrap_err().1
    };
    assert!(fault("{ effect: wnd, form: measured }").contains("choose one of current"));
    assert!(
        fault("{ effect: wind, form: guessed }").contains("it has measured, unrecorded, constant")
    );
}
