//! The playground: a manoeuvre of a model, given in a form and simulated by the server.

mod orders;
mod simulation;

use askama::Template;
use sistership_jobs::Archive;
use sistership_jobs::environment::steady_effect;
use sistership_model::effect::AppliedEffect;
use sistership_report::plots::{HullOutline, LiveChart};
use sistership_simulation::Ship;

use self::orders::{ManoeuvreOrders, Surroundings};
use self::simulation::{FigureList, simulate_orders};
use crate::error::{PageError, Result};
use crate::form::FormFields;
use crate::language::say;
use crate::named::NamedVersion;
use crate::numbers::format_fixed;
use crate::pickers;
use crate::plot::{LINES, PlotTrack, track_chart};
use crate::shell::PageShell;

/// Inputs of the page.
pub struct PlaygroundInputs {
    shell: PageShell,
    fields: FormFields,
    /// Model that is simulated: that of the form, or one to begin with.
    asked: String,
    known: Vec<String>,
    version: Option<NamedVersion>,
    wrong: Option<String>,
}

#[derive(Template)]
#[template(path = "playground.html")]
struct PlaygroundPage<'a> {
    shell: &'a PageShell,
    model: &'a str,
    known: &'a [String],
    wrong: Option<String>,
    orders: ManoeuvreOrders,
    around: Surroundings,
    label: Option<String>,
    deep: bool,
    speed_hint: String,
    chart: Option<LiveChart>,
    figures: FigureList,
    notes: Vec<String>,
}

impl PlaygroundPage<'_> {
    /// Returns true if the manoeuvre has this name.
    fn is_kind(&self, name: &str) -> bool {
        self.orders.kind.name() == name
    }
}

/// Plots and figures of a simulation.
struct PlaygroundResult {
    chart: Option<LiveChart>,
    figures: FigureList,
    notes: Vec<String>,
    deep: bool,
    speed_hint: String,
}

/// Reads the version that the form names.
///
/// # Errors
/// Returns an error if the store fails. An unknown name is reported on the page.
pub async fn gather_inputs(
    archive: &Archive,
    shell: PageShell,
    fields: FormFields,
) -> Result<PlaygroundInputs> {
    let (mut version, mut wrong) = (None, None);
    let asked = match fields.get_text("model") {
        Some(name) => name.to_owned(),
        None => pickers::first_model(archive).await?,
    };
    match NamedVersion::find(archive, "model", &asked).await {
        Ok(found) => version = Some(found),
        Err(PageError::Invalid { message, .. }) => wrong = Some(message),
        Err(other) => return Err(other),
    }
    let known = pickers::model_names(archive).await?;
    let shell = shell.at_place("/playground");
    Ok(PlaygroundInputs { shell, fields, asked, known, version, wrong })
}

impl PlaygroundInputs {
    /// Returns the page, for which the manoeuvre of the form is simulated in at most `most` steps.
    ///
    /// # Errors
    /// Returns an error if the page cannot be rendered.
    pub fn render_html(&self, most: usize) -> Result<String> {
        let mut wrong = self.wrong.clone();
        // The page shows the first error only, and the form with the default values of the parts
        // that are wrong.
        let mut refused = |error: PageError| wrong = wrong.take().or(Some(error.to_string()));
        let orders = ManoeuvreOrders::from_fields(&self.fields).unwrap_or_else(|error| {
            refused(error);
            ManoeuvreOrders::default()
        });
        let around = Surroundings::from_fields(&self.fields).unwrap_or_else(|error| {
            refused(error);
            Surroundings::default()
        });
        let drawn = match (&self.version, wrong.is_none()) {
            (Some(version), true) => match run_playground(version, &orders, &around, most) {
                Ok(drawn) => Some(drawn),
                Err(PageError::Invalid { field, message }) => {
                    wrong = Some(format!("{field}: {message}"));
                    None
                }
                Err(other) => return Err(other),
            },
            _ => None,
        };
        let label = self.version.as_ref().map(NamedVersion::label);
        let empty = PlaygroundResult {
            chart: None,
            figures: Vec::new(),
            notes: Vec::new(),
            deep: false,
            speed_hint: String::new(),
        };
        let PlaygroundResult { chart, figures, notes, deep, speed_hint } = drawn.unwrap_or(empty);
        let page = PlaygroundPage {
            shell: &self.shell,
            model: &self.asked,
            known: &self.known,
            wrong,
            orders,
            around,
            label,
            deep,
            speed_hint,
            chart,
            figures,
            notes,
        };
        Ok(page.render()?)
    }
}

fn run_playground(
    version: &NamedVersion,
    orders: &ManoeuvreOrders,
    around: &Surroundings,
    most: usize,
) -> Result<PlaygroundResult> {
    let mut model = version.document.model.clone();
    // Current and wind are effects, as in a diagnosed model.
    model.effects.extend(around.steady_effects()?);
    let mut ship = Ship::new(&model, &version.law)
        .map_err(|error| PageError::invalid_field("model", error.to_string()))?;
    // The depth is an input of some laws only.
    let knows_depth = ship.law_inputs().any(|(name, _)| name == "depth");
    let mut notes = Vec::new();
    match (around.depth_m, knows_depth) {
        (Some(depth), true) => ship.set_depth(depth),
        (Some(_), false) => {
            notes.push(say("playground-no-depth").with("law", &version.law.name).into());
        }
        (None, _) => {}
    }
    let speed = ship.approach_speed_m_s();
    let run = simulate_orders(&mut ship, orders, most)?;
    notes.extend(run.notes);
    let track = PlotTrack::from_simulation(LINES[0], version.label(), &run.track, ship.has_roll());
    let tracks = [track];
    let hull = HullOutline::from_particulars(&model.particulars);
    Ok(PlaygroundResult {
        chart: Some(track_chart(&tracks, hull, &say("playground-chart").to_string())),
        figures: run.figures,
        notes,
        deep: !knows_depth,
        speed_hint: format_fixed(speed, 2),
    })
}

impl Surroundings {
    /// Returns current and wind as effects of the library.
    fn steady_effects(&self) -> Result<Vec<AppliedEffect>> {
        let named = [("current", self.current_vector()), ("wind", self.wind_vector())];
        let some = named.into_iter().filter_map(|(name, of)| Some((name, of?)));
        some.map(|(name, (north, east))| {
            let missing = || PageError::invalid_field(name, say("playground-no-form"));
            steady_effect(name, [north, east], "playground").ok_or_else(missing)
        })
        .collect()
    }
}
