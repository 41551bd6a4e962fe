//! What a column of a file most likely is.

/// What a column was taken for.
#[derive(Debug, Clone, PartialEq)]
pub struct Guess {
    /// The file, as the manifest names it.
    pub file: String,
    /// The column's header; `#3` for the third of a file without one.
    pub column: String,
    /// The channel's name in manifests; absent for a column that is left out.
    pub channel: Option<String>,
    /// Its unit.
    pub unit: Option<String>,
    /// Whether it counts the other way than the channel.
    pub reversed: bool,
    /// Why.
    pub why: String,
    /// Whether the evidence settles it; otherwise someone should look.
    pub certain: bool,
    /// Where a second reading is nearly as likely: which, and what answers it.
    pub question: Option<String>,
}
