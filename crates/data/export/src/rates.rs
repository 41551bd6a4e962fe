//! Right-hand side of the equations of motion as statements of a language.

use sistership_simulation::tape::ResultSlot;

use crate::export_plan::ExportPlan;
use crate::expression::{TargetLanguage, instruction_terms, operand_text};
use crate::range;

/// Indices in the state vector of the velocities of the axes X, Y, K, N, and names of their
/// accelerations.
const ACCELERATED: [(usize, &str); 4] = [(0, "a_u"), (1, "a_v"), (3, "a_p"), (2, "a_r")];
/// Indices in the state vector of x, y, psi and phi, whose rates a law may define.
const PLACED: [usize; 4] = [6, 7, 5, 4];

/// Statements from the states to their rates, except the rate of the rudder, which belongs to the
/// steering gear.
pub fn rate_statements(plan: &ExportPlan, language: &dyn TargetLanguage) -> Vec<String> {
    let steps = range::rate_slots(plan).into_iter().filter_map(|slot| {
        Some(
            language
                .write_assignment(&format!("t{slot}"), &instruction_terms(plan, language, slot)?),
        )
    });
    let mut all: Vec<String> = steps.collect();
    all.extend(acceleration_statements(plan, language));
    all.extend(kinematic_statements(plan, language));
    all
}

/// Statements of the accelerations of the axes.
fn acceleration_statements(plan: &ExportPlan, language: &dyn TargetLanguage) -> Vec<String> {
    let listed = plan.listed_operations();
    let forces = listed.forces.map(|slot| slot.map(|slot| operand_text(plan, language, slot)));
    let mut all = Vec::new();
    // A constant mass matrix has been inverted already; otherwise the program solves for the
    // accelerations. Absent entries are those of the identity matrix.
    if listed.mobility.is_none() {
        let zero = || language.number_literal(0.0);
        let mass = std::array::from_fn(|row| {
            std::array::from_fn(|column| match listed.mass[row][column] {
                // An entry of the mass matrix that the law calculates.
                Some(slot) => operand_text(plan, language, slot),
                None => language.number_literal(f64::from(u8::from(row == column))),
            })
        });
        all.extend(
            language.write_solution(&mass, &forces.clone().map(|force| force.unwrap_or_else(zero))),
        );
    }
    for (row, (place, solved)) in ACCELERATED.into_iter().enumerate() {
        let mut sum = match &listed.mobility {
            Some(mobility) => mobility_terms(language, &mobility[row], &forces),
            None => vec![solved.to_owned()],
        };
        sum.extend(listed.accelerations[row].map(|slot| operand_text(plan, language, slot)));
        if sum.is_empty() {
            sum.push(language.number_literal(0.0));
        }
        all.push(language.write_assignment(&language.rate_target(place), &sum));
    }
    all
}

/// Terms of a row of the inverse mass matrix times the forces; an axis that the law lacks adds
/// nothing.
fn mobility_terms(
    language: &dyn TargetLanguage,
    row: &[f64; 4],
    forces: &[Option<String>; 4],
) -> Vec<String> {
    let factors = row.iter().zip(forces).filter(|(factor, _)| **factor != 0.0);
    factors
        .filter_map(|(factor, force)| {
            Some(format!("{}*{}", language.number_literal(*factor), force.as_ref()?))
        })
        .collect()
}

/// Statements of the rates of position and attitude; defaults are those of motion in the horizontal
/// plane.
fn kinematic_statements(plan: &ExportPlan, language: &dyn TargetLanguage) -> Vec<String> {
    use sistership_formula::Function::{Cos, Sin};
    let said = plan.listed_operations().kinematics;
    let state = |place: usize| language.state_name(place);
    let (u, v, psi) = (state(0), state(1), state(5));
    let (sin, cos) = (language.write_call(Sin, &[&psi]), language.write_call(Cos, &[&psi]));
    let one = |(place, slot): (usize, Option<ResultSlot>)| {
        // A rate that the law defines takes precedence.
        let sum = match (slot, place) {
            (Some(slot), _) => operand_text(plan, language, slot),
            (None, 6) => format!("{u}*{cos} - {v}*{sin}"),
            (None, 7) => format!("{u}*{sin} + {v}*{cos}"),
            (None, 5) => state(2),
            (None, _) if plan.has_roll => state(3),
            (None, _) => language.number_literal(0.0),
        };
        language.write_assignment(&language.rate_target(place), &[sum])
    };
    PLACED.into_iter().zip(said).map(one).collect()
}
