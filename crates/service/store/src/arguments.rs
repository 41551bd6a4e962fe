//! Arguments of SQL statements, each with the name of its field, checked before any of them is
//! sent.

use crate::checks;
use crate::error::Result;

/// Arguments of a statement, the values of `$1`, `$2`, ... in order.
pub(crate) type StatementArgs<'a> = &'a [(&'static str, Arg<'a>)];

/// One argument of a statement; `None` is SQL's NULL.
#[derive(Clone, Copy)]
pub(crate) enum Arg<'a> {
    // The three types that both databases store; a bool is an integer, a document a text.
    Text(Option<&'a str>),
    Integer(Option<i64>),
    Real(Option<f64>),
}

/// Writes [`Args`]: `args![name: name, created_us: now]`.
macro_rules! args {
    ($($field:ident: $value:expr),* $(,)?) => {
        &[$((stringify!($field), $crate::arguments::Arg::from($value))),*]
    };
}
pub(crate) use args;

/// Binds [`Args`] to a query of either database.
macro_rules! bind {
    ($query:expr, $args:expr) => {{
        let mut query = $query;
        for (_, arg) in $args {
            query = match *arg {
                $crate::arguments::Arg::Text(value) => query.bind(value),
                $crate::arguments::Arg::Integer(value) => query.bind(value),
                $crate::arguments::Arg::Real(value) => query.bind(value),
            };
        }
        query
    }};
}
pub(crate) use bind;

/// Checks all arguments of a statement: no NUL character, no NaN or infinity, no text beyond the
/// limit of length.
pub(crate) fn check_args(args: StatementArgs<'_>) -> Result<()> {
    args.iter().try_for_each(|(field, arg)| match arg {
        Arg::Text(Some(value)) => checks::check_text(field, value),
        Arg::Real(Some(value)) => checks::check_finite(field, *value),
        Arg::Text(None) | Arg::Integer(_) | Arg::Real(None) => Ok(()),
    })
}

impl<'a> From<&'a str> for Arg<'a> {
    fn from(value: &'a str) -> Self {
        Self::Text(Some(value))
    }
}

impl<'a> From<&'a String> for Arg<'a> {
    fn from(value: &'a String) -> Self {
        Self::Text(Some(value))
    }
}

impl<'a> From<Option<&'a str>> for Arg<'a> {
    fn from(value: Option<&'a str>) -> Self {
        Self::Text(value)
    }
}

impl<'a> From<&'a Option<String>> for Arg<'a> {
    fn from(value: &'a Option<String>) -> Self {
        Self::Text(value.as_deref())
    }
}

impl From<i64> for Arg<'_> {
    fn from(value: i64) -> Self {
        Self::Integer(Some(value))
    }
}

impl From<Option<i64>> for Arg<'_> {
    fn from(value: Option<i64>) -> Self {
        Self::Integer(value)
    }
}

impl From<f64> for Arg<'_> {
    fn from(value: f64) -> Self {
        Self::Real(Some(value))
    }
}

impl From<Option<f64>> for Arg<'_> {
    fn from(value: Option<f64>) -> Self {
        Self::Real(value)
    }
}

/// Encodes names as a JSON list, so that a list of any length is one argument.
pub(crate) fn names_list(names: &[String]) -> String {
    serde_json::Value::from(names).to_string()
}
