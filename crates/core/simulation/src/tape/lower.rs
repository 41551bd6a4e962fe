//! Lowering of formulas to the tape: constant folding and shared subexpressions.

use std::collections::HashMap;

use sistership_formula::{Comparison, Expr, Function, builtin};

use super::listing::Listing;
use super::{Op, Slot, Tape};

/// Meaning of a name while a formula is lowered.
pub enum Binding {
    /// A number, which is folded in.
    Constant(f64),
    /// Another formula.
    Formula(Expr),
}

/// Error of a name without a meaning.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("nothing stands for `{0}`")]
pub struct Unbound(pub String);

type Make = fn(Slot, Slot) -> Op;

/// Returns the two sides of a sum, difference, product or quotient, and its operation.
fn sides(expr: &Expr) -> Option<(&Expr, &Expr, Make)> {
    match expr {
        Expr::Add(a, b) => Some((a, b, Op::Add)),
        Expr::Subtract(a, b) => Some((a, b, Op::Subtract)),
        Expr::Multiply(a, b) => Some((a, b, Op::Multiply)),
        Expr::Divide(a, b) => Some((a, b, Op::Divide)),
        _ => None,
    }
}

/// Resolver of the names that are not inputs.
type Bind<'a> = dyn Fn(&str) -> Option<Binding> + 'a;

/// Builder of a tape from formulas.
pub struct TapeBuilder<'a> {
    pub(super) inputs: Vec<String>,
    bind: Box<Bind<'a>>,
    pub(super) ops: Vec<Op>,
    seen: HashMap<[u64; 6], Slot>,
    named: HashMap<String, Slot>,
    pub(super) outputs: Vec<Slot>,
    /// Slots of derivatives that exist already, by slot and input.
    pub(super) slopes: HashMap<(Slot, u32), Slot>,
}

impl<'a> TapeBuilder<'a> {
    /// Creates a builder whose tape has `inputs`; `bind` resolves every other name.
    pub fn new(inputs: &[&str], bind: impl Fn(&str) -> Option<Binding> + 'a) -> Self {
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
    pub fn output(&mut self, expr: &Expr) -> Result<usize, Unbound> {
        let slot = self.lower(expr)?;
        self.outputs.push(slot);
        Ok(self.outputs.len() - 1)
    }

    /// Adds a formula to an existing output, or a new output if `output` is `None`.
    ///
    /// # Errors
    /// Returns an error that names a name without a meaning.
    pub fn sum(&mut self, output: Option<usize>, expr: &Expr) -> Result<usize, Unbound> {
        let Some(output) = output else { return self.output(expr) };
        let slot = self.lower(expr)?;
        self.outputs[output] = self.push(Op::Add(self.outputs[output], slot));
        Ok(output)
    }

    /// Returns the finished tape, without operations that no output needs.
    pub fn finish(self) -> Tape {
        self.listing().needed().fused()
    }

    /// Returns the finished tape in two parts: the operations that call functions or divide and
    /// depend on no input before `from`, and the rest, which takes the results of the first part
    /// after its inputs.
    pub fn finish_hoisted(self, from: usize) -> (Tape, Tape) {
        let (front, rest) = self.listing().needed().hoisted(from);
        (front.fused(), rest.fused())
    }

    fn listing(self) -> Listing {
        Listing { inputs: self.inputs, ops: self.ops, outputs: self.outputs }
    }

    /// Lowers a formula. Sums are nested to the left, for an axis by thousands of terms: these are
    /// followed in a loop, everything else by recursion.
    fn lower(&mut self, expr: &Expr) -> Result<Slot, Unbound> {
        let (mut first, mut after) = (expr, Vec::new());
        // Collects the right operands on the way to the leftmost operand.
        while let Some((a, b, make)) = sides(first) {
            after.push((b, make));
            first = a;
        }
        let mut slot = self.operand(first)?;
        // Applies them from the left.
        while let Some((b, make)) = after.pop() {
            let b = self.lower(b)?;
            slot = self.push(make(slot, b));
        }
        Ok(slot)
    }

    fn operand(&mut self, expr: &Expr) -> Result<Slot, Unbound> {
        Ok(match expr {
            Expr::Number(number) => self.push(Op::Constant(*number)),
            Expr::Name(name) => self.name(name)?,
            Expr::Negate(a) => self.unary(a, Op::Negate)?,
            Expr::Add(..) | Expr::Subtract(..) | Expr::Multiply(..) | Expr::Divide(..) => {
                self.lower(expr)?
            }
            Expr::Power(a, b) => self.power(a, b)?,
            Expr::Call(function, arguments) if arguments.len() == 1 => {
                self.unary(&arguments[0], |a| Op::Call1(*function, a))?
            }
            Expr::Call(function, arguments) => {
                self.binary(&arguments[0], &arguments[1], |a, b| Op::Call2(*function, a, b))?
            }
            Expr::If(comparison, parts) => self.select(*comparison, parts)?,
        })
    }

    fn name(&mut self, name: &str) -> Result<Slot, Unbound> {
        // A name is lowered once; later uses share its slot.
        if let Some(&slot) = self.named.get(name) {
            return Ok(slot);
        }
        let slot = if let Some(index) = self.inputs.iter().position(|input| input == name) {
            self.push(Op::Input(index as u32))
        } else {
            // Bindings take precedence over built-in constants.
            match (self.bind)(name).or_else(|| Some(Binding::Constant(builtin(name)?.0))) {
                Some(Binding::Constant(value)) => self.push(Op::Constant(value)),
                Some(Binding::Formula(expr)) => self.lower(&expr)?,
                None => return Err(Unbound(name.to_owned())),
            }
        };
        self.named.insert(name.to_owned(), slot);
        Ok(slot)
    }

    fn unary(&mut self, a: &Expr, make: impl Fn(Slot) -> Op) -> Result<Slot, Unbound> {
        let a = self.lower(a)?;
        Ok(self.push(make(a)))
    }

    fn binary(
        &mut self,
        a: &Expr,
        b: &Expr,
        make: impl Fn(Slot, Slot) -> Op,
    ) -> Result<Slot, Unbound> {
        let (a, b) = (self.lower(a)?, self.lower(b)?);
        Ok(self.push(make(a, b)))
    }

    fn select(&mut self, comparison: Comparison, parts: &[Expr; 4]) -> Result<Slot, Unbound> {
        let [a, b, c, d] = parts;
        let slots = [self.lower(a)?, self.lower(b)?, self.lower(c)?, self.lower(d)?];
        Ok(self.push(Op::Select(comparison, slots[0], slots[1], slots[2], slots[3])))
    }

    /// Lowers a power. Whole powers become products: faster than `powf`, and defined for negative
    /// bases.
    fn power(&mut self, base: &Expr, exponent: &Expr) -> Result<Slot, Unbound> {
        let (base, exponent) = (self.lower(base)?, self.lower(exponent)?);
        let Op::Constant(number) = self.ops[exponent as usize] else {
            return Ok(self.push(Op::Power(base, exponent)));
        };
        // `sqrt` has a vector instruction, `powf` has none.
        if number == 0.5 {
            return Ok(self.push(Op::Call1(Function::Sqrt, base)));
        }
        if number.fract() != 0.0 || number.abs() > 16.0 {
            return Ok(self.push(Op::Power(base, exponent)));
        }
        // Partial products are shared with other powers of the same base.
        let mut product = self.push(Op::Constant(1.0));
        for _ in 0..number.abs() as u32 {
            product = self.push(Op::Multiply(product, base));
        }
        if number >= 0.0 {
            return Ok(product);
        }
        let one = self.push(Op::Constant(1.0));
        Ok(self.push(Op::Divide(one, product)))
    }

    pub(super) fn constant(&self, slot: Slot) -> Option<f64> {
        if let Op::Constant(value) = self.ops[slot as usize] { Some(value) } else { None }
    }

    pub(super) fn push(&mut self, op: Op) -> Slot {
        if let Some(same) = self.neutral(op) {
            return same;
        }
        // Equal operations share one slot (common subexpressions).
        let op = self.folded(op).map_or(op, Op::Constant);
        let key = op.key();
        if let Some(&slot) = self.seen.get(&key) {
            return slot;
        }
        self.ops.push(op);
        let slot = (self.ops.len() - 1) as Slot;
        self.seen.insert(key, slot);
        slot
    }

    /// Returns the operand to which an operation reduces: `x * 1`, `x + 0`, `x / 1` are the operand
    /// itself; `x * 0` and `0 / x` are zero.
    fn neutral(&self, op: Op) -> Option<Slot> {
        let is = |slot: Slot, value: f64| self.constant(slot) == Some(value);
        match op {
            Op::Multiply(a, b) if is(a, 1.0) || is(b, 0.0) => Some(b),
            Op::Multiply(a, b) if is(b, 1.0) || is(a, 0.0) => Some(a),
            Op::Add(a, b) if is(a, 0.0) => Some(b),
            Op::Add(a, b) | Op::Subtract(a, b) if is(b, 0.0) => Some(a),
            Op::Divide(a, b) if is(b, 1.0) || is(a, 0.0) => Some(a),
            _ => None,
        }
    }

    fn folded(&self, op: Op) -> Option<f64> {
        if matches!(op, Op::Constant(_) | Op::Input(_)) {
            return None;
        }
        let mut values = [0.0; 4];
        for (value, slot) in values.iter_mut().zip(op.operands()) {
            if let Some(slot) = slot {
                *value = self.constant(slot)?;
            }
        }
        Some(op.apply(values))
    }
}
