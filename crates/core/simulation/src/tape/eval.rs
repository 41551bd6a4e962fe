//! Evaluation of a tape for a block of lanes.

use sistership_formula::Function;

use super::{LaneValues, ResultSlot, Tape, TapeInstruction, TapeOp, TapeResults};
use crate::simd::{SimdKernel, dispatch_simd};

impl Tape {
    /// Evaluates every operation; `work` is reused from call to call and holds the results.
    /// `inputs[i]` are the lanes of input `i`.
    pub fn evaluate<const N: usize>(&self, inputs: &[LaneValues<N>], work: &mut TapeResults<N>) {
        work.resize_to(self.len());
        dispatch_simd(TapeEvaluation { tape: self, inputs, work });
    }

    /// Evaluates some of the operations, in the given order; the others keep the results that
    /// `work` holds after a [`Tape::run`].
    pub fn evaluate_among<const N: usize>(
        &self,
        among: &[ResultSlot],
        inputs: &[LaneValues<N>],
        work: &mut TapeResults<N>,
    ) {
        dispatch_simd(PartialEvaluation { tape: self, among, inputs, work });
    }

    /// Returns an output after [`Tape::run`].
    pub fn output_lanes<const N: usize>(
        &self,
        output: usize,
        work: &[LaneValues<N>],
    ) -> LaneValues<N> {
        work[self.outputs[output] as usize]
    }

    /// Returns a reference to an output after [`Tape::run`].
    #[inline(always)]
    pub(crate) fn output_ref<'w, const N: usize>(
        &self,
        output: usize,
        work: &'w [LaneValues<N>],
    ) -> &'w LaneValues<N> {
        &work[self.outputs[output] as usize]
    }

    /// Evaluates every output at one point; allocates, so that it is not for inner loops.
    pub fn evaluate_point(&self, inputs: &[f64]) -> Vec<f64> {
        let inputs: Vec<LaneValues<1>> = inputs.iter().map(|&value| [value]).collect();
        let mut work = TapeResults::default();
        self.evaluate(&inputs, &mut work);
        (0..self.outputs.len()).map(|output| self.output_lanes(output, &work)[0]).collect()
    }
}

/// Evaluation of every instruction in order; `work` has one element for each instruction.
struct TapeEvaluation<'a, const N: usize> {
    tape: &'a Tape,
    inputs: &'a [LaneValues<N>],
    work: &'a mut [LaneValues<N>],
}

impl<const N: usize> SimdKernel for TapeEvaluation<'_, N> {
    #[inline(always)]
    fn run(self) {
        for (index, instruction) in self.tape.instructions.iter().enumerate() {
            self.work[index] = self.tape.instruction_result(instruction, self.inputs, self.work);
        }
    }
}

/// Evaluation of some instructions in order.
struct PartialEvaluation<'a, const N: usize> {
    tape: &'a Tape,
    among: &'a [ResultSlot],
    inputs: &'a [LaneValues<N>],
    work: &'a mut [LaneValues<N>],
}

impl<const N: usize> SimdKernel for PartialEvaluation<'_, N> {
    #[inline(always)]
    fn run(self) {
        for &slot in self.among {
            let instruction = &self.tape.instructions[slot as usize];
            self.work[slot as usize] =
                self.tape.instruction_result(instruction, self.inputs, self.work);
        }
    }
}

impl Tape {
    #[inline(always)]
    fn instruction_result<const N: usize>(
        &self,
        instruction: &TapeInstruction,
        inputs: &[LaneValues<N>],
        work: &[LaneValues<N>],
    ) -> LaneValues<N> {
        match instruction {
            TapeInstruction::Op(op) => evaluate_op(op, inputs, work),
            &TapeInstruction::Products { first, from, to } => {
                sum_products(first, &self.terms[from as usize..to as usize], work)
            }
        }
    }
}

#[inline(always)]
fn evaluate_op<const N: usize>(
    op: &TapeOp,
    inputs: &[LaneValues<N>],
    work: &[LaneValues<N>],
) -> LaneValues<N> {
    let at = |slot: u32| &work[slot as usize];
    match *op {
        TapeOp::Constant(value) => [value; N],
        TapeOp::Input(index) => inputs[index as usize],
        TapeOp::Negate(a) => map_lanes(at(a), |x| -x),
        TapeOp::Add(a, b) => zip_lanes(at(a), at(b), |x, y| x + y),
        TapeOp::Subtract(a, b) => zip_lanes(at(a), at(b), |x, y| x - y),
        TapeOp::Multiply(a, b) => zip_lanes(at(a), at(b), |x, y| x * y),
        TapeOp::Divide(a, b) => zip_lanes(at(a), at(b), |x, y| x / y),
        TapeOp::Power(a, b) => zip_lanes(at(a), at(b), f64::powf),
        TapeOp::Call1(function, a) => call_function(function, at(a)),
        TapeOp::Call2(function, a, b) => zip_lanes(at(a), at(b), |x, y| function.apply(x, y)),
        TapeOp::Select(comparison, a, b, c, d) => {
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
fn sum_products<const N: usize>(
    first: ResultSlot,
    terms: &[[ResultSlot; 2]],
    work: &[LaneValues<N>],
) -> LaneValues<N> {
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
pub(super) fn zip_lanes<const N: usize>(
    a: &LaneValues<N>,
    b: &LaneValues<N>,
    f: impl Fn(f64, f64) -> f64,
) -> LaneValues<N> {
    let mut out = [0.0; N];
    for k in 0..N {
        out[k] = f(a[k], b[k]);
    }
    out
}

/// Applies a function to each lane. A loop, since `map` on arrays is not always inlined, and a call
/// for each lane costs more than the function.
#[inline(always)]
pub(super) fn map_lanes<const N: usize>(
    a: &LaneValues<N>,
    f: impl Fn(f64) -> f64,
) -> LaneValues<N> {
    let mut out = [0.0; N];
    for k in 0..N {
        out[k] = f(a[k]);
    }
    out
}

/// Applies a function of one argument. The cheap functions are written out, so that their loops
/// over the lanes become vector instructions.
#[inline(always)]
fn call_function<const N: usize>(function: Function, a: &LaneValues<N>) -> LaneValues<N> {
    match function {
        Function::Sqrt => map_lanes(a, f64::sqrt),
        Function::Abs => map_lanes(a, f64::abs),
        // Functions without a vector form are evaluated lane by lane.
        _ => map_lanes(a, |x| function.apply(x, 0.0)),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::super::TapeBuilder;
    use super::super::testing::parse_tape;
    use super::*;
    use sistership_formula::parse;

    #[test]
    fn shared_subexpressions_and_constants_cost_one_operation() {
        assert_eq!(parse_tape("u*v + v*u + 2*3").len(), 6);
        assert_eq!(parse_tape("0*u + 4").constant_output(0), Some(4.0));
    }

    #[test]
    fn blocks_agree_with_single_states() {
        let tape = parse_tape("if(u > v, sqrt(u^2 + v^2), atan2(v, u))*exp(-v)");
        let (u, v) = ([1.0, 2.0, -1.0, 0.5], [0.3, 2.5, 0.4, 0.1]);
        let mut work = TapeResults::default();
        tape.evaluate(&[u, v], &mut work);
        for k in 0..4 {
            assert_eq!(tape.output_lanes(0, &work)[k], tape.evaluate_point(&[u[k], v[k]])[0]);
        }
    }

    #[test]
    fn wide_instructions_round_as_plain_ones() {
        let tape = parse_tape(
            "if(u > v, sqrt(u^2 + v^2), atan2(v, u))*exp(-v)/(u*v + 3) - abs(u)^2.5 + \
             tanh(u)*max(u, v)",
        );
        let lane = |from: f64| std::array::from_fn::<f64, 8, _>(|k| from + 0.37 * k as f64);
        let inputs = [lane(-1.1), lane(-0.8)];
        let (mut wide, mut plain) = (TapeResults::default(), vec![[0.0; 8]; tape.len()]);
        tape.evaluate(&inputs, &mut wide);
        TapeEvaluation { tape: &tape, inputs: &inputs, work: &mut plain }.run();
        assert_eq!(*wide, plain);
    }

    #[test]
    fn a_condition_switches_by_lane_and_has_no_derivative() {
        let mut builder = TapeBuilder::new(&["u", "v"], |_| None);
        builder
            .add_output(
                &sistership_formula::parse_condition("u*v < 1")
                    .unwrap()
                    .times(parse("u^2").unwrap()),
            )
            .unwrap();
        let tape = builder.finish();
        let mut work = TapeResults::default();
        tape.evaluate(&[[0.5, 2.0, -3.0], [1.0, 1.0, 1.0]], &mut work);
        assert_eq!(tape.output_lanes(0, &work), [0.25, 0.0, 9.0]);
        assert_eq!(tape.jacobian(&[0.5, 1.0])[0], [1.0, 0.0]);
        assert_eq!(tape.jacobian(&[2.0, 1.0])[0], [0.0, 0.0]);
    }
}
