//! `hostile`: requests that nobody should send. First those that once did harm, each judged by what
//! it must answer; then requests from a seeded grammar to every route of `api/openapi.json`, judged
//! by their status and by whether the server lives.

mod bodies;
mod contract;
mod grammar;
mod known;
mod raw;
mod request;

use std::time::{Duration, Instant};

use crate::attack::{Attack, Failure, Field, Running};
use crate::client::clipped;
use crate::process::Server;
use crate::writes::Write;

use contract::Contract;
use grammar::Grammar;
use raw::{Answer, Raw};

/// An answer that takes longer is wrong, whatever it says.
const PATIENCE: Duration = Duration::from_secs(if cfg!(debug_assertions) { 10 } else { 5 });
/// Requests between looks at the health of the server.
const BETWEEN: u64 = 200;

/// The attack.
pub struct Hostile;

impl Attack for Hostile {
    fn name(&self) -> &'static str {
        "hostile"
    }

    fn share(&self) -> f64 {
        3.0
    }

    fn run<'a>(&'a self, field: &'a Field) -> Running<'a> {
        Box::pin(run(field))
    }
}

async fn run(field: &Field) -> Result<(), Failure> {
    let place = field.place().await?;
    let mut server = place.serve().await?;
    for write in [
        Write::ship("target"),
        Write::version("target", "a target")?,
        Write::trial("target", "one", 1),
    ] {
        write.send(&server.client).await.ok_or("no target")?;
    }
    for known in known::all(server.client.address) {
        let answer = attack(field, &mut server, &known.raw, known.what).await?;
        let Some(answer) = answer else { continue };
        let status = answer.status.unwrap_or(0);
        if !known.statuses.contains(&status) {
            let body = clipped(&answer.body);
            field.tally.wrong(format!("{}: {status} {body}, not {:?}", known.what, known.statuses));
        }
    }
    let contract = Contract::read()?;
    let mut grammar = Grammar::new(field.seed, contract);
    let mut sent = 0;
    while sent < BETWEEN || field.goes_on() {
        let raw = grammar.request(server.client.address);
        sent += 1;
        attack(field, &mut server, &raw, &format!("seed {}, request {sent}", field.seed)).await?;
        if sent % BETWEEN == 0 {
            healthy(field, &server).await;
        }
    }
    server.process.kill();
    place.check("after hostile requests").await?;
    field.tally.remark(format!("{sent} of the grammar, {} routes", grammar.routes()));
    Ok(())
}

/// Sends one request and judges what can be judged of any; none where the server has ended.
async fn attack(
    field: &Field,
    server: &mut Server,
    raw: &Raw,
    what: &str,
) -> Result<Option<Answer>, Failure> {
    field.tally.tried(1);
    let begun = Instant::now();
    let answer = raw.send(server.client.address, 3 * PATIENCE).await;
    let said = || format!("{what}: {}", raw.shown());
    if answer.status.is_none() && !server.lives(&said()).await? {
        return Ok(None);
    }
    match answer.status {
        Some(status) => {
            field.tally.status(status, || format!("{}: {}", said(), clipped(&answer.body)))
        }
        // Who sends more than is taken may be cut off before he reads why.
        None if raw.may_be_cut() => {}
        None => field.tally.wrong(format!("{}: no answer: {}", said(), answer.body)),
    }
    if begun.elapsed() > PATIENCE {
        field.tally.wrong(format!("{} takes {:.1} s", said(), begun.elapsed().as_secs_f64()));
    }
    Ok(Some(answer))
}

async fn healthy(field: &Field, server: &Server) {
    let request = server.client.request(reqwest::Method::GET, "/readyz");
    if !server.client.send(request).await.is_some_and(|reply| reply.ok()) {
        field.tally.wrong("the server is not ready amid hostile requests");
    }
}
