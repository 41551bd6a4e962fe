//! Adam (Kingma and Ba 2015, Algorithm 1) on numbers in a row.

/// Decays of the moments, and what keeps it from dividing by nothing, as its authors give them.
const DECAYS: [f64; 2] = [0.9, 0.999];
const EPSILON: f64 = 1e-8;

/// Moments of a gradient.
pub struct Adam {
    moments: Vec<[f64; 2]>,
    /// What the moments lack of their full size: powers of the decays.
    lacks: [f64; 2],
}

impl Adam {
    /// Nothing seen yet, for so many numbers.
    pub fn new(count: usize) -> Self {
        Self { moments: vec![[0.0; 2]; count], lacks: [1.0; 2] }
    }

    /// A step of a length against a gradient.
    pub fn step(&mut self, numbers: &mut [f64], gradient: &[f64], rate: f64) {
        self.lacks.iter_mut().zip(DECAYS).for_each(|(lack, decay)| *lack *= decay);
        let full = self.lacks.map(|lack| 1.0 - lack);
        let all = numbers.iter_mut().zip(gradient).zip(&mut self.moments);
        for ((number, slope), [m, v]) in all {
            *m = DECAYS[0] * *m + (1.0 - DECAYS[0]) * slope;
            *v = DECAYS[1] * *v + (1.0 - DECAYS[1]) * slope * slope;
            *number -= rate * (*m / full[0]) / ((*v / full[1]).sqrt() + EPSILON);
        }
    }
}
