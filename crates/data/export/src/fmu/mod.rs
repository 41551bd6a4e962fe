//! Functional mock-up units: FMI 2.0 and 3.0, for co-simulation and model exchange.
//!
//! An FMU is an archive with a description (FMI 2.0.4, Sec. 2.2; FMI 3.0.1, Sec. 2.4), a library
//! for Linux on x86-64, which is the same for every model, the operations of the model as a
//! resource, and the sources of the library for other machines.

mod archive;
mod resource;
mod variables;
mod version2;
mod version3;
mod xml;

use crate::error::ExportError;
use crate::format::Format;
use crate::plan::Plan;
use archive::{Entry, SOURCES, packed};

/// FMU for FMI 2.0.
#[derive(Debug)]
pub struct Fmu2;

/// FMU for FMI 3.0.
#[derive(Debug)]
pub struct Fmu3;

static LIBRARY_2: &[u8] = include_bytes!(concat!(env!("OUT_DIR"), "/fmi2.so"));
static LIBRARY_3: &[u8] = include_bytes!(concat!(env!("OUT_DIR"), "/fmi3.so"));

impl Format for Fmu2 {
    fn name(&self) -> &'static str {
        "fmu2"
    }

    fn extension(&self) -> &'static str {
        "fmu"
    }

    fn write(&self, plan: &Plan) -> Result<Vec<u8>, ExportError> {
        let mut entries = common(plan, version2::description(plan));
        // Empty for other targets: such an FMU has only the sources of its library.
        if !LIBRARY_2.is_empty() {
            let place = format!("binaries/linux64/{}.so", plan.identifier);
            entries.push(Entry::new(place, LIBRARY_2));
        }
        entries
            .extend(SOURCES.iter().filter(|(name, _)| !name.contains("fmi3")).map(Entry::source));
        packed(&entries)
    }
}

impl Format for Fmu3 {
    fn name(&self) -> &'static str {
        "fmu3"
    }

    fn extension(&self) -> &'static str {
        "fmu"
    }

    fn write(&self, plan: &Plan) -> Result<Vec<u8>, ExportError> {
        let mut entries = common(plan, version3::description(plan));
        if !LIBRARY_3.is_empty() {
            let place = format!("binaries/x86_64-linux/{}.so", plan.identifier);
            entries.push(Entry::new(place, LIBRARY_3));
        }
        entries
            .extend(SOURCES.iter().filter(|(name, _)| !name.contains("fmi2")).map(Entry::source));
        entries
            .push(Entry::new("sources/buildDescription.xml", version3::build(plan).into_bytes()));
        packed(&entries)
    }
}

/// Files that both versions have.
fn common(plan: &Plan, description: String) -> Vec<Entry> {
    vec![
        Entry::new("modelDescription.xml", description.into_bytes()),
        Entry::new("resources/model.txt", resource::text(plan).into_bytes()),
        Entry::new("documentation/index.html", xml::documentation(plan).into_bytes()),
    ]
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::subject::Subject;
    use sistership_model::Zoo;

    #[test]
    fn an_fmu_of_a_model_is_the_same_bytes_each_time() {
        let zoo = Zoo::embedded().unwrap();
        let model = zoo.model("kvlcc2").unwrap();
        let law = zoo.law(&model.law).unwrap();
        let sha256 = "0".repeat(64);
        let plan = Plan::new(&Subject { model: &model, law, version: None, sha256 }).unwrap();
        for format in [&Fmu2 as &dyn Format, &Fmu3] {
            let bytes = format.write(&plan).unwrap();
            assert!(bytes.len() > 10_000 && bytes == format.write(&plan).unwrap());
        }
    }
}
