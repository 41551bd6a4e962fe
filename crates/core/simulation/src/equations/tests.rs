#![allow(clippy::unwrap_used)]
use sistership_model::law::Law;
use sistership_model::{Model, Zoo};

use super::{EquationLowering, EquationsOfMotion, PlantError};
use crate::Plant;
use crate::candidates::CandidateSystem;
use crate::sensitivity::SensitiveSystem;

/// Result of each view for a model.
fn refusals(model: &Model, law: &Law) -> [Option<PlantError>; 3] {
    [
        Plant::new(model, law).err(),
        CandidateSystem::new(model, law).err(),
        SensitiveSystem::new(model, law).err(),
    ]
}

#[test]
fn every_view_refuses_what_the_model_does_not_give_alike() {
    let zoo = Zoo::load_embedded().unwrap();
    let complete = zoo.find_model("mariner").unwrap();
    let law = zoo.law(&complete.law).unwrap();
    assert_eq!(refusals(&complete, law), [None, None, None]);
    let mut missing = Vec::new();
    for name in law.parameters.keys() {
        let mut model = complete.clone();
        model.parameters.remove(name);
        let [plant, candidates, sensitivities] = refusals(&model, law);
        assert_eq!((&plant, &plant), (&candidates, &sensitivities), "{name}");
        missing.extend(plant);
    }
    assert!(!missing.is_empty());
    assert!(missing.iter().all(|error| matches!(error, PlantError::Missing { .. })), "{missing:?}");
}

#[test]
fn a_tape_takes_states_and_inputs_and_folds_all_else() {
    let zoo = Zoo::load_embedded().unwrap();
    let model = zoo.find_model("mariner").unwrap();
    let equations = EquationsOfMotion::new(&model, zoo.law(&model.law).unwrap()).unwrap();
    let mut lowering = EquationLowering::new(&equations, &equations.tape_input_names());
    let mass = lowering.add_mass_matrix(equations.axes()).unwrap();
    let tape = lowering.finish();
    assert_eq!(tape.input_names(), equations.tape_input_names());
    assert_eq!(mass.len(), equations.axes().len().pow(2));
    assert!(mass.iter().flatten().all(|&entry| tape.constant_output(entry).is_some()));
}
