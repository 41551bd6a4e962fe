//! A log of ten million rows with nine manoeuvres in it: found, cut out and refined on by the
//! program itself, from CSV and from Parquet.
//!
//! `cargo run --release -p sistership-tests --example long_log [-- ROWS]`
//!
//! Printed are the stretches beside what was sailed, rows a second, peak memory, and the error of
//! the refined model on manoeuvres that it has not seen, beside that of the same nine manoeuvres as
//! separate trials in calm water.

mod measured;

use std::path::Path;
use std::time::Instant;

use measured::{Measured, run, thread_s};
use serde_json::Value;
use sistership_model::Trial;
use sistership_tests::voyage::{Order, Sailed, Voyage, write_csv};
use sistership_trials::samples::{to_csv, write_parquet};
use sistership_trials::segmentation::{LogSample, SegmentFinder};
use sistership_trials::{Mapping, SteeringSample, scan_file};

const ROWS: usize = 10_000_000;
/// Rows to half a second.
const EACH: usize = 5;

/// A ship of which nobody has a model; it sails as SR108 does.
const SHIP: &str = "kind: vessel
name: voyager
title: The ship of the long log
category: dry-cargo
sources: { yard: { citation: the yard } }
particulars:
  source: yard
  values: { lpp_m: 175.0, beam_m: 25.4, draught_m: 8.5, displacement_m3: 21222.0, \
rudder_area_m2: 33.04, rudder_aspect_ratio: 1.82, propeller_diameter_m: 6.533, \
service_speed_m_s: 10.47, x_g_m: 0.0, yaw_gyradius_ratio: 0.24 }
";

fn programme() -> Vec<Order> {
    vec![
        Order::Zigzag(10.0, 10.0),
        Order::Turn(12.0, 700.0),
        Order::Zigzag(-20.0, 20.0),
        Order::PullOut(15.0, 300.0),
        Order::Turn(-20.0, 600.0),
        Order::Zigzag(20.0, 20.0),
        Order::Zigzag(-10.0, 10.0),
        Order::Turn(20.0, 600.0),
        Order::Zigzag(15.0, 15.0),
    ]
}

const UNSEEN: [Order; 3] =
    [Order::Zigzag(15.0, 10.0), Order::Turn(-15.0, 600.0), Order::Zigzag(-20.0, 10.0)];

fn main() {
    let rows = std::env::args().nth(1).map_or(ROWS, |text| text.parse().expect("a count of rows"));
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    std::fs::write(folder.join("ship.yaml"), SHIP).expect("written");
    let began = Instant::now();
    let Sailed { trial, manoeuvres } = Voyage::long(rows, EACH, &programme()).sail();
    println!(
        "sailed {:.0} h in {:.0} s",
        trial.duration_s() / 3600.0,
        began.elapsed().as_secs_f64()
    );
    write(folder, &trial);
    drop(trial);
    let unseen = separate(folder, "unseen", &UNSEEN);
    let clean = separate(folder, "clean", &programme());
    for file in ["log.csv", "log.parquet"] {
        println!("\n== {file}");
        in_process(&folder.join(file));
        let answer = import(folder, file, rows);
        compare(&answer, &manoeuvres);
        let trials = vec![folder.join("trials.yaml").display().to_string()];
        refine(folder, "stretches of the log", &trials, &unseen);
    }
    println!("\n== nine separate trials in calm water");
    refine(folder, "separate trials", &clean, &unseen);
}

fn write(folder: &Path, trial: &Trial) {
    let began = Instant::now();
    let create = |name: &str| {
        let file = std::fs::File::create(folder.join(name)).expect("a file");
        std::io::BufWriter::new(file)
    };
    write_csv(create("log.csv"), trial).expect("written");
    write_parquet(create("log.parquet"), trial).expect("written");
    let size = |name: &str| std::fs::metadata(folder.join(name)).map_or(0, |meta| meta.len()) >> 20;
    let (csv, parquet) = (size("log.csv"), size("log.parquet"));
    let took = began.elapsed().as_secs_f64();
    println!("written in {took:.0} s: CSV {csv} MB, Parquet {parquet} MB");
}

/// Each manoeuvre as a file of its own, without waves and gusts.
fn separate(folder: &Path, name: &str, orders: &[Order]) -> Vec<String> {
    let one = |(at, &order): (usize, &Order)| {
        let trial = Voyage::short(EACH, order, at as u64).sail().trial;
        let path = folder.join(format!("{name}-{at}.csv"));
        to_csv(std::fs::File::create(&path).expect("a file"), &trial).expect("written");
        path.display().to_string()
    };
    orders.iter().enumerate().map(one).collect()
}

/// What reading and finding take by themselves, on one core.
fn in_process(path: &Path) {
    let mapping = mapping(path);
    let mut kept = Vec::new();
    let (mut count, began) = (0_u64, thread_s());
    let read = scan_file(path, &mapping, |steering: &SteeringSample| {
        count += 1;
        if kept.len() < 1_000_000 {
            kept.push(sample(steering));
        }
    });
    read.expect("the log is read");
    let rate = |rows: f64, began: f64| rows / (thread_s() - began) / 1e6;
    println!("reading alone: {:.2} million rows a second and core", rate(count as f64, began));
    let (mut finder, began) = (SegmentFinder::new(Some(175.0)), thread_s());
    kept.iter().for_each(|sample| finder.push(sample));
    println!("finding alone: {:.1} million rows a second and core", rate(kept.len() as f64, began));
    assert!(finder.finish().is_ok_and(|found| found.rows == kept.len() as u64));
}

/// The columns of the log as `import` proposes them.
fn mapping(path: &Path) -> Mapping {
    let proposal = sistership_trials::propose_manifest("voyager", &[path]).expect("a manifest");
    proposal.manifest.trial_mapping(&proposal.manifest.manifest.trials[0])
}

fn sample(steering: &SteeringSample) -> LogSample {
    LogSample {
        t_s: steering.t_s,
        rudder_rad: steering.rudder_rad,
        revolutions_rps: steering.revolutions_rps,
        yaw_rate_rad_s: steering.yaw_rate_rad_s,
        heading_rad: steering.heading_rad,
        speed_m_s: steering.speed_m_s,
    }
}

fn import(folder: &Path, file: &str, rows: usize) -> Value {
    let (log, out) = (folder.join(file), folder.join("trials.yaml"));
    let (log, out) = (log.display().to_string(), out.display().to_string());
    let call = ["import", &log, "--ship", "voyager", "--length", "175", "--out", &out, "--json"];
    let Measured { answer, seconds, processor_s, peak_mb } = run(&call);
    println!(
        "import (search and cut, two passes): {seconds:.1} s, {processor_s:.1} s of a core, \
         {:.2} million rows a second, core and pass, peak {peak_mb} MB",
        2.0 * rows as f64 / processor_s / 1e6
    );
    answer
}

/// Each manoeuvre beside the stretch that holds it.
fn compare(answer: &Value, manoeuvres: &[(Order, f64, f64)]) {
    let log = &answer["logs"][0];
    let stretches = log["stretches"].as_array().cloned().unwrap_or_default();
    let number = |value: &Value| value.as_f64().unwrap_or(f64::NAN);
    println!(
        "{} of {} found; rudder scatter {} deg",
        stretches.len(),
        manoeuvres.len(),
        log["rudder_scatter_deg"]
    );
    for &(order, from_s, to_s) in manoeuvres {
        let meets = |one: &&Value| number(&one["from_s"]) <= to_s && from_s <= number(&one["to_s"]);
        let sailed = format!("  {order:<22} {from_s:>9.1} to {to_s:>9.1} s:");
        match stretches.iter().find(meets) {
            Some(one) => println!(
                "{sailed} begins {:>5.1} s before, ends {:>6.1} s after: {} ({})",
                from_s - number(&one["from_s"]),
                number(&one["to_s"]) - to_s,
                one["kind"].as_str().unwrap_or("?"),
                one["why"].as_str().unwrap_or("?"),
            ),
            None => println!("{sailed} NOT FOUND"),
        }
    }
    let steady = log["steady"].as_array().cloned().unwrap_or_default();
    let hours: f64 =
        steady.iter().map(|one| number(&one["to_s"]) - number(&one["from_s"])).sum::<f64>()
            / 3600.0;
    println!("  steady course keeping, for drift: {hours:.1} h in {} parts", steady.len());
}

/// The error on manoeuvres that were kept out.
fn refine(folder: &Path, what: &str, trials: &[String], unseen: &[String]) {
    let ship = folder.join("ship.yaml").display().to_string();
    let mut call = vec!["refine", "--ship", &ship, "--source", "mariner", "--method", "weak"];
    call.extend(["--json", "--held-out"]);
    call.extend(unseen.iter().map(String::as_str));
    call.push("--trials");
    call.extend(trials.iter().chain(unseen).map(String::as_str));
    let Measured { answer, seconds, peak_mb, .. } = run(&call);
    let errors = |model: &str| {
        let of = |channel: &str| answer["held_out"][model][channel].as_f64().unwrap_or(f64::NAN);
        format!(
            "u {:.3} m/s, v {:.3} m/s, r {:.4} deg/s, heading {:.2} deg",
            of("u"),
            of("v"),
            of("r").to_degrees(),
            of("psi").to_degrees()
        )
    };
    println!("refine on {what}: {seconds:.0} s, peak {peak_mb} MB; error on unseen manoeuvres:");
    println!("  source  {}\n  refined {}", errors("source"), errors("refined"));
}
