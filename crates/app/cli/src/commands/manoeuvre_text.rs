//! Text output of the manoeuvres of a model.

use sistership_assessment::uncertainty::UncertaintyBands;
use sistership_model::{Law, Model};
use sistership_simulation::Ship;
use sistership_simulation::metrics::{ImoCriterion, TurningMetrics, ZigzagMetrics};

use super::manoeuvre_document::ManoeuvreDocument;
use super::manoeuvre_further::further_tables;
use super::model_line;
use crate::table::{TextTable, format_number, format_optional};

/// Formats all results as text.
pub fn format_manoeuvres(
    document: &ManoeuvreDocument,
    model: &Model,
    law: &Law,
    ship: &Ship,
) -> String {
    let head = format!(
        "{}\nlength {} m, approach at {} m/s\n",
        model_line(model, law),
        format_number(ship.lpp_m()),
        format_number(document.speed_m_s)
    );
    let further = further_tables(&document.further, ship.lpp_m());
    let further =
        further.into_iter().map(|(title, table)| format_section(&title, false, || table)).collect();
    // A section without rows is omitted with its title.
    let parts: [String; 5] = [
        format_section("Turning circles", document.turns.is_empty(), || {
            turn_table(&document.turns, ship.lpp_m())
        }),
        format_section("Zigzags", document.zigzags.is_empty(), || zigzag_table(&document.zigzags)),
        further,
        format_section("IMO criteria, MSC.137(76)", document.imo.is_empty(), || {
            criteria_table(&document.imo)
        }),
        document.bands.as_ref().map_or(String::new(), |bands| {
            format_section(&band_title(bands), false, || band_table(bands))
        }),
    ];
    let lines = |label: &str, lines: &[String]| {
        lines.iter().map(|line| format!("{label}: {line}\n")).collect::<String>()
    };
    let outside: Vec<String> =
        document.outside.iter().map(|(name, how)| format!("{name}: {}", how.describe())).collect();
    // Failures come last, next to the exit status.
    let end = lines("OUTSIDE", &outside)
        + &lines("remark", &document.remarks)
        + &lines("FAILED", &document.failures);
    let gap = if end.is_empty() { "" } else { "\n" };
    format!("{head}{}{gap}{end}", parts.concat())
}

fn format_section(title: &str, is_empty: bool, table: impl FnOnce() -> TextTable) -> String {
    if is_empty { String::new() } else { format!("\n{title}\n{}", table()) }
}

fn turn_table(turns: &[TurningMetrics], lpp_m: f64) -> TextTable {
    let mut table = TextTable::new([
        "rudder deg",
        "advance m",
        "L",
        "transfer m",
        "L",
        "tactical diameter m",
        "L",
        "steady radius m",
        "max advance m",
        "max transfer m",
        "speed loss m/s",
    ]);
    for turn in turns {
        let mut cells = vec![format_number(turn.rudder_deg)];
        // Lengths in metres and in ship lengths, as in the IMO criteria.
        for length in [turn.advance_m, turn.transfer_m, turn.tactical_diameter_m] {
            cells.extend([
                format_optional(length),
                length.map_or_else(|| "-".to_owned(), |m| format!("{:.2}", m / lpp_m)),
            ]);
        }
        cells.push(format_optional(turn.steady_radius_m));
        cells.extend(
            [turn.max_advance_m, turn.max_transfer_m, turn.speed_loss_m_s].map(format_number),
        );
        table.add_row(cells);
    }
    table
}

fn zigzag_table(zigzags: &[ZigzagMetrics]) -> TextTable {
    let mut table = TextTable::new([
        "rudder deg",
        "heading deg",
        "1st overshoot deg",
        "2nd overshoot deg",
        "initial turning s",
        "period s",
    ]);
    for zigzag in zigzags {
        let known = [
            zigzag.first_overshoot_deg,
            zigzag.second_overshoot_deg,
            zigzag.initial_turning_time_s,
            zigzag.period_s,
        ];
        table.add_row(
            [format_number(zigzag.rudder_deg), format_number(zigzag.switch_deg)]
                .into_iter()
                .chain(known.map(format_optional)),
        );
    }
    table
}

fn band_title(bands: &UncertaintyBands) -> String {
    let failed = if bands.failed > 0 {
        format!(", {} of which left the physical range", bands.failed)
    } else {
        String::new()
    };
    format!("Bands of 95 % by {} draws from the posterior{failed}", bands.sampling.samples)
}

fn band_table(bands: &UncertaintyBands) -> TextTable {
    let mut table = TextTable::new(["figure", "unit", "from", "to", "reached", "met"]);
    let percent = |share: f64| format!("{:.0} %", 100.0 * share);
    for band in &bands.figures {
        // Share of the draws that meet the criterion.
        let met = band.pass.map_or_else(|| "-".to_owned(), percent);
        table.add_row([
            band.figure.clone(),
            band.unit.clone(),
            format_number(band.low),
            format_number(band.high),
            percent(band.reached),
            met,
        ]);
    }
    table
}

fn criteria_table(criteria: &[ImoCriterion]) -> TextTable {
    let mut table = TextTable::new(["criterion", "value", "limit", "unit", "verdict"]);
    for criterion in criteria {
        let verdict =
            criterion.pass.map_or("not reached", |pass| if pass { "pass" } else { "FAIL" });
        let value = criterion.value.map_or_else(|| "-".to_owned(), |value| format!("{value:.2}"));
        let limit = format!("{:.2}", criterion.limit);
        table.add_row([
            criterion.criterion.clone(),
            value,
            limit,
            criterion.unit.clone(),
            verdict.to_owned(),
        ]);
    }
    table
}
