//! Bad input of every kind, each answered by a message that a person can act on: one table, sent to
//! a real server.

use serde_json::{Value, json};
use sistership_tests::server::TestServer;

/// What is sent, and what the answer must say.
struct Case {
    what: &'static str,
    method: &'static str,
    path: &'static str,
    content_type: &'static str,
    body: String,
    status: u16,
    says: &'static [&'static str],
}

const YAML: &str = "application/yaml";
const JSON: &str = "application/json";
const CSV: &str = "text/csv";

fn case(
    what: &'static str,
    method: &'static str,
    path: &'static str,
    content_type: &'static str,
    body: impl Into<String>,
    status: u16,
    says: &'static [&'static str],
) -> Case {
    Case { what, method, path, content_type, body: body.into(), status, says }
}

/// A law that reads, with one thing replaced.
fn law(from: &str, to: &str) -> String {
    let good = "kind: law\nname: bad-law\ntitle: A law of the test\nsources: { test: { citation: \
        test } }\ninputs: { delta: { unit: rad } }\nparameters:\n  T: { unit: s, meaning: time \
        constant }\nvalues:\n  U: sqrt(u^2 + v^2)\nfactors: { u: u, v: v, r: r*lpp_m, delta: delta \
        }\naxes:\n  X: { scale: mass_kg/T, terms: [X_u] }\n  Y: { scale: mass_kg/T, terms: [Y_v] \
        }\n  N: { scale: mass_kg*lpp_m/T, terms: [N_r] }\nmass:\n  X: { X: mass_kg }\n  Y: { Y: \
        mass_kg }\n  N: { N: mass_kg*lpp_m^2 }\n";
    assert!(good.contains(from), "the good law holds {from}");
    good.replacen(from, to, 1)
}

/// A ship that reads, with one thing replaced.
fn ship(from: &str, to: &str) -> String {
    let good = "kind: vessel\nname: bad-ship\ntitle: A ship of the test\ncategory: \
        dry-cargo\nsources: { test: { citation: test } }\nconventions: { rudder_positive: \
        starboard_turn }\nparticulars:\n  source: test\n  values:\n    lpp_m: 100.0\n    beam_m: \
        16.0\n    draught_m: 6.0\n    displacement_m3: 6000.0\nmodels:\n  - name: own\n    law: \
        abkowitz\n    status: published\n    speed_m_s: 7.0\n    parameters: { source: test, \
        values: { m: 0.01, x_G: 0.0, I_z: 0.0006, X_udot: -0.0004, Y_vdot: -0.007, Y_rdot: 0.0, \
        N_vdot: 0.0, N_rdot: -0.0004 } }\n    coefficients: { source: test, values: { X_u: -0.002, \
        Y_v: -0.01, N_r: -0.002, N_delta: 0.001 } }\n";
    assert!(good.contains(from), "the good ship holds {from}");
    good.replacen(from, to, 1)
}

/// A trial of 40 samples of straight running, with one row replaced (row 1 is the header).
fn trial(row: usize, with: &str) -> String {
    let mut rows = vec!["t_s,u_m_s,v_m_s,r_rad_s,psi_rad,delta_rad".to_owned()];
    rows.extend((0..40).map(|k| {
        format!(
            "{:.1},{:.3},0.01,0.001,{:.4},0.02",
            0.5 * f64::from(k),
            7.0 + 0.001 * f64::from(k),
            0.0005 * f64::from(k)
        )
    }));
    rows[row - 1] = with.to_owned();
    rows.join("\n") + "\n"
}

fn bad_laws() -> Vec<Case> {
    let post = |what, from: &str, to: &str, says| {
        case(what, "POST", "/v1/laws", YAML, law(from, to), 422, says)
    };
    vec![
        post(
            "formula that stops",
            "sqrt(u^2 + v^2)",
            "sqrt(u^2 +",
            &["values.U", "cannot be read"],
        ),
        post("unknown name in a formula", "r*lpp_m", "r*length", &["factors.r", "`length`"]),
        post("units that do not add", "sqrt(u^2 + v^2)", "u + r", &["values.U", "m s^-1"]),
        post(
            "scale of the wrong dimension",
            "X: { X: mass_kg }",
            "X: { X: lpp_m }",
            &["mass.X.X", "kg"],
        ),
        post("coefficient in another spelling", "[X_u]", "[X_vu]", &["`X_uv`"]),
        post("coefficient on the wrong axis", "[Y_v]", "[N_v]", &["listed under Y"]),
        post("unknown function", "sqrt(u^2", "root(u^2", &["known function"]),
        post(
            "broken symmetry",
            "terms: [X_u] }",
            "terms: [X_u], rest: mass_kg*v/T }",
            &["symmetry", "axes.X.rest"],
        ),
        post("unknown unit", "unit: s,", "unit: fortnight,", &["fortnight", "known units"]),
        post("mass matrix without a row", "  N: { N: mass_kg*lpp_m^2 }\n", "", &["no row for N"]),
        post("unknown key", "title:", "titel:", &["titel"]),
        post("a name that is not one", "name: bad-law", "name: Bad Law", &["lower-case"]),
        case("YAML that is not YAML", "POST", "/v1/laws", YAML, "kind: [law", 422, &["line"]),
    ]
}

fn bad_ships() -> Vec<Case> {
    let post = |what, from: &str, to: &str, says| {
        case(what, "POST", "/v1/ships", YAML, ship(from, to), 422, says)
    };
    vec![
        post("a length in millimetres", "lpp_m: 100.0", "lpp_m: 100000.0", &["lpp_m", "unit"]),
        post("unknown particular", "beam_m: 16.0", "breadth_m: 16.0", &["breadth_m", "beam_m"]),
        post(
            "a number without source",
            "  source: test\n  values:\n    lpp_m",
            "  values:\n    lpp_m",
            &["source"],
        ),
        post(
            "a source that is not listed",
            "  source: test\n  values:",
            "  source: other\n  values:",
            &["`other`", "sources"],
        ),
        post("unknown law", "law: abkowitz", "law: abkowicz", &["abkowicz", "abkowitz"]),
        post(
            "coefficient the law does not spell",
            "N_delta: 0.001",
            "N_rudder: 0.001",
            &["N_rudder"],
        ),
        post("coefficient in another order", "N_delta: 0.001", "N_deltav: 0.001", &["`N_vdelta`"]),
        post("parameter without value", "N_rdot: -0.0004", "N_vdot: 0.0", &["N_"]),
        post("unknown parameter", "I_z: 0.0006", "I_zz: 0.0006", &["I_zz", "I_z"]),
        post("not a number", "lpp_m: 100.0", "lpp_m: .nan", &["lpp_m"]),
        post("text for a number", "beam_m: 16.0", "beam_m: wide", &["beam_m"]),
        post("unknown rudder sign", "starboard_turn", "right", &["right", "starboard_turn"]),
        post(
            "contradicting displacement",
            "displacement_m3: 6000.0",
            "displacement_m3: 6000.0\n    block_coefficient: 0.9",
            &["block_coefficient", "contradicts"],
        ),
        post(
            "steering gear without rate",
            "speed_m_s: 7.0",
            "speed_m_s: 7.0\n    steering: { rate_deg_s: 0.0 }",
            &["rate"],
        ),
        post("impossible approach speed", "speed_m_s: 7.0", "speed_m_s: -7.0", &["speed_m_s"]),
        post(
            "category that is not a name",
            "category: dry-cargo",
            "category: Dry Cargo",
            &["category"],
        ),
    ]
}

fn bad_trials() -> Vec<Case> {
    let path = "/v1/trials?ship=mariner&name=bad";
    let post = |what, body: String, says| case(what, "POST", path, CSV, body, 422, says);
    let header = |with: &str| trial(1, with);
    let row = |with: &str| trial(12, with);
    vec![
        post("time that stands still", row("4.5,7.0,0.01,0.001,0.005,0.02"), &["12", "t_s"]),
        post("time that runs back", row("1.0,7.0,0.01,0.001,0.005,0.02"), &["12", "t_s"]),
        post(
            "a cell that is not a number",
            row("5.0,fast,0.01,0.001,0.005,0.02"),
            &["12", "u_m_s", "fast"],
        ),
        post("an empty cell", row("5.0,,0.01,0.001,0.005,0.02"), &["12", "u_m_s"]),
        post("NaN", row("5.0,NaN,0.01,0.001,0.005,0.02"), &["12", "u_m_s"]),
        post("a row that is too short", row("5.0,7.0"), &["12"]),
        post("an impossible speed", row("5.0,700.0,0.01,0.001,0.005,0.02"), &["12", "u_m_s"]),
        post("no time column", header("instant,u_m_s,v_m_s,r_rad_s,psi_rad,delta_rad"), &["t_s"]),
        post(
            "two columns for one channel",
            header("t_s,u_m_s,u_kn,r_rad_s,psi_rad,delta_rad"),
            &["u_"],
        ),
        post("only a header", "t_s,u_m_s\n".into(), &["row"]),
        post("nothing at all", String::new(), &["empty"]),
        post("rudder in degrees declared as radians", degrees(), &["delta_rad", "deg"]),
        case(
            "a trial of no ship",
            "POST",
            "/v1/trials?ship=nobody&name=x",
            CSV,
            trial(2, "0.0,7.0,0.01,0.001,0.0,0.02"),
            422,
            &["nobody"],
        ),
    ]
}

/// A turn whose rudder column holds 20 for 20 degrees.
fn degrees() -> String {
    let row = |k: i32| {
        format!(
            "{:.1},7.0,0.01,0.01,{:.4},{}",
            0.5 * f64::from(k),
            0.005 * f64::from(k),
            if k < 10 { 0.0 } else { 20.0 }
        )
    };
    let rows: Vec<String> = (0..80).map(row).collect();
    format!("t_s,u_m_s,v_m_s,r_rad_s,psi_rad,delta_rad\n{}\n", rows.join("\n"))
}

fn bad_requests() -> Vec<Case> {
    let refine = |what, body: Value, status, says| {
        case(what, "POST", "/v1/refinements", JSON, body.to_string(), status, says)
    };
    let predict = |what, body: Value, status, says| {
        case(what, "POST", "/v1/predictions", JSON, body.to_string(), status, says)
    };
    vec![
        case(
            "JSON that stops",
            "POST",
            "/v1/refinements",
            JSON,
            "{\"ship\": ",
            400,
            &["ship", "line 1"],
        ),
        refine(
            "unknown field",
            json!({"ship": "mariner", "source": "auto", "trails": []}),
            422,
            &["trails"],
        ),
        refine("missing field", json!({"source": "auto"}), 422, &["ship"]),
        refine(
            "a ship that is not there",
            json!({"ship": "nobody", "source": "auto"}),
            422,
            &["nobody"],
        ),
        refine("no trials", json!({"ship": "pcc", "source": "auto"}), 422, &["trial"]),
        refine(
            "unknown setting",
            json!({"ship": "mariner", "source": "auto", "settings": {"lamda_count": 5}}),
            422,
            &["lamda_count"],
        ),
        refine(
            "setting out of range",
            json!({"ship": "mariner", "source": "auto", "settings": {"lambda_count": 1}}),
            422,
            &["lambda_count"],
        ),
        predict(
            "a manoeuvre that is none",
            json!({"model": "mariner", "manoeuvre": {"spiral": 1}}),
            422,
            &["spiral"],
        ),
        predict(
            "speed below zero",
            json!({"model": "mariner", "manoeuvre": {"turn_deg": 35.0, "speed_m_s": -1.0}}),
            422,
            &["speed_m_s"],
        ),
        predict(
            "a model that is not there",
            json!({"model": "nobody", "manoeuvre": {"turn_deg": 35.0}}),
            422,
            &["nobody"],
        ),
        predict(
            "text for a number",
            json!({"model": "mariner", "manoeuvre": {"turn_deg": "hard"}}),
            422,
            &["turn_deg"],
        ),
        case("a limit that is no number", "GET", "/v1/ships?limit=many", JSON, "", 400, &["limit"]),
        case(
            "an unknown vector",
            "GET",
            "/v1/ships/mariner/similar?vector=mine",
            JSON,
            "",
            400,
            &["mine", "mei-2019"],
        ),
        case(
            "a version that is not there",
            "GET",
            "/v1/models/mariner/versions/99",
            JSON,
            "",
            404,
            &["99"],
        ),
        case("a path that is not there", "GET", "/v1/shipz", JSON, "", 404, &["/v1/shipz"]),
        case("a method that is not there", "DELETE", "/v1/ships", JSON, "", 405, &["Allow"]),
        case(
            "a body of the wrong kind",
            "POST",
            "/v1/refinements",
            "image/png",
            "x",
            415,
            &["application/json"],
        ),
        case(
            "an alias without a condition",
            "PUT",
            "/v1/models/mariner/aliases/champion",
            JSON,
            json!({"version": 1, "reason": "test"}).to_string(),
            428,
            &["If-Match"],
        ),
    ]
}

#[tokio::test]
async fn every_bad_input_is_answered_so_that_a_person_can_act() {
    let server = TestServer::sqlite().await;
    let cases: Vec<Case> =
        [bad_laws(), bad_ships(), bad_trials(), bad_requests()].into_iter().flatten().collect();
    assert!(cases.len() >= 40, "{}", cases.len());
    let mut wrong = Vec::new();
    for case in &cases {
        let method = case.method.parse().expect("a method");
        let request = server
            .request(method, case.path)
            .header("content-type", case.content_type)
            .body(case.body.clone());
        let response = request.send().await.expect("an answer");
        let (status, kind) =
            (response.status().as_u16(), response.headers().get("content-type").cloned());
        let body = response.text().await.expect("a body");
        let problem = kind.is_some_and(|kind| {
            kind.to_str().is_ok_and(|kind| kind.starts_with("application/problem+json"))
        });
        let missing: Vec<&&str> = case.says.iter().filter(|part| !body.contains(**part)).collect();
        println!("{}: {status} {body}", case.what);
        if status != case.status || !problem || !missing.is_empty() {
            wrong.push(format!(
                "{}: wanted {} saying {:?}, got {status} (problem: {problem}): {body}",
                case.what, case.status, case.says
            ));
        }
    }
    assert!(wrong.is_empty(), "{} of {} cases:\n{}", wrong.len(), cases.len(), wrong.join("\n"));
    let ships: Value = server.get("/v1/ships/bad-ship").await;
    assert_eq!(ships["status"], 404, "a refused ship leaves nothing behind");
}
