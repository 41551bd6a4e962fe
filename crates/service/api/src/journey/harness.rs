//! A server on a free port, and requests of tests to it.

use std::time::Duration;

use reqwest::multipart::{Form, Part};
use reqwest::{Client, Response, StatusCode};
use serde_json::{Value, json};
use sistership_store::testing::TestDatabase;

use crate::{Config, LeaseSettings, RunningServer, Server};

/// A ship like the SR108, without its model and under another name.
pub(super) const SHIP: &str = "
kind: vessel
name: demo-ship
title: Demo ship
category: dry-cargo
sources: { made-up: { citation: For tests } }
particulars:
  source: made-up
  values: { lpp_m: 175.0, beam_m: 25.4, draught_m: 8.5, displacement_m3: 21222.0, block_coefficient: 0.562, x_g_m: 0.0,
    rudder_area_m2: 33.0376, propeller_diameter_m: 6.533, service_speed_m_s: 12.4, yaw_gyradius_ratio: 0.24 }
";

pub(super) struct Harness {
    pub server: RunningServer,
    pub client: Client,
    pub database: TestDatabase,
}

pub(super) fn config(database: &TestDatabase) -> Config {
    let mut config = Config::new(database.folder.path().join("data"));
    config.listen.set_port(0);
    config.database_url = database.url.clone();
    let (lease, beat, poll) =
        (Duration::from_secs(5), Duration::from_millis(200), Duration::from_millis(50));
    // Two thousand clients of one address, see `registry`.
    (config.limits.connections, config.limits.connections_per_address) = (4096, 4096);
    config.leases = LeaseSettings { lease, beat, poll, ..LeaseSettings::default() };
    config
}

impl Harness {
    pub async fn on(database: TestDatabase) -> Self {
        let server = Server::start(config(&database)).await.unwrap();
        Self { server, client: Client::new(), database }
    }

    pub fn url(&self, path: &str) -> String {
        format!("{}{path}", self.server.url())
    }

    pub async fn get(&self, path: &str) -> Value {
        read(self.client.get(self.url(path)).send().await.unwrap()).await.1
    }

    pub async fn post(&self, path: &str, body: &Value) -> (StatusCode, Value) {
        read(self.client.post(self.url(path)).json(body).send().await.unwrap()).await
    }

    pub async fn create_ship(&self) -> (StatusCode, Value) {
        let post =
            self.client.post(self.url("/v1/ships")).header("content-type", "application/yaml");
        read(post.header("idempotency-key", "ship").body(SHIP).send().await.unwrap()).await
    }

    /// Uploads trials that were simulated with the 4-DOF SR108, by manifest.
    pub async fn upload_trials(&self) -> (StatusCode, Value) {
        let manoeuvres =
            [json!({ "turn_deg": 20 }), json!({ "turn_deg": -15 }), zigzag(10), zigzag(-20)];
        let mut manifest = "kind: trials\nship: demo-ship\ntrials:\n".to_owned();
        let mut form = Form::new();
        for (index, manoeuvre) in manoeuvres.iter().enumerate() {
            manifest += &format!("  - {{ file: sailed/{index}.csv, manoeuvre: number {index} }}\n");
            let (_, run) = self
                .post("/v1/predictions", &json!({ "model": "sr108", "manoeuvre": manoeuvre }))
                .await;
            let part = Part::text(csv(&run["trajectory"])).file_name(format!("sailed/{index}.csv"));
            form = form.part(format!("file{index}"), part);
        }
        let form = form.text("manifest", manifest);
        read(self.client.post(self.url("/v1/trials")).multipart(form).send().await.unwrap()).await
    }

    /// Follows a job to its end by its events.
    pub async fn follow(&self, job: &str) -> Value {
        let events = self
            .client
            .get(self.url(&format!("/v1/jobs/{job}/events")))
            .send()
            .await
            .unwrap()
            .text()
            .await
            .unwrap();
        let last = events.lines().rfind(|line| line.starts_with("data:")).unwrap();
        serde_json::from_str(last.trim_start_matches("data:")).unwrap()
    }
}

pub(super) async fn read(response: Response) -> (StatusCode, Value) {
    let (status, text) = (response.status(), response.text().await.unwrap());
    (status, serde_json::from_str(&text).unwrap_or(Value::String(text)))
}

fn zigzag(angle: i64) -> Value {
    json!({ "zigzag": { "rudder_deg": angle, "switch_deg": angle.abs() } })
}

/// Every fifth sample.
pub(super) fn csv(track: &Value) -> String {
    let columns = [
        "t_s",
        "x_m",
        "y_m",
        "psi_rad",
        "u_m_s",
        "v_m_s",
        "r_rad_s",
        "phi_rad",
        "p_rad_s",
        "delta_rad",
        "n_rps",
    ];
    let rows = track["t_s"].as_array().unwrap().len();
    let row = |k: usize| columns.map(|column| track[column][k].to_string()).join(",");
    std::iter::once(columns.join(","))
        .chain((0..rows).step_by(5).map(row))
        .collect::<Vec<_>>()
        .join("\n")
}
