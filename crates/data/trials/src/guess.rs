//! Most likely content of a column of a file.

/// Channel, unit and sign identified for a column.
#[derive(Debug, Clone, PartialEq)]
pub struct ColumnGuess {
    /// File, as named by the manifest.
    pub file: String,
    /// Header of the column; `#3` for the third of a file without a header.
    pub column: String,
    /// Name of the channel in manifests; `None` for a column that is not read.
    pub channel: Option<String>,
    /// Unit of the column.
    pub unit: Option<String>,
    /// True if the sign of the column is opposite to that of the channel.
    pub reversed: bool,
    /// Posterior probability of this reading, given those of the other columns.
    pub probability: f64,
    /// Evidence as text.
    pub why: String,
    /// True if the evidence is sufficient; otherwise the user should confirm it.
    pub certain: bool,
    /// Question to the user if an alternative is nearly as likely, and how to answer it.
    pub question: Option<String>,
}

impl ColumnGuess {
    /// Returns the question without the options of the command line that answer it.
    pub fn short_question(&self) -> Option<&str> {
        let question = self.question.as_deref()?;
        question.split_inclusive("? ").next().map(str::trim_end)
    }
}
