//! One limit: a half space or a second-order cone of the coefficients.

/// An affine function of the coefficients: `normal . c + constant`.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct AffineFunction {
    pub normal: Vec<f64>,
    pub constant: f64,
}

impl AffineFunction {
    /// Value of the function at coefficients.
    pub fn value_at(&self, coefficients: &[f64]) -> f64 {
        self.constant + self.normal.iter().zip(coefficients).map(|(n, c)| n * c).sum::<f64>()
    }

    /// The function `sign (c_k - bound)` of `size` coefficients, `k` being `place`.
    pub fn single_coefficient(size: usize, place: usize, sign: f64, bound: f64) -> Self {
        let mut normal = vec![0.0; size];
        normal[place] = sign;
        Self { normal, constant: -sign * bound }
    }

    /// The linear combination `a self + b other`.
    pub fn linear_combination(&self, a: f64, other: &Self, b: f64) -> Self {
        let normal = self.normal.iter().zip(&other.normal).map(|(x, y)| a * x + b * y).collect();
        Self { normal, constant: a * self.constant + b * other.constant }
    }
}

/// A limit, with the name by which messages refer to it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct CoefficientLimit {
    pub name: String,
    /// One function that is at least 0; or several, the first of which is at least the length of
    /// the others.
    pub cone: Vec<AffineFunction>,
}

impl CoefficientLimit {
    /// The limit that a function is at least 0.
    pub fn at_least_zero(name: String, function: AffineFunction) -> Self {
        Self { name, cone: vec![function] }
    }

    /// The limit that a symmetric matrix of two rows, with the diagonal `a`, `c` and the other
    /// element `b`, has no negative eigenvalue: `a + c >= |(a - c, 2 b)|` (Alizadeh and Goldfarb
    /// 2003, Mathematical Programming 95, 3-51, section 2.3: such a matrix is a cone of second
    /// order in three dimensions).
    pub fn positive_semidefinite(name: String, [a, b, c]: [&AffineFunction; 3]) -> Self {
        // `2 b` as `2 b + 0 b`, a linear combination of two functions.
        Self {
            name,
            cone: vec![
                a.linear_combination(1.0, c, 1.0),
                a.linear_combination(1.0, c, -1.0),
                b.linear_combination(2.0, b, 0.0),
            ],
        }
    }
}
