//! A model linearised along a recorded motion.

use sistership_model::trial::Channel;

/// One gap-free part of a trial: how deviations from the recorded path go from sample to sample,
/// and how they are read. All matrices row by row, sample after sample.
#[derive(Debug, Clone)]
pub struct Linearised {
    /// Samples of the trial.
    pub samples: Vec<usize>,
    /// Time of each, s.
    pub t_s: Vec<f64>,
    /// Number of states, accelerations, columns.
    pub sizes: Sizes,
    /// Rate of change of deviations with deviations: states by states.
    pub jacobian: Vec<f64>,
    /// Accelerations by columns.
    pub accelerations: Vec<f64>,
    /// What the model moves more than the recorded path from a sample to the next, by state.
    pub defect: Vec<f64>,
    /// Readings less what instruments would say on the path, by recorded channel.
    pub reading: Vec<f64>,
    /// What instruments say more by deviations: channels by states; absent where they say the state
    /// itself.
    pub by_state: Option<Vec<f64>>,
    /// What instruments say more by those columns that act on them: channels by `measured` columns.
    pub by_column: Vec<f64>,
    /// Those columns.
    pub measured: Vec<usize>,
    /// The recorded channels with their places among the states.
    pub channels: Vec<(Channel, usize)>,
    /// Of samples, how many go with one reading.
    pub every: usize,
}

/// How much of a linearisation is wanted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Detail {
    /// Everything.
    Whole,
    /// The path and the columns; how deviations go on and are read comes from another one
    /// ([`Linearised::by_filter_of`]).
    Columns,
}

/// Numbers of things.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Sizes {
    /// States.
    pub states: usize,
    /// Accelerations.
    pub axes: usize,
    /// Columns.
    pub columns: usize,
}

impl Linearised {
    /// This one's path and columns through the filter of another: how deviations go on and are read
    /// is the other's.
    pub fn by_filter_of(self, other: &Self) -> Self {
        Self { jacobian: other.jacobian.clone(), by_state: other.by_state.clone(), ..self }
    }

    /// All columns at given parameters, as one column.
    pub fn along(&self, parameters: &[f64]) -> Self {
        let weighted =
            |row: &[f64]| row.iter().zip(parameters).map(|(value, by)| value * by).sum::<f64>();
        let measured: Vec<f64> = self.measured.iter().map(|&column| parameters[column]).collect();
        let said =
            |row: &[f64]| row.iter().zip(&measured).map(|(value, by)| value * by).sum::<f64>();
        Self {
            sizes: Sizes { columns: 1, ..self.sizes },
            accelerations: self
                .accelerations
                .chunks_exact(self.sizes.columns.max(1))
                .map(weighted)
                .collect(),
            by_column: self.by_column.chunks_exact(self.measured.len().max(1)).map(said).collect(),
            measured: if self.measured.is_empty() { Vec::new() } else { vec![0] },
            samples: self.samples.clone(),
            t_s: self.t_s.clone(),
            jacobian: self.jacobian.clone(),
            defect: self.defect.clone(),
            reading: self.reading.clone(),
            by_state: self.by_state.clone(),
            channels: self.channels.clone(),
            every: self.every,
        }
    }
}
