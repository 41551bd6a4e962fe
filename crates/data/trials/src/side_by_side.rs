//! Detection of tables that hold several trials beside each other, each with a time of its own.

use std::collections::{BTreeMap, BTreeSet};

use crate::names;

/// Fewest names, time among them, that the trials of a table have in common.
const SHARED_NAMES: usize = 3;

/// Returns the columns of each trial of a table with several; `None` if it has one.
///
/// Trials are told by a number at the end of each name (`t_1`, `u_1`, `t_2`, `u_2`) or by names that
/// occur again (`t`, `u`, `t`, `u`).
pub(crate) fn find_groups(names: &[String]) -> Option<Vec<Vec<&str>>> {
    let mut groups: BTreeMap<usize, Vec<(String, &str)>> = BTreeMap::new();
    let mut known: BTreeMap<&str, usize> = BTreeMap::new();
    for name in names.iter().map(|name| name.trim()).filter(|name| !name.is_empty()) {
        let count = known.entry(name).or_default();
        *count += 1;
        // A name that occurs again belongs to the next trial, as if it had a number.
        let (stem, number) = split_number(name).unwrap_or((name, *count));
        groups.entry(number).or_default().push((stem.to_lowercase(), name));
    }
    let has_time =
        |group: &[(String, &str)]| group.iter().any(|(stem, _)| names::begins_time(stem));
    // Without a time of its own a group is a pair of rudders or propellers, and no trial.
    groups.retain(|_, group| has_time(group));
    let stems = |group: &[(String, &str)]| -> BTreeSet<String> {
        group.iter().map(|(stem, _)| stem.clone()).collect()
    };
    let mut sets = groups.values().map(|group| stems(group));
    let first = sets.next()?;
    let shared = sets.fold(first, |shared, other| &shared & &other);
    let several = groups.len() > 1 && shared.len() >= SHARED_NAMES;
    several.then(|| {
        groups
            .into_values()
            .map(|group| group.into_iter().map(|(_, name)| name).collect())
            .collect()
    })
}

/// Separates the number at the end of a name: `u_1`, `u1`, `Rudder (2)`.
fn split_number(name: &str) -> Option<(&str, usize)> {
    let bare = name.trim_end_matches([')', ']']);
    let stem = bare.trim_end_matches(|at: char| at.is_ascii_digit());
    let number = bare[stem.len()..].parse().ok()?;
    let stem = stem.trim_end_matches(['_', '-', '.', ' ', '(', '[', '#']);
    (!stem.is_empty()).then_some((stem, number))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn groups(names: &str) -> Option<Vec<String>> {
        let names: Vec<String> = names.split(',').map(str::to_owned).collect();
        let found = find_groups(&names)?;
        Some(found.iter().map(|group| group.join(" ")).collect())
    }

    #[test]
    fn trials_side_by_side_are_told_by_numbers_or_by_repetition() {
        let told = Some(vec!["t_1 u_1 r_1".to_owned(), "t_2 u_2 r_2".to_owned()]);
        assert_eq!(groups("t_1,u_1,r_1,t_2,u_2,r_2"), told);
        assert_eq!(groups("t_1,t_2,u_1,u_2,r_1,r_2"), told);
        let told = Some(vec!["Time (s) Heading Rudder".to_owned(); 2]);
        assert_eq!(groups("Time (s),Heading,Rudder,,Time (s),Heading,Rudder"), told);
    }

    #[test]
    fn one_trial_may_have_numbered_columns_and_a_name_twice() {
        for names in [
            "t,n_1,n_2,delta_1,delta_2",
            "t,u,v,r,u",
            "t_s,rpm1,rpm2,psi",
            "time,time,u",
            "a,b",
            "",
        ] {
            assert_eq!(groups(names), None, "{names}");
        }
    }
}
