//! Evaluation of a tape for a block of lanes.

use sistership_formula::Function;

use super::{Instruction, Lanes, Op, Slot, Slots, Tape};
use crate::wide::{Wide, widest};

impl Tape {
    /// Evaluates every operation; `work` is reused from call to call and holds the results.
    /// `inputs[i]` are the lanes of input `i`.
    pub fn run<const N: usize>(&self, inputs: &[Lanes<N>], work: &mut Slots<N>) {
        work.resize(self.len());
        widest(Evaluation { tape: self, inputs, work });
    }

    /// Evaluates some of the operations, in the given order; the others keep the results that
    /// `work` holds after a [`Tape::run`].
    pub fn run_among<const N: usize>(
        &self,
        among: &[Slot],
        inputs: &[Lanes<N>],
        work: &mut Slots<N>,
    ) {
        widest(PartialEvaluation { tape: self, among, inputs, work });
    }

    /// Returns an output after [`Tape::run`].
    pub fn read<const N: usize>(&self, output: usize, work: &[Lanes<N>]) -> Lanes<N> {
        work[self.outputs[output] as usize]
    }

    /// Returns a reference to an output after [`Tape::run`].
    #[inline(always)]
    pub(crate) fn at<'w, const N: usize>(
        &self,
        output: usize,
        work: &'w [Lanes<N>],
    ) -> &'w Lanes<N> {
        &work[self.outputs[output] as usize]
    }

    /// Evaluates every output at one point; allocates, so that it is not for inner loops.
    pub fn values(&self, inputs: &[f64]) -> Vec<f64> {
        let inputs: Vec<Lanes<1>> = inputs.iter().map(|&value| [value]).collect();
        let mut work = Slots::default();
        self.run(&inputs, &mut work);
        (0..self.outputs.len()).map(|output| self.read(output, &work)[0]).collect()
    }
}

/// Evaluation of every instruction in order; `work` has one element for each instruction.
struct Evaluation<'a, const N: usize> {
    tape: &'a Tape,
    inputs: &'a [Lanes<N>],
    work: &'a mut [Lanes<N>],
}

impl<const N: usize> Wide for Evaluation<'_, N> {
    #[inline(always)]
    fn go(self) {
        for (index, instruction) in self.tape.instructions.iter().enumerate() {
            self.work[index] = self.tape.result(instruction, self.inputs, self.work);
        }
    }
}

/// Evaluation of some instructions in order.
struct PartialEvaluation<'a, const N: usize> {
    tape: &'a Tape,
    among: &'a [Slot],
    inputs: &'a [Lanes<N>],
    work: &'a mut [Lanes<N>],
}

impl<const N: usize> Wide for PartialEvaluation<'_, N> {
    #[inline(always)]
    fn go(self) {
        for &slot in self.among {
            let instruction = &self.tape.instructions[slot as usize];
            self.work[slot as usize] = self.tape.result(instruction, self.inputs, self.work);
        }
    }
}

impl Tape {
    #[inline(always)]
    fn result<const N: usize>(
        &self,
        instruction: &Instruction,
        inputs: &[Lanes<N>],
        work: &[Lanes<N>],
    ) -> Lanes<N> {
        match instruction {
            Instruction::Op(op) => step(op, inputs, work),
            &Instruction::Products { first, from, to } => {
                products(first, &self.terms[from as usize..to as usize], work)
            }
        }
    }
}

#[inline(always)]
fn step<const N: usize>(op: &Op, inputs: &[Lanes<N>], work: &[Lanes<N>]) -> Lanes<N> {
    let at = |slot: u32| &work[slot as usize];
    match *op {
        Op::Constant(value) => [value; N],
        Op::Input(index) => inputs[index as usize],
        Op::Negate(a) => each(at(a), |x| -x),
        Op::Add(a, b) => zip(at(a), at(b), |x, y| x + y),
        Op::Subtract(a, b) => zip(at(a), at(b), |x, y| x - y),
        Op::Multiply(a, b) => zip(at(a), at(b), |x, y| x * y),
        Op::Divide(a, b) => zip(at(a), at(b), |x, y| x / y),
        Op::Power(a, b) => zip(at(a), at(b), f64::powf),
        Op::Call1(function, a) => call(function, at(a)),
        Op::Call2(function, a, b) => zip(at(a), at(b), |x, y| function.apply(x, y)),
        Op::Select(comparison, a, b, c, d) => {
            // Both alternatives are evaluated for all lanes; the comparison selects lane by lane.
            let (mut out, other) = (*at(c), at(d));
            for k in 0..N {
                if !comparison.holds(at(a)[k], at(b)[k]) {
                    out[k] = other[k];
                }
            }
            out
        }
    }
}

#[inline(always)]
fn products<const N: usize>(first: Slot, terms: &[[Slot; 2]], work: &[Lanes<N>]) -> Lanes<N> {
    let mut sum = work[first as usize];
    for &[a, b] in terms {
        let (a, b) = (&work[a as usize], &work[b as usize]);
        // Separate multiplication and addition: a fused one would round differently.
        for k in 0..N {
            sum[k] += a[k] * b[k];
        }
    }
    sum
}

#[inline(always)]
pub(super) fn zip<const N: usize>(
    a: &Lanes<N>,
    b: &Lanes<N>,
    f: impl Fn(f64, f64) -> f64,
) -> Lanes<N> {
    let mut out = [0.0; N];
    for k in 0..N {
        out[k] = f(a[k], b[k]);
    }
    out
}

/// Applies a function to each lane. A loop, since `map` on arrays is not always inlined, and a call
/// for each lane costs more than the function.
#[inline(always)]
pub(super) fn each<const N: usize>(a: &Lanes<N>, f: impl Fn(f64) -> f64) -> Lanes<N> {
    let mut out = [0.0; N];
    for k in 0..N {
        out[k] = f(a[k]);
    }
    out
}

/// Applies a function of one argument. The cheap functions are written out, so that their loops
/// over the lanes become vector instructions.
#[inline(always)]
fn call<const N: usize>(function: Function, a: &Lanes<N>) -> Lanes<N> {
    match function {
        Function::Sqrt => each(a, f64::sqrt),
        Function::Abs => each(a, f64::abs),
        // Functions without a vector form are evaluated lane by lane.
        _ => each(a, |x| function.apply(x, 0.0)),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::super::TapeBuilder;
    use super::super::testing::tape;
    use super::*;
    use sistership_formula::parse;

    #[test]
    fn shared_subexpressions_and_constants_cost_one_operation() {
        assert_eq!(tape("u*v + v*u + 2*3").len(), 6);
        assert_eq!(tape("0*u + 4").constant_output(0), Some(4.0));
    }

    #[test]
    fn blocks_agree_with_single_states() {
        let tape = tape("if(u > v, sqrt(u^2 + v^2), atan2(v, u))*exp(-v)");
        let (u, v) = ([1.0, 2.0, -1.0, 0.5], [0.3, 2.5, 0.4, 0.1]);
        let mut work = Slots::default();
        tape.run(&[u, v], &mut work);
        for k in 0..4 {
            assert_eq!(tape.read(0, &work)[k], tape.values(&[u[k], v[k]])[0]);
        }
    }

    #[test]
    fn wide_instructions_round_as_plain_ones() {
        let tape = tape(
            "if(u > v, sqrt(u^2 + v^2), atan2(v, u))*exp(-v)/(u*v + 3) - abs(u)^2.5 + \
             tanh(u)*max(u, v)",
        );
        let lane = |from: f64| std::array::from_fn::<f64, 8, _>(|k| from + 0.37 * k as f64);
        let inputs = [lane(-1.1), lane(-0.8)];
        let (mut wide, mut plain) = (Slots::default(), vec![[0.0; 8]; tape.len()]);
        tape.run(&inputs, &mut wide);
        Evaluation { tape: &tape, inputs: &inputs, work: &mut plain }.go();
        assert_eq!(*wide, plain);
    }

    #[test]
    fn a_condition_switches_by_lane_and_has_no_derivative() {
        let mut builder = TapeBuilder::new(&["u", "v"], |_| None);
        builder
            .output(
                &sistership_formula::parse_condition("u*v < 1")
                    .unwrap()
                    .times(parse("u^2").unwrap()),
            )
            .unwrap();
        let tape = builder.finish();
        let mut work = Slots::default();
        tape.run(&[[0.5, 2.0, -3.0], [1.0, 1.0, 1.0]], &mut work);
        assert_eq!(tape.read(0, &work), [0.25, 0.0, 9.0]);
        assert_eq!(tape.jacobian(&[0.5, 1.0])[0], [1.0, 0.0]);
        assert_eq!(tape.jacobian(&[2.0, 1.0])[0], [0.0, 0.0]);
    }
}
