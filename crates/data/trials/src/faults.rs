//! Search for faults of the values of a table, in the form of exclusions of a manifest.

use std::collections::BTreeMap;

use sistership_columns::{
    FilteredChannel, Role, SampleFault, backward_times, repeated_rows, sample_faults,
};

use crate::exclusion::{Exclusion, RowRanges};
use crate::kinematics::{
    METRES_PER_RADIAN, column_integral, column_rate, is_position, kinematic_order,
};
use crate::series::is_angle;
use crate::table::{ColumnTarget, Table, TableValues};

/// Multiple of the usual largest magnitude above which a value is no reading.
const IMPOSSIBLE: f64 = 3.0;
/// Fraction of the lower bound of the usual largest magnitude below which a distance is no fault.
const LEAST: f64 = 0.1;
/// Smallest deviation of a position that is a fault, m.
const LEAST_M: f64 = 0.1;
/// Reasons as written in a manifest.
const BACKWARD: &str = "times that are repeated or decrease";
const REPEATED: &str = "repeats of the row before";

/// Returns the faults of every channel, one exclusion for each kind of fault with its rows.
pub(crate) fn table_faults(file: &str, table: &Table) -> Vec<Exclusion> {
    let Some(t) = table.column_values(ColumnTarget::Time) else { return Vec::new() };
    let mut search =
        FaultSearch { file, table, t_s: t.to_vec(), cleaned: BTreeMap::new(), found: Vec::new() };
    search.exclude_backward_times();
    search.exclude_repeated_rows();
    // In an order that compares each channel with others without their faults.
    let mut targets: Vec<ColumnTarget> = table.columns.iter().map(|column| column.target).collect();
    targets.sort_by_key(|target| kinematic_order(*target));
    targets.into_iter().for_each(|target| search.exclude_faults(target));
    search.found
}

/// Faults of a table that were found so far, and its columns without them.
struct FaultSearch<'a> {
    file: &'a str,
    table: &'a Table,
    /// Times; those of rows with a fault are no numbers.
    t_s: Vec<f64>,
    cleaned: BTreeMap<ColumnTarget, Vec<f64>>,
    found: Vec<Exclusion>,
}

impl TableValues for FaultSearch<'_> {
    fn column_values(&self, target: ColumnTarget) -> Option<&[f64]> {
        let cleaned = self.cleaned.get(&target).map(Vec::as_slice);
        cleaned.or_else(|| self.table.column_values(target))
    }
}

impl FaultSearch<'_> {
    fn exclude_backward_times(&mut self) {
        let backward = backward_times(&self.t_s);
        self.add_exclusion(None, &backward, BACKWARD);
        backward.into_iter().for_each(|k| self.t_s[k] = f64::NAN);
    }

    /// Excludes every value of rows that repeat the row before. The rows themselves stay, so that
    /// short gaps are interpolated.
    fn exclude_repeated_rows(&mut self) {
        let columns = self.table.columns.iter().zip(&self.table.values);
        let columns: Vec<_> =
            columns.filter(|(column, _)| column.target != ColumnTarget::Time).collect();
        let values: Vec<&[f64]> = columns.iter().map(|(_, values)| values.as_slice()).collect();
        let repeated = repeated_rows(&values);
        if repeated.is_empty() {
            return;
        }
        for (column, _) in columns {
            self.add_exclusion(Some(column.target), &repeated, REPEATED);
        }
        repeated.into_iter().for_each(|k| self.t_s[k] = f64::NAN);
    }

    fn exclude_faults(&mut self, target: ColumnTarget) {
        let role = Role::from_name(target.name()).filter(|role| *role != Role::Time);
        let Some(role) = role.filter(|role| !is_command(*role)) else { return };
        let Some(values) = self.table.column_values(target) else { return };
        let (rate, integral) = (column_rate(self, target), column_integral(self, target));
        let channel = FilteredChannel {
            values,
            rate: rate.as_deref(),
            integral: integral.as_deref(),
            is_direction: is_angle(target),
            is_position: is_position(target),
            least: least_deviation(role),
            impossible: impossible_magnitude(role),
        };
        let faults = sample_faults(&self.t_s, &channel);
        if faults.is_empty() {
            return;
        }
        let mut cleaned = values.to_vec();
        let mut by_kind: BTreeMap<SampleFault, Vec<usize>> = BTreeMap::new();
        for (k, fault) in faults {
            cleaned[k] = f64::NAN;
            by_kind.entry(fault).or_default().push(k);
        }
        self.cleaned.insert(target, cleaned);
        for (kind, samples) in by_kind {
            self.add_exclusion(Some(target), &samples, kind.manifest_text());
        }
    }

    fn add_exclusion(&mut self, target: Option<ColumnTarget>, samples: &[usize], why: &str) {
        if samples.is_empty() {
            return;
        }
        self.found.push(Exclusion {
            file: self.file.to_owned(),
            channel: target.map(|target| target.name().to_owned()),
            rows: Some(RowRanges::from_rows(samples.iter().map(|&k| self.table.rows[k]))),
            from: None,
            to: None,
            why: why.to_owned(),
        });
    }
}

/// Returns true for commands and depth, whose sudden steps are no faults.
fn is_command(role: Role) -> bool {
    matches!(
        role,
        Role::Delta | Role::DeltaS | Role::DeltaP | Role::N | Role::NS | Role::NP | Role::Depth
    )
}

/// Positions in a projected grid and headings over many turns may be large.
fn impossible_magnitude(role: Role) -> f64 {
    match role {
        Role::X | Role::Y => 1e8,
        Role::Psi | Role::Course => 1e4,
        _ => IMPOSSIBLE * role.usual_range()[1],
    }
}

fn least_deviation(role: Role) -> f64 {
    match role {
        Role::X | Role::Y => LEAST_M,
        Role::Latitude | Role::Longitude => LEAST_M / METRES_PER_RADIAN,
        _ => LEAST * role.usual_range()[0],
    }
}
