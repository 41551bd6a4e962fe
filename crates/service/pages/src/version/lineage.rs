//! Lineage of a version as a picture: its ancestors and descendants.

use sistership_jobs::Archive;
use sistership_jobs::version::VersionDocument;
use sistership_report::plots::{Shape, SvgPlot};
use sistership_store::{PageRequest, VersionHead};

use crate::error::Result;
use crate::language::say;
use crate::picture::{line_shape, text_shape};

/// Number of ancestors in the picture.
const ANCESTORS: usize = 4;
/// Number of descendants in the picture.
const DESCENDANTS: i64 = 5;
const NODE: (f64, f64) = (150.0, 48.0);
const ACROSS: f64 = 36.0;
const DOWN: f64 = 14.0;

/// A version in the picture and in the list.
pub(super) struct LineageNode {
    pub label: String,
    pub at: String,
    pub how: String,
}

/// Ancestors from the oldest, the version, and its descendants.
pub(super) struct VersionLineage {
    pub ancestors: Vec<LineageNode>,
    pub own: LineageNode,
    pub descendants: Vec<LineageNode>,
    /// Names of the trials it was fitted to.
    pub trials: Vec<String>,
    /// Names of its effects.
    pub effects: Vec<String>,
}

impl VersionLineage {
    /// Reads ancestors and descendants of a version.
    ///
    /// # Errors
    /// Returns an error if the store fails.
    pub async fn load(
        archive: &Archive,
        head: &VersionHead,
        document: &VersionDocument,
    ) -> Result<Self> {
        let versions = archive.store.versions();
        let (mut ancestors, mut parent) = (Vec::new(), head.parent.clone());
        // Each parent is one look-up; the chain is cut off after a few.
        while let Some(id) = parent.filter(|_| ancestors.len() < ANCESTORS) {
            let found = versions.by_id(&id).await?.head;
            ancestors.insert(0, LineageNode::from_head(&found));
            parent = found.parent;
        }
        let children =
            versions.list_children(&head.id, &PageRequest::first_page(DESCENDANTS)).await?.items;
        Ok(Self {
            ancestors,
            own: LineageNode::from_head(head),
            descendants: children.iter().map(LineageNode::from_head).collect(),
            trials: document.recipe.trials().iter().map(|trial| trial.name.clone()).collect(),
            effects: document.model.effects.iter().map(|effect| effect.name.clone()).collect(),
        })
    }

    /// Draws the picture; time goes to the right.
    pub fn draw(&self) -> SvgPlot {
        // At least two rows, so that the texts below the node have room.
        let rows = self.descendants.len().max(2);
        let step = NODE.1 + DOWN;
        // The version is in the middle of the height that its descendants need.
        let middle = 10.0 + 0.5 * (rows as f64 * step - DOWN) - 0.5 * NODE.1;
        let x = |column: usize| 6.0 + column as f64 * (NODE.0 + ACROSS);
        let mut shapes = Vec::new();
        for (column, node) in self.ancestors.iter().enumerate() {
            shapes.extend(node.node_shapes((x(column), middle), "node"));
            shapes.push(edge_shape((x(column) + NODE.0, middle), (x(column + 1), middle)));
        }
        let own = self.ancestors.len();
        shapes.extend(self.own.node_shapes((x(own), middle), "node here"));
        shapes.extend(self.input_texts((x(own), middle)));
        let first = middle + 0.5 * NODE.1 - 0.5 * (self.descendants.len() as f64 * step - DOWN);
        for (row, node) in self.descendants.iter().enumerate() {
            let at = (x(own + 1), first + row as f64 * step);
            shapes.extend(node.node_shapes(at, "node"));
            shapes.push(edge_shape((x(own) + NODE.0, middle), at));
        }
        let columns = own + 1 + usize::from(!self.descendants.is_empty());
        let width = (x(columns) - ACROSS + 6.0).max(420.0);
        SvgPlot {
            width,
            height: 20.0 + rows as f64 * step + 8.0,
            label: say("lineage-label").with("version", &self.own.label).into(),
            shapes,
        }
    }

    /// Returns texts on trials and effects, below the node of the version.
    fn input_texts(&self, at: (f64, f64)) -> Vec<Shape> {
        let trials = match self.trials.len() {
            0 => None,
            count => Some(say("lineage-trials").with("count", count)),
        };
        let with = || say("lineage-effects").with("effects", self.effects.join(", "));
        let effects = (!self.effects.is_empty()).then(with);
        let words = trials.into_iter().chain(effects);
        words
            .enumerate()
            .map(|(row, words)| {
                let y = at.1 + NODE.1 + 13.0 + 12.0 * row as f64;
                text_shape((at.0 + 4.0, y), words, "small")
            })
            .collect()
    }
}

impl LineageNode {
    fn from_head(head: &VersionHead) -> Self {
        let VersionHead { model, number, law, method, .. } = head;
        Self {
            label: format!("{model}/{number}"),
            at: format!("/ships/{model}/versions/{number}"),
            how: format!("{method}, {law}"),
        }
    }

    fn node_shapes(&self, at: (f64, f64), class: &'static str) -> [Shape; 3] {
        [
            Shape::Rect { at, size: NODE, class },
            text_shape((at.0 + 8.0, at.1 + 19.0), shorten(&self.label), "title"),
            text_shape((at.0 + 8.0, at.1 + 36.0), shorten(&self.how), "small"),
        ]
    }
}

/// Shortens a text to the width of a node.
fn shorten(words: &str) -> String {
    const LETTERS: usize = 25;
    match words.chars().count() <= LETTERS {
        true => words.to_owned(),
        false => words.chars().take(LETTERS - 1).chain(['…']).collect(),
    }
}

fn edge_shape(from: (f64, f64), to: (f64, f64)) -> Shape {
    let half = 0.5 * NODE.1;
    line_shape((from.0, from.1 + half), (to.0, to.1 + half), "edge")
}
