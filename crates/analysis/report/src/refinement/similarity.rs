//! Choice of the source by similarity: the ranking for readers.

use sistership_priors::similarity::{Definition, RankedSource};
use sistership_priors::source::Similarity;

use crate::numbers::{fixed, known, significant};
use crate::tables::{Cell, Column, Row, Table};

/// Publication of the definition of the vector.
pub(crate) fn definition(definition: Definition) -> &'static str {
    match definition {
        Definition::Mei2019 => "Mei et al. 2019, Eqs. 4 and 5",
        Definition::Kanazawa2023 => "Kanazawa 2023, Eq. 5.18",
    }
}

/// Vector of the target ship: `C_b 0.56, L/B 6.89`.
pub(crate) fn vector(similarity: &Similarity) -> String {
    let one = |(name, value): (&String, &f64)| format!("{name} {}", significant(*value, 3));
    similarity.vector.iter().map(one).collect::<Vec<_>>().join(", ")
}

/// Remark if the source is not the first eligible ship of the ranking.
pub(crate) fn remark(similarity: &Similarity, chosen: &str) -> Option<String> {
    let first = similarity
        .ranking
        .iter()
        .find(|ranked| ranked.eligible)
        .and_then(|ranked| ranked.model.as_deref());
    match first {
        Some(first) if first == chosen => None,
        Some(first) => Some(format!(
            "The source was named for this refinement; by the ranking it would have been {first}."
        )),
        None => Some(
            "The source was named for this refinement; by the ranking no ship is eligible.".into(),
        ),
    }
}

/// Table of the ranking, with the source marked.
pub(crate) fn table(similarity: &Similarity, chosen: &str) -> Table {
    let columns = vec![
        Column::number("rank", ""),
        Column::text("ship", ""),
        Column::text("model", ""),
        Column::number("correlation", ""),
        Column::text("eligible", ""),
        Column::prose("why"),
    ];
    let row = |(index, ranked): (usize, &RankedSource)| line(index + 1, ranked, chosen);
    Table { columns, rows: similarity.ranking.iter().enumerate().map(row).collect() }
}

fn line(rank: usize, ranked: &RankedSource, chosen: &str) -> Row {
    let is_chosen = ranked.model.as_deref() == Some(chosen);
    let ship = Cell::new(&ranked.ship);
    let cells = vec![
        Cell::new(rank.to_string()),
        if is_chosen { ship.mark("source", "chosen") } else { ship },
        Cell::new(ranked.model.as_deref().unwrap_or("–")),
        Cell::new(known(ranked.correlation, |value| fixed(value, 4))),
        if ranked.eligible {
            Cell::new("").mark("✓ yes", "good")
        } else {
            Cell::new("").mark("✗ no", "bad")
        },
        Cell::new(ranked.reasons.join("; ")),
    ];
    Row::of(cells).highlighted(is_chosen)
}
