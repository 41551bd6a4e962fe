//! `neighbours`: one caller floods the queue, the sign-in, the webhooks or the reading of sheets,
//! and another must hardly notice.

use std::io::Write as _;
use std::time::{Duration, Instant};

use reqwest::Method;
use serde_json::{Value, json};
use tokio::net::TcpListener;
use tokio::task::JoinSet;

use crate::attack::{Attack, Failure, Field, Running};
use crate::client::Client;
use crate::documents;
use crate::place::Place;
use crate::process::Server;

/// The server's own key.
const OWNER: &str = "neighbours-of-the-battery";
/// Large jobs of the neighbour.
const LARGE: usize = 400;
/// A small job beside them must begin within this.
const BEGINS: Duration = Duration::from_secs(10);
/// An upload beside a flood must be answered within this, 19 times of 20, or within `SLOWER` times
/// of what it takes without a flood, where the machine is busy with other work.
const ANSWERED: Duration = Duration::from_secs(1);
const SLOWER: u32 = 4;
/// Fewest uploads that a percentile is taken of.
const UPLOADS: usize = 40;
/// A delivery beside silent receivers must arrive within this.
const DELIVERED: Duration = Duration::from_secs(5);
/// Requests of a flood at a time.
const FLOOD: usize = 32;
const NAMESPACE: &str = "http://schemas.openxmlformats.org";
/// Rows of the sheet: about a second of reading in a release build.
const SHEET_ROWS: usize = 60_000;

/// The attack.
pub struct Neighbours;

impl Attack for Neighbours {
    fn name(&self) -> &'static str {
        "neighbours"
    }

    fn works(&self) -> bool {
        true
    }

    fn least_minutes(&self) -> f64 {
        5.0
    }

    fn run<'a>(&'a self, field: &'a Field) -> Running<'a> {
        Box::pin(run(field))
    }
}

/// The caller whose uploads are timed.
struct Uploader {
    client: Client,
    key: String,
    /// 95th percentile of their times without a flood.
    alone: Duration,
    /// Time of each flood.
    time: Duration,
}

async fn run(field: &Field) -> Result<(), Failure> {
    let place = field.place().await?;
    let server = serve(&place).await?;
    let (ann, bob) = (key(&server.client, "ann").await?, key(&server.client, "bob").await?);
    let time = field.left() / 4;
    webhooks(field, &server.client).await?;
    let alone = uploads(&server.client, &bob, Duration::ZERO).await?;
    field.tally.remark(format!("uploads alone {} ms (p95)", alone.as_millis()));
    let uploader = Uploader { client: server.client.clone(), key: bob.clone(), alone, time };
    sign_ins(field, &uploader).await?;
    sheets(field, &uploader, &ann).await?;
    queue(field, &server.client, &ann, &bob).await?;
    server.process.kill();
    place.check("after the neighbours").await
}

async fn serve(place: &Place) -> Result<Server, Failure> {
    let start = place.start().environment([("SISTERSHIP_API_KEY", OWNER)]);
    let flags = ["--accounts", "--webhooks-private", "--trusted-proxy", "127.0.0.0/8"];
    flags.into_iter().fold(start, |start, flag| start.argument(flag)).server().await
}

/// A service key of an engineer.
async fn key(client: &Client, title: &str) -> Result<String, Failure> {
    let body = json!({ "title": title, "roles": [{ "role": "engineer" }] });
    let request = client.request(Method::POST, "/v1/keys").bearer_auth(OWNER).json(&body);
    let made = client.try_send(request).await?.json();
    made["key"].as_str().map(str::to_owned).ok_or_else(|| format!("no key: {made}").into())
}

/// Sends a document; gives the answer where it is one of success.
async fn post(client: &Client, key: &str, path: &str, body: &Value) -> Result<Value, Failure> {
    let request = client.request(Method::POST, path).bearer_auth(key).json(body);
    let reply = client.try_send(request).await?;
    if reply.ok() { Ok(reply.json()) } else { Err(format!("{path}: {}", reply.json()).into()) }
}

/// A ship with the trials that a refinement learns from.
async fn ship_with_trials(client: &Client, key: &str, name: &str) -> Result<(), Failure> {
    let ship = client.request(Method::POST, "/v1/ships").bearer_auth(key);
    let ship = ship.header("content-type", "application/yaml").body(documents::ship(name));
    client.try_send(ship).await?;
    for (file, csv) in documents::trials()? {
        let path = format!("/v1/trials?ship={name}&name={file}&diagnose=false");
        let trial = client.request(Method::POST, &path).bearer_auth(key);
        let trial = trial.header("content-type", "text/csv").body(csv);
        let reply = client.try_send(trial).await?;
        if !reply.ok() {
            return Err(format!("no trial: {}", reply.json()).into());
        }
    }
    Ok(())
}

/// Beside many large jobs of one person a small one of another begins soon.
async fn queue(field: &Field, client: &Client, ann: &str, bob: &str) -> Result<(), Failure> {
    ship_with_trials(client, ann, "ship-of-ann").await?;
    ship_with_trials(client, bob, "ship-of-bob").await?;
    let settings = json!({ "method": "cma-es" });
    let large =
        json!({ "ship": "ship-of-ann", "source": documents::PATTERN, "settings": settings });
    for _ in 0..LARGE {
        post(client, ann, "/v1/refinements", &large).await?;
    }
    // The worker has begun one of them by now.
    tokio::time::sleep(Duration::from_secs(1)).await;
    let settings = json!({ "method": "published" });
    let small =
        json!({ "ship": "ship-of-bob", "source": documents::PATTERN, "settings": settings });
    let (begun, job) = (Instant::now(), post(client, bob, "/v1/refinements", &small).await?);
    let path = format!("/v1/jobs/{}", job["id"].as_str().unwrap_or_default());
    let seen = async || {
        let request = client.request(Method::GET, &path).bearer_auth(bob);
        client.send(request).await.map_or(Value::Null, |reply| reply.json())
    };
    while seen().await["state"] == "queued" && begun.elapsed() < 6 * BEGINS {
        tokio::time::sleep(Duration::from_millis(50)).await;
    }
    let took = begun.elapsed();
    if took > BEGINS {
        field.tally.wrong(format!("a small job began after {took:.1?} beside {LARGE} large ones"));
    }
    let cancel = client.request(Method::DELETE, "/v1/jobs").bearer_auth(ann);
    let cancelled = client.try_send(cancel).await?.json();
    let count = cancelled["cancelled"].as_array().map_or(0, Vec::len);
    field.tally.remark(format!(
        "job at place {} begun after {:.2} s, {count} cancelled at once",
        job["place"],
        took.as_secs_f64()
    ));
    Ok(())
}

/// Uploads of a caller while a flood goes on; gives the 95th percentile of their times.
async fn uploads(client: &Client, key: &str, time: Duration) -> Result<Duration, Failure> {
    let (until, mut times, mut number) = (Instant::now() + time, Vec::new(), 0);
    while times.len() < UPLOADS || Instant::now() < until {
        number += 1;
        // Without the diagnosis that an upload for a ship with a champion queues.
        let query = format!("name={number}.csv&diagnose=false");
        let path = format!("/v1/trials?ship={}&{query}", documents::PATTERN);
        let request = client.request(Method::POST, &path).bearer_auth(key);
        let request = request.header("content-type", "text/csv").body(documents::rows(number));
        let begun = Instant::now();
        let reply = client.try_send(request).await?;
        if !reply.ok() {
            return Err(format!("an upload beside a flood: {}", reply.json()).into());
        }
        times.push(begun.elapsed());
    }
    times.sort_unstable();
    Ok(times[times.len() * 19 / 20])
}

/// Runs a flood in many tasks while uploads are timed.
async fn beside<F: Future<Output = ()> + Send>(
    field: &Field,
    what: &str,
    flood: impl Fn(usize) -> F + Clone + Send + 'static,
    uploader: &Uploader,
) -> Result<(), Failure> {
    let mut tasks = JoinSet::new();
    for task in 0..FLOOD {
        let flood = flood.clone();
        tasks.spawn(async move {
            for round in 0.. {
                flood(round * FLOOD + task).await;
            }
        });
    }
    let took = uploads(&uploader.client, &uploader.key, uploader.time).await;
    tasks.shutdown().await;
    let took = took?;
    if took > ANSWERED && took > SLOWER * uploader.alone {
        field.tally.wrong(format!("uploads take {took:.1?} (p95) beside {what}"));
    }
    field.tally.remark(format!("uploads beside {what} {} ms (p95)", took.as_millis()));
    Ok(())
}

/// Guesses of passwords from many addresses.
async fn sign_ins(field: &Field, uploader: &Uploader) -> Result<(), Failure> {
    let client = &uploader.client;
    let page = client.try_send(client.request(Method::GET, "/sign-in")).await?;
    let page = String::from_utf8_lossy(&page.bytes).into_owned();
    let token = page.split("name=\"form_token\" value=\"").nth(1).unwrap_or_default();
    let token = token.split('"').next().unwrap_or_default().to_owned();
    let flooding = client.clone();
    let flood = move |number: usize| {
        let client = flooding.clone();
        let body =
            format!("form_token={token}&name=nobody-{number}&password=a+wrong+sentence+of+mine");
        let request = client
            .request(Method::POST, "/sign-in")
            .header("content-type", "application/x-www-form-urlencoded")
            .header("origin", format!("http://{}", client.address))
            .header("x-forwarded-for", format!("203.0.{}.{}", number / 250, number % 250))
            .body(body);
        async move {
            client.send(request).await;
        }
    };
    beside(field, "sign-ins", flood, uploader).await
}

/// Checks of a large sheet by one caller.
async fn sheets(field: &Field, uploader: &Uploader, ann: &str) -> Result<(), Failure> {
    let sheet = sheet()?;
    field.tally.remark(format!("sheet of {} kB", sheet.len() / 1000));
    let (flooding, key) = (uploader.client.clone(), ann.to_owned());
    let flood = move |_| {
        let client = flooding.clone();
        let manifest = json!({ "kind": "trials", "ship": documents::PATTERN,
            "trials": [{ "file": "a.xlsx" }] });
        let part = reqwest::multipart::Part::bytes(sheet.clone()).file_name("a.xlsx");
        let form = reqwest::multipart::Form::new()
            .text("manifest", manifest.to_string())
            .part("file", part);
        let request = client.request(Method::POST, "/v1/trials/check").bearer_auth(&key);
        let request = request.multipart(form);
        async move {
            client.send(request).await;
        }
    };
    beside(field, "sheets", flood, uploader).await
}

/// A workbook of many equal rows, which packs well.
fn sheet() -> Result<Vec<u8>, Failure> {
    let main = format!("{NAMESPACE}/spreadsheetml/2006/main");
    let kinds = format!("{NAMESPACE}/officeDocument/2006/relationships");
    let related = |kind: &str, target: &str| {
        format!(
            r#"<Relationships xmlns="{NAMESPACE}/package/2006/relationships"><Relationship Id="r1" Type="{kinds}/{kind}" Target="{target}"/></Relationships>"#
        )
    };
    let parts = [
        ("_rels/.rels", related("officeDocument", "xl/workbook.xml")),
        ("xl/_rels/workbook.xml.rels", related("worksheet", "worksheets/sheet1.xml")),
        (
            "xl/workbook.xml",
            format!(
                r#"<workbook xmlns="{main}" xmlns:r="{kinds}"><sheets><sheet name="a" sheetId="1" r:id="r1"/></sheets></workbook>"#
            ),
        ),
        (
            "xl/worksheets/sheet1.xml",
            format!(r#"<worksheet xmlns="{main}"><sheetData>{}</sheetData></worksheet>"#, rows()),
        ),
    ];
    let mut zip = zip::ZipWriter::new(std::io::Cursor::new(Vec::new()));
    for (name, text) in parts {
        zip.start_file(name, zip::write::SimpleFileOptions::default())?;
        zip.write_all(text.as_bytes())?;
    }
    Ok(zip.finish()?.into_inner())
}

/// Rows of the sheet, below the names of its columns.
fn rows() -> String {
    let columns = ["t_s", "u_m_s", "v_m_s", "r_rad_s", "delta_rad", "n_rps"];
    let name = |name: &&str| format!(r#"<c t="inlineStr"><is><t>{name}</t></is></c>"#);
    let names: String = columns.iter().map(name).collect();
    let rest = "<c><v>1</v></c>".repeat(columns.len() - 1);
    let rows = (0..SHEET_ROWS).map(|row| format!("<row><c><v>{row}</v></c>{rest}</row>"));
    format!("<row>{names}</row>{}", rows.collect::<String>())
}

/// Receivers that never answer beside one that does.
async fn webhooks(field: &Field, client: &Client) -> Result<(), Failure> {
    let silent = TcpListener::bind("127.0.0.1:0").await?;
    let good = TcpListener::bind("127.0.0.1:0").await?;
    let url = |listener: &TcpListener| {
        listener.local_addr().map(|address| format!("http://{address}/hook"))
    };
    let urls = std::iter::repeat_n(url(&silent)?, 24).chain([url(&good)?]);
    for url in urls {
        let body = json!({ "title": "T", "url": url, "events": ["champion.moved"] });
        post(client, OWNER, "/v1/webhooks", &body).await?;
    }
    let held = tokio::spawn(async move {
        let mut held = Vec::new();
        while let Ok((stream, _)) = silent.accept().await {
            held.push(stream);
        }
    });
    let mut worst = Duration::ZERO;
    for number in 0..6 {
        let path = format!("/v1/models/{}/aliases/champion", documents::PATTERN);
        let body = json!({ "version": 1, "reason": format!("move {number}") });
        let put = client.request(Method::PUT, &path).bearer_auth(OWNER);
        let moved = client.try_send(put.header("if-match", "*").json(&body)).await?;
        if !moved.ok() {
            return Err(format!("no move: {}", moved.json()).into());
        }
        let begun = Instant::now();
        let (mut stream, _) = match tokio::time::timeout(6 * DELIVERED, good.accept()).await {
            Ok(accepted) => accepted?,
            Err(_) => return Err("a delivery does not arrive beside silent receivers".into()),
        };
        worst = worst.max(begun.elapsed());
        answer(&mut stream).await?;
    }
    held.abort();
    if worst > DELIVERED {
        field.tally.wrong(format!("a delivery took {worst:.1?} beside 24 silent receivers"));
    }
    field.tally.remark(format!("delivery beside 24 silent {:.2} s", worst.as_secs_f64()));
    Ok(())
}

async fn answer(stream: &mut tokio::net::TcpStream) -> Result<(), Failure> {
    use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};
    let mut request = vec![0; 1 << 14];
    // Any part of the request will do.
    let _ = stream.read(&mut request).await?;
    let said = b"HTTP/1.1 204 No Content\r\nconnection: close\r\n\r\n";
    Ok(stream.write_all(said).await?)
}
