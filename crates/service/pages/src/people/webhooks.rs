//! Webhooks: messages to chat rooms and other programs when a ship's model changes or is in doubt.

use askama::Template;
use sistership_jobs::Archive;
use sistership_jobs::webhooks::MessageFormat;
use sistership_store::{
    CHAMPION_MOVED, DIAGNOSIS_FAILED, DRIFT, Delivery, EVENTS, PageRequest, Webhook,
};

use crate::date::format_date;
use crate::error::Result;
use crate::form::FormFields;
use crate::language::{Message, say};
use crate::shell::PageShell;

/// Number of webhooks on the page.
const LISTED_WEBHOOKS: i64 = 100;

#[derive(Template)]
#[template(path = "webhooks.html")]
struct WebhooksPage {
    shell: PageShell,
    webhooks: Vec<WebhookRow>,
    /// Name and words of each event.
    events: Vec<(&'static str, Message)>,
    public_url: String,
    /// True if the server sends mail.
    has_mail: bool,
}

struct WebhookRow {
    id: String,
    title: String,
    format: &'static str,
    /// Ship, or all ships.
    ship: String,
    events: String,
    /// Last delivery in words.
    last: String,
    active: bool,
}

/// Returns the page.
///
/// # Errors
/// Returns an error if the store fails.
pub async fn webhooks_page(archive: &Archive, shell: PageShell, has_mail: bool) -> Result<String> {
    let store = &archive.store;
    let mut webhooks = Vec::new();
    for webhook in store.webhooks().list(&PageRequest::first_page(LISTED_WEBHOOKS)).await?.items {
        let events = store.webhooks().list_events(&webhook.id).await?;
        let last =
            store.webhooks().list_deliveries(&webhook.id, &PageRequest::first_page(1)).await?;
        webhooks.push(WebhookRow::new(webhook, &events, last.items.first()));
    }
    let page = WebhooksPage {
        shell: shell.at_place("/users"),
        webhooks,
        events: EVENTS.iter().map(|event| (*event, event_words(event))).collect(),
        public_url: store.settings().public_url().await?.unwrap_or_default(),
        has_mail,
    };
    Ok(page.render()?)
}

/// Event in words.
fn event_words(event: &str) -> Message {
    match event {
        CHAMPION_MOVED => say("webhooks-event-champion"),
        DIAGNOSIS_FAILED => say("webhooks-event-diagnosis"),
        DRIFT => say("webhooks-event-drift"),
        _ => say("webhooks-event-other"),
    }
}

impl WebhookRow {
    fn new(webhook: Webhook, events: &[String], last: Option<&Delivery>) -> Self {
        let format = MessageFormat::from_url(&webhook.url).title();
        let events: Vec<String> = events.iter().map(|event| event_words(event).into()).collect();
        let last = match last {
            None => say("webhooks-none-sent").into(),
            Some(Delivery { delivered_us: Some(at_us), .. }) => {
                say("webhooks-arrived").with("at", format_date(*at_us)).into()
            }
            Some(Delivery { answer, .. }) => {
                let unsent = || say("webhooks-not-sent").into();
                let why = answer.clone().unwrap_or_else(unsent);
                say("webhooks-not-arrived").with("why", why).into()
            }
        };
        Self {
            active: webhook.ended_us.is_none(),
            ship: webhook.ship.unwrap_or_else(|| say("webhooks-all-ships").into()),
            id: webhook.id,
            title: webhook.title,
            events: events.join("; "),
            format,
            last,
        }
    }
}

/// Returns the request of a webhook, JSON, from its form.
///
/// # Errors
/// Returns an error that names a field which is missing or wrong.
pub fn webhook_request(form: &FormFields) -> Result<serde_json::Value> {
    let events: Vec<&str> = form.get_texts("event").collect();
    let drift = form.optional_number("drift_above")?;
    Ok(serde_json::json!({
        "title": form.required_text("title")?,
        "url": form.required_text("url")?,
        "ship": form.get_text("ship"),
        "events": events,
        "drift_above": drift,
    }))
}

#[derive(Template)]
#[template(path = "new_webhook.html")]
struct NewWebhookPage<'a> {
    shell: PageShell,
    title: &'a str,
    secret: &'a str,
}

/// Returns the page with the secret of a new webhook, the only page that ever shows it.
///
/// # Errors
/// Returns an error if the page cannot be rendered.
pub fn new_webhook_page(shell: PageShell, title: &str, secret: &str) -> Result<String> {
    Ok(NewWebhookPage { shell: shell.at_place("/users"), title, secret }.render()?)
}
