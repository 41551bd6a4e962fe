//! Webhooks: URLs that are notified of events, and the deliveries to them.
//!
//! A delivery is written by the transaction of the event, so that no acknowledged event is lost,
//! and no event is reported that was rolled back. A worker takes a delivery for a limited time; if
//! the worker dies meanwhile, the delivery is due again: each arrives at least once.

use serde_json::{Value, json};

use crate::arguments::args;
use crate::checks;
use crate::database::AuditedTransaction;
use crate::error::{Result, StoreError};
use crate::page::{ListPage, PageRequest};
use crate::record::record;
use crate::statements::{pair, same, statements};
use crate::store::Store;

/// The champion of a ship has moved.
pub const CHAMPION_MOVED: &str = "champion.moved";
/// A diagnosis found that a version lacks something.
pub const DIAGNOSIS_FAILED: &str = "diagnosis.failed";
/// The residual of a champion on new trials is much larger than on the trials of its fit.
pub const DRIFT: &str = "drift";
/// All events of webhooks.
pub const EVENTS: [&str; 3] = [CHAMPION_MOVED, DIAGNOSIS_FAILED, DRIFT];

/// The columns of a webhook.
macro_rules! webhook {
    ($before:literal, $after:literal) => {
        same(concat!(
            $before,
            " id, title, url, secret, ship, drift_above, created_us, ended_us ",
            $after
        ))
    };
}

/// The columns of a delivery.
macro_rules! delivery {
    ($before:literal, $after:literal) => {
        concat!(
            $before,
            " id, webhook, event, body, created_us, attempts, due_us, delivered_us, answer ",
            $after
        )
    };
}

statements! {
    INSERT = webhook!("INSERT INTO webhooks (id, title, url, secret, ship, drift_above, \
        created_us) VALUES ($1, $2, $3, $4, $5, $6, $7) RETURNING", "");
    GET = webhook!("SELECT", "FROM webhooks WHERE id = $1");
    LIST = webhook!("SELECT", "FROM webhooks WHERE id > COALESCE($1, '') ORDER BY id LIMIT $2");
    END = webhook!("UPDATE webhooks SET ended_us = $2 WHERE id = $1 AND ended_us IS NULL RETURNING", "");
    SHIP = same("SELECT name AS word FROM ships WHERE name = $1");
    LISTEN = same("INSERT INTO webhook_events (event, webhook) VALUES ($1, $2)");
    EVENTS_OF = same("SELECT event AS word FROM webhook_events WHERE webhook = $1 ORDER BY event");
    // For events other than drift the caller passes the largest number, above every threshold.
    LISTENING = same("SELECT w.id AS word FROM webhook_events e JOIN webhooks w ON w.id = \
        e.webhook WHERE e.event = $1 AND w.ended_us IS NULL AND (w.ship IS NULL OR w.ship = $2) \
        AND w.drift_above < $3 ORDER BY w.id");
    PUT = same("INSERT INTO deliveries (id, webhook, event, body, created_us, attempts, due_us) \
        VALUES ($1, $2, $3, $4, $5, 0, $5)");
    // On PostgreSQL, a row that another worker has locked is skipped instead of waited for.
    DUE = pair(
        delivery!("SELECT", "FROM deliveries WHERE webhook = $2 AND due_us <= $1 ORDER BY due_us \
            LIMIT 1"),
        delivery!("SELECT", "FROM deliveries WHERE webhook = $2 AND due_us <= $1 ORDER BY due_us \
            LIMIT 1 FOR UPDATE SKIP LOCKED"),
    );
    // A read without a transaction, so that polling does not take the write lock.
    DUE_NOW = same(delivery!("SELECT", "FROM deliveries WHERE webhook = $2 AND due_us <= $1 ORDER BY \
        due_us LIMIT 1"));
    RECEIVERS = same("SELECT w.id AS word FROM webhooks w WHERE EXISTS (SELECT 1 FROM deliveries d \
        WHERE d.webhook = w.id AND d.due_us <= $1) ORDER BY w.id");
    // The new due time is the end of the lease: without a result until then it is sent again.
    TAKE = same(delivery!("UPDATE deliveries SET attempts = attempts + 1, due_us = $2 WHERE id = \
        $1 RETURNING", ""));
    ARRIVED = same("UPDATE deliveries SET due_us = NULL, delivered_us = $2, answer = $3 WHERE id = \
        $1");
    // A late failure does not undo an arrival that another worker has recorded.
    FAILED = same("UPDATE deliveries SET due_us = $2, answer = $3 WHERE id = $1 AND delivered_us \
        IS NULL");
    // Without a due time a delivery is never sent.
    GIVE_UP = same("UPDATE deliveries SET due_us = NULL, answer = 'the webhook has ended' \
        WHERE webhook = $1 AND due_us IS NOT NULL");
    AGAIN = same(delivery!("UPDATE deliveries SET due_us = $3, attempts = 0 \
        WHERE id = $1 AND webhook = $2 AND delivered_us IS NULL RETURNING", ""));
    // '~' sorts after every id: without a cursor the list starts at the latest one.
    DELIVERIES = same(delivery!("SELECT", "FROM deliveries WHERE webhook = $1 AND id < \
        COALESCE($2, '~') ORDER BY id DESC LIMIT $3"));
}

record! {
    /// A URL that is notified of events.
    pub struct Webhook {
        /// Its id.
        pub id: String,
        /// Purpose, in words.
        pub title: String,
        /// Target of the deliveries.
        pub url: String,
        /// Secret with which deliveries are signed.
        pub secret: String,
        /// Ship whose events are reported; none for all.
        pub ship: Option<String>,
        /// Threshold of the drift event: ratio of the residual of the champion on new trials to
        /// that on the trials of its fit.
        pub drift_above: f64,
        /// When it was made.
        pub created_us: i64,
        /// End, microseconds since 1970; none while it is active.
        pub ended_us: Option<i64>,
    }
}

record! {
    /// A notification of a webhook.
    pub struct Delivery {
        /// Its id.
        pub id: String,
        /// The webhook.
        pub webhook: String,
        /// Event, one of [`EVENTS`].
        pub event: String,
        /// Body of the request, JSON.
        pub body: String,
        /// Time of the event, microseconds since 1970.
        pub created_us: i64,
        /// Number of attempts.
        pub attempts: i64,
        /// Time of the next attempt, microseconds since 1970; none once it has arrived or is given
        /// up.
        pub due_us: Option<i64>,
        /// Time of arrival, microseconds since 1970.
        pub delivered_us: Option<i64>,
        /// Result of the last attempt.
        pub answer: Option<String>,
    }
}

record! {
    /// One column of text: an event, or the id of a webhook.
    pub struct WebhookWord {
        /// The value.
        pub word: String,
    }
}

/// A webhook to be created.
#[derive(Debug, Clone, PartialEq)]
pub struct NewWebhook {
    /// Purpose, in words.
    pub title: String,
    /// Target of the deliveries.
    pub url: String,
    /// Secret with which deliveries are signed.
    pub secret: String,
    /// Ship whose events are reported; none for all.
    pub ship: Option<String>,
    /// Threshold of the drift event: ratio of the residual of the champion on new trials to that on
    /// the trials of its fit.
    pub drift_above: f64,
    /// Events, of [`EVENTS`], each once.
    pub events: Vec<String>,
}

/// Repository of webhooks.
#[derive(Debug, Clone, Copy)]
pub struct WebhookRepository<'a>(pub(crate) &'a Store);

impl Store {
    /// Returns the repository of webhooks.
    pub fn webhooks(&self) -> WebhookRepository<'_> {
        WebhookRepository(self)
    }
}

impl WebhookRepository<'_> {
    /// Creates a webhook.
    pub async fn create(&self, new: &NewWebhook) -> Result<Webhook> {
        let NewWebhook { title, url, secret, ship, drift_above, events } = new;
        checks::check_not_negative("drift_above", *drift_above)?;
        check_events(events)?;
        let (id, now) = (self.0.new_id(), self.0.now_us());
        let mut tx = self.0.begin().await?;
        if let Some(ship) = ship {
            let found: Option<WebhookWord> = tx.fetch_optional(SHIP, args![ship: ship]).await?;
            found
                .ok_or_else(|| StoreError::invalid("ship", format!("there is no ship `{ship}`")))?;
        }
        let values = args![id: &id, title: title, url: url, secret: secret, ship: ship,
            drift_above: *drift_above, created_us: now];
        let webhook = tx.fetch_one(INSERT, values).await?;
        for event in events {
            tx.execute(LISTEN, args![event: event, webhook: &id]).await?;
        }
        let after = json!({ "title": title, "url": url, "ship": ship, "events": events,
            "drift_above": drift_above });
        tx.record_audit_event(now, "webhook.create", format!("webhook:{id}"), None, Some(after));
        tx.commit().await?;
        Ok(webhook)
    }

    /// Returns a webhook.
    pub async fn get(&self, id: &str) -> Result<Webhook> {
        let found = self.0.database().fetch_optional(GET, args![id: id]).await?;
        found.ok_or_else(|| StoreError::not_found("webhook", id))
    }

    /// Returns the events of a webhook.
    pub async fn list_events(&self, id: &str) -> Result<Vec<String>> {
        let words: Vec<WebhookWord> =
            self.0.database().fetch_all(EVENTS_OF, args![webhook: id]).await?;
        Ok(words.into_iter().map(|event| event.word).collect())
    }

    /// Lists the webhooks by id, including ended ones.
    pub async fn list(&self, page: &PageRequest) -> Result<ListPage<Webhook>> {
        let values = args![after: &page.after, limit: page.fetch_limit()?];
        let webhooks = self.0.database().fetch_all(LIST, values).await?;
        Ok(page.build_page(webhooks, |webhook: &Webhook| webhook.id.clone()))
    }

    /// Ends a webhook permanently; its pending deliveries are given up.
    pub async fn end_webhook(&self, id: &str) -> Result<Webhook> {
        let now = self.0.now_us();
        let mut tx = self.0.begin().await?;
        let Some(webhook) = tx.fetch_optional(END, args![id: id, ended_us: now]).await? else {
            return Err(match tx.fetch_optional::<Webhook>(GET, args![id: id]).await? {
                Some(_) => StoreError::conflict("webhook", id, "has ended already"),
                None => StoreError::not_found("webhook", id),
            });
        };
        // In the same transaction: no pending delivery is taken after the end.
        tx.execute(GIVE_UP, args![webhook: id]).await?;
        let after = json!({ "ended": true });
        tx.record_audit_event(now, "webhook.end", format!("webhook:{id}"), None, Some(after));
        tx.commit().await?;
        Ok(webhook)
    }

    /// Lists the deliveries to a webhook, the latest first.
    pub async fn list_deliveries(
        &self,
        id: &str,
        page: &PageRequest,
    ) -> Result<ListPage<Delivery>> {
        let values = args![webhook: id, after: &page.after, limit: page.fetch_limit()?];
        let deliveries = self.0.database().fetch_all(DELIVERIES, values).await?;
        Ok(page.build_page(deliveries, |delivery: &Delivery| delivery.id.clone()))
    }

    /// Returns the ids of the webhooks for which a delivery is due.
    pub async fn due_receivers(&self) -> Result<Vec<String>> {
        let words: Vec<WebhookWord> =
            self.0.database().fetch_all(RECEIVERS, args![due_us: self.0.now_us()]).await?;
        Ok(words.into_iter().map(|webhook| webhook.word).collect())
    }

    /// Takes the delivery to a webhook that is due first, if there is one, until `until_us`: then
    /// it is due again.
    pub async fn take_due(
        &self,
        webhook: &str,
        until_us: i64,
    ) -> Result<Option<(Delivery, Webhook)>> {
        let values = args![due_us: self.0.now_us(), webhook: webhook];
        let due: Option<Delivery> = self.0.database().fetch_optional(DUE_NOW, values).await?;
        // The common case of polling: nothing is due, and no transaction is needed.
        if due.is_none() {
            return Ok(None);
        }
        let mut tx = self.0.begin().await?;
        // Read again under the lock; on PostgreSQL, rows that other workers hold are skipped.
        let due: Option<Delivery> = tx.fetch_optional(DUE, values).await?;
        let Some(due) = due else { return Ok(None) };
        let taken: Delivery = tx.fetch_one(TAKE, args![id: &due.id, due_us: until_us]).await?;
        let webhook = tx.fetch_one(GET, args![id: &taken.webhook]).await?;
        tx.commit().await?;
        Ok(Some((taken, webhook)))
    }

    /// Records that a delivery has arrived.
    pub async fn record_arrival(&self, id: &str, answer: &str) -> Result<()> {
        let mut tx = self.0.begin().await?;
        let values = args![id: id, delivered_us: self.0.now_us(), answer: answer];
        tx.execute(ARRIVED, values).await?;
        tx.commit().await
    }

    /// Records a failed attempt, and the time of the next one, if there is one.
    pub async fn record_failure(&self, id: &str, due_us: Option<i64>, answer: &str) -> Result<()> {
        let mut tx = self.0.begin().await?;
        tx.execute(FAILED, args![id: id, due_us: due_us, answer: answer]).await?;
        tx.commit().await
    }

    /// Queues a delivery that has not arrived again, with its attempts counted from zero.
    pub async fn retry_delivery(&self, webhook: &str, delivery: &str) -> Result<Delivery> {
        let now = self.0.now_us();
        let mut tx = self.0.begin().await?;
        let values = args![id: delivery, webhook: webhook, due_us: now];
        let again = tx.fetch_optional(AGAIN, values).await?;
        let again = again.ok_or_else(|| StoreError::not_found("delivery under way", delivery))?;
        tx.record_audit_event(now, "webhook.again", format!("webhook:{webhook}"), None, None);
        tx.commit().await?;
        Ok(again)
    }
}

fn check_events(events: &[String]) -> Result<()> {
    let wrong = |message: String| Err(StoreError::invalid("events", message));
    if events.is_empty() {
        return wrong(format!("give at least one of {}", EVENTS.join(", ")));
    }
    for (k, event) in events.iter().enumerate() {
        if !EVENTS.contains(&event.as_str()) {
            return wrong(format!("`{event}` is not one of {}", EVENTS.join(", ")));
        }
        if events[..k].contains(event) {
            return wrong(format!("`{event}` is listed twice"));
        }
    }
    Ok(())
}

/// Notifies all webhooks of an event, once the transaction is committed.
pub(crate) async fn notify(
    store: &Store,
    tx: &mut AuditedTransaction,
    event: &str,
    ship: &str,
    about: Value,
) -> Result<()> {
    insert_deliveries(store, tx, (event, f64::MAX), ship, about).await
}

/// Notifies the webhooks whose threshold of drift is below `ratio`.
pub(crate) async fn notify_drift(
    store: &Store,
    tx: &mut AuditedTransaction,
    ratio: f64,
    ship: &str,
) -> Result<()> {
    let about = json!({ "ratio": ratio });
    insert_deliveries(store, tx, (DRIFT, ratio), ship, about).await
}

async fn insert_deliveries(
    store: &Store,
    tx: &mut AuditedTransaction,
    (event, ratio): (&str, f64),
    ship: &str,
    about: Value,
) -> Result<()> {
    let values = args![event: event, ship: ship, drift_above: ratio];
    let listening: Vec<WebhookWord> = tx.fetch_all(LISTENING, values).await?;
    if listening.is_empty() {
        return Ok(());
    }
    let now = store.now_us();
    // The page of this server that the event is about: a version, otherwise the ship.
    let page = match about["version"].as_i64() {
        Some(number) => format!("/ships/{ship}/versions/{number}"),
        None => format!("/ships/{ship}"),
    };
    let body = json!({ "event": event, "ship": ship, "at_us": now, "about": about, "page": page });
    let body = body.to_string();
    // One body for all webhooks, checked once.
    checks::check_json("body", &body)?;
    for webhook in listening {
        let id = store.new_id();
        let values =
            args![id: &id, webhook: &webhook.word, event: event, body: &body, created_us: now];
        tx.execute(PUT, values).await?;
    }
    Ok(())
}
