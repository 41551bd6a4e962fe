//! Derivatives as further operations on the same tape: subexpressions shared with the values are
//! computed once, and all of it runs for a block of lanes.

use sistership_formula::{Comparison, Function};

use super::{Op, Slot, TapeBuilder};

impl TapeBuilder<'_> {
    /// Adds the derivative of an output with respect to an input; `None` if it is zero for all
    /// inputs. At a kink, this is the derivative towards larger arguments.
    pub fn derivative(&mut self, output: usize, input: &str) -> Option<usize> {
        let input = self.inputs.iter().position(|known| known == input)? as u32;
        let slot = self.slope_of(self.outputs[output], input);
        // A derivative that is zero for all inputs needs no output.
        if self.constant(slot) == Some(0.0) {
            return None;
        }
        self.outputs.push(slot);
        Some(self.outputs.len() - 1)
    }

    /// Returns the slot of a slot's derivative. A sum of thousands of terms is nested as deeply:
    /// the derivatives of operands are therefore made first in a loop, in the order of a recursion.
    fn slope_of(&mut self, slot: Slot, input: u32) -> Slot {
        if let Some(&known) = self.slopes.get(&(slot, input)) {
            return known;
        }
        // Depth-first search with an explicit stack.
        let mut waiting = vec![slot];
        while let Some(&next) = waiting.last() {
            let needed = self.ops[next as usize].differentiated().into_iter().flatten();
            // A slot stays on the stack until the derivatives of all its operands exist.
            match needed.into_iter().find(|operand| !self.slopes.contains_key(&(*operand, input))) {
                Some(operand) if !self.slopes.contains_key(&(next, input)) => waiting.push(operand),
                _ => {
                    waiting.pop();
                    self.known_slope(next, input);
                }
            }
        }
        self.known_slope(slot, input)
    }

    /// Returns the derivative of a slot whose operands have theirs.
    fn known_slope(&mut self, slot: Slot, input: u32) -> Slot {
        if let Some(&known) = self.slopes.get(&(slot, input)) {
            return known;
        }
        let slope = self.new_slope(slot, input);
        self.slopes.insert((slot, input), slope);
        slope
    }

    fn new_slope(&mut self, slot: Slot, input: u32) -> Slot {
        let op = self.ops[slot as usize];
        match op {
            Op::Constant(_) => self.number(0.0),
            Op::Input(index) => self.number(f64::from(u8::from(index == input))),
            Op::Negate(a) => {
                let a = self.slope_of(a, input);
                self.push(Op::Negate(a))
            }
            Op::Add(a, b) => self.of_both(a, b, input, Op::Add),
            Op::Subtract(a, b) => self.of_both(a, b, input, Op::Subtract),
            Op::Multiply(a, b) => self.product_rule(a, b, input),
            Op::Divide(a, b) => self.quotient_rule(slot, a, b, input),
            Op::Power(a, b) => self.power_rule(slot, a, b, input),
            Op::Call1(function, a) => self.chain_rule(slot, function, a, input),
            Op::Call2(function, a, b) => self.of_call2(function, a, b, input),
            Op::Select(comparison, a, b, c, d) => {
                let (c, d) = (self.slope_of(c, input), self.slope_of(d, input));
                self.either(comparison, a, b, c, d)
            }
        }
    }

    fn number(&mut self, value: f64) -> Slot {
        self.push(Op::Constant(value))
    }

    fn of_both(&mut self, a: Slot, b: Slot, input: u32, make: fn(Slot, Slot) -> Op) -> Slot {
        let (a, b) = (self.slope_of(a, input), self.slope_of(b, input));
        self.push(make(a, b))
    }

    /// Adds a selection, unless both alternatives are the same slot.
    fn either(&mut self, comparison: Comparison, a: Slot, b: Slot, c: Slot, d: Slot) -> Slot {
        if c == d { c } else { self.push(Op::Select(comparison, a, b, c, d)) }
    }

    fn times(&mut self, a: Slot, b: Slot) -> Slot {
        self.push(Op::Multiply(a, b))
    }

    fn product_rule(&mut self, a: Slot, b: Slot, input: u32) -> Slot {
        let (da, db) = (self.slope_of(a, input), self.slope_of(b, input));
        let (left, right) = (self.times(da, b), self.times(a, db));
        self.push(Op::Add(left, right))
    }

    fn quotient_rule(&mut self, quotient: Slot, a: Slot, b: Slot, input: u32) -> Slot {
        // `(a / b)' = (a' - (a / b) b') / b`
        let (da, db) = (self.slope_of(a, input), self.slope_of(b, input));
        let taken = self.times(quotient, db);
        let above = self.push(Op::Subtract(da, taken));
        if self.constant(above) == Some(0.0) { above } else { self.push(Op::Divide(above, b)) }
    }

    fn power_rule(&mut self, power: Slot, a: Slot, b: Slot, input: u32) -> Slot {
        let (da, db) = (self.slope_of(a, input), self.slope_of(b, input));
        // `(a^b)' = b a^(b - 1) a' + a^b ln(a) b'`
        let one = self.number(1.0);
        let less = self.push(Op::Subtract(b, one));
        let lower = self.push(Op::Power(a, less));
        let by_base = self.times(b, lower);
        let log = self.push(Op::Call1(Function::Log, a));
        let by_exponent = self.times(power, log);
        let (left, right) = (self.times(by_base, da), self.times(by_exponent, db));
        self.push(Op::Add(left, right))
    }

    fn chain_rule(&mut self, value: Slot, function: Function, a: Slot, input: u32) -> Slot {
        let da = self.slope_of(a, input);
        // The outer derivative is not added to the tape if the inner one is zero.
        if self.constant(da) == Some(0.0) {
            return da;
        }
        let outer = self.slope_by_argument(value, function, a);
        self.times(outer, da)
    }

    /// Derivative of a function of one argument; `value` is the slot of the function's value.
    fn slope_by_argument(&mut self, value: Slot, function: Function, a: Slot) -> Slot {
        let one = self.number(1.0);
        match function {
            Function::Sin => self.push(Op::Call1(Function::Cos, a)),
            Function::Cos => {
                let sin = self.push(Op::Call1(Function::Sin, a));
                self.push(Op::Negate(sin))
            }
            Function::Tan => {
                let square = self.times(value, value);
                self.push(Op::Add(one, square))
            }
            Function::Tanh => {
                let square = self.times(value, value);
                self.push(Op::Subtract(one, square))
            }
            Function::Atan => {
                let square = self.times(a, a);
                let below = self.push(Op::Add(one, square));
                self.push(Op::Divide(one, below))
            }
            Function::Sqrt => {
                let half = self.number(0.5);
                self.push(Op::Divide(half, value))
            }
            Function::Abs => {
                let (zero, minus) = (self.number(0.0), self.number(-1.0));
                self.either(Comparison::GreaterOrEqual, a, zero, one, minus)
            }
            Function::Exp => value,
            Function::Log => self.push(Op::Divide(one, a)),
            // `sign` is constant on either side of zero; the others have two arguments.
            Function::Sign | Function::Atan2 | Function::Min | Function::Max => self.number(0.0),
        }
    }

    fn of_call2(&mut self, function: Function, a: Slot, b: Slot, input: u32) -> Slot {
        let (da, db) = (self.slope_of(a, input), self.slope_of(b, input));
        match function {
            Function::Min => self.either(Comparison::LessOrEqual, a, b, da, db),
            Function::Max => self.either(Comparison::GreaterOrEqual, a, b, da, db),
            _ => self.of_atan2(a, b, da, db),
        }
    }

    /// Derivative of atan2: `(b da - a db) / (a^2 + b^2)`, and zero where both arguments are zero.
    fn of_atan2(&mut self, a: Slot, b: Slot, da: Slot, db: Slot) -> Slot {
        let (left, right) = (self.times(b, da), self.times(a, db));
        let above = self.push(Op::Subtract(left, right));
        if self.constant(above) == Some(0.0) {
            return above;
        }
        let (aa, bb) = (self.times(a, a), self.times(b, b));
        let square = self.push(Op::Add(aa, bb));
        let (zero, slope) = (self.number(0.0), self.push(Op::Divide(above, square)));
        self.either(Comparison::Greater, square, zero, slope, zero)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::super::{Tape, TapeBuilder};
    use sistership_formula::parse;

    fn with_slopes(text: &str) -> (Tape, [Option<usize>; 2]) {
        let mut builder = TapeBuilder::new(&["u", "v"], |_| None);
        builder.output(&parse(text).unwrap()).unwrap();
        let slopes = ["u", "v"].map(|input| builder.derivative(0, input));
        (builder.finish(), slopes)
    }

    #[test]
    fn derivatives_on_the_tape_are_those_of_its_tangents() {
        let texts = [
            "u^3*v/(1 + v^2)",
            "atan2(v, u)*abs(v)",
            "max(u, v)*tanh(u*v) - u^-2 + min(u, v)",
            "sin(u)*cos(v)*log(u)*exp(v) + u^2.5 + tan(v) + atan(u*v)",
            "if(u > v, sqrt(u), sign(v))*abs(-u*v)",
            "(2 + u^2)^(0.3*v)",
        ];
        for text in texts {
            let (tape, slopes) = with_slopes(text);
            for at in [[1.3, -0.7], [0.4, 0.9], [2.0, 0.3]] {
                let (values, exact) = (tape.values(&at), tape.jacobian(&at)[0].clone());
                for (slope, exact) in slopes.iter().zip(exact) {
                    let here = slope.map_or(0.0, |output| values[output]);
                    assert!(
                        (here - exact).abs() < 1e-12 * (1.0 + exact.abs()),
                        "{text}: {here} against {exact}"
                    );
                }
            }
        }
    }

    /// The force of an axis with as many terms as a model may have coefficients, and more, on half
    /// of what a thread has.
    #[test]
    fn a_long_sum_is_lowered_and_differentiated_on_a_small_stack() {
        use sistership_formula::Expr;
        let small = std::thread::Builder::new().stack_size(1 << 20);
        let tried = small.spawn(|| {
            let term = |k: usize| parse(&format!("{k}.5*u*v")).unwrap();
            let sum = (1..20_000)
                .map(term)
                .fold(Expr::Number(0.0), |sum, term| Expr::Add(Box::new(sum), Box::new(term)));
            let mut builder = TapeBuilder::new(&["u", "v"], |_| None);
            builder.output(&sum).unwrap();
            let slope = builder.derivative(0, "u").unwrap();
            let tape = builder.finish();
            let values = tape.values(&[2.0, 3.0]);
            assert!((values[slope] * 2.0 - values[0]).abs() < 1e-6 * values[0].abs());
            // Each power is a factor of the next: as deep as formulas may be through values.
            let deep = parse(&format!("{}u{}", "sqrt(1+".repeat(24), ")".repeat(24))).unwrap();
            let mut builder = TapeBuilder::new(&["u", "v"], |_| None);
            builder.output(&deep).unwrap();
            assert!(builder.derivative(0, "u").is_some());
        });
        tried.unwrap().join().unwrap();
    }

    /// Values that each name the one before, down to the deepest that a law may have.
    #[test]
    fn values_of_values_are_lowered_on_a_small_stack() {
        use super::super::Binding;
        let deepest = sistership_formula::MAX_DEPTH;
        let small = std::thread::Builder::new().stack_size(1 << 20);
        let bind = move |name: &str| {
            let number: usize = name.strip_prefix('a')?.parse().ok()?;
            let text =
                if number == 0 { "u".to_owned() } else { format!("a{0}*a{0} + 1", number - 1) };
            parse(&text).ok().map(Binding::Formula)
        };
        let tried = small.spawn(move || {
            let mut builder = TapeBuilder::new(&["u", "v"], bind);
            builder.output(&parse(&format!("a{deepest}")).unwrap()).unwrap();
            builder.derivative(0, "u").unwrap();
            assert!(builder.finish().values(&[0.0, 0.0])[0] > 0.0);
        });
        tried.unwrap().join().unwrap();
    }

    #[test]
    fn what_does_not_depend_on_an_input_has_no_derivative() {
        assert_eq!(with_slopes("3*v + sign(u)").1[0], None);
        assert!(with_slopes("if(u > 0, v, v)").1[1].is_some());
    }
}
