//! `full disk`: the data folder is a small file system that fills up. Writes are refused with 507,
//! reads go on, a start is possible, and when there is room again everything is as before.

use std::fs::File;
use std::io::Write as _;
use std::path::PathBuf;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use rand::RngExt as _;
use reqwest::Method;

use crate::attack::{Attack, Failure, Field, Running};
use crate::client::Client;
use crate::ledger::Ledger;
use crate::place::{Database, Place};
use crate::writes::Write;

const SIZE: &str = "size=48m";
/// Rounds of writes for one ship before the next one: a refinement takes at most 1000 trials.
const FOR_ONE_SHIP: u64 = 40;
/// The largest room that is left when the disk is said to be full, bytes.
const ROOM: u64 = 64 << 10;

/// The longest that the key of a process that has ended is held, and some time to find out.
const HELD: Duration = Duration::from_secs(75);

/// The attack.
pub struct FullDisk;

impl Attack for FullDisk {
    fn name(&self) -> &'static str {
        "full disk"
    }

    fn run<'a>(&'a self, field: &'a Field) -> Running<'a> {
        Box::pin(run(field))
    }
}

/// A small file system; it is taken away when this is dropped.
struct Disk(PathBuf);

impl Disk {
    fn mount(at: PathBuf) -> Option<Self> {
        std::fs::create_dir_all(&at).ok()?;
        let mut mount = Command::new("mount");
        mount.args(["-t", "tmpfs", "-o", SIZE, "tmpfs"]).arg(&at).stderr(Stdio::null());
        mount.status().is_ok_and(|status| status.success()).then_some(Self(at))
    }

    /// Fills it but for some room.
    fn fill(&self, room: u64) -> std::io::Result<()> {
        let path = self.ballast();
        let mut file = File::create(&path)?;
        let block = vec![0; 4096];
        while file.write_all(&block).is_ok() {}
        let length = file.metadata()?.len();
        file.set_len(length.saturating_sub(room))
    }

    fn empty(&self) -> std::io::Result<()> {
        std::fs::remove_file(self.ballast())
    }

    fn ballast(&self) -> PathBuf {
        self.0.join("ballast")
    }
}

impl Drop for Disk {
    fn drop(&mut self) {
        let _ = Command::new("umount").arg("-l").arg(&self.0).status();
    }
}

async fn run(field: &Field) -> Result<(), Failure> {
    let mut place = field.place().await?;
    let Some(disk) = Disk::mount(place.folder().join("disk")) else {
        field.tally.remark("skipped: no tmpfs can be mounted here");
        return Ok(());
    };
    place.data = disk.0.join("data");
    if field.database == Database::Sqlite {
        place.database.url = format!("sqlite://{}", disk.0.join("store.db").display());
    }
    let outcome = filled(field, &place, &disk).await;
    // The file system cannot go before what uses it.
    drop(disk);
    outcome
}

async fn filled(field: &Field, place: &Place, disk: &Disk) -> Result<(), Failure> {
    let (ledger, mut rng, mut round) = (Ledger::default(), field.rng(0), 0);
    let mut server = place.serve().await?;
    let mut ship = String::new();
    while round == 0 || field.goes_on() {
        if round % FOR_ONE_SHIP == 0 {
            ship = format!("filled-{}", round / FOR_ONE_SHIP);
            for write in Write::first(&ship, 1)? {
                ledger.send(ledger.begin(&write), &server.client, &field.tally).await;
            }
        }
        let ship = ship.as_str();
        round += 1;
        disk.fill(if round == 1 { 0 } else { rng.random_range(0..ROOM) })?;
        writes(field, &server.client, &ledger, ship, round).await?;
        reads(field, &server.client, ship, "on a full disk").await;
        server.lives("on a full disk").await?;
        server.process.kill();
        server = match place.serve().await {
            Ok(server) => server,
            Err(failure) => {
                field.tally.wrong(format!("no start on a full disk: {failure}"));
                disk.empty()?;
                place.serve().await?
            }
        };
        reads(field, &server.client, ship, "of a server started on a full disk").await;
        if disk.ballast().exists() {
            disk.empty()?;
        }
        recovered(field, &server.client, &ledger, ship, round).await?;
    }
    ledger.check(&server.client, &field.tally).await;
    server.process.kill();
    place.check("after a full disk").await?;
    field.tally.remark(format!("filled {round} times"));
    Ok(())
}

/// Writes of every kind: each is acknowledged, if there is room for it, or refused by 507.
async fn writes(
    field: &Field,
    client: &Client,
    ledger: &Ledger,
    ship: &str,
    round: u64,
) -> Result<(), Failure> {
    let name = |what: &str| format!("{ship}-{what}-{round}");
    let mut writes = vec![
        Write::ship(&name("ship")),
        Write::law(ship, &name("law")),
        Write::version(ship, &name("version"))?,
        Write::refinement(ship, &name("refined")),
        Write::tag(ship, &name("tag")),
    ];
    writes.extend(
        (0..20)
            .map(|more| Write::trial(ship, &name(&format!("trial-{more}")), 1000 * round + more)),
    );
    for write in writes {
        let place = ledger.begin(&write);
        match write.send(client).await {
            Some(reply) if reply.ok() => ledger.acknowledge(place, &reply, &field.tally),
            Some(reply) if reply.status >= 500 => {}
            Some(reply) => {
                field.tally.wrong(format!("{:?} on a full disk: {}", write.kind, reply.status))
            }
            None => field.tally.wrong(format!("{:?} on a full disk: no answer", write.kind)),
        }
    }
    large(field, client, ship).await;
    Ok(())
}

/// An upload for which there is no room.
async fn large(field: &Field, client: &Client, ship: &str) {
    let rows: String = (0..200_000).map(|row| format!("{row},1.{row:06}\n")).collect();
    let request = client
        .request(Method::POST, &format!("/v1/trials?ship={ship}&name=large.csv&diagnose=false"));
    let reply = client
        .send(request.header("content-type", "text/csv").body(format!("t_s,u_m_s\n{rows}")))
        .await;
    match reply.map(|reply| reply.status) {
        Some(500..=599) => {}
        other => field.tally.wrong(format!("a large upload on a full disk: {other:?}, not 507")),
    }
}

async fn reads(field: &Field, client: &Client, ship: &str, when: &str) {
    let paths = [
        "/healthz".to_owned(),
        "/v1/ships".to_owned(),
        format!("/v1/ships/{ship}"),
        format!("/v1/trials?ship={ship}"),
        format!("/v1/models/{ship}/versions/1/document"),
        "/v1/ships/mariner/model".to_owned(),
    ];
    for path in paths {
        let reply = client.send(client.request(Method::GET, &path)).await;
        if !reply.as_ref().is_some_and(|reply| reply.ok()) {
            field.tally.wrong(format!("{path} {when}: {:?}", reply.map(|reply| reply.status)));
        }
    }
}

/// With room again, what is sent is taken, and a key that was refused is free.
async fn recovered(
    field: &Field,
    client: &Client,
    ledger: &Ledger,
    ship: &str,
    round: u64,
) -> Result<(), Failure> {
    let open: Vec<usize> = {
        let entries = ledger.entries();
        let open = |place: &usize| entries[*place].acknowledged.is_none();
        (0..entries.len()).filter(open).collect()
    };
    for place in open {
        // A process that ended before it could say that a request has failed holds its key for a
        // minute.
        let until = Instant::now() + HELD;
        let mut taken = ledger.repeat(place, client, &field.tally).await;
        while taken == Some(false) && Instant::now() < until {
            tokio::time::sleep(Duration::from_secs(1)).await;
            taken = ledger.repeat(place, client, &field.tally).await;
        }
        if taken != Some(true) {
            let mark = ledger.entries()[place].write.mark.clone();
            field.tally.wrong(format!("{mark} is not taken though there is room again"));
        }
    }
    let write = Write::version(ship, &format!("with room {round}"))?;
    if ledger.send(ledger.begin(&write), client, &field.tally).await != Some(true) {
        field.tally.wrong("no version is taken though there is room again");
    }
    Ok(())
}
