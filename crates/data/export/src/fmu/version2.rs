//! `modelDescription.xml` of FMI 2.0.

use sistership_model::version::code_revision;

use super::variables::{FmuVariable, VariableRole, fmu_variables};
use super::xml::{escape_xml, model_summary, unit_elements, variable_attributes};
use crate::export_plan::ExportPlan;

/// Returns the model description.
pub fn model_description(plan: &ExportPlan) -> String {
    let variables = fmu_variables(plan);
    let listed: String = variables.iter().map(|one| variable_element(one, &variables)).collect();
    let places = |roles: &[VariableRole]| -> String {
        // FMI 2.0 refers to variables by their position, from 1.
        let of = variables.iter().zip(1..).filter(|(variable, _)| roles.contains(&variable.role));
        of.map(|(_, index)| format!("      <Unknown index=\"{index}\"/>\n")).collect()
    };
    let (outputs, rates) =
        (places(&[VariableRole::State, VariableRole::Output]), places(&[VariableRole::Rate]));
    let unknown = places(&[VariableRole::Rate, VariableRole::Output]);
    let (name, model, summary) = (escape_xml(&plan.name), &plan.identifier, model_summary(plan));
    let sources = "<SourceFiles><File name=\"model.c\"/><File name=\"fmi2.c\"/></SourceFiles>";
    let can = "canNotUseMemoryManagementFunctions=\"true\" canGetAndSetFMUstate=\"true\" \
               canSerializeFMUstate=\"true\"";
    format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n\
         <fmiModelDescription fmiVersion=\"2.0\" modelName=\"{name}\" guid=\"{guid}\"\n  \
         description=\"{summary}\"\n  \
         generationTool=\"sistership {tool}\" variableNamingConvention=\"flat\" \
         numberOfEventIndicators=\"0\">\n  \
         <ModelExchange modelIdentifier=\"{model}\" {can}>{sources}</ModelExchange>\n  \
         <CoSimulation modelIdentifier=\"{model}\" canHandleVariableCommunicationStepSize=\"true\" \
         {can}>{sources}</CoSimulation>\n  \
         <UnitDefinitions>\n{units}  </UnitDefinitions>\n  \
         <LogCategories><Category name=\"logStatusError\"/></LogCategories>\n  \
         <DefaultExperiment startTime=\"0.0\" stopTime=\"600.0\" stepSize=\"{step:?}\"/>\n  \
         <ModelVariables>\n{listed}  </ModelVariables>\n  \
         <ModelStructure>\n    <Outputs>\n{outputs}    </Outputs>\n    \
         <Derivatives>\n{rates}    </Derivatives>\n    \
         <InitialUnknowns>\n{unknown}    </InitialUnknowns>\n  </ModelStructure>\n\
         </fmiModelDescription>\n",
        guid = plan.sha256,
        tool = code_revision(),
        units = unit_elements(""),
        step = plan.step_s(),
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
    let derivative = match variable.role {
        VariableRole::Rate => {
            let state = variable.name.trim_end_matches("_dot");
            let index = all.iter().position(|one| one.name == state).map_or(0, |place| place + 1);
            format!(" derivative=\"{index}\"")
        }
        _ => String::new(),
    };
    format!(
        "    <ScalarVariable name=\"{}\" valueReference=\"{}\" description=\"{}\" {kind}>\
         <Real{}{derivative}/></ScalarVariable>\n",
        variable.name,
        variable.reference,
        escape_xml(&variable.description),
        variable_attributes(variable)
    )
}
