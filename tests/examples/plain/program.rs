//! The program as a process: what it answers, how long it takes and the memory that it needs.

use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use serde_json::Value;
use sistership_tests::binary;

use crate::arguments::Arguments;

/// Between two looks at a process.
const LOOK: Duration = Duration::from_millis(5);

/// The program that is judged.
pub struct Program {
    path: PathBuf,
    limit: Duration,
}

/// A call that has ended.
pub struct Ended {
    /// Its JSON document, or the last line of what it said.
    pub answer: Result<Value, String>,
    /// Its JSON document, where it printed one, whatever its exit status.
    pub printed: Option<Value>,
    /// From start to end, s.
    pub wall_s: f64,
    /// Highest resident memory, MB, as Linux counts it and as seen in the last look before its end.
    pub peak_mb: f64,
}

impl Program {
    /// The named one, or that of this tree.
    pub fn new(arguments: &Arguments) -> Self {
        let path = arguments.program.clone().unwrap_or_else(|| binary::path().clone());
        Self { path, limit: Duration::from_secs_f64(arguments.limit_s) }
    }

    /// Runs it in a folder of its own, in which it may leave files.
    pub fn run(&self, arguments: &[String], folder: &Path) -> Ended {
        let begun = Instant::now();
        let mut child = self.started(arguments, folder);
        let (mut peak_mb, mut ended) = (0.0_f64, None);
        while ended.is_none() && begun.elapsed() < self.limit {
            peak_mb = peak_mb.max(resident_mb(child.id()));
            std::thread::sleep(LOOK);
            ended = child.try_wait().expect("the process can be asked");
        }
        let wall_s = begun.elapsed().as_secs_f64();
        let answer = match ended {
            Some(status) => answer(folder, status.success()),
            None => Err(given_up(&mut child, wall_s)),
        };
        let printed = std::fs::read_to_string(folder.join(OUT)).unwrap_or_default();
        let printed = serde_json::from_str(&printed).ok();
        Ended { answer, printed, wall_s, peak_mb }
    }

    fn started(&self, arguments: &[String], folder: &Path) -> Child {
        let file = |name: &str| std::fs::File::create(folder.join(name)).expect("a file");
        let mut command = Command::new(&self.path);
        command.args(arguments).env_remove("SISTERSHIP_ZOO").stdin(Stdio::null());
        command.stdout(file(OUT)).stderr(file(SAID));
        command.spawn().expect("the program starts")
    }
}

const OUT: &str = "answer.json";
const SAID: &str = "said.txt";

fn given_up(child: &mut Child, after_s: f64) -> String {
    child.kill().expect("the process ends");
    child.wait().expect("the process has ended");
    format!("given up after {after_s:.0} s")
}

fn answer(folder: &Path, success: bool) -> Result<Value, String> {
    let text = |name: &str| std::fs::read_to_string(folder.join(name)).unwrap_or_default();
    let read = || serde_json::from_str(&text(OUT)).map_err(|error| error.to_string());
    if success { read() } else { Err(text(SAID).lines().last().unwrap_or_default().to_owned()) }
}

/// Peak of a process so far, MB; zero where it has ended.
fn resident_mb(process: u32) -> f64 {
    let status = std::fs::read_to_string(format!("/proc/{process}/status")).unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:")).unwrap_or_default();
    let kib = line.split_whitespace().next().and_then(|kib| kib.parse::<f64>().ok());
    kib.unwrap_or_default() / 1024.0
}
