//! Choice of the source by similarity: the ranking for readers.

use sistership_priors::similarity::{RankedSource, VectorDefinition};
use sistership_priors::source::SimilarityRanking;

use crate::numbers::{format_fixed, format_known, format_significant};
use crate::tables::{ReportTable, TableCell, TableColumn, TableRow};

/// Publication of the definition of the vector.
pub(crate) fn definition_source(definition: VectorDefinition) -> &'static str {
    match definition {
        VectorDefinition::Mei2019 => "Mei et al. 2019, Eqs. 4 and 5",
        VectorDefinition::Kanazawa2023 => "Kanazawa 2023, Eq. 5.18",
    }
}

/// Vector of the target ship: `C_b 0.56, L/B 6.89`.
pub(crate) fn vector_text(similarity: &SimilarityRanking) -> String {
    let one = |(name, value): (&String, &f64)| format!("{name} {}", format_significant(*value, 3));
    similarity.vector.iter().map(one).collect::<Vec<_>>().join(", ")
}

/// Remark if the source is not the first eligible ship of the ranking.
pub(crate) fn source_remark(similarity: &SimilarityRanking, chosen: &str) -> Option<String> {
    let first = similarity
        .ranking
        .iter()
        .find(|ranked| ranked.eligible)
        .and_then(|ranked| ranked.model.as_deref());
    match first {
        Some(first) if first == chosen => None,
        Some(first) => Some(format!(
            "The source was given for this refinement; the ranking would have selected {first}."
        )),
        None => Some(
            "The source was given for this refinement; no ship of the ranking is eligible.".into(),
        ),
    }
}

/// Table of the ranking, with the source marked.
pub(crate) fn ranking_table(similarity: &SimilarityRanking, chosen: &str) -> ReportTable {
    let columns = vec![
        TableColumn::number_column("rank", ""),
        TableColumn::text_column("ship", ""),
        TableColumn::text_column("model", ""),
        TableColumn::number_column("correlation", ""),
        TableColumn::text_column("eligible", ""),
        TableColumn::prose_column("why"),
    ];
    let row = |(index, ranked): (usize, &RankedSource)| ranking_row(index + 1, ranked, chosen);
    ReportTable { columns, rows: similarity.ranking.iter().enumerate().map(row).collect() }
}

fn ranking_row(rank: usize, ranked: &RankedSource, chosen: &str) -> TableRow {
    let is_chosen = ranked.model.as_deref() == Some(chosen);
    let ship = TableCell::new(&ranked.ship);
    let cells = vec![
        TableCell::new(rank.to_string()),
        if is_chosen { ship.with_mark("source", "chosen") } else { ship },
        TableCell::new(ranked.model.as_deref().unwrap_or("–")),
        TableCell::new(format_known(ranked.correlation, |value| format_fixed(value, 4))),
        if ranked.eligible {
            TableCell::new("").with_mark("✓ yes", "good")
        } else {
            TableCell::new("").with_mark("✗ no", "bad")
        },
        TableCell::new(ranked.reasons.join("; ")),
    ];
    TableRow::from_cells(cells).with_highlight(is_chosen)
}
