//! Number types: times, speeds, angles.

use utoipa::openapi::RefOr;
use utoipa::openapi::schema::{KnownFormat, ObjectBuilder, Schema, SchemaFormat, Type};

/// Declares a type of number with a rule.
macro_rules! number {
    ($(#[$about:meta])* $name:ident: $fits:expr, $says:literal, $schema:expr) => {
        $(#[$about])*
        #[derive(Debug, Clone, Copy, PartialEq)]
        pub struct $name(f64);

        impl $name {
            /// Returns the number.
            pub fn get(self) -> f64 {
                self.0
            }
        }

        impl<'de> serde::Deserialize<'de> for $name {
            fn deserialize<D: serde::Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
                let (value, fits): (f64, fn(f64) -> bool) = (f64::deserialize(from)?, $fits);
                let wrong = || serde::de::Error::custom(format!("must be {}, not {value}", $says));
                // The rule alone would accept an infinity where it has no maximum.
                if value.is_finite() && fits(value) { Ok(Self(value)) } else { Err(wrong()) }
            }
        }

        impl utoipa::PartialSchema for $name {
            fn schema() -> RefOr<Schema> {
                let number = ObjectBuilder::new().schema_type(Type::Number);
                let describe: fn(ObjectBuilder) -> ObjectBuilder = $schema;
                describe(number.format(Some(SchemaFormat::KnownFormat(KnownFormat::Double)))).build().into()
            }
        }

        impl utoipa::ToSchema for $name {}
    };
}

number! {
    /// A positive depth, speed or time.
    Positive: |value| value > 0.0, "above 0", |number| number.exclusive_minimum(Some(0))
}
number! {
    /// The length of a step, s.
    StepLength: |value| value > 0.0 && value <= 60.0, "above 0 and at most 60 s",
        |number| number.exclusive_minimum(Some(0)).maximum(Some(60))
}
number! {
    /// The speed of a current, m/s.
    WaterSpeed: |value| (0.0..=10.0).contains(&value), "from 0 to 10 m/s",
        |number| number.minimum(Some(0)).maximum(Some(10))
}
number! {
    /// The speed of a wind, m/s.
    WindSpeed: |value| (0.0..=80.0).contains(&value), "from 0 to 80 m/s",
        |number| number.minimum(Some(0)).maximum(Some(80))
}
number! {
    /// A component of the velocity of a current, m/s.
    CurrentComponent: |value| (-10.0..=10.0).contains(&value), "from -10 to 10 m/s",
        |number| number.minimum(Some(-10)).maximum(Some(10))
}
number! {
    /// The draught of a ship, m.
    Draught: |value| (0.0..=40.0).contains(&value), "from 0 to 40 m",
        |number| number.minimum(Some(0)).maximum(Some(40))
}
number! {
    /// An angle of a rudder or a heading, in degrees.
    Angle: |value| value != 0.0 && value.abs() <= 90.0, "an angle up to 90 deg to either side and \
        not 0",
        |number| number.minimum(Some(-90)).maximum(Some(90)).extensions(not_zero())
}

/// Returns the extension by which a schema excludes 0; it becomes the keyword `not`, see
/// `api::routes::document`.
fn not_zero() -> Option<utoipa::openapi::extensions::Extensions> {
    Some([("x-not".to_owned(), serde_json::json!({ "const": 0 }))].into_iter().collect())
}
