//! Package of System Structure and Parameterization (SSP 1.0): an FMU as a component of a system,
//! and a file of the values of its parameters and inputs, for tools that vary them or connect ships
//! with other components.

use sistership_model::version::code_revision;
use sistership_simulation::equations::CoefficientBinding;

use crate::error::ExportError;
use crate::export_plan::ExportPlan;
use crate::fmu::Fmi2Format;
use crate::fmu::archive::{ArchiveEntry, pack_archive};
use crate::fmu::variables::{FmuVariable, VariableRole, fmu_variables};
use crate::fmu::xml::{escape_xml, model_summary, unit_elements};
use crate::format::ModelFormat;

/// Package of SSP 1.0 with an FMU for FMI 2.0.
#[derive(Debug)]
pub struct SspFormat;

/// Place of the parameter values in the package.
const PARAMETERS: &str = "resources/parameters.ssv";

impl ModelFormat for SspFormat {
    fn name(&self) -> &'static str {
        "ssp"
    }

    fn extension(&self) -> &'static str {
        "ssp"
    }

    fn settable_names(&self) -> CoefficientBinding {
        CoefficientBinding::AllNames
    }

    fn write(&self, plan: &ExportPlan) -> Result<Vec<u8>, ExportError> {
        let unit = Fmi2Format.write(plan)?;
        pack_archive(&[
            ArchiveEntry::new("SystemStructure.ssd", system_structure(plan).into_bytes()),
            ArchiveEntry::new(PARAMETERS, parameter_values(plan).into_bytes()),
            ArchiveEntry::new(unit_place(plan), unit),
        ])
    }
}

/// Place of the FMU in the package.
fn unit_place(plan: &ExportPlan) -> String {
    format!("resources/{}.fmu", plan.identifier)
}

/// Kind of a variable as a connector; `None` for one that other components do not need.
fn connector_kind(role: VariableRole) -> Option<&'static str> {
    match role {
        VariableRole::State | VariableRole::Output => Some("output"),
        VariableRole::Input => Some("input"),
        VariableRole::Parameter => Some("parameter"),
        VariableRole::Rate => None,
    }
}

/// Description of the system (SSP 1.0, Sec. 5.2). It has the ship alone, so that whoever adds
/// components connects them; the annotation is what the Open Simulation Platform reads.
fn system_structure(plan: &ExportPlan) -> String {
    let variables = fmu_variables(plan);
    let connectors: String = variables.iter().filter_map(connector_element).collect();
    format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n\
         <ssd:SystemStructureDescription name=\"{identifier}\" version=\"1.0\"\n  \
         generationTool=\"sistership {tool}\"\n  {NAMESPACE_COMMON}\n  \
         xmlns:ssd=\"http://ssp-standard.org/SSP1/SystemStructureDescription\"\n  \
         xmlns:osp=\"http://opensimulationplatform.com/SSP/OSPAnnotations\">\n  \
         <ssd:System name=\"system\" description=\"{summary}\">\n    <ssd:Elements>\n      \
         <ssd:Component name=\"ship\" type=\"application/x-fmu-sharedlibrary\" source=\"{unit}\">\n\
         <ssd:Connectors>\n{connectors}</ssd:Connectors>\n        <ssd:ParameterBindings>\n          \
         <ssd:ParameterBinding source=\"{PARAMETERS}\"/>\n        </ssd:ParameterBindings>\n      \
         </ssd:Component>\n    </ssd:Elements>\n  </ssd:System>\n  \
         <ssd:Units>\n{units}  </ssd:Units>\n  \
         <ssd:DefaultExperiment startTime=\"0.0\" stopTime=\"600.0\">\n    <ssd:Annotations>\n      \
         <ssc:Annotation type=\"com.opensimulationplatform\"><osp:Algorithm>\
         <osp:FixedStepAlgorithm baseStepSize=\"{step:?}\"/></osp:Algorithm></ssc:Annotation>\n    \
         </ssd:Annotations>\n  </ssd:DefaultExperiment>\n</ssd:SystemStructureDescription>\n",
        identifier = plan.identifier,
        tool = code_revision(),
        summary = model_summary(plan),
        unit = unit_place(plan),
        units = unit_elements("ssc:"),
        step = plan.step_s(),
    )
}

const NAMESPACE_COMMON: &str = "xmlns:ssc=\"http://ssp-standard.org/SSP1/SystemStructureCommon\"";

fn connector_element(variable: &FmuVariable) -> Option<String> {
    Some(format!(
        "          <ssd:Connector name=\"{}\" kind=\"{}\" description=\"{}\"><ssc:Real{}/>\
         </ssd:Connector>\n",
        variable.name,
        connector_kind(variable.role)?,
        escape_xml(&variable.description),
        unit_attribute(variable)
    ))
}

fn unit_attribute(variable: &FmuVariable) -> String {
    variable.unit.as_ref().map_or(String::new(), |unit| format!(" unit=\"{unit}\""))
}

/// Values of the parameters and inputs (SSP 1.0, Sec. 6).
fn parameter_values(plan: &ExportPlan) -> String {
    let values: String = fmu_variables(plan).iter().filter_map(value_element).collect();
    format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n\
         <ssv:ParameterSet name=\"{identifier}\" version=\"1.0\"\n  \
         generationTool=\"sistership {tool}\"\n  {NAMESPACE_COMMON}\n  \
         xmlns:ssv=\"http://ssp-standard.org/SSP1/SystemStructureParameterValues\">\n  \
         <ssv:Parameters>\n{values}  </ssv:Parameters>\n  <ssv:Units>\n{units}  </ssv:Units>\n\
         </ssv:ParameterSet>\n",
        identifier = plan.identifier,
        tool = code_revision(),
        units = unit_elements("ssc:"),
    )
}

fn value_element(variable: &FmuVariable) -> Option<String> {
    let given = matches!(variable.role, VariableRole::Parameter | VariableRole::Input);
    let value = variable.start.filter(|_| given)?;
    Some(format!(
        "    <ssv:Parameter name=\"{}\" description=\"{}\"><ssv:Real value=\"{value:?}\"{}/>\
         </ssv:Parameter>\n",
        variable.name,
        escape_xml(&variable.description),
        unit_attribute(variable)
    ))
}
