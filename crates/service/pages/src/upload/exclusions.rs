//! Ranges of time that a person excludes or restores.

use sistership_trials::{Exclusion, RowRanges, TrialWithRows};

use super::proposed::UploadProposal;
use crate::error::{PageError, Result};
use crate::form::FormFields;
use crate::language::say;

/// Reason of an exclusion that the form gives, as manifests have it.
const BY_HAND: &str = "excluded on the upload page";

/// A range of time of a trial, and what is to be done with it.
#[derive(Debug, Clone, PartialEq)]
pub struct RangeRequest {
    /// Index of the trial.
    pub trial: usize,
    channel: Option<String>,
    from_s: f64,
    to_s: f64,
    excludes: bool,
}

impl RangeRequest {
    /// Reads the range of a form whose button is `exclude` or `restore`; `None` for other buttons.
    ///
    /// # Errors
    /// Returns an error that names the field that is missing or wrong.
    pub fn from_form(of: &UploadProposal, fields: &FormFields) -> Result<Option<Self>> {
        let excludes = match fields.get_text("do") {
            Some("exclude") => true,
            Some("restore") => false,
            _ => return Ok(None),
        };
        let time = |name: &str| {
            let missing = || PageError::invalid_field(name, say("upload-time-empty"));
            fields.optional_number(name)?.ok_or_else(missing)
        };
        let trial = usize::try_from(fields.whole_number("range_trial")?).ok();
        // The index is from a form, which may be older than the proposal.
        let trial = trial.filter(|at| *at < of.manifest.manifest.trials.len());
        let trial = trial
            .ok_or_else(|| PageError::invalid_field("range_trial", say("upload-not-a-file")))?;
        let channel = fields.get_text("range_channel").map(str::to_owned);
        if let Some(name) = channel.as_deref().filter(|name| !of.channel_names().contains(name)) {
            let message = say("upload-not-read").with("channel", name);
            return Err(PageError::invalid_field("range_channel", message));
        }
        let (from_s, to_s) = (time("range_from")?, time("range_to")?);
        Ok(Some(Self { trial, channel, from_s, to_s, excludes }))
    }

    /// Excludes or restores the range.
    ///
    /// # Errors
    /// Returns an error if the range has no row, or nothing is excluded in it.
    pub fn apply(&self, of: &mut UploadProposal, trial: &TrialWithRows) -> Result<()> {
        let rows = trial
            .rows_between(self.from_s, self.to_s)
            .ok_or_else(|| PageError::invalid_field("range_to", say("upload-no-rows")))?;
        let file = of.manifest.manifest.trials[self.trial].file.clone();
        let exclude = &mut of.manifest.declarations.exclude;
        if self.excludes {
            // The rows after the last one of the file are none of it.
            let last = trial.rows.last().copied().unwrap_or_default();
            let rows = *rows.start()..=(*rows.end()).min(last);
            exclude.push(Exclusion {
                file,
                channel: self.channel.clone(),
                rows: Some(RowRanges(vec![rows])),
                from: None,
                to: None,
                why: BY_HAND.into(),
            });
            return Ok(());
        }
        // Whether anything changed distinguishes a restored range from one that excluded nothing.
        let before = exclude.clone();
        let is_meant = |one: &Exclusion| {
            one.file == file && (self.channel.is_none() || one.channel == self.channel)
        };
        exclude.retain_mut(|one| !is_meant(one) || one.restore_rows(&rows));
        match *exclude == before {
            true => Err(PageError::invalid_field("range_from", say("upload-nothing-excluded"))),
            false => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use sistership_model::trial::Trial;
    use sistership_trials::propose_manifest;

    fn proposed() -> (UploadProposal, TrialWithRows) {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("log.csv");
        std::fs::write(&path, "t_s,psi_deg\n0,50\n1,50.7\n2,51.4\n3,52.1\n").unwrap();
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
        let trial = Trial { t_s: vec![0.0, 1.0, 2.0, 3.0], ..Trial::default() };
        (of, TrialWithRows { trial, rows: vec![2, 3, 4, 5] })
    }

    fn applied(of: &mut UploadProposal, trial: &TrialWithRows, form: [&str; 4]) -> Result<()> {
        let names = ["do", "range_channel", "range_from", "range_to"];
        let pairs = names.iter().zip(form).chain([(&"range_trial", "0")]);
        let pairs = pairs.map(|(name, text)| ((*name).to_owned(), text.to_owned()));
        let fields = FormFields::from(pairs.collect::<Vec<_>>());
        let request = RangeRequest::from_form(of, &fields)?;
        request.unwrap().apply(of, trial)
    }

    #[test]
    fn a_range_is_excluded_and_a_part_of_it_restored() {
        let (mut of, trial) = proposed();
        applied(&mut of, &trial, ["exclude", "psi", "1", "9"]).unwrap();
        let rows = |of: &UploadProposal| -> Vec<String> {
            let all = of.manifest.declarations.exclude.iter();
            all.map(|one| one.rows.clone().unwrap().to_string()).collect()
        };
        assert_eq!(rows(&of), ["3-5"]);
        applied(&mut of, &trial, ["restore", "", "1.5", "2.5"]).unwrap();
        assert_eq!(rows(&of), ["3, 5"]);
        applied(&mut of, &trial, ["restore", "psi", "0", "9"]).unwrap();
        assert!(rows(&of).is_empty());
    }

    #[test]
    fn a_wrong_range_is_named() {
        let (mut of, trial) = proposed();
        let mut wrong = |form| applied(&mut of, &trial, form).unwrap_err().to_string();
        assert!(wrong(["exclude", "psi", "2", "1"]).starts_with("range_to: "));
        assert!(wrong(["exclude", "psi", "", "1"]).starts_with("range_from: "));
        assert!(wrong(["exclude", "roll", "0", "1"]).starts_with("range_channel: "));
        assert!(wrong(["restore", "psi", "0", "1"]).contains("nothing is excluded"));
    }
}
