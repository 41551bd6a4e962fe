//! Families of ships whose models share a foundation, and the priors learned from them.

use serde_json::json;

use crate::arguments::args;
use crate::checks;
use crate::database::AuditedTransaction;
use crate::error::{Result, StoreError};
use crate::objects::sha256_hex;
use crate::page::{ListPage, PageRequest};
use crate::record::{RowCount, record};
use crate::search::FactRange;
use crate::statements::{Statement, pair, same, statements};
use crate::store::Store;
use crate::version;

statements! {
    // A conflict on the name returns no row.
    INSERT = same("INSERT INTO families (name, title, foundation, created_us) VALUES ($1, $2, $3, \
        $4) ON CONFLICT (name) DO NOTHING RETURNING name, title, foundation, created_us");
    GET = same("SELECT name, title, foundation, created_us FROM families WHERE name = $1");
    LIST = same("SELECT name, title, foundation, created_us FROM families WHERE name > \
        COALESCE($1, '') ORDER BY name LIMIT $2");
    FOUND = same("UPDATE families SET foundation = $2 WHERE name = $1 RETURNING name, title, \
        foundation, created_us");
    OF_SHIP = same("SELECT f.name, f.title, f.foundation, f.created_us FROM family_members m JOIN \
        families f ON f.name = m.family WHERE m.ship = $1 AND m.family > COALESCE($2, '') ORDER BY \
        m.family LIMIT $3");
    // An existing member is no error and counts as no change.
    ADD = same("INSERT INTO family_members (family, ship, added_us) VALUES ($1, $2, $3) ON \
        CONFLICT (family, ship) DO NOTHING");
    REMOVE = same("DELETE FROM family_members WHERE family = $1 AND ship = $2");
    SHIP = same("SELECT COUNT(*) AS rows FROM ships WHERE name = $1 AND deleted_us IS NULL");
    COUNT = same("SELECT COUNT(*) AS rows FROM family_members m JOIN ships s ON s.name = m.ship \
        WHERE m.family = $1 AND s.deleted_us IS NULL");
    // Outer joins: members without a champion are listed too; deleted ships are not.
    MEMBERS = same("SELECT m.ship, m.added_us, v.number AS champion, v.method FROM family_members \
        m JOIN ships s ON s.name = m.ship AND s.deleted_us IS NULL \
        LEFT JOIN aliases a ON a.model = m.ship AND a.alias = 'champion' \
        LEFT JOIN versions v ON v.model = a.model AND v.number = a.version_number \
        WHERE m.family = $1 AND m.ship > COALESCE($2, '') ORDER BY m.ship LIMIT $3");
    // Inner joins: a member without a champion or without the fact is no result.
    WITHIN = same("SELECT m.ship, m.added_us, v.number AS champion, v.method FROM family_members \
        m JOIN ships s ON s.name = m.ship AND s.deleted_us IS NULL \
        JOIN aliases a ON a.model = m.ship AND a.alias = 'champion' \
        JOIN versions v ON v.model = a.model AND v.number = a.version_number \
        JOIN ship_facts f ON f.ship = m.ship AND f.fact = $2 AND f.value >= $3 AND f.value <= $4 \
        WHERE m.family = $1 ORDER BY m.ship LIMIT $5");
    // On SQLite the one writer holds the whole database already.
    LOCK = pair(
        "SELECT name, title, foundation, created_us FROM families WHERE name = $1",
        "SELECT name, title, foundation, created_us FROM families WHERE name = $1 FOR NO KEY UPDATE",
    );
    // The next revision is computed by the insertion itself, under the lock of the family.
    TEACH = same("INSERT INTO family_priors (family, revision, document, sha256, created_us) \
        SELECT $1, COALESCE(MAX(revision), 0) + 1, $2, $3, $4 FROM family_priors WHERE family = $1 \
        RETURNING family, revision, document, sha256, created_us");
    PRIOR = same("SELECT family, revision, document, sha256, created_us FROM family_priors WHERE \
        family = $1 AND revision = $2");
    LAST_PRIOR = same("SELECT family, revision, document, sha256, created_us FROM family_priors \
        WHERE family = $1 ORDER BY revision DESC LIMIT 1");
}

record! {
    /// A family.
    pub struct Family {
        /// Its name, for ever.
        pub name: String,
        /// Display title.
        pub title: String,
        /// Id of the version from which the models of its members start.
        pub foundation: String,
        /// When it was made.
        pub created_us: i64,
    }
}

record! {
    /// A member of a family.
    pub struct FamilyMember {
        /// The ship.
        pub ship: String,
        /// Start of the membership, microseconds since 1970.
        pub added_us: i64,
        /// The number of its champion, if it has one.
        pub champion: Option<i64>,
        /// Method by which the champion was made.
        pub method: Option<String>,
    }
}

record! {
    /// A prior learned from the members of a family.
    pub struct FamilyPrior {
        /// The family.
        pub family: String,
        /// Revision of the prior: 1, 2, 3, ...
        pub revision: i64,
        /// Means and covariances, JSON.
        pub document: String,
        /// The hash of the document.
        pub sha256: String,
        /// Time of learning, microseconds since 1970.
        pub created_us: i64,
    }
}

/// Repository of families.
#[derive(Debug, Clone, Copy)]
pub struct FamilyRepository<'a>(pub(crate) &'a Store);

impl Store {
    /// Returns the repository of families.
    pub fn families(&self) -> FamilyRepository<'_> {
        FamilyRepository(self)
    }
}

impl FamilyRepository<'_> {
    /// Creates a family on the version `foundation`.
    pub async fn create(&self, name: &str, title: &str, foundation: &str) -> Result<Family> {
        checks::check_name("name", name)?;
        let mut tx = self.0.begin().await?;
        version::check_id(&mut tx, "foundation", foundation).await?;
        let values =
            args![name: name, title: title, foundation: foundation, created_us: self.0.now_us()];
        let family = tx.fetch_optional(INSERT, values).await?;
        let family = family
            .ok_or_else(|| StoreError::conflict("family", name, "this name exists already"))?;
        let after = json!({ "foundation": foundation });
        tx.record_audit_event(
            self.0.now_us(),
            "family.create",
            audit_subject(name),
            None,
            Some(after),
        );
        tx.commit().await?;
        Ok(family)
    }

    /// A family.
    pub async fn get(&self, name: &str) -> Result<Family> {
        let family = self.0.database().fetch_optional(GET, args![name: name]).await?;
        family.ok_or_else(|| StoreError::not_found("family", name))
    }

    /// The families by name.
    pub async fn list(&self, page: &PageRequest) -> Result<ListPage<Family>> {
        let families = self
            .0
            .database()
            .fetch_all(LIST, args![after: &page.after, limit: page.fetch_limit()?])
            .await?;
        Ok(page.build_page(families, |family: &Family| family.name.clone()))
    }

    /// Sets another foundation of a family.
    pub async fn set_foundation(&self, name: &str, foundation: &str) -> Result<Family> {
        let mut tx = self.0.begin().await?;
        version::check_id(&mut tx, "foundation", foundation).await?;
        let before: Option<Family> = tx.fetch_optional(GET, args![name: name]).await?;
        let family = tx.fetch_optional(FOUND, args![name: name, foundation: foundation]).await?;
        let family = family.ok_or_else(|| StoreError::not_found("family", name))?;
        let before = before.map(|family| json!({ "foundation": family.foundation }));
        let after = json!({ "foundation": foundation });
        tx.record_audit_event(
            self.0.now_us(),
            "family.found",
            audit_subject(name),
            before,
            Some(after),
        );
        tx.commit().await?;
        Ok(family)
    }

    /// Adds ships, all or none; existing members are skipped. Returns the number of new members.
    pub async fn add_members(&self, family: &str, ships: &[String]) -> Result<u64> {
        let mut tx = self.0.begin().await?;
        require_family(&mut tx, GET, family).await?;
        let mut added = Vec::new();
        for ship in ships {
            // Checked here and not by the foreign key: a deleted ship still has a row.
            let RowCount { rows } = tx.fetch_one(SHIP, args![name: ship]).await?;
            if rows == 0 {
                return Err(StoreError::invalid("ships", format!("there is no ship `{ship}`")));
            }
            let values = args![family: family, ship: ship, added_us: self.0.now_us()];
            if tx.execute(ADD, values).await? > 0 {
                added.push(ship.as_str());
            }
        }
        if !added.is_empty() {
            let after = json!({ "ships": added });
            tx.record_audit_event(
                self.0.now_us(),
                "family.add",
                audit_subject(family),
                None,
                Some(after),
            );
        }
        tx.commit().await?;
        Ok(added.len() as u64)
    }

    /// Removes a ship from a family; returns true if it was a member.
    pub async fn remove_member(&self, family: &str, ship: &str) -> Result<bool> {
        let mut tx = self.0.begin().await?;
        let removed = tx.execute(REMOVE, args![family: family, ship: ship]).await?;
        if removed > 0 {
            let before = json!({ "ships": [ship] });
            tx.record_audit_event(
                self.0.now_us(),
                "family.remove",
                audit_subject(family),
                Some(before),
                None,
            );
        }
        tx.commit().await?;
        Ok(removed > 0)
    }

    /// Counts the members of a family.
    pub async fn count_members(&self, family: &str) -> Result<i64> {
        let counted: Option<RowCount> =
            self.0.database().fetch_optional(COUNT, args![family: family]).await?;
        Ok(counted.map_or(0, |counted| counted.rows))
    }

    /// The families that a ship is a member of, by name.
    pub async fn list_by_ship(&self, ship: &str, page: &PageRequest) -> Result<ListPage<Family>> {
        let all = args![ship: ship, after: &page.after, limit: page.fetch_limit()?];
        let found = self.0.database().fetch_all(OF_SHIP, all).await?;
        Ok(page.build_page(found, |family: &Family| family.name.clone()))
    }

    /// The members by name.
    pub async fn list_members(
        &self,
        family: &str,
        page: &PageRequest,
    ) -> Result<ListPage<FamilyMember>> {
        let values = args![family: family, after: &page.after, limit: page.fetch_limit()?];
        let members = self.0.database().fetch_all(MEMBERS, values).await?;
        Ok(page.build_page(members, |member: &FamilyMember| member.ship.clone()))
    }

    /// Members that have a champion and a fact in a range, by name.
    pub async fn members_in_range(
        &self,
        family: &str,
        range: &FactRange,
        limit: i64,
    ) -> Result<Vec<FamilyMember>> {
        let values = args![family: family, fact: &range.fact, min: range.min, max: range.max,
            limit: limit];
        self.0.database().fetch_all(WITHIN, values).await
    }

    /// Stores a prior as the next revision of the family.
    pub async fn insert_prior(&self, family: &str, document: &str) -> Result<FamilyPrior> {
        let mut tx = self.0.begin().await?;
        let prior = insert_prior_row(self.0, &mut tx, family, document).await?;
        tx.commit().await?;
        Ok(prior)
    }

    /// Returns a prior of a family: of a revision, or the latest one.
    pub async fn get_prior(&self, family: &str, revision: Option<i64>) -> Result<FamilyPrior> {
        let prior = match revision {
            Some(revision) => {
                self.0
                    .database()
                    .fetch_optional(PRIOR, args![family: family, revision: revision])
                    .await?
            }
            None => self.0.database().fetch_optional(LAST_PRIOR, args![family: family]).await?,
        };
        prior.ok_or_else(|| StoreError::not_found("family prior", family))
    }
}

/// Stores a prior within a transaction.
pub(crate) async fn insert_prior_row(
    store: &Store,
    tx: &mut AuditedTransaction,
    family: &str,
    document: &str,
) -> Result<FamilyPrior> {
    checks::check_json("document", document)?;
    // Two priors at the same time get one revision after the other, not the same one.
    require_family(tx, LOCK, family).await?;
    let sha256 = sha256_hex(document.as_bytes());
    let values =
        args![family: family, document: document, sha256: &sha256, created_us: store.now_us()];
    let prior: FamilyPrior = tx.fetch_one(TEACH, values).await?;
    let after = json!({ "revision": prior.revision, "sha256": sha256 });
    tx.record_audit_event(store.now_us(), "family.prior", audit_subject(family), None, Some(after));
    Ok(prior)
}

/// Returns the subject of audit entries about a family.
fn audit_subject(name: &str) -> String {
    format!("family:{name}")
}

/// Checks that there is a family, by a statement that reads or locks it.
async fn require_family(
    tx: &mut AuditedTransaction,
    statement: Statement,
    name: &str,
) -> Result<()> {
    let family: Option<Family> = tx.fetch_optional(statement, args![name: name]).await?;
    family.map(drop).ok_or_else(|| StoreError::not_found("family", name))
}

impl FamilyRepository<'_> {
    /// Stores a prior and completes the job that learned it, all or nothing. `result` writes the
    /// job's result, JSON.
    pub async fn commit_prior(
        &self,
        family: &str,
        document: &str,
        job: (&str, i64),
        result: impl FnOnce(&FamilyPrior) -> String,
    ) -> Result<FamilyPrior> {
        let mut tx = self.0.begin().await?;
        let prior = insert_prior_row(self.0, &mut tx, family, document).await?;
        crate::work::complete_job(&mut tx, job.0, job.1, &result(&prior), self.0.now_us()).await?;
        tx.commit().await?;
        Ok(prior)
    }
}
