//! Messages of NMEA 2000: the values that are of use for a trial, in the fields and resolutions of
//! the public descriptions of canboat.

use super::message_log::MessageValue;

/// Resolution of angles, rad; of rates, rad/s; of speeds, m/s.
const ANGLE: f64 = 1e-4;
const RATE: f64 = 3.125e-8;
const SPEED: f64 = 0.01;

/// Returns true if a message may be longer than a frame.
pub(crate) fn is_fast_packet(pgn: u32) -> bool {
    pgn == 129_029
}

/// Bytes of a message; a field that is not available is `None`.
struct MessageFields<'a>(&'a [u8]);

impl MessageFields<'_> {
    /// Returns a little-endian number of up to eight bytes. All bits set, or the largest value of a
    /// signed field, means that it is not available.
    fn unsigned_field(&self, at: usize, size: usize) -> Option<f64> {
        let whole = self.field_bits(at, size)?;
        (whole != u64::MAX >> (64 - 8 * size)).then_some(whole as f64)
    }

    fn signed_field(&self, at: usize, size: usize) -> Option<f64> {
        let (whole, shift) = (self.field_bits(at, size)?, 64 - 8 * size);
        let value = ((whole << shift) as i64) >> shift;
        (value != i64::MAX >> shift).then_some(value as f64)
    }

    fn field_bits(&self, at: usize, size: usize) -> Option<u64> {
        let bytes = self.0.get(at..at + size)?;
        Some(bytes.iter().rev().fold(0, |whole, &byte| (whole << 8) | u64::from(byte)))
    }

    /// Returns the lowest bits of a byte.
    fn low_bits(&self, at: usize, count: u32) -> Option<u8> {
        self.0.get(at).map(|byte| byte & (u8::MAX >> (8 - count)))
    }
}

/// Returns the values of a message, in the units of their columns.
pub(crate) fn decode_message(pgn: u32, data: &[u8]) -> Vec<MessageValue> {
    let fields = MessageFields(data);
    let mut values = Vec::new();
    let mut add = |name: &str, unit: &'static str, number: Option<f64>| {
        let value = number.map(|number| MessageValue { name: name.to_owned(), unit, number });
        values.extend(value);
    };
    let angle = |at: usize| fields.unsigned_field(at, 2).map(|value| value * ANGLE);
    match pgn {
        // Rudder: its instance, the order, the angle, positive to starboard.
        127_245 => {
            add(
                side_name(fields.low_bits(0, 8), ["delta_rad", "delta_s_rad"]),
                "rad",
                fields.signed_field(4, 2).map(|value| value * ANGLE),
            );
        }
        127_250 => add("psi_rad", "rad", true_heading(&fields)),
        127_251 => add("r_rad_s", "rad/s", fields.signed_field(1, 4).map(|value| value * RATE)),
        // Attitude: yaw, pitch, roll.
        127_257 => add("phi_rad", "rad", fields.signed_field(5, 2).map(|value| value * ANGLE)),
        // Engine: its instance, revolutions by a quarter a minute.
        127_488 => add(
            side_name(fields.low_bits(0, 8), ["n_rpm", "n_s_rpm"]),
            "rpm",
            fields.unsigned_field(1, 2).map(|value| 0.25 * value),
        ),
        128_259 => {
            add("u_water_m_s", "m/s", fields.unsigned_field(1, 2).map(|value| value * SPEED));
        }
        // Depth below the transducer, and its offset to the surface (positive) or the keel.
        128_267 => {
            let offset = fields.signed_field(5, 2).map_or(0.0, |value| 1e-3 * value).max(0.0);
            add("depth_m", "m", fields.unsigned_field(1, 4).map(|value| 0.01 * value + offset));
        }
        129_025 => {
            add("latitude_deg", "deg", fields.signed_field(0, 4).map(|value| 1e-7 * value));
            add("longitude_deg", "deg", fields.signed_field(4, 4).map(|value| 1e-7 * value));
        }
        // Course over ground relative to true north, speed over ground.
        129_026 => {
            let is_true = fields.low_bits(1, 2) == Some(0);
            add("course_rad", "rad", angle(2).filter(|_| is_true));
            add("speed_m_s", "m/s", fields.unsigned_field(4, 2).map(|value| value * SPEED));
        }
        // Position of a receiver; the rapid message of it is preferred by its rate.
        129_029 => {
            add("latitude_deg", "deg", fields.signed_field(7, 8).map(|value| 1e-16 * value));
            add("longitude_deg", "deg", fields.signed_field(15, 8).map(|value| 1e-16 * value));
        }
        130_306 => {
            let (speed, from) = match fields.low_bits(5, 3) {
                Some(0) => ("wind_speed_m_s", "wind_from_rad"),
                Some(2) => ("apparent_wind_speed_m_s", "apparent_wind_from_rad"),
                // True wind by the bow or by magnetic north has no channel.
                _ => return values,
            };
            add(speed, "m/s", fields.unsigned_field(1, 2).map(|value| value * SPEED));
            add(from, "rad", angle(3));
        }
        _ => {}
    }
    values
}

/// Returns the name for an instance: the first is the only one, or the one to port.
fn side_name(instance: Option<u8>, names: [&str; 2]) -> &str {
    names[usize::from(instance == Some(1))]
}

/// Returns the heading from true north: of a magnetic compass only where the message has the
/// variation.
fn true_heading(fields: &MessageFields) -> Option<f64> {
    let heading = fields.unsigned_field(1, 2)? * ANGLE;
    match fields.low_bits(7, 2)? {
        0 => Some(heading),
        1 => {
            let correction = |at: usize| fields.signed_field(at, 2).map(|value| value * ANGLE);
            let turned = heading + correction(3).unwrap_or(0.0) + correction(5)?;
            Some(turned.rem_euclid(std::f64::consts::TAU))
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn only(pgn: u32, data: &[u8]) -> f64 {
        let values = decode_message(pgn, data);
        assert_eq!(values.len(), 1, "{values:?}");
        values[0].number
    }

    #[test]
    fn fields_have_their_resolution_and_gaps_are_none() {
        assert!((only(127_245, &[0, 0xff, 0xff, 0x7f, 0x18, 0xfc, 0xff, 0xff]) + 0.1).abs() < 1e-9);
        // 1 rad from magnetic north, variation of -0.1 rad.
        let heading = [0xff, 0x10, 0x27, 0xff, 0x7f, 0x18, 0xfc, 0xfd];
        assert!((only(127_250, &heading) - 0.9).abs() < 1e-9);
        assert!((only(127_251, &[0, 0x00, 0x48, 0xe8, 0x01, 0xff, 0xff, 0xff]) - 1.0).abs() < 1e-6);
        assert!(
            (only(127_488, &[0, 0xe0, 0x01, 0xff, 0xff, 0x7f, 0xff, 0xff]) - 120.0).abs() < 1e-9
        );
        assert!(decode_message(127_488, &[0, 0xff, 0xff]).is_empty());
        assert!(decode_message(127_245, &[]).is_empty());
        let wind = decode_message(130_306, &[0, 0x10, 0x27, 0x10, 0x27, 0xfa, 0xff, 0xff]);
        assert_eq!((wind[0].name.as_str(), wind[0].number), ("apparent_wind_speed_m_s", 100.0));
    }
}
