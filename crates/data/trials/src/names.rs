//! Canonical column names, which need no mapping: the name of a channel and a unit suffix.

use sistership_model::trial::Channel;

use crate::table::{ColumnTarget, RawQuantity};
use crate::units::UnitKind;

/// Other common names of channels; a wind direction without a qualifier is where the wind comes
/// from.
const ALIASES: [(&str, Channel); 8] = [
    ("wind_dir", Channel::WindFrom),
    ("apparent_wind_dir", Channel::ApparentWindFrom),
    ("n_starboard", Channel::NS),
    ("n_stbd", Channel::NS),
    ("n_port", Channel::NP),
    ("delta_starboard", Channel::DeltaS),
    ("delta_stbd", Channel::DeltaS),
    ("delta_port", Channel::DeltaP),
];

const RAW_ALIASES: [(&str, RawQuantity); 4] = [
    ("lat", RawQuantity::Latitude),
    ("lon", RawQuantity::Longitude),
    ("cog", RawQuantity::Course),
    ("sog", RawQuantity::Speed),
];

/// Common headers of time, whose unit is detected from the cells.
const TIMES: [&str; 9] = [
    "time",
    "timestamp",
    "time_stamp",
    "datetime",
    "date_time",
    "date/time",
    "date time",
    "utc",
    "utc time",
];

/// Returns true if the header is a common name of time.
pub(crate) fn is_time(header: &str) -> bool {
    TIMES.iter().any(|known| header.eq_ignore_ascii_case(known))
}

/// Returns true if the header is `t` or a common name of time, with or without its unit.
pub(crate) fn begins_time(header: &str) -> bool {
    let bare = header.split(['(', '[']).next().unwrap_or_default().trim();
    // `t_s` and `time_ms`, but not `time_constant`.
    let stem = bare.rsplit_once('_').filter(|(_, unit)| ["s", "sec", "ms", "us"].contains(unit));
    let stem = stem.map_or(bare, |(stem, _)| stem);
    stem.eq_ignore_ascii_case("t") || is_time(stem) || is_time(bare)
}

/// Returns the target and unit named by a header, such as `r_radps` or `wind_speed_kn`. The name of
/// a channel followed by anything but a unit of its kind (`delta_ordered_rad`) is another quantity.
pub(crate) fn canonical_target(header: &str) -> Option<(ColumnTarget, &'static str)> {
    let channels =
        Channel::all_channels().map(|channel| (channel.name(), ColumnTarget::Channel(channel)));
    let aliases = ALIASES.iter().map(|&(name, channel)| (name, ColumnTarget::Channel(channel)));
    let raw = RawQuantity::all_quantities().map(|raw| (raw.name(), ColumnTarget::Raw(raw)));
    let raw = raw.chain(RAW_ALIASES.iter().map(|&(name, raw)| (name, ColumnTarget::Raw(raw))));
    let mut known =
        std::iter::once(("t", ColumnTarget::Time)).chain(channels).chain(aliases).chain(raw);
    known.find_map(|(name, target)| {
        let suffix = header.strip_prefix(name)?.strip_prefix('_')?;
        UnitKind::from_target(target).unit_of_suffix(suffix).map(|unit| (target, unit))
    })
}

/// Returns the target of a name without unit suffix, such as `psi`, if the unit given elsewhere is
/// of its kind.
pub(crate) fn target_with_unit(header: &str, unit: &str) -> Option<ColumnTarget> {
    let target = ColumnTarget::from_name(header)?;
    UnitKind::from_target(target).unit_to_si(unit).ok().map(|_| target)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn channel(header: &str) -> Option<(Channel, &'static str)> {
        match canonical_target(header) {
            Some((ColumnTarget::Channel(channel), unit)) => Some((channel, unit)),
            _ => None,
        }
    }

    #[test]
    fn canonical_columns_and_other_units_are_known() {
        for known in Channel::all_channels() {
            assert_eq!(channel(known.column_name()).map(|(found, _)| found), Some(known));
        }
        assert_eq!(canonical_target("t_s"), Some((ColumnTarget::Time, "s")));
        assert_eq!(channel("r_radps"), Some((Channel::R, "rad/s")));
        assert_eq!(channel("p_deg_s"), Some((Channel::P, "deg/s")));
        assert_eq!(channel("n_rpm"), Some((Channel::N, "rpm")));
        assert_eq!(channel("u_km_h"), Some((Channel::U, "km/h")));
        assert_eq!(channel("wind_speed_kn"), Some((Channel::WindSpeed, "kn")));
        assert_eq!(channel("wind_dir_rad"), Some((Channel::WindFrom, "rad")));
    }

    #[test]
    fn times_are_told_with_and_without_their_units() {
        for header in ["t", "T", "t_s", "Time [s]", "time_ms", "time_stamp", "UTC", "t (s)"] {
            assert!(begins_time(header), "{header}");
        }
        for header in ["", "u_m_s", "tide", "t_air", "time_constant", "s"] {
            assert!(!begins_time(header), "{header}");
        }
    }

    #[test]
    fn other_quantities_are_not_taken_for_a_channel() {
        for header in ["delta_ordered_rad", "u", "n_rad_s", "r_rpm", "psi_m", "", "x_"] {
            assert_eq!(canonical_target(header), None, "{header}");
        }
    }
}
