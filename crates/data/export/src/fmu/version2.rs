//! `modelDescription.xml` of FMI 2.0.

use sistership_model::version::code_revision;

use super::variables::{Role, Variable, all};
use super::xml::{attributes, escaped, summary, units};
use crate::plan::Plan;

/// Returns the model description.
pub fn description(plan: &Plan) -> String {
    let variables = all(plan);
    let listed: String = variables.iter().map(|one| variable(one, &variables)).collect();
    let places = |roles: &[Role]| -> String {
        // FMI 2.0 refers to variables by their position, from 1.
        let of = variables.iter().zip(1..).filter(|(variable, _)| roles.contains(&variable.role));
        of.map(|(_, index)| format!("      <Unknown index=\"{index}\"/>\n")).collect()
    };
    let (outputs, rates) = (places(&[Role::State, Role::Output]), places(&[Role::Rate]));
    let unknown = places(&[Role::Rate, Role::Output]);
    let (name, model, summary) = (escaped(&plan.name), &plan.identifier, summary(plan));
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
        units = units(),
        step = plan.step_s(),
    )
}

fn variable(variable: &Variable, all: &[Variable]) -> String {
    let kind = match variable.role {
        Role::State => "causality=\"output\" variability=\"continuous\" initial=\"exact\"",
        Role::Rate => "causality=\"local\" variability=\"continuous\" initial=\"calculated\"",
        Role::Input => "causality=\"input\" variability=\"continuous\"",
        Role::Parameter => "causality=\"parameter\" variability=\"fixed\" initial=\"exact\"",
        Role::Output => "causality=\"output\" variability=\"continuous\" initial=\"calculated\"",
    };
    let derivative = match variable.role {
        Role::Rate => {
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
        escaped(&variable.description),
        attributes(variable)
    )
}
