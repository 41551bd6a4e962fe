//! Splitting of headers into words.

/// Letters with marks, and their usual transcription in headers.
const PLAIN: [(char, &str); 33] = [
    ('ä', "ae"),
    ('ö', "oe"),
    ('ü', "ue"),
    ('ß', "ss"),
    ('æ', "ae"),
    ('ø', "oe"),
    ('å', "aa"),
    ('é', "e"),
    ('è', "e"),
    ('ê', "e"),
    ('ë', "e"),
    ('á', "a"),
    ('à', "a"),
    ('â', "a"),
    ('ã', "a"),
    ('í', "i"),
    ('ì', "i"),
    ('î', "i"),
    ('ï', "i"),
    ('ó', "o"),
    ('ò', "o"),
    ('ô', "o"),
    ('õ', "o"),
    ('ú', "u"),
    ('ù', "u"),
    ('û', "u"),
    ('ñ', "n"),
    ('ç', "c"),
    ('œ', "oe"),
    ('ψ', "psi"),
    ('φ', "phi"),
    ('δ', "delta"),
    ('ÿ', "y"),
];

/// Splits a text into words in lower case without marks; a change from a small to a capital letter
/// begins a word.
pub(crate) fn split_words(text: &str) -> Vec<String> {
    let mut words = Vec::new();
    let mut word = String::new();
    let mut before = ' ';
    for letter in text.chars() {
        // `yawRate` is two words.
        let begins = before.is_lowercase() && letter.is_uppercase();
        if (begins || !letter.is_alphanumeric()) && !word.is_empty() {
            words.push(std::mem::take(&mut word));
        }
        if letter.is_alphanumeric() {
            push_plain(letter, &mut word);
        }
        before = letter;
    }
    words.push(word);
    words.retain(|word| !word.is_empty());
    // A bound on the work for texts that are no headers.
    words.truncate(20);
    words
}

fn push_plain(letter: char, word: &mut String) {
    for small in letter.to_lowercase() {
        match PLAIN.iter().find(|(marked, _)| *marked == small) {
            Some((_, plain)) => word.push_str(plain),
            None => word.push(small),
        }
    }
}

/// Returns true if the script of a text does not separate words by spaces.
pub(crate) fn is_ideographic(text: &str) -> bool {
    text.chars().any(|letter| matches!(letter, '\u{1100}'..='\u{11ff}' | '\u{2e80}'..='\u{9fff}' | '\u{ac00}'..='\u{d7af}'))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn headers_are_cut_into_words() {
        assert_eq!(split_words("YawRate [deg/s]"), ["yaw", "rate", "deg", "s"]);
        assert_eq!(split_words("Krängung_ist (°)"), ["kraengung", "ist"]);
        assert_eq!(split_words("舵角"), ["舵角"]);
        assert!(is_ideographic("선수각") && !is_ideographic("Kurs"));
    }
}
