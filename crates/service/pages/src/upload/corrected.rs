//! A proposal with the corrections of the form.

use indexmap::IndexMap;
use sistership_model::manifest::{ColumnMapping, MissingValues, RudderSign, VelocityFrame};
use sistership_trials::{ColumnGuess, ManifestFile};

use super::proposed::{DERIVED, GIVEN, TARGETS, UploadProposal};
use super::trial_fields::apply_trial_fields;
use crate::error::{PageError, Result};
use crate::form::FormFields;
use crate::language::say;

/// Returns the proposal with the form's columns, signs, manoeuvres, depths and exclusions.
///
/// # Errors
/// Returns an error if a channel is unknown or given twice, a unit is missing, or a depth is no
/// number.
pub fn correct_proposal(of: &UploadProposal, fields: &FormFields) -> Result<UploadProposal> {
    let mut corrected = of.clone();
    corrected.diagnose = fields.get_text("diagnose").is_some();
    // Signs first: they are part of the readings of columns.
    apply_conventions(&mut corrected.manifest, fields)?;
    for file in of.mapped_files() {
        let columns = correct_guesses(&mut corrected, fields, file)?;
        replace_columns(&mut corrected.manifest, of, file, &columns);
    }
    corrected.manifest.declarations.ignore = ignored_columns(&corrected.guesses);
    apply_trial_fields(&mut corrected.manifest, fields)?;
    keep_exclusions(&mut corrected.manifest, fields);
    Ok(corrected)
}

/// Corrects the readings of the columns of a file, and returns its channels with their columns.
fn correct_guesses(
    of: &mut UploadProposal,
    fields: &FormFields,
    file: &str,
) -> Result<IndexMap<String, ColumnMapping>> {
    let port = of.manifest.manifest.conventions.rudder_positive == RudderSign::PortTurn;
    let mut columns: IndexMap<String, ColumnMapping> = IndexMap::new();
    for (key, guess) in of.guesses.iter_mut().enumerate().filter(|(_, one)| one.file == file) {
        let read = column_mapping(fields, key, &guess.column)?;
        if let Some((channel, mapping)) = &read
            && let Some(first) = columns.insert(channel.clone(), mapping.clone())
        {
            let message = say("upload-read-already").with("column", first.column);
            let message = message.with("channel", channel);
            return Err(PageError::invalid_field(&format!("channel.{key}"), message));
        }
        settle_guess(guess, read, port);
    }
    Ok(columns)
}

/// Replaces the reading of a column by that of the form, if they differ.
fn settle_guess(guess: &mut ColumnGuess, read: Option<(String, ColumnMapping)>, port: bool) {
    // The sign of the rudder is a field of its own.
    let is_reversed = |channel: &str, one: &ColumnMapping| match channel.starts_with("delta") {
        true => port,
        false => one.reversed,
    };
    let reversed = read.as_ref().is_some_and(|(channel, one)| is_reversed(channel, one));
    let (channel, unit) = read.map(|(channel, one)| (channel, one.unit)).unzip();
    if (&guess.channel, &guess.unit, guess.reversed) == (&channel, &unit, reversed) {
        return;
    }
    *guess = ColumnGuess {
        channel,
        unit,
        reversed,
        probability: 1.0,
        why: GIVEN.into(),
        certain: true,
        question: None,
        ..guess.clone()
    };
}

/// Replaces the columns of a file, and of all trials that share them.
fn replace_columns(
    manifest: &mut ManifestFile,
    before: &UploadProposal,
    file: &str,
    columns: &IndexMap<String, ColumnMapping>,
) {
    let sensors = manifest.sensors.iter_mut().flatten();
    if let Some(sensor) = sensors.into_iter().find(|sensor| sensor.file == file) {
        let columns = columns.iter().map(|(name, one)| (name.clone(), one.clone()));
        sensor.columns = columns.collect();
        return;
    }
    let known = &before.manifest.manifest.trials;
    let Some(first) = known.iter().find(|trial| trial.file == file) else { return };
    if first.columns.is_empty() {
        manifest.manifest.columns = columns.clone();
        return;
    }
    let alike = manifest.manifest.trials.iter_mut().zip(known);
    for (trial, _) in alike.filter(|(_, known)| known.columns == first.columns) {
        trial.columns = columns.clone();
    }
}

/// Returns the columns that are not read. Two files may have such columns of the same name.
fn ignored_columns(guesses: &[ColumnGuess]) -> Vec<String> {
    let ignored = guesses.iter().filter(|one| one.channel.is_none() && !one.column.is_empty());
    let mut ignored: Vec<String> = ignored.map(|guess| guess.column.clone()).collect();
    ignored.sort_unstable();
    ignored.dedup();
    ignored
}

/// Returns channel, unit and sign of a column; `None` if it is not used.
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
            say("upload-no-channel").with("channel", channel),
        ));
    }
    let unit = fields.required_text(&format!("unit.{key}"))?.to_owned();
    let ticked = fields.get_text(&format!("reversed.{key}")).is_some();
    let reversed = ticked && !channel.starts_with("delta");
    let mapping = ColumnMapping { reversed, ..ColumnMapping::new(column, unit) };
    Ok(Some((channel.to_owned(), mapping)))
}

/// Removes the exclusions that are not ticked.
fn keep_exclusions(manifest: &mut ManifestFile, fields: &FormFields) {
    let mut place = 0_usize..;
    manifest.declarations.exclude.retain(|_| {
        let name = place.next().map(|place| format!("excluded.{place}"));
        name.is_some_and(|name| fields.get_text(&name).is_some())
    });
}

fn apply_conventions(manifest: &mut ManifestFile, fields: &FormFields) -> Result<()> {
    let one_of = |name: &str, words: [&str; 2]| match fields.get_text(name) {
        Some(text) if text == words[0] => Ok(true),
        Some(text) if text == words[1] => Ok(false),
        _ => {
            let message = say("upload-one-of").with("one", words[0]).with("other", words[1]);
            Err(PageError::invalid_field(name, message))
        }
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
        _ => return Err(PageError::invalid_field("missing", say("upload-missing-values"))),
    };
    let wanted = DERIVED
        .into_iter()
        .filter(|(name, _)| fields.get_text(&format!("derive_{name}")).is_some());
    manifest.declarations.derive = wanted.map(|(_, one)| one).collect();
    Ok(())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use sistership_model::manifest::ManifestTrial;
    use sistership_trials::{Exclusion, RowRanges, propose_manifest};

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
            template: None,
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
        let corrected = correct_proposal(&of, &fields(&form)).unwrap();
        assert_eq!(corrected.guesses[1].why, GIVEN);
        assert!(corrected.changed_channels(&of).contains("psi"));
        let manifest = corrected.manifest;
        let psi = &manifest.manifest.columns["psi"];
        assert_eq!((psi.column.as_str(), psi.unit.as_str()), ("strange", "deg"));
        assert_eq!(manifest.declarations.ignore, ["other"]);
        assert_eq!(manifest.manifest.conventions.rudder_positive, RudderSign::PortTurn);
        assert_eq!(manifest.manifest.trials[0].depth_m, Some(12.5));
        assert_eq!(manifest.declarations.derive.len(), 1);
    }

    #[test]
    fn exclusions_that_are_not_ticked_are_restored() {
        let (_folder, mut of) = proposed("t_s,psi_deg\n0,1\n1,2\n");
        let exclusion = |channel: &str| Exclusion {
            file: "log.csv".into(),
            channel: Some(channel.into()),
            rows: Some(RowRanges::from_rows([2])),
            from: None,
            to: None,
            why: "spikes".into(),
        };
        of.manifest.declarations.exclude = vec![exclusion("psi"), exclusion("r")];
        let corrected = correct_proposal(&of, &fields(&[("excluded.1", "on")])).unwrap();
        assert_eq!(corrected.manifest.declarations.exclude, [exclusion("r")]);
    }

    #[test]
    fn files_with_other_columns_are_corrected_on_their_own() {
        let (_folder, mut of) = proposed("t_s,psi_deg\n0,1\n1,2\n");
        let first = of.manifest.manifest.trials[0].clone();
        let columns = IndexMap::from([("u".to_owned(), ColumnMapping::new("v_log", "kn"))]);
        for file in ["b.csv", "c.csv"] {
            let other =
                ManifestTrial { file: file.into(), columns: columns.clone(), ..first.clone() };
            of.manifest.manifest.trials.push(other);
            of.manifest.sensors.push(Vec::new());
        }
        of.guesses.push(ColumnGuess {
            file: "b.csv".into(),
            column: "v_log".into(),
            ..of.guesses[0].clone()
        });
        let form = [("channel.0", "t"), ("unit.0", "s"), ("channel.2", "v"), ("unit.2", "m/s")];
        let corrected = correct_proposal(&of, &fields(&form)).unwrap().manifest.manifest;
        assert_eq!(corrected.columns.keys().collect::<Vec<_>>(), ["t"]);
        let own = |at: usize| corrected.trials[at].columns["v"].clone();
        assert_eq!((own(1), own(2)), (ColumnMapping::new("v_log", "m/s"), own(1)));
    }

    #[test]
    fn a_wrong_field_is_named() {
        let (_folder, of) = proposed("t_s,psi_deg\n0,1\n1,2\n");
        let wrong =
            |form: &[(&str, &str)]| correct_proposal(&of, &fields(form)).unwrap_err().to_string();
        let twice = [("channel.0", "t"), ("unit.0", "s"), ("channel.1", "t"), ("unit.1", "s")];
        assert!(wrong(&twice).starts_with("channel.1: "));
        assert!(wrong(&[("channel.0", "t")]).starts_with("unit.0: "));
        assert!(wrong(&[("channel.0", "<b>"), ("unit.0", "s")]).contains("is not a channel"));
        assert!(wrong(&[("depth.0", "-1")]).starts_with("depth.0: "));
    }
}
