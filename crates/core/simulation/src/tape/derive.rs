//! Derivatives as further operations on the same tape: subexpressions shared with the values are
//! computed once, and all of it runs for a block of lanes.

use sistership_formula::{Comparison, Function};

use super::{ResultSlot, TapeBuilder, TapeOp};

impl TapeBuilder<'_> {
    /// Adds the derivative of an output with respect to an input; `None` if it is zero for all
    /// inputs. At a kink, this is the derivative towards larger arguments.
    pub fn add_derivative(&mut self, output: usize, input: &str) -> Option<usize> {
        let input = self.inputs.iter().position(|known| known == input)? as u32;
        let slot = self.derivative_slot(self.outputs[output], input);
        // A derivative that is zero for all inputs needs no output.
        if self.constant_value(slot) == Some(0.0) {
            return None;
        }
        self.outputs.push(slot);
        Some(self.outputs.len() - 1)
    }

    /// Returns the slot of a slot's derivative. A sum of thousands of terms is nested as deeply:
    /// the derivatives of operands are therefore made first in a loop, in the order of a recursion.
    fn derivative_slot(&mut self, slot: ResultSlot, input: u32) -> ResultSlot {
        if let Some(&known) = self.slopes.get(&(slot, input)) {
            return known;
        }
        // Depth-first search with an explicit stack.
        let mut waiting = vec![slot];
        while let Some(&next) = waiting.last() {
            let needed = self.ops[next as usize].differentiated_operands().into_iter().flatten();
            // A slot stays on the stack until the derivatives of all its operands exist.
            match needed.into_iter().find(|operand| !self.slopes.contains_key(&(*operand, input))) {
                Some(operand) if !self.slopes.contains_key(&(next, input)) => waiting.push(operand),
                _ => {
                    waiting.pop();
                    self.cached_derivative(next, input);
                }
            }
        }
        self.cached_derivative(slot, input)
    }

    /// Returns the derivative of a slot whose operands have theirs.
    fn cached_derivative(&mut self, slot: ResultSlot, input: u32) -> ResultSlot {
        if let Some(&known) = self.slopes.get(&(slot, input)) {
            return known;
        }
        let slope = self.differentiate_op(slot, input);
        self.slopes.insert((slot, input), slope);
        slope
    }

    fn differentiate_op(&mut self, slot: ResultSlot, input: u32) -> ResultSlot {
        let op = self.ops[slot as usize];
        match op {
            TapeOp::Constant(_) => self.push_constant(0.0),
            TapeOp::Input(index) => self.push_constant(f64::from(u8::from(index == input))),
            TapeOp::Negate(a) => {
                let a = self.derivative_slot(a, input);
                self.push_op(TapeOp::Negate(a))
            }
            TapeOp::Add(a, b) => self.differentiate_both(a, b, input, TapeOp::Add),
            TapeOp::Subtract(a, b) => self.differentiate_both(a, b, input, TapeOp::Subtract),
            TapeOp::Multiply(a, b) => self.product_rule(a, b, input),
            TapeOp::Divide(a, b) => self.quotient_rule(slot, a, b, input),
            TapeOp::Power(a, b) => self.power_rule(slot, a, b, input),
            TapeOp::Call1(function, a) => self.chain_rule(slot, function, a, input),
            TapeOp::Call2(function, a, b) => self.differentiate_call2(function, a, b, input),
            TapeOp::Select(comparison, a, b, c, d) => {
                let (c, d) = (self.derivative_slot(c, input), self.derivative_slot(d, input));
                self.push_select(comparison, a, b, c, d)
            }
        }
    }

    fn push_constant(&mut self, value: f64) -> ResultSlot {
        self.push_op(TapeOp::Constant(value))
    }

    fn differentiate_both(
        &mut self,
        a: ResultSlot,
        b: ResultSlot,
        input: u32,
        make: fn(ResultSlot, ResultSlot) -> TapeOp,
    ) -> ResultSlot {
        let (a, b) = (self.derivative_slot(a, input), self.derivative_slot(b, input));
        self.push_op(make(a, b))
    }

    /// Adds a selection, unless both alternatives are the same slot.
    fn push_select(
        &mut self,
        comparison: Comparison,
        a: ResultSlot,
        b: ResultSlot,
        c: ResultSlot,
        d: ResultSlot,
    ) -> ResultSlot {
        if c == d { c } else { self.push_op(TapeOp::Select(comparison, a, b, c, d)) }
    }

    fn push_product(&mut self, a: ResultSlot, b: ResultSlot) -> ResultSlot {
        self.push_op(TapeOp::Multiply(a, b))
    }

    fn product_rule(&mut self, a: ResultSlot, b: ResultSlot, input: u32) -> ResultSlot {
        let (da, db) = (self.derivative_slot(a, input), self.derivative_slot(b, input));
        let (left, right) = (self.push_product(da, b), self.push_product(a, db));
        self.push_op(TapeOp::Add(left, right))
    }

    fn quotient_rule(
        &mut self,
        quotient: ResultSlot,
        a: ResultSlot,
        b: ResultSlot,
        input: u32,
    ) -> ResultSlot {
        // `(a / b)' = (a' - (a / b) b') / b`
        let (da, db) = (self.derivative_slot(a, input), self.derivative_slot(b, input));
        let taken = self.push_product(quotient, db);
        let above = self.push_op(TapeOp::Subtract(da, taken));
        if self.constant_value(above) == Some(0.0) {
            above
        } else {
            self.push_op(TapeOp::Divide(above, b))
        }
    }

    fn power_rule(
        &mut self,
        power: ResultSlot,
        a: ResultSlot,
        b: ResultSlot,
        input: u32,
    ) -> ResultSlot {
        let (da, db) = (self.derivative_slot(a, input), self.derivative_slot(b, input));
        // `(a^b)' = b a^(b - 1) a' + a^b ln(a) b'`
        let one = self.push_constant(1.0);
        let less = self.push_op(TapeOp::Subtract(b, one));
        let lower = self.push_op(TapeOp::Power(a, less));
        let by_base = self.push_product(b, lower);
        let log = self.push_op(TapeOp::Call1(Function::Log, a));
        let by_exponent = self.push_product(power, log);
        let (left, right) = (self.push_product(by_base, da), self.push_product(by_exponent, db));
        self.push_op(TapeOp::Add(left, right))
    }

    fn chain_rule(
        &mut self,
        value: ResultSlot,
        function: Function,
        a: ResultSlot,
        input: u32,
    ) -> ResultSlot {
        let da = self.derivative_slot(a, input);
        // The outer derivative is not added to the tape if the inner one is zero.
        if self.constant_value(da) == Some(0.0) {
            return da;
        }
        let outer = self.argument_derivative(value, function, a);
        self.push_product(outer, da)
    }

    /// Derivative of a function of one argument; `value` is the slot of the function's value.
    fn argument_derivative(
        &mut self,
        value: ResultSlot,
        function: Function,
        a: ResultSlot,
    ) -> ResultSlot {
        let one = self.push_constant(1.0);
        match function {
            Function::Sin => self.push_op(TapeOp::Call1(Function::Cos, a)),
            Function::Cos => {
                let sin = self.push_op(TapeOp::Call1(Function::Sin, a));
                self.push_op(TapeOp::Negate(sin))
            }
            Function::Tan => {
                let square = self.push_product(value, value);
                self.push_op(TapeOp::Add(one, square))
            }
            Function::Tanh => {
                let square = self.push_product(value, value);
                self.push_op(TapeOp::Subtract(one, square))
            }
            Function::Atan => {
                let square = self.push_product(a, a);
                let below = self.push_op(TapeOp::Add(one, square));
                self.push_op(TapeOp::Divide(one, below))
            }
            Function::Sqrt => {
                let half = self.push_constant(0.5);
                self.push_op(TapeOp::Divide(half, value))
            }
            Function::Abs => {
                let (zero, minus) = (self.push_constant(0.0), self.push_constant(-1.0));
                self.push_select(Comparison::GreaterOrEqual, a, zero, one, minus)
            }
            Function::Exp => value,
            Function::Log => self.push_op(TapeOp::Divide(one, a)),
            // `sign` is constant on either side of zero; the others have two arguments.
            Function::Sign | Function::Atan2 | Function::Min | Function::Max => {
                self.push_constant(0.0)
            }
        }
    }

    fn differentiate_call2(
        &mut self,
        function: Function,
        a: ResultSlot,
        b: ResultSlot,
        input: u32,
    ) -> ResultSlot {
        let (da, db) = (self.derivative_slot(a, input), self.derivative_slot(b, input));
        match function {
            Function::Min => self.push_select(Comparison::LessOrEqual, a, b, da, db),
            Function::Max => self.push_select(Comparison::GreaterOrEqual, a, b, da, db),
            _ => self.differentiate_atan2(a, b, da, db),
        }
    }

    /// Derivative of atan2: `(b da - a db) / (a^2 + b^2)`, and zero where both arguments are zero.
    fn differentiate_atan2(
        &mut self,
        a: ResultSlot,
        b: ResultSlot,
        da: ResultSlot,
        db: ResultSlot,
    ) -> ResultSlot {
        let (left, right) = (self.push_product(b, da), self.push_product(a, db));
        let above = self.push_op(TapeOp::Subtract(left, right));
        if self.constant_value(above) == Some(0.0) {
            return above;
        }
        let (aa, bb) = (self.push_product(a, a), self.push_product(b, b));
        let square = self.push_op(TapeOp::Add(aa, bb));
        let (zero, slope) = (self.push_constant(0.0), self.push_op(TapeOp::Divide(above, square)));
        self.push_select(Comparison::Greater, square, zero, slope, zero)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::super::{Tape, TapeBuilder};
    use sistership_formula::parse;

    fn with_slopes(text: &str) -> (Tape, [Option<usize>; 2]) {
        let mut builder = TapeBuilder::new(&["u", "v"], |_| None);
        builder.add_output(&parse(text).unwrap()).unwrap();
        let slopes = ["u", "v"].map(|input| builder.add_derivative(0, input));
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
                let (values, exact) = (tape.evaluate_point(&at), tape.jacobian(&at)[0].clone());
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
            builder.add_output(&sum).unwrap();
            let slope = builder.add_derivative(0, "u").unwrap();
            let tape = builder.finish();
            let values = tape.evaluate_point(&[2.0, 3.0]);
            assert!((values[slope] * 2.0 - values[0]).abs() < 1e-6 * values[0].abs());
            // Each power is a factor of the next: as deep as formulas may be through values.
            let deep = parse(&format!("{}u{}", "sqrt(1+".repeat(24), ")".repeat(24))).unwrap();
            let mut builder = TapeBuilder::new(&["u", "v"], |_| None);
            builder.add_output(&deep).unwrap();
            assert!(builder.add_derivative(0, "u").is_some());
        });
        tried.unwrap().join().unwrap();
    }

    /// Values that each name the one before, down to the deepest that a law may have.
    #[test]
    fn values_of_values_are_lowered_on_a_small_stack() {
        use super::super::NameBinding;
        let deepest = sistership_formula::MAX_DEPTH;
        let small = std::thread::Builder::new().stack_size(1 << 20);
        let bind = move |name: &str| {
            let number: usize = name.strip_prefix('a')?.parse().ok()?;
            let text =
                if number == 0 { "u".to_owned() } else { format!("a{0}*a{0} + 1", number - 1) };
            parse(&text).ok().map(NameBinding::Formula)
        };
        let tried = small.spawn(move || {
            let mut builder = TapeBuilder::new(&["u", "v"], bind);
            builder.add_output(&parse(&format!("a{deepest}")).unwrap()).unwrap();
            builder.add_derivative(0, "u").unwrap();
            assert!(builder.finish().evaluate_point(&[0.0, 0.0])[0] > 0.0);
        });
        tried.unwrap().join().unwrap();
    }

    #[test]
    fn what_does_not_depend_on_an_input_has_no_derivative() {
        assert_eq!(with_slopes("3*v + sign(u)").1[0], None);
        assert!(with_slopes("if(u > 0, v, v)").1[1].is_some());
    }
}
