//! Made-up fleets: ships like the Mariner in size and law, each with coefficients of its own, and
//! trials that they have sailed.

use std::sync::Arc;

use bytes::Bytes;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha12Rng;
use rand_distr::{Distribution, StandardNormal};
use rayon::prelude::*;
use sistership_model::trial::{Channel, Trial};
use sistership_model::{Law, Model, Vessel, Zoo};
use sistership_priors::transfer::transfer_model;
use sistership_simulation::Ship;
use sistership_simulation::manoeuvre::{ManoeuvreSettings, simulate_turn, simulate_zigzag};
use sistership_simulation::state::{RECORDED_CHANNELS, Trajectory, at};
use sistership_store::{NewShip, NewTrial, ObjectStorage, Store};
use sistership_trials::samples::to_parquet;
use tokio::task::JoinSet;

/// The ship whose model the fleet is founded on.
pub const FOUNDATION: &str = "mariner";
/// By how much ships differ in length and coefficients.
const SIZE: f64 = 0.2;
const SCATTER: f64 = 0.05;
/// Deviation of speeds, m/s, and of the rate of turn, rad/s, as recorded every two seconds.
const NOISE: [(Channel, f64); 3] = [(Channel::U, 0.01), (Channel::V, 0.01), (Channel::R, 1e-4)];
const INTERVAL_S: usize = 2;
const DURATION_S: f64 = 500.0;

/// A ship of a fleet with the samples of its trials.
pub struct Made {
    /// Its row.
    pub ship: NewShip,
    /// Its trials.
    pub trials: Vec<(NewTrial, Bytes)>,
}

/// What fleets are made from.
pub struct Yard {
    model: Model,
    law: Arc<Law>,
    vessel: Vessel,
}

impl Yard {
    /// The Mariner's.
    ///
    /// # Panics
    /// Where the zoo does not have it.
    pub fn new() -> Self {
        let zoo = Zoo::load_embedded().expect("the zoo");
        let model = zoo.find_model(FOUNDATION).expect("the foundation");
        let law = Arc::clone(zoo.law(&model.law).expect("its law"));
        Self { law, vessel: Vessel::clone(zoo.vessel(FOUNDATION).expect("the ship")), model }
    }

    /// The ship of this number with so many trials, always the same.
    ///
    /// # Panics
    /// Where no ship can be made of it.
    pub fn build(&self, number: usize, trials: usize) -> Made {
        let name = format!("sister-{number:05}");
        let mut rng = ChaCha12Rng::seed_from_u64(number as u64);
        let vessel = self.vessel(&name, 1.0 + SIZE * (2.0 * rng.random::<f64>() - 1.0));
        let own = |rng: &mut ChaCha12Rng| -> f64 {
            1.0 + SCATTER * <StandardNormal as Distribution<f64>>::sample(&StandardNormal, rng)
        };
        let mut truth = transfer_model(&self.model, &self.law, &vessel, None);
        truth.coefficients.values_mut().for_each(|quantity| quantity.value *= own(&mut rng));
        let ship = Ship::new(&truth, &self.law).expect("a ship");
        let trials = (0..trials).map(|trial| self.trial(&name, &ship, trial, &mut rng)).collect();
        let document = serde_json::to_string(&vessel.file).expect("its document");
        let (title, category) = (vessel.file.title.clone(), vessel.file.category.clone());
        Made { ship: NewShip { name, title, category, document }, trials }
    }

    /// The Mariner's particulars at another scale, without its models.
    fn vessel(&self, name: &str, scale: f64) -> Vessel {
        let of = |particular: &str| {
            self.vessel.particular(particular).expect("a particular of the Mariner")
        };
        let text = format!(
            "kind: vessel\nname: {name}\ntitle: {name}, made up\ncategory: {}\ntype: cargo ship\n\
             sources:\n  made-up: {{ citation: \"The Mariner at scale {scale:.4}\" }}\n\
             particulars:\n  source: made-up\n  values:\n    lpp_m: {}\n    beam_m: {}\n    \
             draught_m: {}\n    displacement_m3: {}\n    x_g_m: {}\n    service_speed_m_s: {}\n    \
             water_density_kg_m3: 1025.0\n",
            self.vessel.file.category,
            scale * of("lpp_m"),
            scale * of("beam_m"),
            scale * of("draught_m"),
            scale.powi(3) * of("displacement_m3"),
            scale * of("x_g_m"),
            scale.sqrt() * of("service_speed_m_s"),
        );
        Vessel::parse(name, &text).unwrap_or_else(|error| panic!("{error}"))
    }

    fn trial(
        &self,
        name: &str,
        ship: &Ship,
        index: usize,
        rng: &mut ChaCha12Rng,
    ) -> (NewTrial, Bytes) {
        let settings = ManoeuvreSettings {
            step_s: Some(1.0),
            duration_s: Some(DURATION_S),
            ..ManoeuvreSettings::default()
        };
        let (what, track) = match index % 4 {
            0 => (
                "zigzag 20/20",
                simulate_zigzag(ship, 20.0, 20.0, &settings).map(|zigzag| zigzag.track),
            ),
            1 => ("turn 35", simulate_turn(ship, 35.0, &settings).map(|turn| turn.track)),
            2 => (
                "zigzag -10/10",
                simulate_zigzag(ship, -10.0, 10.0, &settings).map(|zigzag| zigzag.track),
            ),
            _ => ("turn -20", simulate_turn(ship, -20.0, &settings).map(|turn| turn.track)),
        };
        let track = track.unwrap_or_else(|stopped| panic!("{name} {stopped}"));
        let samples = Bytes::from(
            to_parquet(&recorded(&track, &format!("{what} {index}"), rng)).expect("samples"),
        );
        let key = sistership_store::sha256_hex(&samples);
        let new = NewTrial {
            ship: name.to_owned(),
            sha256: key.clone(),
            name: format!("{what} {index}"),
            manifest: "{}".into(),
            conventions: "{}".into(),
            manoeuvre: Some(what.to_owned()),
            sample_rows: track.t_s.len().div_ceil(INTERVAL_S) as i64,
            duration_s: DURATION_S,
            warnings: "[]".into(),
            object_key: key,
        };
        (new, samples)
    }

    /// Builds ships and puts them into a store with their trials.
    ///
    /// # Panics
    /// Where the store does not take them.
    pub async fn launch(
        &self,
        store: &Store,
        objects: &ObjectStorage,
        numbers: std::ops::Range<usize>,
        trials: usize,
    ) {
        let numbers: Vec<usize> = numbers.collect();
        for some in numbers.chunks(64) {
            let made: Vec<Made> =
                some.par_iter().map(|&number| self.build(number, trials)).collect();
            let mut kept: JoinSet<()> =
                made.into_iter().map(|made| keep(store.clone(), objects.clone(), made)).collect();
            while let Some(kept) = kept.join_next().await {
                kept.expect("a kept ship");
            }
        }
    }
}

/// One ship after the other would wait for the disk by itself.
async fn keep(store: Store, objects: ObjectStorage, Made { ship, trials }: Made) {
    store.ships().create(&ship).await.expect("a new ship");
    for (trial, samples) in trials {
        objects.put(samples).await.expect("kept samples");
        store.trials().insert(&trial).await.expect("a kept trial");
    }
}

impl Default for Yard {
    fn default() -> Self {
        Self::new()
    }
}

/// The name of the ship of this number.
pub fn name(number: usize) -> String {
    format!("sister-{number:05}")
}

fn recorded(track: &Trajectory, name: &str, rng: &mut ChaCha12Rng) -> Trial {
    let every = |column: Vec<f64>| column.into_iter().step_by(INTERVAL_S).collect::<Vec<f64>>();
    let mut channels: std::collections::BTreeMap<Channel, Vec<f64>> = RECORDED_CHANNELS[..6]
        .iter()
        .map(|&(channel, index)| (channel, every(track.state_column(index))))
        .collect();
    channels.insert(Channel::Delta, every(track.state_column(at::DELTA)));
    for (channel, deviation) in NOISE {
        let shaken = channels.get_mut(&channel).expect("a recorded channel");
        let normals = StandardNormal.sample_iter(&mut *rng);
        shaken
            .iter_mut()
            .zip(normals)
            .for_each(|(value, normal): (_, f64)| *value += deviation * normal);
    }
    Trial { name: name.to_owned(), t_s: every(track.t_s.clone()), channels, ..Trial::default() }
}
