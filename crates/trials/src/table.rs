//! The mapped columns of a file as numbers in SI units and radians, still in the file's own signs.

use sistership_model::trial::Channel;

/// What a column is read into.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Target {
    Time,
    Channel(Channel),
}

impl Target {
    pub(crate) fn by_name(name: &str) -> Option<Self> {
        if name == "t" { Some(Self::Time) } else { Channel::by_name(name).map(Self::Channel) }
    }

    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Time => "t",
            Self::Channel(channel) => channel.name(),
        }
    }
}

/// A column of the file that is read.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Column {
    /// Position in the file, from 0.
    pub index: usize,
    pub header: String,
    pub target: Target,
    /// As declared, for messages.
    pub unit: String,
    pub to_si: f64,
}

/// Numbers of the mapped columns, one vector per column, and the rows of the file that they stand in.
#[derive(Debug, Default)]
pub(crate) struct Table {
    pub columns: Vec<Column>,
    pub values: Vec<Vec<f64>>,
    pub rows: Vec<u32>,
    /// Of these, the ones before which rows have been left out.
    pub resumed: Vec<u32>,
    /// What time zero is in the calendar, where the file says it.
    pub start: Option<String>,
}
