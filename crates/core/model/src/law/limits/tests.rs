#![allow(clippy::unwrap_used)]
use std::time::{Duration, Instant};

use super::*;
use sistership_formula::{MAX_NESTING, MAX_OPERATORS};

/// A law with some formula as the rest of X, values and terms.
fn law(rest: &str, values: &str, terms: &str) -> String {
    format!(
        "kind: law\nname: tried\ntitle: tried\nsources: {{}}\nvalues:\n  one: \
         '1'\n{values}\nfactors: {{ u: u, v: v, r: r, {} }}\naxes:\n  X: {{ terms: [{terms}], \
         rest: '({rest})*mass_kg*g' }}\n  Y: {{ terms: [Y_v], open: true }}\n  N: {{ terms: [N_r] \
         }}\nmass: {{ X: {{ X: mass_kg }}, Y: {{ Y: mass_kg }}, N: {{ N: mass_kg*lpp_m^2 }} }}\n",
        factors()
    )
}

/// Result of reading on the smallest stack on which documents are read, within a second.
fn read(text: String) -> Result<(), String> {
    let small = std::thread::Builder::new().stack_size(1 << 20);
    let began = Instant::now();
    let read =
        small.spawn(move || Law::parse("law.yaml", &text).map(|_| ()).map_err(|e| e.to_string()));
    let read = read.unwrap().join().unwrap();
    assert!(began.elapsed() < Duration::from_secs(2), "{:?}: {read:?}", began.elapsed());
    read
}

/// Values of which each names the one before twice.
fn twice(count: usize) -> String {
    let one = |n: usize| format!("  a{}: a{n} + a{n}\n", n + 1);
    format!("  a0: one\n{}", (0..count).map(one).collect::<String>())
}

/// Values of which each is a long sum upon the one before.
fn chain(count: usize, operators: usize) -> String {
    let one = |n: usize| format!("  a{}: a{n}{}\n", n + 1, " + one".repeat(operators));
    format!("  a0: one\n{}", (0..count).map(one).collect::<String>())
}

#[test]
fn laws_at_the_limits_are_read_and_beyond_refused() {
    assert_eq!(read(law("1", "", "X_u")), Ok(()));
    let around =
        |open: &str, close: &str, n: usize| format!("{}1{}", open.repeat(n), close.repeat(n));
    for (open, close, most) in [
        ("(", ")", MAX_NESTING),
        ("-", "", MAX_NESTING),
        ("sqrt(", ")", MAX_NESTING),
        ("", "^1", MAX_NESTING),
        ("", "+1", MAX_OPERATORS),
    ] {
        assert_eq!(read(law(&around(open, close, most - 5), "", "X_u")), Ok(()), "{open}{close}");
        for n in [most + 1, 10 * most, 1_609, 3_355, 10_000] {
            let said = read(law(&around(open, close, n), "", "X_u")).unwrap_err();
            assert!(
                said.contains("axes.X.rest") && said.contains("the limit is"),
                "{open}{close}: {said}"
            );
        }
    }
    assert_eq!(read(law("a30", &twice(30), "X_u")), Ok(()));
    assert_eq!(read(law("a200", &twice(200), "X_u")), Ok(()));
    assert!(read(law("a490", &twice(490), "X_u")).unwrap_err().contains("512 deep"));
    assert_eq!(read(law("a2", &chain(2, 240), "X_u")), Ok(()));
    assert!(read(law("a20", &chain(20, 240), "X_u")).unwrap_err().contains("512 deep"));
    assert!(
        read(law("1", &twice(501), "X_u"))
            .unwrap_err()
            .contains("values: there are 503; the limit is 500")
    );
    let names =
        |count: usize| -> String { (0..count).map(|n| format!("X_{}, ", name(n))).collect() };
    assert_eq!(read(law("1", "", &names(MAX_TERMS - 2))), Ok(()));
    for count in [MAX_TERMS + 1, 3_320, 10 * MAX_TERMS] {
        let said = read(law("1", "", &names(count))).unwrap_err();
        assert!(
            said.contains("axes: terms: there are") && said.contains("the limit is 1500"),
            "{said}"
        );
    }
    let said = read(law("1", "", &format!("X_{}", "u".repeat(10_000)))).unwrap_err();
    assert!(said.contains("the limit is"), "{said}");
    assert!(read(law("1", "", "X_uuuuuuuuuuuuuuuuu")).unwrap_err().contains("16 factors"));
    let said = read(format!("{}{}", law("1", "", "X_u"), "{a: ".repeat(50_000))).unwrap_err();
    assert!(said.contains("64 deep"), "{said}");
}

/// Different products of two of the factors.
fn name(number: usize) -> String {
    let letters =
        |place: usize| [b'A' + (place / 8) as u8, b'a' + (place % 8) as u8].map(char::from);
    let pairs = (0..64).flat_map(|a| (a..64).map(move |b| (a, b)));
    let (a, b) = pairs.clone().nth(number % 2080).unwrap();
    [['F'].to_vec(), letters(a).to_vec(), ['F'].to_vec(), letters(b).to_vec()]
        .concat()
        .into_iter()
        .collect()
}

fn factors() -> String {
    let symbols: Vec<String> =
        (0..64).map(|n| name(pairs_of(n))).map(|pair| format!("{}: u", &pair[..3])).collect();
    symbols.join(", ")
}

/// Where the pair of a factor with itself stands among the pairs.
fn pairs_of(factor: usize) -> usize {
    (0..factor).map(|earlier| 64 - earlier).sum()
}
