//! Estimate of the number of independent guesses of a password: repetitions, sequences and words of
//! leaked lists count little (NIST SP 800-63B, 5.1.1.2).

/// Words of most lists of leaked passwords, and words that this program suggests by its name.
const WORDS: [&str; 40] = [
    "password",
    "passwort",
    "passwd",
    "secret",
    "admin",
    "administrator",
    "welcome",
    "letmein",
    "login",
    "master",
    "monkey",
    "dragon",
    "shadow",
    "sunshine",
    "princess",
    "football",
    "baseball",
    "superman",
    "batman",
    "iloveyou",
    "trustno",
    "starwars",
    "whatever",
    "freedom",
    "michael",
    "jordan",
    "summer",
    "winter",
    "spring",
    "autumn",
    "changeme",
    "default",
    "guest",
    "test",
    "qwertz",
    "sistership",
    "captain",
    "engineer",
    "vessel",
    "ship",
];
/// The rows of keyboards.
const ROWS: [&str; 5] = ["qwertyuiop", "qwertzuiop", "asdfghjkl", "zxcvbnm", "yxcvbnm"];
/// Minimum length of a part of a keyboard row or of a sequence that counts as one guess.
const RUN: usize = 3;

/// Returns the number of independent guesses of a password: each character is one, but a word, a
/// part of a keyboard row, a sequence such as `1234`, and a repeated character or part are one
/// together.
pub(crate) fn independent_parts(password: &str) -> usize {
    let lower: Vec<char> = password.to_lowercase().chars().collect();
    // A repeated text counts once: only its first period is judged.
    let rest = &lower[..repetition_period(&lower)];
    let (mut at, mut parts) = (0, 0);
    while at < rest.len() {
        at += guess_length(&rest[at..]);
        parts += 1;
    }
    parts
}

/// Returns the period with which a text repeats itself; its length if it does not.
fn repetition_period(text: &[char]) -> usize {
    let repeats = |length: &usize| text.iter().zip(&text[*length..]).all(|(a, b)| a == b);
    (1..=text.len() / 2).find(repeats).unwrap_or(text.len())
}

/// Returns the number of leading characters of a text that are one guess.
fn guess_length(text: &[char]) -> usize {
    // The longest of the three readings counts as one guess.
    let word =
        WORDS.iter().filter(|word| starts_with_word(text, word)).map(|word| word.len()).max();
    let row = ROWS.iter().map(|row| row_length(text, row)).max().filter(|length| *length >= RUN);
    let run = Some(sequence_length(text)).filter(|length| *length >= RUN);
    [word, row, run].into_iter().flatten().max().unwrap_or(1)
}

fn starts_with_word(text: &[char], word: &str) -> bool {
    text.len() >= word.len() && word.chars().eq(text[..word.len()].iter().copied())
}

/// Returns the number of leading characters that follow a row of the keyboard.
fn row_length(text: &[char], row: &str) -> usize {
    let start = text.first().and_then(|first| row.find(*first));
    let rest = start.map_or("", |start| &row[start..]);
    rest.chars().zip(text).take_while(|(a, b)| a == *b).count()
}

/// Returns the number of leading characters with a constant difference of code points: -1, 0 or 1.
fn sequence_length(text: &[char]) -> usize {
    let difference = |pair: &[char]| i64::from(u32::from(pair[1])) - i64::from(u32::from(pair[0]));
    // A single character has no difference; it is a sequence of its own length.
    let Some(first) = text.windows(2).next().map(difference) else { return text.len() };
    if first.abs() > 1 {
        return 1;
    }
    1 + text.windows(2).take_while(|pair| difference(pair) == first).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn repetitions_sequences_and_common_words_are_one_guess() {
        for (password, expected) in [
            ("aaaaaaaaaaaaaaa", 1),
            ("password1234567", 2),
            ("Password12345678", 2),
            ("qwertyuiop12345", 2),
            ("abcabcabcabcabc", 1),
            ("sistership987654", 2),
            ("", 0),
        ] {
            assert_eq!(independent_parts(password), expected, "{password}");
        }
        for password in ["correct horse battery", "a long sentence of its own", "x7;Lq0!vTz2#mKp"] {
            assert!(independent_parts(password) > 12, "{password}");
        }
    }
}
