//! Ships that are strangers: their kin, their likeness, and which are for work.

use sistership_model::quantity::Quantity;
use sistership_model::{Model, Vessel};
use sistership_priors::similarity::{CharacteristicVector, VectorDefinition};

/// Ships that are one hull at several scales or in several hands, or sisters that were identified
/// together: none may be the source of its own kin.
const KIN: [&[&str]; 5] = [
    &["kcs", "kcs-2m", "kcs-3m"],
    &["kvlcc2", "kvlcc2-7m"],
    &["sr108", "s175-3m5"],
    &["gunnerus-29m", "gunnerus-34m"],
    &["fs-bitumen-1", "fs-bitumen-2"],
];

/// Whether two ships are of one hull.
pub fn kin(a: &str, b: &str) -> bool {
    a == b || KIN.iter().any(|hull| hull.contains(&a) && hull.contains(&b))
}

/// Whether a ship is for work, by a rule that was set before anything was fitted: the sum of the
/// bytes of its name, or of that of the first of its kin, is even. All others are for judgement.
pub fn is_for_work(name: &str) -> bool {
    let first = KIN.iter().find(|hull| hull.contains(&name)).map_or(name, |hull| hull[0]);
    first.bytes().map(u32::from).sum::<u32>().is_multiple_of(2)
}

/// The ship with its speed, and without its models and trials.
pub fn bare(vessel: &Vessel, model: &Model) -> Vessel {
    let mut bare = vessel.clone();
    bare.file.models = Vec::new();
    bare.file.free_running = Vec::new();
    if let Some(speed) = model.speed_m_s {
        let quantity = Quantity::new(speed, "model");
        bare.particulars.insert("service_speed_m_s".into(), quantity);
    }
    bare
}

/// Measures of similarity, by name.
pub const MEASURES: [&str; 4] =
    ["correlation, Mei", "correlation, Kanazawa", "difference, Mei", "difference, Kanazawa"];

/// By each measure, larger for ships that are more alike.
pub fn likeness(a: &Vessel, b: &Vessel) -> Vec<Option<f64>> {
    let vectors = |definition| {
        (
            CharacteristicVector::from_vessel(a, definition),
            CharacteristicVector::from_vessel(b, definition),
        )
    };
    let definitions = [VectorDefinition::Mei2019, VectorDefinition::Kanazawa2023];
    let correlations = definitions.map(|definition| {
        let (a, b) = vectors(definition);
        a.correlation(&b)
    });
    let differences = definitions.map(|definition| {
        let (a, b) = vectors(definition);
        a.largest_difference(&b).map(|(_, difference)| -difference)
    });
    correlations.into_iter().chain(differences).collect()
}
