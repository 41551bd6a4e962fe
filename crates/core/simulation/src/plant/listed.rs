//! A plant as others may write it down: the operations, and which of their results are what.

use super::Plant;
use crate::tape::{Slot, Tape};

/// The right-hand side of the equations of motion, operation by operation. Axes are in the order X,
/// Y, K, N; a result is named by the place of its instruction on the tape.
#[derive(Debug, Clone)]
pub struct Listed<'a> {
    /// The operations. Inputs are the states `u, v, r, p, phi, psi`, the inputs of the law, and the
    /// coefficients that are left open.
    pub tape: &'a Tape,
    /// Forces, N, and moments, N m; an axis that the law does not have has none.
    pub forces: [Option<Slot>; 4],
    /// The mass matrix by rows; what is absent is that of the identity.
    pub mass: [[Option<Slot>; 4]; 4],
    /// Its inverse by rows, where masses do not change with the motion.
    pub mobility: Option<[[f64; 4]; 4]>,
    /// Rates of x, y, psi and phi, where they are not those of motion in the horizontal plane.
    pub kinematics: [Option<Slot>; 4],
    /// What effects add to the accelerations, m/s2 and rad/s2.
    pub accelerations: [Option<Slot>; 4],
    /// How far the motion is outside of what trials covered, by half ranges; none where that is not
    /// known.
    pub distance: Option<Slot>,
}

impl Plant {
    /// What it does, operation by operation.
    pub fn listed(&self) -> Listed<'_> {
        let slot = |output: Option<usize>| output.map(|output| self.tape.slot(output));
        let rows = |m: &nalgebra::Matrix4<f64>| {
            std::array::from_fn(|row| std::array::from_fn(|column| m[(row, column)]))
        };
        Listed {
            tape: &self.tape,
            forces: self.layout.forces.map(slot),
            mass: self.layout.mass.map(|row| row.map(slot)),
            mobility: self.mobility.as_ref().map(rows),
            kinematics: self.layout.kinematics.map(slot),
            accelerations: self.layout.accelerations.map(slot),
            distance: slot(self.layout.distance),
        }
    }
}
