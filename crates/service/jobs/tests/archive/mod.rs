//! An archive with the zoo and trials of a ship.

use sistership_jobs::archive::Archive;
use sistership_jobs::catalogue::ZooCache;
use sistership_jobs::seed;
use sistership_model::version::RecipeTrial;
use sistership_model::{Trial, Zoo, trial::Channel};
use sistership_simulation::Ship;
use sistership_simulation::manoeuvre::{ManoeuvreSettings, simulate_zigzag};
use sistership_simulation::state::{RECORDED_CHANNELS, at};
use sistership_store::NewTrial;
use sistership_store::testing::TestDatabase;
use sistership_trials::samples::write_parquet;

/// Zigzags of a Mariner that is more damped than its model says.
fn trials() -> Vec<Trial> {
    let zoo = Zoo::load_embedded().unwrap();
    let mut model = zoo.find_model("mariner").unwrap();
    for (name, factor) in [("N_r", 1.25), ("N_delta", 0.85)] {
        model.coefficients.get_mut(name).unwrap().value *= factor;
    }
    let ship = Ship::new(&model, zoo.law(&model.law).unwrap()).unwrap();
    let sailed = |angle: f64| {
        let settings = ManoeuvreSettings { duration_s: Some(400.0), ..Default::default() };
        let track = simulate_zigzag(&ship, angle, angle.abs(), &settings).unwrap().track;
        let thin = |column: Vec<f64>| column.into_iter().step_by(10).collect::<Vec<f64>>();
        let columns = RECORDED_CHANNELS[..6].iter().chain(&[(Channel::Delta, at::DELTA)]);
        let revolutions = (Channel::N, vec![1.0; thin(track.t_s.clone()).len()]);
        let channels = columns.map(|&(channel, at)| (channel, thin(track.state_column(at))));
        let channels = channels.chain([revolutions]).collect();
        let name = format!("zigzag {angle}");
        Trial { name, t_s: thin(track.t_s.clone()), channels, ..Trial::default() }
    };
    [10.0, -10.0, 20.0, -20.0].map(sailed).to_vec()
}

/// An archive with the zoo and those trials.
pub async fn archive(database: &TestDatabase) -> (Archive, Vec<RecipeTrial>) {
    let archive = Archive::open(&database.url, database.folder.path()).await.unwrap();
    seed::seed_zoo(&archive.store, &ZooCache::default()).await.unwrap();
    let mut named = Vec::new();
    for trial in trials() {
        let mut bytes = Vec::new();
        write_parquet(&mut bytes, &trial).unwrap();
        let key = archive.objects.put(bytes.into()).await.unwrap();
        let text = |text: &str| text.to_owned();
        let new = NewTrial {
            ship: text("mariner"),
            sha256: key.clone(),
            name: trial.name.clone(),
            manifest: text("{}"),
            conventions: text("{}"),
            manoeuvre: None,
            sample_rows: 401,
            duration_s: 400.0,
            warnings: text("[]"),
            object_key: key.clone(),
        };
        archive.store.trials().insert(&new).await.unwrap();
        named.push(RecipeTrial { name: trial.name, sha256: key });
    }
    (archive, named)
}
