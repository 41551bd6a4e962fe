//! A real worker process on the store of a server.

use std::io::{BufRead, BufReader};
use std::process::{Child, Command, Stdio};

use crate::binary;
use crate::server::TestServer;

/// A worker process; it is killed when this is dropped.
pub struct TestWorker(Child);

impl TestWorker {
    /// Starts one with a lease, and waits until it works.
    ///
    /// # Panics
    /// Where it does not start.
    pub fn start(server: &TestServer, lease_s: &str) -> Self {
        let mut process = Command::new(binary::path())
            .args(["work", "--lease-s", lease_s])
            .args(server.store_arguments())
            .env("SISTERSHIP_LOG", "warn")
            .stdout(Stdio::piped())
            .spawn()
            .expect("the worker starts");
        let out = process.stdout.take().expect("its output");
        let line = BufReader::new(out).lines().next().expect("a line").expect("text");
        assert!(line.contains("works"), "{line}");
        Self(process)
    }

    /// Its process.
    pub fn id(&self) -> u32 {
        self.0.id()
    }

    /// Kills it without warning, as `kill -9` does.
    ///
    /// # Panics
    /// Where it cannot be killed.
    pub fn kill(&mut self) {
        self.0.kill().expect("the worker is killed");
        self.0.wait().expect("the worker is gone");
    }
}

impl Drop for TestWorker {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}
