//! What stands between the program and a part that it needs: a proxy that passes bytes until it is
//! told to do otherwise.

use std::path::PathBuf;

use tokio::io::{AsyncRead, AsyncReadExt as _, AsyncWrite, AsyncWriteExt as _};
use tokio::net::{TcpListener, TcpStream, UnixListener, UnixStream};
use tokio::sync::watch;
use tokio::task::JoinHandle;

use crate::attack::Failure;

/// What the gate does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mode {
    /// It passes bytes.
    Open,
    /// Connections stay open and pass nothing; new ones are accepted, and pass nothing either.
    Stalled,
    /// Connections are cut, new ones as well.
    Refused,
    /// Every request of HTTP is answered with a status.
    Answers(u16),
}

/// The state of a gate: its mode, and how often connections were forgotten.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct State {
    mode: Mode,
    silences: u64,
}

/// A gate; it closes when it is dropped.
pub struct Gate {
    state: watch::Sender<State>,
    accepting: JoinHandle<()>,
}

impl Gate {
    /// Before a socket of Unix, at another path.
    ///
    /// # Errors
    /// The path cannot be bound.
    pub fn before_socket(at: PathBuf, server: PathBuf) -> Result<Self, Failure> {
        let listener = UnixListener::bind(at)?;
        let (state, seen) = open();
        let accepting = tokio::spawn(async move {
            while let Ok((client, _)) = listener.accept().await {
                let (server, seen) = (server.clone(), seen.clone());
                tokio::spawn(async move {
                    serve(client, async { UnixStream::connect(server).await }, seen).await;
                });
            }
        });
        Ok(Self { state, accepting })
    }

    /// Before an address; also gives the gate's own.
    ///
    /// # Errors
    /// There is no free port.
    pub async fn before_address(server: String) -> Result<(Self, String), Failure> {
        let listener = TcpListener::bind("127.0.0.1:0").await?;
        let at = listener.local_addr()?.to_string();
        let (state, seen) = open();
        let accepting = tokio::spawn(async move {
            while let Ok((client, _)) = listener.accept().await {
                let (server, seen) = (server.clone(), seen.clone());
                tokio::spawn(async move {
                    serve(client, async { TcpStream::connect(server).await }, seen).await;
                });
            }
        });
        Ok((Self { state, accepting }, at))
    }

    /// Changes what it does.
    pub fn set(&self, mode: Mode) {
        self.state.send_modify(|state| state.mode = mode);
    }

    /// Forgets all connections, as a firewall does: they stay open and pass nothing any more, new
    /// ones do.
    pub fn forget(&self) {
        self.state.send_modify(|state| state.silences += 1);
    }
}

impl Drop for Gate {
    fn drop(&mut self) {
        self.accepting.abort();
    }
}

fn open() -> (watch::Sender<State>, watch::Receiver<State>) {
    watch::channel(State { mode: Mode::Open, silences: 0 })
}

/// One connection, until an end hangs up or the gate cuts it.
async fn serve<S: AsyncRead + AsyncWrite + Unpin>(
    mut client: S,
    connect: impl Future<Output = std::io::Result<S>>,
    mut seen: watch::Receiver<State>,
) {
    let (made, passing) = (*seen.borrow(), seen.clone());
    match made.mode {
        Mode::Refused => return,
        Mode::Answers(status) => return answer(&mut client, status).await,
        Mode::Open | Mode::Stalled => {}
    }
    let Ok(server) = connect.await else { return };
    let (from_client, to_client) = tokio::io::split(client);
    let (from_server, to_server) = tokio::io::split(server);
    let cut = seen.wait_for(|now| matches!(now.mode, Mode::Refused | Mode::Answers(_)));
    tokio::select! {
        _ = cut => {}
        () = pass(from_client, to_server, passing.clone(), made) => {}
        () = pass(from_server, to_client, passing, made) => {}
    }
}

/// Passes bytes on while the gate is open; those that came before a stall are written after it.
async fn pass(
    mut from: impl AsyncRead + Unpin,
    mut to: impl AsyncWrite + Unpin,
    mut seen: watch::Receiver<State>,
    made: State,
) {
    let mut bytes = vec![0; 1 << 16];
    while let Ok(count @ 1..) = from.read(&mut bytes).await {
        let open = |now: &State| now.mode == Mode::Open && now.silences == made.silences;
        if seen.wait_for(open).await.is_err() || to.write_all(&bytes[..count]).await.is_err() {
            return;
        }
    }
}

/// Answers requests; they are not parsed, as the head of each comes with the first read.
async fn answer<S: AsyncRead + AsyncWrite + Unpin>(client: &mut S, status: u16) {
    let mut request = vec![0; 1 << 16];
    let said = format!("HTTP/1.1 {status} Fault\r\ncontent-length: 0\r\nconnection: close\r\n\r\n");
    if client.read(&mut request).await.is_ok() {
        let _ = client.write_all(said.as_bytes()).await;
        let _ = client.shutdown().await;
    }
}
