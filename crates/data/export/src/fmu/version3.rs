//! `modelDescription.xml` and `buildDescription.xml` of FMI 3.0.

use sistership_model::version::code_revision;

use super::variables::{FmuVariable, VariableRole, fmu_variables};
use super::xml::{escape_xml, model_summary, unit_elements, variable_attributes};
use crate::export_plan::ExportPlan;

/// Returns the model description.
pub fn model_description(plan: &ExportPlan) -> String {
    let variables = fmu_variables(plan);
    let listed: String = variables.iter().map(|one| variable_element(one, &variables)).collect();
    let structure = |roles: &[VariableRole], element: &str| -> String {
        let of = variables.iter().filter(|variable| roles.contains(&variable.role));
        // FMI 3.0 refers to variables by their value reference.
        of.map(|one| format!("    <{element} valueReference=\"{}\"/>\n", one.reference)).collect()
    };
    let (name, model, summary) = (escape_xml(&plan.name), &plan.identifier, model_summary(plan));
    let can = "canGetAndSetFMUState=\"true\" canSerializeFMUState=\"true\"";
    format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n\
         <fmiModelDescription fmiVersion=\"3.0\" modelName=\"{name}\" \
         instantiationToken=\"{token}\"\n  description=\"{summary}\"\n  \
         generationTool=\"sistership {tool}\" variableNamingConvention=\"flat\">\n  \
         <ModelExchange modelIdentifier=\"{model}\" {can}/>\n  \
         <CoSimulation modelIdentifier=\"{model}\" canHandleVariableCommunicationStepSize=\"true\" \
         {can}/>\n  \
         <UnitDefinitions>\n{units}  </UnitDefinitions>\n  \
         <LogCategories><Category name=\"logStatusError\"/></LogCategories>\n  \
         <DefaultExperiment startTime=\"0.0\" stopTime=\"600.0\" stepSize=\"{step:?}\"/>\n  \
         <ModelVariables>\n    \
         <Float64 name=\"time\" valueReference=\"0\" causality=\"independent\" \
         variability=\"continuous\" unit=\"s\"/>\n{listed}  </ModelVariables>\n  \
         <ModelStructure>\n{outputs}{rates}{unknown}  </ModelStructure>\n\
         </fmiModelDescription>\n",
        token = plan.sha256,
        tool = code_revision(),
        units = unit_elements(""),
        step = plan.step_s(),
        outputs = structure(&[VariableRole::State, VariableRole::Output], "Output"),
        rates = structure(&[VariableRole::Rate], "ContinuousStateDerivative"),
        unknown = structure(&[VariableRole::Rate, VariableRole::Output], "InitialUnknown"),
    )
}

fn variable_element(variable: &FmuVariable, all: &[FmuVariable]) -> String {
    let kind = match variable.role {
        VariableRole::State => "causality=\"output\" variability=\"continuous\" initial=\"exact\"",
        VariableRole::Rate => {
            "causality=\"local\" variability=\"continuous\" initial=\"calculated\""
        }
        VariableRole::Input => "causality=\"input\" variability=\"continuous\"",
        VariableRole::Parameter => {
            "causality=\"parameter\" variability=\"tunable\" initial=\"exact\""
        }
        VariableRole::Output => {
            "causality=\"output\" variability=\"continuous\" initial=\"calculated\""
        }
    };
    let state = variable.name.trim_end_matches("_dot");
    let of = all.iter().find(|one| variable.role == VariableRole::Rate && one.name == state);
    let derivative =
        of.map_or(String::new(), |state| format!(" derivative=\"{}\"", state.reference));
    format!(
        "    <Float64 name=\"{}\" valueReference=\"{}\" description=\"{}\" \
         {kind}{}{derivative}/>\n",
        variable.name,
        variable.reference,
        escape_xml(&variable.description),
        variable_attributes(variable)
    )
}

/// Returns the build description, for compiling the library from its sources.
pub fn build_description(plan: &ExportPlan) -> String {
    format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n\
         <fmiBuildDescription fmiVersion=\"3.0\">\n  \
         <BuildConfiguration modelIdentifier=\"{}\">\n    \
         <SourceFileSet language=\"C99\">\n      \
         <SourceFile name=\"model.c\"/>\n      <SourceFile name=\"fmi3.c\"/>\n    \
         </SourceFileSet>\n  </BuildConfiguration>\n</fmiBuildDescription>\n",
        plan.identifier
    )
}
