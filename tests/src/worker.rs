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
        let mut worker = Self::begin(&server.store_arguments(), lease_s);
        worker.until_it_works();
        worker
    }

    /// Starts one on a store, and does not wait.
    ///
    /// # Panics
    /// Where it does not start.
    pub fn begin(store: &[String], lease_s: &str) -> Self {
        let mut command = Command::new(binary::path());
        command.args(["work", "--lease-s", lease_s]).args(store).env("SISTERSHIP_LOG", "warn");
        Self(command.stdout(Stdio::piped()).spawn().expect("the worker starts"))
    }

    /// Waits until it works.
    ///
    /// # Panics
    /// Where it ends instead.
    pub fn until_it_works(&mut self) {
        let out = self.0.stdout.take().expect("its output");
        let line = BufReader::new(out).lines().next().expect("a worker that works").expect("text");
        assert!(line.contains("worker started"), "{line}");
    }

    /// Its process.
    pub fn id(&self) -> u32 {
        self.0.id()
    }

    /// Tells it to stop, and waits until it has.
    ///
    /// # Panics
    /// Where it cannot be told.
    pub fn terminate(&mut self) -> std::process::ExitStatus {
        self.signal("-TERM");
        self.0.wait().expect("the worker ends")
    }

    /// Halts it until [`TestWorker::resume`].
    ///
    /// # Panics
    /// Where it cannot be told.
    pub fn halt(&self) {
        self.signal("-STOP");
    }

    /// Lets it go on.
    ///
    /// # Panics
    /// Where it cannot be told.
    pub fn resume(&self) {
        self.signal("-CONT");
    }

    fn signal(&self, signal: &str) {
        let told = Command::new("kill").args([signal, &self.id().to_string()]).status();
        assert!(told.expect("a signal is sent").success());
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
