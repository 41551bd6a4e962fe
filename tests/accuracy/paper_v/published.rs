//! The columns `True`, `SP` and `MR` of Table 5 of Paper V (Kanazawa et al. 2023, doi
//! 10.1016/j.oceaneng.2023.114874), as bound into Kanazawa's thesis (NTNU 2023:247). The table's
//! other printing, 5.2 of the thesis, lacks cells.

use super::turn::Metrics;

/// A turn at a speed: four rows of the table.
pub struct Block {
    /// Propeller revolutions, rpm: the table's low, middle and high speed.
    pub n_rpm: f64,
    /// Rudder, deg.
    pub rudder_deg: f64,
    /// What the true ship does.
    pub truth: Metrics,
    /// Errors of the source parameters, %.
    pub source: Metrics,
    /// Errors of the model refinement, %, mean over five data sets.
    pub refined: Metrics,
}

const fn block(
    n_rpm: f64,
    rudder_deg: f64,
    truth: [f64; 4],
    source: [f64; 4],
    refined: [f64; 4],
) -> Block {
    Block {
        n_rpm,
        rudder_deg,
        truth: Metrics(truth),
        source: Metrics(source),
        refined: Metrics(refined),
    }
}

/// Radius, transfer, advance and speed loss in each column.
pub const TABLE_5: [Block; 6] = [
    block(80.0, 7.5, [824.9, 1683.2, 1099.2, 1.3], [10.3, 6.1, 6.5, 38.2], [3.6, 4.5, 9.6, 0.9]),
    block(80.0, -7.5, [817.1, 1683.2, 1099.2, 1.3], [28.0, 22.9, 9.3, 49.5], [5.4, 2.9, 2.6, 9.0]),
    block(100.0, 7.5, [760.7, 1558.5, 1039.8, 1.8], [19.6, 14.6, 1.9, 43.8], [1.0, 1.8, 8.3, 2.3]),
    block(
        100.0,
        -7.5,
        [755.3, 1558.5, 1039.8, 1.8],
        [38.5, 32.8, 14.4, 54.1],
        [7.0, 4.7, 2.5, 10.4],
    ),
    block(120.0, 7.5, [680.0, 1375.3, 962.3, 2.5], [33.8, 29.8, 5.1, 50.9], [1.1, 2.4, 7.3, 3.3]),
    block(
        120.0,
        -7.5,
        [676.3, 1375.3, 962.3, 2.5],
        [54.6, 50.4, 22.6, 60.0],
        [9.0, 8.8, 1.8, 10.6],
    ),
];
