//! Multilayer perceptrons, trained by Adam (Kingma and Ba 2015, Algorithm 1) with weight decay
//! decoupled from the gradient (Loshchilov and Hutter 2019). The activation function is `x / sqrt(1
//! + x^2)`, which every processor rounds in the same way, unlike the hyperbolic tangent.

use serde::{Deserialize, Serialize};

use crate::draws::RandomStream;
use crate::sample::TrainingSample;

/// Layers of neurons; the last layer has one neuron, which is linear.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Perceptron(Vec<DenseLayer>);

/// Layer of neurons with common inputs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct DenseLayer {
    /// Weights of one neuron after the other, one weight for each input.
    weights: Vec<f64>,
    biases: Vec<f64>,
}

/// Settings of the training of a perceptron.
#[derive(Debug, Clone)]
pub struct DescentSettings<'a> {
    /// Number of neurons of each hidden layer.
    pub hidden: &'a [usize],
    /// Number of passes over all samples.
    pub epochs: usize,
    /// Number of samples per step.
    pub batch: usize,
    /// Initial learning rate; it decreases linearly to zero.
    pub rate: f64,
    /// Weight decay, multiplied by the learning rate at each step.
    pub decay: f64,
}

/// Largest number of neurons of a layer, and the size of the buffers of a layer's outputs.
const MOST_NEURONS: usize = 256;

impl DenseLayer {
    /// Random initial weights, uniform within limits by the number of inputs and neurons (Glorot
    /// and Bengio 2010, Eq. 16).
    fn with_random_weights(inputs: usize, neurons: usize, draws: &mut RandomStream) -> Self {
        let limit = (6.0 / (inputs + neurons) as f64).sqrt();
        let weights = (0..inputs * neurons).map(|_| limit * draws.signed_unit()).collect();
        Self { weights, biases: vec![0.0; neurons] }
    }

    /// Weighted sums of the inputs, `W x + b`.
    fn weighted_sums(&self, inputs: &[f64], out: &mut [f64]) {
        let rows = self.weights.chunks_exact(inputs.len());
        for ((out, row), bias) in out.iter_mut().zip(rows).zip(&self.biases) {
            *out = bias + row.iter().zip(inputs).map(|(w, x)| w * x).sum::<f64>();
        }
    }

    /// Derivatives with respect to the inputs of a layer from those with respect to its sums.
    fn propagate_back(&self, by_sum: &[f64]) -> Vec<f64> {
        // The number of inputs is not stored; it follows from the weights.
        let width = self.weights.len() / self.biases.len();
        let mut by_input = vec![0.0; width];
        for (row, value) in self.weights.chunks_exact(width).zip(by_sum) {
            by_input.iter_mut().zip(row).for_each(|(sum, weight)| *sum += value * weight);
        }
        by_input
    }

    /// Weights and biases, in this order.
    fn parameters_mut(&mut self) -> impl Iterator<Item = &mut f64> {
        self.weights.iter_mut().chain(&mut self.biases)
    }
}

/// Activation of a neuron at its weighted sum, and the derivative there.
fn activate_neuron(sum: f64) -> (f64, f64) {
    let root = 1.0 / (1.0 + sum * sum).sqrt();
    (sum * root, root * root * root)
}

impl Perceptron {
    /// Prediction for inputs in standard deviations.
    pub fn predict(&self, inputs: &[f64]) -> f64 {
        // Fixed buffers on the stack: this is called at every step of a simulation.
        let (mut here, mut next) = ([0.0; MOST_NEURONS], [0.0; MOST_NEURONS]);
        let mut width = inputs.len();
        here[..width].copy_from_slice(inputs);
        for (place, layer) in self.0.iter().enumerate() {
            layer.weighted_sums(&here[..width], &mut next);
            width = layer.biases.len();
            if place + 1 < self.0.len() {
                next[..width].iter_mut().for_each(|sum| *sum = activate_neuron(*sum).0);
            }
            std::mem::swap(&mut here, &mut next);
        }
        here[0]
    }

    /// Layers in order: the weights, neuron after neuron, and the biases.
    pub fn layers(&self) -> impl Iterator<Item = (&[f64], &[f64])> {
        self.0.iter().map(|layer| (&layer.weights[..], &layer.biases[..]))
    }

    /// Adds the derivatives of the prediction with respect to the inputs to `slopes`, by
    /// backpropagation through the layers.
    pub fn add_gradient(&self, inputs: &[f64], slopes: &mut [f64]) {
        let mut here = inputs.to_vec();
        let mut hidden = Vec::with_capacity(self.0.len());
        for layer in &self.0 {
            let mut sums = vec![0.0; layer.biases.len()];
            layer.weighted_sums(&here, &mut sums);
            hidden.push(sums.iter().map(|sum| activate_neuron(*sum).1).collect::<Vec<f64>>());
            here = sums.into_iter().map(|sum| activate_neuron(sum).0).collect();
        }
        // Backwards from the output, whose derivative with respect to itself is 1. The last layer
        // is linear and has no factor of the activation.
        let mut after = vec![1.0];
        for (place, layer) in self.0.iter().enumerate().rev() {
            if place + 1 < self.0.len() {
                after.iter_mut().zip(&hidden[place]).for_each(|(value, slope)| *value *= slope);
            }
            after = layer.propagate_back(&after);
        }
        slopes.iter_mut().zip(after).for_each(|(slope, value)| *slope += value);
    }

    /// True if the layers fit together, end in one neuron and hold finite numbers only.
    pub fn is_sound(&self, inputs: usize) -> bool {
        let mut width = inputs;
        // Buffers have a fixed size, so wider layers must be rejected here.
        let goes_on = |layer: &DenseLayer| {
            let before = std::mem::replace(&mut width, layer.biases.len());
            let mut numbers = layer.weights.iter().chain(&layer.biases);
            (1..=MOST_NEURONS).contains(&width)
                && layer.weights.len() == before * width
                && numbers.all(|number| number.is_finite())
        };
        (1..=MOST_NEURONS).contains(&inputs)
            && self.0.iter().all(goes_on)
            && self.0.last().is_some_and(|last| last.biases.len() == 1)
    }
}

/// Trains a perceptron on squared errors.
pub fn train_perceptron(
    sample: &TrainingSample,
    descent: &DescentSettings<'_>,
    draws: &mut RandomStream,
) -> Perceptron {
    let mut widths = vec![sample.columns.len()];
    widths.extend(descent.hidden.iter().chain(&[1]));
    let layers = widths
        .windows(2)
        .map(|pair| DenseLayer::with_random_weights(pair[0], pair[1], draws))
        .collect();
    let rows: Vec<Vec<f64>> = (0..sample.len()).map(|k| sample.row_inputs(k)).collect();
    let mut trainee = TrainingState::new(Perceptron(layers));
    let steps = descent.epochs * sample.len().div_ceil(descent.batch);
    let mut taken = 0;
    for _ in 0..descent.epochs {
        // A new random order of all samples in each epoch.
        for batch in draws.sample_indices(sample.len(), sample.len()).chunks(descent.batch) {
            for row in batch {
                trainee.add_row_gradient(&rows[*row as usize], sample.targets[*row as usize]);
            }
            // Linear decay of the learning rate to zero over all steps.
            let rate = descent.rate * (1.0 - taken as f64 / steps as f64);
            trainee.apply_adam(batch.len(), rate, descent.decay);
            taken += 1;
        }
    }
    trainee.network
}

/// State of the training: the network, the sums of its gradient and the moments of Adam.
struct TrainingState {
    network: Perceptron,
    gradient: Vec<DenseLayer>,
    first: Vec<DenseLayer>,
    second: Vec<DenseLayer>,
    /// Bias of the moments relative to their full size: powers of the decay rates.
    lacks: [f64; 2],
    /// Outputs of each layer, the inputs first, and derivatives there.
    answers: Vec<Vec<f64>>,
    slopes: Vec<Vec<f64>>,
    /// Derivatives of the error with respect to the sums of a layer, and of the one before it.
    blame: Vec<f64>,
    before: Vec<f64>,
}

/// Decay rates of the moments of Adam, and the constant that prevents a division by zero, as given
/// by its authors.
const DECAYS: [f64; 2] = [0.9, 0.999];
const EPSILON: f64 = 1e-8;

impl TrainingState {
    fn new(network: Perceptron) -> Self {
        let empty = |layer: &DenseLayer| DenseLayer {
            weights: vec![0.0; layer.weights.len()],
            biases: vec![0.0; layer.biases.len()],
        };
        let zeros: Vec<DenseLayer> = network.0.iter().map(empty).collect();
        let of_widths = || network.0.iter().map(|layer| vec![0.0; layer.biases.len()]).collect();
        let mut answers: Vec<Vec<f64>> = of_widths();
        let slopes = of_widths();
        answers.insert(0, Vec::new());
        Self {
            gradient: zeros.clone(),
            first: zeros.clone(),
            second: zeros,
            network,
            lacks: [1.0; 2],
            answers,
            slopes,
            blame: Vec::new(),
            before: Vec::new(),
        }
    }

    /// Adds the gradient of half the squared error of a row.
    fn add_row_gradient(&mut self, inputs: &[f64], target: f64) {
        self.propagate_forward(inputs);
        let last = self.network.0.len();
        self.blame.clear();
        // Derivative of half the squared error with respect to the output.
        self.blame.push(self.answers[last][0] - target);
        for place in (0..last).rev() {
            self.propagate_back(place);
            std::mem::swap(&mut self.blame, &mut self.before);
        }
    }

    /// Evaluates all layers and keeps their outputs and derivatives.
    fn propagate_forward(&mut self, inputs: &[f64]) {
        self.answers[0].clear();
        self.answers[0].extend_from_slice(inputs);
        let last = self.network.0.len() - 1;
        for (place, layer) in self.network.0.iter().enumerate() {
            let (before, after) = self.answers.split_at_mut(place + 1);
            layer.weighted_sums(&before[place], &mut after[0]);
            if place < last {
                for (sum, slope) in after[0].iter_mut().zip(&mut self.slopes[place]) {
                    (*sum, *slope) = activate_neuron(*sum);
                }
            }
        }
    }

    /// Adds the gradient of a layer, and computes the error derivatives of the layer before it.
    fn propagate_back(&mut self, place: usize) {
        let (inputs, layer) = (&self.answers[place], &self.network.0[place]);
        self.before.clear();
        self.before.resize(inputs.len(), 0.0);
        let width = inputs.len();
        for (neuron, blame) in self.blame.iter().enumerate() {
            let own = neuron * width..(neuron + 1) * width;
            let gradient = &mut self.gradient[place];
            gradient.biases[neuron] += blame;
            let sums = gradient.weights[own.clone()].iter_mut().zip(inputs);
            sums.for_each(|(sum, x)| *sum += blame * x);
            let back = self.before.iter_mut().zip(&layer.weights[own]);
            back.for_each(|(back, weight)| *back += blame * weight);
        }
        // The inputs themselves have no activation.
        if place > 0 {
            self.before.iter_mut().zip(&self.slopes[place - 1]).for_each(|(b, slope)| *b *= slope);
        }
    }

    /// Applies a step of Adam with the mean gradient of a batch, then resets the gradient.
    fn apply_adam(&mut self, batch: usize, rate: f64, decay: f64) {
        self.lacks.iter_mut().zip(DECAYS).for_each(|(lack, decay)| *lack *= decay);
        // Correction of the bias of the moments, which start at zero (Algorithm 1).
        let full = self.lacks.map(|lack| 1.0 - lack);
        let layers = self.network.0.iter_mut().zip(&mut self.gradient);
        let moments = self.first.iter_mut().zip(&mut self.second);
        for ((layer, gradient), (first, second)) in layers.zip(moments) {
            let numbers = layer.parameters_mut().zip(gradient.parameters_mut());
            for ((number, sum), (m, v)) in
                numbers.zip(first.parameters_mut().zip(second.parameters_mut()))
            {
                let slope = std::mem::take(sum) / batch as f64;
                *m = DECAYS[0] * *m + (1.0 - DECAYS[0]) * slope;
                *v = DECAYS[1] * *v + (1.0 - DECAYS[1]) * slope * slope;
                let move_by = (*m / full[0]) / ((*v / full[1]).sqrt() + EPSILON);
                // The decay does not pass through the moments: that is the decoupling.
                *number -= rate * (move_by + decay * *number);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample() -> TrainingSample {
        let x: Vec<f64> = (0..400).map(|k| f64::from(k % 20) / 10.0 - 1.0).collect();
        let y: Vec<f64> = (0..400).map(|k| f64::from(k / 20) / 10.0 - 1.0).collect();
        let targets = x.iter().zip(&y).map(|(x, y)| x * y + 0.5 * x).collect();
        TrainingSample { columns: vec![x, y], targets }
    }

    fn descent(hidden: &[usize]) -> DescentSettings<'_> {
        DescentSettings { hidden, epochs: 100, batch: 32, rate: 0.02, decay: 0.0 }
    }

    #[test]
    fn a_product_is_learned() {
        let sample = sample();
        let network = train_perceptron(&sample, &descent(&[12, 12]), &mut RandomStream::new(1, 0));
        let error = |k: usize| (network.predict(&sample.row_inputs(k)) - sample.targets[k]).powi(2);
        let mean = (0..sample.len()).map(error).sum::<f64>() / sample.len() as f64;
        assert!(mean < 1e-3, "{mean}");
        assert!(network.is_sound(2) && !network.is_sound(3));
    }

    #[test]
    fn the_gradient_is_that_of_differences() {
        let layers = |draws: &mut RandomStream| {
            vec![
                DenseLayer::with_random_weights(2, 3, draws),
                DenseLayer::with_random_weights(3, 1, draws),
            ]
        };
        let network = Perceptron(layers(&mut RandomStream::new(5, 0)));
        let (inputs, target) = ([0.3, -0.7], 0.4);
        let mut trainee = TrainingState::new(network.clone());
        trainee.add_row_gradient(&inputs, target);
        let error = |network: &Perceptron| 0.5 * (network.predict(&inputs) - target).powi(2);
        for (layer, place) in [(0, 0), (0, 5), (1, 2)] {
            let moved = |by: f64| {
                let mut network = network.clone();
                network.0[layer].weights[place] += by;
                error(&network)
            };
            let slope = (moved(1e-5) - moved(-1e-5)) / 2e-5;
            let found = trainee.gradient[layer].weights[place];
            assert!((slope - found).abs() < 1e-8, "{slope} {found}");
        }
    }
}
