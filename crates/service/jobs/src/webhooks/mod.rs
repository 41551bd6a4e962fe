//! Telling webhooks what has happened: each delivery is sent, signed, until it arrives, less and
//! less often. It knows no route.

mod addresses;
mod sent;

use std::time::Duration;

use futures::future::join_all;
use sistership_store::{Delivery, Store, Webhook};

pub use addresses::check_url;

/// How webhooks are told.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Telling {
    /// Whether receivers may be within private networks, and speak plain http.
    pub private: bool,
    /// How often it is looked whether something is due.
    pub poll: Duration,
}

/// Deliveries that are sent side by side.
const TOGETHER: usize = 8;
/// For how long one that was taken is not taken by another process: longer than it is waited for.
const TAKEN: Duration = Duration::from_secs(120);
/// The first pause after an attempt that failed; each further one is twice as long.
const FIRST: Duration = Duration::from_secs(10);
/// The longest pause.
const LONGEST: Duration = Duration::from_secs(6 * 3600);
/// Attempts before a delivery is given up: the pauses between them are 10 s to 6 h, a day and more
/// in all. It can be asked for again.
const ATTEMPTS: i64 = 16;
/// A pause after the database has failed.
const BREATH: Duration = Duration::from_secs(5);

/// Sends what is due, for ever. Whoever drops this breaks attempts off: they are due again when
/// their time is over.
pub async fn keep(store: Store, telling: Telling) {
    loop {
        let mut pause = telling.poll;
        match once(&store, telling).await {
            Ok(TOGETHER) => continue,
            Ok(_) => {}
            Err(error) => {
                tracing::error!(%error, "webhooks could not be told");
                pause = pause.max(BREATH);
            }
        }
        tokio::time::sleep(pause).await;
    }
}

/// Sends some of what is due, and returns how many.
async fn once(store: &Store, telling: Telling) -> sistership_store::Result<usize> {
    let mut taken = Vec::new();
    while taken.len() < TOGETHER {
        match store.webhooks().take(store.now_us() + micros(TAKEN)).await? {
            Some(one) => taken.push(one),
            None => break,
        }
    }
    let told = taken.iter().map(|(delivery, webhook)| tell(store, telling, delivery, webhook));
    join_all(told).await.into_iter().collect::<sistership_store::Result<Vec<()>>>()?;
    Ok(taken.len())
}

async fn tell(
    store: &Store,
    telling: Telling,
    delivery: &Delivery,
    webhook: &Webhook,
) -> sistership_store::Result<()> {
    match sent::send(delivery, webhook, store.now_us(), telling.private).await {
        Ok(answer) => store.webhooks().arrived(&delivery.id, &answer).await,
        Err(reason) => {
            let due = pause(delivery.attempts).map(|pause| store.now_us() + micros(pause));
            tracing::warn!(webhook = webhook.id, delivery = delivery.id, reason, "not delivered");
            store.webhooks().failed(&delivery.id, due, &reason).await
        }
    }
}

/// How long to wait after so many attempts; none once it is given up.
fn pause(attempts: i64) -> Option<Duration> {
    let doubled = u32::try_from(attempts - 1).ok().and_then(|n| 2_u32.checked_pow(n));
    let pause = doubled.and_then(|factor| FIRST.checked_mul(factor)).unwrap_or(LONGEST);
    (attempts < ATTEMPTS).then_some(pause.min(LONGEST))
}

fn micros(time: Duration) -> i64 {
    i64::try_from(time.as_micros()).unwrap_or(i64::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pauses_double_to_six_hours_and_end() {
        let pauses: Vec<Option<u64>> =
            (1..=17).map(|attempt| pause(attempt).map(|pause| pause.as_secs())).collect();
        assert_eq!(pauses[..3], [Some(10), Some(20), Some(40)]);
        assert_eq!((pauses[12], pauses[14], pauses[15]), (Some(21_600), Some(21_600), None));
        let all: u64 = pauses.iter().flatten().sum();
        assert!((24 * 3600..48 * 3600).contains(&all), "{} h", all / 3600);
    }
}
