//! Texts of a model in the text of another language. Names, sources and remarks are free text: they
//! must end neither the string nor the comment in which they stand.

/// Text on one line, without control characters and marks of templates.
pub fn single_line(text: &str) -> String {
    let is_blank = |c: char| c.is_whitespace() || c.is_control();
    let words: Vec<&str> = text.split(is_blank).filter(|word| !word.is_empty()).collect();
    words.join(" ").replace("@@", "@ @")
}

/// Content of a character vector of MATLAB in single quotes, in which a quote is doubled.
pub fn escape_matlab(text: &str) -> String {
    single_line(text).replace('\'', "''")
}

/// Content of a string of Modelica in double quotes.
pub fn escape_modelica(text: &str) -> String {
    single_line(text).replace('\\', "\\\\").replace('"', "\\\"")
}

/// Content of a comment of C.
pub fn escape_c_comment(text: &str) -> String {
    text.replace("*/", "* /")
}

#[cfg(test)]
mod tests {
    use super::*;

    const HOSTILE: &str = "a'b \"c\" \\\n*/ @@d\u{0}";

    #[test]
    fn texts_end_neither_strings_nor_comments() {
        assert_eq!(escape_matlab(HOSTILE), "a''b \"c\" \\ */ @ @d");
        assert_eq!(escape_modelica(HOSTILE), "a'b \\\"c\\\" \\\\ */ @ @d");
        assert_eq!(escape_c_comment(&single_line(HOSTILE)), "a'b \"c\" \\ * / @ @d");
    }

    #[test]
    fn plain_texts_stay_as_they_are() {
        for text in ["mariner/abkowitz", "Chislett, 1965: X_v|v|"] {
            assert_eq!(escape_matlab(text), text);
            assert_eq!(escape_modelica(text), text);
            assert_eq!(escape_c_comment(text), text);
        }
    }
}
