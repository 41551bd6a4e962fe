//! A browser, driven by the WebDriver protocol (W3C 2018): Debian's chromium by its chromedriver.
//! The few commands that a journey needs are plain requests; a library would bring nothing else.

use std::io::Write;
use std::net::{TcpListener, TcpStream};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use reqwest::{Client, Method};
use serde_json::{Value, json};

/// What the protocol calls an element.
const ELEMENT: &str = "element-6066-11e4-a52e-4f735466cecf";
/// How long something on a page is waited for.
const PATIENCE: Duration = Duration::from_secs(240);

/// A browser with one window; both are gone when this is dropped.
pub struct Browser {
    driver: Child,
    session: String,
    client: Client,
    /// Where pictures of pages are put.
    pictures: Option<PathBuf>,
}

impl Browser {
    /// Starts one; none, said plainly, where it is not installed.
    pub async fn start() -> Option<Self> {
        let port = TcpListener::bind("127.0.0.1:0").ok()?.local_addr().ok()?.port();
        let mut driver = Command::new("chromedriver");
        driver.arg(format!("--port={port}")).stdout(Stdio::null()).stderr(Stdio::null());
        let (Ok(driver), true) = (driver.spawn(), Path::new("/usr/bin/chromium").is_file()) else {
            println!("skipped: chromium and chromedriver are not installed");
            return None;
        };
        sistership_store::provide_cryptography();
        let client = Client::new();
        let pictures = std::env::var_os("SISTERSHIP_PICTURES").map(PathBuf::from);
        let url = format!("http://127.0.0.1:{port}");
        let mut browser = Self { driver, session: url, client, pictures };
        browser.until_ready().await;
        let options = json!({ "binary": "/usr/bin/chromium", "args": [
            "--headless=new", "--no-sandbox", "--disable-gpu", "--no-first-run",
            "--disable-background-networking", "--disable-component-update", "--disable-sync"] });
        let asked = json!({ "capabilities": { "alwaysMatch": { "goog:chromeOptions": options } } });
        let made = browser.told(Method::POST, "/session", &asked).await;
        browser.session += &format!("/session/{}", made["sessionId"].as_str().expect("a session"));
        Some(browser)
    }

    async fn until_ready(&self) {
        for _ in 0..200 {
            if self.client.get(format!("{}/status", self.session)).send().await.is_ok() {
                return;
            }
            tokio::time::sleep(Duration::from_millis(50)).await;
        }
        panic!("chromedriver does not answer");
    }

    async fn asked(&self, method: Method, path: &str, body: &Value) -> Result<Value, Value> {
        let request = self.client.request(method.clone(), format!("{}{path}", self.session));
        let request = if method == Method::POST { request.json(body) } else { request };
        let answer: Value = request.send().await.expect("an answer").json().await.expect("JSON");
        match answer["value"].get("error") {
            Some(_) => Err(answer["value"].clone()),
            None => Ok(answer["value"].clone()),
        }
    }

    async fn told(&self, method: Method, path: &str, body: &Value) -> Value {
        let done = self.asked(method, path, body).await;
        done.unwrap_or_else(|error| panic!("{path}: {error}"))
    }

    /// Loads a page.
    pub async fn go(&self, url: &str) {
        self.told(Method::POST, "/url", &json!({ "url": url })).await;
    }

    /// The path of the page that is shown.
    pub async fn path(&self) -> String {
        let url = self.told(Method::GET, "/url", &Value::Null).await;
        let url = url.as_str().expect("text").to_owned();
        url.splitn(4, '/').nth(3).map_or_else(String::new, |path| format!("/{path}"))
    }

    /// The text of the page as a person reads it.
    pub async fn text(&self) -> String {
        let text = self.run("return document.body ? document.body.innerText : ''").await;
        text.as_str().unwrap_or_default().to_owned()
    }

    /// Runs a script on the page.
    pub async fn run(&self, script: &str) -> Value {
        self.asked_to_run(script).await.unwrap_or_else(|error| panic!("{script}: {error}"))
    }

    /// The same, where the page may be gone before it is run.
    async fn asked_to_run(&self, script: &str) -> Result<Value, Value> {
        let asked = json!({ "script": script, "args": [] });
        self.asked(Method::POST, "/execute/sync", &asked).await
    }

    /// Runs a script that calls back with what it has found.
    pub async fn run_until_called_back(&self, script: &str) -> Value {
        self.told(Method::POST, "/execute/async", &json!({ "script": script, "args": [] })).await
    }

    async fn element(&self, css: &str) -> String {
        let asked = json!({ "using": "css selector", "value": css });
        let until = Instant::now() + PATIENCE;
        loop {
            match self.asked(Method::POST, "/element", &asked).await {
                Ok(found) => return found[ELEMENT].as_str().expect("an id").to_owned(),
                Err(error) if Instant::now() > until => panic!("{css}: {error}"),
                Err(_) => tokio::time::sleep(Duration::from_millis(100)).await,
            }
        }
    }

    /// Presses something.
    pub async fn click(&self, css: &str) {
        let id = self.element(css).await;
        self.told(Method::POST, &format!("/element/{id}/click"), &json!({})).await;
    }

    /// Presses something that leads to another page, and waits until that page stands: a page asked
    /// for before an answer to this arrives would otherwise be replaced by that answer.
    pub async fn leave_by(&self, css: &str) {
        self.run("window.left = false").await;
        self.click(css).await;
        let until = Instant::now() + PATIENCE;
        let stands = "return window.left === undefined && document.readyState === 'complete'";
        while self.asked_to_run(stands).await.ok() != Some(json!(true)) {
            assert!(Instant::now() < until, "{css} leads nowhere: {}", self.text().await);
            tokio::time::sleep(Duration::from_millis(50)).await;
        }
    }

    /// Moves the pointer to places of an element, as shares of its width and height; with `drags`
    /// the button is held from the first place to the last.
    pub async fn point(&self, css: &str, places: &[(f64, f64)], drags: bool) {
        let corner = self
            .run(&format!(
                "const one = document.querySelector(\"{css}\"); one.scrollIntoView({{ block: 'center' }});
                const box = one.getBoundingClientRect(); return [box.left, box.top, box.width, box.height]"
            ))
            .await;
        let number = |index: usize| corner[index].as_f64().expect("a number");
        let mut actions: Vec<Value> = Vec::new();
        for (x, y) in places {
            let (x, y) = (number(0) + x * number(2), number(1) + y * number(3));
            actions.push(json!({ "type": "pointerMove", "x": x.round(), "y": y.round() }));
        }
        if drags {
            actions.insert(1, json!({ "type": "pointerDown", "button": 0 }));
            actions.push(json!({ "type": "pointerUp", "button": 0 }));
        }
        let pointer = json!({ "type": "pointer", "id": "mouse",
            "parameters": { "pointerType": "mouse" }, "actions": actions });
        self.told(Method::POST, "/actions", &json!({ "actions": [pointer] })).await;
    }

    /// Types into a field, in the place of what it holds.
    pub async fn fill(&self, css: &str, text: &str) {
        let id = self.element(css).await;
        self.told(Method::POST, &format!("/element/{id}/clear"), &json!({})).await;
        self.keys(css, text).await;
    }

    /// Types, or chooses files by their paths, one a line.
    pub async fn keys(&self, css: &str, text: &str) {
        let id = self.element(css).await;
        self.told(Method::POST, &format!("/element/{id}/value"), &json!({ "text": text })).await;
    }

    /// Presses keys where the focus is.
    pub async fn press(&self, keys: &str) {
        let mut actions: Vec<Value> = Vec::new();
        for key in keys.chars().map(String::from) {
            actions.push(json!({ "type": "keyDown", "value": key }));
            actions.push(json!({ "type": "keyUp", "value": key }));
        }
        let keyboard = json!({ "type": "key", "id": "keyboard", "actions": actions });
        self.told(Method::POST, "/actions", &json!({ "actions": [keyboard] })).await;
    }

    /// Presses the Tab key until something has the focus.
    pub async fn tab_to(&self, css: &str) {
        let there = format!("return document.activeElement?.matches(\"{css}\") ?? false");
        for _ in 0..200 {
            if self.run(&there).await == json!(true) {
                return;
            }
            self.press("\u{e004}").await;
        }
        panic!("the Tab key does not reach {css}");
    }

    /// Chooses from a list what has a value.
    pub async fn choose(&self, css: &str, value: &str) {
        self.click(&format!("{css} option[value='{value}']")).await;
    }

    /// Waits until the page says something.
    pub async fn until(&self, words: &str) -> String {
        let until = Instant::now() + PATIENCE;
        loop {
            let text = self.text().await;
            if text.contains(words) {
                return text;
            }
            assert!(Instant::now() < until, "`{words}` does not come: {text}");
            tokio::time::sleep(Duration::from_millis(200)).await;
        }
    }

    /// Shows the page at three widths: it must not be wider than the window. Keeps pictures where
    /// SISTERSHIP_PICTURES names a folder.
    pub async fn looked_at(&self, name: &str) {
        for width in [1400, 800, 390] {
            self.told(Method::POST, "/window/rect", &json!({ "width": width, "height": 900 }))
                .await;
            let beyond = self
                .run(
                    "return document.documentElement.scrollWidth - \
                    document.documentElement.clientWidth",
                )
                .await;
            assert!(beyond.as_i64() <= Some(0), "{name} is {beyond} px too wide at {width} px");
            if let Some(folder) = &self.pictures {
                let height = self.run("return document.documentElement.scrollHeight").await;
                let size = json!({ "width": width,
                    "height": height.as_i64().unwrap_or(900).clamp(900, 6000) + 140 });
                self.told(Method::POST, "/window/rect", &size).await;
                let picture = self.told(Method::GET, "/screenshot", &Value::Null).await;
                let path = folder.join(format!("{name}-{width}.png.base64"));
                std::fs::write(path, picture.as_str().expect("base64")).expect("a picture");
            }
        }
        self.told(Method::POST, "/window/rect", &json!({ "width": 1400, "height": 900 })).await;
    }

    /// Nothing that axe-core calls serious or critical may be on the page. Where it is not
    /// installed (`npm ci` in `tests/npm`) this is not looked at.
    pub async fn accessible(&self, name: &str) {
        let place = concat!(env!("CARGO_MANIFEST_DIR"), "/npm/node_modules/axe-core/axe.min.js");
        let Ok(axe) = std::fs::read_to_string(place) else {
            println!("skipped: axe-core is not installed in tests/npm, {name} is not looked at");
            return;
        };
        self.run(&axe).await;
        let found = self
            .run_until_called_back(
                "const back = arguments[arguments.length - 1];
                axe.run().then(result => back(result.violations
                    .filter(one => ['serious', 'critical'].includes(one.impact))
                    .map(one => one.id + ': ' + one.nodes.map(node => node.target.join(' ')).join(', '))));",
            )
            .await;
        assert_eq!(found, json!([]), "{name}");
    }
}

impl Drop for Browser {
    fn drop(&mut self) {
        // The session is what ends the browser: a driver that is killed leaves it running.
        self.end_session();
        let _ = Command::new("kill").args(["-TERM", &self.driver.id().to_string()]).status();
        let _ = self.driver.wait();
    }
}

impl Browser {
    /// Ends the session without the runtime, which a panic may have left.
    fn end_session(&self) -> Option<()> {
        let (place, path) = self.session.strip_prefix("http://")?.split_once('/')?;
        let mut stream = TcpStream::connect(place).ok()?;
        stream.set_read_timeout(Some(Duration::from_secs(10))).ok()?;
        let asked =
            format!("DELETE /{path} HTTP/1.1\r\nHost: {place}\r\nConnection: close\r\n\r\n");
        stream.write_all(asked.as_bytes()).ok()?;
        std::io::copy(&mut stream, &mut std::io::sink()).ok().map(drop)
    }
}
