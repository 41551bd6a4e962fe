//! Names under which people record channels.

/// A target's name in manifests, and headers in use for it; the more words of a header a name
/// explains, the better.
const NAMES: &[(&str, &[&str])] = &[
    ("t", &["t", "time", "timestamp", "date time", "datetime", "utc", "elapsed time", "zeit"]),
    ("x", &["x", "x position", "x pos", "north", "northing"]),
    ("y", &["y", "y position", "y pos", "east", "easting"]),
    ("latitude", &["latitude", "lat"]),
    ("longitude", &["longitude", "lon", "lng", "long"]),
    ("psi", &["psi", "heading", "hdg", "gyro", "yaw", "yaw angle", "hdt"]),
    ("u", &["u", "surge", "surge velocity", "longitudinal speed"]),
    ("v", &["v", "sway", "sway velocity", "transverse speed", "lateral speed"]),
    (
        "u_water",
        &[
            "u water",
            "stw",
            "speed through water",
            "speed through the water",
            "water speed",
            "log speed",
            "speed log",
        ],
    ),
    ("v_water", &["v water", "transverse speed through water", "transverse water speed"]),
    ("r", &["r", "yaw rate", "rot", "rate of turn", "turn rate"]),
    ("phi", &["phi", "roll", "roll angle", "heel"]),
    ("p", &["p", "roll rate"]),
    ("delta", &["delta", "rudder", "rudder angle", "rudder position"]),
    ("delta_s", &["rudder starboard", "rudder stbd", "rudder stb", "rudder sb"]),
    ("delta_p", &["rudder port", "rudder ps", "rudder bb"]),
    ("n", &["n", "rpm", "propeller", "propeller rpm", "shaft speed", "shaft rpm", "revolutions"]),
    ("n_s", &["rpm starboard", "rpm stbd", "propeller starboard", "shaft starboard"]),
    ("n_p", &["rpm port", "propeller port", "shaft port"]),
    ("course", &["course", "cog", "course over ground"]),
    ("speed", &["speed", "sog", "speed over ground"]),
    ("wind_speed", &["wind speed", "true wind speed", "wind velo true", "tws"]),
    ("wind_from", &["wind direction", "wind dir", "true wind direction", "wind dir true", "twd"]),
    (
        "apparent_wind_speed",
        &[
            "apparent wind speed",
            "relative wind speed",
            "wind speed relative",
            "wind velo relative",
            "aws",
        ],
    ),
    (
        "apparent_wind_from",
        &[
            "apparent wind angle",
            "wind dir relative",
            "apparent wind direction",
            "relative wind direction",
            "relative wind angle",
            "awa",
        ],
    ),
    ("depth", &["depth", "water depth"]),
];

/// Letters that stand for a channel where a header begins with one and goes on in other words, as
/// `u_velo` and `n_prop` do.
const LETTERS: [(&str, &str); 7] =
    [("u", "u"), ("v", "v"), ("vm", "v"), ("r", "r"), ("p", "p"), ("n", "n"), ("psi", "psi")];

/// Words of what was wanted or computed, not measured.
const OTHERS: [&str; 11] = [
    "ordered",
    "order",
    "command",
    "commanded",
    "cmd",
    "setpoint",
    "target",
    "reference",
    "error",
    "std",
    "desired",
];

/// What a header most likely is, and whether it is exactly a known name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Likely {
    pub target: &'static str,
    pub exact: bool,
}

/// The target of a header.
pub(crate) fn likely(header: &str) -> Option<Likely> {
    let words = words(header);
    if words.iter().any(|word| OTHERS.contains(&word.as_str())) {
        return None;
    }
    let mut best: Option<(usize, Likely)> = None;
    for &(target, names) in NAMES {
        for name in names {
            let of_name: Vec<&str> = name.split(' ').collect();
            let exact = words.iter().eq(of_name.iter());
            // A letter alone means nothing among other words.
            let part =
                name.len() > 1 && of_name.iter().all(|one| words.iter().any(|word| word == one));
            let better =
                best.is_none_or(|(most, known)| of_name.len() >= most || (exact && !known.exact));
            if (exact || part) && better {
                best = Some((of_name.len(), Likely { target, exact }));
            }
        }
    }
    best.map(|(_, likely)| likely).or_else(|| by_letter(words.first()?))
}

fn by_letter(first: &str) -> Option<Likely> {
    let (_, target) = LETTERS.iter().find(|(letter, _)| *letter == first)?;
    Some(Likely { target, exact: false })
}

/// Words of a header in lower case, without the unit in brackets.
fn words(header: &str) -> Vec<String> {
    let name = header.split(['[', '(']).next().unwrap_or_default().to_lowercase();
    let words = name.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty());
    words.take(20).map(str::to_owned).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn headers_are_recognised_by_their_words() {
        for (header, wanted) in [
            ("Rudder Angle [deg]", "delta"),
            ("RUDDER_PORT (deg)", "delta_p"),
            ("GPS Latitude", "latitude"),
            ("Speed over ground", "speed"),
            ("Relative wind speed", "apparent_wind_speed"),
            ("True Wind Direction", "wind_from"),
            ("Yaw rate", "r"),
            ("u [m/s]", "u"),
            ("STW [kn]", "u_water"),
            ("Speed through water", "u_water"),
            ("Log speed", "u_water"),
            ("Date/Time", "t"),
            ("Shaft RPM starboard", "n_s"),
            ("u_velo [m/s]", "u"),
            ("vm_velo [m/s]", "v"),
            ("r_angvelo [rad/s]", "r"),
            ("n_prop [rps]", "n"),
            ("wind_dir_relative_mid [rad]", "apparent_wind_from"),
            ("wind_velo_true [m/s]", "wind_speed"),
        ] {
            assert_eq!(likely(header).map(|likely| likely.target), Some(wanted), "{header}");
        }
        for header in ["Rudder order", "temperature", "engine u load", "", "[deg]"] {
            assert_eq!(likely(header), None, "{header}");
        }
    }
}
