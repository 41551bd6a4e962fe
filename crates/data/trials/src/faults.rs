//! Search for faults of the values of a table, in the form of exclusions of a manifest.

use std::collections::BTreeMap;

use sistership_columns::{FilteredChannel, Role, SampleFault, backward_times, sample_faults};

use crate::exclusion::{Exclusion, RowRanges};
use crate::series::is_angle;
use crate::table::{ColumnTarget, Table};

/// Channels and their measured rates.
const RATES: [(&str, &str); 2] = [("psi", "r"), ("phi", "p")];
/// Multiple of the usual largest magnitude above which a value is no reading.
const IMPOSSIBLE: f64 = 3.0;
/// Fraction of the lower bound of the usual largest magnitude below which a distance is no fault.
const LEAST: f64 = 0.1;

/// Returns the faults of every channel, one exclusion for each kind of fault with its rows.
pub(crate) fn table_faults(file: &str, table: &Table) -> Vec<Exclusion> {
    let Some(t) = values_of(table, "t") else { return Vec::new() };
    let mut found: Vec<Exclusion> = Vec::new();
    let backward = backward_times(t);
    if !backward.is_empty() {
        let rows = backward.into_iter().map(|k| table.rows[k]);
        let why = "times that are repeated or decrease";
        found.push(fault_exclusion(file, None, rows, why));
    }
    for (column, values) in table.columns.iter().zip(&table.values) {
        let name = column.target.name();
        let Some(role) = Role::from_name(name).filter(|role| *role != Role::Time) else { continue };
        if is_command(role) {
            continue;
        }
        let rate = RATES.iter().find(|(whole, _)| *whole == name);
        let channel = FilteredChannel {
            values,
            rate: rate.and_then(|(_, rate)| values_of(table, rate)),
            is_direction: is_angle(column.target),
            least: LEAST * role.usual_range()[0],
            impossible: impossible_magnitude(role),
        };
        let mut by_kind: BTreeMap<SampleFault, Vec<u32>> = BTreeMap::new();
        for (k, fault) in sample_faults(t, &channel) {
            by_kind.entry(fault).or_default().push(table.rows[k]);
        }
        found.extend(
            by_kind
                .into_iter()
                .map(|(kind, rows)| fault_exclusion(file, Some(name), rows, kind.manifest_text())),
        );
    }
    found
}

fn fault_exclusion(
    file: &str,
    channel: Option<&str>,
    rows: impl IntoIterator<Item = u32>,
    why: &str,
) -> Exclusion {
    Exclusion {
        file: file.to_owned(),
        channel: channel.map(str::to_owned),
        rows: Some(RowRanges::from_rows(rows)),
        from: None,
        to: None,
        why: why.to_owned(),
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

fn values_of<'a>(table: &'a Table, name: &str) -> Option<&'a [f64]> {
    let target = ColumnTarget::from_name(name)?;
    let at = table.columns.iter().position(|column| column.target == target)?;
    table.values.get(at).map(Vec::as_slice)
}
