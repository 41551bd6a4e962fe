//! A prediction over a horizon: the same on the command line, of a file or a store, and over HTTP.

use reqwest::Method;
use serde_json::{Value, json};
use sistership_tests::binary;
use sistership_tests::server::TestServer;

const ORDERS: &str = "t_s,delta_deg,n_rps\n0,20,\n15,-20,\n";

fn wind() -> [&'static str; 4] {
    ["--wind-m-s", "12", "--wind-from-deg", "90"]
}

/// What `POST /v1/predictions` answers to the same orders in the same wind.
async fn over_http(server: &TestServer) -> Value {
    let rudder = 20f64.to_radians();
    let asked = json!({ "model": "mariner", "horizon": {
        "orders": [{ "t_s": 0.0, "delta_rad": rudder }, { "t_s": 15.0, "delta_rad": -rudder }],
        "duration_s": 60.0, "wind": { "speed_m_s": 12.0, "from_rad": 90f64.to_radians() },
    } });
    let (status, answer) = server.send(Method::POST, "/v1/predictions", &asked, &[]).await;
    assert_eq!(status, 200, "{answer}");
    answer
}

#[tokio::test(flavor = "multi_thread")]
async fn files_a_store_and_a_server_predict_the_same() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = |name: &str| folder.path().join(name).display().to_string();
    let (orders, out) = (path("orders.csv"), path("track.csv"));
    std::fs::write(&orders, ORDERS).expect("written");
    let server = TestServer::sqlite().await;
    let theirs = over_http(&server).await;
    let store = server.store_arguments();
    let predict = |model: &str, more: &[&str]| {
        let mut all = vec!["predict", "--model", model, "--orders", &orders, "--duration-s", "60"];
        all.extend(wind());
        all.extend(more);
        binary::json(&[all.as_slice(), &["--json"]].concat(), 0)
    };
    let store: Vec<&str> = store.iter().map(String::as_str).collect();
    let of_zoo = predict("mariner", &["--out", &out]);
    let stored = predict("mariner/1", &store);
    for ours in [&of_zoo, &stored] {
        assert_eq!(ours["trajectory"], theirs["trajectory"]);
        assert!(ours["band"].is_null() && ours["stopped"].is_null(), "{ours}");
    }
    let track = std::fs::read_to_string(&out).expect("a track");
    assert_eq!(track.lines().count(), 122);
    assert!(track.starts_with("t_s,x_m,y_m,psi_rad,u_m_s,v_m_s,r_rad_s,delta_rad,n_rps\n"));
}

#[test]
fn what_cannot_be_predicted_is_refused_with_its_place() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let orders = folder.path().join("orders.csv").display().to_string();
    std::fs::write(&orders, "t_s,delta_deg\n0,x\n5,1\n4,1\n").expect("written");
    let refused = |more: &[&str], status: i32, words: &[&str]| {
        let all = [&["predict", "--model", "mariner", "--duration-s", "60"], more].concat();
        let done = binary::run(&all);
        let error = String::from_utf8_lossy(&done.stderr).into_owned();
        assert_eq!(done.status.code(), Some(status), "{error}");
        words.iter().for_each(|word| assert!(error.contains(word), "{word}: {error}"));
    };
    refused(&["--orders", &orders], 1, &["orders.csv", "line 2, column 2", "line 4, t_s"]);
    refused(&["--draws", "50"], 1, &["horizon.draws", "posterior"]);
    refused(&["--wind-m-s", "5"], 2, &["--wind-from-deg"]);
    refused(&["--orders", &orders, "--rudder-deg", "5"], 2, &["--rudder-deg"]);
    let text = binary::run(&["predict", "--model", "mariner", "--duration-s", "60"]);
    assert!(String::from_utf8_lossy(&text.stdout).contains("heading deg"));
}
