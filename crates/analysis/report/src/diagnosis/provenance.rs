//! Provenance of the diagnosis: the diagnosed model, and the trials.

use sistership_model::Model;
use sistership_model::effect::AppliedEffect;
use sistership_model::trial::{Channel, Trial};

use crate::numbers::{known, significant, stated};
use crate::tables::{Cell, Column, Row, Table};
use crate::words;

/// Facts about the model: a heading and a text for each.
pub(crate) fn model(model: &Model) -> Vec<(&'static str, String)> {
    let mut lines = vec![(
        "Status",
        format!("{}: {}", words::status(model.status), words::status_meaning(model.status)),
    )];
    lines.extend(
        model.speed_m_s.map(|speed| ("Approach speed", format!("{} m/s", stated(speed, 3)))),
    );
    let carried: Vec<String> = model.effects.iter().map(carried).collect();
    lines.push((
        "Effects it carries already",
        if carried.is_empty() { "none".into() } else { carried.join("; ") },
    ));
    let open = match &model.uncertainty {
        Some(uncertainty) => format!("learned on {}", uncertainty.trials.join(", ")),
        None => "not known; what the settings say is allowed instead".into(),
    };
    lines.push(("What its own trials leave open", open));
    lines.extend(model.note.iter().map(|note| ("Note", note.clone())));
    lines
}

fn carried(effect: &AppliedEffect) -> String {
    let values = effect
        .parameters
        .iter()
        .map(|(name, quantity)| format!("{name} {}", significant(quantity.value, 3)));
    format!("{} ({})", effect.name, values.collect::<Vec<_>>().join(", "))
}

/// Table of the trials.
pub(crate) fn trials(trials: &[&Trial]) -> Table {
    let columns = vec![
        Column::text("trial", ""),
        Column::text("manoeuvre", ""),
        Column::number("samples", ""),
        Column::number("duration", "s"),
        Column::number("approach speed", "m/s"),
        Column::number("water depth", "m"),
        Column::prose("channels"),
    ];
    let row = |trial: &&Trial| {
        let speed = trial.channel(Channel::U).and_then(|speeds| speeds.first().copied());
        let channels: Vec<&str> = trial.channels.keys().map(|channel| channel.name()).collect();
        Row::of(vec![
            Cell::new(&trial.name),
            Cell::new(trial.manoeuvre.as_deref().unwrap_or("–")),
            Cell::new(trial.len().to_string()),
            Cell::new(stated(trial.duration_s(), 4)),
            Cell::new(known(speed, |speed| significant(speed, 3))),
            Cell::new(known(trial.depth_m, |depth| stated(depth, 3))),
            Cell::new(channels.join(", ")),
        ])
    };
    Table { columns, rows: trials.iter().map(row).collect() }
}
