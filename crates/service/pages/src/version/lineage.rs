//! Lineage of a version as a picture: its ancestors and descendants.

use sistership_jobs::Archive;
use sistership_jobs::version::VersionDocument;
use sistership_report::plots::{Plot, Shape};
use sistership_store::{Page, VersionHead};

use crate::error::Result;
use crate::picture::{line, text};

/// Number of ancestors in the picture.
const ANCESTORS: usize = 4;
/// Number of descendants in the picture.
const DESCENDANTS: i64 = 5;
const NODE: (f64, f64) = (150.0, 48.0);
const ACROSS: f64 = 36.0;
const DOWN: f64 = 14.0;

/// A version in the picture and in the list.
pub(super) struct Node {
    pub label: String,
    pub at: String,
    pub how: String,
}

/// Ancestors from the oldest, the version, and its descendants.
pub(super) struct Lineage {
    pub ancestors: Vec<Node>,
    pub own: Node,
    pub descendants: Vec<Node>,
    /// Names of the trials it was fitted to.
    pub trials: Vec<String>,
    /// Names of its effects.
    pub effects: Vec<String>,
}

impl Lineage {
    /// Reads ancestors and descendants of a version.
    ///
    /// # Errors
    /// Returns an error if the store fails.
    pub async fn of(
        archive: &Archive,
        head: &VersionHead,
        document: &VersionDocument,
    ) -> Result<Self> {
        let versions = archive.store.versions();
        let (mut ancestors, mut parent) = (Vec::new(), head.parent.clone());
        // Each parent is one look-up; the chain is cut off after a few.
        while let Some(id) = parent.filter(|_| ancestors.len() < ANCESTORS) {
            let found = versions.by_id(&id).await?.head;
            ancestors.insert(0, Node::of(&found));
            parent = found.parent;
        }
        let children = versions.children(&head.id, &Page::first(DESCENDANTS)).await?.items;
        Ok(Self {
            ancestors,
            own: Node::of(head),
            descendants: children.iter().map(Node::of).collect(),
            trials: document.recipe.trials().iter().map(|trial| trial.name.clone()).collect(),
            effects: document.model.effects.iter().map(|effect| effect.name.clone()).collect(),
        })
    }

    /// Draws the picture; time goes to the right.
    pub fn drawn(&self) -> Plot {
        // At least two rows, so that the texts below the node have room.
        let rows = self.descendants.len().max(2);
        let step = NODE.1 + DOWN;
        // The version is in the middle of the height that its descendants need.
        let middle = 10.0 + 0.5 * (rows as f64 * step - DOWN) - 0.5 * NODE.1;
        let x = |column: usize| 6.0 + column as f64 * (NODE.0 + ACROSS);
        let mut shapes = Vec::new();
        for (column, node) in self.ancestors.iter().enumerate() {
            shapes.extend(node.drawn((x(column), middle), "node"));
            shapes.push(edge((x(column) + NODE.0, middle), (x(column + 1), middle)));
        }
        let own = self.ancestors.len();
        shapes.extend(self.own.drawn((x(own), middle), "node here"));
        shapes.extend(self.beside((x(own), middle)));
        let first = middle + 0.5 * NODE.1 - 0.5 * (self.descendants.len() as f64 * step - DOWN);
        for (row, node) in self.descendants.iter().enumerate() {
            let at = (x(own + 1), first + row as f64 * step);
            shapes.extend(node.drawn(at, "node"));
            shapes.push(edge((x(own) + NODE.0, middle), at));
        }
        let columns = own + 1 + usize::from(!self.descendants.is_empty());
        let width = (x(columns) - ACROSS + 6.0).max(420.0);
        Plot {
            width,
            height: 20.0 + rows as f64 * step + 8.0,
            label: format!("Lineage of {}; the list below says the same", self.own.label),
            shapes,
        }
    }

    /// Returns texts on trials and effects, below the node of the version.
    fn beside(&self, at: (f64, f64)) -> Vec<Shape> {
        let trials = match self.trials.len() {
            0 => None,
            1 => Some("of 1 trial".to_owned()),
            count => Some(format!("of {count} trials")),
        };
        let effects =
            (!self.effects.is_empty()).then(|| format!("with {}", self.effects.join(", ")));
        let words = trials.into_iter().chain(effects);
        words
            .enumerate()
            .map(|(row, words)| {
                let y = at.1 + NODE.1 + 13.0 + 12.0 * row as f64;
                text((at.0 + 4.0, y), words, "small")
            })
            .collect()
    }
}

impl Node {
    fn of(head: &VersionHead) -> Self {
        let VersionHead { model, number, law, method, .. } = head;
        Self {
            label: format!("{model}/{number}"),
            at: format!("/ships/{model}/versions/{number}"),
            how: format!("{method}, {law}"),
        }
    }

    fn drawn(&self, at: (f64, f64), class: &'static str) -> [Shape; 3] {
        [
            Shape::Rect { at, size: NODE, class },
            text((at.0 + 8.0, at.1 + 19.0), cut(&self.label), "title"),
            text((at.0 + 8.0, at.1 + 36.0), cut(&self.how), "small"),
        ]
    }
}

/// Shortens a text to the width of a node.
fn cut(words: &str) -> String {
    const LETTERS: usize = 25;
    match words.chars().count() <= LETTERS {
        true => words.to_owned(),
        false => words.chars().take(LETTERS - 1).chain(['…']).collect(),
    }
}

fn edge(from: (f64, f64), to: (f64, f64)) -> Shape {
    let half = 0.5 * NODE.1;
    line((from.0, from.1 + half), (to.0, to.1 + half), "edge")
}
