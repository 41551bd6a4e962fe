//! Columns by which another published form of an effect may differ from the one that is used.
//!
//! Forms of one effect differ in their accelerations by a share of the effect's response: each
//! acceleration by its own share, a share that grows with the speed, and a response that comes
//! later. Their sizes are unknown and are integrated out (consider parameters: Schmidt 1966, Adv
//! Control Syst 3, 293-340).

use super::linearised::{LinearisationSizes, LinearisedPart};

/// Number of columns for each acceleration of a response.
pub const FORM_ERRORS: usize = 3;

/// A column that acts on one acceleration.
#[derive(Debug, Clone, PartialEq)]
pub struct AxisColumn {
    /// Index of the acceleration.
    pub axis: usize,
    /// Acceleration by a unit of the column, for each interval.
    pub values: Vec<f64>,
}

impl LinearisedPart {
    /// Returns the columns of the errors of a form whose response is the sum of the columns by
    /// `weights`: those of the first acceleration, then of the next. `pace` is the relative excess
    /// of the speed at each sample, `memory_s` the time by which the response may be later.
    pub fn form_errors(&self, weights: &[f64], pace: &[f64], memory_s: f64) -> Vec<AxisColumn> {
        let LinearisationSizes { axes, columns, .. } = self.sizes;
        let row = |row: &[f64]| row.iter().zip(weights).map(|(a, by)| a * by).sum::<f64>();
        let all: Vec<f64> = self.accelerations.chunks_exact(columns.max(1)).map(row).collect();
        let of_axis = |axis: usize| {
            let own: Vec<f64> = all.iter().skip(axis).step_by(axes).copied().collect();
            let by_pace =
                own.iter().zip(pace.windows(2)).map(|(a, ends)| a * 0.5 * (ends[0] + ends[1]));
            let (by_pace, later) = (by_pace.collect(), self.delay_response(&own, memory_s));
            [own, by_pace, later].map(|values| AxisColumn { axis, values })
        };
        (0..axes).flat_map(of_axis).collect()
    }

    /// First-order response to an acceleration, less that acceleration.
    fn delay_response(&self, own: &[f64], memory_s: f64) -> Vec<f64> {
        let mut late = own.first().copied().unwrap_or_default();
        let next = |(value, ends): (&f64, &[f64])| {
            late += (1.0 - (-(ends[1] - ends[0]) / memory_s).exp()) * (value - late);
            late - value
        };
        own.iter().zip(self.t_s.windows(2)).map(next).collect()
    }

    /// Appends columns that act on one acceleration each.
    pub fn append_axis_columns(self, more: &[AxisColumn]) -> Self {
        let LinearisationSizes { axes, columns, .. } = self.sizes;
        let steps = self.t_s.len().saturating_sub(1);
        let mut accelerations = Vec::with_capacity(steps * axes * (columns + more.len()));
        for step in 0..steps {
            for axis in 0..axes {
                let row = (step * axes + axis) * columns;
                accelerations.extend_from_slice(&self.accelerations[row..row + columns]);
                let value =
                    |one: &AxisColumn| if one.axis == axis { one.values[step] } else { 0.0 };
                accelerations.extend(more.iter().map(value));
            }
        }
        let sizes = LinearisationSizes { columns: columns + more.len(), ..self.sizes };
        Self { sizes, accelerations, ..self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn part() -> LinearisedPart {
        LinearisedPart {
            samples: vec![0, 1, 2],
            t_s: vec![0.0, 1.0, 2.0],
            sizes: LinearisationSizes { states: 2, axes: 2, columns: 1 },
            jacobian: vec![0.0; 8],
            accelerations: vec![1.0, 2.0, 3.0, 4.0],
            defect: vec![0.0; 4],
            reading: Vec::new(),
            by_state: None,
            by_column: Vec::new(),
            measured: Vec::new(),
            by_rate: Vec::new(),
            channels: Vec::new(),
            every: 1,
        }
    }

    #[test]
    fn each_acceleration_of_a_response_has_its_own_errors() {
        let errors = part().form_errors(&[0.5], &[0.0, 0.0, 1.0], 1.0);
        assert_eq!(errors.len(), 2 * FORM_ERRORS);
        assert_eq!((errors[0].axis, &errors[0].values[..]), (0, &[0.5, 1.5][..]));
        assert_eq!((errors[4].axis, &errors[4].values[..]), (1, &[0.0, 1.0][..]));
        // The late response rises to 1 - 1/e of a step.
        assert!((errors[2].values[1] + (-1.0_f64).exp()).abs() < 1e-12, "{errors:?}");
        let with = part().append_axis_columns(&errors[..1]);
        assert_eq!(with.sizes.columns, 2);
        assert_eq!(with.accelerations, [1.0, 0.5, 2.0, 0.0, 3.0, 1.5, 4.0, 0.0]);
    }
}
