//! `docs/zoo.md` says what the zoo holds and what it is worth; `UPDATE_ZOO=1` rewrites it.

use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::path::PathBuf;

use sistership_assessment::validation::{
    CatalogueEntry, FigureComparison, ModelAppraisal, Severity, ValidationStatus, appraise_vessel,
    compare_published, limits, review_ship,
};
use sistership_model::vessel::Status;
use sistership_model::{Vessel, Zoo};
use sistership_priors::estimates::{LAW, RegressionLibrary, estimate_ship};
use sistership_simulation::Ship;
use sistership_simulation::manoeuvre::StandardManoeuvres;

#[test]
fn the_page_of_the_zoo_is_current() {
    let zoo = Zoo::load_embedded().unwrap_or_else(|error| panic!("{error}"));
    is_current("zoo.md", &page(&zoo));
}

/// One `Dataset` of schema.org a ship, each on a line of its own.
#[test]
fn the_catalogue_of_the_zoo_is_current() {
    let zoo = Zoo::load_embedded().unwrap_or_else(|error| panic!("{error}"));
    let entries =
        zoo.vessels().map(|vessel| serde_json::to_string(&CatalogueEntry::from_vessel(vessel)));
    let entries: Result<Vec<String>, _> = entries.collect();
    let entries = entries.unwrap_or_else(|error| panic!("{error}"));
    is_current("zoo.jsonld", &format!("{{\"@graph\":[\n{}\n]}}\n", entries.join(",\n")));
}

fn is_current(name: &str, current: &str) {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../docs").join(name);
    if std::env::var_os("UPDATE_ZOO").is_some() {
        std::fs::write(&path, current)
            .unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    }
    let stored = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(
        stored == current,
        "docs/{name} is not current: run this test with UPDATE_ZOO=1\n{}",
        first_difference(&stored, current)
    );
}

#[test]
fn every_ship_of_the_zoo_passes_the_check_of_a_contributed_one() {
    let zoo = Zoo::load_embedded().unwrap_or_else(|error| panic!("{error}"));
    for vessel in zoo.vessels() {
        let review = review_ship(&zoo, vessel).unwrap_or_else(|error| panic!("{error}"));
        let refused = review.findings.iter().filter(|one| one.severity == Severity::Refused);
        let refused: Vec<String> =
            refused.map(|one| format!("{}: {}", one.about, one.message)).collect();
        assert!(review.is_acceptable(), "{}:\n{}", vessel.name(), refused.join("\n"));
    }
}

fn first_difference(stored: &str, current: &str) -> String {
    let mut pairs = stored.lines().zip(current.lines());
    pairs.find(|(a, b)| a != b).map_or(String::new(), |(a, b)| format!("- {a}\n+ {b}"))
}

/// The page. Figures are rounded so that it is the same on every machine.
fn page(zoo: &Zoo) -> String {
    let appraised: Vec<(&Vessel, Vec<ModelAppraisal>)> = zoo
        .vessels()
        .map(|vessel| {
            let models = appraise_vessel(zoo, vessel).unwrap_or_else(|error| panic!("{error}"));
            (vessel.as_ref(), models)
        })
        .collect();
    let mut text = head(&appraised);
    text.push_str(&models_table(&appraised));
    text.push_str(&comparisons_table(&appraised));
    text.push_str(&estimates_table(zoo, &appraised));
    text.push_str(&without_model(&appraised));
    text.push_str(&sources_list(&appraised));
    text
}

fn head(appraised: &[(&Vessel, Vec<ModelAppraisal>)]) -> String {
    let all = || appraised.iter().flat_map(|(_, models)| models);
    let with_model = appraised.iter().filter(|(_, models)| !models.is_empty()).count();
    let citations: BTreeSet<&str> = appraised
        .iter()
        .flat_map(|(vessel, models)| models.iter().map(move |model| (vessel, model)))
        .filter_map(|(vessel, model)| {
            let key = model.sources.first()?;
            vessel.file.sources.get(key).map(|source| source.citation.as_str())
        })
        .collect();
    let sail = all().filter(|model| model.manoeuvres.failures.is_empty()).count();
    let count = |standing| all().filter(|model| model.standing == standing).count();
    let by_model = tried(appraised, |models| !models.is_empty());
    let by_estimate = tried(appraised, <[ModelAppraisal]>::is_empty);
    format!(
        "# The zoo\n\n\
         Generated: `UPDATE_ZOO=1 cargo test -p sistership-tests --test zoo page`.\n\n\
         {} models of {with_model} ships, from {} publications or programs (the first source of \
         each model); {} ships in all.\n{sail} of the models sail every standard manoeuvre. By \
         status: {} validated, {} published, {} disputed, {} estimated.\n{} ships are held \
         against published free-running trials of their own: {by_model} by their models, \
         {by_estimate} by the\nestimate from their particulars. A ship that the zoo has at several \
         scales counts once.\n\n\
         A model is `validated` where every published free-running figure of its ship is met: \
         turning figures within {:.0} %, overshoots\nwithin {:.0} % or {:.0} deg, whichever is \
         more, each beside the uncertainty of the trial; `disputed` where one is\nmissed; \
         `published` or `estimated`, by the origin of its figures, where none is known. The limits \
         are chosen\n(`crates/analysis/assessment/src/validation/limits.rs` has the reasons).\n\n",
        all().count(),
        citations.len(),
        appraised.len(),
        count(ValidationStatus::Validated),
        count(ValidationStatus::Published),
        count(ValidationStatus::Disputed),
        count(ValidationStatus::Estimated),
        by_model + by_estimate,
        100.0 * limits::TURN_SHARE,
        100.0 * limits::OVERSHOOT_SHARE,
        limits::OVERSHOOT_DEG,
    )
}

/// Ships with published trials whose models are as wanted. The same trials of a ship at several
/// scales count once.
fn tried(
    appraised: &[(&Vessel, Vec<ModelAppraisal>)],
    wanted: impl Fn(&[ModelAppraisal]) -> bool,
) -> usize {
    let with_trials = appraised
        .iter()
        .filter(|(vessel, models)| wanted(models) && !vessel.file.free_running.is_empty());
    let trials = |vessel: &Vessel| {
        let each = vessel.file.free_running.iter().map(|trial| {
            let citation = vessel.file.sources.get(&trial.source).map(|source| &source.citation);
            format!("{citation:?} {:?} {:?}", trial.turns, trial.zigzags)
        });
        each.collect::<Vec<String>>()
    };
    with_trials.map(|(vessel, _)| trials(vessel)).collect::<BTreeSet<_>>().len()
}

fn models_table(appraised: &[(&Vessel, Vec<ModelAppraisal>)]) -> String {
    let mut text = String::from(
        "## Models\n\n\
         Turns at 35 deg to starboard (or as far as the gear goes) in ship lengths, zigzags \
         beginning to starboard\nin deg, in deep water unless the model's name says otherwise.\n\n\
         | model | L, m | m/s | law | origin | status | advance | tactical | 10/10 | 20/20 | \
         source |\n| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n",
    );
    for model in appraised.iter().flat_map(|(_, models)| models) {
        let sailed = &model.manoeuvres;
        let source = model.sources.first().map_or("-", String::as_str);
        let _ = writeln!(
            text,
            "| `{}` | {} | {:.2} | `{}` | {} | {} | {} | {} | {} | {} | {source} |",
            model.model,
            length(model.lpp_m),
            model.speed_m_s,
            model.law,
            origin(model.origin),
            model.standing.as_word(),
            turn_figure(model, |turn| turn.advance_m),
            turn_figure(model, |turn| turn.tactical_diameter_m),
            overshoots(sailed, 10.0),
            overshoots(sailed, 20.0),
        );
    }
    text.push('\n');
    text
}

fn origin(status: Status) -> &'static str {
    match status {
        Status::Published => "published",
        Status::Estimated => "estimated",
        Status::Transferred => "transferred",
        Status::Refined => "refined",
    }
}

fn length(lpp_m: f64) -> String {
    if lpp_m < 10.0 { format!("{lpp_m:.2}") } else { format!("{lpp_m:.1}") }
}

fn turn_figure(
    model: &ModelAppraisal,
    of: impl Fn(&sistership_simulation::metrics::TurningMetrics) -> Option<f64>,
) -> String {
    let starboard = model.manoeuvres.turns.iter().find(|turn| turn.rudder_deg > 0.0);
    starboard
        .and_then(of)
        .map_or_else(|| "-".into(), |metres| format!("{:.2}", metres / model.lpp_m))
}

fn overshoots(sailed: &StandardManoeuvres, rudder_deg: f64) -> String {
    let Some(zigzag) = sailed.zigzags.iter().find(|zigzag| zigzag.rudder_deg == rudder_deg) else {
        return "-".into();
    };
    let angle = |angle: Option<f64>| angle.map_or_else(|| "-".into(), |deg| format!("{deg:.1}"));
    format!("{}, {}", angle(zigzag.first_overshoot_deg), angle(zigzag.second_overshoot_deg))
}

fn comparisons_table(appraised: &[(&Vessel, Vec<ModelAppraisal>)]) -> String {
    let mut text = String::from(
        "## Against published free-running trials\n\n| model | figure | published | simulated | \
         error | allowed | within | source |\n| --- | --- | --- | --- | --- | --- | --- | --- |\n",
    );
    for model in appraised.iter().flat_map(|(_, models)| models) {
        for one in &model.comparisons {
            let _ = writeln!(
                text,
                "| `{}` | {} | {:.2} ± {:.2} {} | {} | {} | {:.2} | {} | {} |",
                model.model,
                one.figure,
                one.published,
                one.uncertainty,
                one.unit,
                two(one.sailed),
                two(FigureComparison::error(one)),
                one.limit,
                if one.is_within() { "yes" } else { "no" },
                one.source,
            );
        }
    }
    text.push('\n');
    text
}

/// What the estimate from particulars makes of the same trials, whatever models the ship has.
fn estimates_table(zoo: &Zoo, appraised: &[(&Vessel, Vec<ModelAppraisal>)]) -> String {
    let mut text = String::from(
        "## Estimates from particulars against the same trials\n\n\
         Manoeuvres simulated by `sistership estimate`, from the particulars only, with one screw \
         and one rudder for every ship\n(docs/evidence/estimates.md has the bands).\n\n\
         | ship | figure | published | estimate | error | source |\n\
         | --- | --- | --- | --- | --- | --- |\n",
    );
    let library = RegressionLibrary::parse_embedded().unwrap_or_else(|error| panic!("{error}"));
    for (vessel, _) in appraised {
        for one in estimated(zoo, &library, vessel) {
            let _ = writeln!(
                text,
                "| `{}` | {} | {:.2} ± {:.2} {} | {} | {} | {} |",
                vessel.name(),
                one.figure,
                one.published,
                one.uncertainty,
                one.unit,
                two(one.sailed),
                two(one.error()),
                one.source,
            );
        }
    }
    text.push('\n');
    text
}

/// The estimate at the speed of each trial, beside the trial.
fn estimated(zoo: &Zoo, library: &RegressionLibrary, vessel: &Vessel) -> Vec<FigureComparison> {
    let law = zoo.law(LAW).unwrap_or_else(|| panic!("the law {LAW} is missing"));
    let mut all = Vec::new();
    for trial in &vessel.file.free_running {
        let speed = trial.speed_m_s.or_else(|| vessel.particular("service_speed_m_s"));
        let speed = speed.or_else(|| vessel.file.models.first()?.speed_m_s);
        let Some(speed) = speed else { continue };
        let Ok(estimate) = estimate_ship(library, vessel, law, speed) else { continue };
        let ship = Ship::new(&estimate.model, law).unwrap_or_else(|error| panic!("{error}"));
        all.extend(compare_published(&ship, std::slice::from_ref(trial)));
    }
    all
}

fn two(value: Option<f64>) -> String {
    value.map_or_else(|| "-".into(), |value| format!("{value:.2}"))
}

fn without_model(appraised: &[(&Vessel, Vec<ModelAppraisal>)]) -> String {
    let names: Vec<String> = appraised
        .iter()
        .filter(|(_, models)| models.is_empty())
        .map(|(vessel, _)| format!("`{}`", vessel.name()))
        .collect();
    format!("Known by particulars only: {}.\n\n", names.join(", "))
}

fn sources_list(appraised: &[(&Vessel, Vec<ModelAppraisal>)]) -> String {
    let mut text = String::from("## Sources\n\n| ship | key | citation |\n| --- | --- | --- |\n");
    for (vessel, _) in appraised {
        for (key, source) in &vessel.file.sources {
            let doi = source.doi.as_ref().map_or(String::new(), |doi| format!(", doi {doi}"));
            let citation = source.citation.replace('|', "\\|");
            let _ = writeln!(text, "| `{}` | {key} | {citation}{doi} |", vessel.name());
        }
    }
    text
}
