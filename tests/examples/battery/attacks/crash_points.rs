//! `crash points`: the same requests again and again, while the k-th operation on a file or a
//! socket kills the server, or fails.

use rand::seq::SliceRandom as _;

use crate::attack::{Attack, Failure, Field, Running};
use crate::client::Client;
use crate::faults::{Control, Faults, Strike};
use crate::ledger::Ledger;
use crate::place::Place;
use crate::process::Server;
use crate::writes::Write;

/// Points, however little time there is.
const FEWEST: usize = 10;
/// Longer than a key is held for whoever carries it out.
const AHEAD_S: i64 = 61;

/// The attack.
pub struct CrashPoints;

impl Attack for CrashPoints {
    fn name(&self) -> &'static str {
        "crash points"
    }

    fn share(&self) -> f64 {
        2.0
    }

    fn run<'a>(&'a self, field: &'a Field) -> Running<'a> {
        Box::pin(run(field))
    }
}

async fn run(field: &Field) -> Result<(), Failure> {
    let Some(faults) = field.faults.as_deref() else {
        field.tally.remark("skipped: no `cc` to build the faults with");
        return Ok(());
    };
    let place = field.place().await?;
    let control = Control::new(place.folder())?;
    let mut points = Points {
        field,
        faults,
        server: Some(place.serve_under(faults, &control).await?),
        place,
        control,
        round: 0,
    };
    let count = points.count().await?;
    // All of them where there is time for all, else a sample in an order of its own.
    let mut order: Vec<(i64, Strike)> = (1..=count).map(|at| (at, Strike::Kill)).collect();
    order.extend((1..=count).map(|at| (at, Strike::Full)));
    order.shuffle(&mut field.rng(0));
    let mut done = 0;
    for &(at, strike) in &order {
        if done >= FEWEST && !field.goes_on() {
            break;
        }
        points.crash(at, strike).await?;
        done += 1;
    }
    let starts = points.starts().await?;
    points.place.check("after the crash points").await?;
    let all = order.len();
    field.tally.remark(format!("{done} of {all} points of the sequence, {starts} of the start"));
    Ok(())
}

/// A server that is killed at chosen points.
struct Points<'a> {
    field: &'a Field,
    faults: &'a Faults,
    place: Place,
    control: Control,
    server: Option<Server>,
    round: i64,
}

impl Points<'_> {
    /// The server, started where there is none.
    async fn client(&mut self) -> Result<Client, Failure> {
        if let Some(server) = &self.server {
            return Ok(server.client.clone());
        }
        let server = self.place.serve_under(self.faults, &self.control).await?;
        let client = server.client.clone();
        self.server = Some(server);
        Ok(client)
    }

    /// The operations of the sequence.
    async fn count(&mut self) -> Result<i64, Failure> {
        self.control.arm(Strike::Nothing, 0)?;
        let client = self.client().await?;
        let ledger = self.sequence(&client).await?;
        if ledger.entries().iter().any(|entry| entry.acknowledged.is_none()) {
            return Err("the sequence is not acknowledged without a fault".into());
        }
        Ok(self.control.counted()?)
    }

    /// Sends the sequence with new names; what is not answered ends it.
    async fn sequence(&mut self, client: &Client) -> Result<Ledger, Failure> {
        self.round += 1;
        let (ship, ledger) = (format!("crash-{}", self.round), Ledger::default());
        let number = 1_000 + self.round as u64;
        let sequence = [
            Write::ship(&ship),
            Write::tag(&ship, "crashed"),
            Write::version(&ship, "first")?,
            Write::alias(&ship, "set", 1, None),
            Write::law(&ship, &format!("{ship}-law")),
            Write::trial(&ship, "trial", number),
            Write::refinement(&ship, "refined"),
            Write::version(&ship, "second")?,
        ];
        for write in &sequence {
            let place = ledger.begin(write);
            if write
                .send(client)
                .await
                .map(|reply| keep(&ledger, place, &reply, self.field))
                .is_none()
            {
                break;
            }
        }
        Ok(ledger)
    }

    /// One point: the fault, a restart, the same requests under the same keys, and a look at all of
    /// it.
    async fn crash(&mut self, at: i64, strike: Strike) -> Result<(), Failure> {
        let client = self.client().await?;
        self.control.arm(strike, at)?;
        let ledger = self.sequence(&client).await?;
        self.control.arm(Strike::Nothing, 0)?;
        // A key whose answer could not be kept is held for a while, on a full disk as after a kill.
        self.control.ahead(AHEAD_S * self.round)?;
        let killed = strike == Strike::Kill && self.killed().await;
        if let Some(server) = self.server.as_mut().filter(|_| !killed) {
            server.lives(&format!("{strike:?} at operation {at}")).await?;
        }
        let client = self.client().await?;
        let open: Vec<usize> = ledger
            .entries()
            .iter()
            .enumerate()
            .filter(|(_, entry)| entry.acknowledged.is_none())
            .map(|(place, _)| place)
            .collect();
        for place in open {
            ledger.repeat(place, &client, &self.field.tally).await;
        }
        ledger.check(&client, &self.field.tally).await;
        Ok(())
    }

    /// Whether the fault has killed the server, as it was meant to.
    async fn killed(&mut self) -> bool {
        let Some(mut server) = self.server.take() else { return false };
        if server.process.ended_within(std::time::Duration::from_millis(300)).await {
            server.process.dismiss();
            return true;
        }
        self.server = Some(server);
        false
    }

    /// Kills first starts on empty databases at their k-th operation: the next start brings the
    /// store up.
    async fn starts(&mut self) -> Result<usize, Failure> {
        let (mut done, mut at) = (0, 1);
        while done < 3 || self.field.goes_on() {
            let place = self.field.place().await?;
            let control = Control::new(place.folder())?;
            control.arm(Strike::Kill, at)?;
            self.field.tally.tried(1);
            let killed = place.serve_under(self.faults, &control).await;
            control.arm(Strike::Nothing, 0)?;
            if let Ok(server) = killed {
                server.process.kill();
                break;
            }
            place
                .serve()
                .await
                .map_err(|error| format!("after a first start killed at operation {at}: {error}"))?
                .process
                .kill();
            place.check(&format!("after a first start killed at operation {at}")).await?;
            (done, at) = (done + 1, at * 2 + 1);
        }
        Ok(done)
    }
}

/// Keeps an answer of success; another is one of a server at fault, and judged by its status alone.
fn keep(ledger: &Ledger, place: usize, reply: &crate::client::Reply, field: &Field) {
    if reply.ok() {
        ledger.acknowledge(place, reply, &field.tally);
    }
}
