//! Structs that are read from rows in the same way on both databases.

use sqlx::FromRow;
use sqlx::postgres::PgRow;
use sqlx::sqlite::SqliteRow;

/// A struct that a row of either database can be read into.
pub(crate) trait DatabaseRecord:
    for<'r> FromRow<'r, SqliteRow> + for<'r> FromRow<'r, PgRow> + Send + Unpin
{
}

impl<T> DatabaseRecord for T where
    T: for<'r> FromRow<'r, SqliteRow> + for<'r> FromRow<'r, PgRow> + Send + Unpin
{
}

/// Conversion of a field from its stored type.
pub(crate) trait StoredColumn: Sized {
    /// Type of the column, known to both databases.
    type Stored;

    /// Converts a stored value.
    fn load(stored: Self::Stored) -> sqlx::Result<Self>;
}

macro_rules! stored_as_is {
    ($($type:ty),*) => {$(
        impl StoredColumn for $type {
            type Stored = Self;

            fn load(stored: Self) -> sqlx::Result<Self> {
                Ok(stored)
            }
        }
    )*};
}
stored_as_is!(String, i64, f64, Option<String>, Option<i64>, Option<f64>);

impl StoredColumn for bool {
    type Stored = i64;

    fn load(stored: i64) -> sqlx::Result<Self> {
        Ok(stored != 0)
    }
}

/// Declares a struct and how to read it from a row of either database: each field from the column
/// of its name, `flatten` from the same row.
macro_rules! record {
    ($(#[$meta:meta])* pub struct $name:ident {
        $(flatten $head:ident: $head_type:ty,)?
        $($(#[$doc:meta])* pub $field:ident: $type:ty,)*
    }) => {
        $(#[$meta])*
        #[derive(Debug, Clone, PartialEq)]
        pub struct $name {
            $(#[doc = "All but the long texts."] pub $head: $head_type,)?
            $($(#[$doc])* pub $field: $type,)*
        }

        $crate::record::record!(@from sqlx::sqlite::SqliteRow, $name, [$($head: $head_type)?], [$($field: $type,)*]);
        $crate::record::record!(@from sqlx::postgres::PgRow, $name, [$($head: $head_type)?], [$($field: $type,)*]);
    };
    (@from $row:ty, $name:ident, [$($head:ident: $head_type:ty)?], [$($field:ident: $type:ty,)*]) => {
        impl<'r> sqlx::FromRow<'r, $row> for $name {
            fn from_row(row: &'r $row) -> sqlx::Result<Self> {
                use sqlx::Row as _;
                Ok(Self {
                    $($head: <$head_type as sqlx::FromRow<'r, $row>>::from_row(row)?,)?
                    $($field: <$type as $crate::record::StoredColumn>::load(row.try_get(stringify!($field))?)?,)*
                })
            }
        }
    };
}
pub(crate) use record;

record! {
    /// A number of rows.
    pub struct RowCount {
        /// Number of rows.
        pub rows: i64,
    }
}
