//! A person's journey by pages and forms alone: odd files are uploaded with a corrected mapping,
//! the champion turns out not to hold, another is promoted and rolled back. Every page has what a
//! person must find on it, a policy that allows nothing from elsewhere, and hostile names as text.

use reqwest::multipart::{Form, Part};
use reqwest::{Method, RequestBuilder, Response};
use sistership_model::Trial;
use sistership_tests::server::TestServer;

use super::lacking::{EFFECT, NAME, ship, trials};
use super::sea_trials::csv;

/// What must be shown and never be obeyed.
const HOSTILE: &str = "<script>alert(1)</script>";
const SHOWN: &str = "&#60;script&#62;alert(1)&#60;/script&#62;";

/// A page that is there, with what each must have.
async fn page(server: &TestServer, path: &str) -> String {
    let asked = server.request(Method::GET, path).header("accept", "text/html");
    let response = asked.send().await.expect("an answer");
    assert_eq!(response.status(), 200, "{path}");
    read(response, path).await
}

async fn read(response: Response, path: &str) -> String {
    let policy = response.headers()["content-security-policy"].to_str().expect("text").to_owned();
    for part in
        ["default-src 'none'", "script-src 'sha256-", "style-src 'sha256-", "base-uri 'none'"]
    {
        assert!(policy.contains(part), "{path}: {policy}");
    }
    assert!(!policy.contains("unsafe"), "{path}: {policy}");
    let text = response.text().await.expect("a page");
    for part in ["<a class=\"skip\"", "aria-label=\"Main\"", "href=\"/zoo\"", "<html lang=\"en\">"]
    {
        assert!(text.contains(part), "{path} lacks {part}");
    }
    assert!(!text.contains(HOSTILE), "{path} lets a name in as it is");
    assert!(
        !text.contains(" style=") && !text.contains(" onclick="),
        "{path}: the policy forbids it"
    );
    let plain = without_plots(&text);
    assert!(plain.len() < 100_000, "{path} has {} bytes beside its plots", plain.len());
    text
}

fn without_plots(text: &str) -> String {
    let without = |text: &str, from: &str, to: &str| -> String {
        let parts = text.split(from);
        parts.map(|part| part.rsplit(to).next().unwrap_or(part)).collect()
    };
    // The values of the drawn lines are a part of the plots.
    without(&without(text, "<svg", "</svg>"), "<script type=\"application/json\"", "</script>")
}

/// The token that the forms of a page send.
fn token(page: &str) -> String {
    let (_, rest) = page.split_once("name=\"form_token\" value=\"").expect("a form");
    rest.split('"').next().expect("a value").to_owned()
}

/// A form as a browser writes it (application/x-www-form-urlencoded).
fn encoded<N: AsRef<str>, T: AsRef<str>>(fields: &[(N, T)]) -> String {
    let quoted = |text: &str| -> String {
        let each = text.bytes().map(|byte| match byte.is_ascii_alphanumeric() {
            true => char::from(byte).to_string(),
            false => format!("%{byte:02X}"),
        });
        each.collect()
    };
    let pair =
        |(name, text): &(N, T)| format!("{}={}", quoted(name.as_ref()), quoted(text.as_ref()));
    fields.iter().map(pair).collect::<Vec<_>>().join("&")
}

/// A form, ready to be sent.
fn form<N: AsRef<str>, T: AsRef<str>>(
    server: &TestServer,
    to: &str,
    fields: &[(N, T)],
) -> RequestBuilder {
    let request = server.request(Method::POST, to).header("accept", "text/html");
    let kind = "application/x-www-form-urlencoded";
    request.header("content-type", kind).body(encoded(fields))
}

/// Sends a form of a page as a browser does, and gives the page that it leads to.
async fn send(server: &TestServer, from: &str, to: &str, fields: &[(&str, &str)]) -> Response {
    let token = token(&page(server, from).await);
    let all: Vec<(&str, &str)> =
        fields.iter().copied().chain([("form_token", token.as_str())]).collect();
    form(server, to, &all).send().await.expect("an answer")
}

async fn create(server: &TestServer) {
    let hostile = ship().replacen("title: ", &format!("title: '{HOSTILE}' #"), 1);
    let request = server.request(Method::POST, "/v1/ships");
    let request = request.header("content-type", "application/yaml").body(hostile);
    assert_eq!(request.send().await.expect("an answer").status(), 201);
}

/// The files of trials whose heading stands under a name that says nothing, in degrees.
fn odd_files(trials: &[Trial]) -> Vec<Part> {
    let odd = |trial: &Trial| {
        let text = String::from_utf8(csv(trial)).expect("text");
        let (header, rows) = text.split_once('\n').expect("rows");
        let place = header.split(',').position(|name| name == "psi_rad").expect("a heading");
        let row = |row: &str| {
            let degrees =
                |cell: &str| cell.parse::<f64>().expect("a number").to_degrees().to_string();
            let cells = row
                .split(',')
                .enumerate()
                .map(|(at, cell)| if at == place { degrees(cell) } else { cell.to_owned() });
            cells.collect::<Vec<_>>().join(",")
        };
        let rows: Vec<String> = rows.lines().map(row).collect();
        let header = header.replace("psi_rad", "kompass");
        let bytes = format!("{header}\n{}\n", rows.join("\n")).into_bytes();
        Part::bytes(bytes).file_name(trial.name.clone())
    };
    trials.iter().map(odd).collect()
}

/// The value of the field `name` that belongs to a column, by the label of its list.
fn key_of(mapping: &str, column: &str) -> String {
    let label = format!("\" aria-label=\"Channel of {column}\"");
    let (before, _) = mapping.split_once(&label).expect("the column");
    before.rsplit("name=\"channel.").next().expect("a key").to_owned()
}

/// Every field of the form as the page shows it: what is chosen, written and ticked.
fn fields(mapping: &str) -> Vec<(String, String)> {
    let mut all = Vec::new();
    for part in mapping.split("<select ").skip(1) {
        let body = part.split("</select>").next().unwrap_or_default();
        let chosen = body.split("<option").find(|option| option.contains(" selected>"));
        let chosen = chosen.or_else(|| body.split("<option").nth(1)).unwrap_or_default();
        let text = chosen.split('>').nth(1).and_then(|text| text.split('<').next());
        all.push((named(body), attribute(chosen, "value").or(text).unwrap_or_default().to_owned()));
    }
    for part in mapping.split("<input ").skip(1) {
        let body = part.split('>').next().unwrap_or_default();
        if body.contains("checkbox") && !body.contains(" checked") {
            continue;
        }
        all.push((named(body), attribute(body, "value").unwrap_or("on").to_owned()));
    }
    all
}

fn named(tag: &str) -> String {
    attribute(tag, "name").unwrap_or_default().to_owned()
}

fn attribute<'a>(tag: &'a str, name: &str) -> Option<&'a str> {
    tag.split_once(&format!("{name}=\""))?.1.split('"').next()
}

/// Files arrive, nothing is kept, the mapping is corrected, and the trials are kept; gives the page
/// of the diagnosis that follows.
async fn upload(server: &TestServer) -> String {
    let choose = format!("/ships/{NAME}/upload");
    let mut parts = Form::new().text("form_token", token(&page(server, &choose).await));
    for part in odd_files(&trials()) {
        parts = parts.part("file", part);
    }
    let sent =
        server.request(Method::POST, &choose).multipart(parts).send().await.expect("an answer");
    let at = sent.url().path().to_owned();
    let first = read(sent, &at).await;
    assert!(first.contains("yaw rate") && first.contains("heading ψ"), "found by its relations");
    let (key, mut all) = (key_of(&first, "kompass"), fields(&first));
    for (name, text) in &mut all {
        match name.as_str() {
            name if *name == format!("channel.{key}") => *text = "psi".to_owned(),
            name if *name == format!("unit.{key}") => *text = "deg".to_owned(),
            "manoeuvre.0" => *text = HOSTILE.to_owned(),
            _ if name.starts_with("derive_") => text.clear(),
            _ => {}
        }
    }
    all.push(("do".to_owned(), "look".to_owned()));
    let ask =
        async |all: &[(String, String)]| form(server, &at, all).send().await.expect("an answer");
    let looked = read(ask(&all).await, &at).await;
    assert!(looked.contains("All files can be read") && looked.contains("heading ψ"), "{looked}");
    let listed = server.get(&format!("/v1/trials?ship={NAME}")).await;
    assert_eq!(listed["items"].as_array().map(Vec::len), Some(0), "nothing is kept unasked");
    all.last_mut().expect("the button").1 = "keep".to_owned();
    let kept = ask(&all).await;
    assert_eq!(kept.status(), 200);
    let stored = read(kept, &at).await;
    assert!(stored.contains("stored") && stored.contains(">Refine<"), "{stored}");
    let job = stored.split_once("href=\"/jobs/").expect("the diagnosis").1;
    format!("/jobs/{}", job.split('"').next().unwrap_or_default())
}

async fn journey(server: TestServer) {
    create(&server).await;
    let job = upload(&server).await;
    let id = job.strip_prefix("/jobs/").expect("the page of the diagnosis").to_owned();
    assert!(page(&server, &job).await.contains("Diagnosis of"));
    server.finished(&id).await;
    let done = page(&server, &job).await;
    assert!(
        done.contains("succeeded") && done.contains(EFFECT) && done.contains("Report"),
        "{done}"
    );
    does_not_hold(&server).await;
    trial(&server).await;
    version(&server).await;
    others(&server).await;
    promoted(&server).await;
    refused(&server).await;
    stated(&server).await;
    administered(&server).await;
    in_a_browser(&server).await;
}

/// A browser shows the pages without a word on its console: the policy allows what they have, and
/// their script runs. Skipped, and said so, where Debian's chromium is not installed.
async fn in_a_browser(server: &TestServer) {
    if std::process::Command::new("chromium").arg("--version").output().is_err() {
        println!("skipped: no chromium is installed");
        return;
    }
    let paths = [
        "/".to_owned(),
        format!("/ships/{NAME}"),
        format!("/ships/{NAME}/versions/2"),
        format!("/playground?model={NAME}"),
        "/zoo/laws/mmg".to_owned(),
    ];
    for path in paths {
        let address = format!("{}{path}", server.url());
        let shown = tokio::task::spawn_blocking(move || browsed(&address)).await.expect("it ends");
        let (page, log) = shown;
        assert!(
            page.contains("aria-current=\"page\"") && page.contains("</html>"),
            "{path}: {log}"
        );
        assert!(!log.contains(":CONSOLE"), "{path}: {log}");
    }
}

/// What a browser has made of a page, and what it says.
fn browsed(address: &str) -> (String, String) {
    let folder = tempfile::tempdir().expect("a folder");
    let mut browser = std::process::Command::new("chromium");
    browser.args(["--headless", "--no-sandbox", "--disable-gpu", "--no-first-run"]);
    browser.args(["--disable-background-networking", "--disable-component-update"]);
    browser.args(["--disable-sync", "--enable-logging=stderr", "--dump-dom"]);
    browser.arg(format!("--user-data-dir={}", folder.path().display())).arg(address);
    let output = browser.output().expect("it starts");
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    (text(&output.stdout), text(&output.stderr))
}

async fn does_not_hold(server: &TestServer) {
    let at = format!("/ships/{NAME}");
    let ship = page(server, &at).await;
    for part in ["Its model does not hold", EFFECT, SHOWN, "Similar ships", "to scale", "Refine"] {
        assert!(ship.contains(part), "the ship's page lacks {part}");
    }
    // The order of the fleet follows within a second or so.
    for _ in 0..100 {
        let fleet = page(server, "/?standing=does-not-hold").await;
        if fleet.contains(&format!("href=\"{at}\"")) {
            assert!(fleet.contains(EFFECT) && !fleet.contains("href=\"/ships/kvlcc2\""));
            return;
        }
        tokio::time::sleep(std::time::Duration::from_millis(100)).await;
    }
    panic!("the fleet does not say that the ship's model does not hold");
}

async fn trial(server: &TestServer) {
    let listed = server.get(&format!("/v1/trials?ship={NAME}")).await;
    let id = listed["items"][0]["id"].as_str().expect("a trial");
    let trial = page(server, &format!("/trials/{id}")).await;
    for part in [SHOWN, "class=\"hull", "Errors of the champion", "Version 2", "psi"] {
        assert!(trial.contains(part), "the trial's page lacks {part}");
    }
}

async fn version(server: &TestServer) {
    let version = page(server, &format!("/ships/{NAME}/versions/2")).await;
    for part in [EFFECT, "MSC.137(76)", "N_delta", "Lineage", "lacking/1", "Make it champion"] {
        assert!(version.contains(part), "the version's page lacks {part}");
    }
    let both = page(server, &format!("/compare?v={NAME}/1&v={NAME}/2")).await;
    for part in ["lacking/1", "lacking/2", "tactical diameter", "N_delta", "class=\"line b\""] {
        assert!(both.contains(part), "the comparison lacks {part}");
    }
    assert!(page(server, "/compare?v=nobody").await.contains("there is no model `nobody`"));
}

/// Conditions that no instrument records are stated in forms, and stand in the acceptance summary.
async fn stated(server: &TestServer) {
    let summary = format!("/ships/{NAME}/versions/2/acceptance");
    let open = page(server, &summary).await;
    for part in ["not stated", "MSC.137(76)", "Checked by", "Trials used"] {
        assert!(open.contains(part), "the summary lacks {part}");
    }
    let at = format!("/ships/{NAME}/conditions");
    let shown = page(server, &format!("{at}?version=2")).await;
    let trials = fields(&shown).into_iter().filter(|(name, _)| name == "trial");
    let mut all: Vec<(String, String)> = trials.collect();
    let pair = |name: &str, text: &str| (name.to_owned(), text.to_owned());
    all.extend([pair("date", "2026-11-28"), pair("place", HOSTILE), pair("version", "2")]);
    all.extend([pair("draught_fore_m", "8"), pair("draught_aft_m", "9,5")]);
    all.push(pair("form_token", &token(&shown)));
    let sent = form(server, &at, &all).send().await.expect("an answer");
    assert_eq!(sent.url().path(), summary);
    let filled = read(sent, &summary).await;
    for part in ["2026-11-28", SHOWN, "1.50 m by the stern"] {
        assert!(filled.contains(part), "the summary lacks {part}");
    }
    let signed = [("role", "checked"), ("person", "Ann Smith")];
    let to = format!("/ships/{NAME}/versions/2/sign");
    let signed = read(send(server, &summary, &to, &signed).await, &to).await;
    assert!(signed.contains("Ann Smith"), "{signed}");
    let at = format!("/ships/{NAME}/particulars");
    let mut all = fields(&page(server, &at).await);
    all.retain(|(name, _)| name != "citation");
    all.iter_mut()
        .filter(|(name, _)| name == "gm_m")
        .for_each(|(_, text)| *text = "0.4".to_owned());
    let refused = form(server, &at, &all).send().await.expect("an answer");
    assert_eq!(refused.status(), 422, "a changed figure needs a source");
    all.push(pair("citation", "inclining test"));
    let ship = read(form(server, &at, &all).send().await.expect("an answer"), &at).await;
    assert!(ship.contains("Revision 2") && ship.contains("typed-in"), "{ship}");
}

/// Families and webhooks are made on pages, and the example is loaded.
async fn administered(server: &TestServer) {
    let family = [("name", "sisters"), ("title", "Sisters"), ("foundation", "kvlcc2/1")];
    let made = send(server, "/families", "/families", &family).await;
    assert_eq!(made.url().path(), "/families/sisters");
    let to = "/families/sisters/members";
    let grown = send(server, "/families/sisters", to, &[("members", NAME)]).await;
    assert!(read(grown, to).await.contains(&format!("href=\"/ships/{NAME}\"")));
    let webhook = [
        ("title", HOSTILE),
        ("url", "https://hooks.slack.com/services/a/b"),
        ("event", "champion.moved"),
    ];
    let made = read(send(server, "/webhooks", "/webhooks", &webhook).await, "/webhooks").await;
    assert!(made.contains("not shown again"), "{made}");
    let list = page(server, "/webhooks").await;
    assert!(list.contains("Slack") && list.contains("another version is in use"), "{list}");
    let end = list.split("action=\"").find(|part| part.contains("/end\"")).expect("a form");
    let end = end.split('"').next().unwrap_or_default().to_owned();
    assert!(read(send(server, "/webhooks", &end, &[]).await, &end).await.contains("ended"));
    let loaded = send(server, "/webhooks", "/example", &[]).await;
    assert_eq!(loaded.url().path(), "/ships/northern-star");
    let ship = read(loaded, "/ships/northern-star").await;
    assert!(ship.contains("turn-port-20.csv") && ship.contains("Refine its model"), "{ship}");
}

async fn others(server: &TestServer) {
    let deep = format!("/playground?model={NAME}&rudder=20&current=1&current_to=90&wind=10");
    let sailed = page(server, &deep).await;
    assert!(sailed.contains("Tactical diameter") && sailed.contains("<svg"), "{sailed}");
    let script = format!("/playground?model={NAME}&kind=script&script=0+0%0A60+{HOSTILE}");
    assert!(page(server, &script).await.contains("script: line 2"));
    for (path, part) in [
        ("/zoo", "abkowitz"),
        ("/zoo/laws/abkowitz", "<math>"),
        ("/zoo/effects/rudder-offset", "Sources"),
        ("/jobs", EFFECT),
        ("/families", "None yet"),
        ("/?sort=name&from=kv", "kvlcc2"),
        ("/?similar_to=kvlcc2", "Correlation"),
        ("/?particular=lpp_m&particular_min=300&sort=value", "kvlcc2"),
    ] {
        assert!(page(server, path).await.contains(part), "{path} lacks {part}");
    }
}

async fn promoted(server: &TestServer) {
    let (at, to) = (format!("/ships/{NAME}"), format!("/ships/{NAME}/champion"));
    let promote = [("version", "2"), ("revision", "1"), ("reason", "its rudder is off")];
    let ship = read(send(server, &at, &to, &promote).await, &to).await;
    assert!(ship.contains("Its model holds") && ship.contains("Roll back to version 1"), "{ship}");
    let stale = send(server, &at, &to, &promote).await;
    assert_eq!(stale.status(), 412, "the champion has moved since");
    assert!(read(stale, &to).await.contains("has changed"));
    let back = [("version", "1"), ("revision", "2"), ("reason", "rolled back")];
    let ship = read(send(server, &at, &to, &back).await, &to).await;
    assert!(ship.contains("Its model does not hold"), "{ship}");
    let tagged = send(server, &at, &format!("{at}/tag"), &[("tag", "own")]).await;
    assert!(read(tagged, &at).await.contains("Remove the tag own"));
    assert!(page(server, "/?tag=own&sort=name").await.contains(NAME));
}

/// Forms without the token, and forms of other web sites, do nothing.
async fn refused(server: &TestServer) {
    let to = format!("/ships/{NAME}/tag");
    let without = form(server, &to, &[("tag", "stolen")]);
    assert_eq!(without.send().await.expect("an answer").status(), 403);
    let token = token(&page(server, &format!("/ships/{NAME}")).await);
    let fields = [("tag", "stolen"), ("form_token", token.as_str())];
    let foreign = form(server, &to, &fields).header("origin", "http://evil.example");
    assert_eq!(foreign.send().await.expect("an answer").status(), 403);
    let files = Form::new().part("file", Part::bytes(&b"t_s\n0\n"[..]).file_name("a.csv"));
    let upload = server.request(Method::POST, &format!("/ships/{NAME}/upload")).multipart(files);
    assert_eq!(upload.send().await.expect("an answer").status(), 403);
    let ship = page(server, &format!("/ships/{NAME}")).await;
    assert!(!ship.contains("stolen"));
    let missing = server.request(Method::GET, "/ships/nobody").header("accept", "text/html");
    let missing = missing.send().await.expect("an answer");
    assert_eq!(missing.status(), 404);
    assert!(read(missing, "/ships/nobody").await.contains("Not found"));
}

#[tokio::test]
async fn by_pages_alone() {
    journey(TestServer::sqlite().await).await;
}
