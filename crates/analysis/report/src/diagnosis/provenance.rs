//! Provenance of the diagnosis: the diagnosed model, and the trials.

use sistership_model::Model;
use sistership_model::effect::AppliedEffect;
use sistership_model::trial::{Channel, Trial};

use crate::numbers::{format_known, format_significant, format_stated};
use crate::tables::{ReportTable, TableCell, TableColumn, TableRow};
use crate::words;

/// Facts about the model: a heading and a text for each.
pub(crate) fn model_facts(model: &Model) -> Vec<(&'static str, String)> {
    let mut lines = vec![(
        "Status",
        format!("{}: {}", words::status_word(model.status), words::status_meaning(model.status)),
    )];
    lines.extend(
        model.speed_m_s.map(|speed| ("Approach speed", format!("{} m/s", format_stated(speed, 3)))),
    );
    let carried: Vec<String> = model.effects.iter().map(effect_text).collect();
    lines.push((
        "Effects included already",
        if carried.is_empty() { "none".into() } else { carried.join("; ") },
    ));
    let open = match &model.uncertainty {
        Some(uncertainty) => format!("estimated on {}", uncertainty.trials.join(", ")),
        None => "unknown; the setting `slack` is used instead".into(),
    };
    lines.push(("Uncertainty of the model", open));
    lines.extend(model.note.iter().map(|note| ("Note", note.clone())));
    lines
}

fn effect_text(effect: &AppliedEffect) -> String {
    let values = effect
        .parameters
        .iter()
        .map(|(name, quantity)| format!("{name} {}", format_significant(quantity.value, 3)));
    format!("{} ({})", effect.name, values.collect::<Vec<_>>().join(", "))
}

/// Table of the trials.
pub(crate) fn trial_table(trials: &[&Trial]) -> ReportTable {
    let columns = vec![
        TableColumn::text_column("trial", ""),
        TableColumn::text_column("manoeuvre", ""),
        TableColumn::number_column("samples", ""),
        TableColumn::number_column("duration", "s"),
        TableColumn::number_column("approach speed", "m/s"),
        TableColumn::number_column("water depth", "m"),
        TableColumn::prose_column("channels"),
    ];
    let row = |trial: &&Trial| {
        let speed = trial.channel(Channel::U).and_then(|speeds| speeds.first().copied());
        let channels: Vec<&str> = trial.channels.keys().map(|channel| channel.name()).collect();
        TableRow::from_cells(vec![
            TableCell::new(&trial.name),
            TableCell::new(trial.manoeuvre.as_deref().unwrap_or("–")),
            TableCell::new(trial.len().to_string()),
            TableCell::new(format_stated(trial.duration_s(), 4)),
            TableCell::new(format_known(speed, |speed| format_significant(speed, 3))),
            TableCell::new(format_known(trial.depth_m, |depth| format_stated(depth, 3))),
            TableCell::new(channels.join(", ")),
        ])
    };
    ReportTable { columns, rows: trials.iter().map(row).collect() }
}
