//! Body of a delivery: JSON for programs, or a sentence with a link for people. Chat rooms are
//! recognised by the host of the webhook, mail by its scheme.

use reqwest::Url;
use serde_json::{Value, json};

/// Hosts of Slack.
const SLACK_HOSTS: [&str; 2] = ["hooks.slack.com", "hooks.slack-gov.com"];
/// Endings of the hosts of Microsoft Teams: connectors and workflows.
const TEAMS_HOSTS: [&str; 3] =
    [".webhook.office.com", ".logic.azure.com", ".api.powerplatform.com"];

/// Scheme of the address of a mail box.
const MAIL_SCHEME: &str = "mailto";
/// Largest number of trials that a mail lists.
const MAX_LISTED_TRIALS: usize = 10;

/// Form in which a receiver takes events.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MessageFormat {
    /// The event as JSON.
    Json,
    /// A message of Slack (Incoming Webhooks).
    Slack,
    /// An adaptive card in Microsoft Teams.
    Teams,
    /// A mail of plain text.
    Mail,
}

/// Subject and body of a mail.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct MailText {
    pub subject: String,
    pub body: String,
}

impl MailText {
    /// Returns the mail of an event; `base` is the URL of this server, for links.
    pub fn from_event(event: &str, base: Option<&str>) -> Self {
        let parsed: Value = serde_json::from_str(event).unwrap_or_default();
        let sentence = event_sentence(&parsed);
        let trials = parsed["about"]["trials"].as_array().into_iter().flatten();
        let link = |path: String| base.map(|base| format!("{}{path}", base.trim_end_matches('/')));
        let trials = trials.filter_map(Value::as_str).take(MAX_LISTED_TRIALS);
        let trials: Vec<String> = trials.filter_map(|id| link(format!("/trials/{id}"))).collect();
        let mut parts = vec![sentence.clone()];
        parts.extend(event_link(&parsed, base));
        if !trials.is_empty() {
            parts.push(format!("Trials:\n{}", trials.join("\n")));
        }
        // A reason may have several lines; a subject has one.
        let subject = sentence.replace(char::is_control, " ");
        Self { subject, body: parts.join("\n\n") + "\n" }
    }
}

impl MessageFormat {
    /// Returns the format of a receiver by its URL.
    pub fn from_url(url: &str) -> Self {
        let url = Url::parse(url).ok();
        if url.as_ref().is_some_and(|url| url.scheme() == MAIL_SCHEME) {
            return Self::Mail;
        }
        // The host alone counts: a path or a user name may contain any text.
        let host = url.as_ref().and_then(Url::host_str).unwrap_or_default();
        match host {
            host if SLACK_HOSTS.contains(&host) => Self::Slack,
            host if TEAMS_HOSTS.iter().any(|ending| host.ends_with(ending)) => Self::Teams,
            _ => Self::Json,
        }
    }

    /// Name for people.
    pub fn title(self) -> &'static str {
        match self {
            Self::Json => "JSON",
            Self::Slack => "Slack",
            Self::Teams => "Microsoft Teams",
            Self::Mail => "Mail",
        }
    }

    /// Returns the body to send; `base` is the URL of this server, for links.
    pub(super) fn render_body(self, event: &str, base: Option<&str>) -> String {
        // Events are written by this program; an unknown one still gets its sentence.
        let parsed: Value = serde_json::from_str(event).unwrap_or_default();
        let (text, link) = (event_sentence(&parsed), event_link(&parsed, base));
        match (self, link) {
            (Self::Json, _) => event.to_owned(),
            (Self::Slack, None) => json!({ "text": text }).to_string(),
            (Self::Slack, Some(link)) => {
                json!({ "text": format!("{text} <{link}|Open>") }).to_string()
            }
            (Self::Teams, link) => teams_card(&text, link.as_deref()).to_string(),
            (Self::Mail, _) => MailText::from_event(event, base).body,
        }
    }
}

/// Returns an event in a sentence.
fn event_sentence(event: &Value) -> String {
    let (ship, about) = (event["ship"].as_str().unwrap_or("a ship"), &event["about"]);
    let words = |value: &Value| -> String {
        let all = value.as_array().into_iter().flatten().filter_map(Value::as_str);
        all.collect::<Vec<_>>().join(", ")
    };
    match event["event"].as_str() {
        Some("champion.moved") => {
            let reason = about["reason"].as_str().unwrap_or("no reason given");
            format!("{ship}: version {} is in use now ({reason}).", about["version"])
        }
        Some("diagnosis.failed") => {
            let missing = words(&about["effects"]);
            let missing =
                if missing.is_empty() { "something unexplained".to_owned() } else { missing };
            let trials = match about["trials"].as_array().map_or(0, Vec::len) {
                0 => String::new(),
                1 => ", by 1 trial".to_owned(),
                count => format!(", by {count} trials"),
            };
            format!("{ship}: its model no longer holds. It lacks {missing}{trials}.")
        }
        Some("drift") => {
            let ratio = about["ratio"].as_f64().unwrap_or_default();
            format!("{ship}: unexplained force is {ratio:.1} times that of the fitted trials.")
        }
        _ => format!("{ship}: something changed."),
    }
}

/// Returns the address of the page that an event is about.
fn event_link(event: &Value, base: Option<&str>) -> Option<String> {
    let base = base?.trim_end_matches('/');
    Some(format!("{base}{}", event["page"].as_str()?))
}

fn teams_card(text: &str, link: Option<&str>) -> Value {
    // Without a public address of the server there is nothing to open.
    let open = link.map(|link| json!({ "type": "Action.OpenUrl", "title": "Open", "url": link }));
    let card = json!({
        "$schema": "http://adaptivecards.io/schemas/adaptive-card.json",
        "type": "AdaptiveCard",
        "version": "1.4",
        "body": [{ "type": "TextBlock", "text": text, "wrap": true }],
        "actions": open.into_iter().collect::<Vec<_>>(),
    });
    json!({ "type": "message", "attachments": [
        { "contentType": "application/vnd.microsoft.card.adaptive", "content": card }] })
}

#[cfg(test)]
mod tests {
    use super::*;

    const EVENT: &str = r#"{"event":"champion.moved","ship":"kcs","page":"/ships/kcs/versions/2",
        "about":{"version":2,"reason":"looked over"}}"#;

    #[test]
    fn chat_rooms_are_recognised_by_their_host() {
        let of = MessageFormat::from_url;
        assert_eq!(of("https://hooks.slack.com/services/T/B/x"), MessageFormat::Slack);
        assert_eq!(of("https://prod-1.westeurope.logic.azure.com/x"), MessageFormat::Teams);
        assert_eq!(of("https://hooks.slack.com.evil.example/x"), MessageFormat::Json);
        assert_eq!(MessageFormat::Json.render_body(EVENT, None), EVENT);
    }

    #[test]
    fn a_mail_has_version_trials_and_links() {
        let event = r#"{"event":"diagnosis.failed","ship":"kcs","page":"/ships/kcs/versions/2",
            "about":{"version":2,"effects":["wind"],"trials":["t1","t2"]}}"#;
        let mail = MailText::from_event(event, Some("https://ships.example/"));
        assert_eq!(mail.subject, "kcs: its model no longer holds. It lacks wind, by 2 trials.");
        for line in ["/ships/kcs/versions/2", "/trials/t1", "/trials/t2"] {
            let line = format!("\nhttps://ships.example{line}\n");
            assert!(mail.body.contains(&line), "{line} is not in {}", mail.body);
        }
        let event = EVENT.replace("looked over", "two\\nlines");
        let mail = MailText::from_event(&event, None);
        assert!(mail.subject.contains("(two lines)") && !mail.body.contains("http"), "{mail:?}");
        assert_eq!(MessageFormat::from_url("mailto:a@b.example"), MessageFormat::Mail);
    }

    #[test]
    fn a_message_has_the_version_and_a_link() {
        let base = Some("https://ships.example/");
        let slack = MessageFormat::Slack.render_body(EVENT, base);
        assert!(slack.contains("kcs: version 2 is in use now (looked over)."), "{slack}");
        assert!(slack.contains("<https://ships.example/ships/kcs/versions/2|Open>"), "{slack}");
        let teams = MessageFormat::Teams.render_body(EVENT, base);
        assert!(
            teams.contains("\"url\":\"https://ships.example/ships/kcs/versions/2\""),
            "{teams}"
        );
        assert!(!MessageFormat::Teams.render_body(EVENT, None).contains("OpenUrl"));
    }
}
