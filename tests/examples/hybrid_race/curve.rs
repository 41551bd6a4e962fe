//! Learning curves: kept as they grow, drawn, and told in a table.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::io::Write as _;
use std::path::PathBuf;
use std::time::Instant;

use rayon::prelude::*;
use sistership_model::trial::Channel;
use sistership_model::{Law, Model, Trial};
use sistership_numerics::cma_es::SearchUsage;
use sistership_simulation::Ship;
use sistership_simulation::error::SquaredError;
use sistership_simulation::recorded::{ReplaySettings, replay_trial};

/// A method with its points.
type Kept = (String, Vec<Point>);

/// Where curves are kept.
pub struct Folder(PathBuf);

/// What a method had after so many seconds.
#[derive(Clone, Copy)]
pub struct Point {
    pub wall_s: f64,
    pub cpu_s: f64,
    pub evaluations: usize,
    pub objective: f64,
    pub held_out: f64,
}

/// What a method passed by; time in which the curve itself is made does not count.
pub struct Curve {
    pub method: String,
    pub points: Vec<Point>,
    spent: SearchUsage,
    paused_s: f64,
    paused_cpu_s: f64,
    file: std::fs::File,
}

/// The standardised mean squared error of u, v and r together; infinite where a simulation leaves
/// the physical range.
pub fn held_out_error(
    model: &Model,
    law: &Law,
    trials: &[Trial],
    deviations: &BTreeMap<Channel, f64>,
    restart_s: f64,
) -> f64 {
    let mut ship = Ship::new(model, law).unwrap_or_else(|error| panic!("{error}"));
    ship.set_envelope_speed(2.0);
    let settings = ReplaySettings { restart_s: Some(restart_s), ..ReplaySettings::default() };
    let one = |trial: &Trial| {
        let run = replay_trial(&ship, trial, &settings).unwrap_or_else(|error| panic!("{error}"));
        run.stopped.is_none().then(|| SquaredError::from_trial(trial, &run))
    };
    let errors: Option<Vec<SquaredError>> = trials.par_iter().map(one).collect();
    let mut sum = SquaredError::default();
    let Some(errors) = errors else { return f64::INFINITY };
    errors.iter().for_each(|error| sum.add(error));
    let of = |channel: Channel| {
        (sum.channel_rmse(channel).unwrap_or(f64::INFINITY) / deviations[&channel]).powi(2)
    };
    [Channel::U, Channel::V, Channel::R].map(of).iter().sum()
}

impl Curve {
    pub fn new(method: &str, folder: &Folder) -> Self {
        let mut file = std::fs::File::create(folder.0.join(format!("{method}.csv")))
            .expect("a file in the folder");
        writeln!(file, "wall_s,cpu_s,evaluations,objective,held_out_error")
            .expect("room on the disk");
        Self {
            method: method.to_owned(),
            points: Vec::new(),
            spent: SearchUsage::start_now(),
            paused_s: 0.0,
            paused_cpu_s: 0.0,
            file,
        }
    }

    /// Keeps a point where it is `due` or 5 % and a second have passed since the last.
    pub fn see(
        &mut self,
        evaluations: usize,
        objective: f64,
        due: bool,
        held_out: &dyn Fn() -> f64,
    ) {
        let last = self.points.last().map_or(0.0, |point| point.wall_s);
        let now = self.spent.wall_s() - self.paused_s;
        if due || now > (1.05 * last).max(last + 1.0) {
            self.keep(evaluations, objective, held_out);
        }
    }

    /// The point at which a refinement has ended, selection and all.
    pub fn end(&mut self, held_out: &dyn Fn() -> f64) {
        let (evaluations, objective) =
            self.points.last().map_or((0, f64::NAN), |point| (point.evaluations, point.objective));
        self.keep(evaluations, objective, held_out);
    }

    fn keep(&mut self, evaluations: usize, objective: f64, held_out: &dyn Fn() -> f64) {
        let (wall_s, cpu_s) =
            (self.spent.wall_s() - self.paused_s, self.cpu_s() - self.paused_cpu_s);
        let begun = (Instant::now(), self.cpu_s());
        let point = Point { wall_s, cpu_s, evaluations, objective, held_out: held_out() };
        writeln!(self.file, "{wall_s:.3},{cpu_s:.3},{evaluations},{objective},{}", point.held_out)
            .expect("room on the disk");
        eprintln!(
            "{} {wall_s:.1} s: {evaluations} evaluations, objective {objective:.5}, held out {:.5}",
            self.method, point.held_out
        );
        self.points.push(point);
        self.paused_s += begun.0.elapsed().as_secs_f64();
        self.paused_cpu_s += self.cpu_s() - begun.1;
    }

    fn cpu_s(&self) -> f64 {
        self.spent.cpu_s().unwrap_or(f64::NAN)
    }
}

impl Folder {
    pub fn new(path: &str) -> Self {
        std::fs::create_dir_all(path).expect("a folder");
        Self(path.into())
    }

    /// All curves of the folder, held-out error over seconds, both axes logarithmic; and the table.
    pub fn show(&self) {
        let curves = ["trajectory", "cma-es"].map(|method| self.kept(method));
        std::fs::write(self.0.join("race.svg"), svg(&curves)).expect("room on the disk");
        table(&curves);
    }

    /// The curve of a method as its file has it: empty where there is none.
    fn kept(&self, method: &str) -> Kept {
        let text =
            std::fs::read_to_string(self.0.join(format!("{method}.csv"))).unwrap_or_default();
        let point = |line: &str| {
            let mut values = line.split(',').map_while(|value| value.parse::<f64>().ok());
            let mut next = || values.next();
            let (wall_s, cpu_s, evaluations) = (next()?, next()?, next()? as usize);
            Some(Point { wall_s, cpu_s, evaluations, objective: next()?, held_out: next()? })
        };
        (method.to_owned(), text.lines().skip(1).filter_map(point).collect())
    }
}

const WIDTH: f64 = 720.0;
const HEIGHT: f64 = 440.0;
const LEFT: f64 = 70.0;
const EDGE: f64 = 50.0;

fn svg(curves: &[Kept]) -> String {
    let all =
        || curves.iter().flat_map(|(_, points)| points).filter(|point| point.held_out.is_finite());
    let range = |of: &dyn Fn(&Point) -> f64| {
        let (low, high) = all()
            .map(of)
            .fold((f64::INFINITY, 0.0_f64), |(low, high), value| (low.min(value), high.max(value)));
        (low.log10().floor(), high.log10().ceil().max(low.log10().floor() + 1.0))
    };
    let (seconds, errors) = (range(&|point| point.wall_s.max(0.1)), range(&|point| point.held_out));
    let x = |value: f64| {
        LEFT + (value.max(0.1).log10() - seconds.0) / (seconds.1 - seconds.0)
            * (WIDTH - LEFT - EDGE)
    };
    let y = |value: f64| {
        EDGE + (errors.1 - value.log10()) / (errors.1 - errors.0) * (HEIGHT - 2.0 * EDGE)
    };
    let mut out = format!(
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {WIDTH} {HEIGHT}' \
         font-family='sans-serif' font-size='13'>"
    );
    let _ = write!(out, "<rect width='{WIDTH}' height='{HEIGHT}' fill='white'/>");
    for decade in seconds.0 as i32..=seconds.1 as i32 {
        let (at, value) = (x(10_f64.powi(decade)), 10_f64.powi(decade));
        let _ = write!(
            out,
            "<line x1='{at}' x2='{at}' y1='{EDGE}' y2='{}' stroke='#ddd'/><text x='{at}' y='{}' \
             text-anchor='middle'>{value}</text>",
            HEIGHT - EDGE,
            HEIGHT - EDGE + 18.0
        );
    }
    for decade in errors.0 as i32..=errors.1 as i32 {
        let (at, value) = (y(10_f64.powi(decade)), 10_f64.powi(decade));
        let _ = write!(
            out,
            "<line x1='{LEFT}' x2='{}' y1='{at}' y2='{at}' stroke='#ddd'/><text x='{}' y='{}' \
             text-anchor='end'>{value}</text>",
            WIDTH - EDGE,
            LEFT - 6.0,
            at + 4.0
        );
    }
    for (index, ((method, points), colour)) in
        curves.iter().zip(["#0b5394", "#b45f06", "#38761d"]).enumerate()
    {
        let points: Vec<String> = points
            .iter()
            .filter(|point| point.held_out.is_finite())
            .map(|point| format!("{:.1},{:.1}", x(point.wall_s), y(point.held_out)))
            .collect();
        let _ = write!(
            out,
            "<polyline points='{}' fill='none' stroke='{colour}' stroke-width='2'/>",
            points.join(" ")
        );
        let _ = write!(
            out,
            "<text x='{}' y='{}' fill='{colour}'>{}</text>",
            WIDTH - 160.0,
            EDGE + 18.0 * (1.0 + index as f64),
            method
        );
    }
    let _ = write!(
        out,
        "<text x='{}' y='{}' text-anchor='middle'>seconds on the wall</text>",
        WIDTH / 2.0,
        HEIGHT - 10.0
    );
    let _ = write!(
        out,
        "<text x='{LEFT}' y='{}'>standardised squared error of u, v, r on manoeuvres held out, 100 \
         s at a time</text></svg>",
        EDGE - 14.0
    );
    out
}

/// What each method had at certain times, and at its end.
fn table(curves: &[Kept]) {
    println!(
        "{:<11} {:>9} {:>9} {:>12} {:>12} {:>12}",
        "method", "wall s", "cpu s", "evaluations", "objective", "held out"
    );
    let times = [10.0, 20.0, 60.0, 120.0, 300.0, 600.0, 1200.0, 1800.0, 3600.0, f64::INFINITY];
    for (method, points) in curves {
        let mut told = None;
        for time in times {
            let Some(at) = points.iter().rposition(|point| point.wall_s <= time) else { continue };
            if told != Some(at) {
                let Point { wall_s, cpu_s, evaluations, objective, held_out } = points[at];
                println!(
                    "{:<11} {wall_s:>9.1} {cpu_s:>9.1} {evaluations:>12} {objective:>12.5} \
                     {held_out:>12.5}",
                    method
                );
            }
            told = Some(at);
        }
    }
}
