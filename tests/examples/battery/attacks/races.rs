//! `races`: the same key, alias, number, upload and ship from many tasks at once. One wins, and
//! numbers have no gap.

use std::future::Future;

use reqwest::Method;
use serde_json::Value;
use tokio::task::JoinSet;

use crate::attack::{Attack, Failure, Field, Running};
use crate::client::{Client, Reply};
use crate::documents;
use crate::ledger::{Ledger, in_progress};
use crate::tally::Tally;
use crate::writes::Write;

const RACERS: usize = 16;

/// The attack.
pub struct Races;

impl Attack for Races {
    fn name(&self) -> &'static str {
        "races"
    }

    fn run<'a>(&'a self, field: &'a Field) -> Running<'a> {
        Box::pin(run(field))
    }
}

async fn run(field: &Field) -> Result<(), Failure> {
    let place = field.place().await?;
    let server = place.serve().await?;
    let race = Race { client: server.client.clone(), tally: &field.tally };
    let mut rounds = 0;
    while rounds == 0 || field.goes_on() {
        rounds += 1;
        race.round(rounds).await?;
    }
    server.process.kill();
    place.check("after the races").await?;
    field.tally.remark(format!("{rounds} rounds of {RACERS}"));
    Ok(())
}

struct Race<'a> {
    client: Client,
    tally: &'a Tally,
}

impl Race<'_> {
    async fn round(&self, round: usize) -> Result<(), Failure> {
        let ship = format!("race-{round}");
        self.same_name(&ship).await;
        self.same_key(&ship).await?;
        self.same_number(&ship).await?;
        self.same_alias(&ship).await;
        self.same_upload(&ship, round as u64).await;
        self.same_revision(&ship).await;
        self.deletion_and_use(&ship).await?;
        Ok(())
    }

    /// Sends the same from many tasks; gives the statuses and answers.
    async fn all(&self, write: impl Fn(usize) -> Write) -> Vec<Reply> {
        let sent = (0..RACERS).map(|racer| {
            let (write, client) = (write(racer), self.client.clone());
            async move { write.send(&client).await }
        });
        self.gather(sent).await
    }

    async fn gather(
        &self,
        sent: impl Iterator<Item = impl Future<Output = Option<Reply>> + Send + 'static>,
    ) -> Vec<Reply> {
        let mut racers: JoinSet<Option<Reply>> = sent.collect();
        let mut replies = Vec::new();
        while let Some(reply) = racers.join_next().await {
            match reply {
                Ok(Some(reply)) => replies.push(reply),
                _ => self.tally.wrong("a racer got no answer"),
            }
        }
        replies
    }

    /// Exactly one wins; the others are told so by one status.
    fn one_wins(&self, what: &str, replies: &[Reply], others: u16) {
        let won = replies.iter().filter(|reply| reply.ok()).count();
        let lost = replies.iter().filter(|reply| reply.status == others).count();
        if won != 1 || won + lost != replies.len() {
            let statuses: Vec<u16> = replies.iter().map(|reply| reply.status).collect();
            self.tally
                .wrong(format!("{what}: one should win and the others get {others}: {statuses:?}"));
        }
    }

    /// Keyless creations of one name.
    async fn same_name(&self, ship: &str) {
        let replies = self.all(|_| Write::ship(ship).unkeyed()).await;
        self.one_wins(&format!("creations of {ship}"), &replies, 409);
    }

    /// One key: one version, the same answer for all who get one.
    async fn same_key(&self, ship: &str) -> Result<(), Failure> {
        let (write, ledger) = (Write::version(ship, "keyed")?, Ledger::default());
        let place = ledger.begin(&write);
        for reply in self.all(|_| write.clone()).await {
            match reply.ok() {
                true => ledger.acknowledge(place, &reply, self.tally),
                false if in_progress(&reply) => {}
                false => self.tally.wrong(format!(
                    "the same key: {} {}",
                    reply.status,
                    reply.json()["detail"]
                )),
            }
        }
        ledger.repeat(place, &self.client, self.tally).await;
        ledger.check(&self.client, self.tally).await;
        Ok(())
    }

    /// Versions registered at once get numbers without a gap.
    async fn same_number(&self, ship: &str) -> Result<(), Failure> {
        let ledger = Ledger::default();
        let writes: Vec<Write> = (0..RACERS)
            .map(|racer| Write::version(ship, &format!("racer {racer}")))
            .collect::<Result<_, _>>()?;
        let writes: Vec<Write> = writes.into_iter().map(Write::unkeyed).collect();
        let places: Vec<usize> = writes.iter().map(|write| ledger.begin(write)).collect();
        let replies = self.all(|racer| writes[racer].clone()).await;
        if replies.len() != RACERS || !replies.iter().all(Reply::ok) {
            self.tally.wrong(format!(
                "{RACERS} versions at once: {:?}",
                replies.iter().map(|r| r.status).collect::<Vec<_>>()
            ));
        }
        replies
            .iter()
            .zip(places)
            .for_each(|(reply, place)| ledger.acknowledge(place, reply, self.tally));
        ledger.check(&self.client, self.tally).await;
        Ok(())
    }

    /// Creations of an alias, then moves of it by one ETag.
    async fn same_alias(&self, ship: &str) {
        let made = self.all(|racer| Write::alias(ship, &format!("made by {racer}"), 1, None)).await;
        self.one_wins(&format!("creations of an alias of {ship}"), &made, 412);
        let alias = self
            .client
            .send(self.client.request(Method::GET, &format!("/v1/models/{ship}/aliases/ledger")))
            .await;
        let Some(alias) = alias else { return self.tally.wrong("an alias is not answered") };
        let moved = self
            .all(|racer| {
                Write::alias(ship, &format!("moved by {racer}"), 2, Some(alias.header("etag")))
            })
            .await;
        self.one_wins(&format!("moves of an alias of {ship}"), &moved, 412);
    }

    /// The same samples: one trial.
    async fn same_upload(&self, ship: &str, number: u64) {
        let replies = self.all(|_| Write::trial(ship, "raced", number).unkeyed()).await;
        let new: u64 = replies.iter().filter_map(|reply| reply.json()["new"].as_u64()).sum();
        let ids: std::collections::BTreeSet<String> =
            replies.iter().map(|reply| reply.json()["trials"][0]["id"].to_string()).collect();
        if new != 1 || ids.len() != 1 || !replies.iter().all(Reply::ok) {
            self.tally.wrong(format!("one upload from {RACERS} tasks: {new} new, ids {ids:?}"));
        }
    }

    /// Changes of a ship by one ETag.
    async fn same_revision(&self, ship: &str) {
        let path = format!("/v1/ships/{ship}");
        let Some(now) = self.client.send(self.client.request(Method::GET, &path)).await else {
            return self.tally.wrong("a ship is not answered");
        };
        let changes = (0..RACERS).map(|racer| {
            let text = documents::ship(ship)
                .replace("A ship of", &format!("Changed by {racer}, a ship of"));
            let request =
                self.client.request(Method::PUT, &path).header("if-match", now.header("etag"));
            let (client, request) = (
                self.client.clone(),
                request.header("content-type", "application/yaml").body(text),
            );
            async move { client.send(request).await }
        });
        let replies = self.gather(changes).await;
        self.one_wins(&format!("changes of {ship}"), &replies, 412);
    }

    /// A ship that is deleted while it gets trials and versions: each is taken or refused, and none
    /// is half there.
    async fn deletion_and_use(&self, ship: &str) -> Result<(), Failure> {
        let (client, path) = (self.client.clone(), format!("/v1/ships/{ship}"));
        let etag = client
            .send(client.request(Method::GET, &path))
            .await
            .map(|reply| reply.header("etag").to_owned());
        let deletion =
            client.request(Method::DELETE, &path).header("if-match", etag.unwrap_or_default());
        let writes: Vec<Write> = (0..RACERS as u64)
            .map(|racer| match racer % 2 {
                0 => Ok(Write::trial(ship, &format!("late-{racer}"), 900_000_000 + racer)),
                _ => Write::version(ship, &format!("late {racer}")),
            })
            .collect::<Result<_, Failure>>()?;
        let deleted = {
            let client = client.clone();
            tokio::spawn(async move { client.send(deletion).await })
        };
        let replies = self.all(|racer| writes[racer].clone()).await;
        if !deleted.await?.is_some_and(|reply| reply.ok()) {
            self.tally.wrong(format!("{ship} is not deleted"));
        }
        for reply in replies
            .iter()
            .filter(|reply| !reply.ok() && ![404, 409, 410, 412, 422].contains(&reply.status))
        {
            self.tally.wrong(format!(
                "use of a ship under deletion: {} {}",
                reply.status,
                reply.json()["detail"]
            ));
        }
        let back = client.send(client.request(Method::POST, &format!("{path}/undelete"))).await;
        if !back.is_some_and(|reply| reply.ok()) {
            self.tally.wrong(format!("{ship} is not undeleted"));
        }
        let trials = client.items(&format!("/v1/trials?ship={ship}")).await.unwrap_or_default();
        let acknowledged = |reply: &&Reply| reply.ok() && reply.json()["trials"].is_array();
        for said in replies.iter().filter(acknowledged).map(Reply::json) {
            if !trials.iter().any(|trial: &Value| trial["id"] == said["trials"][0]["id"]) {
                self.tally.lost(format!("a trial acknowledged while its ship was deleted: {said}"));
            }
        }
        Ok(())
    }
}
