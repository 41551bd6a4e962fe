//! Suggestions for unknown names.

/// Returns at most five known names that differ by a few letters, or that contain the given name or
/// are contained in it.
pub fn close_names<'a>(name: &str, known: &'a [String]) -> Vec<&'a str> {
    let name = name.to_lowercase();
    let near = |known: &&String| {
        let contains = name.len() >= 3 && (known.contains(&name) || name.contains(known.as_str()));
        // One letter for each five may be wrong, and one in any case.
        contains || edit_distance(&name, known) <= 1 + name.chars().count() / 5
    };
    known.iter().filter(near).map(String::as_str).take(5).collect()
}

/// Levenshtein distance: the number of letters to insert, delete or exchange.
fn edit_distance(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, from) in a.chars().enumerate() {
        // One row of the table is enough; `diagonal` is the cell above and to the left.
        let mut diagonal = std::mem::replace(&mut row[0], i + 1);
        for (j, to) in b.iter().enumerate() {
            let exchanged = diagonal + usize::from(from != *to);
            diagonal = row[j + 1];
            row[j + 1] = exchanged.min(row[j] + 1).min(diagonal + 1);
        }
    }
    row[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances() {
        assert_eq!(
            (
                edit_distance("kitten", "sitting"),
                edit_distance("", "ab"),
                edit_distance("ab", "ab")
            ),
            (3, 2, 0)
        );
    }
}
