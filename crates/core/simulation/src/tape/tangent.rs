//! Tangents along a tape that has been evaluated for a block of lanes: forward mode, along one
//! input at a time, at the points of all lanes together.

use sistership_formula::Function;

use super::eval::{each, zip};
use super::{Instruction, Lanes, Op, Slot, Slots, Tape};
use crate::wide::{Wide, widest};

/// Input along which a tape is differentiated, and the derivatives.
#[derive(Debug, Clone)]
pub struct Direction<const N: usize> {
    input: u32,
    /// Instructions that depend on the input, in order.
    reached: Vec<Slot>,
    /// Derivatives; zero for instructions that do not depend on the input.
    tangents: Slots<N>,
}

impl<const N: usize> Direction<N> {
    /// Instructions that depend on the input, in order.
    pub fn reached(&self) -> &[Slot] {
        &self.reached
    }

    /// Derivatives after [`Tape::differentiate`], which are read in the same way as values.
    pub fn tangents(&self) -> &[Lanes<N>] {
        &self.tangents
    }
}

/// Factors of the derivatives of the first and the second operand in the derivative of an
/// operation, where these are not trivial.
#[derive(Debug, Clone, Default)]
pub struct Slopes<const N: usize>([Slots<N>; 2]);

impl Tape {
    /// Prepares the differentiation along an input.
    pub fn along<const N: usize>(&self, input: usize) -> Direction<N> {
        let mut tangents = Slots::default();
        tangents.resize(self.len());
        let input = input as u32;
        Direction { input, reached: self.depending_on(input), tangents }
    }

    fn depending_on(&self, input: u32) -> Vec<Slot> {
        let mut depends = vec![false; self.len()];
        for (index, instruction) in self.instructions.iter().enumerate() {
            let reads = |slot: Slot| depends[slot as usize];
            depends[index] = match *instruction {
                Instruction::Op(Op::Input(own)) => own == input,
                Instruction::Op(op) => op.operands().into_iter().flatten().any(reads),
                Instruction::Products { first, from, to } => {
                    reads(first)
                        || self.terms[from as usize..to as usize]
                            .iter()
                            .flatten()
                            .any(|&slot| reads(slot))
                }
            };
        }
        (0..self.len()).filter(|&index| depends[index]).map(|index| index as Slot).collect()
    }

    /// Computes the local slopes at the points that `primal` holds after a [`Tape::run`]; all
    /// directions share them.
    pub fn slopes<const N: usize>(&self, primal: &[Lanes<N>], slopes: &mut Slopes<N>) {
        let [by_a, by_b] = &mut slopes.0;
        by_a.resize(self.len());
        by_b.resize(self.len());
        for (index, instruction) in self.instructions.iter().enumerate() {
            // Fused products need no factors: their tangents follow from the values.
            let Instruction::Op(op) = instruction else { continue };
            if let Some([a, b]) = self.slopes_of(op, index, primal) {
                (by_a[index], by_b[index]) = (a, b);
            }
        }
    }

    fn slopes_of<const N: usize>(
        &self,
        op: &Op,
        index: usize,
        primal: &[Lanes<N>],
    ) -> Option<[Lanes<N>; 2]> {
        let at = |slot: Slot| &primal[slot as usize];
        Some(match *op {
            // `d(x / y) = dx / y - x dy / y^2`
            Op::Divide(a, b) => [each(at(b), |y| 1.0 / y), zip(at(a), at(b), |x, y| -x / (y * y))],
            Op::Power(a, b) => {
                // A constant exponent has no derivative, and ln of a negative base would be NaN.
                let by_exponent = match self.instructions[b as usize] {
                    Instruction::Op(Op::Constant(_)) => [0.0; N],
                    _ => zip(&primal[index], at(a), |z, x| z * x.ln()),
                };
                // `d(x^y) = y x^(y - 1) dx + x^y ln(x) dy`
                [zip(at(a), at(b), |x, y| y * x.powf(y - 1.0)), by_exponent]
            }
            Op::Call1(function, a) => [each(at(a), |x| slope(function, x)), [0.0; N]],
            Op::Call2(function, a, b) => [
                zip(at(a), at(b), |x, y| slopes(function, x, y).0),
                zip(at(a), at(b), |x, y| slopes(function, x, y).1),
            ],
            _ => return None,
        })
    }

    /// Computes the derivatives along the input of a direction, with the local slopes at the points
    /// that `primal` holds after a [`Tape::run`].
    pub fn differentiate<const N: usize>(
        &self,
        direction: &mut Direction<N>,
        primal: &[Lanes<N>],
        slopes: &Slopes<N>,
    ) {
        widest(Differentiation { tape: self, direction, primal, slopes });
    }

    /// Derivative of every output with respect to every input; rows are outputs.
    pub fn jacobian(&self, inputs: &[f64]) -> Vec<Vec<f64>> {
        let point: Vec<Lanes<1>> = inputs.iter().map(|&value| [value]).collect();
        let (mut primal, mut slopes) = (Slots::default(), Slopes::default());
        self.run(&point, &mut primal);
        self.slopes(&primal, &mut slopes);
        let mut rows = vec![Vec::with_capacity(inputs.len()); self.outputs.len()];
        for input in 0..inputs.len() {
            let mut direction = self.along(input);
            self.differentiate(&mut direction, &primal, &slopes);
            for (output, row) in rows.iter_mut().enumerate() {
                row.push(self.read(output, direction.tangents())[0]);
            }
        }
        rows
    }
}

/// Differentiation of all instructions that depend on an input, in order.
struct Differentiation<'a, const N: usize> {
    tape: &'a Tape,
    direction: &'a mut Direction<N>,
    primal: &'a [Lanes<N>],
    slopes: &'a Slopes<N>,
}

impl<const N: usize> Wide for Differentiation<'_, N> {
    #[inline(always)]
    fn go(self) {
        let Self { tape, direction: Direction { input, reached, tangents }, primal, slopes } = self;
        let [by_a, by_b] = [&*slopes.0[0], &*slopes.0[1]];
        let tangents = &mut **tangents;
        for &slot in reached.iter() {
            let index = slot as usize;
            let d = |slot: Slot| &tangents[slot as usize];
            let value = |slot: Slot| &primal[slot as usize];
            // `d(a b) = b da + a db`
            let product = |a: Slot, b: Slot| sum(&times(d(a), value(b)), &times(d(b), value(a)));
            tangents[index] = match tape.instructions[index] {
                Instruction::Products { first, from, to } => {
                    let mut out = *d(first);
                    for &[a, b] in &tape.terms[from as usize..to as usize] {
                        out = sum(&out, &product(a, b));
                    }
                    out
                }
                Instruction::Op(op) => match op {
                    Op::Constant(_) => [0.0; N],
                    Op::Input(own) => [f64::from(u8::from(own == *input)); N],
                    Op::Negate(a) => each(d(a), |x| -x),
                    Op::Add(a, b) => sum(d(a), d(b)),
                    Op::Subtract(a, b) => zip(d(a), d(b), |x, y| x - y),
                    Op::Multiply(a, b) => product(a, b),
                    Op::Call1(_, a) => times(d(a), &by_a[index]),
                    Op::Divide(a, b) | Op::Power(a, b) | Op::Call2(_, a, b) => {
                        sum(&times(d(a), &by_a[index]), &times(d(b), &by_b[index]))
                    }
                    Op::Select(comparison, a, b, then, otherwise) => {
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
fn sum<const N: usize>(a: &Lanes<N>, b: &Lanes<N>) -> Lanes<N> {
    zip(a, b, |x, y| x + y)
}

#[inline(always)]
fn times<const N: usize>(lanes: &Lanes<N>, factors: &Lanes<N>) -> Lanes<N> {
    // Zero times an infinite slope is zero: a direction that does not reach the operand.
    zip(lanes, factors, |x, factor| if x == 0.0 { 0.0 } else { x * factor })
}

/// Derivative of a function of one argument; at a kink, that of the side towards larger arguments.
fn slope(function: Function, x: f64) -> f64 {
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

fn slopes(function: Function, a: f64, b: f64) -> (f64, f64) {
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
    use super::super::testing::tape;
    use super::*;

    #[test]
    fn what_does_not_depend_on_an_input_is_not_visited() {
        let both = tape("u^2*sin(u) + sqrt(1 + v^2)*exp(v)");
        assert!(both.along::<1>(1).reached().len() < both.len());
        let other = tape("u^2").along::<1>(1);
        assert!(other.reached().is_empty(), "{other:?}");
    }

    #[test]
    fn every_lane_has_the_derivatives_at_its_own_point() {
        let tape = tape("if(u > v, u^2*v, atan2(v, u))*exp(-v)/(u*v + 3) + u^2.5*v + max(u, v)");
        let at = |lane: usize| [0.3 + 0.4 * lane as f64, 2.0 - 0.5 * lane as f64];
        let point: [Lanes<5>; 2] = [0, 1].map(|input| std::array::from_fn(|k| at(k)[input]));
        let (mut primal, mut slopes) = (Slots::default(), Slopes::default());
        tape.run(&point, &mut primal);
        tape.slopes(&primal, &mut slopes);
        for input in 0..2 {
            let mut direction = tape.along(input);
            tape.differentiate(&mut direction, &primal, &slopes);
            for (lane, slope) in tape.read(0, direction.tangents()).into_iter().enumerate() {
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
            let tape = tape(text);
            let at = [1.3, -0.7];
            let exact = tape.jacobian(&at)[0].clone();
            for i in 0..2 {
                let mut moved = [at, at];
                moved[0][i] += 1e-6;
                moved[1][i] -= 1e-6;
                let difference = (tape.values(&moved[0])[0] - tape.values(&moved[1])[0]) / 2e-6;
                assert!(
                    (difference - exact[i]).abs() < 1e-7 * (1.0 + difference.abs()),
                    "{text}: {difference} against {}",
                    exact[i]
                );
            }
        }
    }
}
