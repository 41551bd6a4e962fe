//! Mei et al. 2019, Tables 5 and 6, from Table 4; and SR108's sources by the three steps of
//! Kanazawa 2023, 5.1.2.

use sistership_model::Zoo;
use sistership_priors::similarity::{CharacteristicVector, VectorDefinition};
use sistership_priors::source::rank_similar;

/// Table 5 as printed: the normalised vectors.
const TABLE_5: [(&str, [f64; 5]); 5] = [
    ("kvlcc2", [0.573, 0.392, 0.401, 0.639, 0.466]),
    ("mariner", [0.376, 0.494, 0.446, 0.332, 0.273]),
    ("esso-tanker", [0.529, 0.454, 0.371, 0.590, 0.372]),
    ("sr108", [0.358, 0.490, 0.430, 0.224, 0.495]),
    ("pcc", [0.349, 0.397, 0.564, 0.287, 0.570]),
];
const COMPONENTS: [&str; 5] = ["C_b", "L/B", "B/T", "L/V0", "Ar/(LT)"];
/// Table 6 as printed: the correlations with KVLCC2.
const TABLE_6: [(&str, f64); 4] =
    [("mariner", -0.576), ("esso-tanker", 0.851), ("sr108", -0.887), ("pcc", -0.723)];

fn zoo() -> Zoo {
    Zoo::load_embedded().unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn tables_5_and_6_of_mei_2019() {
    let zoo = zoo();
    for (ship, printed) in TABLE_5 {
        let normalised = CharacteristicVector::from_vessel(
            zoo.vessel(ship).expect("in the zoo"),
            VectorDefinition::Mei2019,
        )
        .normalised_values();
        for (name, printed) in COMPONENTS.iter().zip(printed) {
            assert!(
                (normalised[*name] - printed).abs() < 0.0011,
                "{ship} {name}: {} against {printed}",
                normalised[*name]
            );
        }
    }
    let ranking = rank_similar(
        &zoo,
        zoo.vessel("kvlcc2").expect("in the zoo"),
        Some(VectorDefinition::Mei2019),
        &[],
    )
    .ranking;
    for (ship, printed) in TABLE_6 {
        let found = ranking
            .iter()
            .find(|ranked| ranked.ship == ship)
            .and_then(|ranked| ranked.correlation)
            .expect("a correlation");
        println!("KVLCC2 against {ship}: {found:.4}, printed {printed}");
        assert!((found - printed).abs() < 0.0006, "{ship}");
    }
}

#[test]
fn mariner_is_an_eligible_source_for_sr108() {
    let zoo = zoo();
    let ranking = rank_similar(&zoo, zoo.vessel("sr108").expect("in the zoo"), None, &[]).ranking;
    for ranked in &ranking {
        println!(
            "{:<20} {:?} {} {}",
            ranked.ship,
            ranked.correlation,
            ranked.eligible,
            ranked.reasons.join("; ")
        );
    }
    let mariner = ranking.iter().find(|ranked| ranked.ship == "mariner").expect("ranked");
    assert!(mariner.eligible, "{:?}", mariner.reasons);
    let tanker = ranking.iter().find(|ranked| ranked.ship == "esso-tanker").expect("ranked");
    assert!(!tanker.eligible && tanker.reasons[0].contains("category"));
}

/// The vectors printed under Eq. 5.18.
#[test]
fn vectors_of_kanazawa_2023() {
    let zoo = zoo();
    let printed = [
        ("mariner", [0.59, 6.94, 2.82, 6.08, 0.023, 0.81]),
        ("sr108", [0.56, 6.89, 2.99, 6.32, 0.022, 0.77]),
    ];
    for (ship, printed) in printed {
        let values = CharacteristicVector::from_vessel(
            zoo.vessel(ship).expect("in the zoo"),
            VectorDefinition::Kanazawa2023,
        )
        .values;
        let names = ["C_b", "L/B", "B/T", "L/volume^(1/3)", "Ar/(LT)", "Dp/T"];
        for (name, printed) in names.iter().zip(printed) {
            let half_digit = if printed < 0.1 { 0.0005 } else { 0.0051 };
            assert!(
                (values[*name] - printed).abs() <= half_digit,
                "{ship} {name}: {} against {printed}",
                values[*name]
            );
        }
    }
}
