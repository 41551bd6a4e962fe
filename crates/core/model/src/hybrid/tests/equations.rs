//! Term by term against Miyauchi 2024, Eqs. 13 to 16. Eq. 13 lists the coefficients of the
//! regressors of Eq. 14, and Eq. 16 the regressors of the coefficients of Eq. 15; those for N are
//! said to be as those for Y. Transcribed are Eqs. 14 and 15: of the other two our copy shows too
//! little. Three terms of Eq. 15 are determined by their neighbours (decision 6).

use std::collections::BTreeSet;

use super::{PRINTED, names, vectwin};
use crate::coefficient::Axis;

/// Eqs. 13 and 14 up to the second order, with S, C for sine and cosine of the starboard rudder and
/// s, c of the port one.
const EVEN_2: &str = "u C c n u|u| uC uc un vv vr vS vs rr rS rs Ss Cc Cn cn n|n|";

/// The third order of Eqs. 13 and 14, in their order.
const EVEN_3: &str = "uuu uvv uvr urr uvS urS u|u|C vvC vrC vSC rrC rSC uvs urs uSs vCs rCs SCs \
                      u|u|c uCc vvc vrc vSc vsc rrc rSc rsc Ssc u|u|n uCn ucn un|n| vvn vrn vSn \
                      vsn rrn rSn rsn Ssn Ccn Cn|n| cn|n| nnn";

/// Eqs. 15 and 16 up to the second order.
const ODD_2: &str = "v r S s uv ur uS us vC vc vn rC rc rn SC Sc Sn Cs sc sn";

/// The third order of Eqs. 15 and 16, in their order.
const ODD_3: &str = "uuv vvv uur v|v|r vr|r| rrr uuS v|v|S vrS r|r|S uvC urC uSC vCC rCC SCC uus \
                     uCs v|v|s vrs vSs r|r|s rSs CCs uvc urc uSc usc vCc rCc SCc Csc uvn urn uSn \
                     usn vCn vcn vnn rCn rcn rnn SCn Scn Snn Csn scn snn";

/// The printed terms in this project's spelling.
fn spelled(printed: &str) -> BTreeSet<String> {
    let terms: Vec<&str> = printed.split_whitespace().collect();
    let names: BTreeSet<String> = terms.iter().map(|term| spell(term)).collect();
    assert_eq!(names.len(), terms.len(), "a term is transcribed twice");
    names
}

fn spell(term: &str) -> String {
    let letters: Vec<char> = term.chars().collect();
    let mut factors: Vec<(usize, bool, &str)> = Vec::new();
    let mut bars = 0;
    for letter in letters {
        match letter {
            '|' => bars += 1,
            letter => {
                let place = "uvrnSCsc".find(letter).unwrap();
                factors.push((place, bars % 2 == 1, SYMBOLS[place]));
            }
        }
    }
    factors.sort_unstable();
    factors
        .iter()
        .map(|&(_, bar, symbol)| if bar { format!("|{symbol}|") } else { symbol.to_owned() })
        .collect()
}

const SYMBOLS: [&str; 8] =
    ["u", "v", "r", "n", "sindelta_s", "cosdelta_s", "sindelta_p", "cosdelta_p"];

#[test]
fn the_second_order_is_that_of_the_equations() {
    // Up to the second order the text and the equations agree.
    for rules in ["", PRINTED] {
        let derived = vectwin(2, rules);
        assert_eq!(names(&derived, Axis::X), spelled(EVEN_2), "{rules}");
        for axis in [Axis::Y, Axis::N] {
            assert_eq!(names(&derived, axis), spelled(ODD_2), "{axis} {rules}");
        }
    }
}

#[test]
fn the_third_order_is_that_of_the_equations() {
    let derived = vectwin(3, PRINTED);
    assert_eq!(names(&derived, Axis::X), spelled(&format!("{EVEN_2} {EVEN_3}")));
    for axis in [Axis::Y, Axis::N] {
        assert_eq!(names(&derived, axis), spelled(&format!("{ODD_2} {ODD_3}")), "{axis}");
    }
}

#[test]
fn the_third_order_as_described_differs_from_the_equations_where_they_differ_from_the_text() {
    let derived = vectwin(3, "");
    assert_eq!(names(&derived, Axis::X), spelled(&format!("{EVEN_2} {EVEN_3}")));
    let (printed, described) = (spelled(&format!("{ODD_2} {ODD_3}")), names(&derived, Axis::Y));
    let only_printed: BTreeSet<String> = printed.difference(&described).cloned().collect();
    let only_described: BTreeSet<String> = described.difference(&printed).cloned().collect();
    // Squares of the starboard cosine, which modification B drops, and x|x| on the other half of
    // the squares.
    assert_eq!(
        only_printed,
        spelled(
            "vCC rCC SCC CCs v|v|r vr|r| v|v|S r|r|S v|v|s r|r|s uuv uur uuS uus vnn rnn Snn snn"
        )
    );
    assert_eq!(
        only_described,
        spelled("vvr vrr vvS rrS vvs rrs u|u|v u|u|r u|u|S u|u|s vn|n| rn|n| Sn|n| sn|n|")
    );
}

#[test]
fn the_factors_stand_for_the_variables_of_equation_6() {
    let law = vectwin(2, "").law_file;
    let of =
        |symbol: &str| law.values.get(&law.factors[symbol]).unwrap_or(&law.factors[symbol]).clone();
    let formulas: Vec<String> = SYMBOLS.iter().map(|symbol| of(symbol)).collect();
    assert_eq!(
        formulas,
        ["u", "v", "r", "n", "sin(delta_s)", "cos(delta_s)", "sin(delta_p)", "cos(delta_p)"]
    );
}
