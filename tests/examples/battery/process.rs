//! Processes of the built program, watched: their memory, and whether they end by themselves.

use std::ffi::OsString;
use std::fs::File;
use std::io::{BufRead as _, BufReader};
use std::path::PathBuf;
use std::process::{Child, Command, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, OnceLock};
use std::time::{Duration, Instant};

use sistership_tests::binary;

use crate::attack::Failure;
use crate::client::Client;
use crate::tally::Tally;

/// How long a process may take until it says that it listens or works.
const PATIENCE: Duration = Duration::from_secs(180);
const SAMPLING: Duration = Duration::from_millis(20);
/// Bytes of a log that are shown.
const SHOWN: usize = 300;

static PROGRAM: OnceLock<PathBuf> = OnceLock::new();

/// Attacks another program than the one of this tree.
pub fn choose(path: PathBuf) {
    let _ = PROGRAM.set(path);
}

/// The program: the chosen one, or the one of this tree, built in the profile of the battery.
pub fn program() -> &'static PathBuf {
    PROGRAM.get_or_init(|| binary::path().clone())
}

/// How a process is started.
#[derive(Clone)]
pub struct Start {
    arguments: Vec<OsString>,
    environment: Vec<(OsString, OsString)>,
    log: PathBuf,
    tally: Arc<Tally>,
}

impl Start {
    /// With the arguments that name a store; its log goes into the folder.
    pub fn new(arguments: Vec<OsString>, folder: PathBuf, tally: Arc<Tally>) -> Self {
        Self { arguments, environment: Vec::new(), log: folder.join("log"), tally }
    }

    /// With one more argument.
    pub fn argument(mut self, argument: impl Into<OsString>) -> Self {
        self.arguments.push(argument.into());
        self
    }

    /// With more in its environment.
    pub fn environment<K: Into<OsString>, V: Into<OsString>>(
        mut self,
        more: impl IntoIterator<Item = (K, V)>,
    ) -> Self {
        self.environment.extend(more.into_iter().map(|(name, value)| (name.into(), value.into())));
        self
    }

    /// A server.
    ///
    /// # Errors
    /// It ends, or does not listen in time.
    pub async fn server(self) -> Result<Server, Failure> {
        let (process, line) = self.begin("serve", &["--listen", "127.0.0.1:0"]).await?;
        let address = line.rsplit("http://").next().unwrap_or_default().trim().parse()?;
        let client = Client::new(address, Arc::clone(&self.tally));
        Ok(Server { process, client, start: self })
    }

    /// A worker.
    ///
    /// # Errors
    /// It ends, or does not work in time.
    pub async fn worker(self) -> Result<Process, Failure> {
        Ok(self.begin("work", &[]).await?.0)
    }

    async fn begin(&self, command: &str, more: &[&str]) -> Result<(Process, String), Failure> {
        let log = File::options().create(true).append(true).open(&self.log)?;
        let mut child = Command::new(program())
            .arg(command)
            .args(more)
            .args(&self.arguments)
            .env_remove("SISTERSHIP_ZOO")
            .env("SISTERSHIP_LOG", "error")
            .envs(self.environment.iter().map(|(name, value)| (name, value)))
            .stdout(Stdio::piped())
            .stderr(log)
            .spawn()?;
        let out = child.stdout.take().ok_or("no output")?;
        let process = Process::watch(child, self.log.clone(), Arc::clone(&self.tally));
        let (said, heard) = tokio::sync::oneshot::channel();
        std::thread::spawn(move || {
            let mut lines = BufReader::new(out).lines();
            let _ = said.send(lines.next().and_then(Result::ok));
            lines.for_each(drop);
        });
        match tokio::time::timeout(PATIENCE, heard).await {
            Ok(Ok(Some(line))) => Ok((process, line)),
            Ok(_) => {
                let tail = process.tail();
                process.dismiss();
                Err(format!("`{command}` ends at its start: {tail}").into())
            }
            Err(_) => {
                Err(format!("`{command}` does not start within {PATIENCE:?}: {}", process.tail())
                    .into())
            }
        }
    }
}

/// A process; it is killed when this is dropped, and counted as aborted where it has ended before.
pub struct Process {
    child: Child,
    log: PathBuf,
    tally: Arc<Tally>,
    gone: Arc<AtomicBool>,
}

impl Process {
    fn watch(child: Child, log: PathBuf, tally: Arc<Tally>) -> Self {
        let gone = Arc::new(AtomicBool::new(false));
        let process = Self { child, log, tally: Arc::clone(&tally), gone: Arc::clone(&gone) };
        let id = process.child.id();
        std::thread::spawn(move || {
            while !gone.load(Ordering::SeqCst) {
                if let Some(kb) = peak_kb(id) {
                    tally.memory(kb);
                }
                std::thread::sleep(SAMPLING);
            }
        });
        process
    }

    /// Its number.
    pub fn id(&self) -> u32 {
        self.child.id()
    }

    /// Its highest resident memory so far, MB.
    pub fn peak_mb(&self) -> u64 {
        peak_kb(self.id()).unwrap_or(0).div_ceil(1024)
    }

    /// Whether it has ended, by whatever.
    pub fn ended(&mut self) -> bool {
        !matches!(self.child.try_wait(), Ok(None))
    }

    /// Waits so long for its end.
    pub async fn ended_within(&mut self, patience: Duration) -> bool {
        let begun = Instant::now();
        while !self.ended() {
            if begun.elapsed() > patience {
                return false;
            }
            tokio::time::sleep(Duration::from_millis(5)).await;
        }
        true
    }

    /// Kills it without warning; one that has ended before counts as aborted.
    pub fn kill(mut self) {
        self.end();
    }

    /// Tells it to stop, as a service manager does. Whether it ended in time, well.
    pub async fn terminate(mut self, patience: Duration) -> bool {
        let told = Command::new("kill").args(["-TERM", &self.id().to_string()]).status();
        let stopped =
            told.is_ok_and(|status| status.success()) && self.ended_within(patience).await;
        let well = stopped
            && self
                .child
                .try_wait()
                .is_ok_and(|status| status.is_some_and(|status| status.success()));
        if well {
            self.dismiss();
        }
        well
    }

    /// Lets go of one that has ended as it should.
    pub fn dismiss(mut self) {
        self.gone.store(true, Ordering::SeqCst);
        let _ = self.child.kill();
        let _ = self.child.wait();
    }

    /// The end of its log.
    pub fn tail(&self) -> String {
        let log = std::fs::read(&self.log).unwrap_or_default();
        let log =
            String::from_utf8_lossy(&log[log.len().saturating_sub(SHOWN)..]).replace('\n', " ");
        log.trim().to_owned()
    }

    fn end(&mut self) {
        if self.gone.swap(true, Ordering::SeqCst) {
            return;
        }
        if let Some(kb) = peak_kb(self.id()) {
            self.tally.memory(kb);
        }
        if let Ok(Some(status)) = self.child.try_wait() {
            self.tally.aborted(format!("a process ended by itself: {status}: {}", self.tail()));
        }
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        self.end();
    }
}

/// The highest resident memory of a process so far, kB.
fn peak_kb(id: u32) -> Option<u64> {
    let status = std::fs::read_to_string(format!("/proc/{id}/status")).ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM:"))?;
    line.split_whitespace().nth(1)?.parse().ok()
}

/// A server and a client of it.
pub struct Server {
    /// The process.
    pub process: Process,
    /// The client.
    pub client: Client,
    start: Start,
}

impl Server {
    /// Whether it lives. One that has ended counts as aborted by `what`, and is started again.
    ///
    /// # Errors
    /// It does not start again.
    pub async fn lives(&mut self, what: &str) -> Result<bool, Failure> {
        // A core that is written, or a stack that is unwound, takes a moment.
        if !self.process.ended_within(Duration::from_millis(200)).await {
            return Ok(true);
        }
        let tail = self.process.tail();
        self.process.tally.aborted(format!("{what}: {tail}"));
        self.restart().await?;
        Ok(false)
    }

    /// Starts it again after its end.
    ///
    /// # Errors
    /// It does not start.
    pub async fn restart(&mut self) -> Result<(), Failure> {
        self.process.gone.store(true, Ordering::SeqCst);
        let _ = self.process.child.kill();
        let _ = self.process.child.wait();
        *self = self.start.clone().server().await?;
        Ok(())
    }
}
