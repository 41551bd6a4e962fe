//! Derivatives along a tape that has been evaluated: in several directions at once, forwards.

use sistership_formula::Function;

use super::eval::{each, zip};
use super::{Instruction, Lanes, Op, Slot, Slots, Tape};

impl Tape {
    /// Directional derivatives at the point that `primal` holds after a [`Tape::run`] of one lane:
    /// lane `k` of `seeds[i]` is the change of input `i` in direction `k`.
    pub fn tangents<const N: usize>(
        &self,
        primal: &[Lanes<1>],
        seeds: &[Lanes<N>],
        work: &mut Slots<N>,
    ) {
        work.resize(self.len());
        (0..self.len()).for_each(|index| work[index] = self.tangent(index, primal, seeds, work));
    }

    /// The instructions that depend on some of the inputs.
    pub fn depending_on(&self, inputs: &[usize]) -> Vec<Slot> {
        let mut depends = vec![false; self.len()];
        for (index, instruction) in self.instructions.iter().enumerate() {
            let reads = |slot: Slot| depends[slot as usize];
            depends[index] = match *instruction {
                Instruction::Op(Op::Input(input)) => inputs.contains(&(input as usize)),
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

    /// As [`Tape::tangents`], where nothing but what [`depends`](Tape::depending_on) on the seeded
    /// inputs is visited; `work` is kept from call to call for the same inputs, empty at first.
    pub fn tangents_among<const N: usize>(
        &self,
        depending: &[Slot],
        primal: &[Lanes<1>],
        seeds: &[Lanes<N>],
        work: &mut Slots<N>,
    ) {
        work.resize(self.len());
        for &slot in depending {
            let index = slot as usize;
            work[index] = self.tangent(index, primal, seeds, work);
        }
    }

    #[inline(always)]
    fn tangent<const N: usize>(
        &self,
        index: usize,
        primal: &[Lanes<1>],
        seeds: &[Lanes<N>],
        work: &[Lanes<N>],
    ) -> Lanes<N> {
        match &self.instructions[index] {
            Instruction::Op(op) => tangent(op, index, primal, seeds, work),
            &Instruction::Products { first, from, to } => {
                let mut sum = work[first as usize];
                for &[a, b] in &self.terms[from as usize..to as usize] {
                    let term = tangent(&Op::Multiply(a, b), index, primal, seeds, work);
                    sum = zip(&sum, &term, |x, y| x + y);
                }
                sum
            }
        }
    }

    /// The derivative of every output with respect to every input: rows are outputs.
    pub fn jacobian(&self, inputs: &[f64]) -> Vec<Vec<f64>> {
        let point: Vec<Lanes<1>> = inputs.iter().map(|&value| [value]).collect();
        let (mut primal, mut work) = (Slots::default(), Slots::default());
        self.run(&point, &mut primal);
        let column = |direction: usize, work: &mut Slots<1>| {
            let seeds: Vec<Lanes<1>> =
                (0..inputs.len()).map(|i| [f64::from(u8::from(i == direction))]).collect();
            self.tangents(&primal, &seeds, work);
            (0..self.outputs.len()).map(|output| self.read(output, work)[0]).collect::<Vec<f64>>()
        };
        let columns: Vec<Vec<f64>> =
            (0..inputs.len()).map(|direction| column(direction, &mut work)).collect();
        (0..self.outputs.len())
            .map(|row| columns.iter().map(|column| column[row]).collect())
            .collect()
    }
}

#[inline(always)]
fn times<const N: usize>(lanes: &Lanes<N>, factor: f64) -> Lanes<N> {
    // No direction is moved by an infinite slope that it does not meet.
    each(lanes, |x| if x == 0.0 { 0.0 } else { x * factor })
}

#[inline(always)]
fn tangent<const N: usize>(
    op: &Op,
    index: usize,
    primal: &[Lanes<1>],
    seeds: &[Lanes<N>],
    work: &[Lanes<N>],
) -> Lanes<N> {
    let value = |slot: u32| primal[slot as usize][0];
    let d = |slot: u32| &work[slot as usize];
    let scaled = |slot: u32, factor: f64| times(d(slot), factor);
    let both = |a: u32, by_a: f64, b: u32, by_b: f64| {
        zip(&times(d(a), by_a), &times(d(b), by_b), |x, y| x + y)
    };
    match *op {
        Op::Constant(_) => [0.0; N],
        Op::Input(input) => seeds[input as usize],
        Op::Negate(a) => scaled(a, -1.0),
        Op::Add(a, b) => both(a, 1.0, b, 1.0),
        Op::Subtract(a, b) => both(a, 1.0, b, -1.0),
        Op::Multiply(a, b) => both(a, value(b), b, value(a)),
        Op::Divide(a, b) => both(a, 1.0 / value(b), b, -value(a) / (value(b) * value(b))),
        Op::Power(a, b) => {
            let (x, y) = (value(a), value(b));
            both(a, y * x.powf(y - 1.0), b, primal[index][0] * x.ln())
        }
        Op::Call1(function, a) => scaled(a, slope(function, value(a))),
        Op::Call2(function, a, b) => {
            let (by_a, by_b) = slopes(function, value(a), value(b));
            both(a, by_a, b, by_b)
        }
        Op::Select(comparison, a, b, then, otherwise) => {
            if comparison.holds(value(a), value(b)) {
                *d(then)
            } else {
                *d(otherwise)
            }
        }
    }
}

/// The derivative of a function of one argument; at a kink, that of the side towards larger
/// arguments.
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
    fn what_does_not_depend_on_a_direction_is_not_visited() {
        let tape = tape("u^2*sin(u) + sqrt(1 + v^2)*exp(v)");
        let point = [[1.3], [0.4]];
        let (mut primal, mut all, mut some) =
            (Slots::default(), Slots::default(), Slots::default());
        tape.run(&point, &mut primal);
        let seeds = [[0.0], [1.0]];
        let depending = tape.depending_on(&[1]);
        assert!(depending.len() < tape.len());
        tape.tangents(&primal, &seeds, &mut all);
        tape.tangents_among(&depending, &primal, &seeds, &mut some);
        assert_eq!(tape.read(0, &all), tape.read(0, &some));
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
