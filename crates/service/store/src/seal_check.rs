//! Check of the protected rows against their seals in the audit.

use crate::arguments::args;
use crate::error::Result;
use crate::integrity::IntegrityFault;
use crate::record::record;
use crate::row_seal::{KINDS, seal_rows, sealed_kind};
use crate::statements::{Statement, same, statements};
use crate::store::Store;

statements! {
    LATEST = same("SELECT row_sha256 FROM audit WHERE subject = $1 AND row_sha256 IS NOT NULL \
        ORDER BY number DESC LIMIT 1");
    // The subjects of the audit whose rows are gone.
    SEALED = same("SELECT DISTINCT subject AS name FROM audit WHERE row_sha256 IS NOT NULL \
        AND subject > $1 ORDER BY subject LIMIT 500");
}

record! {
    /// Name of a row, or subject of the audit.
    pub struct SealedName {
        /// The name.
        pub name: String,
    }
}

record! {
    /// Seal of an audit entry.
    pub struct StatedSeal {
        /// SHA-256 of the protected columns.
        pub row_sha256: Option<String>,
    }
}

impl Store {
    /// Compares every protected row with the seal in the audit; returns all faults. Rows may change
    /// meanwhile.
    pub async fn seal_faults(&self) -> Result<Vec<IntegrityFault>> {
        let mut faults = Vec::new();
        for kind in &KINDS {
            for name in self.all_names(kind.names).await? {
                faults.extend(self.unstated_fault(&format!("{}{name}", kind.prefix)).await?);
            }
        }
        faults.extend(self.unstated_fault("settings").await?);
        // By the audit, as a row that is gone has no name in the database.
        for subject in self.all_names(SEALED).await? {
            faults.extend(self.changed_fault(&subject).await?);
        }
        Ok(faults)
    }

    async fn all_names(&self, statement: Statement) -> Result<Vec<String>> {
        let mut names: Vec<String> = Vec::new();
        loop {
            let after = names.last().map_or("", String::as_str);
            let page: Vec<SealedName> =
                self.database().fetch_all(statement, args![after: after]).await?;
            if page.is_empty() {
                return Ok(names);
            }
            names.extend(page.into_iter().map(|row| row.name));
        }
    }

    async fn present_seal(&self, subject: &str) -> Result<Option<String>> {
        let Some((kind, name)) = sealed_kind(subject) else { return Ok(None) };
        Ok(seal_rows(self.database().fetch_all(kind.rows, args![name: name]).await?))
    }

    /// Returns the fault of a row that no entry of the audit is about.
    async fn unstated_fault(&self, subject: &str) -> Result<Option<IntegrityFault>> {
        // The row is read first: its entry comes with the same commit.
        let present = self.present_seal(subject).await?;
        let unstated = present.is_some() && self.stated_seal(subject).await?.is_none();
        Ok(unstated.then(|| seal_fault(subject, "is not in the audit")))
    }

    /// Returns the fault of a row that is not as the audit states.
    async fn changed_fault(&self, subject: &str) -> Result<Option<IntegrityFault>> {
        let mut message = "";
        // A change between the two reads shows as a fault, which a second look does not confirm.
        for _ in 0..2 {
            let (present, stated) =
                (self.present_seal(subject).await?, self.stated_seal(subject).await?);
            message = match present {
                present if present == stated => return Ok(None),
                Some(_) => "is not what the last entry of the audit about it states",
                None => "is in the audit, but not in the database",
            };
        }
        Ok(Some(seal_fault(subject, message)))
    }

    async fn stated_seal(&self, subject: &str) -> Result<Option<String>> {
        let stated: Option<StatedSeal> =
            self.database().fetch_optional(LATEST, args![subject: subject]).await?;
        Ok(stated.and_then(|stated| stated.row_sha256))
    }
}

fn seal_fault(subject: &str, message: &str) -> IntegrityFault {
    IntegrityFault::new("audit-row", subject, message)
}
