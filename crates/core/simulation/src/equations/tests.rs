#![allow(clippy::unwrap_used)]
use sistership_model::law::Law;
use sistership_model::{Model, Zoo};

use super::{EquationsOfMotion, Lowering, PlantError};
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
    let zoo = Zoo::embedded().unwrap();
    let complete = zoo.model("mariner").unwrap();
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
    let zoo = Zoo::embedded().unwrap();
    let model = zoo.model("mariner").unwrap();
    let equations = EquationsOfMotion::new(&model, zoo.law(&model.law).unwrap()).unwrap();
    let mut lowering = Lowering::new(&equations, &equations.names());
    let mass = lowering.mass_matrix(equations.axes()).unwrap();
    let tape = lowering.finish();
    assert_eq!(tape.inputs(), equations.names());
    assert_eq!(mass.len(), equations.axes().len().pow(2));
    assert!(mass.iter().flatten().all(|&entry| tape.constant_output(entry).is_some()));
}
