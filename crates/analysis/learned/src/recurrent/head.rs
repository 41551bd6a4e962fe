//! Head of a recurrent network: two layers of neurons and a weighted sum for each output, all
//! without offset, so that zero input gives zero output (Wakita 2022, Eq. 8).

use super::cell::activate_neuron;

/// Outputs of the layers, and derivatives there, as needed by the gradient.
#[derive(Debug, Clone)]
pub struct HeadStep {
    inputs: [Vec<f64>; 3],
    slopes: [Vec<f64>; 2],
}

/// Number of parameters of the head.
pub fn parameter_count(width: usize, outputs: usize) -> usize {
    2 * width * (width + 1) + outputs * width
}

/// Evaluates the outputs for the output of a cell.
pub fn propagate_forward(numbers: &[f64], answer: &[f64], outputs: usize) -> (Vec<f64>, HeadStep) {
    let width = answer.len();
    let mut inputs: [Vec<f64>; 3] = Default::default();
    let mut slopes: [Vec<f64>; 2] = Default::default();
    inputs[0] = answer.to_vec();
    for (layer, weights) in
        numbers[..2 * width * (width + 1)].chunks(width * (width + 1)).enumerate()
    {
        let answers: Vec<(f64, f64)> = weights
            .chunks_exact(width + 1)
            .map(|row| {
                let sum = row[width] + row_product(row, &inputs[layer]);
                let (answer, slope) = activate_neuron(sum);
                // The output at zero input is subtracted, so the bias shifts the working point
                // only.
                (answer - activate_neuron(row[width]).0, slope)
            })
            .collect();
        inputs[layer + 1] = answers.iter().map(|(answer, _)| *answer).collect();
        slopes[layer] = answers.iter().map(|(_, slope)| *slope).collect();
    }
    let last = &numbers[2 * width * (width + 1)..];
    let out =
        last.chunks_exact(width).take(outputs).map(|row| row_product(row, &inputs[2])).collect();
    (out, HeadStep { inputs, slopes })
}

fn row_product(row: &[f64], inputs: &[f64]) -> f64 {
    row.iter().zip(inputs).map(|(w, x)| w * x).sum()
}

/// Propagates error derivatives from the outputs to the cell's output, which are returned;
/// derivatives with respect to the parameters are added to `gradient`.
pub fn propagate_back(
    numbers: &[f64],
    step: &HeadStep,
    blame: &[f64],
    gradient: &mut [f64],
) -> Vec<f64> {
    let width = step.inputs[0].len();
    let layer = width * (width + 1);
    let mut back = vec![0.0; width];
    let rows = numbers[2 * layer..].chunks_exact(width);
    let slopes = gradient[2 * layer..].chunks_exact_mut(width);
    for ((row, slopes), blame) in rows.zip(slopes).zip(blame) {
        add_scaled(slopes, &step.inputs[2], *blame);
        add_scaled(&mut back, row, *blame);
    }
    for place in [1, 0] {
        let mut before = vec![0.0; width];
        let own = place * layer..(place + 1) * layer;
        let rows = numbers[own.clone()].chunks_exact(width + 1);
        let slopes = gradient[own].chunks_exact_mut(width + 1);
        for (k, (row, slopes)) in rows.zip(slopes).enumerate() {
            let sum = back[k] * step.slopes[place][k];
            add_scaled(&mut slopes[..width], &step.inputs[place], sum);
            // Second term: the bias also enters through the output at zero input.
            slopes[width] += sum - back[k] * activate_neuron(row[width]).1;
            add_scaled(&mut before, &row[..width], sum);
        }
        back = before;
    }
    back
}

fn add_scaled(to: &mut [f64], what: &[f64], times: f64) {
    to.iter_mut().zip(what).for_each(|(to, what)| *to += times * what);
}
