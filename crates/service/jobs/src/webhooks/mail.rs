//! Mail of events, handed to the SMTP server of the operator (RFC 5321).

use std::fmt;
use std::sync::Arc;
use std::time::Duration;

use lettre::message::Mailbox;
use lettre::message::header::{ContentType, HeaderName, HeaderValue};
use lettre::transport::smtp::extension::ClientId;
use lettre::{Address, AsyncSmtpTransport, AsyncTransport, Message, Tokio1Executor};
use reqwest::Url;
use sistership_store::{Delivery, provide_cryptography};
use tokio::sync::Semaphore;

use super::message::MailText;

/// Number of connections to the server at a time.
const CONNECTIONS: usize = 4;
/// Time for a message, with the wait for a connection; shorter than the lease of a delivery.
const TIMEOUT: Duration = Duration::from_secs(60);
/// Maximum length of a stored answer, characters.
const MAX_ANSWER_CHARS: usize = 300;

/// SMTP server and sender of mail.
#[derive(Clone, PartialEq, Eq)]
pub struct MailSettings {
    /// `smtps://user:password@host:465`, `smtp://user:password@host:587?tls=required`, or
    /// `smtp://host:25` without a password.
    pub smtp_url: String,
    /// Address of the sender, such as `Sistership <ships@example.com>`.
    pub from: String,
}

impl fmt::Debug for MailSettings {
    /// Omits the URL, which may hold a password.
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.debug_struct("MailSettings").field("from", &self.from).finish_non_exhaustive()
    }
}

/// Sender of mail over few connections.
#[derive(Clone)]
pub struct MailSender {
    transport: AsyncSmtpTransport<Tokio1Executor>,
    from: Mailbox,
    slots: Arc<Semaphore>,
}

impl fmt::Debug for MailSender {
    /// Omits the transport, which holds a password.
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.debug_struct("MailSender").field("from", &self.from).finish_non_exhaustive()
    }
}

impl MailSender {
    /// Creates a sender; the server is first reached with the first message.
    ///
    /// # Errors
    /// Returns a message that names the setting which is wrong and how to put it right.
    pub fn new(settings: &MailSettings) -> Result<Self, String> {
        provide_cryptography();
        let from: Mailbox = settings.from.parse().map_err(|_| {
            "mail_from is not an address; write one such as ships@example.com".to_owned()
        })?;
        let wrong =
            |why: &str| format!("the SMTP URL {why}; write it as smtps://user:password@host:465");
        // The reason of the library could repeat the password.
        let url = Url::parse(&settings.smtp_url).map_err(|_| wrong("cannot be read"))?;
        // Opportunistic encryption can be suppressed by an attacker in between (RFC 7817).
        let is_required =
            url.query_pairs().any(|(name, value)| name == "tls" && value == "required");
        if url.scheme() == "smtp" && !is_required && url.password().is_some() {
            return Err(wrong("would send the password in the clear"));
        }
        let builder = AsyncSmtpTransport::<Tokio1Executor>::from_url(&settings.smtp_url)
            .map_err(|_| wrong("is none"))?;
        // Servers refuse names that are none in the greeting: by default that of the sender.
        let builder = match url.path().trim_matches('/') {
            "" => builder.hello_name(ClientId::Domain(from.email.domain().to_owned())),
            _ => builder,
        };
        let transport = builder.timeout(Some(TIMEOUT)).build();
        Ok(Self { transport, from, slots: Arc::new(Semaphore::new(CONNECTIONS)) })
    }

    /// Sends a delivery once; returns the answer of the server, or the reason of the failure.
    pub(super) async fn send_once(
        &self,
        delivery: &Delivery,
        to: Address,
        text: MailText,
    ) -> Result<String, String> {
        let message = self.compose(delivery, to, text).map_err(|error| error.to_string())?;
        let send = async {
            // The connection is closed when it is dropped, also by the deadline: a mail that was
            // interrupted cannot mix with the next one.
            let _slot = self.slots.acquire().await;
            self.transport.send(message).await
        };
        let shorten = |text: String| text.chars().take(MAX_ANSWER_CHARS).collect::<String>();
        match tokio::time::timeout(TIMEOUT, send).await {
            Ok(Ok(answer)) => Ok(answer.code().to_string()),
            Ok(Err(error)) => Err(shorten(describe_failure(&error))),
            Err(_) => Err("no answer of the mail server in time".to_owned()),
        }
    }

    /// Returns the message; every attempt at a delivery has the same id.
    fn compose(
        &self,
        delivery: &Delivery,
        to: Address,
        text: MailText,
    ) -> Result<Message, lettre::error::Error> {
        let mut message = Message::builder()
            .from(self.from.clone())
            .to(Mailbox::new(None, to))
            .message_id(Some(format!("<{}@{}>", delivery.id, self.from.email.domain())))
            .subject(text.subject)
            .header(ContentType::TEXT_PLAIN)
            .body(text.body)?;
        // Absence notes are not sent in answer to it (RFC 3834).
        let name = HeaderName::new_from_ascii_str("Auto-Submitted");
        message.headers_mut().insert_raw(HeaderValue::new(name, "auto-generated".to_owned()));
        Ok(message)
    }
}

/// Describes an error without the address of the server.
fn describe_failure(error: &lettre::transport::smtp::Error) -> String {
    match error.status() {
        Some(code) => match std::error::Error::source(error) {
            Some(said) => format!("the mail server answered {code}: {said}"),
            None => format!("the mail server answered {code}"),
        },
        None if error.is_tls() => "no encrypted connection to the mail server".to_owned(),
        None if error.is_client() => error.to_string(),
        None => "no connection to the mail server".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refusal(smtp_url: &str, from: &str) -> String {
        let settings = MailSettings { smtp_url: smtp_url.to_owned(), from: from.to_owned() };
        assert!(!format!("{settings:?}").contains("secret"));
        MailSender::new(&settings).err().unwrap_or_default()
    }

    #[test]
    fn wrong_settings_are_named_without_the_password() {
        assert_eq!(refusal("smtps://ann:secret@mail.example", "ships@example.com"), "");
        assert_eq!(refusal("smtp://a:secret@m.example?tls=required", "a@example.com"), "");
        assert_eq!(refusal("smtp://127.0.0.1:2525", "Ships <ships@example.com>"), "");
        assert!(refusal("smtps://mail.example", "no address").starts_with("mail_from"));
        let opportunistic = "smtp://ann:secret@mail.example?tls=opportunistic";
        for url in ["smtp://ann:secret@mail.example", opportunistic, "https://ann:secret@x.example"]
        {
            let message = refusal(url, "ships@example.com");
            assert!(message.contains("SMTP URL") && !message.contains("secret"), "{message}");
        }
    }
}
