//! What of a password is no guess of its own: repetitions, sequences and words that everybody
//! tries first (NIST SP 800-63B, 5.1.1.2).

/// Words that stand in most lists of leaked passwords, and that this program suggests by its name.
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
/// The shortest part of a row or of a sequence that counts as one.
const RUN: usize = 3;

/// How many guesses of its own a password takes: each of its characters is one, but a word, a row of
/// the keyboard, a sequence such as `1234`, and a character or part that repeats is one together.
pub(crate) fn independent_parts(password: &str) -> usize {
    let lower: Vec<char> = password.to_lowercase().chars().collect();
    let rest = &lower[..period(&lower)];
    let (mut at, mut parts) = (0, 0);
    while at < rest.len() {
        at += step(&rest[at..]);
        parts += 1;
    }
    parts
}

/// After how many characters a text repeats itself; all of it where it does not.
fn period(text: &[char]) -> usize {
    let repeats = |length: &usize| text.iter().zip(&text[*length..]).all(|(a, b)| a == b);
    (1..=text.len() / 2).find(repeats).unwrap_or(text.len())
}

/// How many characters of the beginning of a text are one guess.
fn step(text: &[char]) -> usize {
    let word = WORDS.iter().filter(|word| begins(text, word)).map(|word| word.len()).max();
    let row = ROWS.iter().map(|row| along(text, row)).max().filter(|length| *length >= RUN);
    let run = Some(sequence(text)).filter(|length| *length >= RUN);
    [word, row, run].into_iter().flatten().max().unwrap_or(1)
}

fn begins(text: &[char], word: &str) -> bool {
    text.len() >= word.len() && word.chars().eq(text[..word.len()].iter().copied())
}

/// How many characters follow a row of the keyboard.
fn along(text: &[char], row: &str) -> usize {
    let start = text.first().and_then(|first| row.find(*first));
    let rest = start.map_or("", |start| &row[start..]);
    rest.chars().zip(text).take_while(|(a, b)| a == *b).count()
}

/// How many characters go on by the same step: none, one up or one down.
fn sequence(text: &[char]) -> usize {
    let difference = |pair: &[char]| i64::from(u32::from(pair[1])) - i64::from(u32::from(pair[0]));
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
