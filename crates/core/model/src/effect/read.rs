//! Reading of an effect from its file.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::file::{ActsOn, EffectFile, FormFile, GrammarFile, PriorOddsFile};
use super::form::EffectForm;
use super::grammar::TermGrammar;
use crate::error::{ErrorContext, FileError};
use crate::name::check_slug;
use crate::source::Source;

/// Effect, read and checked.
#[derive(Debug, Clone, PartialEq)]
pub struct Effect {
    /// Name in the zoo.
    pub name: String,
    /// One line for readers.
    pub title: String,
    /// The part of the model on which it acts.
    pub acts_on: ActsOn,
    /// Publications of the effect.
    pub sources: BTreeMap<String, Source>,
    /// A remark.
    pub note: Option<String>,
    /// Prior odds of the effect, before any trial is considered.
    pub beforehand: Option<PriorOddsFile>,
    /// True if it differs from day to day: earlier trials of the ship do not inform on it.
    pub differs_by_day: bool,
    /// The forms in which it may appear; empty if terms are searched.
    pub forms: Vec<Arc<EffectForm>>,
    /// Grammar of the terms that are searched.
    pub grammar: Option<TermGrammar>,
}

impl Effect {
    /// Reads and checks an effect; `file` is its name in errors.
    ///
    /// # Errors
    /// Returns an error with file, line and field of the first fault: syntax, an unknown name, a
    /// unit, a symmetry.
    pub fn parse(file: &str, text: &str) -> Result<Self, FileError> {
        read_effect(file, text)
    }
}

fn read_effect(file: &str, text: &str) -> Result<Effect, FileError> {
    let blame = ErrorContext::new(file, text);
    let raw: EffectFile = blame.deserialize()?;
    check_slug(&raw.name).map_err(|e| blame.field_error("name", e))?;
    if raw.forms.is_empty() == raw.grammar.is_none() {
        return Err(blame.field_error("forms", "write either `forms` or a `grammar`"));
    }
    let at = |(field, message): (String, String)| blame.field_error(&field, message);
    raw.beforehand.as_ref().map_or(Ok(()), check_odds).map_err(at)?;
    Ok(Effect {
        forms: read_forms(raw.acts_on, &raw.forms).map_err(at)?,
        grammar: raw
            .grammar
            .as_ref()
            .map(|grammar| read_grammar(raw.acts_on, grammar))
            .transpose()
            .map_err(at)?,
        name: raw.name,
        title: raw.title,
        acts_on: raw.acts_on,
        sources: raw.sources,
        note: raw.note,
        beforehand: raw.beforehand,
        differs_by_day: raw.differs_by_day,
    })
}

fn check_odds(raw: &PriorOddsFile) -> Result<(), (String, String)> {
    let wrong = |odds: f64| !(odds > 0.0 && odds.is_finite());
    let refuse = |field: &str| Err((format!("beforehand.{field}"), "should be above 0".to_owned()));
    match raw.odds_where_recorded {
        _ if wrong(raw.odds) => refuse("odds"),
        Some(odds) if wrong(odds) => refuse("odds_where_recorded"),
        _ => Ok(()),
    }
}

fn check_misfit(form: &FormFile) -> Result<(), (String, String)> {
    match form.misfit {
        Some(share) if !(share > 0.0 && share <= 1.0) => {
            Err(("misfit".into(), "should be above 0 and at most 1".into()))
        }
        _ => Ok(()),
    }
}

fn read_forms(acts_on: ActsOn, raw: &[FormFile]) -> Result<Vec<Arc<EffectForm>>, (String, String)> {
    let one = |(index, form): (usize, &FormFile)| {
        let path = format!("forms.{}", form.name);
        check_slug(&form.name).map_err(|e| (path.clone(), e.to_string()))?;
        if raw[..index].iter().any(|earlier| earlier.name == form.name) {
            return Err((path, "is the name of two forms".into()));
        }
        // The form reports fields below itself; errors need the path from the root.
        let below = |(field, message): (String, String)| {
            let field = if field.is_empty() { path.clone() } else { format!("{path}.{field}") };
            (field, message)
        };
        check_misfit(form).map_err(below)?;
        EffectForm::from_file(acts_on, form).map(Arc::new).map_err(below)
    };
    raw.iter().enumerate().map(one).collect()
}

fn read_grammar(acts_on: ActsOn, raw: &GrammarFile) -> Result<TermGrammar, (String, String)> {
    if acts_on != ActsOn::Force {
        return Err(("acts_on".into(), "a grammar defines forces: write `force`".into()));
    }
    TermGrammar::from_file(raw).map_err(|(field, message)| (format!("grammar.{field}"), message))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    const DRAG: &str = "
kind: effect
name: drag
title: Drag by roll
acts_on: force
sources: { test: { citation: made for this test } }
forms:
  - name: only
    meaning: drag
    needs: [phi]
    parameters:
      share: { unit: '1', meaning: share, prior: { deviation: 0.1 }, bounds: [-1, 1], mirror: same }
    reports: { share_percent: share }
    values: { force: 0.5*water_density_kg_m3*lpp_m^2*u^2 }
    forces:
      X: -share*force*phi^2
";

    fn refused(from: &str, to: &str) -> String {
        assert!(DRAG.contains(from), "{from}");
        read_effect("drag.yaml", &DRAG.replace(from, to)).unwrap_err().to_string()
    }

    #[test]
    fn a_form_reads() {
        let effect = read_effect("drag.yaml", DRAG).unwrap_or_else(|e| panic!("{e}"));
        let form = &effect.forms[0];
        assert_eq!(form.reports["share_percent"].factor, 100.0);
        assert_eq!(
            (form.parameters["share"].start, form.parameters["share"].prior_mean),
            (0.0, 0.0)
        );
    }

    #[test]
    fn odds_and_misfit_are_above_nothing() {
        let odds = refused("forms:\n", "beforehand: { odds: 0, because: test }\nforms:\n");
        assert!(odds.starts_with("drag.yaml:7: beforehand.odds: "), "{odds}");
        let misfit = refused("needs: [phi]", "needs: [phi]\n    misfit: 1.5");
        assert!(misfit.contains("forms.only.misfit: "), "{misfit}");
    }

    #[test]
    fn refusals_name_file_line_and_field() {
        let unknown = refused("*phi^2", "*beta^2");
        assert!(
            unknown.starts_with("drag.yaml:16: forms.only.forces.X: ")
                && unknown.contains("`beta`"),
            "{unknown}"
        );
        let dimension = refused("force*phi^2", "force*lpp_m*phi^2");
        assert!(
            dimension.contains("drag.yaml:16") && dimension.contains("kg m^2 s^-2"),
            "{dimension}"
        );
        let symmetry = refused("phi^2", "phi");
        assert!(
            symmetry.contains("drag.yaml:16: forms.only.forces.X")
                && symmetry.contains("stay as it is"),
            "{symmetry}"
        );
        let needs = refused("needs: [phi]", "needs: [p]");
        assert!(needs.contains("drag.yaml:16: forms.only.forces.X: uses `phi`"), "{needs}");
        let absent = refused("-share*", "-(share + 0.1)*");
        assert!(
            absent.contains("forms.only.forces.X: does not vanish")
                && absent.contains("should be 0"),
            "{absent}"
        );
    }

    #[test]
    fn parameters_are_checked() {
        for (from, to, part) in [
            ("deviation: 0.1", "deviation: 0.0", "above zero"),
            ("[-1, 1]", "[1, -1]", "in order"),
            ("[-1, 1]", "[0.5, 1]", "absent, 0, is outside"),
            ("unit: '1'", "unit: deg", "SI"),
            ("      share: {", "      draught_m: {", "is already a state"),
            ("forces:\n      X", "measures:\n      u", "`measurement`"),
            ("share_percent: share", "share_deg_s: share", "s^-1"),
            ("share_percent: share", "share_percent: share*u", "unknown name `u`"),
            ("name: only", "name: Only one", "is not a valid name"),
        ] {
            let error = refused(from, to);
            assert!(error.contains(part), "{error}");
        }
    }

    #[test]
    fn forms_or_a_grammar() {
        let neither = &DRAG[..DRAG.find("forms:").unwrap()];
        assert!(read_effect("drag.yaml", neither).unwrap_err().message.contains("either"));
    }
}
