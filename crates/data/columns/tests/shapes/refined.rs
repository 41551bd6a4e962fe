//! Refinements by the program on files in many shapes, and on the same recordings in canonical
//! columns: what import loses.

use std::fmt::Write;
use std::path::PathBuf;
use std::process::Command;

use sistership_columns::{ColumnData, Role};

use crate::shape::{Shape, whole_shape};
use crate::source::{Source, sources};

/// Recordings of the tank in the order of their files: four are fitted, two judge.
const FITTED: [usize; 4] = [2, 3, 5, 7];
const JUDGES: [usize; 2] = [4, 6];
/// Largest share by which an error may differ from that of canonical columns.
const ALLOWED: f64 = 0.05;
/// Every how many samples are kept, for a short test.
const EVERY: usize = 5;

#[test]
#[ignore = "a table for docs/evidence/import.md, in minutes"]
fn refinements_after_import_are_those_from_canonical_columns() {
    let (Some(sources), Some(program)) = (sources(), std::env::var_os("SISTERSHIP_PROGRAM")) else {
        println!("skipped: the data or SISTERSHIP_PROGRAM is missing");
        return;
    };
    let tank: Vec<Source> =
        sources.into_iter().filter(|source| source.name == "tank").map(thin_samples).collect();
    let folder = tempfile::tempdir().expect("a folder");
    let bench = Bench { program: program.into(), folder: folder.path().to_owned(), tank };
    let canonical = bench.canonical_errors();
    println!("canonical: r {:.5} deg/s, u {:.5} m/s", canonical.0.to_degrees(), canonical.1);
    let first = std::env::var("SISTERSHIP_SHAPES").ok().and_then(|text| text.parse().ok());
    let mut within = 0;
    let seeds = 12;
    for seed in first.unwrap_or(1000)..first.unwrap_or(1000) + seeds {
        let (kind, errors) = bench.imported_errors(seed);
        let Some((r, u)) = errors else {
            println!("{seed} {kind}: no model");
            continue;
        };
        let (dr, du) = (r / canonical.0 - 1.0, u / canonical.1 - 1.0);
        within += u64::from(dr.abs() <= ALLOWED && du.abs() <= ALLOWED);
        println!("{seed} {kind}: r {:+.1} %, u {:+.1} %", 100.0 * dr, 100.0 * du);
    }
    println!("{within} of {seeds} within {:.0} %", 100.0 * ALLOWED);
    assert!(4 * within >= 3 * seeds, "{within}");
}

/// One in [`EVERY`] samples.
fn thin_samples(mut source: Source) -> Source {
    for (_, values) in &mut source.columns {
        *values = values.iter().copied().step_by(EVERY).collect();
    }
    source
}

struct Bench {
    program: PathBuf,
    folder: PathBuf,
    tank: Vec<Source>,
}

impl Bench {
    /// Errors of yaw rate, rad/s, and surge velocity, m/s, on the judges after a refinement of files
    /// with canonical columns.
    fn canonical_errors(&self) -> (f64, f64) {
        let fitted: Vec<PathBuf> = FITTED.iter().map(|&at| self.canonical_file(at)).collect();
        self.judged_errors("canonical", &fitted).expect("a model")
    }

    /// The same after an import of files in the shape of a seed, and the naming of the shape.
    fn imported_errors(&self, seed: u64) -> (&'static str, Option<(f64, f64)>) {
        let folder = self.folder.join(format!("shape{seed}"));
        std::fs::create_dir(&folder).expect("a folder");
        let mut kind = "";
        let files = FITTED.map(|at| {
            let shape = whole_shape(&self.tank[at], seed);
            kind = shape.kind;
            let path = folder.join(format!("run{at}.csv"));
            std::fs::write(&path, file_text(&shape, seed)).expect("a file");
            path
        });
        let manifest = folder.join("trials.yaml");
        let mut call = Command::new(&self.program);
        call.arg("import").args(&files).arg("--out").arg(&manifest);
        let output = call.output().expect("the program");
        if !output.status.success() {
            println!("{}", String::from_utf8_lossy(&output.stderr));
        }
        (kind, self.judged_errors(&format!("shape{seed}"), &[manifest]))
    }

    fn canonical_file(&self, at: usize) -> PathBuf {
        let path = self.folder.join(format!("canonical{at}.csv"));
        std::fs::write(&path, canonical_text(&self.tank[at])).expect("a file");
        path
    }

    fn judged_errors(&self, name: &str, trials: &[PathBuf]) -> Option<(f64, f64)> {
        let model = self.folder.join(format!("{name}.model.yaml"));
        let mut refine = Command::new(&self.program);
        refine.args(["refine", "--ship", "kvlcc2-7m", "--source", "kvlcc2", "--method", "weak"]);
        refine.arg("--trials").args(trials).arg("--out").arg(&model);
        let output = refine.output().expect("the program");
        if !output.status.success() {
            println!("{}", String::from_utf8_lossy(&output.stderr));
            return None;
        }
        let judges: Vec<PathBuf> = JUDGES.iter().map(|&at| self.canonical_file(at)).collect();
        let mut simulate = Command::new(&self.program);
        simulate.args(["simulate", "--json", "--restart-s", "60", "--model"]).arg(&model);
        let output = simulate.arg("--trials").args(&judges).output().expect("the program");
        simulated_errors(&output.stdout)
    }
}

/// Root mean square errors over all trials of a simulation's document.
fn simulated_errors(document: &[u8]) -> Option<(f64, f64)> {
    let document: serde_yaml::Value = serde_yaml::from_slice(document).ok()?;
    let trials = document.get("trials")?.as_sequence()?;
    let mean = |channel: &str| {
        let each = trials.iter().map(|trial| trial.get("rmse")?.get(channel)?.as_f64());
        let squares: Option<f64> = each.map(|error| Some(error?.powi(2))).sum();
        Some((squares? / trials.len() as f64).sqrt())
    };
    Some((mean("r")?, mean("u")?))
}

/// A file as a recorder writes it: separator and decimal mark by the seed.
fn file_text(shape: &Shape, seed: u64) -> String {
    let (separator, mark) = [(",", "."), (";", ","), ("\t", "."), (";", ".")][(seed % 4) as usize];
    let columns = &shape.sample.columns;
    let joined = |cells: Vec<String>| cells.join(separator) + "\n";
    let mut text = joined(columns.iter().map(|column| quote_header(&column.header)).collect());
    if columns.iter().any(|column| column.below.is_some()) {
        let unit = |column: &ColumnData| column.below.clone().unwrap_or_default();
        text += &joined(columns.iter().map(unit).collect());
    }
    let cell = |value: f64| match value.is_finite() {
        true => value.to_string().replace('.', mark),
        false => String::new(),
    };
    for row in 0..columns[0].values.len() {
        text += &joined(columns.iter().map(|column| cell(column.values[row])).collect());
    }
    text
}

fn quote_header(header: &str) -> String {
    if header.contains([',', ';', '"']) { format!("\"{header}\"") } else { header.to_owned() }
}

/// A file with canonical columns; surge and sway follow from the velocities over the earth.
fn canonical_text(source: &Source) -> String {
    let column = |role: Role| &source.columns.iter().find(|one| one.0 == role).expect("a column").1;
    let [t, x, y, psi, r] = [Role::Time, Role::X, Role::Y, Role::Psi, Role::R].map(column);
    let [north, east, delta, n] = [Role::VNorth, Role::VEast, Role::Delta, Role::N].map(column);
    let mut text = "t_s,x_m,y_m,psi_rad,u_m_s,v_m_s,r_rad_s,delta_rad,n_rps\n".to_owned();
    for k in 0..t.len() {
        let (sin, cos) = psi[k].sin_cos();
        let (u, v) = (north[k] * cos + east[k] * sin, east[k] * cos - north[k] * sin);
        let row = [t[k], x[k], y[k], psi[k], u, v, r[k], delta[k], n[k]];
        let cells: Vec<String> = row.iter().map(f64::to_string).collect();
        writeln!(text, "{}", cells.join(",")).expect("memory");
    }
    text
}
