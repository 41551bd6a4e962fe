//! The library's effects as the true ship has them.

use sistership_model::effect::AppliedEffect;

use super::super::truth::{Hidden, Weather, effect};

/// Each effect; where one has two forms or kinds that trials tell apart, each of these.
pub const SINGLES: [&str; 17] = [
    "wind",
    "wind/constant",
    "current",
    "rudder-offset",
    "rudder-lag",
    "propeller-asymmetry",
    "extra-resistance",
    "shallow-water",
    "yaw-rate-bias",
    "heading-drift",
    "speed-log",
    "time-delay",
    "lever-arm",
    "roll-coupling",
    "wave-drift",
    "missing-term/N_r|r|",
    "missing-term/Y_v|v|",
];

/// Effects that are found together at sea.
pub const PAIRS: [[&str; 2]; 12] = [
    ["current", "rudder-offset"],
    ["wind", "yaw-rate-bias"],
    ["extra-resistance", "rudder-lag"],
    ["current", "speed-log"],
    ["wind", "current"],
    ["rudder-offset", "lever-arm"],
    ["shallow-water", "current"],
    ["extra-resistance", "heading-drift"],
    ["time-delay", "rudder-lag"],
    ["wave-drift", "yaw-rate-bias"],
    ["propeller-asymmetry", "extra-resistance"],
    ["lever-arm", "speed-log"],
];

/// Where the wind of 12 m/s comes from, deg.
const WIND_FROM_DEG: f64 = 60.0;
const WIND_M_S: f64 = 12.0;

/// What hides some effects at a share of their full strength.
pub fn hidden(labels: &[&str], share: f64) -> Hidden {
    let blows = labels.contains(&"wind");
    Hidden {
        effects: labels.iter().map(|label| listed(label, share)).collect(),
        wind: blows
            .then(|| Weather { speed_m_s: WIND_M_S * share, from_rad: WIND_FROM_DEG.to_radians() }),
        no_wind_sensor: labels.contains(&"wind/constant"),
        unlisted: None,
    }
}

/// North and east of something towards (or from) a direction.
fn components(size: f64, direction_deg: f64) -> (f64, f64) {
    let (sin, cos) = direction_deg.to_radians().sin_cos();
    (size * cos, size * sin)
}

fn listed(label: &str, share: f64) -> AppliedEffect {
    let (name, kind) = label.split_once('/').unwrap_or((label, ""));
    match name {
        "wind" if kind.is_empty() => effect(name, "measured", &WIND_COEFFICIENTS),
        "wind" | "current" | "wave-drift" => of_the_sea(name, share),
        "missing-term" => term(kind, share),
        _ => of_the_ship(name, share),
    }
}

/// Of a typical ship; a share of the strength is a share of the wind's speed.
const WIND_COEFFICIENTS: [(&str, f64); 10] = [
    ("X_A0", -0.02),
    ("X_A1", -0.6),
    ("X_A3", 0.05),
    ("X_A5", 0.02),
    ("Y_A1", 0.8),
    ("Y_A3", 0.04),
    ("Y_A5", -0.02),
    ("N_A1", 0.02),
    ("N_A2", 0.08),
    ("N_A3", -0.01),
];

fn of_the_sea(name: &str, share: f64) -> AppliedEffect {
    let steady = |size: f64, direction_deg: f64| {
        let (north, east) = components(size * share, direction_deg);
        [("north_m_s", north), ("east_m_s", east)]
    };
    match name {
        "wind" => effect(name, "constant", &steady(WIND_M_S, WIND_FROM_DEG)),
        "current" => effect(name, "constant", &steady(0.6, 45.0)),
        _ => {
            let (north, east) = components(0.008 * share, 120.0);
            effect(
                name,
                "constant",
                &[("north", north), ("east", east), ("surge_share", 0.4), ("yaw_lever", 0.03)],
            )
        }
    }
}

/// Terms of the hull that are a fifth to a third of the linear ones in these trials.
fn term(name: &str, share: f64) -> AppliedEffect {
    let (parameter, full) =
        if name == "N_r|r|" { ("N_r_abs_r", -0.0022) } else { ("Y_v_abs_v", -0.022) };
    effect("missing-term", name, &[(parameter, full * share)])
}

fn of_the_ship(name: &str, share: f64) -> AppliedEffect {
    let with = |form: &str, full: &[(&str, f64)]| {
        let scaled: Vec<(&str, f64)> =
            full.iter().map(|&(name, value)| (name, share * value)).collect();
        effect(name, form, &scaled)
    };
    match name {
        "rudder-offset" => with("constant", &[("offset_rad", 1.5_f64.to_radians())]),
        "rudder-lag" => with("first-order", &[("time_constant_s", 3.0)]),
        "propeller-asymmetry" => with("constant", &[("side_force", 0.01), ("moment", -0.005)]),
        "extra-resistance" => with("quadratic", &[("coefficient", 0.004)]),
        "shallow-water" => with("constant", &[("draught_to_depth", 0.5)]),
        "yaw-rate-bias" => with("constant", &[("bias_rad_s", 0.03_f64.to_radians())]),
        "heading-drift" => with("linear", &[("drift_rad_s", 0.005_f64.to_radians())]),
        "speed-log" => with("both", &[("scale", 0.03), ("offset_m_s", 0.1)]),
        "time-delay" => with("heading", &[("delay_s", 1.5)]),
        "lever-arm" => with("gnss", &[("forward_m", 40.0), ("starboard_m", 5.0)]),
        // As large again as what Son and Nomoto give.
        "roll-coupling" => {
            with("linear", &[("Y_phi", -6.3e-5), ("N_phi", -1.42e-4), ("N_p", 2.13e-4)])
        }
        _ => panic!("no case `{name}`"),
    }
}
