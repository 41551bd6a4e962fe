//! Fields of the form for each trial: manoeuvre, depth, revolutions and current.

use sistership_trials::{ManifestFile, TrialCurrent};

use super::proposed::GIVEN;
use crate::error::{PageError, Result};
use crate::form::FormFields;
use crate::language::say;

/// Metres per second in a knot.
const KNOT_M_S: f64 = 1852.0 / 3600.0;
/// Fastest current, kn.
const FASTEST_CURRENT_KN: f64 = 20.0;

/// A trial as the form shows it: texts of its fields.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(super) struct TrialFields {
    pub file: String,
    pub manoeuvre: String,
    /// Depth, m.
    pub depth: String,
    /// Revolutions held throughout, rpm.
    pub revolutions: String,
    /// Speed of the current, kn.
    pub current: String,
    /// Direction to which it flows, deg.
    pub towards: String,
}

/// Returns the fields of the trials of a manifest.
pub(super) fn trial_fields(manifest: &ManifestFile) -> Vec<TrialFields> {
    let number = |value: Option<f64>| value.map_or_else(String::new, |value| value.to_string());
    let currents = &manifest.declarations.currents;
    let fields = manifest.manifest.trials.iter().map(|trial| {
        let label = trial.trial_label();
        let current = currents.iter().find(|current| current.trial == label);
        let (current, towards) = current.map_or_else(Default::default, current_texts);
        TrialFields {
            file: trial.file.clone(),
            manoeuvre: trial.manoeuvre.clone().unwrap_or_default(),
            depth: number(trial.depth_m),
            // Rounded to what a tachometer shows.
            revolutions: number(trial.n_rps.map(|n_rps| (600.0 * n_rps).round() / 10.0)),
            current,
            towards,
        }
    });
    fields.collect()
}

/// Speed, kn, and direction, deg, of a current as texts.
fn current_texts(current: &TrialCurrent) -> (String, String) {
    let (north, east) = (current.north_m_s, current.east_m_s);
    let towards = east.atan2(north).to_degrees().rem_euclid(360.0);
    (format!("{:.2}", north.hypot(east) / KNOT_M_S), format!("{towards:.0}"))
}

/// Applies the fields of the form to the trials of a manifest.
///
/// # Errors
/// Returns an error that names a field which is no number or outside its range.
pub(super) fn apply_trial_fields(manifest: &mut ManifestFile, fields: &FormFields) -> Result<()> {
    let before = trial_fields(manifest);
    let mut currents = Vec::new();
    for (place, trial) in manifest.manifest.trials.iter_mut().enumerate() {
        trial.manoeuvre = fields.get_text(&format!("manoeuvre.{place}")).map(str::to_owned);
        trial.depth_m =
            positive_number(fields, &format!("depth.{place}"), "upload-positive-depth")?;
        let name = format!("revolutions.{place}");
        let rpm = positive_number(fields, &name, "upload-positive-revolutions")?;
        // What was only shown rounded stays as it was.
        if fields.get_text(&name).unwrap_or_default() != before[place].revolutions {
            trial.n_rps = rpm.map(|rpm| rpm / 60.0);
        }
        let (current, towards) = (format!("current.{place}"), format!("towards.{place}"));
        let texts = [&current, &towards].map(|name| fields.get_text(name).unwrap_or_default());
        let label = trial.trial_label();
        if texts == [before[place].current.as_str(), before[place].towards.as_str()] {
            let kept = manifest.declarations.currents.iter().find(|one| one.trial == label);
            currents.extend(kept.cloned());
        } else {
            currents.extend(read_current(fields, (&current, &towards), label)?);
        }
    }
    manifest.declarations.currents = currents;
    Ok(())
}

fn positive_number(fields: &FormFields, name: &str, wrong: &'static str) -> Result<Option<f64>> {
    match fields.optional_number(name)? {
        Some(value) if value <= 0.0 => Err(PageError::invalid_field(name, say(wrong))),
        value => Ok(value),
    }
}

/// Reads the current of a trial; `None` if its speed is empty or 0.
fn read_current(
    fields: &FormFields,
    (current, towards): (&str, &str),
    trial: String,
) -> Result<Option<TrialCurrent>> {
    let speed_m_s = KNOT_M_S * fields.number_within(current, (0.0, FASTEST_CURRENT_KN), 0.0)?;
    if speed_m_s == 0.0 {
        return Ok(None);
    }
    // A current needs its direction.
    fields.required_text(towards)?;
    let (east, north) = fields.number_within(towards, (0.0, 360.0), 0.0)?.to_radians().sin_cos();
    let why = GIVEN.to_owned();
    Ok(Some(TrialCurrent { trial, north_m_s: speed_m_s * north, east_m_s: speed_m_s * east, why }))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use sistership_model::manifest::{Manifest, ManifestTrial, TrialConventions, TrialsKind};

    use super::*;

    fn manifest() -> ManifestFile {
        let mut trial = ManifestTrial::from_file_name("a.csv");
        trial.n_rps = Some(1.666);
        let mut manifest: ManifestFile = Manifest {
            kind: TrialsKind::Trials,
            ship: "kcs".into(),
            conventions: TrialConventions::default(),
            columns: Default::default(),
            trials: vec![trial],
        }
        .into();
        let (trial, why) = ("a.csv".to_owned(), "drift of a turn".to_owned());
        let current = TrialCurrent { trial, north_m_s: 0.3, east_m_s: 0.4, why };
        manifest.declarations.currents.push(current);
        manifest
    }

    fn apply(pairs: &[(&str, &str)]) -> Result<ManifestFile> {
        let (mut manifest, shown) = (manifest(), trial_fields(&manifest()).remove(0));
        let shown = [
            ("revolutions.0", shown.revolutions),
            ("current.0", shown.current),
            ("towards.0", shown.towards),
        ];
        // A later pair replaces the text that is shown.
        let changed = |name: &str| pairs.iter().any(|(other, _)| *other == name);
        let shown = shown.into_iter().filter(|(name, _)| !changed(name));
        let all = shown.map(|(name, text)| (name.to_owned(), text));
        let all = all.chain(pairs.iter().map(|(name, text)| ((*name).into(), (*text).into())));
        apply_trial_fields(&mut manifest, &FormFields::from(all.collect::<Vec<_>>()))?;
        Ok(manifest)
    }

    #[test]
    fn fields_that_are_left_as_shown_change_nothing() {
        assert_eq!(trial_fields(&manifest())[0].revolutions, "100");
        assert_eq!(apply(&[]).unwrap(), manifest());
    }

    #[test]
    fn a_current_and_revolutions_are_given_changed_and_removed() {
        let given =
            apply(&[("revolutions.0", "90"), ("current.0", "2"), ("towards.0", "90")]).unwrap();
        assert_eq!(given.manifest.trials[0].n_rps, Some(1.5));
        let current = &given.declarations.currents[0];
        assert!((current.east_m_s - 1.0289).abs() < 1e-4 && current.north_m_s.abs() < 1e-12);
        assert_eq!(current.why, GIVEN);
        let removed = apply(&[("revolutions.0", ""), ("current.0", "")]).unwrap();
        assert_eq!(removed.manifest.trials[0].n_rps, None);
        assert!(removed.declarations.currents.is_empty());
    }

    #[test]
    fn a_wrong_field_is_named() {
        for (pairs, name) in [
            (&[("depth.0", "-1")][..], "depth.0: "),
            (&[("revolutions.0", "0")], "revolutions.0: "),
            (&[("current.0", "1"), ("towards.0", "")], "towards.0: "),
            (&[("towards.0", "400")], "towards.0: "),
        ] {
            let message = apply(pairs).unwrap_err().to_string();
            assert!(message.starts_with(name), "{message}");
        }
    }
}
