//! Consistency of particulars.

use sistership_model::Vessel;

use crate::validation::finding::ReviewFinding;

/// Value of a particular of a ship by its name.
type ParticularLookup<'a> = &'a dyn Fn(&str) -> Option<f64>;

/// A ratio of particulars, and its usual range.
struct ParticularRatio {
    about: &'static str,
    words: &'static str,
    of: fn(ParticularLookup<'_>) -> Option<f64>,
    usual: std::ops::RangeInclusive<f64>,
}

const G: f64 = 9.80665;

/// The ranges are wide: what lies outside is more often a wrong unit than an unusual ship.
const RATIOS: [ParticularRatio; 8] = [
    ParticularRatio {
        about: "beam_m",
        words: "L/B",
        of: |p| Some(p("lpp_m")? / p("beam_m")?),
        usual: 2.5..=12.0,
    },
    ParticularRatio {
        about: "draught_m",
        words: "B/T",
        of: |p| Some(p("beam_m")? / p("draught_m")?),
        usual: 1.3..=8.0,
    },
    ParticularRatio {
        about: "block_coefficient",
        words: "C_b",
        of: |p| p("block_coefficient"),
        usual: 0.3..=0.95,
    },
    ParticularRatio {
        about: "x_g_m",
        words: "|x_G|/L",
        of: |p| Some(p("x_g_m")?.abs() / p("lpp_m")?),
        usual: 0.0..=0.08,
    },
    ParticularRatio {
        about: "yaw_gyradius_ratio",
        words: "k_zz/L",
        of: |p| p("yaw_gyradius_ratio"),
        usual: 0.2..=0.3,
    },
    ParticularRatio {
        about: "rudder_area_m2",
        words: "A_R/(L T)",
        of: |p| Some(p("rudder_area_m2")? / (p("lpp_m")? * p("draught_m")?)),
        usual: 0.008..=0.06,
    },
    ParticularRatio {
        about: "propeller_diameter_m",
        words: "D_p/T",
        of: |p| Some(p("propeller_diameter_m")? / p("draught_m")?),
        usual: 0.3..=1.0,
    },
    ParticularRatio {
        about: "service_speed_m_s",
        words: "Froude number",
        of: |p| Some(p("service_speed_m_s")? / (G * p("lpp_m")?).sqrt()),
        usual: 0.05..=0.6,
    },
];

/// Relative difference of displacements from which on it is reported.
const DISPLACEMENT_SHARE: f64 = 0.02;

/// Checks that the particulars of a ship are consistent.
pub fn particular_findings(vessel: &Vessel) -> Vec<ReviewFinding> {
    let of = |name: &str| vessel.particular(name);
    let ratios = RATIOS.iter().filter_map(|ratio| {
        let value = (ratio.of)(&of).filter(|value| !ratio.usual.contains(value))?;
        let (low, high) = (ratio.usual.start(), ratio.usual.end());
        let message = format!("{} is {value:.3}; ships have {low} to {high}", ratio.words);
        Some(ReviewFinding::for_review(format!("particulars.{}", ratio.about), message))
    });
    ratios.chain(displacement_findings(vessel)).chain(missing_particulars(vessel)).collect()
}

/// Findings on displacement by volume, by mass and by block coefficient.
fn displacement_findings(vessel: &Vessel) -> Vec<ReviewFinding> {
    // Stated values only: a derived displacement agrees by definition.
    let stated = |name: &str| vessel.particulars.get(name).map(|quantity| quantity.value);
    let density = vessel.particular("water_density_kg_m3");
    let boxed = || Some(stated("lpp_m")? * stated("beam_m")? * stated("draught_m")?);
    let by_block = || Some(stated("block_coefficient")? * boxed()?);
    let by_mass = || Some(stated("mass_kg")? / density?);
    let Some(volume) = stated("displacement_m3") else { return Vec::new() };
    let differs = |words: &str, other: Option<f64>| {
        let other = other.filter(|other| (other / volume - 1.0).abs() > DISPLACEMENT_SHARE)?;
        let message = format!("{volume:.4} m3, but {words} gives {other:.4} m3");
        Some(ReviewFinding::for_review("particulars.displacement_m3", message))
    };
    let pairs = [differs("C_b L B T", by_block()), differs("the mass over the density", by_mass())];
    pairs.into_iter().flatten().collect()
}

/// Finding on particulars that similarity and transfer need and the ship lacks.
fn missing_particulars(vessel: &Vessel) -> Vec<ReviewFinding> {
    const NEEDED: [&str; 4] = ["lpp_m", "beam_m", "draught_m", "displacement_m3"];
    let lacks = |name: &&&str| vessel.particular(name).is_none();
    let lacking: Vec<&str> = NEEDED.iter().filter(lacks).copied().collect();
    if lacking.is_empty() {
        return Vec::new();
    }
    let message =
        format!("{} are missing: no similarity to other ships can be computed", lacking.join(", "));
    vec![ReviewFinding::for_review("particulars", message)]
}
