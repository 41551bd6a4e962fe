//! Binding of the listening socket.

use std::net::SocketAddr;

use tokio::net::{TcpListener, TcpSocket};

/// Maximum number of connections that wait to be accepted.
const BACKLOG: u32 = 1024;
/// Size of the system's send buffer of a connection, bytes. It also sets the resolution at which
/// reading is seen: the socket becomes writable again only after a third of this has been read.
const SEND_BUFFER: u32 = 128 << 10;

/// Binds an address and listens on it.
///
/// # Errors
/// Returns an error if the system refuses the address.
pub fn bind(listen: SocketAddr) -> std::io::Result<TcpListener> {
    let socket = if listen.is_ipv4() { TcpSocket::new_v4() } else { TcpSocket::new_v6() }?;
    #[cfg(unix)]
    socket.set_reuseaddr(true)?;
    socket.set_send_buffer_size(SEND_BUFFER)?;
    socket.bind(listen)?;
    socket.listen(BACKLOG)
}
