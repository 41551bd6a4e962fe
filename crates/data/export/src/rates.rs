//! Right-hand side of the equations of motion as statements of a language.

use sistership_simulation::tape::Slot;

use crate::expression::{Language, operand, terms};
use crate::plan::Plan;
use crate::range;

/// Indices in the state vector of the velocities of the axes X, Y, K, N, and names of their
/// accelerations.
const ACCELERATED: [(usize, &str); 4] = [(0, "a_u"), (1, "a_v"), (3, "a_p"), (2, "a_r")];
/// Indices in the state vector of x, y, psi and phi, whose rates a law may define.
const PLACED: [usize; 4] = [6, 7, 5, 4];

/// Statements from the states to their rates, except the rate of the rudder, which belongs to the
/// steering gear.
pub fn statements(plan: &Plan, language: &dyn Language) -> Vec<String> {
    let steps = range::others(plan).into_iter().filter_map(|slot| {
        Some(language.assign(&format!("t{slot}"), &terms(plan, language, slot)?))
    });
    let mut all: Vec<String> = steps.collect();
    all.extend(accelerations(plan, language));
    all.extend(kinematics(plan, language));
    all
}

/// Statements of the accelerations of the axes.
fn accelerations(plan: &Plan, language: &dyn Language) -> Vec<String> {
    let listed = plan.listed();
    let forces = listed.forces.map(|slot| slot.map(|slot| operand(plan, language, slot)));
    let mut all = Vec::new();
    // A constant mass matrix has been inverted already; otherwise the program solves for the
    // accelerations. Absent entries are those of the identity matrix.
    if listed.mobility.is_none() {
        let zero = || language.number(0.0);
        let mass = std::array::from_fn(|row| {
            std::array::from_fn(|column| match listed.mass[row][column] {
                // An entry of the mass matrix that the law calculates.
                Some(slot) => operand(plan, language, slot),
                None => language.number(f64::from(u8::from(row == column))),
            })
        });
        all.extend(language.solve(&mass, &forces.clone().map(|force| force.unwrap_or_else(zero))));
    }
    for (row, (place, solved)) in ACCELERATED.into_iter().enumerate() {
        let mut sum = match &listed.mobility {
            Some(mobility) => products(language, &mobility[row], &forces),
            None => vec![solved.to_owned()],
        };
        sum.extend(listed.accelerations[row].map(|slot| operand(plan, language, slot)));
        if sum.is_empty() {
            sum.push(language.number(0.0));
        }
        all.push(language.assign(&language.rate(place), &sum));
    }
    all
}

/// Terms of a row of the inverse mass matrix times the forces; an axis that the law lacks adds
/// nothing.
fn products(language: &dyn Language, row: &[f64; 4], forces: &[Option<String>; 4]) -> Vec<String> {
    let factors = row.iter().zip(forces).filter(|(factor, _)| **factor != 0.0);
    factors
        .filter_map(|(factor, force)| {
            Some(format!("{}*{}", language.number(*factor), force.as_ref()?))
        })
        .collect()
}

/// Statements of the rates of position and attitude; defaults are those of motion in the horizontal
/// plane.
fn kinematics(plan: &Plan, language: &dyn Language) -> Vec<String> {
    use sistership_formula::Function::{Cos, Sin};
    let said = plan.listed().kinematics;
    let state = |place: usize| language.state(place);
    let (u, v, psi) = (state(0), state(1), state(5));
    let (sin, cos) = (language.call(Sin, &[&psi]), language.call(Cos, &[&psi]));
    let one = |(place, slot): (usize, Option<Slot>)| {
        // A rate that the law defines takes precedence.
        let sum = match (slot, place) {
            (Some(slot), _) => operand(plan, language, slot),
            (None, 6) => format!("{u}*{cos} - {v}*{sin}"),
            (None, 7) => format!("{u}*{sin} + {v}*{cos}"),
            (None, 5) => state(2),
            (None, _) if plan.has_roll => state(3),
            (None, _) => language.number(0.0),
        };
        language.assign(&language.rate(place), &[sum])
    };
    PLACED.into_iter().zip(said).map(one).collect()
}
