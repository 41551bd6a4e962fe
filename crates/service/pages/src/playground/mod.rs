//! The playground: a manoeuvre of a model, given in a form and simulated by the server.

mod orders;
mod sailed;

use askama::Template;
use sistership_jobs::Archive;
use sistership_jobs::surroundings::steady;
use sistership_model::effect::AppliedEffect;
use sistership_report::plots::Hull;
use sistership_simulation::Ship;

use self::orders::{Orders, Surroundings};
use self::sailed::{Figures, sailed};
use crate::error::{PageError, Result};
use crate::form::Fields;
use crate::named::NamedVersion;
use crate::picture::svg;
use crate::plot::{LINES, Track, channels, ground};
use crate::shell::Shell;

/// Inputs of the page.
pub struct Gathered {
    shell: Shell,
    fields: Fields,
    version: Option<NamedVersion>,
    wrong: Option<String>,
}

#[derive(Template)]
#[template(path = "playground.html")]
struct PlaygroundPage<'a> {
    shell: &'a Shell,
    model: &'a str,
    wrong: Option<String>,
    orders: Orders,
    around: Surroundings,
    label: Option<String>,
    deep: bool,
    speed_hint: String,
    track: Option<String>,
    series: Option<String>,
    figures: Figures,
    notes: Vec<String>,
}

impl PlaygroundPage<'_> {
    /// Returns true if the manoeuvre has this name.
    fn is_kind(&self, name: &str) -> bool {
        self.orders.kind.name() == name
    }
}

/// Plots and figures of a simulation.
struct Drawn {
    track: Option<String>,
    series: Option<String>,
    figures: Figures,
    notes: Vec<String>,
    deep: bool,
    speed_hint: String,
}

/// Reads the version that the form names.
///
/// # Errors
/// Returns an error if the store fails. An unknown name is reported on the page.
pub async fn gather(archive: &Archive, shell: Shell, fields: Fields) -> Result<Gathered> {
    let (mut version, mut wrong) = (None, None);
    if let Some(name) = fields.text("model") {
        match NamedVersion::find(archive, "model", name).await {
            Ok(found) => version = Some(found),
            Err(PageError::Invalid { message, .. }) => wrong = Some(message),
            Err(other) => return Err(other),
        }
    }
    Ok(Gathered { shell: shell.at("/playground"), fields, version, wrong })
}

impl Gathered {
    /// Returns the page, for which the manoeuvre of the form is simulated in at most `most` steps.
    ///
    /// # Errors
    /// Returns an error if the page cannot be rendered.
    pub fn html(&self, most: usize) -> Result<String> {
        let mut wrong = self.wrong.clone();
        // The page shows the first error only, and the form with the default values of the parts
        // that are wrong.
        let mut refused = |error: PageError| wrong = wrong.take().or(Some(error.to_string()));
        let orders = Orders::read(&self.fields).unwrap_or_else(|error| {
            refused(error);
            Orders::default()
        });
        let around = Surroundings::read(&self.fields).unwrap_or_else(|error| {
            refused(error);
            Surroundings::default()
        });
        let drawn = match (&self.version, wrong.is_none()) {
            (Some(version), true) => match drawn(version, &orders, &around, most) {
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
        let empty = Drawn {
            track: None,
            series: None,
            figures: Vec::new(),
            notes: Vec::new(),
            deep: false,
            speed_hint: String::new(),
        };
        let Drawn { track, series, figures, notes, deep, speed_hint } = drawn.unwrap_or(empty);
        let page = PlaygroundPage {
            shell: &self.shell,
            model: self.fields.text("model").unwrap_or_default(),
            wrong,
            orders,
            around,
            label,
            deep,
            speed_hint,
            track,
            series,
            figures,
            notes,
        };
        Ok(page.render()?)
    }
}

fn drawn(
    version: &NamedVersion,
    orders: &Orders,
    around: &Surroundings,
    most: usize,
) -> Result<Drawn> {
    let mut model = version.document.model.clone();
    // Current and wind are effects, as in a diagnosed model.
    model.effects.extend(around.effects()?);
    let mut ship = Ship::new(&model, &version.law)
        .map_err(|error| PageError::invalid("model", error.to_string()))?;
    // The depth is an input of some laws only.
    let knows_depth = ship.law_inputs().any(|(name, _)| name == "depth");
    let mut notes = Vec::new();
    match (around.depth_m, knows_depth) {
        (Some(depth), true) => ship.set_depth(depth),
        (Some(_), false) => notes.push(format!(
            "The law {} does not know the water depth: it is sailed in deep water.",
            version.law.name
        )),
        (None, _) => {}
    }
    let speed = ship.approach_speed_m_s();
    let run = sailed(&mut ship, orders, most)?;
    notes.extend(run.notes);
    let track = Track::simulated(LINES[0], version.label(), &run.track, ship.has_roll());
    let tracks = [track];
    let hull = Hull::of(&model.particulars);
    Ok(Drawn {
        track: ground(&tracks, hull, "Track").as_ref().map(svg).transpose()?,
        series: Some(svg(&channels(&tracks, "Motion over time"))?),
        figures: run.figures,
        notes,
        deep: !knows_depth,
        speed_hint: format!("{speed:.2}"),
    })
}

impl Surroundings {
    /// Returns current and wind as effects of the library.
    fn effects(&self) -> Result<Vec<AppliedEffect>> {
        let named = [("current", self.current()), ("wind", self.wind())];
        let some = named.into_iter().filter_map(|(name, of)| Some((name, of?)));
        some.map(|(name, (north, east))| {
            let missing = || PageError::invalid(name, "the library has no constant form of it");
            steady(name, [north, east], "playground").ok_or_else(missing)
        })
        .collect()
    }
}
