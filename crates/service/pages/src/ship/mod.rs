//! The page of a ship: particulars, health of its model, versions, trials, jobs, and actions.

mod drawing;
mod next_step;
mod versions;

use std::sync::Arc;

use askama::Template;
use sistership_jobs::Archive;
use sistership_jobs::aliases::CHAMPION;
use sistership_jobs::archive::parse_vessel;
use sistership_jobs::champions::most_similar_ships;
use sistership_jobs::condition::{Condition, SinceTrial, WeighedDiagnosis};
use sistership_jobs::search::urgency::UrgencyClass;
use sistership_model::particulars::Particulars;
use sistership_model::quantity::Quantity;
use sistership_model::{Vessel, Zoo};
use sistership_priors::similarity::RankedSource;
use sistership_store::{Alias, JobFilter, PageRequest, Ship, ShipNote};

use self::next_step::{NextStep, ShipSituation, StepAction};
use self::versions::{VersionRow, list_versions};
use crate::date::format_date;
use crate::error::Result;
use crate::language::{Message, say};
use crate::numbers::{format_significant, format_stated};
use crate::particulars::PARTICULARS;
use crate::picture::render_svg;
use crate::rows::{JobRow, TrialRow};
use crate::shell::PageShell;
use crate::terms::{condition_sentence, particular_words};

/// Knots in a metre per second.
const KNOTS: f64 = 3600.0 / 1852.0;
/// Number of lines of each list.
const LIST_LINES: i64 = 50;
/// Number of similar ships on the page.
pub const SIMILAR: usize = 5;

/// Inputs of the page.
pub struct ShipPageInputs {
    shell: PageShell,
    ship: Ship,
    vessel: Vessel,
    condition: Condition,
    aliases: Vec<Alias>,
    before: Option<i64>,
    versions: (Vec<VersionRow>, bool),
    trials: Vec<TrialRow>,
    more_trials: bool,
    jobs: Vec<JobRow>,
    tags: Vec<String>,
    notes: Vec<NoteRow>,
    families: Vec<String>,
    laws: Vec<String>,
}

#[derive(Template)]
#[template(path = "ship.html")]
struct ShipPage<'a> {
    of: &'a ShipPageInputs,
    shell: &'a PageShell,
    class: &'static str,
    since: Option<Message>,
    next: NextStep,
    evidence: Vec<EvidenceRow>,
    revision: Option<i64>,
    particulars: Vec<ParticularRow>,
    drawing: Option<String>,
    similar: Vec<SimilarRow>,
    compare: String,
    methods: [(&'static str, Message); 5],
    /// Condition of the ship in a sentence.
    sentence: String,
}

impl ShipPage<'_> {
    /// Returns true if a version is the champion, the version in use.
    fn is_champion(&self, number: &i64) -> bool {
        self.of.condition.version == Some(*number)
    }
}

/// A particular in words, with its name in documents.
struct ParticularRow {
    name: String,
    words: String,
    value: String,
    unit: &'static str,
    source: String,
}

impl ParticularRow {
    fn from_quantity(name: &str, of: &Quantity) -> Self {
        let (words, unit) = particular_words(name);
        let value = format_stated(of.value, 6);
        // Speeds of ships are read in knots.
        let value = match unit {
            "m/s" => format!("{value} ({} kn)", format_stated(of.value * KNOTS, 3)),
            _ => value,
        };
        Self { name: name.to_owned(), words, value, unit, source: of.source.clone() }
    }
}

/// A note: time, author and text.
struct NoteRow {
    made: String,
    actor: String,
    text: String,
}

impl NoteRow {
    fn from_note(note: ShipNote) -> Self {
        Self { made: format_date(note.at_us), actor: note.actor, text: note.text }
    }
}

/// A diagnosis that counts for the condition.
struct EvidenceRow {
    made: String,
    what: String,
    verdict: String,
    report: String,
}

impl EvidenceRow {
    fn from_diagnosis(diagnosis: &WeighedDiagnosis) -> Self {
        let trials = say("word-count-trials").with("count", diagnosis.trials.len());
        let what = match diagnosis.whole {
            true => say("ship-all-trials").with("trials", trials),
            false => trials,
        };
        let what = what.into();
        let (made, report) = (format_date(diagnosis.by.at_us), diagnosis.by.report.clone());
        Self { made, what, verdict: diagnosis.verdict.clone(), report }
    }
}

/// Formats the trial since which a condition holds.
fn since_text(since: &SinceTrial) -> Message {
    say("ship-since").with("trial", &since.name).with("at", format_date(since.at_us))
}

struct SimilarRow {
    ship: String,
    law: String,
    correlation: String,
    eligible: bool,
    reasons: Vec<String>,
}

/// Methods of a refinement: names in requests, and words.
fn methods() -> [(&'static str, Message); 5] {
    [
        ("", say("method-select")),
        ("weak", say("method-weak")),
        ("trajectory", say("method-trajectory")),
        ("published", say("method-published")),
        ("cma-es", say("method-cma-es")),
    ]
}

/// Reads the inputs of the page.
///
/// # Errors
/// Returns an error if there is no such ship or the store fails.
pub async fn gather_inputs(
    archive: &Archive,
    shell: PageShell,
    name: &str,
) -> Result<ShipPageInputs> {
    let store = &archive.store;
    let ship = store.ships().get(name).await?;
    // Only the first entries of each list are shown.
    let aliases = store.aliases().list(name, &PageRequest::first_page(LIST_LINES)).await?.items;
    let trials = store.trials().list(name, &PageRequest::first_page(LIST_LINES)).await?;
    let filter = JobFilter { ship: Some(name.to_owned()), state: None };
    let jobs = store.jobs().list(&filter, &PageRequest::first_page(10)).await?;
    let families =
        store.families().list_by_ship(name, &PageRequest::first_page(LIST_LINES)).await?;
    let laws = store.laws().list(&PageRequest::first_page(200)).await?;
    let notes = store.ships().list_notes(name, &PageRequest::first_page(10)).await?;
    Ok(ShipPageInputs {
        vessel: parse_vessel(&ship.name, &ship.document)?,
        condition: Condition::read_current(store, name).await?,
        before: previous_champion(archive, &aliases, name).await?,
        versions: list_versions(archive, name, &aliases).await?,
        more_trials: trials.next.is_some(),
        trials: trials.items.into_iter().map(TrialRow::from_trial).collect(),
        jobs: jobs.items.into_iter().map(JobRow::from_job).collect(),
        tags: store.ships().list_tags(name).await?,
        notes: notes.items.into_iter().map(NoteRow::from_note).collect(),
        families: families.items.into_iter().map(|family| family.name).collect(),
        laws: laws.items.into_iter().map(|law| law.name).collect(),
        aliases,
        ship,
        shell: shell.at_place("/"),
    })
}

/// Returns the version that was champion before the present one.
async fn previous_champion(
    archive: &Archive,
    aliases: &[Alias],
    ship: &str,
) -> Result<Option<i64>> {
    // Without champion the alias has no history.
    if !aliases.iter().any(|alias| alias.alias == CHAMPION) {
        return Ok(None);
    }
    // The latest move names the version before it.
    let history =
        archive.store.aliases().list_history(ship, CHAMPION, &PageRequest::first_page(1)).await?;
    Ok(history.items.first().and_then(|change| change.from_number))
}

impl ShipPageInputs {
    /// The ship, to which others are compared.
    pub fn vessel(&self) -> &Vessel {
        &self.vessel
    }

    /// Returns the ships of a zoo that are most similar, with their eligibility as source models.
    ///
    /// # Errors
    /// Returns an error if the store fails.
    pub async fn similar_ships(
        &self,
        archive: &Archive,
        zoo: Arc<Zoo>,
    ) -> Result<Vec<RankedSource>> {
        Ok(most_similar_ships(archive, zoo, self.vessel.clone(), SIMILAR).await?)
    }

    fn situation(&self) -> ShipSituation<'_> {
        ShipSituation {
            name: &self.ship.name,
            condition: &self.condition,
            jobs: &self.jobs,
            versions: &self.versions.0,
            has_trials: !self.trials.is_empty(),
        }
    }

    /// Returns the page, with the ships that are most similar.
    ///
    /// # Errors
    /// Returns an error if the page cannot be rendered.
    pub fn render_html(&self, similar: Vec<RankedSource>) -> Result<String> {
        let particulars = &self.vessel.particulars;
        let drawing = drawing::draw_ship(particulars, &self.ship.title);
        let champion = self.aliases.iter().find(|alias| alias.alias == CHAMPION);
        let page = ShipPage {
            of: self,
            shell: &self.shell,
            class: UrgencyClass::from_condition(&self.condition).name(),
            next: NextStep::for_ship(&self.situation()),
            since: self.condition.since.as_ref().map(since_text),
            evidence: self.condition.diagnoses.iter().map(EvidenceRow::from_diagnosis).collect(),
            revision: champion.map(|alias| alias.revision),
            particulars: ordered_particulars(particulars),
            drawing: drawing.as_ref().map(render_svg).transpose()?,
            similar: similar.into_iter().map(SimilarRow::from_ranked).collect(),
            compare: comparison_address(&self.ship.name, &self.versions.0),
            methods: methods(),
            sentence: condition_sentence(&self.condition),
        };
        Ok(page.render()?)
    }
}

/// Rows of particulars, in the order of forms; the others follow by name.
fn ordered_particulars(particulars: &Particulars) -> Vec<ParticularRow> {
    let mut all: Vec<(&String, &Quantity)> = particulars.iter().collect();
    let place = |name: &str| PARTICULARS.iter().position(|field| field.name == name);
    all.sort_by_key(|(name, _)| place(name).unwrap_or(PARTICULARS.len()));
    all.into_iter().map(|(name, of)| ParticularRow::from_quantity(name, of)).collect()
}

/// Returns the address of a comparison of the two newest versions.
fn comparison_address(ship: &str, versions: &[VersionRow]) -> String {
    let each = versions.iter().take(2).map(|version| format!("v={ship}/{}", version.number));
    format!("/compare?{}", each.collect::<Vec<_>>().join("&"))
}

impl SimilarRow {
    fn from_ranked(ranked: RankedSource) -> Self {
        let RankedSource { ship, law, correlation, eligible, reasons, .. } = ranked;
        let correlation =
            correlation.map_or_else(String::new, |value| format_significant(value, 4));
        Self { ship, law: law.unwrap_or_default(), correlation, eligible, reasons }
    }
}
