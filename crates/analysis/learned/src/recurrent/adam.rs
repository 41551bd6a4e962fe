//! Optimiser Adam (Kingma and Ba 2015, Algorithm 1) on a vector of numbers.

/// Decay rates of the moments, and the constant that prevents a division by zero, as given by its
/// authors.
const DECAYS: [f64; 2] = [0.9, 0.999];
const EPSILON: f64 = 1e-8;

/// Optimiser state: moments of the gradient.
pub struct AdamOptimizer {
    moments: Vec<[f64; 2]>,
    /// Bias of the moments relative to their full size: powers of the decay rates.
    lacks: [f64; 2],
}

impl AdamOptimizer {
    /// Creates the state for `count` numbers, with zero moments.
    pub fn new(count: usize) -> Self {
        Self { moments: vec![[0.0; 2]; count], lacks: [1.0; 2] }
    }

    /// Applies one step against a gradient, with the given learning rate.
    pub fn apply_gradient(&mut self, numbers: &mut [f64], gradient: &[f64], rate: f64) {
        self.lacks.iter_mut().zip(DECAYS).for_each(|(lack, decay)| *lack *= decay);
        // The moments start at zero; this corrects their bias.
        let full = self.lacks.map(|lack| 1.0 - lack);
        let all = numbers.iter_mut().zip(gradient).zip(&mut self.moments);
        for ((number, slope), [m, v]) in all {
            *m = DECAYS[0] * *m + (1.0 - DECAYS[0]) * slope;
            *v = DECAYS[1] * *v + (1.0 - DECAYS[1]) * slope * slope;
            *number -= rate * (*m / full[0]) / ((*v / full[1]).sqrt() + EPSILON);
        }
    }
}
