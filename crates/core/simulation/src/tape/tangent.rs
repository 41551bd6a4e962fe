//! Tangents along a tape that has been evaluated for a block of lanes: forward mode, along one
//! input at a time, at the points of all lanes together.

use sistership_formula::Function;

use super::eval::{map_lanes, zip_lanes};
use super::{LaneValues, ResultSlot, Tape, TapeInstruction, TapeOp, TapeResults};
use crate::simd::{SimdKernel, dispatch_simd};

/// Input along which a tape is differentiated, and the derivatives.
#[derive(Debug, Clone)]
pub struct InputDirection<const N: usize> {
    input: u32,
    /// Instructions that depend on the input, in order.
    reached: Vec<ResultSlot>,
    /// Derivatives; zero for instructions that do not depend on the input.
    tangents: TapeResults<N>,
}

impl<const N: usize> InputDirection<N> {
    /// Instructions that depend on the input, in order.
    pub fn reached_slots(&self) -> &[ResultSlot] {
        &self.reached
    }

    /// Derivatives after [`Tape::differentiate`], which are read in the same way as values.
    pub fn tangents(&self) -> &[LaneValues<N>] {
        &self.tangents
    }
}

/// Factors of the derivatives of the first and the second operand in the derivative of an
/// operation, where these are not trivial.
#[derive(Debug, Clone, Default)]
pub struct LocalSlopes<const N: usize>([TapeResults<N>; 2]);

impl Tape {
    /// Prepares the differentiation along an input.
    pub fn tangent_direction<const N: usize>(&self, input: usize) -> InputDirection<N> {
        let mut tangents = TapeResults::default();
        tangents.resize_to(self.len());
        let input = input as u32;
        InputDirection { input, reached: self.dependent_slots(input), tangents }
    }

    fn dependent_slots(&self, input: u32) -> Vec<ResultSlot> {
        let mut depends = vec![false; self.len()];
        for (index, instruction) in self.instructions.iter().enumerate() {
            let reads = |slot: ResultSlot| depends[slot as usize];
            depends[index] = match *instruction {
                TapeInstruction::Op(TapeOp::Input(own)) => own == input,
                TapeInstruction::Op(op) => op.operands().into_iter().flatten().any(reads),
                TapeInstruction::Products { first, from, to } => {
                    reads(first)
                        || self.terms[from as usize..to as usize]
                            .iter()
                            .flatten()
                            .any(|&slot| reads(slot))
                }
            };
        }
        (0..self.len()).filter(|&index| depends[index]).map(|index| index as ResultSlot).collect()
    }

    /// Computes the local slopes at the points that `primal` holds after a [`Tape::run`]; all
    /// directions share them.
    pub fn compute_slopes<const N: usize>(
        &self,
        primal: &[LaneValues<N>],
        slopes: &mut LocalSlopes<N>,
    ) {
        let [by_a, by_b] = &mut slopes.0;
        by_a.resize_to(self.len());
        by_b.resize_to(self.len());
        for (index, instruction) in self.instructions.iter().enumerate() {
            // Fused products need no factors: their tangents follow from the values.
            let TapeInstruction::Op(op) = instruction else { continue };
            if let Some([a, b]) = self.op_slopes(op, index, primal) {
                (by_a[index], by_b[index]) = (a, b);
            }
        }
    }

    fn op_slopes<const N: usize>(
        &self,
        op: &TapeOp,
        index: usize,
        primal: &[LaneValues<N>],
    ) -> Option<[LaneValues<N>; 2]> {
        let at = |slot: ResultSlot| &primal[slot as usize];
        Some(match *op {
            // `d(x / y) = dx / y - x dy / y^2`
            TapeOp::Divide(a, b) => {
                [map_lanes(at(b), |y| 1.0 / y), zip_lanes(at(a), at(b), |x, y| -x / (y * y))]
            }
            TapeOp::Power(a, b) => {
                // A constant exponent has no derivative, and ln of a negative base would be NaN.
                let by_exponent = match self.instructions[b as usize] {
                    TapeInstruction::Op(TapeOp::Constant(_)) => [0.0; N],
                    _ => zip_lanes(&primal[index], at(a), |z, x| z * x.ln()),
                };
                // `d(x^y) = y x^(y - 1) dx + x^y ln(x) dy`
                [zip_lanes(at(a), at(b), |x, y| y * x.powf(y - 1.0)), by_exponent]
            }
            TapeOp::Call1(function, a) => {
                [map_lanes(at(a), |x| unary_slope(function, x)), [0.0; N]]
            }
            TapeOp::Call2(function, a, b) => [
                zip_lanes(at(a), at(b), |x, y| binary_slopes(function, x, y).0),
                zip_lanes(at(a), at(b), |x, y| binary_slopes(function, x, y).1),
            ],
            _ => return None,
        })
    }

    /// Computes the derivatives along the input of a direction, with the local slopes at the points
    /// that `primal` holds after a [`Tape::run`].
    pub fn differentiate<const N: usize>(
        &self,
        direction: &mut InputDirection<N>,
        primal: &[LaneValues<N>],
        slopes: &LocalSlopes<N>,
    ) {
        dispatch_simd(TapeDifferentiation { tape: self, direction, primal, slopes });
    }

    /// Derivative of every output with respect to every input; rows are outputs.
    pub fn jacobian(&self, inputs: &[f64]) -> Vec<Vec<f64>> {
        let point: Vec<LaneValues<1>> = inputs.iter().map(|&value| [value]).collect();
        let (mut primal, mut slopes) = (TapeResults::default(), LocalSlopes::default());
        self.evaluate(&point, &mut primal);
        self.compute_slopes(&primal, &mut slopes);
        let mut rows = vec![Vec::with_capacity(inputs.len()); self.outputs.len()];
        for input in 0..inputs.len() {
            let mut direction = self.tangent_direction(input);
            self.differentiate(&mut direction, &primal, &slopes);
            for (output, row) in rows.iter_mut().enumerate() {
                row.push(self.output_lanes(output, direction.tangents())[0]);
            }
        }
        rows
    }
}

/// Differentiation of all instructions that depend on an input, in order.
struct TapeDifferentiation<'a, const N: usize> {
    tape: &'a Tape,
    direction: &'a mut InputDirection<N>,
    primal: &'a [LaneValues<N>],
    slopes: &'a LocalSlopes<N>,
}

impl<const N: usize> SimdKernel for TapeDifferentiation<'_, N> {
    #[inline(always)]
    fn run(self) {
        let Self { tape, direction: InputDirection { input, reached, tangents }, primal, slopes } =
            self;
        let [by_a, by_b] = [&*slopes.0[0], &*slopes.0[1]];
        let tangents = &mut **tangents;
        for &slot in reached.iter() {
            let index = slot as usize;
            let d = |slot: ResultSlot| &tangents[slot as usize];
            let value = |slot: ResultSlot| &primal[slot as usize];
            // `d(a b) = b da + a db`
            let product = |a: ResultSlot, b: ResultSlot| {
                add_lanes(&multiply_lanes(d(a), value(b)), &multiply_lanes(d(b), value(a)))
            };
            tangents[index] = match tape.instructions[index] {
                TapeInstruction::Products { first, from, to } => {
                    let mut out = *d(first);
                    for &[a, b] in &tape.terms[from as usize..to as usize] {
                        out = add_lanes(&out, &product(a, b));
                    }
                    out
                }
                TapeInstruction::Op(op) => match op {
                    TapeOp::Constant(_) => [0.0; N],
                    TapeOp::Input(own) => [f64::from(u8::from(own == *input)); N],
                    TapeOp::Negate(a) => map_lanes(d(a), |x| -x),
                    TapeOp::Add(a, b) => add_lanes(d(a), d(b)),
                    TapeOp::Subtract(a, b) => zip_lanes(d(a), d(b), |x, y| x - y),
                    TapeOp::Multiply(a, b) => product(a, b),
                    TapeOp::Call1(_, a) => multiply_lanes(d(a), &by_a[index]),
                    TapeOp::Divide(a, b) | TapeOp::Power(a, b) | TapeOp::Call2(_, a, b) => {
                        add_lanes(
                            &multiply_lanes(d(a), &by_a[index]),
                            &multiply_lanes(d(b), &by_b[index]),
                        )
                    }
                    TapeOp::Select(comparison, a, b, then, otherwise) => {
                        let (mut out, other) = (*d(then), d(otherwise));
                        for k in 0..N {
                            if !comparison.holds(value(a)[k], value(b)[k]) {
                                out[k] = other[k];
                            }
                        }
                        out
                    }
                },
            };
        }
    }
}

#[inline(always)]
fn add_lanes<const N: usize>(a: &LaneValues<N>, b: &LaneValues<N>) -> LaneValues<N> {
    zip_lanes(a, b, |x, y| x + y)
}

#[inline(always)]
fn multiply_lanes<const N: usize>(lanes: &LaneValues<N>, factors: &LaneValues<N>) -> LaneValues<N> {
    // Zero times an infinite slope is zero: a direction that does not reach the operand.
    zip_lanes(lanes, factors, |x, factor| if x == 0.0 { 0.0 } else { x * factor })
}

/// Derivative of a function of one argument; at a kink, that of the side towards larger arguments.
fn unary_slope(function: Function, x: f64) -> f64 {
    match function {
        Function::Sin => x.cos(),
        Function::Cos => -x.sin(),
        Function::Tan => 1.0 / x.cos().powi(2),
        Function::Atan => 1.0 / (1.0 + x * x),
        Function::Sqrt => 0.5 / x.sqrt(),
        Function::Abs => {
            if x >= 0.0 {
                1.0
            } else {
                -1.0
            }
        }
        Function::Exp => x.exp(),
        Function::Log => 1.0 / x,
        Function::Tanh => 1.0 - x.tanh().powi(2),
        Function::Sign | Function::Atan2 | Function::Min | Function::Max => 0.0,
    }
}

fn binary_slopes(function: Function, a: f64, b: f64) -> (f64, f64) {
    match function {
        Function::Atan2 => {
            let square = a * a + b * b;
            // The angle of a zero vector is undefined; its derivative is set to zero.
            if square == 0.0 { (0.0, 0.0) } else { (b / square, -a / square) }
        }
        Function::Min if a <= b => (1.0, 0.0),
        Function::Max if a >= b => (1.0, 0.0),
        _ => (0.0, 1.0),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::super::testing::parse_tape;
    use super::*;

    #[test]
    fn what_does_not_depend_on_an_input_is_not_visited() {
        let both = parse_tape("u^2*sin(u) + sqrt(1 + v^2)*exp(v)");
        assert!(both.tangent_direction::<1>(1).reached_slots().len() < both.len());
        let other = parse_tape("u^2").tangent_direction::<1>(1);
        assert!(other.reached_slots().is_empty(), "{other:?}");
    }

    #[test]
    fn every_lane_has_the_derivatives_at_its_own_point() {
        let tape =
            parse_tape("if(u > v, u^2*v, atan2(v, u))*exp(-v)/(u*v + 3) + u^2.5*v + max(u, v)");
        let at = |lane: usize| [0.3 + 0.4 * lane as f64, 2.0 - 0.5 * lane as f64];
        let point: [LaneValues<5>; 2] = [0, 1].map(|input| std::array::from_fn(|k| at(k)[input]));
        let (mut primal, mut slopes) = (TapeResults::default(), LocalSlopes::default());
        tape.evaluate(&point, &mut primal);
        tape.compute_slopes(&primal, &mut slopes);
        for input in 0..2 {
            let mut direction = tape.tangent_direction(input);
            tape.differentiate(&mut direction, &primal, &slopes);
            for (lane, slope) in tape.output_lanes(0, direction.tangents()).into_iter().enumerate()
            {
                assert_eq!(slope, tape.jacobian(&at(lane))[0][input], "{input} {lane}");
            }
        }
    }

    #[test]
    fn derivatives_agree_with_differences() {
        for text in [
            "u^3*v/(1 + v^2)",
            "atan2(v, u)*abs(v)",
            "max(u, v)*tanh(u*v) - u^-2",
            "sin(u)*cos(v)*log(u)*exp(v) + u^2.5",
        ] {
            let tape = parse_tape(text);
            let at = [1.3, -0.7];
            let exact = tape.jacobian(&at)[0].clone();
            for i in 0..2 {
                let mut moved = [at, at];
                moved[0][i] += 1e-6;
                moved[1][i] -= 1e-6;
                let difference =
                    (tape.evaluate_point(&moved[0])[0] - tape.evaluate_point(&moved[1])[0]) / 2e-6;
                assert!(
                    (difference - exact[i]).abs() < 1e-7 * (1.0 + difference.abs()),
                    "{text}: {difference} against {}",
                    exact[i]
                );
            }
        }
    }
}
