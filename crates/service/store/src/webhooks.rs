//! Webhooks: places on the web that are told of what happens, and what each is told.
//!
//! A delivery is written by the transaction that it tells of, so that none is lost of what was
//! acknowledged, and none tells of what was undone. Whoever takes one has it for a time; if the
//! taker is gone by then, it is due again: it arrives at least once.

use serde_json::{Value, json};

use crate::arguments::args;
use crate::checks;
use crate::database::Transaction;
use crate::error::{Result, StoreError};
use crate::page::{List, Page};
use crate::record::record;
use crate::statements::{pair, same, statements};
use crate::store::Store;

/// The champion of a ship has moved.
pub const CHAMPION_MOVED: &str = "champion.moved";
/// A diagnosis found that a version lacks something.
pub const DIAGNOSIS_FAILED: &str = "diagnosis.failed";
/// A champion leaves much more of new trials than of those that it was fitted on.
pub const DRIFT: &str = "drift";
/// What a webhook may be told.
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
    LISTENING = same("SELECT w.id AS word FROM webhook_events e JOIN webhooks w ON w.id = \
        e.webhook WHERE e.event = $1 AND w.ended_us IS NULL AND (w.ship IS NULL OR w.ship = $2) \
        AND w.drift_above < $3 ORDER BY w.id");
    PUT = same("INSERT INTO deliveries (id, webhook, event, body, created_us, attempts, due_us) \
        VALUES ($1, $2, $3, $4, $5, 0, $5)");
    DUE = pair(
        delivery!("SELECT", "FROM deliveries WHERE due_us <= $1 ORDER BY due_us LIMIT 1"),
        delivery!("SELECT", "FROM deliveries WHERE due_us <= $1 ORDER BY due_us LIMIT 1 FOR UPDATE \
            SKIP LOCKED"),
    );
    // Whether it is worth to begin to write.
    DUE_NOW = same(delivery!("SELECT", "FROM deliveries WHERE due_us <= $1 ORDER BY due_us LIMIT 1"));
    TAKE = same(delivery!("UPDATE deliveries SET attempts = attempts + 1, due_us = $2 WHERE id = \
        $1 RETURNING", ""));
    ARRIVED = same("UPDATE deliveries SET due_us = NULL, delivered_us = $2, answer = $3 WHERE id = \
        $1");
    FAILED = same("UPDATE deliveries SET due_us = $2, answer = $3 WHERE id = $1 AND delivered_us \
        IS NULL");
    GIVE_UP = same("UPDATE deliveries SET due_us = NULL, answer = 'the webhook has ended' \
        WHERE webhook = $1 AND due_us IS NOT NULL");
    AGAIN = same(delivery!("UPDATE deliveries SET due_us = $3, attempts = 0 \
        WHERE id = $1 AND webhook = $2 AND delivered_us IS NULL RETURNING", ""));
    DELIVERIES = same(delivery!("SELECT", "FROM deliveries WHERE webhook = $1 AND id < \
        COALESCE($2, '~') ORDER BY id DESC LIMIT $3"));
}

record! {
    /// A place that is told of what happens.
    pub struct Webhook {
        /// Its id.
        pub id: String,
        /// What it is for.
        pub title: String,
        /// Where it is.
        pub url: String,
        /// What deliveries are signed with.
        pub secret: String,
        /// The ship of which it is told; none for all.
        pub ship: Option<String>,
        /// How many times as much a champion leaves of new trials as of those that it was fitted on
        /// before it is told of drift.
        pub drift_above: f64,
        /// When it was made.
        pub created_us: i64,
        /// When it was ended, if it was.
        pub ended_us: Option<i64>,
    }
}

record! {
    /// What a webhook is told.
    pub struct Delivery {
        /// Its id.
        pub id: String,
        /// The webhook.
        pub webhook: String,
        /// What happened, one of [`EVENTS`].
        pub event: String,
        /// What is sent, JSON.
        pub body: String,
        /// When it happened.
        pub created_us: i64,
        /// How often it was sent.
        pub attempts: i64,
        /// When it is sent next; none once it has arrived or was given up.
        pub due_us: Option<i64>,
        /// When it arrived, if it did.
        pub delivered_us: Option<i64>,
        /// What came of the last attempt.
        pub answer: Option<String>,
    }
}

record! {
    /// A word.
    pub struct WebhookWord {
        /// The word.
        pub word: String,
    }
}

/// A webhook that is to be kept.
#[derive(Debug, Clone, PartialEq)]
pub struct NewWebhook {
    /// What it is for.
    pub title: String,
    /// Where it is.
    pub url: String,
    /// What deliveries are signed with.
    pub secret: String,
    /// The ship of which it is told; none for all.
    pub ship: Option<String>,
    /// How many times as much a champion leaves of new trials as of those that it was fitted on
    /// before it is told of drift.
    pub drift_above: f64,
    /// What it is told, of [`EVENTS`], each once.
    pub events: Vec<String>,
}

/// The webhooks of a store.
#[derive(Debug, Clone, Copy)]
pub struct Webhooks<'a>(pub(crate) &'a Store);

impl Store {
    /// Places that are told of what happens.
    pub fn webhooks(&self) -> Webhooks<'_> {
        Webhooks(self)
    }
}

impl Webhooks<'_> {
    /// Keeps a webhook.
    pub async fn create(&self, new: &NewWebhook) -> Result<Webhook> {
        let NewWebhook { title, url, secret, ship, drift_above, events } = new;
        checks::not_negative("drift_above", *drift_above)?;
        check_events(events)?;
        let (id, now) = (self.0.new_id(), self.0.now_us());
        let mut tx = self.0.begin().await?;
        if let Some(ship) = ship {
            let found: Option<WebhookWord> = tx.optional(SHIP, args![ship: ship]).await?;
            found
                .ok_or_else(|| StoreError::invalid("ship", format!("there is no ship `{ship}`")))?;
        }
        let values = args![id: &id, title: title, url: url, secret: secret, ship: ship,
            drift_above: *drift_above, created_us: now];
        let webhook = tx.one(INSERT, values).await?;
        for event in events {
            tx.execute(LISTEN, args![event: event, webhook: &id]).await?;
        }
        let after = json!({ "title": title, "url": url, "ship": ship, "events": events,
            "drift_above": drift_above });
        tx.note(now, "webhook.create", format!("webhook:{id}"), None, Some(after));
        tx.commit().await?;
        Ok(webhook)
    }

    /// A webhook.
    pub async fn get(&self, id: &str) -> Result<Webhook> {
        let found = self.0.database().optional(GET, args![id: id]).await?;
        found.ok_or_else(|| StoreError::missing("webhook", id))
    }

    /// What a webhook is told.
    pub async fn events(&self, id: &str) -> Result<Vec<String>> {
        let words: Vec<WebhookWord> = self.0.database().all(EVENTS_OF, args![webhook: id]).await?;
        Ok(words.into_iter().map(|event| event.word).collect())
    }

    /// The webhooks by id, those that have ended too.
    pub async fn list(&self, page: &Page) -> Result<List<Webhook>> {
        let values = args![after: &page.after, limit: page.fetch()?];
        let webhooks = self.0.database().all(LIST, values).await?;
        Ok(page.of(webhooks, |webhook: &Webhook| webhook.id.clone()))
    }

    /// Ends a webhook, for ever; what it was still to be told is given up.
    pub async fn end(&self, id: &str) -> Result<Webhook> {
        let now = self.0.now_us();
        let mut tx = self.0.begin().await?;
        let Some(webhook) = tx.optional(END, args![id: id, ended_us: now]).await? else {
            return Err(match tx.optional::<Webhook>(GET, args![id: id]).await? {
                Some(_) => StoreError::conflict("webhook", id, "has ended already"),
                None => StoreError::missing("webhook", id),
            });
        };
        tx.execute(GIVE_UP, args![webhook: id]).await?;
        let after = json!({ "ended": true });
        tx.note(now, "webhook.end", format!("webhook:{id}"), None, Some(after));
        tx.commit().await?;
        Ok(webhook)
    }

    /// What a webhook was told and is to be told, the latest first.
    pub async fn deliveries(&self, id: &str, page: &Page) -> Result<List<Delivery>> {
        let values = args![webhook: id, after: &page.after, limit: page.fetch()?];
        let deliveries = self.0.database().all(DELIVERIES, values).await?;
        Ok(page.of(deliveries, |delivery: &Delivery| delivery.id.clone()))
    }

    /// Takes the delivery that is due first, if one is, until a moment: it is due again then.
    pub async fn take(&self, until_us: i64) -> Result<Option<(Delivery, Webhook)>> {
        let due: Option<Delivery> =
            self.0.database().optional(DUE_NOW, args![due_us: self.0.now_us()]).await?;
        if due.is_none() {
            return Ok(None);
        }
        let mut tx = self.0.begin().await?;
        let due: Option<Delivery> = tx.optional(DUE, args![due_us: self.0.now_us()]).await?;
        let Some(due) = due else { return Ok(None) };
        let taken: Delivery = tx.one(TAKE, args![id: &due.id, due_us: until_us]).await?;
        let webhook = tx.one(GET, args![id: &taken.webhook]).await?;
        tx.commit().await?;
        Ok(Some((taken, webhook)))
    }

    /// Notes that a delivery has arrived.
    pub async fn arrived(&self, id: &str, answer: &str) -> Result<()> {
        let mut tx = self.0.begin().await?;
        let values = args![id: id, delivered_us: self.0.now_us(), answer: answer];
        tx.execute(ARRIVED, values).await?;
        tx.commit().await
    }

    /// Notes that a delivery has not arrived, and when it is sent again, if it is.
    pub async fn failed(&self, id: &str, due_us: Option<i64>, answer: &str) -> Result<()> {
        let mut tx = self.0.begin().await?;
        tx.execute(FAILED, args![id: id, due_us: due_us, answer: answer]).await?;
        tx.commit().await
    }

    /// Sends what has not arrived once more, from the beginning of its attempts.
    pub async fn again(&self, webhook: &str, delivery: &str) -> Result<Delivery> {
        let now = self.0.now_us();
        let mut tx = self.0.begin().await?;
        let values = args![id: delivery, webhook: webhook, due_us: now];
        let again = tx.optional(AGAIN, values).await?;
        let again = again.ok_or_else(|| StoreError::missing("delivery under way", delivery))?;
        tx.note(now, "webhook.again", format!("webhook:{webhook}"), None, None);
        tx.commit().await?;
        Ok(again)
    }
}

fn check_events(events: &[String]) -> Result<()> {
    let wrong = |message: String| Err(StoreError::invalid("events", message));
    if events.is_empty() {
        return wrong(format!("name at least one of {}", EVENTS.join(", ")));
    }
    for (k, event) in events.iter().enumerate() {
        if !EVENTS.contains(&event.as_str()) {
            return wrong(format!("`{event}` is none of {}", EVENTS.join(", ")));
        }
        if events[..k].contains(event) {
            return wrong(format!("`{event}` is named twice"));
        }
    }
    Ok(())
}

/// Tells all who listen of what a transaction does, once it is kept.
pub(crate) async fn tell(
    store: &Store,
    tx: &mut Transaction,
    event: &str,
    ship: &str,
    about: Value,
) -> Result<()> {
    tell_of(store, tx, (event, f64::MAX), ship, about).await
}

/// Tells those who listen, and ask for no more than a champion leaves of new trials.
pub(crate) async fn tell_drift(
    store: &Store,
    tx: &mut Transaction,
    ratio: f64,
    ship: &str,
) -> Result<()> {
    let about = json!({ "ratio": ratio });
    tell_of(store, tx, (DRIFT, ratio), ship, about).await
}

async fn tell_of(
    store: &Store,
    tx: &mut Transaction,
    (event, ratio): (&str, f64),
    ship: &str,
    about: Value,
) -> Result<()> {
    let values = args![event: event, ship: ship, drift_above: ratio];
    let listening: Vec<WebhookWord> = tx.all(LISTENING, values).await?;
    if listening.is_empty() {
        return Ok(());
    }
    let now = store.now_us();
    let body = json!({ "event": event, "ship": ship, "at_us": now, "about": about }).to_string();
    checks::json("body", &body)?;
    for webhook in listening {
        let id = store.new_id();
        let values =
            args![id: &id, webhook: &webhook.word, event: event, body: &body, created_us: now];
        tx.execute(PUT, values).await?;
    }
    Ok(())
}
