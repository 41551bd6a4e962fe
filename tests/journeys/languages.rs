//! The pages in German and Norwegian: by the browser's wish, and by a person's choice.

use std::collections::BTreeSet;
use std::path::Path;

use reqwest::redirect::Policy;
use reqwest::{Client, Method, StatusCode};
use sistership_store::testing::TestDatabase;
use sistership_tests::server::TestServer;

/// Pages of a server with the published ships alone, each with a word in German and Norwegian.
const PAGES: [(&str, &str, &str); 20] = [
    ("/", "Eigene Flotte", "Egen flåte"),
    ("/?ships=library", "Validierungsfehler", "Valideringsfeil"),
    ("/new-ship", "Tiefgang", "Dypgang"),
    ("/ships/kcs", "Länge zwischen den Loten", "Lengde mellom perpendikulærene"),
    ("/ships/kcs/particulars", "Metazentrische Höhe", "Metasenterhøyde"),
    ("/ships/kcs/conditions", "Bedingungen der Versuche", "Forhold under prøvene"),
    ("/ships/kcs/upload", "Versuche von kcs hochladen", "Last opp prøver av kcs"),
    ("/ships/kcs/versions/1", "taktischer Drehkreisdurchmesser", "taktisk diameter"),
    ("/ships/kcs/versions/1/acceptance", "Abnahmeübersicht", "Godkjenningssammendrag"),
    ("/compare?v=kcs&v=mariner", "Drehkreise", "Svingesirkler"),
    ("/playground?model=kcs", "Ruderlage", "Rorvinkel"),
    ("/families", "Grundlage", "Grunnlag"),
    ("/zoo", "Modellstrukturen", "Modellstrukturer"),
    ("/zoo/laws/modular", "Bewegungsgleichungen", "Bevegelseslikninger"),
    ("/zoo/effects/wind", "fügt Kräfte hinzu", "legger til krefter"),
    ("/jobs", "Aufträge", "Jobber"),
    ("/users", "Dienstschlüssel", "Tjenestenøkler"),
    ("/webhooks", "Modelldrift", "Modelldrift"),
    ("/audit", "Alle Änderungen", "Alle endringer"),
    ("/ships/nowhere", "Nicht gefunden", "Ikke funnet"),
];

/// Keys of the messages, of which none may stand in a page.
fn keys() -> BTreeSet<String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../crates/service/pages/messages/en");
    let files = std::fs::read_dir(folder).expect("the catalogue").map(|file| file.expect("a file"));
    let texts = files.map(|file| std::fs::read_to_string(file.path()).expect("a catalogue"));
    let of = |text: String| -> Vec<String> {
        let keys = text.lines().filter_map(|line| Some(line.split_once(" = ")?.0.to_owned()));
        keys.filter(|key| !key.starts_with(' ')).collect()
    };
    texts.flat_map(of).collect()
}

/// Text of a page without styles and scripts.
fn body(page: &str) -> &str {
    let (_, body) = page.split_once("<body>").expect("a body");
    body.split("<script>").next().unwrap_or(body)
}

async fn get(server: &TestServer, path: &str, language: &str) -> (StatusCode, String) {
    let request = server.request(Method::GET, path).header("accept", "text/html");
    let response = request.header("accept-language", language).send().await.expect("an answer");
    assert_eq!(response.headers()["vary"], "Accept-Language, Cookie", "{path}");
    (response.status(), response.text().await.expect("a page"))
}

#[tokio::test(flavor = "multi_thread")]
async fn pages_speak_the_language_of_the_browser() {
    let server = TestServer::on(TestDatabase::new_sqlite(), &[]).await;
    let keys = keys();
    assert!(keys.len() > 400, "{} messages", keys.len());
    for (path, german, norwegian) in PAGES {
        for (accepted, code, word) in
            [("de-CH,de;q=0.9", "de", german), ("fr, nn;q=0.8, en;q=0.2", "nb", norwegian)]
        {
            let (_, page) = get(&server, path, accepted).await;
            assert!(page.contains(&format!("<html lang=\"{code}\">")), "{path} in {code}");
            assert!(page.contains(word), "{path} lacks `{word}`:\n{}", body(&page));
            let words = body(&page).split(|c: char| !c.is_ascii_alphanumeric() && c != '-');
            let raw: Vec<&str> =
                words.filter(|word| word.contains('-') && keys.contains(*word)).collect();
            assert!(raw.is_empty(), "{path} in {code} shows {raw:?}");
        }
    }
    // Decimal marks are for people; values of forms and of plots keep the point.
    let (_, page) = get(&server, "/ships/kcs/particulars", "de").await;
    assert!(page.contains("value=\"0.651\"") || page.contains("value=\"0.65"), "{}", body(&page));
    let (_, page) = get(&server, "/ships/kcs/versions/1", "de").await;
    assert!(page.contains("m/s (") && page.contains(",0 kn)"), "{}", body(&page));
}

#[tokio::test(flavor = "multi_thread")]
async fn a_chosen_language_is_kept() {
    let server = TestServer::on(TestDatabase::new_sqlite(), &[]).await;
    let (status, page) = get(&server, "/zoo", "en").await;
    assert_eq!(status, StatusCode::OK);
    let (_, rest) = page.split_once("name=\"form_token\" value=\"").expect("a form");
    let token = rest.split('"').next().expect("a value");
    let browser = Client::builder().redirect(Policy::none()).build().expect("a client");
    let choose = |code: &str| {
        let request = browser.post(format!("{}/language", server.url()));
        let request = request.header("accept", "text/html");
        let request = request.header("content-type", "application/x-www-form-urlencoded");
        let request = request.header("referer", format!("{}/families?after=x", server.url()));
        request.body(format!("form_token={token}&language={code}")).send()
    };
    let answer = choose("nb").await.expect("an answer");
    assert_eq!(answer.status(), StatusCode::SEE_OTHER);
    assert_eq!(answer.headers()["location"], "/families?after=x");
    let cookie = answer.headers()["set-cookie"].to_str().expect("text").to_owned();
    let (cookie, _) = cookie.split_once(';').expect("attributes");
    let request = server.request(Method::GET, "/jobs").header("accept-language", "de");
    let page = request.header("cookie", cookie).send().await.expect("an answer");
    let page = page.text().await.expect("a page");
    assert!(page.contains("<html lang=\"nb\">") && page.contains("<h1>Jobber</h1>"));
    let refused = choose("fr").await.expect("an answer");
    assert_eq!(refused.status(), StatusCode::UNPROCESSABLE_ENTITY);
    assert!(refused.text().await.expect("a page").contains("there is no language"));
}
