//! Listing of a plant for exports: the operations, and the meaning of their results.

use super::Plant;
use crate::tape::{ResultSlot, Tape, TapeInstruction, TapeOp};

/// Right-hand side of the equations of motion as a list of operations. Axes are in the order X, Y,
/// K, N; a result is given by the place of its instruction on the tape.
#[derive(Debug, Clone)]
pub struct PlantListing<'a> {
    /// The operations. Inputs are the states `u, v, r, p, phi, psi`, the inputs of the law, and the
    /// coefficients, parameters and particulars that are left open.
    pub tape: &'a Tape,
    /// Forces, N, and moments, N m; `None` for an axis that the law does not have.
    pub forces: [Option<ResultSlot>; 4],
    /// Mass matrix by rows; absent entries are those of the identity.
    pub mass: [[Option<ResultSlot>; 4]; 4],
    /// Inverse of the mass matrix by rows, where masses do not change with the motion.
    pub mobility: Option<[[f64; 4]; 4]>,
    /// Rates of x, y, psi and phi, where they are not those of motion in the horizontal plane.
    pub kinematics: [Option<ResultSlot>; 4],
    /// Accelerations that effects add, m/s2 and rad/s2.
    pub accelerations: [Option<ResultSlot>; 4],
    /// Distance of the motion from the range covered by trials, in half ranges; `None` if that
    /// range is unknown.
    pub distance: Option<ResultSlot>,
}

impl Plant {
    /// Returns true if an operation reads an input of the tape, by its place among the inputs.
    pub fn reads_input(&self, place: usize) -> bool {
        let input = TapeInstruction::Op(TapeOp::Input(place as u32));
        self.tape.instructions().contains(&input)
    }

    /// Returns the listing of the plant.
    pub fn to_listing(&self) -> PlantListing<'_> {
        let slot = |output: Option<usize>| output.map(|output| self.tape.output_slot(output));
        let rows = |m: &nalgebra::Matrix4<f64>| {
            std::array::from_fn(|row| std::array::from_fn(|column| m[(row, column)]))
        };
        PlantListing {
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
