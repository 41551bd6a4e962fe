//! What the list of a fleet says of its ships: of all that are on a page at once, for a page of
//! fifty would take hundreds of statements otherwise.

use std::collections::BTreeMap;

use crate::arguments::{args, names_list};
use crate::diagnoses::Diagnosed;
use crate::error::Result;
use crate::record::record;
use crate::statements::{pair, statements};
use crate::store::Store;
use crate::version::{Version, VersionHead};

/// A text about the names of `$1`, a JSON list, which it goes through first.
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
    // A diagnosis concerns the version that it is of, and the one that came of it.
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
    // Here and below a limit keeps PostgreSQL from joining all rows.
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

/// How a ship stands.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ShipStanding {
    /// The version that is its champion.
    pub champion: Option<VersionHead>,
    /// The newest diagnoses that the champion was subject or result of, at most 200, the latest
    /// first.
    pub diagnoses: Vec<Diagnosed>,
    /// The fact that was asked for.
    pub fact: Option<f64>,
    /// The facts whose names begin as was asked for, by name.
    pub series: Vec<f64>,
    /// The families that it belongs to, by name.
    pub families: Vec<String>,
}

record! {
    /// A diagnosis with the version that it concerns.
    pub struct Concerning {
        flatten head: Diagnosed,
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
    pub struct FactOf {
        /// The ship.
        pub ship: String,
        /// The value.
        pub value: f64,
    }
}

record! {
    /// That a ship belongs to a family.
    pub struct Membership {
        /// The ship.
        pub ship: String,
        /// The family.
        pub family: String,
    }
}

impl Store {
    /// The champions of those of these ships that have one, with their documents.
    pub async fn champions(&self, ships: &[String]) -> Result<Vec<Version>> {
        self.database().all(CHAMPION_DOCUMENTS, args![names: &names_list(ships)]).await
    }

    /// Which of these trials are deleted, by their ids.
    pub async fn deleted_trials(&self, ids: &[String]) -> Result<Vec<String>> {
        let found: Vec<TrialId> =
            self.database().all(DELETED, args![ids: &names_list(ids)]).await?;
        Ok(found.into_iter().map(|trial| trial.id).collect())
    }

    /// How each of these ships stands, with one of its facts, and those whose names begin like
    /// `series`; one of which nothing is known has an empty standing.
    pub async fn standings(
        &self,
        ships: &[String],
        fact: &str,
        series: &str,
    ) -> Result<BTreeMap<String, ShipStanding>> {
        let (database, names) = (self.database(), names_list(ships));
        let empty = |ship: &String| (ship.clone(), ShipStanding::default());
        let mut all: BTreeMap<String, ShipStanding> = ships.iter().map(empty).collect();
        let champions: Vec<VersionHead> = database.all(CHAMPIONS, args![names: &names]).await?;
        let ids: Vec<String> = champions.iter().map(|champion| champion.id.clone()).collect();
        let concerning: Vec<Concerning> =
            database.all(DIAGNOSES, args![ids: &names_list(&ids)]).await?;
        let mut diagnoses: BTreeMap<String, Vec<Diagnosed>> = BTreeMap::new();
        for Concerning { head, concerns } in concerning {
            diagnoses.entry(concerns).or_default().push(head);
        }
        for champion in champions {
            if let Some(standing) = all.get_mut(&champion.model) {
                standing.diagnoses = diagnoses.remove(&champion.id).unwrap_or_default();
                standing.champion = Some(champion);
            }
        }
        let facts: Vec<FactOf> = database.all(FACTS, args![names: &names, fact: fact]).await?;
        for FactOf { ship, value } in facts {
            all.entry(ship).and_modify(|standing| standing.fact = Some(value));
        }
        // Names are of letters, digits and spaces, all of which come before this.
        let end = format!("{series}~");
        let of_series = args![names: &names, from: series, before: &end];
        for FactOf { ship, value } in database.all(SERIES, of_series).await? {
            all.entry(ship).and_modify(|standing| standing.series.push(value));
        }
        let families: Vec<Membership> = database.all(FAMILIES, args![names: &names]).await?;
        for Membership { ship, family } in families {
            all.entry(ship).and_modify(|standing| standing.families.push(family));
        }
        Ok(all)
    }
}
