#![allow(clippy::unwrap_used)]
use sistership_model::manifest::ColumnMapping;

use super::*;

fn run(headers: &[&str], mapping: &Mapping) -> (Option<Vec<TableColumn>>, String) {
    let headers: Vec<String> = headers.iter().map(|&header| header.to_owned()).collect();
    let mut findings = Findings::default();
    let columns = resolve_headers(&headers, mapping, &mut findings);
    let (errors, warnings) = findings.into_lists();
    let text = errors
        .into_iter()
        .chain(warnings)
        .map(|finding| finding.message)
        .collect::<Vec<_>>()
        .join("\n");
    (columns, text)
}

fn mapped(columns: &[(&str, &str, &str)]) -> Mapping {
    let one = |&(name, column, unit): &(&str, &str, &str)| {
        (name.to_owned(), ColumnMapping::new(column, unit))
    };
    Mapping { columns: columns.iter().map(one).collect(), ..Mapping::default() }
}

#[test]
fn canonical_names_need_no_mapping_and_others_are_listed_once() {
    let (columns, text) =
        run(&["t_s", "u_kn", "delta_ordered_rad", "note"], &Mapping::with_canonical_names());
    let columns = columns.unwrap();
    assert_eq!(columns.len(), 2);
    assert!((columns[1].to_si - 0.514_444).abs() < 1e-5);
    assert_eq!(text, "columns not read: delta_ordered_rad, note");
}

#[test]
fn a_mapping_goes_before_a_canonical_name() {
    let (columns, _) = run(&["t_s", "u_m_s", "log"], &mapped(&[("u", "log", "kn")]));
    assert_eq!(columns.unwrap()[0].header, "log");
}

#[test]
fn a_missing_column_is_answered_with_those_that_exist() {
    let (columns, text) = run(&["t_s", "u_velo [m/s]"], &mapped(&[("u", "u_vel [m/s]", "m/s")]));
    assert!(columns.is_none());
    assert!(text.contains("did you mean `u_velo [m/s]`?; the file has `t_s`"), "{text}");
}

#[test]
fn two_columns_for_one_channel_are_refused() {
    let (columns, text) = run(&["t_s", "u_m_s", "u_kn"], &Mapping::with_canonical_names());
    assert!(columns.is_none());
    assert!(text.contains("`u_m_s` and `u_kn` both give u"), "{text}");
    let (columns, _) = run(&["t_s", "u", "u"], &mapped(&[("u", "u", "m/s")]));
    assert!(columns.is_none());
}

#[test]
fn one_column_is_one_channel() {
    let (_, text) = run(&["t_s", "a"], &mapped(&[("u", "a", "m/s"), ("v", "a", "m/s")]));
    assert!(text.contains("mapped to u and to v"), "{text}");
}

#[test]
fn time_and_a_channel_are_needed() {
    assert!(
        run(&["time_s", "u_m_s"], &Mapping::with_canonical_names()).1.contains("name it `t_s`")
    );
    assert!(
        run(&["t_s", "speed"], &Mapping::with_canonical_names())
            .1
            .contains("no column for any channel")
    );
}

#[test]
fn a_wrong_unit_is_answered_with_the_right_ones() {
    let (_, text) = run(&["t_s", "n"], &mapped(&[("n", "n", "rad/s")]));
    assert!(text.contains("n: unit `rad/s` does not fit; use one of rps, rpm"), "{text}");
}

#[test]
fn apparent_wind_has_channels_of_its_own() {
    let mut mapping = mapped(&[("wind_speed", "w", "kn")]);
    mapping.conventions.wind.kind = WindKind::Apparent;
    let (columns, _) = run(&["t_s", "w"], &mapping);
    assert_eq!(columns.unwrap()[0].target, ColumnTarget::Channel(Channel::ApparentWindSpeed));
}

#[test]
fn a_header_and_a_manifest_agree_on_the_unit() {
    for (name, header, unit) in [
        ("u", "log_kn", "m/s"),
        ("u", "log [kn]", "m/s"),
        ("r", "r_deg_s", "rad/s"),
        ("psi", "psi (deg)", "rad"),
        ("t", "t_ms", "s"),
    ] {
        let time = if name == "t" { "u_m_s" } else { "t_s" };
        let (columns, text) = run(&[time, header], &mapped(&[(name, header, unit)]));
        assert!(columns.is_none() && text.contains("the header has the unit"), "{header}: {text}");
    }
    for (name, header, unit) in [
        ("u", "log_kn", "kn"),
        ("u", "speed [m/s]", "m/s"),
        ("x", "east_m", "m"),
        ("psi", "hdg_s", "deg"),
    ] {
        assert!(run(&["t_s", header], &mapped(&[(name, header, unit)])).0.is_some(), "{header}");
    }
}
