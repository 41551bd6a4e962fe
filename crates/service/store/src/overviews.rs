//! State of all ships on a page of the fleet list, in a few statements: one ship at a time, a page
//! of fifty would take hundreds.

use std::collections::BTreeMap;

use crate::arguments::{args, names_list};
use crate::diagnoses::DiagnosisRow;
use crate::error::Result;
use crate::record::record;
use crate::statements::{pair, statements};
use crate::store::Store;
use crate::version::{Version, VersionHead};

/// A statement about the names in `$1`, a JSON list, which it reads first.
macro_rules! of_names {
    ($columns:literal, $joined:literal) => {
        pair(
            concat!("SELECT ", $columns, " FROM json_each($1) n CROSS JOIN ", $joined),
            concat!(
                "SELECT ",
                $columns,
                " FROM json_array_elements_text(CAST($1 AS JSON)) AS n(value) CROSS JOIN ",
                $joined
            ),
        )
    };
}

statements! {
    CHAMPIONS = of_names!(
        "v.id, v.model, v.number, v.parent, v.law, v.method, v.sha256, v.created_us, v.author",
        "aliases a CROSS JOIN versions v WHERE a.model = n.value AND a.alias = 'champion' \
        AND v.model = a.model AND v.number = a.version_number"
    );
    CHAMPION_DOCUMENTS = of_names!(
        "v.id, v.model, v.number, v.parent, v.law, v.method, v.document, v.sha256, v.created_us, \
        v.author",
        "aliases a CROSS JOIN versions v WHERE a.model = n.value AND a.alias = 'champion' \
        AND v.model = a.model AND v.number = a.version_number"
    );
    // A diagnosis concerns the diagnosed version, and the one that resulted from it.
    DIAGNOSES = pair(
        "SELECT n.value AS concerns, d.id, d.version_id, d.made_id, d.report_id, d.verdict, \
        d.effects, d.trials, d.unexplained, d.drift, d.created_us \
        FROM json_each($1) n CROSS JOIN diagnoses d WHERE d.id IN (SELECT x.id FROM \
        (SELECT s.id FROM diagnoses s WHERE s.version_id = n.value \
        UNION ALL SELECT m.id FROM diagnoses m WHERE m.made_id = n.value) x ORDER BY x.id DESC \
        LIMIT 200) ORDER BY n.value, d.id DESC",
        "SELECT n.value AS concerns, d.id, d.version_id, d.made_id, d.report_id, d.verdict, \
        d.effects, d.trials, d.unexplained, d.drift, d.created_us \
        FROM json_array_elements_text(CAST($1 AS JSON)) AS n(value) CROSS JOIN LATERAL (SELECT * \
        FROM ((SELECT s.* FROM diagnoses s WHERE s.version_id = n.value ORDER BY s.id DESC LIMIT \
        200) UNION ALL \
        (SELECT m.* FROM diagnoses m WHERE m.made_id = n.value ORDER BY m.id DESC LIMIT 200)) x \
        ORDER BY x.id DESC LIMIT 200) d ORDER BY n.value, d.id DESC"
    );
    DELETED = pair(
        "SELECT t.id FROM json_each($1) n CROSS JOIN trials t WHERE t.id = n.value AND \
        t.deleted_us IS NOT NULL",
        "SELECT t.id FROM json_array_elements_text(CAST($1 AS JSON)) AS n(value) CROSS JOIN \
        LATERAL (SELECT o.id FROM trials o WHERE o.id = n.value AND o.deleted_us IS NOT NULL LIMIT \
        1) t"
    );
    FACTS = of_names!("f.ship, f.value", "ship_facts f WHERE f.ship = n.value AND f.fact = $2");
    // Here and below, a limit keeps PostgreSQL from joining all rows.
    SERIES = pair(
        "SELECT f.ship, f.value FROM json_each($1) n CROSS JOIN ship_facts f \
        WHERE f.ship = n.value AND f.fact >= $2 AND f.fact < $3 ORDER BY f.ship, f.fact",
        "SELECT f.ship, f.value FROM json_array_elements_text(CAST($1 AS JSON)) AS n(value) \
        CROSS JOIN LATERAL (SELECT o.ship, o.fact, o.value FROM ship_facts o WHERE o.ship = \
        n.value AND o.fact >= $2 AND o.fact < $3 ORDER BY o.fact LIMIT 1000) f ORDER BY f.ship, \
        f.fact"
    );
    FAMILIES = pair(
        "SELECT m.ship, m.family FROM json_each($1) n CROSS JOIN family_members m \
        WHERE m.ship = n.value ORDER BY m.ship, m.family",
        "SELECT m.ship, m.family FROM json_array_elements_text(CAST($1 AS JSON)) AS n(value) \
        CROSS JOIN LATERAL (SELECT o.ship, o.family FROM family_members o WHERE o.ship = n.value \
        ORDER BY o.family LIMIT 1000) m ORDER BY m.ship, m.family"
    );
}

/// State of a ship in the fleet list.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ShipOverview {
    /// Its champion.
    pub champion: Option<VersionHead>,
    /// The latest diagnoses of the champion, or from which it resulted, at most 200, the latest
    /// first.
    pub diagnoses: Vec<DiagnosisRow>,
    /// Value of the requested fact.
    pub fact: Option<f64>,
    /// Values of the facts with the requested prefix, ordered by name.
    pub series: Vec<f64>,
    /// Names of its families.
    pub families: Vec<String>,
}

record! {
    /// A diagnosis with the version that it concerns.
    pub struct VersionDiagnosis {
        flatten head: DiagnosisRow,
        /// The version's id.
        pub concerns: String,
    }
}

record! {
    /// A trial's id.
    pub struct TrialId {
        /// The id.
        pub id: String,
    }
}

record! {
    /// A fact's value.
    pub struct FactValue {
        /// The ship.
        pub ship: String,
        /// The value.
        pub value: f64,
    }
}

record! {
    /// Membership of a ship in a family.
    pub struct FamilyMembership {
        /// The ship.
        pub ship: String,
        /// The family.
        pub family: String,
    }
}

impl Store {
    /// Returns the champions of these ships with their documents; ships without one are skipped.
    pub async fn list_champions(&self, ships: &[String]) -> Result<Vec<Version>> {
        self.database().fetch_all(CHAMPION_DOCUMENTS, args![names: &names_list(ships)]).await
    }

    /// Returns the values of a fact by ship; ships without it are skipped.
    pub async fn fact_values(&self, ships: &[String], fact: &str) -> Result<BTreeMap<String, f64>> {
        let names = names_list(ships);
        let values = args![names: &names, fact: fact];
        let facts: Vec<FactValue> = self.database().fetch_all(FACTS, values).await?;
        Ok(facts.into_iter().map(|fact| (fact.ship, fact.value)).collect())
    }

    /// Returns the ids of those of the trials that are deleted.
    pub async fn deleted_trials(&self, ids: &[String]) -> Result<Vec<String>> {
        let found: Vec<TrialId> =
            self.database().fetch_all(DELETED, args![ids: &names_list(ids)]).await?;
        Ok(found.into_iter().map(|trial| trial.id).collect())
    }

    /// Returns the state of each ship, with the value of one fact and of all facts whose names
    /// begin with `series`; a ship without data has an empty state.
    pub async fn ship_overviews(
        &self,
        ships: &[String],
        fact: &str,
        series: &str,
    ) -> Result<BTreeMap<String, ShipOverview>> {
        let (database, names) = (self.database(), names_list(ships));
        // Every requested ship has an entry, also one without data.
        let empty = |ship: &String| (ship.clone(), ShipOverview::default());
        let mut all: BTreeMap<String, ShipOverview> = ships.iter().map(empty).collect();
        let champions: Vec<VersionHead> =
            database.fetch_all(CHAMPIONS, args![names: &names]).await?;
        let ids: Vec<String> = champions.iter().map(|champion| champion.id.clone()).collect();
        let concerning: Vec<VersionDiagnosis> =
            database.fetch_all(DIAGNOSES, args![ids: &names_list(&ids)]).await?;
        let mut diagnoses: BTreeMap<String, Vec<DiagnosisRow>> = BTreeMap::new();
        // The statement has sorted them, the latest first for each version.
        for VersionDiagnosis { head, concerns } in concerning {
            diagnoses.entry(concerns).or_default().push(head);
        }
        for champion in champions {
            if let Some(standing) = all.get_mut(&champion.model) {
                standing.diagnoses = diagnoses.remove(&champion.id).unwrap_or_default();
                standing.champion = Some(champion);
            }
        }
        let facts: Vec<FactValue> =
            database.fetch_all(FACTS, args![names: &names, fact: fact]).await?;
        for FactValue { ship, value } in facts {
            all.entry(ship).and_modify(|standing| standing.fact = Some(value));
        }
        // Names of facts consist of letters, digits and spaces, all of which sort before `~`.
        let end = format!("{series}~");
        let of_series = args![names: &names, from: series, before: &end];
        for FactValue { ship, value } in database.fetch_all(SERIES, of_series).await? {
            all.entry(ship).and_modify(|standing| standing.series.push(value));
        }
        let families: Vec<FamilyMembership> =
            database.fetch_all(FAMILIES, args![names: &names]).await?;
        for FamilyMembership { ship, family } in families {
            all.entry(ship).and_modify(|standing| standing.families.push(family));
        }
        Ok(all)
    }
}
