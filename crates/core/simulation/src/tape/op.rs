//! Operations of the tape.

use sistership_formula::{Comparison, Function};

/// Index of an operation's result.
pub type ResultSlot = u32;

/// Operation on earlier results.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum TapeOp {
    /// A number.
    Constant(f64),
    /// An input, by its index.
    Input(u32),
    /// `-a`
    Negate(ResultSlot),
    /// `a + b`
    Add(ResultSlot, ResultSlot),
    /// `a - b`
    Subtract(ResultSlot, ResultSlot),
    /// `a b`
    Multiply(ResultSlot, ResultSlot),
    /// `a / b`
    Divide(ResultSlot, ResultSlot),
    /// `a^b`
    Power(ResultSlot, ResultSlot),
    /// A function of one argument.
    Call1(Function, ResultSlot),
    /// A function of two arguments.
    Call2(Function, ResultSlot, ResultSlot),
    /// The third operand where the comparison of the first with the second holds, else the fourth.
    Select(Comparison, ResultSlot, ResultSlot, ResultSlot, ResultSlot),
}

impl TapeOp {
    /// Slots of the operands.
    pub fn operands(&self) -> [Option<ResultSlot>; 4] {
        match *self {
            Self::Constant(_) | Self::Input(_) => [None; 4],
            Self::Negate(a) | Self::Call1(_, a) => [Some(a), None, None, None],
            Self::Add(a, b) | Self::Subtract(a, b) | Self::Multiply(a, b) | Self::Divide(a, b) => {
                [Some(a), Some(b), None, None]
            }
            Self::Power(a, b) | Self::Call2(_, a, b) => [Some(a), Some(b), None, None],
            Self::Select(_, a, b, c, d) => [Some(a), Some(b), Some(c), Some(d)],
        }
    }

    /// Operands on whose derivatives the derivative depends: all but those of a comparison.
    pub(crate) fn differentiated_operands(&self) -> [Option<ResultSlot>; 4] {
        match *self {
            Self::Select(_, _, _, c, d) => [Some(c), Some(d), None, None],
            _ => self.operands(),
        }
    }

    /// Returns the operation with its operands mapped to other slots.
    pub(crate) fn remap_operands(self, to: &dyn Fn(ResultSlot) -> ResultSlot) -> Self {
        match self {
            Self::Constant(_) | Self::Input(_) => self,
            Self::Negate(a) => Self::Negate(to(a)),
            Self::Add(a, b) => Self::Add(to(a), to(b)),
            Self::Subtract(a, b) => Self::Subtract(to(a), to(b)),
            Self::Multiply(a, b) => Self::Multiply(to(a), to(b)),
            Self::Divide(a, b) => Self::Divide(to(a), to(b)),
            Self::Power(a, b) => Self::Power(to(a), to(b)),
            Self::Call1(function, a) => Self::Call1(function, to(a)),
            Self::Call2(function, a, b) => Self::Call2(function, to(a), to(b)),
            Self::Select(comparison, a, b, c, d) => {
                Self::Select(comparison, to(a), to(b), to(c), to(d))
            }
        }
    }

    /// Value of the operation for given operands; NaN for an input.
    pub(crate) fn apply_values(&self, [a, b, c, d]: [f64; 4]) -> f64 {
        match *self {
            Self::Constant(value) => value,
            Self::Input(_) => f64::NAN,
            Self::Negate(_) => -a,
            Self::Add(..) => a + b,
            Self::Subtract(..) => a - b,
            Self::Multiply(..) => a * b,
            Self::Divide(..) => a / b,
            Self::Power(..) => a.powf(b),
            Self::Call1(function, _) | Self::Call2(function, ..) => function.apply(a, b),
            Self::Select(comparison, ..) => {
                if comparison.holds(a, b) {
                    c
                } else {
                    d
                }
            }
        }
    }

    /// Key that equal operations share; sums and products also with exchanged operands.
    pub(crate) fn identity_key(&self) -> [u64; 6] {
        let slots = self.operands().map(|slot| slot.map_or(u64::MAX, u64::from));
        let ordered = |mut pair: [u64; 2]| {
            pair.sort_unstable();
            pair
        };
        let [a, b, c, d] = slots;
        let [low, high] = ordered([a, b]);
        // The first number identifies the operation.
        match *self {
            Self::Constant(value) => [0, value.to_bits(), 0, 0, 0, 0],
            Self::Input(index) => [1, u64::from(index), 0, 0, 0, 0],
            Self::Negate(_) => [2, a, 0, 0, 0, 0],
            Self::Add(..) => [3, low, high, 0, 0, 0],
            Self::Subtract(..) => [4, a, b, 0, 0, 0],
            Self::Multiply(..) => [5, low, high, 0, 0, 0],
            Self::Divide(..) => [6, a, b, 0, 0, 0],
            Self::Power(..) => [7, a, b, 0, 0, 0],
            Self::Call1(function, _) => [8, function as u64, a, 0, 0, 0],
            Self::Call2(function, ..) => [9, function as u64, a, b, 0, 0],
            Self::Select(comparison, ..) => [10, comparison as u64, a, b, c, d],
        }
    }
}
