//! Import of a bundle into an archive.
//!
//! Everything is checked before anything is written. Rows are only added and existing ones stay as
//! they are, so that an import that was interrupted can be repeated.

use serde::Serialize;
use sistership_model::version::sha256_hex;
use sistership_store::{ExpectedRevision, NewReport, NewShip, NewTrial, NewVersion, Version};

use super::content::{
    Bundle, BundleContent, ReportRecord, ShipRecord, ShipRevision, VersionRecord,
};
use super::error::BundleError;
use super::history::{optional, ship_revisions};
use crate::aliases::{LATEST, server_move};
use crate::archive::Archive;

type Result<T> = std::result::Result<T, BundleError>;

/// Result of an import: the rows that are new to the archive.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize)]
pub struct BundleImport {
    /// The ship.
    pub ship: String,
    /// New ships.
    pub ships: Vec<String>,
    /// New versions, `ship/number`.
    pub versions: Vec<String>,
    /// Number of new trials.
    pub trials: usize,
    /// Number of versions of the bundle that the archive had already.
    pub known: usize,
}

/// Imports a bundle.
///
/// # Errors
/// Returns an error that names everything in the archive that contradicts the bundle; nothing is
/// written then.
pub async fn import_bundle(archive: &Archive, bundle: &Bundle) -> Result<BundleImport> {
    let content = &bundle.content;
    let conflicts = find_conflicts(archive, content).await?;
    if !conflicts.is_empty() {
        return Err(BundleError::Conflicts(conflicts));
    }
    let mut taken = BundleImport { ship: content.ship.clone(), ..BundleImport::default() };
    for (name, text) in &content.laws {
        archive.store.laws().insert(name, text).await?;
    }
    for library in &content.effects {
        archive.store.effect_libraries().insert_absent(library).await?;
    }
    for ship in &content.ships {
        taken.ships.extend(import_ship(archive, ship).await?.then(|| ship.name.clone()));
    }
    // Objects are durable before the rows of trials and versions that refer to them.
    for bytes in bundle.objects.values() {
        archive.objects.put(bytes.clone()).await?;
    }
    taken.trials = import_trials(archive, content).await?;
    import_versions(archive, content, &mut taken).await?;
    import_aliases(archive, content).await?;
    Ok(taken)
}

/// Lists rows of the archive that have the same name and other content.
async fn find_conflicts(archive: &Archive, content: &BundleContent) -> Result<Vec<String>> {
    let mut all = Vec::new();
    for (name, text) in &content.laws {
        let known = optional(archive.store.laws().get(name).await)?;
        if known.is_some_and(|law| law.sha256 != sha256_hex(text.as_bytes())) {
            all.push(format!("the law `{name}` differs from that in this store"));
        }
    }
    for ship in &content.ships {
        let known = ship_revisions(archive, &ship.name).await?;
        // One history may be longer than the other; the common part must agree.
        if known.iter().zip(&ship.revisions).any(|(here, there)| here.document != there.document) {
            all.push(format!("the ship `{}` has a different history in this store", ship.name));
        }
    }
    for (line, number, version) in content.versions() {
        let known = optional(archive.store.versions().get(line, number).await)?;
        if known.is_some_and(|known| known.head.sha256 != version.sha256) {
            all.push(format!("version {line}/{number} differs from that in this store"));
        }
    }
    Ok(all)
}

/// Adds the revisions of a ship that are missing; returns true if the ship is new.
async fn import_ship(archive: &Archive, ship: &ShipRecord) -> Result<bool> {
    let known = ship_revisions(archive, &ship.name).await?.len();
    for (before, revision) in ship.revisions.iter().enumerate().skip(known) {
        // Revisions are added one by one, so that the archive has the same history.
        let ShipRevision { title, category, document } = revision.clone();
        let new = NewShip { name: ship.name.clone(), title, category, document };
        match before {
            0 => archive.store.ships().create(&new).await?,
            before => archive.store.ships().update(&new, before as i64).await?,
        };
    }
    Ok(known == 0)
}

async fn import_trials(archive: &Archive, content: &BundleContent) -> Result<usize> {
    let new = |trial: &super::content::TrialRecord| NewTrial {
        ship: trial.ship.clone(),
        sha256: trial.sha256.clone(),
        name: trial.name.clone(),
        manifest: trial.manifest.clone(),
        conventions: trial.conventions.clone(),
        manoeuvre: trial.manoeuvre.clone(),
        sample_rows: trial.sample_rows,
        duration_s: trial.duration_s,
        warnings: trial.warnings.clone(),
        object_key: trial.sha256.clone(),
    };
    let all: Vec<NewTrial> = content.trials.iter().map(new).collect();
    let inserted = archive.store.trials().insert_all(&all).await?;
    Ok(inserted.iter().filter(|trial| trial.new).count())
}

/// Creates the versions that are missing, parents first: each pass creates those whose parent
/// exists.
async fn import_versions(
    archive: &Archive,
    content: &BundleContent,
    taken: &mut BundleImport,
) -> Result<()> {
    let mut open: Vec<(&str, i64, &VersionRecord)> = content.versions().collect();
    while !open.is_empty() {
        let (mut later, before) = (Vec::new(), open.len());
        for (line, number, version) in open {
            let name = format!("{line}/{number}");
            if optional(archive.store.versions().get(line, number).await)?.is_some() {
                taken.known += 1;
            } else if let Some(parent) = resolve_parent(archive, line, number, version).await? {
                import_version(archive, (line, number), version, parent).await?;
                taken.versions.push(name);
            } else {
                later.push((line, number, version));
            }
        }
        // A pass without progress: a parent is neither in the bundle nor in the archive.
        if later.len() == before {
            let (line, number, _) = later[0];
            return Err(BundleError::File(format!("lacks the inputs of {line}/{number}")));
        }
        open = later;
    }
    Ok(())
}

/// Returns the id of the parent, `Some(None)` for a version without parent, or `None` while the
/// parent or the preceding version is missing.
async fn resolve_parent(
    archive: &Archive,
    line: &str,
    number: i64,
    version: &VersionRecord,
) -> Result<Option<Option<String>>> {
    let at = async |line: &str, number: i64| -> Result<Option<Version>> {
        optional(archive.store.versions().get(line, number).await)
    };
    if number > 1 && at(line, number - 1).await?.is_none() {
        return Ok(None);
    }
    match &version.parent {
        None => Ok(Some(None)),
        Some((line, number)) => Ok(at(line, *number).await?.map(|parent| Some(parent.head.id))),
    }
}

async fn import_version(
    archive: &Archive,
    (line, number): (&str, i64),
    version: &VersionRecord,
    parent: Option<String>,
) -> Result<()> {
    let new = NewVersion {
        model: line.to_owned(),
        parent,
        law: version.law.clone(),
        method: version.method.clone(),
        document: version.document.clone(),
        weights: version.weights.clone(),
    };
    let follow = server_move(LATEST, ExpectedRevision::Any, "bundle");
    // The store assigns the number; a concurrent writer can have taken the expected one.
    let made = archive.store.versions().create(&new, &[follow]).await?;
    if (made.number, &made.sha256) != (number, &version.sha256) {
        let message = format!(
            "{line}/{number} became {line}/{}: another process writes to this \
                               ship; import again",
            made.number
        );
        return Err(BundleError::File(message));
    }
    for ReportRecord { kind, document, html } in version.reports.clone() {
        let (version_id, ship) = (Some(made.id.clone()), line.to_owned());
        archive
            .store
            .reports()
            .insert(&NewReport { version_id, ship, kind, document, html })
            .await?;
    }
    Ok(())
}

/// Sets the aliases of the ship that are missing; existing ones are not moved.
async fn import_aliases(archive: &Archive, content: &BundleContent) -> Result<()> {
    // `latest` follows the versions by itself.
    for (alias, number) in content.aliases.iter().filter(|(alias, _)| *alias != LATEST) {
        if optional(archive.store.aliases().get(&content.ship, alias).await)?.is_none() {
            let change = server_move(alias, ExpectedRevision::Absent, "bundle");
            archive.store.aliases().move_to(&content.ship, *number, &change).await?;
        }
    }
    Ok(())
}
