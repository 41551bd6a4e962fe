//! Functional mock-up units: FMI 2.0 and 3.0, for co-simulation and model exchange.
//!
//! An FMU is an archive with a description (FMI 2.0.4, Sec. 2.2; FMI 3.0.1, Sec. 2.4), a library
//! for each kind of machine, which is the same for every model, the operations of the model as a
//! resource, and the sources of the library.

pub(crate) mod archive;
mod library;
mod resource;
pub(crate) mod variables;
mod version2;
mod version3;
pub(crate) mod xml;

use sistership_simulation::equations::CoefficientBinding;

use crate::error::ExportError;
use crate::export_plan::ExportPlan;
use crate::format::ModelFormat;
use archive::{ArchiveEntry, SOURCES, pack_archive};
use library::{FmiVersion, library_entries};

/// FMU for FMI 2.0.
#[derive(Debug)]
pub struct Fmi2Format;

/// FMU for FMI 3.0.
#[derive(Debug)]
pub struct Fmi3Format;

impl ModelFormat for Fmi2Format {
    fn name(&self) -> &'static str {
        "fmu2"
    }

    fn extension(&self) -> &'static str {
        "fmu"
    }

    fn settable_names(&self) -> CoefficientBinding {
        CoefficientBinding::AllNames
    }

    fn write(&self, plan: &ExportPlan) -> Result<Vec<u8>, ExportError> {
        let mut entries = common_entries(plan, version2::model_description(plan));
        entries.extend(library_entries(FmiVersion::Two, &plan.identifier));
        entries.extend(
            SOURCES
                .iter()
                .filter(|(name, _)| !name.contains("fmi3"))
                .map(ArchiveEntry::source_entry),
        );
        pack_archive(&entries)
    }
}

impl ModelFormat for Fmi3Format {
    fn name(&self) -> &'static str {
        "fmu3"
    }

    fn extension(&self) -> &'static str {
        "fmu"
    }

    fn settable_names(&self) -> CoefficientBinding {
        CoefficientBinding::AllNames
    }

    fn write(&self, plan: &ExportPlan) -> Result<Vec<u8>, ExportError> {
        let mut entries = common_entries(plan, version3::model_description(plan));
        entries.extend(library_entries(FmiVersion::Three, &plan.identifier));
        entries.extend(
            SOURCES
                .iter()
                .filter(|(name, _)| !name.contains("fmi2"))
                .map(ArchiveEntry::source_entry),
        );
        entries.push(ArchiveEntry::new(
            "sources/buildDescription.xml",
            version3::build_description(plan).into_bytes(),
        ));
        pack_archive(&entries)
    }
}

/// Files that both versions have.
fn common_entries(plan: &ExportPlan, description: String) -> Vec<ArchiveEntry> {
    vec![
        ArchiveEntry::new("modelDescription.xml", description.into_bytes()),
        ArchiveEntry::new("resources/model.txt", resource::resource_text(plan).into_bytes()),
        ArchiveEntry::new("documentation/index.html", xml::documentation_page(plan).into_bytes()),
    ]
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::subject::ExportSubject;
    use sistership_model::Zoo;

    #[test]
    fn an_fmu_of_a_model_is_the_same_bytes_each_time() {
        let zoo = Zoo::load_embedded().unwrap();
        let model = zoo.find_model("kvlcc2").unwrap();
        let law = zoo.law(&model.law).unwrap();
        let sha256 = "0".repeat(64);
        let subject = ExportSubject { model: &model, law, version: None, sha256 };
        for format in [&Fmi2Format as &dyn ModelFormat, &Fmi3Format] {
            let plan = format.prepare(&subject).unwrap();
            let bytes = format.write(&plan).unwrap();
            assert!(bytes.len() > 10_000 && bytes == format.write(&plan).unwrap());
        }
    }
}
