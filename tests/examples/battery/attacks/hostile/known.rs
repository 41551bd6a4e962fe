//! Requests that once did harm, with the answers that are right.

use std::net::SocketAddr;

use super::raw::Raw;
use crate::documents;

/// A request and the statuses that are right for it.
pub struct Known {
    /// What it is.
    pub what: &'static str,
    /// The request.
    pub raw: Raw,
    /// What may be answered.
    pub statuses: &'static [u16],
}

const REFUSED: &[u16] = &[400, 413, 422];
/// What is refused, or taken and borne: the attack on workers sees to the latter.
const BORNE: &[u16] = &[201, 400, 413, 422];
const MISDIRECTED: &[u16] = &[400, 403, 421];
const CSV: &str = "/v1/trials/check?ship=target&name=known.csv";

/// All of them.
pub fn all(address: SocketAddr) -> Vec<Known> {
    // Under another name each: a law never changes, and one of them may be there.
    let law = |what: &'static str, formula: String, statuses| {
        let text = documents::law_of(&format!("known-{}", formula.len()), &formula);
        Known {
            what,
            raw: Raw::new("POST", "/v1/laws", address, "application/yaml", text),
            statuses,
        }
    };
    let nested = |open: &str, inner: &str, close: &str, depth: usize| {
        open.repeat(depth) + inner + &close.repeat(depth)
    };
    let mut known = vec![
        law("a formula of 1,609 brackets", nested("(", "u", ")", 1609), BORNE),
        law("a formula of 10,000 brackets", nested("(", "u", ")", 10_000), REFUSED),
        law("a formula of 10,000 signs", nested("-", "u", "", 10_000), REFUSED),
        law("a formula of 10,000 roots", nested("sqrt(", "u", ")", 10_000), REFUSED),
        law("a formula of 10,000 powers", nested("", "u", "^2", 10_000), REFUSED),
        law("a formula of 3,355 terms", format!("u{}", " + u".repeat(3354)), BORNE),
        law("a formula of 3,320 terms", format!("u{}", " + u".repeat(3319)), BORNE),
        law("a formula of 100,000 factors", format!("u{}", "*u".repeat(99_999)), REFUSED),
    ];
    known.extend(vessels(address));
    known.extend(deep_documents(address));
    known.extend(tables(address));
    known.extend(headers(address));
    known
}

fn vessels(address: SocketAddr) -> Vec<Known> {
    let ship = |what, value: String| {
        let text = documents::ship("known").replace("lpp_m: 175.0", &format!("lpp_m: \"{value}\""));
        Known {
            what,
            raw: Raw::new("POST", "/v1/ships", address, "application/yaml", text),
            statuses: REFUSED,
        }
    };
    vec![
        ship("a length of 10,000 brackets", "(".repeat(10_000) + "1" + &")".repeat(10_000)),
        ship("a length of 10,000 signs", "-".repeat(10_000) + "1"),
    ]
}

/// What takes a parser long: it must be refused in time.
fn deep_documents(address: SocketAddr) -> Vec<Known> {
    let post = |what, path, media, body: String| {
        let raw = Raw::new("POST", path, address, media, body);
        Known { what, raw, statuses: REFUSED }
    };
    let bomb: String = (1..25).fold("a0: &a0 [x, x]\n".to_owned(), |text, level| {
        text + &format!("a{level}: &a{level} [*a{0}, *a{0}]\n", level - 1)
    });
    vec![
        post(
            "YAML of 50,000 maps in each other",
            "/v1/laws",
            "application/yaml",
            "{a: ".repeat(50_000),
        ),
        post(
            "YAML of 50,000 maps in a ship",
            "/v1/ships",
            "application/yaml",
            "{a: ".repeat(50_000),
        ),
        post(
            "YAML of 50,000 lists in each other",
            "/v1/laws",
            "application/yaml",
            "[".repeat(50_000),
        ),
        post(
            "YAML of 50,000 lists by dashes",
            "/v1/laws",
            "application/yaml",
            "- ".repeat(50_000) + "a",
        ),
        post("YAML whose aliases multiply", "/v1/laws", "application/yaml", bomb),
        post("JSON of 100,000 lists", "/v1/predictions", "application/json", "[".repeat(100_000)),
    ]
}

/// Tables with rows that are shorter or longer than their heading.
fn tables(address: SocketAddr) -> Vec<Known> {
    let check = |what, body: &str, statuses| Known {
        what,
        raw: Raw::new("POST", CSV, address, "text/csv", body),
        statuses,
    };
    // A check answers 200 with what is wrong; an upload refuses.
    let upload = |what, body: &str| {
        let path = "/v1/trials?ship=target&name=known.csv&diagnose=false";
        Known { what, raw: Raw::new("POST", path, address, "text/csv", body), statuses: REFUSED }
    };
    let comma = "t_s,x_m,y_m,u_m_s,v_m_s,r_rad_s\n0.5,0,0,7,01,0,0\n1.0,3,0,7,02,1,0\n1.5,7,0,7,03,2,0\n2.0,9,0,7,04,3,0\n";
    vec![
        upload("rows with a decimal comma", comma),
        upload("a row with a cell too many", "t_s,u_m_s\n0,1\n1,1\n2,1,9\n3,1\n"),
        upload("a row with a cell too few", "t_s,u_m_s,v_m_s\n0,1,0\n1,1,0\n2,1\n3,1,0\n"),
        upload("a value that is no number", "t_s,u_m_s\n0,1\n1,NaN\n2,inf\n3,1e999\n"),
        check("an empty table", "", &[200, 400, 422]),
    ]
}

/// Requests of a page of another site, and of no site at all.
fn headers(address: SocketAddr) -> Vec<Known> {
    let law = |name: &str| {
        Raw::new("POST", "/v1/laws", address, "application/yaml", documents::law(name))
    };
    let without_host = |mut raw: Raw| {
        raw.head = String::from_utf8_lossy(&raw.head)
            .replace(&format!("host: {address}\r\n"), "")
            .into_bytes();
        raw
    };
    let known = |what, raw| Known { what, raw, statuses: MISDIRECTED };
    vec![
        known("two Host headers", law("known-1").header("host", "elsewhere.example")),
        known("no Host header", without_host(law("known-2"))),
        known("the Host of another", {
            let mut raw = law("known-3");
            raw.head = String::from_utf8_lossy(&raw.head)
                .replace(&address.to_string(), "elsewhere.example")
                .into_bytes();
            raw
        }),
        known(
            "Sec-Fetch-Site: cross-site without Origin",
            law("known-4").header("sec-fetch-site", "cross-site"),
        ),
        known(
            "the Origin https of the same host",
            law("known-5").header("origin", format!("https://{address}")),
        ),
        known("the Origin of another", law("known-6").header("origin", "http://elsewhere.example")),
    ]
}
