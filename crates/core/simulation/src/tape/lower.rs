//! Lowering of formulas to the tape: constant folding and shared subexpressions.
//!
//! A factor or numerator that is a constant 0 removes its term, whatever the other operand is: an
//! effect without strength adds nothing in deep water either, where `0 * depth` would be no number,
//! and a derivative keeps no terms of factors that are constant. [`Expr::value`] follows IEEE 754
//! instead; it differs for operands that are infinite, not a number, or a denominator of 0.

use std::collections::HashMap;

use sistership_formula::{Comparison, Expr, Function, builtin_constant};

use super::listing::OperationList;
use super::{ResultSlot, Tape, TapeOp};

/// Meaning of a name while a formula is lowered.
pub enum NameBinding {
    /// A number, which is folded in.
    Constant(f64),
    /// Another formula.
    Formula(Expr),
}

/// Error of a name without a meaning.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("nothing stands for `{0}`")]
pub struct UnboundName(pub String);

type BinaryOp = fn(ResultSlot, ResultSlot) -> TapeOp;

/// Returns the two sides of a sum, difference, product or quotient, and its operation.
fn binary_sides(expr: &Expr) -> Option<(&Expr, &Expr, BinaryOp)> {
    match expr {
        Expr::Add(a, b) => Some((a, b, TapeOp::Add)),
        Expr::Subtract(a, b) => Some((a, b, TapeOp::Subtract)),
        Expr::Multiply(a, b) => Some((a, b, TapeOp::Multiply)),
        Expr::Divide(a, b) => Some((a, b, TapeOp::Divide)),
        _ => None,
    }
}

/// Resolver of the names that are not inputs.
type NameResolver<'a> = dyn Fn(&str) -> Option<NameBinding> + 'a;

/// Builder of a tape from formulas.
pub struct TapeBuilder<'a> {
    pub(super) inputs: Vec<String>,
    bind: Box<NameResolver<'a>>,
    pub(super) ops: Vec<TapeOp>,
    seen: HashMap<[u64; 6], ResultSlot>,
    named: HashMap<String, ResultSlot>,
    pub(super) outputs: Vec<ResultSlot>,
    /// Slots of derivatives that exist already, by slot and input.
    pub(super) slopes: HashMap<(ResultSlot, u32), ResultSlot>,
}

impl<'a> TapeBuilder<'a> {
    /// Creates a builder whose tape has `inputs`; `bind` resolves every other name.
    pub fn new(inputs: &[&str], bind: impl Fn(&str) -> Option<NameBinding> + 'a) -> Self {
        let inputs = inputs.iter().map(|&name| name.to_owned()).collect();
        Self {
            inputs,
            bind: Box::new(bind),
            ops: Vec::new(),
            seen: HashMap::new(),
            named: HashMap::new(),
            outputs: Vec::new(),
            slopes: HashMap::new(),
        }
    }

    /// Adds an output and returns its number.
    ///
    /// # Errors
    /// Returns an error that names a name without a meaning.
    pub fn add_output(&mut self, expr: &Expr) -> Result<usize, UnboundName> {
        let slot = self.lower_expr(expr)?;
        self.outputs.push(slot);
        Ok(self.outputs.len() - 1)
    }

    /// Adds a formula to an existing output, or a new output if `output` is `None`.
    ///
    /// # Errors
    /// Returns an error that names a name without a meaning.
    pub fn add_to_output(
        &mut self,
        output: Option<usize>,
        expr: &Expr,
    ) -> Result<usize, UnboundName> {
        let Some(output) = output else { return self.add_output(expr) };
        let slot = self.lower_expr(expr)?;
        self.outputs[output] = self.push_op(TapeOp::Add(self.outputs[output], slot));
        Ok(output)
    }

    /// Returns the finished tape, without operations that no output needs.
    pub fn finish(self) -> Tape {
        self.into_listing().without_unused().into_tape()
    }

    /// Returns the finished tape in two parts: the operations that call functions or divide and
    /// depend on no input before `from`, and the rest, which takes the results of the first part
    /// after its inputs.
    pub fn finish_hoisted(self, from: usize) -> (Tape, Tape) {
        let (front, rest) = self.into_listing().without_unused().split_hoisted(from);
        (front.into_tape(), rest.into_tape())
    }

    fn into_listing(self) -> OperationList {
        OperationList { inputs: self.inputs, ops: self.ops, outputs: self.outputs }
    }

    /// Lowers a formula. Sums are nested to the left, for an axis by thousands of terms: these are
    /// followed in a loop, everything else by recursion.
    fn lower_expr(&mut self, expr: &Expr) -> Result<ResultSlot, UnboundName> {
        let (mut first, mut after) = (expr, Vec::new());
        // Collects the right operands on the way to the leftmost operand.
        while let Some((a, b, make)) = binary_sides(first) {
            after.push((b, make));
            first = a;
        }
        let mut slot = self.lower_operand(first)?;
        // Applies them from the left.
        while let Some((b, make)) = after.pop() {
            let b = self.lower_expr(b)?;
            slot = self.push_op(make(slot, b));
        }
        Ok(slot)
    }

    fn lower_operand(&mut self, expr: &Expr) -> Result<ResultSlot, UnboundName> {
        Ok(match expr {
            Expr::Number(number) => self.push_op(TapeOp::Constant(*number)),
            Expr::Name(name) => self.lower_name(name)?,
            Expr::Negate(a) => self.lower_unary(a, TapeOp::Negate)?,
            Expr::Add(..) | Expr::Subtract(..) | Expr::Multiply(..) | Expr::Divide(..) => {
                self.lower_expr(expr)?
            }
            Expr::Power(a, b) => self.lower_power(a, b)?,
            Expr::Call(function, arguments) if arguments.len() == 1 => {
                self.lower_unary(&arguments[0], |a| TapeOp::Call1(*function, a))?
            }
            Expr::Call(function, arguments) => {
                self.lower_binary(&arguments[0], &arguments[1], |a, b| {
                    TapeOp::Call2(*function, a, b)
                })?
            }
            Expr::If(comparison, parts) => self.lower_select(*comparison, parts)?,
        })
    }

    fn lower_name(&mut self, name: &str) -> Result<ResultSlot, UnboundName> {
        // A name is lowered once; later uses share its slot.
        if let Some(&slot) = self.named.get(name) {
            return Ok(slot);
        }
        let slot = if let Some(index) = self.inputs.iter().position(|input| input == name) {
            self.push_op(TapeOp::Input(index as u32))
        } else {
            // Bindings take precedence over built-in constants.
            match (self.bind)(name)
                .or_else(|| Some(NameBinding::Constant(builtin_constant(name)?.0)))
            {
                Some(NameBinding::Constant(value)) => self.push_op(TapeOp::Constant(value)),
                Some(NameBinding::Formula(expr)) => self.lower_expr(&expr)?,
                None => return Err(UnboundName(name.to_owned())),
            }
        };
        self.named.insert(name.to_owned(), slot);
        Ok(slot)
    }

    fn lower_unary(
        &mut self,
        a: &Expr,
        make: impl Fn(ResultSlot) -> TapeOp,
    ) -> Result<ResultSlot, UnboundName> {
        let a = self.lower_expr(a)?;
        Ok(self.push_op(make(a)))
    }

    fn lower_binary(
        &mut self,
        a: &Expr,
        b: &Expr,
        make: impl Fn(ResultSlot, ResultSlot) -> TapeOp,
    ) -> Result<ResultSlot, UnboundName> {
        let (a, b) = (self.lower_expr(a)?, self.lower_expr(b)?);
        Ok(self.push_op(make(a, b)))
    }

    fn lower_select(
        &mut self,
        comparison: Comparison,
        parts: &[Expr; 4],
    ) -> Result<ResultSlot, UnboundName> {
        let [a, b, c, d] = parts;
        let slots =
            [self.lower_expr(a)?, self.lower_expr(b)?, self.lower_expr(c)?, self.lower_expr(d)?];
        Ok(self.push_op(TapeOp::Select(comparison, slots[0], slots[1], slots[2], slots[3])))
    }

    /// Lowers a power. Whole powers become products: faster than `powf`, and defined for negative
    /// bases.
    fn lower_power(&mut self, base: &Expr, exponent: &Expr) -> Result<ResultSlot, UnboundName> {
        let (base, exponent) = (self.lower_expr(base)?, self.lower_expr(exponent)?);
        let TapeOp::Constant(number) = self.ops[exponent as usize] else {
            return Ok(self.push_op(TapeOp::Power(base, exponent)));
        };
        // `sqrt` has a vector instruction, `powf` has none.
        if number == 0.5 {
            return Ok(self.push_op(TapeOp::Call1(Function::Sqrt, base)));
        }
        if number.fract() != 0.0 || number.abs() > 16.0 {
            return Ok(self.push_op(TapeOp::Power(base, exponent)));
        }
        // Partial products are shared with other powers of the same base.
        let mut product = self.push_op(TapeOp::Constant(1.0));
        for _ in 0..number.abs() as u32 {
            product = self.push_op(TapeOp::Multiply(product, base));
        }
        if number >= 0.0 {
            return Ok(product);
        }
        let one = self.push_op(TapeOp::Constant(1.0));
        Ok(self.push_op(TapeOp::Divide(one, product)))
    }

    pub(super) fn constant_value(&self, slot: ResultSlot) -> Option<f64> {
        if let TapeOp::Constant(value) = self.ops[slot as usize] { Some(value) } else { None }
    }

    pub(super) fn push_op(&mut self, op: TapeOp) -> ResultSlot {
        if let Some(same) = self.neutral_result(op) {
            return same;
        }
        // Equal operations share one slot (common subexpressions).
        let op = self.fold_constants(op).map_or(op, TapeOp::Constant);
        let key = op.identity_key();
        if let Some(&slot) = self.seen.get(&key) {
            return slot;
        }
        self.ops.push(op);
        let slot = (self.ops.len() - 1) as ResultSlot;
        self.seen.insert(key, slot);
        slot
    }

    /// Returns the operand to which an operation reduces: `x * 1`, `x + 0`, `x / 1` are the operand
    /// itself; `x * 0` and `0 / x` are zero for every `x`: the term is absent.
    fn neutral_result(&self, op: TapeOp) -> Option<ResultSlot> {
        let is = |slot: ResultSlot, value: f64| self.constant_value(slot) == Some(value);
        match op {
            TapeOp::Multiply(a, b) if is(a, 1.0) || is(b, 0.0) => Some(b),
            TapeOp::Multiply(a, b) if is(b, 1.0) || is(a, 0.0) => Some(a),
            TapeOp::Add(a, b) if is(a, 0.0) => Some(b),
            TapeOp::Add(a, b) | TapeOp::Subtract(a, b) if is(b, 0.0) => Some(a),
            TapeOp::Divide(a, b) if is(b, 1.0) || is(a, 0.0) => Some(a),
            _ => None,
        }
    }

    fn fold_constants(&self, op: TapeOp) -> Option<f64> {
        if matches!(op, TapeOp::Constant(_) | TapeOp::Input(_)) {
            return None;
        }
        let mut values = [0.0; 4];
        for (value, slot) in values.iter_mut().zip(op.operands()) {
            if let Some(slot) = slot {
                *value = self.constant_value(slot)?;
            }
        }
        Some(op.apply_values(values))
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use sistership_formula::parse;

    use super::super::testing::parse_tape;

    #[test]
    fn a_constant_zero_removes_its_term_whatever_the_other_operand_is() {
        for text in ["0*u + v", "u*0 + v", "0/u + v"] {
            let (tape, expr) = (parse_tape(text), parse(text).unwrap());
            for u in [2.0, 0.0, f64::INFINITY, f64::NAN] {
                assert_eq!(tape.evaluate_point(&[u, 3.0])[0], 3.0, "{text} at {u}");
            }
            // By IEEE 754 the term is no number there.
            let at = |name: &str| Some(if name == "u" { f64::NAN } else { 3.0 });
            assert!(expr.value(&at).unwrap().is_nan(), "{text}");
        }
    }

    #[test]
    fn a_zero_that_is_not_constant_follows_ieee_754() {
        let tape = parse_tape("u*v");
        assert!(tape.evaluate_point(&[0.0, f64::INFINITY])[0].is_nan());
        assert!(parse_tape("u/v").evaluate_point(&[0.0, 0.0])[0].is_nan());
    }
}
