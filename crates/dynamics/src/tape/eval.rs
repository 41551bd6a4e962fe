//! Evaluation of a tape, and of its derivatives, for a block of lanes.

use sistership_model::formula::Function;

use super::{Op, Slot, Tape};
use crate::wide::{Wide, widest};

/// Values of one quantity in every lane.
pub type Lanes<const N: usize> = [f64; N];

impl Tape {
    /// Evaluates every operation; `work` is reused from call to call and holds the results afterwards.
    /// `inputs[i]` are the lanes of input `i`.
    pub fn run<const N: usize>(&self, inputs: &[Lanes<N>], work: &mut Vec<Lanes<N>>) {
        work.resize(self.ops.len(), [0.0; N]);
        widest(Evaluation { ops: &self.ops, inputs, work });
    }

    /// An output after [`Tape::run`].
    pub fn read<const N: usize>(&self, output: usize, work: &[Lanes<N>]) -> Lanes<N> {
        work[self.outputs[output] as usize]
    }

    /// As [`Tape::read`], without a copy.
    #[inline(always)]
    pub(crate) fn at<'w, const N: usize>(&self, output: usize, work: &'w [Lanes<N>]) -> &'w Lanes<N> {
        &work[self.outputs[output] as usize]
    }

    /// Every output at one point, for callers in no hurry.
    pub fn values(&self, inputs: &[f64]) -> Vec<f64> {
        let inputs: Vec<Lanes<1>> = inputs.iter().map(|&value| [value]).collect();
        let mut work = Vec::with_capacity(self.ops.len());
        self.run(&inputs, &mut work);
        (0..self.outputs.len()).map(|output| self.read(output, &work)[0]).collect()
    }

    /// Directional derivatives at the point that `primal` holds after a [`Tape::run`] of one lane: lane `k` of
    /// `seeds[i]` is the change of input `i` in direction `k`.
    pub fn tangents<const N: usize>(&self, primal: &[Lanes<1>], seeds: &[Lanes<N>], work: &mut Vec<Lanes<N>>) {
        work.resize(self.ops.len(), [0.0; N]);
        for (index, op) in self.ops.iter().enumerate() {
            work[index] = tangent(op, index, primal, seeds, work);
        }
    }

    /// The operations that depend on some of the inputs.
    pub fn depending_on(&self, inputs: &[usize]) -> Vec<Slot> {
        let mut depends = vec![false; self.ops.len()];
        for (index, op) in self.ops.iter().enumerate() {
            depends[index] = match *op {
                Op::Input(input) => inputs.contains(&(input as usize)),
                _ => op.operands().into_iter().flatten().any(|slot| depends[slot as usize]),
            };
        }
        (0..self.ops.len()).filter(|&index| depends[index]).map(|index| index as Slot).collect()
    }

    /// As [`Tape::tangents`], where nothing but what [`depends`](Tape::depending_on) on the seeded inputs is visited; `work`
    /// is kept from call to call for the same inputs, empty at first.
    pub fn tangents_among<const N: usize>(
        &self,
        depending: &[Slot],
        primal: &[Lanes<1>],
        seeds: &[Lanes<N>],
        work: &mut Vec<Lanes<N>>,
    ) {
        work.resize(self.ops.len(), [0.0; N]);
        for &slot in depending {
            let index = slot as usize;
            work[index] = tangent(&self.ops[index], index, primal, seeds, work);
        }
    }

    /// The derivative of every output with respect to every input: rows are outputs.
    pub fn jacobian(&self, inputs: &[f64]) -> Vec<Vec<f64>> {
        let point: Vec<Lanes<1>> = inputs.iter().map(|&value| [value]).collect();
        let (mut primal, mut work) = (Vec::new(), Vec::new());
        self.run(&point, &mut primal);
        let column = |direction: usize, work: &mut Vec<Lanes<1>>| {
            let seeds: Vec<Lanes<1>> = (0..inputs.len()).map(|i| [f64::from(u8::from(i == direction))]).collect();
            self.tangents(&primal, &seeds, work);
            (0..self.outputs.len()).map(|output| self.read(output, work)[0]).collect::<Vec<f64>>()
        };
        let columns: Vec<Vec<f64>> = (0..inputs.len()).map(|direction| column(direction, &mut work)).collect();
        (0..self.outputs.len()).map(|row| columns.iter().map(|column| column[row]).collect()).collect()
    }
}

/// Every operation in turn; `work` is as long as there are operations.
struct Evaluation<'a, const N: usize> {
    ops: &'a [Op],
    inputs: &'a [Lanes<N>],
    work: &'a mut [Lanes<N>],
}

impl<const N: usize> Wide for Evaluation<'_, N> {
    #[inline(always)]
    fn go(self) {
        for (index, op) in self.ops.iter().enumerate() {
            self.work[index] = step(op, self.inputs, self.work);
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
fn zip<const N: usize>(a: &Lanes<N>, b: &Lanes<N>, f: impl Fn(f64, f64) -> f64) -> Lanes<N> {
    let mut out = [0.0; N];
    for k in 0..N {
        out[k] = f(a[k], b[k]);
    }
    out
}

/// A loop, since `map` on arrays is not always inlined, and a call a lane costs more than what it calculates.
#[inline(always)]
fn each<const N: usize>(a: &Lanes<N>, f: impl Fn(f64) -> f64) -> Lanes<N> {
    let mut out = [0.0; N];
    for k in 0..N {
        out[k] = f(a[k]);
    }
    out
}

/// The cheap functions are spelled out, so that their loops over the lanes become vector instructions.
#[inline(always)]
fn call<const N: usize>(function: Function, a: &Lanes<N>) -> Lanes<N> {
    match function {
        Function::Sqrt => each(a, f64::sqrt),
        Function::Abs => each(a, f64::abs),
        _ => each(a, |x| function.apply(x, 0.0)),
    }
}

#[inline(always)]
fn times<const N: usize>(lanes: &Lanes<N>, factor: f64) -> Lanes<N> {
    // No direction is moved by an infinite slope that it does not meet.
    each(lanes, |x| if x == 0.0 { 0.0 } else { x * factor })
}

#[inline(always)]
fn tangent<const N: usize>(op: &Op, index: usize, primal: &[Lanes<1>], seeds: &[Lanes<N>], work: &[Lanes<N>]) -> Lanes<N> {
    let value = |slot: u32| primal[slot as usize][0];
    let d = |slot: u32| &work[slot as usize];
    let scaled = |slot: u32, factor: f64| times(d(slot), factor);
    let both = |a: u32, by_a: f64, b: u32, by_b: f64| zip(&times(d(a), by_a), &times(d(b), by_b), |x, y| x + y);
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

/// The derivative of a function of one argument; at a kink, that of the side towards larger arguments.
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
    use super::super::TapeBuilder;
    use super::*;
    use sistership_model::formula::parse;

    fn tape(text: &str) -> Tape {
        let mut builder = TapeBuilder::new(&["u", "v"], &|_| None);
        builder.output(&parse(text).unwrap()).unwrap();
        builder.finish()
    }

    #[test]
    fn shared_subexpressions_and_constants_cost_one_operation() {
        assert_eq!(tape("u*v + v*u + 2*3").len(), 6);
        assert_eq!(tape("0*u + 4").constant_output(0), Some(4.0));
    }

    #[test]
    fn blocks_agree_with_single_states() {
        let tape = tape("if(u > v, sqrt(u^2 + v^2), atan2(v, u))*exp(-v)");
        let (u, v) = ([1.0, 2.0, -1.0, 0.5], [0.3, 2.5, 0.4, 0.1]);
        let mut work = Vec::new();
        tape.run(&[u, v], &mut work);
        for k in 0..4 {
            assert_eq!(tape.read(0, &work)[k], tape.values(&[u[k], v[k]])[0]);
        }
    }

    #[test]
    fn wide_instructions_round_as_plain_ones() {
        let tape = tape("if(u > v, sqrt(u^2 + v^2), atan2(v, u))*exp(-v)/(u*v + 3) - abs(u)^2.5 + tanh(u)*max(u, v)");
        let lane = |from: f64| std::array::from_fn::<f64, 8, _>(|k| from + 0.37 * k as f64);
        let inputs = [lane(-1.1), lane(-0.8)];
        let (mut wide, mut plain) = (Vec::new(), vec![[0.0; 8]; tape.len()]);
        tape.run(&inputs, &mut wide);
        Evaluation { ops: &tape.ops, inputs: &inputs, work: &mut plain }.go();
        assert_eq!(wide, plain);
    }

    #[test]
    fn what_does_not_depend_on_a_direction_is_not_visited() {
        let tape = tape("u^2*sin(u) + sqrt(1 + v^2)*exp(v)");
        let point = [[1.3], [0.4]];
        let (mut primal, mut all, mut some) = (Vec::new(), Vec::new(), Vec::new());
        tape.run(&point, &mut primal);
        let seeds = [[0.0], [1.0]];
        let depending = tape.depending_on(&[1]);
        assert!(depending.len() < tape.len());
        tape.tangents(&primal, &seeds, &mut all);
        tape.tangents_among(&depending, &primal, &seeds, &mut some);
        assert_eq!(tape.read(0, &all), tape.read(0, &some));
    }

    #[test]
    fn a_condition_switches_by_lane_and_has_no_derivative() {
        let mut builder = TapeBuilder::new(&["u", "v"], &|_| None);
        builder.output(&sistership_model::formula::parse_condition("u*v < 1").unwrap().times(parse("u^2").unwrap())).unwrap();
        let tape = builder.finish();
        let mut work = Vec::new();
        tape.run(&[[0.5, 2.0, -3.0], [1.0, 1.0, 1.0]], &mut work);
        assert_eq!(tape.read(0, &work), [0.25, 0.0, 9.0]);
        assert_eq!(tape.jacobian(&[0.5, 1.0])[0], [1.0, 0.0]);
        assert_eq!(tape.jacobian(&[2.0, 1.0])[0], [0.0, 0.0]);
    }

    #[test]
    fn derivatives_agree_with_differences() {
        for text in ["u^3*v/(1 + v^2)", "atan2(v, u)*abs(v)", "max(u, v)*tanh(u*v) - u^-2", "sin(u)*cos(v)*log(u)*exp(v) + u^2.5"]
        {
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
