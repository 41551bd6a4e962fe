//! The acceptance summary of a version, one page to print: ship, loading, conditions of its trials,
//! verdict on the standards of IMO, model, and the people who made, checked and approved it.

use askama::Template;
use serde_json::Value;
use sistership_jobs::Archive;
use sistership_jobs::archive::parse_vessel;
use sistership_model::Vessel;
use sistership_store::{SignOff, StoreError};

use super::figures::CriterionRow;
use super::{ManoeuvreCache, VersionPageInputs, gather_inputs, speed_words};
use crate::conditions::{CONDITIONS, stated_text};
use crate::date::{format_date, format_stored_day};
use crate::error::Result;
use crate::language::{Message, say};
use crate::numbers::{format_fixed, format_significant, format_stated};
use crate::shell::PageShell;
use crate::terms::{imo_words, particular_words};

/// Conditions that are among the facts of the ship, as its loading.
const LOADING: [&str; 3] = ["draught_fore_m", "draught_aft_m", "displacement"];

/// Inputs of the page.
pub struct SummaryInputs {
    of: VersionPageInputs,
    title: String,
    vessel: Vessel,
    /// Statements about the trials of the version.
    stated: Vec<Value>,
    signed: Vec<SignOff>,
}

#[derive(Template)]
#[template(path = "acceptance.html")]
struct SummaryPage<'a> {
    of: &'a VersionPageInputs,
    shell: &'a PageShell,
    title: &'a str,
    verdict: String,
    verdict_class: &'static str,
    criteria: Vec<SummaryCriterion<'a>>,
    ship_facts: Vec<SummaryFact>,
    trial_facts: Vec<SummaryFact>,
    error: Option<String>,
    signatures: [Signature; 3],
    missing: bool,
}

/// Criterion with its value in metres where it is a length.
struct SummaryCriterion<'a> {
    row: &'a CriterionRow,
    metres: Option<String>,
}

/// Fact of the summary: name, and value if it is known.
struct SummaryFact {
    name: String,
    value: Option<String>,
    /// Address of the form in which it is stated.
    form: String,
}

/// Signature: role, and name and date if somebody has signed.
struct Signature {
    role: Message,
    person: String,
    date: String,
}

/// Reads the inputs of the page.
///
/// # Errors
/// Returns an error if there is no such version or the store fails.
pub async fn gather_summary(
    archive: &Archive,
    shell: PageShell,
    ship: &str,
    number: i64,
) -> Result<SummaryInputs> {
    let store = &archive.store;
    let of = gather_inputs(archive, shell, ship, number).await?;
    let row = store.ships().get(ship).await?;
    let mut stated = Vec::new();
    // By hash: a recipe names the bytes that were fitted, whatever the trial is called now.
    for trial in of.document.recipe.trials() {
        match store.trials().find_by_hash(ship, &trial.sha256).await {
            Ok(found) => stated.extend(store.trials().stated_conditions(&found.id).await?),
            // A trial that was deleted since, or of a sister ship.
            Err(StoreError::NotFound { .. }) => {}
            Err(other) => return Err(other.into()),
        }
    }
    Ok(SummaryInputs {
        vessel: parse_vessel(&row.name, &row.document)?,
        title: row.title,
        signed: store.versions().list_sign_offs(ship, number).await?,
        stated,
        of,
    })
}

impl SummaryInputs {
    /// Returns the page; the standard manoeuvres are simulated for it unless they are in the cache.
    ///
    /// # Errors
    /// Returns an error if the page cannot be rendered.
    pub fn render_html(&self, known: &ManoeuvreCache) -> Result<String> {
        let of = &self.of;
        let sailed = known.get_or_simulate(&of.version.head.id, &of.document, &of.law)?;
        let (verdict, verdict_class) = imo_words(&sailed.verdicts());
        let lpp_m = self.vessel.particular("lpp_m");
        let (ship_facts, trial_facts) = (self.ship_facts(), self.trial_facts());
        let page = SummaryPage {
            of,
            shell: &of.shell,
            title: &self.title,
            verdict,
            verdict_class,
            criteria: sailed.criteria.iter().map(|row| SummaryCriterion::new(row, lpp_m)).collect(),
            missing: ship_facts.iter().chain(&trial_facts).any(|fact| fact.value.is_none()),
            ship_facts,
            trial_facts,
            error: held_out_error(&of.document.report),
            signatures: self.signatures(),
        };
        Ok(page.render()?)
    }

    /// Ship and loading; what is stated for the trials counts more than the particulars.
    fn ship_facts(&self) -> Vec<SummaryFact> {
        let known = |name: &str| self.vessel.particular(name);
        let metres = |name: &str| known(name).map(|value| format!("{} m", format_stated(value, 5)));
        let volume = known("displacement_m3");
        let volume = volume.map(|volume| format!("{} m³", format_stated(volume, 6)));
        let speed = self.of.document.model.speed_m_s.map(speed_words);
        let form = format!("/ships/{}/particulars", self.of.version.head.model);
        let fact = |name: String, value| SummaryFact { name, value, form: form.clone() };
        vec![
            fact(particular_words("lpp_m").0, metres("lpp_m")),
            fact(particular_words("beam_m").0, metres("beam_m")),
            fact(
                say("acceptance-draught").into(),
                self.stated_draught().or_else(|| metres("draught_m")),
            ),
            fact(say("acceptance-trim").into(), self.trim_text()),
            fact(
                say("acceptance-displacement").into(),
                self.stated_words("displacement").or(volume),
            ),
            fact(say("acceptance-speed").into(), speed),
            fact(say("acceptance-revolutions").into(), self.engine_words()),
        ]
    }

    /// Revolutions on the approach, and what a turn takes of them.
    fn engine_words(&self) -> Option<String> {
        let model = &self.of.document.model;
        let revolutions = format_fixed(60.0 * model.revolutions_rps?, 1);
        let lost = model.revolutions_loss.map(|loss| format_fixed(50.0 * loss, 0));
        let message = match lost {
            None => say("acceptance-engine-held"),
            Some(lost) => say("acceptance-engine-loses").with("lost", lost),
        };
        Some(message.with("revolutions", revolutions).to_string())
    }

    /// Conditions of the trials; remarks only where there are any.
    fn trial_facts(&self) -> Vec<SummaryFact> {
        let head = &self.of.version.head;
        let form = format!("/ships/{}/conditions?version={}", head.model, head.number);
        CONDITIONS
            .iter()
            .filter(|field| !LOADING.contains(&field.name))
            .map(|field| (field, self.stated_words(field.name)))
            .filter(|(field, value)| field.name != "remarks" || value.is_some())
            .map(|(field, value)| SummaryFact { name: field.label(), value, form: form.clone() })
            .collect()
    }

    /// Different texts that are stated for the trials, in their order.
    fn stated_words(&self, name: &str) -> Option<String> {
        // Trials of one day usually share their conditions, which are then printed once.
        let mut all: Vec<&str> = Vec::new();
        for stated in &self.stated {
            let text = stated_text(Some(stated), name);
            if !text.is_empty() && !all.contains(&text) {
                all.push(text);
            }
        }
        let shown = |text: &&str| match name {
            "date" => format_stored_day(text),
            _ => (*text).to_owned(),
        };
        (!all.is_empty()).then(|| all.iter().map(shown).collect::<Vec<_>>().join("; "))
    }

    /// Draughts fore and aft as they are stated for the first trial that has both, m.
    fn stated_draughts(&self) -> Option<(f64, f64)> {
        let number = |stated: &Value, name: &str| {
            stated_text(Some(stated), name).replace(',', ".").parse::<f64>().ok()
        };
        self.stated.iter().find_map(|stated| {
            number(stated, "draught_fore_m").zip(number(stated, "draught_aft_m"))
        })
    }

    fn stated_draught(&self) -> Option<String> {
        let (fore, aft) = self.stated_draughts()?;
        let text = say("acceptance-draughts").with("fore", format_stated(fore, 5));
        Some(text.with("aft", format_stated(aft, 5)).into())
    }

    fn trim_text(&self) -> Option<String> {
        let known = |name: &str| self.vessel.particular(name);
        // Draughts of the ship are those of a usual loading: those of the trials count first.
        let own = || known("draught_fore_m").zip(known("draught_aft_m"));
        let (fore, aft) = self.stated_draughts().or_else(own)?;
        let text =
            if aft < fore { say("acceptance-trim-bow") } else { say("acceptance-trim-stern") };
        Some(text.with("trim", format_fixed((aft - fore).abs(), 2)).into())
    }

    fn signatures(&self) -> [Signature; 3] {
        let head = &self.of.version.head;
        let by = |role, name: &str| {
            let signed = self.signed.iter().find(|one| one.role == name);
            let (person, date) = signed
                .map_or_else(Default::default, |one| (one.person.clone(), format_date(one.at_us)));
            Signature { role, person, date }
        };
        let (person, date) = (head.author.clone(), format_date(head.created_us));
        [
            Signature { role: say("acceptance-made"), person, date },
            by(say("acceptance-checked"), "checked"),
            by(say("acceptance-approved"), "approved"),
        ]
    }
}

impl<'a> SummaryCriterion<'a> {
    fn new(row: &'a CriterionRow, lpp_m: Option<f64>) -> Self {
        // Criteria are in ship lengths, people measure in metres.
        let metres = row.number.zip(lpp_m).filter(|_| row.unit == "L");
        let metres = metres
            .map(|(value, length)| format!("{} m", format_stated((value * length).round(), 5)));
        Self { row, metres }
    }
}

/// Error of the selected option on held-out manoeuvres.
fn held_out_error(report: &Value) -> Option<String> {
    let options = report["options"].as_array()?;
    let chosen = options.iter().find(|option| option["chosen"] == true)?;
    Some(format_significant(chosen["error"].as_f64()?, 2))
}
