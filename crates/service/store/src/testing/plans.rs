//! Query plans of all statements: none may read a whole table.

use serde_json::Value;
use sqlx::{AssertSqlSafe, Executor as _, PgConnection, PgPool, Row as _, SqlitePool};

use crate::connections::DatabaseWriter;
use crate::error::{Result, StoreError};
use crate::statements::{ALL, Statement};
use crate::store::Store;

/// Statements that may read all rows, with reasons.
const MAY: &[(&str, &str)] = &[
    // Checks of the whole store.
    ("integrity", ""),
    // Counts all jobs, from the index by kind and state.
    ("jobs", "COUNTS"),
    // Administrators create webhooks: they are few.
    ("webhooks", "RECEIVERS"),
    // Read by a check of the whole store.
    ("seal_check", "SEALED"),
    // One row for each setting.
    ("row_seal", "SETTINGS"),
    // No queries.
    ("garbage", "HOLD"),
    ("garbage", "LOCK"),
];
/// Plan steps of lists that a statement has made itself.
const FEW: [&str; 8] =
    ["SCAN few", "SCAN a", "SCAN waiting", "SCAN line", "SCAN p", "SCAN w", "SCAN t", "SCAN r"];
/// Beginning of the plan step of a query within a statement.
const WITHIN: &str = "SCAN (subquery";
/// Plan step of a list that is an argument of the statement.
const GIVEN: &str = "SCAN n VIRTUAL TABLE";
/// An index of the queued and running jobs only, read in its order.
const SHORT: &str = "jobs_to_claim";

impl Store {
    /// Returns every statement whose plan reads all rows of a table unexpectedly, with the step
    /// that does.
    pub async fn full_scans(&self) -> Result<Vec<String>> {
        let mut found = Vec::new();
        for (table, statements) in ALL {
            for (name, statement) in *statements {
                if MAY.iter().any(|(of, which)| of == table && (which.is_empty() || which == name))
                {
                    continue;
                }
                let scans = self.statement_scans(*statement).await;
                let scans =
                    scans.map_err(|error| StoreError::conflict(table, *name, error.to_string()))?;
                found.extend(scans.into_iter().map(|scan| format!("{table}::{name}: {scan}")));
            }
        }
        Ok(found)
    }

    async fn statement_scans(&self, statement: Statement) -> sqlx::Result<Vec<String>> {
        match &self.database().write {
            DatabaseWriter::Sqlite(group) => sqlite_scans(group.pool(), statement.sqlite).await,
            DatabaseWriter::Postgres(pool) => {
                postgres_scans(&pool.current_lease().pool, statement.postgres).await
            }
        }
    }
}

async fn sqlite_scans(pool: &SqlitePool, sql: &str) -> sqlx::Result<Vec<String>> {
    let rows = pool.fetch_all(AssertSqlSafe(format!("EXPLAIN QUERY PLAN {sql}"))).await?;
    let steps = rows
        .into_iter()
        .map(|row| row.try_get::<String, _>("detail"))
        .collect::<sqlx::Result<Vec<_>>>()?;
    Ok(steps
        .into_iter()
        .filter(|step| step.starts_with("SCAN ") && step != "SCAN CONSTANT ROW")
        .filter(|step| {
            let own = FEW.contains(&step.as_str()) || step.starts_with(WITHIN);
            !own && !step.contains(SHORT) && !step.starts_with(GIVEN)
        })
        .collect())
}

/// Returns the full scans in the plan for any values, on a connection that avoids sequential scans
/// if possible.
async fn postgres_scans(pool: &PgPool, sql: &str) -> sqlx::Result<Vec<String>> {
    let mut connection = pool.acquire().await?;
    let plan = explain_statement(&mut connection, sql).await;
    connection.execute("RESET ALL").await?;
    connection.execute("DEALLOCATE ALL").await?;
    connection.close().await?;
    let mut scans = Vec::new();
    collect_scans(&plan?, &mut scans);
    Ok(scans)
}

async fn explain_statement(connection: &mut PgConnection, sql: &str) -> sqlx::Result<Value> {
    connection
        .execute("SET enable_seqscan = off; SET plan_cache_mode = force_generic_plan")
        .await?;
    connection.execute(AssertSqlSafe(format!("PREPARE explained AS {sql}"))).await?;
    // NULL for each placeholder: a generic plan does not depend on the values.
    let values = match (1..).take_while(|n| sql.contains(&format!("${n}"))).count() {
        0 => String::new(),
        count => format!("({})", vec!["NULL"; count].join(", ")),
    };
    let row = connection
        .fetch_one(AssertSqlSafe(format!("EXPLAIN (FORMAT JSON) EXECUTE explained{values}")))
        .await?;
    let text: String = row.try_get_unchecked(0)?;
    serde_json::from_str(&text).map_err(|error| sqlx::Error::Decode(Box::new(error)))
}

/// Collects the steps of a plan that read all rows: of a table, or of an index without a condition.
fn collect_scans(plan: &Value, scans: &mut Vec<String>) {
    match plan {
        Value::Array(all) => all.iter().for_each(|one| collect_scans(one, scans)),
        Value::Object(fields) => {
            let text = |field: &str| fields.get(field).and_then(Value::as_str).unwrap_or_default();
            let kind = text("Node Type");
            let index = kind.starts_with("Index") || kind == "Bitmap Index Scan";
            let whole = kind == "Seq Scan"
                || index && !fields.contains_key("Index Cond") && text("Index Name") != SHORT;
            if whole {
                scans.push(format!("{kind} on {}{}", text("Relation Name"), text("Index Name")));
            }
            fields.values().for_each(|value| collect_scans(value, scans));
        }
        _ => {}
    }
}
