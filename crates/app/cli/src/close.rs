//! Names close to one that is not known.

/// Names that a slip of the fingers leads away from, or that contain what was written.
pub fn close_names<'a>(name: &str, known: &'a [String]) -> Vec<&'a str> {
    let name = name.to_lowercase();
    let near = |known: &&String| {
        let contains = name.len() >= 3 && (known.contains(&name) || name.contains(known.as_str()));
        contains || distance(&name, known) <= 1 + name.chars().count() / 5
    };
    known.iter().filter(near).map(String::as_str).take(5).collect()
}

/// Letters to insert, delete or exchange between two words.
fn distance(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, from) in a.chars().enumerate() {
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
            (distance("kitten", "sitting"), distance("", "ab"), distance("ab", "ab")),
            (3, 2, 0)
        );
    }
}
