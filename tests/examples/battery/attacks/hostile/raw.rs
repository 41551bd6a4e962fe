//! Requests as bytes, because no client library would send them.

use std::net::SocketAddr;
use std::time::Duration;

use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};
use tokio::net::TcpStream;

use crate::client::clipped;

/// What a server surely reads of a body.
const TAKEN: usize = 4 << 20;
/// What a server surely reads of a head.
const HEAD: usize = 16 << 10;
/// What is read of an answer.
const READ: u64 = 1 << 20;

/// A request.
#[derive(Debug, Clone)]
pub struct Raw {
    /// The request line and the headers, without the empty line.
    pub head: Vec<u8>,
    /// The body.
    pub body: Vec<u8>,
    /// Whether it says less or more than it sends.
    pub broken: bool,
}

/// What came of a request.
#[derive(Debug)]
pub struct Answer {
    /// The status, if there was one.
    pub status: Option<u16>,
    /// The beginning of the body, or why there was no answer.
    pub body: String,
}

impl Raw {
    /// A request with a body of a media type, as it should be written.
    pub fn new(
        method: &str,
        path: &str,
        address: SocketAddr,
        media: &str,
        body: impl Into<Vec<u8>>,
    ) -> Self {
        let head = format!("{method} {path} HTTP/1.1\r\nhost: {address}\r\nconnection: close");
        let raw = Self { head: head.into_bytes(), body: body.into(), broken: false };
        if media.is_empty() { raw } else { raw.header("content-type", media) }
    }

    /// With one more header.
    pub fn header(mut self, name: &str, value: impl AsRef<[u8]>) -> Self {
        self.head.extend_from_slice(format!("\r\n{name}: ").as_bytes());
        self.head.extend_from_slice(value.as_ref());
        self
    }

    /// Whether the server may hang up before it was understood.
    pub fn may_be_cut(&self) -> bool {
        self.broken || self.body.len() >= TAKEN || self.head.len() >= HEAD
    }

    /// Its beginning, for a person.
    pub fn shown(&self) -> String {
        let line = self.head.split(|&byte| byte == b'\r').next().unwrap_or_default();
        let text =
            |bytes: &[u8]| clipped(&String::from_utf8_lossy(bytes)).escape_debug().to_string();
        format!("{} with {} bytes: {}", text(line), self.body.len(), text(&self.body))
    }

    /// Sends it and reads the answer.
    pub async fn send(&self, address: SocketAddr, patience: Duration) -> Answer {
        match tokio::time::timeout(patience, self.exchange(address)).await {
            Ok(Ok(read)) => answer(&read),
            Ok(Err(error)) => Answer { status: None, body: error.to_string() },
            Err(_) => Answer { status: None, body: format!("nothing within {patience:?}") },
        }
    }

    async fn exchange(&self, address: SocketAddr) -> std::io::Result<Vec<u8>> {
        let stream = TcpStream::connect(address).await?;
        let (mut from, mut to) = stream.into_split();
        let mut said = self.head.clone();
        if !self.broken {
            said.extend_from_slice(format!("\r\ncontent-length: {}", self.body.len()).as_bytes());
        }
        said.extend_from_slice(b"\r\n\r\n");
        said.extend_from_slice(&self.body);
        let broken = self.broken;
        // Beside the reading: a server that refuses early does not read on.
        let writing = tokio::spawn(async move {
            let _ = to.write_all(&said).await;
            if broken {
                let _ = to.shutdown().await;
            }
            to
        });
        let mut read = Vec::new();
        let mut part = vec![0; 64 << 10];
        loop {
            match from.read(&mut part).await {
                Ok(0) => break,
                Ok(more) => read.extend_from_slice(&part[..more]),
                Err(_) if !read.is_empty() => break,
                Err(error) => return Err(error),
            }
            if read.len() as u64 > READ || find(&read, b"text/event-stream").is_some() {
                break;
            }
        }
        writing.abort();
        Ok(read)
    }
}

fn answer(read: &[u8]) -> Answer {
    let text = String::from_utf8_lossy(read);
    let status = text.strip_prefix("HTTP/1.1 ").and_then(|rest| rest.get(..3)?.parse().ok());
    let body = text.split_once("\r\n\r\n").map_or("", |(_, body)| body).to_owned();
    Answer { status, body }
}

fn find(bytes: &[u8], part: &[u8]) -> Option<usize> {
    bytes.windows(part.len()).position(|window| window == part)
}
