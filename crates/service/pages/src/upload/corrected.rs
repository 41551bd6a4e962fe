//! A manifest with the corrections of the form.

use std::collections::BTreeMap;

use indexmap::IndexMap;
use sistership_model::manifest::{ColumnMapping, MissingValues, RudderSign, VelocityFrame};
use sistership_trials::ManifestFile;

use super::proposed::{DERIVED, TARGETS, UploadProposal};
use crate::error::{PageError, Result};
use crate::form::FormFields;

/// Returns the manifest with the form's columns, signs, manoeuvres and depths.
///
/// # Errors
/// Returns an error if a channel is unknown or given twice, a unit is missing, or a depth is no
/// number.
pub fn correct_manifest(of: &UploadProposal, fields: &FormFields) -> Result<ManifestFile> {
    let mut manifest = of.manifest.clone();
    let mut by_file: BTreeMap<&str, IndexMap<String, ColumnMapping>> = BTreeMap::new();
    let mut ignored = Vec::new();
    for (key, guess) in of.guesses.iter().enumerate().filter(|(_, one)| of.is_mapped(&one.file)) {
        let columns = by_file.entry(&guess.file).or_default();
        match column_mapping(fields, key, &guess.column)? {
            None => ignored.push(guess.column.clone()),
            Some((channel, mut mapping)) => {
                // The sign of the rudder is a field of its own.
                mapping.reversed = guess.reversed && !channel.starts_with("delta");
                if let Some(first) = columns.insert(channel.clone(), mapping) {
                    let message = format!(
                        "`{}` is read as {channel} already; choose one column",
                        first.column
                    );
                    return Err(PageError::invalid_field(&format!("channel.{key}"), message));
                }
            }
        }
    }
    let sensors = manifest.sensors.iter_mut().flatten();
    for sensor in sensors {
        if let Some(columns) = by_file.remove(sensor.file.as_str()) {
            sensor.columns = columns.into_iter().collect();
        }
    }
    // The remaining entry is that of the first trial file, whose columns the other trials share.
    if let Some(columns) = by_file.into_values().next() {
        manifest.manifest.columns = columns;
    }
    // Two files may have ignored columns of the same name.
    ignored.sort_unstable();
    ignored.dedup();
    manifest.declarations.ignore = ignored;
    apply_conventions(&mut manifest, fields)?;
    apply_trial_fields(&mut manifest, fields)?;
    Ok(manifest)
}

/// Returns channel and unit of a column; `None` if it is not used.
fn column_mapping(
    fields: &FormFields,
    key: usize,
    column: &str,
) -> Result<Option<(String, ColumnMapping)>> {
    let field = format!("channel.{key}");
    let Some(channel) = fields.get_text(&field) else { return Ok(None) };
    if !TARGETS.contains(&channel) {
        return Err(PageError::invalid_field(
            &field,
            format!("`{channel}` is not a channel; choose one of the list"),
        ));
    }
    let unit = fields.required_text(&format!("unit.{key}"))?.to_owned();
    Ok(Some((channel.to_owned(), ColumnMapping::new(column, unit))))
}

fn apply_conventions(manifest: &mut ManifestFile, fields: &FormFields) -> Result<()> {
    let one_of = |name: &str, words: [&str; 2]| match fields.get_text(name) {
        Some(text) if text == words[0] => Ok(true),
        Some(text) if text == words[1] => Ok(false),
        _ => Err(PageError::invalid_field(name, format!("must be {} or {}", words[0], words[1]))),
    };
    let conventions = &mut manifest.manifest.conventions;
    conventions.rudder_positive = match one_of("rudder_positive", ["starboard_turn", "port_turn"])?
    {
        true => RudderSign::StarboardTurn,
        false => RudderSign::PortTurn,
    };
    conventions.velocity = match one_of("velocity", ["ground", "water"])? {
        true => VelocityFrame::Ground,
        false => VelocityFrame::Water,
    };
    conventions.missing = match fields.get_text("missing") {
        Some("bridge") => MissingValues::Bridge,
        Some("drop") => MissingValues::Drop,
        Some("refuse") => MissingValues::Refuse,
        _ => return Err(PageError::invalid_field("missing", "must be bridge, drop or refuse")),
    };
    let wanted = DERIVED
        .into_iter()
        .filter(|(name, _)| fields.get_text(&format!("derive_{name}")).is_some());
    manifest.declarations.derive = wanted.map(|(_, one)| one).collect();
    Ok(())
}

fn apply_trial_fields(manifest: &mut ManifestFile, fields: &FormFields) -> Result<()> {
    for (place, trial) in manifest.manifest.trials.iter_mut().enumerate() {
        trial.manoeuvre = fields.get_text(&format!("manoeuvre.{place}")).map(str::to_owned);
        let field = format!("depth.{place}");
        trial.depth_m = match fields.optional_number(&field)? {
            Some(depth) if depth <= 0.0 => {
                let message = "must be above 0; leave it empty for deep water";
                return Err(PageError::invalid_field(&field, message));
            }
            depth => depth,
        };
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use sistership_trials::propose_manifest;

    fn proposed(text: &str) -> (tempfile::TempDir, UploadProposal) {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("log.csv");
        std::fs::write(&path, text).unwrap();
        let proposal = propose_manifest("kcs", &[&path]).unwrap();
        let (guesses, manifest) = (proposal.guesses, proposal.manifest);
        let of = UploadProposal {
            ship: "kcs".into(),
            id: "1".into(),
            guesses,
            manifest,
            diagnose: true,
        };
        (folder, of)
    }

    fn fields(pairs: &[(&str, &str)]) -> FormFields {
        let signs = [("rudder_positive", "port_turn"), ("velocity", "water"), ("missing", "drop")];
        let all = signs.iter().chain(pairs);
        let pairs = all.map(|(name, text)| ((*name).to_owned(), (*text).to_owned()));
        FormFields::from(pairs.collect::<Vec<_>>())
    }

    #[test]
    fn what_a_person_corrects_is_in_the_manifest() {
        let (_folder, of) = proposed("t_s,strange,other\n0,1,2\n1,2,3\n");
        let form = [
            ("channel.0", "t"),
            ("unit.0", "s"),
            ("channel.1", "psi"),
            ("unit.1", "deg"),
            ("manoeuvre.0", "zigzag 10/10"),
            ("depth.0", "12,5"),
            ("derive_r", "on"),
        ];
        let manifest = correct_manifest(&of, &fields(&form)).unwrap();
        let psi = &manifest.manifest.columns["psi"];
        assert_eq!((psi.column.as_str(), psi.unit.as_str()), ("strange", "deg"));
        assert_eq!(manifest.declarations.ignore, ["other"]);
        assert_eq!(manifest.manifest.conventions.rudder_positive, RudderSign::PortTurn);
        assert_eq!(manifest.manifest.trials[0].depth_m, Some(12.5));
        assert_eq!(manifest.declarations.derive.len(), 1);
    }

    #[test]
    fn a_wrong_field_is_named() {
        let (_folder, of) = proposed("t_s,psi_deg\n0,1\n1,2\n");
        let wrong =
            |form: &[(&str, &str)]| correct_manifest(&of, &fields(form)).unwrap_err().to_string();
        let twice = [("channel.0", "t"), ("unit.0", "s"), ("channel.1", "t"), ("unit.1", "s")];
        assert!(wrong(&twice).starts_with("channel.1: "));
        assert!(wrong(&[("channel.0", "t")]).starts_with("unit.0: "));
        assert!(wrong(&[("channel.0", "<b>"), ("unit.0", "s")]).contains("is not a channel"));
        assert!(wrong(&[("depth.0", "-1")]).starts_with("depth.0: "));
    }
}
