//! Identifiers that are valid in every language.

use std::collections::BTreeSet;

/// Identifier of letters, digits and underscores for any text: `X_v|v|` becomes `X_v_abs_v`,
/// `mariner/abkowitz` becomes `mariner_abkowitz`.
pub fn to_identifier(text: &str) -> String {
    let mut name = String::new();
    let mut inside = false;
    for letter in text.chars() {
        match letter {
            '|' => {
                // Bars come in pairs, as in `v|v|`.
                inside = !inside;
                name.push_str(if inside { "_abs_" } else { "_" });
            }
            letter if letter.is_ascii_alphanumeric() => name.push(letter),
            '@' => name.push_str("_at_"),
            _ => name.push('_'),
        }
    }
    let mut name = name.trim_matches('_').to_owned();
    while name.contains("__") {
        name = name.replace("__", "_");
    }
    // An identifier must begin with a letter in every language.
    if !name.starts_with(|first: char| first.is_ascii_alphabetic()) {
        name.insert_str(0, "m_");
    }
    name
}

/// Identifiers of several texts, made unique by a number.
pub fn unique_identifiers<'a>(texts: impl Iterator<Item = &'a str>) -> Vec<String> {
    let mut taken = BTreeSet::new();
    let one = |text: &'a str| {
        let plain = to_identifier(text);
        let mut name = plain.clone();
        let mut number = 2;
        // Different texts may have the same identifier.
        while !taken.insert(name.clone()) {
            name = format!("{plain}_{number}");
            number += 1;
        }
        name
    };
    texts.map(one).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn absolute_values_and_submodels_are_spelled_out() {
        let names = ["X_v|v|", "N_|v|r", "X_u@astern", "mariner/abkowitz", "6-dof", "Y_vvr", "'"];
        let spelled = names.map(to_identifier);
        let expected = [
            "X_v_abs_v",
            "N_abs_v_r",
            "X_u_at_astern",
            "mariner_abkowitz",
            "m_6_dof",
            "Y_vvr",
            "m_",
        ];
        assert_eq!(spelled, expected);
    }

    #[test]
    fn names_that_come_out_alike_are_told_apart() {
        assert_eq!(
            unique_identifiers(["a/b", "a-b", "a b"].into_iter()),
            ["a_b", "a_b_2", "a_b_3"]
        );
    }
}
