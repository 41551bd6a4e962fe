//! Export of a ship from an archive to a bundle.

use std::collections::{BTreeMap, BTreeSet};

use sistership_model::version;
use sistership_store::{StoreError, Trial, Version, read_all_pages};

use super::content::{Bundle, BundleContent, ReportRecord, ShipRecord, TrialRecord, VersionRecord};
use super::error::BundleError;
use super::history::ship_revisions;
use crate::archive::{Archive, version_document};
use crate::recipe::DerivationRecipe;
use crate::ship_trials::all_trials;
use crate::version::VersionDocument;

type Result<T> = std::result::Result<T, BundleError>;

/// Exports a ship with all its versions, and of other ships the versions that these start from, up
/// to the last one needed, so that version numbers stay the same.
///
/// # Errors
/// Returns an error that names what is missing, or what a bundle cannot hold.
pub async fn collect_bundle(archive: &Archive, ship: &str) -> Result<Bundle> {
    let mut gathering =
        BundleBuilder { archive, needed: BTreeMap::new(), bundle: empty_bundle(ship) };
    archive.store.ships().get(ship).await?;
    let latest = match archive.store.versions().latest(ship).await {
        Ok(latest) => latest.head.number,
        Err(StoreError::NotFound { .. }) => 0,
        Err(error) => return Err(error.into()),
    };
    gathering.needed.insert(ship.to_owned(), latest);
    gathering.add_versions().await?;
    gathering.add_ships().await?;
    gathering.add_trials(ship).await?;
    gathering.add_aliases(ship).await?;
    Ok(gathering.bundle)
}

fn empty_bundle(ship: &str) -> Bundle {
    let content = BundleContent { ship: ship.to_owned(), ..BundleContent::default() };
    Bundle { content, objects: BTreeMap::new() }
}

struct BundleBuilder<'a> {
    archive: &'a Archive,
    /// Number of the last version that is needed of each ship.
    needed: BTreeMap<String, i64>,
    bundle: Bundle,
}

impl BundleBuilder<'_> {
    /// Adds versions until each ship has those that are needed; the sources of a version may add
    /// more.
    async fn add_versions(&mut self) -> Result<()> {
        let has = |gathering: &Self, line: &String| {
            gathering.bundle.content.lines.get(line).map_or(0, Vec::len) as i64
        };
        // `version` below may raise `needed` of any ship, so the search starts anew after each
        // version.
        let open = |gathering: &Self| {
            let lines = gathering.needed.iter();
            let mut open = lines.filter(|(line, number)| has(gathering, line) < **number);
            open.next().map(|(line, _)| line.clone())
        };
        while let Some(line) = open(self) {
            let number = has(self, &line) + 1;
            let version = self.archive.store.versions().get(&line, number).await?;
            let record = self.version_record(&version).await?;
            self.bundle.content.lines.entry(line).or_default().push(record);
        }
        Ok(())
    }

    async fn version_record(&mut self, version: &Version) -> Result<VersionRecord> {
        let head = &version.head;
        let VersionDocument { recipe, model, .. } = version_document(version)?;
        // The prior of a family is none of the documents that a bundle can hold.
        if recipe.family_prior().is_some() {
            return Err(BundleError::Prior(format!("{}/{}", head.model, head.number)));
        }
        for source in recipe.source_versions() {
            self.require_version(&source.ship, source.number);
        }
        let parent = match &head.parent {
            Some(id) => {
                let parent = self.archive.store.versions().by_id(id).await?.head;
                self.require_version(&parent.model, parent.number);
                Some((parent.model, parent.number))
            }
            None => None,
        };
        self.add_inputs(head.model.as_str(), &head.law, &recipe).await?;
        let weights = model.branch.map(|branch| branch.weights_sha256);
        if let Some(hash) = &weights {
            self.add_object(hash).await?;
        }
        Ok(VersionRecord {
            parent,
            law: head.law.clone(),
            method: head.method.clone(),
            sha256: head.sha256.clone(),
            document: version.document.clone(),
            weights,
            reports: self.version_reports(&head.id).await?,
        })
    }

    fn require_version(&mut self, line: &str, number: i64) {
        // All versions before the needed one follow, because numbers must have no gaps.
        let last = self.needed.entry(line.to_owned()).or_default();
        *last = number.max(*last);
    }

    /// Adds the laws, libraries of effects and samples that a recipe names.
    async fn add_inputs(&mut self, ship: &str, law: &str, recipe: &DerivationRecipe) -> Result<()> {
        let store = &self.archive.store;
        let mut laws = BTreeSet::from([law.to_owned()]);
        // A refinement across laws also reads the law of its source.
        if let DerivationRecipe::Plain(version::VersionRecipe::Refinement {
            across: Some(across),
            ..
        }) = recipe
        {
            laws.insert(across.law.clone());
        }
        for name in laws {
            let text = store.laws().get(&name).await?.document;
            self.bundle.content.laws.insert(name, text);
        }
        if let Some(hash) = recipe.effects_sha256() {
            let library = store.effect_libraries().get(hash).await?.document;
            if !self.bundle.content.effects.contains(&library) {
                self.bundle.content.effects.push(library);
            }
        }
        for trial in recipe.trials() {
            self.add_object(&trial.sha256).await?;
            match store.trials().find_by_hash(ship, &trial.sha256).await {
                Ok(row) => self.add_trial(row),
                // The trial was deleted or belongs to another ship: the recipe needs only its
                // samples.
                Err(StoreError::NotFound { .. }) => {}
                Err(error) => return Err(error.into()),
            }
        }
        Ok(())
    }

    async fn add_object(&mut self, hash: &str) -> Result<()> {
        if !self.bundle.objects.contains_key(hash) {
            let bytes = self.archive.objects.get(hash).await?;
            self.bundle.objects.insert(hash.to_owned(), bytes);
        }
        Ok(())
    }

    fn add_trial(&mut self, row: Trial) {
        let record = TrialRecord {
            ship: row.ship,
            sha256: row.sha256,
            name: row.name,
            manifest: row.manifest,
            conventions: row.conventions,
            manoeuvre: row.manoeuvre,
            sample_rows: row.sample_rows,
            duration_s: row.duration_s,
            warnings: row.warnings,
        };
        let known = &mut self.bundle.content.trials;
        if !known.iter().any(|one| one.ship == record.ship && one.sha256 == record.sha256) {
            known.push(record);
        }
    }

    /// Returns the reports on a version, oldest first.
    async fn version_reports(&self, version: &str) -> Result<Vec<ReportRecord>> {
        let reports = self.archive.store.reports();
        let heads =
            read_all_pages(|page| async move { reports.by_version(version, &page).await }).await?;
        let mut all = Vec::new();
        // The store lists the newest first.
        for head in heads.iter().rev() {
            let report = reports.get(&head.id).await?;
            let (kind, document, html) = (report.head.kind, report.document, report.html);
            all.push(ReportRecord { kind, document, html });
        }
        Ok(all)
    }

    async fn add_ships(&mut self) -> Result<()> {
        for name in self.needed.keys().cloned().collect::<Vec<_>>() {
            let revisions = ship_revisions(self.archive, &name).await?;
            self.bundle.content.ships.push(ShipRecord { name, revisions });
        }
        Ok(())
    }

    /// Adds every trial of the ship, also those that no version was derived from.
    async fn add_trials(&mut self, ship: &str) -> Result<()> {
        for row in all_trials(&self.archive.store, ship).await? {
            self.add_object(&row.object_key).await?;
            self.add_trial(row);
        }
        Ok(())
    }

    async fn add_aliases(&mut self, ship: &str) -> Result<()> {
        let aliases = self.archive.store.aliases();
        let aliases = read_all_pages(|page| async move { aliases.list(ship, &page).await }).await?;
        let places = aliases.into_iter().map(|alias| (alias.alias, alias.version_number));
        self.bundle.content.aliases.extend(places);
        Ok(())
    }
}
