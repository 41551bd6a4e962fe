//! Learned corrections as formulas, for exports: the same operations as are evaluated in a
//! simulation.

use sistership_formula::{Comparison, Expr, Function};
use sistership_model::branch::{CorrectionInput, CorrectionMode, CorrectionOutput, Signal};
use sistership_simulation::branch::{AdditionFormulas, LAW_RATES};

use crate::domain::FadedDomain;
use crate::expressions::{added, divided, subtracted};
use crate::kernels::KernelSum;
use crate::perceptron::Perceptron;
use crate::regressor::OutputRegressor;
use crate::tree::RegressionTree;

/// Formulas under construction: an expression that is used more than once gets a name.
#[derive(Debug, Default)]
pub(crate) struct FormulaWriter {
    values: Vec<(String, Expr)>,
}

impl FormulaWriter {
    /// Gives an expression a name and returns the name.
    fn name_value(&mut self, expr: Expr) -> Expr {
        let name = format!("correction.{}", self.values.len());
        self.values.push((name.clone(), expr));
        Expr::Name(name)
    }

    /// Formula of a regressor over its scaled inputs.
    fn regressor_formula(&mut self, regressor: &OutputRegressor, inputs: &[Expr]) -> Expr {
        match regressor {
            OutputRegressor::RandomForest(trees) => {
                let sum = sum_terms(trees.iter().map(|tree| tree.prediction_formula(inputs)));
                divided(sum, trees.len() as f64)
            }
            OutputRegressor::BoostedTrees(boosted) => {
                let trees = boosted.trees.iter().map(|tree| tree.prediction_formula(inputs));
                added(Expr::Number(boosted.first), sum_terms(trees))
            }
            OutputRegressor::KernelRidge(kernels) => kernel_sum(kernels, inputs),
            OutputRegressor::Perceptron(network) => self.network_formula(network, inputs),
        }
    }

    /// Formula of a network, layer by layer; the activation is `x / sqrt(1 + x^2)`.
    fn network_formula(&mut self, network: &Perceptron, inputs: &[Expr]) -> Expr {
        let mut here = inputs.to_vec();
        let layers: Vec<_> = network.layers().collect();
        for (place, (weights, biases)) in layers.iter().enumerate() {
            let rows = weights.chunks_exact(here.len());
            let sums: Vec<Expr> =
                rows.zip(*biases).map(|(row, bias)| affine_sum(row, *bias, &here)).collect();
            here = match place + 1 < layers.len() {
                false => sums,
                true => sums.into_iter().map(|sum| self.neuron_formula(sum)).collect(),
            };
        }
        // The last layer has one neuron.
        here.into_iter().next().unwrap_or(Expr::Number(0.0))
    }

    /// Formula of a neuron's activation at its weighted sum.
    fn neuron_formula(&mut self, sum: Expr) -> Expr {
        let x = self.name_value(sum);
        let square = added(Expr::Number(1.0), x.clone().times(x.clone()));
        let root = Expr::Call(Function::Sqrt, vec![square]);
        let factor = Expr::Divide(Box::new(Expr::Number(1.0)), Box::new(root));
        self.name_value(x.times(factor))
    }
}

/// Formulas of all that a correction adds; each output comes with its index among the rates.
pub(crate) fn addition_formulas(
    mode: CorrectionMode,
    outputs: &[(usize, CorrectionOutput, OutputRegressor)],
    domain: &FadedDomain,
) -> AdditionFormulas {
    let mut writer = FormulaWriter::default();
    let share = domain.share_formula(&mut |expr| writer.name_value(expr));
    // The share is used by every output, and gets a name.
    let share = writer.name_value(share);
    let mut added: [Option<Expr>; 3] = [None, None, None];
    for (place, output, regressor) in outputs {
        let answer = output_formula(&mut writer, output, regressor);
        let difference = match mode {
            CorrectionMode::Parallel => answer,
            CorrectionMode::Convert | CorrectionMode::Serial => {
                // The correction replaces the law's rate instead of adding to it.
                subtracted(answer, Expr::Name(LAW_RATES[*place].to_owned()))
            }
        };
        added[*place] = Some(share.clone().times(difference));
    }
    AdditionFormulas { values: writer.values, added }
}

/// Formula of an output, limited to the range of its training.
fn output_formula(
    writer: &mut FormulaWriter,
    output: &CorrectionOutput,
    regressor: &OutputRegressor,
) -> Expr {
    let inputs: Vec<Expr> =
        output.inputs.iter().map(|input| writer.name_value(scaled_input(input))).collect();
    let answer = writer.regressor_formula(regressor, &inputs);
    let [low, high] = output.range.map(Expr::Number);
    let scaled = Expr::Number(output.scale).times(answer);
    // Limited to the range of the training targets.
    let above = Expr::Call(Function::Max, vec![scaled, low]);
    Expr::Call(Function::Min, vec![above, high])
}

/// Formula of an input, scaled as in training.
fn scaled_input(input: &CorrectionInput) -> Expr {
    let name = |name: &str| Expr::Name(name.to_owned());
    let signal = match input.signal {
        Signal::U => name("u"),
        Signal::V => name("v"),
        Signal::R => name("r"),
        Signal::Delta => name("delta"),
        Signal::N => name("n"),
        Signal::Beta => {
            Expr::Call(Function::Atan2, vec![Expr::Negate(Box::new(name("v"))), name("u")])
        }
        Signal::UDot => name(LAW_RATES[0]),
        Signal::VDot => name(LAW_RATES[1]),
        Signal::RDot => name(LAW_RATES[2]),
    };
    divided(subtracted(signal, Expr::Number(input.centre)), input.scale)
}

/// Sum of rational quadratic kernels `1 / (1 + |c - x|^2 / (2 length^2))` about the centres.
fn kernel_sum(kernels: &KernelSum, inputs: &[Expr]) -> Expr {
    let twice = 2.0 * kernels.length * kernels.length;
    let kernel = |centre: &[f64]| {
        let square = |(c, x): (&f64, &Expr)| {
            let offset = subtracted(Expr::Number(*c), x.clone());
            offset.clone().times(offset)
        };
        let square = sum_terms(centre.iter().zip(inputs).map(square));
        let below = added(Expr::Number(1.0), divided(square, twice));
        Expr::Divide(Box::new(Expr::Number(1.0)), Box::new(below))
    };
    let centres = kernels.centres.chunks_exact(inputs.len()).zip(&kernels.factors);
    let terms = centres.map(|(centre, factor)| Expr::Number(*factor).times(kernel(centre)));
    added(Expr::Number(kernels.mean), sum_terms(terms))
}

/// Weighted sum `bias + row inputs`.
fn affine_sum(row: &[f64], bias: f64, inputs: &[Expr]) -> Expr {
    let terms = row.iter().zip(inputs).map(|(w, x)| Expr::Number(*w).times(x.clone()));
    added(Expr::Number(bias), sum_terms(terms))
}

/// Conditional expression `if(input <= bound, below, above)`.
pub(crate) fn split_formula(input: Expr, bound: f64, [below, above]: [Expr; 2]) -> Expr {
    let parts = [input, Expr::Number(bound), below, above];
    Expr::If(Comparison::LessOrEqual, Box::new(parts))
}

fn sum_terms(terms: impl Iterator<Item = Expr>) -> Expr {
    terms.reduce(added).unwrap_or(Expr::Number(0.0))
}

impl RegressionTree {
    /// Prediction of the tree as nested conditional expressions.
    pub fn prediction_formula(&self, inputs: &[Expr]) -> Expr {
        self.node_formula(0, inputs)
    }

    fn node_formula(&self, at: usize, inputs: &[Expr]) -> Expr {
        let (input, right, value) = self.node_at(at);
        let Some(input) = input else { return Expr::Number(value) };
        // The left child directly follows its parent.
        let below = self.node_formula(at + 1, inputs);
        let above = self.node_formula(right, inputs);
        split_formula(inputs[input].clone(), value, [below, above])
    }
}
