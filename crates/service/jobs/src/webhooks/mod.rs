//! Delivery of events to webhooks: each delivery is signed and sent until it arrives, at growing
//! intervals. It is independent of the routes of the API.

mod addresses;
mod attempt;
mod mail;
mod message;

use std::collections::HashSet;
use std::time::Duration;

use futures::future::join_all;
use sistership_store::{Delivery, Store, Webhook};
use tokio::task::JoinSet;

use self::attempt::DeliveryAttempt;
use self::message::MailText;

pub use addresses::{Receiver, check_receiver};
pub use mail::{MailSender, MailSettings};
pub use message::MessageFormat;

/// Settings of the deliveries.
#[derive(Debug, Clone)]
pub struct DeliverySettings {
    /// True if receivers may be in private networks and use plain http.
    pub private: bool,
    /// Interval at which the store is polled for due deliveries.
    pub poll: Duration,
    /// Sender of mail, if there is one.
    pub mail: Option<MailSender>,
}

/// Reason for which a server sends no mail.
pub const NO_MAIL: &str =
    "this server sends no mail; start it with SISTERSHIP_SMTP_URL and --mail-from";

/// Number of deliveries that are sent to one receiver at a time.
const SHARE: usize = 4;
/// Number of receivers that are served at a time. Each has its own share of deliveries, so that one
/// that does not answer delays no other.
const RECEIVERS: usize = 256;
/// Lease of a delivery: no other process sends it in this time, which is longer than an attempt may
/// take.
const DELIVERY_LEASE: Duration = Duration::from_secs(120);
/// Delay after the first failed attempt; it doubles after each further one.
const FIRST_DELAY: Duration = Duration::from_secs(10);
/// Largest delay.
const LONGEST_DELAY: Duration = Duration::from_secs(6 * 3600);
/// Number of attempts before a delivery is abandoned: the delays between them are 10 s to 6 h, more
/// than a day in all. It can be requested again.
const MAX_ATTEMPTS: i64 = 16;
/// Delay after a failure of the database.
const FAILURE_DELAY: Duration = Duration::from_secs(5);

/// Sends due deliveries forever. If the future is dropped, attempts are aborted; they are due again
/// after their lease.
pub async fn run_deliveries(store: Store, settings: DeliverySettings) {
    let (mut serving, mut served) = (HashSet::new(), JoinSet::new());
    loop {
        while let Some(ended) = served.try_join_next() {
            serving.remove(&ended.unwrap_or_default());
        }
        let mut pause = settings.poll;
        match store.webhooks().due_receivers().await {
            Ok(due) => {
                for webhook in due {
                    if serving.len() < RECEIVERS && serving.insert(webhook.clone()) {
                        served.spawn(serve_receiver(store.clone(), settings.clone(), webhook));
                    }
                }
            }
            Err(error) => {
                tracing::error!(%error, "webhooks could not be delivered");
                pause = pause.max(FAILURE_DELAY);
            }
        }
        tokio::time::sleep(pause).await;
    }
}

/// Sends all due deliveries to one receiver, and returns its webhook.
async fn serve_receiver(store: Store, settings: DeliverySettings, webhook: String) -> String {
    loop {
        match deliver_batch(&store, &settings, &webhook).await {
            // A full batch means that more may be due.
            Ok(SHARE) => {}
            Ok(_) => return webhook,
            Err(error) => {
                tracing::error!(%error, webhook, "deliveries could not be read or recorded");
                // The webhook counts as served meanwhile, so that the database can recover.
                tokio::time::sleep(FAILURE_DELAY).await;
                return webhook;
            }
        }
    }
}

/// Sends one batch of due deliveries to a receiver, and returns its size.
async fn deliver_batch(
    store: &Store,
    settings: &DeliverySettings,
    webhook: &str,
) -> sistership_store::Result<usize> {
    let mut taken = Vec::new();
    while taken.len() < SHARE {
        // Taking a delivery also counts the attempt and sets the time at which it is due again.
        let until = store.now_us() + to_micros(DELIVERY_LEASE);
        match store.webhooks().take_due(webhook, until).await? {
            Some(one) => taken.push(one),
            None => break,
        }
    }
    let sent = taken.iter().map(|(delivery, webhook)| deliver(store, settings, delivery, webhook));
    // All attempts finish before an error of the database is returned.
    join_all(sent).await.into_iter().collect::<sistership_store::Result<Vec<()>>>()?;
    Ok(taken.len())
}

async fn deliver(
    store: &Store,
    settings: &DeliverySettings,
    delivery: &Delivery,
    webhook: &Webhook,
) -> sistership_store::Result<()> {
    let base = store.settings().public_url().await?;
    match attempt_delivery(store, settings, (delivery, webhook), base.as_deref()).await {
        Ok(answer) => store.webhooks().record_arrival(&delivery.id, &answer).await,
        Err(reason) => {
            let due = retry_delay(delivery.attempts).map(|pause| store.now_us() + to_micros(pause));
            tracing::warn!(webhook = webhook.id, delivery = delivery.id, reason, "not delivered");
            store.webhooks().record_failure(&delivery.id, due, &reason).await
        }
    }
}

/// Sends a delivery once; returns the answer, or the reason of the failure.
async fn attempt_delivery(
    store: &Store,
    settings: &DeliverySettings,
    (delivery, webhook): (&Delivery, &Webhook),
    base: Option<&str>,
) -> Result<String, String> {
    // Checked again: the setting may have changed since the webhook was created.
    let url = match check_receiver(&webhook.url, settings.private)? {
        Receiver::Web(url) => url,
        Receiver::Mail(to) => {
            let sender = settings.mail.as_ref().ok_or(NO_MAIL)?;
            return sender
                .send_once(delivery, to, MailText::from_event(&delivery.body, base))
                .await;
        }
    };
    let format = MessageFormat::from_url(&webhook.url);
    let attempt = DeliveryAttempt {
        delivery,
        webhook,
        url,
        body: format.render_body(&delivery.body, base),
        now_us: store.now_us(),
        private: settings.private,
    };
    attempt.send_once().await
}

/// Returns the delay after this number of attempts; `None` if the delivery is abandoned.
fn retry_delay(attempts: i64) -> Option<Duration> {
    // The delay doubles with each attempt up to the largest one; an overflow counts as the largest.
    let doubled = u32::try_from(attempts - 1).ok().and_then(|n| 2_u32.checked_pow(n));
    let pause = doubled.and_then(|factor| FIRST_DELAY.checked_mul(factor)).unwrap_or(LONGEST_DELAY);
    (attempts < MAX_ATTEMPTS).then_some(pause.min(LONGEST_DELAY))
}

fn to_micros(time: Duration) -> i64 {
    i64::try_from(time.as_micros()).unwrap_or(i64::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pauses_double_to_six_hours_and_end() {
        let pauses: Vec<Option<u64>> =
            (1..=17).map(|attempt| retry_delay(attempt).map(|pause| pause.as_secs())).collect();
        assert_eq!(pauses[..3], [Some(10), Some(20), Some(40)]);
        assert_eq!((pauses[12], pauses[14], pauses[15]), (Some(21_600), Some(21_600), None));
        let all: u64 = pauses.iter().flatten().sum();
        assert!((24 * 3600..48 * 3600).contains(&all), "{} h", all / 3600);
    }
}
