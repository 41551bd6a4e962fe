//! What stands for the data of Mei 2019: MARIN's free-running trials of the KVLCC2 are not public,
//! so that trials are sailed by its published MMG model, of which the reference model knows
//! nothing, and read with scatter.

use std::collections::BTreeMap;

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha12Rng;
use rand_distr::StandardNormal;
use sistership_model::trial::{Channel, Trial};
use sistership_model::{Law, Model, Zoo};
use sistership_priors::similarity::VectorDefinition;
use sistership_priors::source::rank_similar;
use sistership_priors::transfer::{TrialApproach, transfer_model};
use sistership_simulation::manoeuvre::{ManoeuvreSettings, simulate_turn, simulate_zigzag};
use sistership_simulation::state::{RECORDED_CHANNELS, Trajectory, at};
use sistership_simulation::{Ship, metrics};

/// The ship and the four among which the paper chooses its reference model.
const TARGET: &str = "kvlcc2";
const CANDIDATES: [(&str, f64); 4] =
    [("mariner", -0.576), ("esso-tanker", 0.851), ("sr108", -0.887), ("pcc", -0.723)];

/// Standard deviation of readings: of u and v by the approach speed U, of r by U/L, as in the
/// synthetic trials of `tests/src/synthetic.rs`.
const SCATTER: f64 = 0.005;

/// A rudder angle with the heading at which it is reversed, or held.
pub type Order = (f64, Option<f64>);

/// The ship as it is, and the reference model on its particulars.
pub struct Pair {
    pub truth: Ship,
    pub reference: Model,
    pub law: Law,
    speed_m_s: f64,
}

impl Pair {
    pub fn new() -> Self {
        let zoo = Zoo::load_embedded().unwrap_or_else(|error| panic!("{error}"));
        let own = zoo.find_model(TARGET).unwrap_or_else(|error| panic!("{error}"));
        let truth = Ship::new(&own, zoo.law(&own.law).expect("its law"))
            .unwrap_or_else(|error| panic!("{error}"));
        let target = zoo.vessel(TARGET).expect("in the zoo");
        let name = most_similar(&zoo);
        let source = zoo.find_model(&name).unwrap_or_else(|error| panic!("{error}"));
        let law = Law::clone(zoo.law(&source.law).expect("its law"));
        let speed_m_s = truth.approach_speed_m_s();
        // Without revolutions they are its source's by Froude's law.
        let approach = TrialApproach { speed_m_s, n_rps: None };
        let reference = transfer_model(&source, &law, target, Some(approach));
        Self { truth, reference, law, speed_m_s }
    }

    /// A trial of the true ship, one sample a second as in the paper.
    pub fn sailed(&self, (rudder, switch): Order) -> Trial {
        let settings = ManoeuvreSettings { duration_s: Some(1400.0), ..Default::default() };
        let track = match switch {
            Some(switch) => {
                simulate_zigzag(&self.truth, rudder, switch, &settings).map(|z| z.track)
            }
            None => simulate_turn(&self.truth, rudder, &settings).map(|t| t.track),
        };
        let track = track.unwrap_or_else(|stopped| panic!("{stopped}"));
        self.recorded(&format!("{rudder}/{switch:?}"), &track)
    }

    fn recorded(&self, name: &str, track: &Trajectory) -> Trial {
        let thin = |column: Vec<f64>| column.into_iter().step_by(10).collect::<Vec<f64>>();
        let columns = RECORDED_CHANNELS[..6].iter().chain(&[(Channel::Delta, at::DELTA)]);
        let mut channels: BTreeMap<Channel, Vec<f64>> =
            columns.map(|&(channel, place)| (channel, thin(track.state_column(place)))).collect();
        // The reference model runs at its own revolutions: the paper's Eq. 6 knows speeds alone.
        let n_rps = self.reference.revolutions_rps.unwrap_or_default();
        channels.insert(Channel::N, vec![n_rps; channels[&Channel::U].len()]);
        let t_s = thin(track.t_s.clone());
        Trial { name: name.to_owned(), t_s, channels, ..Trial::default() }
    }

    /// A trial as instruments read it.
    pub fn read(&self, trial: &Trial, seed: u64) -> Trial {
        let (mut rng, mut read) = (ChaCha12Rng::seed_from_u64(seed), trial.clone());
        let unit = SCATTER * self.speed_m_s;
        let deviations =
            [(Channel::U, unit), (Channel::V, unit), (Channel::R, unit / self.truth.lpp_m())];
        for (channel, deviation) in deviations {
            for value in read.channels.get_mut(&channel).into_iter().flatten() {
                *value += deviation * rng.sample::<f64, _>(StandardNormal);
            }
        }
        read
    }
}

/// The most similar of the paper's four by Eqs. 4 and 5; prints its Table 6 beside ours.
fn most_similar(zoo: &Zoo) -> String {
    let target = zoo.vessel(TARGET).expect("in the zoo");
    let ranking = rank_similar(zoo, target, Some(VectorDefinition::Mei2019), &[]).ranking;
    println!("correlation with {TARGET} (Mei, Table 6: printed, here)");
    let mut best = (f64::NEG_INFINITY, String::new());
    for (name, printed) in CANDIDATES {
        let found = ranking.iter().find(|ranked| ranked.ship == name);
        let found = found.and_then(|ranked| ranked.correlation).unwrap_or(f64::NAN);
        println!("  {name:<12} {printed:+.3}  {found:+.3}");
        if found > best.0 {
            best = (found, name.to_owned());
        }
    }
    best.1
}

/// Advance and tactical diameter by the length.
pub fn turning(track: &Trajectory, rudder_deg: f64, lpp_m: f64) -> [f64; 2] {
    let metrics = metrics::TurningMetrics::from_track(track, rudder_deg);
    let of = |value: Option<f64>| value.map_or(f64::NAN, |metres| metres / lpp_m);
    metrics.map_or([f64::NAN; 2], |m| [of(m.advance_m), of(m.tactical_diameter_m)])
}
