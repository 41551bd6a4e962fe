//! Statistics in a document: their sizes as numbers, their values as the base64 of their bytes, so
//! that none is rounded.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use sistership_numerics::RegressionMoments;

/// Serialised form.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct PackedMoments {
    /// Number of regressors.
    regressors: usize,
    /// Number of targets.
    targets: usize,
    /// Values of the moments, as little-endian doubles.
    numbers: String,
}

pub(super) fn serialize<S: Serializer>(
    moments: &RegressionMoments,
    serializer: S,
) -> Result<S::Ok, S::Error> {
    let bytes: Vec<u8> =
        moments.to_numbers().iter().flat_map(|number| number.to_le_bytes()).collect();
    PackedMoments {
        regressors: moments.regressors(),
        targets: moments.targets(),
        numbers: STANDARD.encode(bytes),
    }
    .serialize(serializer)
}

pub(super) fn deserialize<'de, D: Deserializer<'de>>(
    deserializer: D,
) -> Result<RegressionMoments, D::Error> {
    let PackedMoments { regressors, targets, numbers } = PackedMoments::deserialize(deserializer)?;
    let bytes = STANDARD.decode(numbers).map_err(D::Error::custom)?;
    // A remainder of bytes means a damaged document.
    let (doubles, rest) = bytes.as_chunks::<8>();
    let numbers: Vec<f64> = doubles.iter().map(|double| f64::from_le_bytes(*double)).collect();
    let moments =
        RegressionMoments::from_numbers(&numbers, regressors, targets).filter(|_| rest.is_empty());
    moments.ok_or_else(|| {
        D::Error::custom(format!(
            "are not statistics of {regressors} regressors and {targets} targets"
        ))
    })
}
