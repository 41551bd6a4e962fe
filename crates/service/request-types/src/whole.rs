//! Types of whole numbers: counts, limits, numbers of versions.

use sistership_store::MAX_LIMIT;
use utoipa::openapi::RefOr;
use utoipa::openapi::schema::{KnownFormat, ObjectBuilder, Schema, SchemaFormat, Type};

/// Largest whole number that every reader of JSON represents exactly.
pub const MAX_WHOLE: i64 = (1 << 53) - 1;

/// Declares a type of whole number with a minimum and a maximum; `deserialize_str` reads it from a
/// path or a query, `deserialize_i64` from a body.
macro_rules! whole {
    ($(#[$about:meta])* $name:ident: $min:expr, $max:expr, $read:ident $(, default $default:expr)?) => {
        $(#[$about])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub struct $name(i64);

        impl $name {
            /// Returns the number.
            pub fn get(self) -> i64 {
                self.0
            }

            fn check(value: Option<i64>) -> Result<Self, String> {
                let known = value.filter(|value| ($min..=$max).contains(value));
                known.map(Self).ok_or_else(|| format!("must be a whole number from {} to {}", $min, $max))
            }
        }

        $(impl Default for $name {
            fn default() -> Self {
                Self($default)
            }
        })?

        impl std::str::FromStr for $name {
            type Err = String;

            fn from_str(text: &str) -> Result<Self, String> {
                Self::check(text.parse().ok())
            }
        }

        impl<'de> serde::Deserialize<'de> for $name {
            fn deserialize<D: serde::Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
                from.$read(Whole(Self::check))
            }
        }

        impl utoipa::PartialSchema for $name {
            fn schema() -> RefOr<Schema> {
                let whole = ObjectBuilder::new().schema_type(Type::Integer);
                let whole = whole.format(Some(SchemaFormat::KnownFormat(KnownFormat::Int64)));
                let whole = whole.minimum(Some($min)).maximum(Some($max));
                $(let whole = whole.default(Some($default.into()));)?
                whole.build().into()
            }
        }

        impl utoipa::ToSchema for $name {}
    };
}

whole! {
    /// Maximum number of items of a page.
    Limit: 1, MAX_LIMIT, deserialize_str, default 100
}
whole! {
    /// Maximum number of members of a family that are read.
    MemberLimit: 1, MAX_LIMIT, deserialize_str, default 50
}
whole! {
    /// The number of a version or of a prior.
    Number: 1, MAX_WHOLE, deserialize_str
}
whole! {
    /// Number of models drawn from a posterior.
    SampleCount: 2, 1000, deserialize_i64, default 100
}
whole! {
    /// Number of models drawn from a posterior that are simulated in a session.
    DrawCount: 2, 200, deserialize_i64, default 100
}
whole! {
    /// Number of steps that a session simulates.
    StepCount: 1, 10_000, deserialize_i64, default 1
}
whole! {
    /// The number of a version, in a body.
    VersionNumber: 1, MAX_WHOLE, deserialize_i64
}
whole! {
    /// A moment, microseconds since 1970.
    MomentUs: 1, MAX_WHOLE, deserialize_i64
}

/// Visitor that reads a number from JSON, a path or a query: 3 and 3.0 are the same number for JSON
/// Schema.
struct Whole<T>(fn(Option<i64>) -> Result<T, String>);

impl<T> serde::de::Visitor<'_> for Whole<T> {
    type Value = T;

    fn expecting(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        out.write_str("a whole number")
    }

    fn visit_i64<E: serde::de::Error>(self, value: i64) -> Result<T, E> {
        self.0(Some(value)).map_err(E::custom)
    }

    fn visit_u64<E: serde::de::Error>(self, value: u64) -> Result<T, E> {
        self.0(i64::try_from(value).ok()).map_err(E::custom)
    }

    fn visit_f64<E: serde::de::Error>(self, value: f64) -> Result<T, E> {
        // Beyond 2^53 a float no longer represents each whole number.
        let whole = value.fract() == 0.0 && value.abs() <= MAX_WHOLE as f64;
        self.0(whole.then_some(value as i64)).map_err(E::custom)
    }

    fn visit_str<E: serde::de::Error>(self, value: &str) -> Result<T, E> {
        self.0(value.parse().ok()).map_err(E::custom)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn a_whole_number_may_be_written_as_a_decimal() {
        let read = |text: &str| serde_json::from_str::<VersionNumber>(text).map(VersionNumber::get);
        assert_eq!(
            (read("3").unwrap(), read("3.0").unwrap(), read("9007199254740991").unwrap()),
            (3, 3, MAX_WHOLE)
        );
        for wrong in [
            "0",
            "9007199254740992",
            "1.5",
            "1e300",
            "-1",
            "\"3\"",
            "null",
            "true",
            "18446744073709551615",
        ] {
            assert!(read(wrong).is_err(), "{wrong}");
        }
    }
}
