//! The program's run time and the largest memory that it held.

use std::io::Read;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use serde_json::Value;
use sistership_tests::binary;

/// What a run answered and took.
pub struct Measured {
    pub answer: Value,
    pub seconds: f64,
    /// Of all threads; the machine may be others', too.
    pub processor_s: f64,
    pub peak_mb: u64,
}

/// Runs the program.
pub fn run(arguments: &[&str]) -> Measured {
    let program = binary::path();
    let began = Instant::now();
    let mut child = Command::new(program)
        .args(arguments)
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .expect("the program starts");
    let mut out = child.stdout.take().expect("its output");
    let reader = std::thread::spawn(move || {
        let mut text = String::new();
        out.read_to_string(&mut text).map(|_| text)
    });
    let (mut peak_mb, mut processor_s, process) = (0, 0.0, format!("/proc/{}", child.id()));
    let status = loop {
        peak_mb = peak_mb.max(high_water_mb(&process).unwrap_or(0));
        processor_s = processor(&process).unwrap_or(0.0).max(processor_s);
        if let Some(status) = child.try_wait().expect("a child") {
            break status;
        }
        std::thread::sleep(Duration::from_millis(20));
    };
    let text = reader.join().expect("a reader").expect("its output");
    assert!(status.success(), "{arguments:?}: {status}: {text}");
    let answer = serde_json::from_str(&text).expect("JSON");
    Measured { answer, seconds: began.elapsed().as_secs_f64(), processor_s, peak_mb }
}

/// `VmHWM` of a process.
fn high_water_mb(process: &str) -> Option<u64> {
    let status = std::fs::read_to_string(format!("{process}/status")).ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM:"))?;
    line.split_whitespace().nth(1)?.parse::<u64>().ok().map(|kb| kb >> 10)
}

/// Time of the processor that a process took, s: its 14th and 15th field, in hundredths.
fn processor(process: &str) -> Option<f64> {
    let stat = std::fs::read_to_string(format!("{process}/stat")).ok()?;
    let after = stat.rsplit(')').next()?;
    let ticks = |at: usize| after.split_whitespace().nth(at)?.parse::<f64>().ok();
    Some((ticks(11)? + ticks(12)?) / 100.0)
}

/// Time of the processor that this thread has taken, s.
pub fn thread_s() -> f64 {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
    time.tv_sec as f64 + time.tv_nsec as f64 * 1e-9
}
