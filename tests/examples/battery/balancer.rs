//! A small proxy before several servers: each connection goes to the next server that accepts it.

use std::net::SocketAddr;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use tokio::io::copy_bidirectional;
use tokio::net::{TcpListener, TcpStream};
use tokio::task::JoinHandle;

use crate::attack::Failure;

/// A proxy; it closes when it is dropped.
pub struct Balancer {
    /// Where it listens.
    pub address: SocketAddr,
    servers: Arc<Mutex<Vec<SocketAddr>>>,
    accepting: JoinHandle<()>,
}

impl Balancer {
    /// Starts one before some servers.
    ///
    /// # Errors
    /// There is no free port.
    pub async fn start(servers: Vec<SocketAddr>) -> Result<Self, Failure> {
        let listener = TcpListener::bind("127.0.0.1:0").await?;
        let address = listener.local_addr()?;
        let servers = Arc::new(Mutex::new(servers));
        let accepting = tokio::spawn(accept_all(listener, Arc::clone(&servers)));
        Ok(Self { address, servers, accepting })
    }

    /// Replaces the address of one server, which has been started again.
    pub fn replace(&self, place: usize, address: SocketAddr) {
        self.servers.lock().unwrap_or_else(PoisonError::into_inner)[place] = address;
    }
}

impl Drop for Balancer {
    fn drop(&mut self) {
        self.accepting.abort();
    }
}

async fn accept_all(listener: TcpListener, servers: Arc<Mutex<Vec<SocketAddr>>>) {
    let turn = Arc::new(AtomicUsize::new(0));
    while let Ok((client, _)) = listener.accept().await {
        let known = servers.lock().unwrap_or_else(PoisonError::into_inner).clone();
        tokio::spawn(serve_client(client, known, Arc::clone(&turn)));
    }
}

/// Passes bytes between a client and the first server that accepts a connection, if one does.
async fn serve_client(mut client: TcpStream, servers: Vec<SocketAddr>, turn: Arc<AtomicUsize>) {
    let first = turn.fetch_add(1, Ordering::Relaxed);
    for place in 0..servers.len() {
        let address = servers[(first + place) % servers.len()];
        if let Ok(mut server) = TcpStream::connect(address).await {
            // An error means that one of the two has gone, which the other learns by the close.
            let _ = copy_bidirectional(&mut client, &mut server).await;
            return;
        }
    }
}
