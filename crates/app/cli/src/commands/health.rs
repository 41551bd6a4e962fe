//! `sistership health`: readiness of a running server, for containers and load balancers.

use std::io::{BufRead, BufReader, Write};
use std::net::{IpAddr, Ipv4Addr, Ipv6Addr, SocketAddr, TcpStream};
use std::time::Duration;

use clap::Args;
use sistership_api::DEFAULT_LISTEN;

use crate::failure::Failure;
use crate::output;
use crate::values::address;

/// Longest time to connect, to send and to wait for the answer, each.
const TIMEOUT: Duration = Duration::from_secs(5);

const EXAMPLES: &str = "\
Examples:
  sistership health
  sistership health --listen 127.0.0.1:9000

Exit status: 0 the server answers, and so do its database and object store; 1 they do not.";

/// Check that a server of this machine is ready.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct HealthArguments {
    /// Address and port on which the server listens [default: 127.0.0.1:8080].
    #[arg(long, value_name = "ADDRESS:PORT", env = "SISTERSHIP_LISTEN", value_parser = address)]
    listen: Option<SocketAddr>,
}

/// Runs the command.
///
/// # Errors
/// Returns an error if the server does not answer, or answers that it is not ready.
pub fn run(arguments: &HealthArguments) -> Result<(), Failure> {
    let address = reachable_address(arguments.listen.unwrap_or(DEFAULT_LISTEN));
    let status = request_status(address)
        .map_err(|error| Failure::Refused(format!("no server answers at {address}: {error}")))?;
    match status.split(' ').nth(1) {
        Some("200") => output::print_result(false, &(), || "ready".to_owned()),
        _ => Err(Failure::Refused(format!("the server at {address} is not ready: {status}"))),
    }
}

/// Returns the address at which a server that listens on `listen` is reached from this machine.
fn reachable_address(listen: SocketAddr) -> SocketAddr {
    let ip = match listen.ip() {
        IpAddr::V4(ip) if ip.is_unspecified() => Ipv4Addr::LOCALHOST.into(),
        IpAddr::V6(ip) if ip.is_unspecified() => Ipv6Addr::LOCALHOST.into(),
        ip => ip,
    };
    SocketAddr::new(ip, listen.port())
}

/// Requests `/readyz` and returns the status line of the answer.
fn request_status(address: SocketAddr) -> std::io::Result<String> {
    let mut stream = TcpStream::connect_timeout(&address, TIMEOUT)?;
    stream.set_read_timeout(Some(TIMEOUT))?;
    stream.set_write_timeout(Some(TIMEOUT))?;
    write!(stream, "GET /readyz HTTP/1.1\r\nHost: {address}\r\nConnection: close\r\n\r\n")?;
    let mut status = String::new();
    BufReader::new(stream).read_line(&mut status)?;
    Ok(status.trim_end().to_owned())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use std::net::TcpListener;

    /// Answers one request with a status line, and returns the result of the command.
    fn check_against(status: &'static str) -> Result<(), Failure> {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let listen = Some(listener.local_addr().unwrap());
        let server = std::thread::spawn(move || {
            let (mut stream, _) = listener.accept().unwrap();
            // The whole request is read: a socket closed with unread bytes resets the connection.
            let request = BufReader::new(&stream).lines().map_while(Result::ok);
            let request: Vec<String> = request.take_while(|line| !line.is_empty()).collect();
            write!(stream, "{status}\r\n\r\n").unwrap();
            request.concat()
        });
        let outcome = run(&HealthArguments { listen });
        assert!(server.join().unwrap().starts_with("GET /readyz HTTP/1.1"));
        outcome
    }

    #[test]
    fn only_a_ready_server_is_healthy() {
        assert_eq!(check_against("HTTP/1.1 200 OK"), Ok(()));
        let refused = check_against("HTTP/1.1 503 Service Unavailable").unwrap_err();
        assert!(refused.message().unwrap().contains("503 Service Unavailable"));
    }

    #[test]
    fn an_absent_server_is_named() {
        // A listener that is dropped leaves a port on which nothing listens.
        let listen = TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap();
        let refused = run(&HealthArguments { listen: Some(listen) }).unwrap_err();
        assert!(refused.message().unwrap().contains(&listen.to_string()));
    }

    #[test]
    fn all_interfaces_are_reached_by_loopback() {
        let reached = |text: &str| reachable_address(text.parse().unwrap()).to_string();
        assert_eq!(reached("0.0.0.0:80"), "127.0.0.1:80");
        assert_eq!(reached("[::]:80"), "[::1]:80");
        assert_eq!(reached("10.0.0.1:80"), "10.0.0.1:80");
    }
}
