//! The address that is listened on.

use std::net::SocketAddr;

use tokio::net::{TcpListener, TcpSocket};

/// Connections that the system holds until they are taken.
const BACKLOG: u32 = 1024;
/// What the system keeps of an answer that is not read. It also is how finely reading is seen: the
/// system tells of room only when a third of this has been read.
const SEND_BUFFER: u32 = 128 << 10;

/// Takes an address.
///
/// # Errors
/// The system does not give it.
pub fn bind(listen: SocketAddr) -> std::io::Result<TcpListener> {
    let socket = if listen.is_ipv4() { TcpSocket::new_v4() } else { TcpSocket::new_v6() }?;
    #[cfg(unix)]
    socket.set_reuseaddr(true)?;
    socket.set_send_buffer_size(SEND_BUFFER)?;
    socket.bind(listen)?;
    socket.listen(BACKLOG)
}
