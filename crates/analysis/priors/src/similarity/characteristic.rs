//! Characteristic vectors of ships and their correlation.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use sistership_model::Vessel;

/// A published definition of the characteristic vector.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum VectorDefinition {
    /// `C_b, L/B, B/T, L/V0 (s), Ar/(LT)`: Mei et al. 2019, section III.B and Eqs. 4-5.
    #[serde(rename = "mei-2019")]
    Mei2019,
    /// `C_b, L/B, B/T, L/volume^(1/3), Ar/(LT), Dp/T`: Kanazawa 2023, Eq. 5.18.
    #[serde(rename = "kanazawa-2023")]
    Kanazawa2023,
}

/// A component: its name, and the norm by which it is divided before ships are correlated.
type VectorComponent = (&'static str, f64);

/// Norms of the rows of Mei's Table 4 (Eq. 4). They are those of its five ships: with norms over
/// the ships compared, adding a ship to the zoo would change the correlation of two others.
const MEI_2019: [VectorComponent; 5] = [
    ("C_b", 1.567_947),
    ("L/B", 14.082_16),
    ("B/T", 6.957_127),
    ("L/V0", 62.763_39),
    ("Ar/(LT)", 0.044_075_1),
];

/// Norms over the five full-scale ships of the zoo that have every component, fixed for the same
/// reason.
const KANAZAWA_2023: [VectorComponent; 6] = [
    ("C_b", 1.56),
    ("L/B", 14.79),
    ("B/T", 6.33),
    ("L/volume^(1/3)", 12.75),
    ("Ar/(LT)", 0.04351),
    ("Dp/T", 1.419),
];

/// Largest number of components of a definition.
const MOST_COMPONENTS: usize = 6;

impl VectorDefinition {
    /// All definitions.
    pub const ALL: [Self; 2] = [Self::Mei2019, Self::Kanazawa2023];

    /// Name of the definition.
    pub fn name(self) -> &'static str {
        match self {
            Self::Mei2019 => "mei-2019",
            Self::Kanazawa2023 => "kanazawa-2023",
        }
    }

    /// Definition of a given name.
    pub fn by_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|definition| definition.name() == name)
    }

    fn component_norms(self) -> &'static [VectorComponent] {
        match self {
            Self::Mei2019 => &MEI_2019,
            Self::Kanazawa2023 => &KANAZAWA_2023,
        }
    }
}

/// Characteristic vector of a ship; a component is absent where its particulars do not give it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CharacteristicVector {
    /// Definition of the vector.
    pub definition: VectorDefinition,
    /// Components by name.
    pub values: BTreeMap<String, f64>,
}

impl CharacteristicVector {
    /// Creates a vessel's vector: published values where its file quotes them, otherwise from its
    /// particulars.
    pub fn from_vessel(vessel: &Vessel, definition: VectorDefinition) -> Self {
        // Quoted values take precedence over computed ones.
        let quoted = vessel.quoted_vectors.get(definition.name());
        let computed = |name: &str| vector_component(vessel, name);
        let value = |name: &str| {
            quoted.and_then(|values| values.get(name).copied()).or_else(|| computed(name))
        };
        let values = definition
            .component_norms()
            .iter()
            .filter_map(|(name, _)| Some(((*name).to_owned(), value(name)?)));
        Self { definition, values: values.collect() }
    }

    /// Components that the ship lacks.
    pub fn missing_components(&self) -> Vec<&'static str> {
        let components = self.definition.component_norms().iter();
        components.map(|(name, _)| *name).filter(|name| !self.values.contains_key(*name)).collect()
    }

    /// Components divided by their norms (Mei 2019, Eq. 4).
    pub fn normalised_values(&self) -> BTreeMap<String, f64> {
        let norms: BTreeMap<&str, f64> =
            self.definition.component_norms().iter().copied().collect();
        self.values
            .iter()
            .map(|(name, value)| (name.clone(), value / norms[name.as_str()]))
            .collect()
    }

    /// Pearson's correlation of the normalised components that both have (Mei 2019, Eq. 5); `None`
    /// for fewer than four.
    pub fn correlation(&self, other: &Self) -> Option<f64> {
        self.normalised_components().correlation(&other.normalised_components())
    }

    /// Normalised components for a correlation.
    pub fn normalised_components(&self) -> NormalisedComponents {
        // By name: the order of the sums decides their last bits, which versions keep.
        let mut known = self.definition.component_norms().to_vec();
        known.sort_unstable_by_key(|(name, _)| *name);
        let mut all = [None; MOST_COMPONENTS];
        for (place, (name, norm)) in all.iter_mut().zip(known) {
            *place = self.values.get(name).map(|value| value / norm);
        }
        NormalisedComponents(all)
    }

    /// Component in which two ships differ most, relative to this one.
    pub fn largest_difference(&self, other: &Self) -> Option<(String, f64)> {
        let difference = |(name, a): (&String, &f64)| {
            Some((name.clone(), (other.values.get(name)? / a - 1.0).abs()))
        };
        self.values.iter().filter_map(difference).max_by(|a, b| a.1.total_cmp(&b.1))
    }
}

/// Normalised components of a vector: sufficient for the ranking of many ships.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NormalisedComponents([Option<f64>; MOST_COMPONENTS]);

impl NormalisedComponents {
    /// Correlation as [`CharacteristicVector::correlation`]; both must follow the same definition.
    pub fn correlation(&self, other: &Self) -> Option<f64> {
        let both = || self.0.iter().zip(&other.0).filter_map(|(a, b)| Some(((*a)?, (*b)?)));
        let count = both().count();
        // A correlation of fewer components means little.
        if count < 4 {
            return None;
        }
        let n = count as f64;
        let mean_a = both().map(|pair| pair.0).sum::<f64>() / n;
        let mean_b = both().map(|pair| pair.1).sum::<f64>() / n;
        let sum =
            |f: fn(f64, f64) -> f64| both().map(|(a, b)| f(a - mean_a, b - mean_b)).sum::<f64>();
        let spread = (sum(|a, _| a * a) * sum(|_, b| b * b)).sqrt();
        (spread > 0.0).then(|| (sum(|a, b| a * b) / spread).clamp(-1.0, 1.0))
    }
}

/// Returns the particular that gives a component, besides length and draught.
pub fn component_particular(component: &str) -> Option<&'static str> {
    match component {
        "C_b" => Some("block_coefficient"),
        "L/B" | "B/T" => Some("beam_m"),
        "L/V0" => Some("service_speed_m_s"),
        "L/volume^(1/3)" => Some("displacement_m3"),
        "Ar/(LT)" => Some("rudder_area_m2"),
        "Dp/T" => Some("propeller_diameter_m"),
        _ => None,
    }
}

fn vector_component(vessel: &Vessel, name: &str) -> Option<f64> {
    let of = |name: &str| vessel.particular(name);
    let (l, b, t) = (of("lpp_m"), of("beam_m"), of("draught_m"));
    match name {
        "C_b" => of("block_coefficient"),
        "L/B" => Some(l? / b?),
        "B/T" => Some(b? / t?),
        // A time: that of a model is scaled to full size by Froude's law, otherwise models would be
        // similar to models only.
        "L/V0" => Some(l? / of("service_speed_m_s")? * vessel.file.scale.unwrap_or(1.0).sqrt()),
        "L/volume^(1/3)" => Some(l? / of("displacement_m3")?.cbrt()),
        "Ar/(LT)" => Some(of("rudder_area_m2")? / (l? * t?)),
        "Dp/T" => Some(of("propeller_diameter_m")? / t?),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use sistership_model::Zoo;

    #[test]
    fn norms_are_those_of_table_4() {
        let zoo = Zoo::load_embedded().unwrap();
        let ships = ["kvlcc2", "mariner", "esso-tanker", "sr108", "pcc"]
            .map(|name| zoo.vessel(name).unwrap().clone());
        for (name, norm) in MEI_2019 {
            let square = |v: &std::sync::Arc<Vessel>| {
                CharacteristicVector::from_vessel(v, VectorDefinition::Mei2019).values[name].powi(2)
            };
            let sum = ships.iter().map(square).sum::<f64>().sqrt();
            assert!((sum / norm - 1.0).abs() < 1e-5, "{name}: {sum}");
        }
    }

    #[test]
    fn norms_of_the_zoo() {
        let zoo = Zoo::load_embedded().unwrap();
        let ships = ["kvlcc2", "mariner", "esso-tanker", "sr108", "kcs"]
            .map(|name| zoo.vessel(name).unwrap().clone());
        for (name, norm) in KANAZAWA_2023 {
            let square = |v: &std::sync::Arc<Vessel>| {
                CharacteristicVector::from_vessel(v, VectorDefinition::Kanazawa2023)
                    .values
                    .get(name)
                    .map(|x| x * x)
            };
            let sum = ships.iter().filter_map(square).sum::<f64>().sqrt();
            assert!((sum / norm - 1.0).abs() < 5e-3, "{name}: {sum}");
        }
    }
}
