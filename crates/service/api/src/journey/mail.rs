//! Mail of events, to a small SMTP server on this machine.

use std::sync::{Arc, Mutex};
use std::time::Duration;

use serde_json::{Value, json};
use sistership_store::testing::TestDatabase;
use tokio::io::{AsyncBufReadExt, AsyncWriteExt, BufReader};
use tokio::net::{TcpListener, TcpStream};

use super::harness::{Harness, config, read};
use crate::{MailSettings, Server};

/// Receivers and text of the mails that a server has taken.
type Mails = Arc<Mutex<Vec<(String, String)>>>;

/// An SMTP server that defers the first receiver (RFC 5321, 4.2.1), and takes all mail after that.
#[derive(Clone, Default)]
struct MailServer {
    mails: Mails,
    deferred: Arc<Mutex<bool>>,
}

impl MailServer {
    /// Starts the server; returns it with its URL.
    async fn start() -> (Self, String) {
        let (server, listener) = (Self::default(), TcpListener::bind("127.0.0.1:0").await.unwrap());
        let url = format!("smtp://{}", listener.local_addr().unwrap());
        let own = server.clone();
        tokio::spawn(async move {
            while let Ok((stream, _)) = listener.accept().await {
                tokio::spawn(own.clone().converse(stream));
            }
        });
        (server, url)
    }

    async fn converse(self, stream: TcpStream) {
        let mut stream = BufReader::new(stream);
        let mut receiver = String::new();
        stream.write_all(b"220 test ready\r\n").await.unwrap();
        while let Some(line) = read_line(&mut stream).await {
            let answer = match line.split([' ', ':']).next().unwrap_or_default() {
                "EHLO" => "250 test".to_owned(),
                "MAIL" => "250 sender ok".to_owned(),
                "RCPT" => self.take_receiver(&mut receiver, &line),
                "DATA" => {
                    stream.write_all(b"354 go on\r\n").await.unwrap();
                    let mut text = Vec::new();
                    while let Some(line) = read_line(&mut stream).await.filter(|line| line != ".") {
                        text.push(line);
                    }
                    self.mails.lock().unwrap().push((receiver.clone(), text.join("\n")));
                    "250 taken".to_owned()
                }
                "QUIT" => break,
                _ => "500 unknown".to_owned(),
            };
            stream.write_all(format!("{answer}\r\n").as_bytes()).await.unwrap();
        }
    }

    fn take_receiver(&self, receiver: &mut String, line: &str) -> String {
        *receiver = line.trim_start_matches("RCPT TO:").trim_matches(['<', '>']).to_owned();
        let mut deferred = self.deferred.lock().unwrap();
        match std::mem::replace(&mut *deferred, true) {
            true => "250 receiver ok".to_owned(),
            false => "451 try again later".to_owned(),
        }
    }
}

async fn read_line(stream: &mut BufReader<TcpStream>) -> Option<String> {
    let mut line = String::new();
    stream.read_line(&mut line).await.ok().filter(|bytes| *bytes > 0)?;
    Some(line.trim_end().to_owned())
}

async fn start_server(smtp_url: Option<String>) -> Harness {
    let database = TestDatabase::new_sqlite();
    let mut config = config(&database);
    let from = "Sistership <ships@ships.example>".to_owned();
    config.mail = smtp_url.map(|smtp_url| MailSettings { smtp_url, from });
    let server = Server::start(config).await.unwrap();
    Harness { server, client: reqwest::Client::new(), database }
}

impl Harness {
    /// Creates a webhook of a mail box.
    async fn create_mail(&self, url: &str) -> (reqwest::StatusCode, Value) {
        let asked = json!({ "title": "Master", "url": url, "events": ["champion.moved"] });
        self.post("/v1/webhooks", &asked).await
    }

    /// Waits for the next result of the latest delivery.
    async fn delivery_answer(&self, id: &str, expected: &str) -> Value {
        for _ in 0..400 {
            let listed = self.get(&format!("/v1/webhooks/{id}/deliveries")).await;
            if listed["items"][0]["answer"].as_str().is_some_and(|said| said.contains(expected)) {
                return listed["items"][0].clone();
            }
            tokio::time::sleep(Duration::from_millis(50)).await;
        }
        panic!("the delivery has no answer {expected}");
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn a_change_is_mailed_once_also_after_a_deferral() {
    let (mail_server, url) = MailServer::start().await;
    let harness = start_server(Some(url)).await;
    let settings = json!({ "second_person": false, "public_url": "https://ships.example" });
    let put = harness.client.put(harness.url("/v1/settings")).json(&settings);
    assert_eq!(read(put.send().await.unwrap()).await.0, 200);
    let (status, made) = harness.create_mail("mailto:master@fleet.example").await;
    assert_eq!(status, 201, "{made}");
    let id = made["about"]["id"].as_str().unwrap().to_owned();

    let path = "/v1/models/mariner/aliases/champion";
    let present = harness.get(path).await;
    let asked = json!({ "version": present["version"], "reason": "looked over" });
    let revision = format!("\"{}\"", present["revision"]);
    let moved = harness.client.put(harness.url(path)).header("if-match", revision).json(&asked);
    assert!(moved.send().await.unwrap().status().is_success());

    // The deferral is shown, and the mail stays due.
    let deferred = harness.delivery_answer(&id, "451").await;
    assert!(deferred["due_us"].is_i64() && deferred["delivered_us"].is_null(), "{deferred}");
    let page = harness.client.get(harness.url("/webhooks")).send().await.unwrap();
    assert!(page.text().await.unwrap().contains("451"), "the page shows the failure");
    let again = format!("/v1/webhooks/{id}/deliveries/{}/retry", deferred["id"].as_str().unwrap());
    assert_eq!(harness.post(&again, &json!({})).await.0, 200);
    let sent = harness.delivery_answer(&id, "250").await;
    assert!(sent["delivered_us"].is_i64(), "{sent}");

    let mails = mail_server.mails.lock().unwrap().clone();
    let [(receiver, text)] = mails.as_slice() else { panic!("{} mails", mails.len()) };
    assert_eq!(receiver, "master@fleet.example");
    for line in [
        "Subject: mariner: version 1 is in use now (looked over).",
        "To: master@fleet.example",
        "From: Sistership <ships@ships.example>",
        "Auto-Submitted: auto-generated",
        "https://ships.example/ships/mariner/versions/1",
    ] {
        assert!(text.contains(line), "{line} is not in {text}");
    }
    assert!(
        text.contains(&format!("Message-ID: <{}@ships.example>", sent["id"].as_str().unwrap()))
    );
    harness.server.stop().await;
}

#[tokio::test(flavor = "multi_thread")]
async fn mail_needs_a_server_and_a_public_box() {
    let harness = start_server(None).await;
    let (status, problem) = harness.create_mail("mailto:master@fleet.example").await;
    assert!(status == 422 && problem.to_string().contains("--mail-from"), "{problem}");
    harness.server.stop().await;
    let harness = start_server(Some("smtp://127.0.0.1:9".to_owned())).await;
    for url in ["mailto:root@localhost", "mailto:ann@[10.0.0.1]", "mailto:ann@host.internal"] {
        let (status, problem) = harness.create_mail(url).await;
        assert!(status == 422 && problem.to_string().contains("public domain"), "{problem}");
    }
    harness.server.stop().await;
}
