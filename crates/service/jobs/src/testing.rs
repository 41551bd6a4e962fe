//! A demonstration ship with a version of each kind of recipe, for tests: a refinement, the
//! diagnosis of it on trials with a rudder offset, and a refinement from statistics.
#![allow(clippy::unwrap_used)]

use std::sync::Arc;

use serde_json::Value;
use sistership_diagnosis::Settings;
use sistership_fleet::bulk::BulkSettings;
use sistership_identification::refine::RefinementSettings;
use sistership_model::effect::AppliedEffect;
use sistership_model::quantity::Quantity;
use sistership_model::trial::{Channel, Trial};
use sistership_model::version::{RecipeTrial, SourceVersion, VersionRecipe, sha256_hex};
use sistership_model::{Model, Zoo};
use sistership_simulation::manoeuvre::{ManoeuvreSettings, simulate_turn, simulate_zigzag};
use sistership_simulation::state::{RECORDED_CHANNELS, at};
use sistership_simulation::{Ship, Trajectory};
use sistership_store::testing::TestDatabase;
use sistership_store::{NewShip, NewVersion, VersionHead};
use sistership_trials::samples::to_parquet;
use tokio::sync::OnceCell;

use crate::archive::{Archive, parse_vessel};
use crate::derive::{derive, published_document};
use crate::library::embedded_library;
use crate::recipe::{DerivationRecipe, DiagnosisKind, DiagnosisRecipe, FamilyKind, FamilyRecipe};
use crate::seed::new_ship;
use crate::sorted_json::sort_keys;
use crate::version::VersionDocument;

/// Name of the demonstration ship. Its versions are 1, 2 and 3.
pub(crate) const DEMO_SHIP: &str = "demo-ship";
/// Its source model, the first version of this ship.
const SOURCE_SHIP: &str = "sr108";
const LAW: &str = "son-nomoto";
/// Amplitudes of the noise of `u, v, r, psi, x, y, phi, p`, SI.
const NOISE: [f64; 8] = [4e-3, 5e-3, 1e-4, 6e-4, 0.5, 0.5, 6e-4, 1e-4];

/// Rows and objects of the archive.
#[derive(Debug, Default)]
pub(crate) struct DemoRows {
    /// Name and text of the law.
    pub law: (String, String),
    /// The source's ship and the demonstration ship.
    pub ships: Vec<NewShip>,
    /// Samples of the trials: those of the refinement, then those with a rudder offset.
    pub samples: Vec<Vec<u8>>,
    /// The source, then the versions of the demonstration ship.
    pub versions: Vec<NewVersion>,
}

/// Returns the rows; they are derived once in a process.
pub(crate) async fn demo_rows() -> &'static DemoRows {
    static ROWS: OnceCell<DemoRows> = OnceCell::const_new();
    ROWS.get_or_init(derive_rows).await
}

impl DemoRows {
    /// Opens an archive with everything but versions. Of the program's own it has the library of
    /// effects.
    pub async fn open_archive(&self, database: &TestDatabase) -> Archive {
        let archive = Archive::open(&database.url, database.folder.path()).await.unwrap();
        archive.store.laws().insert(&self.law.0, &self.law.1).await.unwrap();
        for ship in &self.ships {
            archive.store.ships().create(ship).await.unwrap();
        }
        for samples in &self.samples {
            archive.objects.put(samples.clone().into()).await.unwrap();
        }
        archive
    }

    fn trials(&self, names: [&str; 2], from: usize) -> Vec<RecipeTrial> {
        let one = |(name, samples): (&str, &Vec<u8>)| RecipeTrial {
            name: name.to_owned(),
            sha256: sha256_hex(samples),
        };
        names.into_iter().zip(&self.samples[from..]).map(one).collect()
    }
}

async fn derive_rows() -> DemoRows {
    let mut rows = start_rows();
    let database = TestDatabase::new_sqlite();
    let archive = rows.open_archive(&database).await;
    let source = rows.publish_source();
    let source = create(&archive, &mut rows, source).await;
    let refined = rows.refinement(source_of(&source));
    let refined = create(&archive, &mut rows, derived(&archive, &refined, "published").await).await;
    let diagnosis = rows.diagnosis(source_of(&refined));
    let diagnosed = derived(&archive, &diagnosis, "diagnosis").await;
    create(&archive, &mut rows, diagnosed).await;
    let family = rows.family(source_of(&refined));
    let member = derived(&archive, &family, "statistics").await;
    create(&archive, &mut rows, member).await;
    archive.store.close().await;
    rows
}

async fn create(archive: &Archive, rows: &mut DemoRows, new: NewVersion) -> VersionHead {
    let made = archive.store.versions().create(&new, &[]).await.unwrap();
    rows.versions.push(new);
    made
}

async fn derived(archive: &Archive, recipe: &DerivationRecipe, method: &str) -> NewVersion {
    let made = derive(archive, DEMO_SHIP, recipe, Arc::new(|_, _| true)).await.unwrap();
    new_version(&made.with_explicit_settings().unwrap().document, method)
}

fn new_version(document: &VersionDocument, method: &str) -> NewVersion {
    NewVersion {
        model: document.ship.clone(),
        parent: None,
        law: LAW.to_owned(),
        method: method.to_owned(),
        document: document.to_canonical_json().unwrap(),
        weights: None,
    }
}

fn source_of(head: &VersionHead) -> SourceVersion {
    SourceVersion { ship: head.model.clone(), number: head.number, sha256: head.sha256.clone() }
}

/// The law, the ships and the samples.
fn start_rows() -> DemoRows {
    let zoo = Zoo::load_embedded().unwrap();
    let ship = new_ship(zoo.vessel(SOURCE_SHIP).unwrap()).unwrap();
    let demo = NewShip {
        name: DEMO_SHIP.to_owned(),
        title: "Demo ship".to_owned(),
        document: demo_document(&ship.document),
        ..ship.clone()
    };
    let mut model = zoo.find_model(SOURCE_SHIP).unwrap();
    model.coefficients.get_mut("N_v").unwrap().value *= 1.1;
    let law = (LAW.to_owned(), zoo.law_text(LAW).unwrap().to_owned());
    let samples = [None, Some(rudder_offset(&zoo))].into_iter().flat_map(|effect| {
        let mut model = model.clone();
        model.effects.extend(effect);
        sailed_trials(&zoo, &model).map(|trial| to_parquet(&trial).unwrap())
    });
    DemoRows { law, ships: vec![ship, demo], samples: samples.collect(), versions: Vec::new() }
}

/// The source's document under the name of the demonstration ship, without published models.
fn demo_document(source: &str) -> String {
    let mut document: Value = serde_json::from_str(source).unwrap();
    document["name"] = DEMO_SHIP.into();
    document["title"] = "Demo ship".into();
    document["models"] = Value::Array(Vec::new());
    document.to_string()
}

fn rudder_offset(zoo: &Zoo) -> AppliedEffect {
    let effect = zoo.effect("rudder-offset").unwrap();
    AppliedEffect {
        name: effect.name.clone(),
        acts_on: effect.acts_on,
        parameters: [("offset_rad".to_owned(), Quantity::new(0.03, "hidden"))].into(),
        form: effect.forms[0].file.clone(),
    }
}

/// A turn and a zigzag of a model, recorded once a second with noise.
fn sailed_trials(zoo: &Zoo, model: &Model) -> [Trial; 2] {
    let ship = Ship::new(model, zoo.law(&model.law).unwrap()).unwrap();
    let settings = ManoeuvreSettings { duration_s: Some(300.0), ..ManoeuvreSettings::default() };
    let turn = simulate_turn(&ship, 20.0, &settings).unwrap().track;
    let zigzag = simulate_zigzag(&ship, 20.0, 20.0, &settings).unwrap().track;
    [recorded_trial("turn", &turn), recorded_trial("zigzag", &zigzag)]
}

fn recorded_trial(name: &str, track: &Trajectory) -> Trial {
    let thin = |column: Vec<f64>| column.into_iter().step_by(10).collect::<Vec<f64>>();
    let noisy = |((channel, place), amplitude): ((Channel, usize), f64)| {
        let column = thin(track.state_column(place)).into_iter().enumerate();
        (channel, column.map(|(k, x)| x + amplitude * noise(k, place)).collect::<Vec<f64>>())
    };
    let motions = RECORDED_CHANNELS.into_iter().zip(NOISE).map(noisy);
    let rudder = (Channel::Delta, thin(track.state_column(at::DELTA)));
    let revolutions = (Channel::N, thin(track.n_rps.clone()));
    Trial {
        name: name.to_owned(),
        t_s: thin(track.t_s.clone()),
        channels: motions.chain([rudder, revolutions]).collect(),
        ..Trial::default()
    }
}

/// Values between -1 and 1 that depend on each other as little as noise, the same on every run.
fn noise(k: usize, place: usize) -> f64 {
    let phase = (12.9898 * k as f64 + 78.233 * place as f64).sin() * 43_758.545_3;
    2.0 * (phase - phase.floor()) - 1.0
}

impl DemoRows {
    fn law_sha256(&self) -> String {
        sha256_hex(self.law.1.as_bytes())
    }

    fn demo_sha256(&self) -> String {
        sha256_hex(self.ships[1].document.as_bytes())
    }

    fn publish_source(&self) -> NewVersion {
        let ship = &self.ships[0];
        let vessel = parse_vessel(&ship.name, &ship.document).unwrap();
        let zoo = Zoo::load_embedded().unwrap();
        let ship_sha256 = sha256_hex(ship.document.as_bytes());
        let law = zoo.law(LAW).unwrap();
        let published =
            published_document(&vessel, LAW, law, &ship_sha256, &self.law_sha256()).unwrap();
        new_version(&published, "published-source")
    }

    fn refinement(&self, source: SourceVersion) -> DerivationRecipe {
        let mut settings = RefinementSettings { lambda_count: 10, ..Default::default() };
        settings.bands.samples = 4;
        DerivationRecipe::Plain(VersionRecipe::Refinement {
            source: Some(source),
            law: None,
            ship_sha256: self.demo_sha256(),
            law_sha256: self.law_sha256(),
            across: None,
            population: Vec::new(),
            effects_sha256: embedded_library().unwrap().sha256.clone(),
            trials: self.trials(["turn.csv", "zigzag.csv"], 0),
            settings: sort_keys(serde_json::to_value(settings).unwrap()),
            code_revision: "test".to_owned(),
        })
    }

    fn diagnosis(&self, diagnosed: SourceVersion) -> DerivationRecipe {
        DerivationRecipe::Diagnosis(DiagnosisRecipe {
            kind: DiagnosisKind::Diagnosis,
            diagnosed,
            law_sha256: self.law_sha256(),
            trials: self.trials(["offset-turn.csv", "offset-zigzag.csv"], 2),
            effects_sha256: embedded_library().unwrap().sha256.clone(),
            settings: sort_keys(serde_json::to_value(Settings::default()).unwrap()),
            code_revision: "test".to_owned(),
        })
    }

    fn family(&self, foundation: SourceVersion) -> DerivationRecipe {
        DerivationRecipe::Family(FamilyRecipe {
            kind: FamilyKind::Family,
            start: foundation.clone(),
            ship_sha256: Some(self.demo_sha256()),
            foundation,
            prior: None,
            law_sha256: self.law_sha256(),
            trials: self.trials(["turn.csv", "zigzag.csv"], 0),
            settings: BulkSettings { lambda_count: 10, ..BulkSettings::default() },
            code_revision: "test".to_owned(),
        })
    }
}
