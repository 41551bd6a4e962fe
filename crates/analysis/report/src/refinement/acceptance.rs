//! Acceptance summary, the first page of a report: ship, conditions of the trials, verdict on the
//! standards of IMO, model, and what is not stated with the place where it is added.

use sistership_model::Model;
use sistership_model::trial::{Channel, Trial};

use super::content::RefinementContent;
use super::input::RefinementInput;
use super::manoeuvres::CriterionComparison;
use super::tables::pass_cell;
use crate::numbers::{format_fixed, format_known, format_stated, join_words};
use crate::tables::{ReportTable, TableCell, TableColumn, TableRow};

/// Knots in a metre per second.
const KNOTS: f64 = 3600.0 / 1852.0;
/// Share of the drawn models from which a criterion is met without a reservation: that of the bands.
const CERTAIN: f64 = 0.95;

/// Acceptance summary.
#[derive(Debug)]
pub(crate) struct AcceptanceSummary {
    pub verdict: String,
    pub verdict_class: &'static str,
    pub facts: Vec<SummaryFact>,
    pub trials: String,
    pub criteria: ReportTable,
}

/// Fact: name, and value or the place where it is added.
#[derive(Debug)]
pub(crate) struct SummaryFact {
    pub name: &'static str,
    pub value: Result<String, &'static str>,
}

impl AcceptanceSummary {
    pub fn from_input(input: &RefinementInput<'_>, content: &RefinementContent<'_>) -> Self {
        let imo = &content.manoeuvres.imo;
        let (verdict, verdict_class) = uncertain_verdict(imo);
        let facts = ship_facts(input).into_iter().chain(condition_facts(input.trials));
        Self {
            verdict,
            verdict_class,
            facts: facts.collect(),
            trials: trial_list(input.trials),
            criteria: criteria_table(imo, content.manoeuvres.lpp_m),
        }
    }

    /// Facts that are not stated.
    pub fn missing(&self) -> impl Iterator<Item = (&'static str, &'static str)> {
        self.facts.iter().filter_map(|fact| Some((fact.name, fact.value.as_ref().err().copied()?)))
    }
}

/// Returns the verdict on all criteria of a model in a sentence, and its class: `good`, `bad` or
/// `open`. `imo` has name and verdict of each criterion.
pub fn imo_verdict(imo: &[(&str, Option<bool>)]) -> (String, &'static str) {
    let with = |pass: Option<bool>| -> Vec<String> {
        let some = imo.iter().filter(|(_, own)| *own == pass);
        some.map(|(name, _)| (*name).to_owned()).collect()
    };
    let (failed, unknown) = (with(Some(false)), with(None));
    // One failure decides; what could not be evaluated is never counted as met.
    match (imo.is_empty(), failed.is_empty(), unknown.is_empty()) {
        (true, ..) => ("The criteria of MSC.137(76) could not be evaluated.".to_owned(), "open"),
        (_, false, _) => {
            (format!("The model does not meet MSC.137(76): {}.", join_words(&failed)), "bad")
        }
        (_, _, false) => (
            format!(
                "The model meets the criteria of MSC.137(76) that it reaches; unknown: {}.",
                join_words(&unknown)
            ),
            "open",
        ),
        _ => ("The model meets all criteria of MSC.137(76).".to_owned(), "good"),
    }
}

/// The same with the criteria that the model meets, but too many of the models that are drawn from its
/// posterior do not: the class is then `open`.
fn uncertain_verdict(imo: &[CriterionComparison<'_>]) -> (String, &'static str) {
    let verdicts: Vec<_> = imo.iter().map(|one| (one.criterion, one.refined_pass)).collect();
    let (sentence, class) = imo_verdict(&verdicts);
    let uncertain = |one: &CriterionComparison<'_>| {
        let share = one.pass_share.filter(|share| *share < CERTAIN)?;
        let met = one.refined_pass == Some(true);
        met.then(|| format!("{} ({} %)", one.criterion, format_fixed(100.0 * share, 0)))
    };
    let uncertain: Vec<String> = imo.iter().filter_map(uncertain).collect();
    if class == "bad" || uncertain.is_empty() {
        return (sentence, class);
    }
    (format!("{sentence} With less than 95 % probability: {}.", join_words(&uncertain)), "open")
}

/// Ship, speed and loading.
fn ship_facts(input: &RefinementInput<'_>) -> Vec<SummaryFact> {
    let known = |name: &str| input.vessel.particular(name);
    let metres = |name: &str| known(name).map(|value| format!("{} m", format_stated(value, 5)));
    let fact = |name, value: Option<String>, place| SummaryFact { name, value: value.ok_or(place) };
    let particulars = "Particulars of the ship (its document, `particulars`)";
    // The speed of the trials, which may be below that of service.
    let speed = input.refinement.model.speed_m_s.map(|speed| with_knots(speed, 2));
    let trim = known("draught_aft_m").zip(known("draught_fore_m"));
    let trim = trim.map(|(aft, fore)| format!("{} m by the stern", format_fixed(aft - fore, 2)));
    let volume = known("displacement_m3");
    let volume = volume.map(|volume| format!("{} m³", format_stated(volume, 6)));
    vec![
        fact("Length between perpendiculars", metres("lpp_m"), particulars),
        fact("Beam", metres("beam_m"), particulars),
        fact("Draught", metres("draught_m"), particulars),
        fact("Trim", trim, "`draught_fore_m` and `draught_aft_m` in the ship's particulars"),
        fact("Displacement", volume, particulars),
        fact("Approach speed", speed, "`service_speed_m_s` in the ship's particulars"),
        fact(
            "Propeller revolutions",
            engine_text(&input.refinement.model),
            "column `n` of the trials",
        ),
    ]
}

/// Revolutions on the approach, and what a turn takes of them.
fn engine_text(model: &Model) -> Option<String> {
    let approach =
        format!("{} rpm on the approach", format_fixed(60.0 * model.revolutions_rps?, 1));
    let lost = model.revolutions_loss.map(|loss| format_fixed(50.0 * loss, 0));
    Some(lost.map_or_else(
        || format!("{approach}, held in manoeuvres"),
        |lost| format!("{approach}; {lost} % less at half the speed, as in the trials"),
    ))
}

/// Conditions of the trials: what their channels tell.
fn condition_facts(trials: &[&Trial]) -> Vec<SummaryFact> {
    let by_hand = "the form of conditions, linked from the version's acceptance summary";
    let blank = |name| SummaryFact { name, value: Err(by_hand) };
    let wind = channel_range(trials, &[Channel::WindSpeed, Channel::ApparentWindSpeed])
        .map(|(low, high)| format!("{} to {}", with_knots(low, 1), with_knots(high, 1)));
    // A recorded depth changes along the track and says more than a stated one.
    let depth = channel_range(trials, &[Channel::Depth]).or_else(|| stated_depth(trials));
    let depth = depth.map(|(low, high)| match high - low < 0.05 {
        true => format!("{} m", format_fixed(low, 1)),
        false => format!("{} to {} m", format_fixed(low, 1), format_fixed(high, 1)),
    });
    let channels: Vec<String> = Channel::all_channels()
        .filter(|channel| trials.iter().any(|trial| trial.channel(*channel).is_some()))
        .map(|channel| channel.to_string())
        .collect();
    let recorded = (!channels.is_empty()).then(|| channels.join(", "));
    vec![
        blank("Date of the trials"),
        blank("Place"),
        SummaryFact {
            name: "Wind",
            value: wind.ok_or("Channels `wind_speed` and `wind_from` of the trials"),
        },
        blank("Sea"),
        SummaryFact { name: "Water depth", value: depth.ok_or("`depth_m` of the trials") },
        SummaryFact { name: "Recorded channels", value: recorded.ok_or(by_hand) },
        blank("Instruments"),
    ]
}

/// Depths that trials state for their whole duration, m.
fn stated_depth(trials: &[&Trial]) -> Option<(f64, f64)> {
    value_limits(trials.iter().filter_map(|trial| trial.depth_m))
}

/// Least and greatest value of the first of these channels that some trial has, SI.
fn channel_range(trials: &[&Trial], channels: &[Channel]) -> Option<(f64, f64)> {
    channels.iter().find_map(|channel| {
        let values = trials.iter().filter_map(|trial| trial.channel(*channel)).flatten();
        value_limits(values.copied())
    })
}

fn value_limits(values: impl Iterator<Item = f64>) -> Option<(f64, f64)> {
    values.fold(None, |limits: Option<(f64, f64)>, value| {
        let (low, high) = limits.unwrap_or((value, value));
        Some((low.min(value), high.max(value)))
    })
}

/// Speed in metres per second and knots.
fn with_knots(speed_m_s: f64, decimals: usize) -> String {
    let knots = format_fixed(KNOTS * speed_m_s, 1);
    format!("{} m/s ({knots} kn)", format_fixed(speed_m_s, decimals))
}

/// Names of the trials with their manoeuvres.
fn trial_list(trials: &[&Trial]) -> String {
    let name = |trial: &&Trial| match &trial.manoeuvre {
        Some(manoeuvre) => format!("{} ({manoeuvre})", trial.name),
        None => trial.name.clone(),
    };
    trials.iter().map(name).collect::<Vec<_>>().join(", ")
}

/// Criteria of the refined model alone, lengths in metres too.
fn criteria_table(imo: &[CriterionComparison<'_>], lpp_m: Option<f64>) -> ReportTable {
    let columns = vec![
        TableColumn::text_column("criterion of MSC.137(76)", ""),
        TableColumn::number_column("value", ""),
        TableColumn::number_column("95 % band", ""),
        TableColumn::number_column("limit", "at most"),
        TableColumn::number_column("met with", "probability"),
        TableColumn::text_column("verdict", ""),
    ];
    ReportTable { columns, rows: imo.iter().map(|one| criterion_row(one, lpp_m)).collect() }
}

fn criterion_row(one: &CriterionComparison<'_>, lpp_m: Option<f64>) -> TableRow {
    // Criteria are in ship lengths, people measure in metres.
    let metres = |value: f64| match (one.unit, lpp_m) {
        ("L", Some(length)) => format!(" ({} m)", format_stated((value * length).round(), 5)),
        _ => String::new(),
    };
    let value = |value| format!("{} {}{}", format_fixed(value, 2), one.unit, metres(value));
    let band = one.band.map_or_else(
        || "–".to_owned(),
        |[low, high]| format!("{} to {} {}", format_fixed(low, 2), format_fixed(high, 2), one.unit),
    );
    let share = |share| format!("{} %", format_fixed(100.0 * share, 0));
    TableRow::from_cells(vec![
        TableCell::new(one.criterion),
        TableCell::new(format_known(one.refined, value)),
        TableCell::new(band),
        TableCell::new(format!("{} {}", format_fixed(one.limit, 2), one.unit)),
        TableCell::new(format_known(one.pass_share, share)),
        pass_cell(one.refined_pass),
    ])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn criterion(name: &str, pass: Option<bool>) -> CriterionComparison<'_> {
        CriterionComparison {
            criterion: name,
            limit: 4.5,
            unit: "L",
            source: None,
            source_pass: None,
            refined: pass.map(|_| 4.0),
            refined_pass: pass,
            band: Some([3.5, 4.6]),
            pass_share: Some(0.93),
        }
    }

    #[test]
    fn one_failure_decides_the_verdict() {
        assert!(imo_verdict(&[("advance", Some(true))]).0.contains("meets all"));
        let (text, class) = imo_verdict(&[("turn", Some(false)), ("stop", None)]);
        assert!(text.contains("does not meet MSC.137(76): turn.") && class == "bad", "{text}");
        assert_eq!(imo_verdict(&[("stop", None)]).1, "open");
    }

    #[test]
    fn a_criterion_that_many_drawn_models_fail_is_named() {
        let unsure = criterion("advance", Some(true));
        let sure = CriterionComparison { pass_share: Some(0.95), ..criterion("stop", Some(true)) };
        let (text, class) = uncertain_verdict(&[unsure, sure]);
        assert!(text.ends_with("With less than 95 % probability: advance (93 %)."), "{text}");
        assert_eq!(class, "open");
        let sure = CriterionComparison { pass_share: None, ..criterion("stop", Some(true)) };
        assert_eq!(uncertain_verdict(&[sure]).1, "good");
        let failed = uncertain_verdict(&[criterion("turn", Some(false))]);
        assert_eq!(failed, imo_verdict(&[("turn", Some(false))]));
    }

    #[test]
    fn lengths_are_in_metres_and_speeds_in_knots() {
        let one = criterion("advance", Some(true));
        let cells: Vec<String> =
            criterion_row(&one, Some(100.0)).cells.into_iter().map(|cell| cell.text).collect();
        assert_eq!(cells[1..5], ["4.00 L (400 m)", "3.50 to 4.60 L", "4.50 L", "93 %"]);
        assert_eq!(with_knots(10.0, 2), "10.00 m/s (19.4 kn)");
    }

    #[test]
    fn the_conditions_of_the_trials_are_stated_or_missing() {
        let mut trial = Trial { depth_m: Some(20.0), ..Trial::default() };
        trial.channels.insert(Channel::WindSpeed, vec![2.0, 5.0]);
        let facts = condition_facts(&[&trial]);
        let value =
            |name: &str| facts.iter().find(|fact| fact.name == name).map(|fact| fact.value.clone());
        let wind = "2.0 m/s (3.9 kn) to 5.0 m/s (9.7 kn)".to_owned();
        assert_eq!(value("Wind"), Some(Ok(wind)));
        assert_eq!(value("Water depth"), Some(Ok("20.0 m".to_owned())));
        assert!(value("Place").is_some_and(|place| place.is_err()));
    }
}
