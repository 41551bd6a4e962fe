//! Mapped columns of a file as numbers in SI units and radians, still in the signs of the file.

use sistership_formula::units::Dimension;
use sistership_model::trial::Channel;

/// Target of a column.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum ColumnTarget {
    Time,
    Channel(Channel),
    /// A quantity from which channels are computed.
    Raw(RawQuantity),
    /// A column that is yet to be identified, by its index in the file.
    Unidentified(u16),
}

/// Recorded quantities from which channels are computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum RawQuantity {
    /// North of the equator, rad.
    Latitude,
    /// East of Greenwich, rad.
    Longitude,
    /// Course over ground, rad clockwise from north.
    Course,
    /// Speed over ground, m/s.
    Speed,
    /// Velocity over ground, m/s: towards north and towards east.
    VNorth,
    VEast,
}

// In the order of the variants of `RawQuantity`, which index this table.
const RAW: [(RawQuantity, &str, Dimension); 6] = [
    (RawQuantity::Latitude, "latitude", Dimension::NONE),
    (RawQuantity::Longitude, "longitude", Dimension::NONE),
    (RawQuantity::Course, "course", Dimension::NONE),
    (RawQuantity::Speed, "speed", Dimension::SPEED),
    (RawQuantity::VNorth, "v_north", Dimension::SPEED),
    (RawQuantity::VEast, "v_east", Dimension::SPEED),
];

impl RawQuantity {
    pub(crate) fn all_quantities() -> impl Iterator<Item = Self> {
        RAW.iter().map(|&(raw, ..)| raw)
    }

    pub(crate) fn name(self) -> &'static str {
        RAW[self as usize].1
    }

    pub(crate) fn dimension(self) -> Dimension {
        RAW[self as usize].2
    }

    /// Returns the channels that are computed from the quantity.
    pub(crate) fn computed_channels(self) -> &'static [Channel] {
        match self {
            Self::Latitude | Self::Longitude => &[Channel::X, Channel::Y],
            Self::Course | Self::Speed | Self::VNorth | Self::VEast => &[Channel::U, Channel::V],
        }
    }
}

impl ColumnTarget {
    pub(crate) fn from_name(name: &str) -> Option<Self> {
        let raw = || RawQuantity::all_quantities().find(|raw| raw.name() == name).map(Self::Raw);
        if name == "t" {
            Some(Self::Time)
        } else {
            Channel::by_name(name).map(Self::Channel).or_else(raw)
        }
    }

    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Time => "t",
            Self::Channel(channel) => channel.name(),
            Self::Raw(raw) => raw.name(),
            Self::Unidentified(_) => "",
        }
    }
}

/// Column of the file that is read.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct TableColumn {
    /// Position in the file, from 0.
    pub index: usize,
    pub header: String,
    pub target: ColumnTarget,
    /// Unit as declared, for messages.
    pub unit: String,
    pub to_si: f64,
    /// Value of the file that stands for zero.
    pub at_rest: f64,
}

impl TableColumn {
    /// Returns a value of the file in canonical units.
    pub(crate) fn to_canonical(&self, value: f64) -> f64 {
        (value - self.at_rest) * self.to_si
    }
}

/// Returns the number of columns in memory at a time: those that are read, and those computed from
/// them.
pub(crate) fn memory_columns(columns: &[TableColumn]) -> usize {
    let raw = columns.iter().filter(|column| matches!(column.target, ColumnTarget::Raw(_)));
    columns.len() + raw.count()
}

/// Calendar time of time zero.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct TimeOrigin {
    pub text: String,
    /// Seconds since 1970, or since midnight where no date is known.
    pub at_s: f64,
    pub dated: bool,
}

/// Numbers of the mapped columns, one vector per column, and their rows in the file.
#[derive(Debug, Default)]
pub(crate) struct Table {
    pub columns: Vec<TableColumn>,
    pub values: Vec<Vec<f64>>,
    pub rows: Vec<u32>,
    /// Rows before which other rows have been excluded.
    pub resumed: Vec<u32>,
    /// Calendar time of time zero, if the file contains it.
    pub start: Option<TimeOrigin>,
}

/// Source of the values of a table; a gap is NaN.
pub(crate) trait TableValues {
    /// Returns the values of a column in SI units, where there is one.
    fn column_values(&self, target: ColumnTarget) -> Option<&[f64]>;

    /// Returns the values of a channel, where it is recorded.
    fn channel_values(&self, channel: Channel) -> Option<&[f64]> {
        self.column_values(ColumnTarget::Channel(channel))
    }

    /// Returns the values of a quantity from which channels are computed, where it is recorded.
    fn raw_values(&self, raw: RawQuantity) -> Option<&[f64]> {
        self.column_values(ColumnTarget::Raw(raw))
    }
}

impl TableValues for Table {
    fn column_values(&self, target: ColumnTarget) -> Option<&[f64]> {
        let at = self.columns.iter().position(|column| column.target == target)?;
        self.values.get(at).map(Vec::as_slice)
    }
}
