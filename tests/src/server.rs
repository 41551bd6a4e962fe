//! A real server process on a temporary folder, and a client of it.

use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::Duration;

use reqwest::{Client, Method, RequestBuilder, Response};
use serde_json::Value;
use sistership_store::testing::{TestDatabase, TestS3};

use crate::binary;

/// A server process; it is killed when this is dropped.
pub struct TestServer {
    process: Child,
    url: String,
    client: Client,
    database: TestDatabase,
    data: PathBuf,
    extra: Vec<String>,
    /// The bucket of its samples, where they are in one.
    bucket: Option<Bucket>,
}

/// A part of an S3-compatible server that holds the samples of one store.
#[derive(Debug, Clone)]
pub struct Bucket {
    /// What the command line is told of it.
    pub arguments: Vec<String>,
    /// What the environment is told of it.
    pub environment: Vec<(&'static str, &'static str)>,
}

impl Bucket {
    /// What is below a prefix.
    pub fn of(s3: &TestS3, prefix: &str) -> Self {
        let arguments = s3
            .store_options(prefix)
            .into_iter()
            .flat_map(|(flag, value)| [flag.to_owned(), value])
            .collect();
        Self { arguments, environment: s3.environment_credentials().to_vec() }
    }
}

impl TestServer {
    /// On a new SQLite database.
    pub async fn sqlite() -> Self {
        Self::on(TestDatabase::new_sqlite(), &[]).await
    }

    /// On a new PostgreSQL database; `None`, said plainly, where PostgreSQL is not installed.
    pub async fn postgres() -> Option<Self> {
        Some(Self::on(TestDatabase::new_postgres().await?, &[]).await)
    }

    /// On a database, with further arguments of `sistership serve`.
    pub async fn on(database: TestDatabase, extra: &[&str]) -> Self {
        let data = database.folder.path().join("data");
        let extra: Vec<String> = extra.iter().map(|&argument| argument.to_owned()).collect();
        let (process, url) =
            start(&database.url, &data, &extra, None, Stdio::inherit(), Some("warn"));
        let server = Self { process, url, client: client(), database, data, extra, bucket: None };
        server.until_ready().await;
        server
    }

    /// On a database, with its samples in a bucket.
    pub async fn with_bucket(database: TestDatabase, bucket: &Bucket) -> Self {
        let data = database.folder.path().join("data");
        let (process, url) =
            start(&database.url, &data, &[], Some(bucket), Stdio::inherit(), Some("warn"));
        let (extra, bucket) = (Vec::new(), Some(bucket.clone()));
        let server = Self { process, url, client: client(), database, data, extra, bucket };
        server.until_ready().await;
        server
    }

    /// The same with its log in a file, as its own configuration asks for it.
    ///
    /// # Panics
    /// Where it does not start.
    pub async fn logged(database: TestDatabase, extra: &[&str]) -> (Self, PathBuf) {
        let data = database.folder.path().join("data");
        let log = database.folder.path().join("log");
        let extra: Vec<String> = extra.iter().map(|&argument| argument.to_owned()).collect();
        let file = std::fs::File::create(&log).expect("a log");
        let (process, url) = start(&database.url, &data, &extra, None, file.into(), None);
        let server = Self { process, url, client: client(), database, data, extra, bucket: None };
        server.until_ready().await;
        (server, log)
    }

    /// Kills the process without warning, as the system would.
    ///
    /// # Panics
    /// Where it cannot be killed.
    pub fn kill(&mut self) {
        self.process.kill().expect("the server is killed");
        self.process.wait().expect("the server is gone");
    }

    /// Tells the process to stop, as a service manager does, and waits until it has.
    ///
    /// # Panics
    /// Where it cannot be told.
    pub fn terminate(&mut self) -> std::process::ExitStatus {
        let told = Command::new("kill").args(["-TERM", &self.process.id().to_string()]).status();
        assert!(told.expect("a signal is sent").success());
        self.process.wait().expect("the server ends")
    }

    /// Starts it again on the same database and folder.
    pub async fn restart(&mut self) {
        let bucket = self.bucket.as_ref();
        (self.process, self.url) = start(
            &self.database.url,
            &self.data,
            &self.extra,
            bucket,
            Stdio::inherit(),
            Some("warn"),
        );
        self.until_ready().await;
    }

    /// Its URL, without a slash at the end.
    pub fn url(&self) -> &str {
        &self.url
    }

    /// The most memory that the process has had resident, and what it has now, MB.
    pub fn memory_mb(&self) -> (u64, u64) {
        memory_mb(self.process.id())
    }

    /// Its address and port.
    pub fn address(&self) -> String {
        self.url.trim_start_matches("http://").to_owned()
    }

    /// Its database.
    pub fn database(&self) -> &TestDatabase {
        &self.database
    }

    /// Arguments that open its store from the command line.
    pub fn store_arguments(&self) -> [String; 4] {
        [
            "--database-url".into(),
            self.database.url.clone(),
            "--data-dir".into(),
            self.data.display().to_string(),
        ]
    }

    async fn until_ready(&self) {
        for _ in 0..100 {
            if self
                .client
                .get(format!("{}/readyz", self.url))
                .send()
                .await
                .is_ok_and(|response| response.status().is_success())
            {
                return;
            }
            tokio::time::sleep(Duration::from_millis(100)).await;
        }
        panic!("the server does not become ready");
    }

    /// A request to a path.
    pub fn request(&self, method: Method, path: &str) -> RequestBuilder {
        self.client.request(method, format!("{}{path}", self.url))
    }

    /// The JSON answer to a GET.
    ///
    /// # Panics
    /// Where there is none.
    pub async fn get(&self, path: &str) -> Value {
        json(self.request(Method::GET, path).send().await.expect("an answer")).await.1
    }

    /// Sends JSON; gives the status and the JSON answer.
    ///
    /// # Panics
    /// Where there is none.
    pub async fn send(
        &self,
        method: Method,
        path: &str,
        body: &Value,
        headers: &[(&str, &str)],
    ) -> (u16, Value) {
        let request = self.request(method, path).json(body);
        let request =
            headers.iter().fold(request, |request, (name, value)| request.header(*name, *value));
        json(request.send().await.expect("an answer")).await
    }

    /// Follows a job to its end and gives it.
    ///
    /// # Panics
    /// Where it takes more than ten minutes: on two busy cores a refinement takes two.
    pub async fn finished(&self, job: &str) -> Value {
        for _ in 0..3000 {
            let state = self.get(&format!("/v1/jobs/{job}")).await;
            if matches!(state["state"].as_str(), Some("succeeded" | "failed" | "cancelled")) {
                return state;
            }
            tokio::time::sleep(Duration::from_millis(200)).await;
        }
        panic!("job {job} does not end");
    }
}

impl Drop for TestServer {
    fn drop(&mut self) {
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

/// The most memory that a process has had resident, and what it has now, MB, as Linux counts it;
/// nothing where it has ended.
pub fn memory_mb(process: u32) -> (u64, u64) {
    let status = std::fs::read_to_string(format!("/proc/{process}/status")).unwrap_or_default();
    let of = |name: &str| {
        let line = status.lines().find_map(|line| line.strip_prefix(name)).unwrap_or_default();
        line.split_whitespace().next().and_then(|kib| kib.parse::<u64>().ok()).unwrap_or_default()
            / 1024
    };
    (of("VmHWM:"), of("VmRSS:"))
}

/// The status and the JSON of an answer; null for an answer without a body.
///
/// # Panics
/// Where the body breaks off.
pub async fn json(response: Response) -> (u16, Value) {
    let status = response.status().as_u16();
    let text = response.text().await.expect("a body");
    (status, serde_json::from_str(&text).unwrap_or(Value::Null))
}

/// Starts the program and reads its address from the line it prints when it listens.
fn start(
    database_url: &str,
    data: &Path,
    extra: &[String],
    bucket: Option<&Bucket>,
    log: Stdio,
    level: Option<&str>,
) -> (Child, String) {
    let mut command = Command::new(binary::path());
    if let Some(bucket) = bucket {
        command.envs(bucket.environment.iter().copied()).args(["serve"]).args(&bucket.arguments);
    } else {
        command.arg("serve");
    }
    if let Some(level) = level {
        command.env("SISTERSHIP_LOG", level);
    }
    if !extra.iter().any(|argument| argument == "--listen") {
        command.args(["--listen", "127.0.0.1:0"]);
    }
    let mut process = command
        .args(["--database-url", database_url, "--data-dir"])
        .arg(data)
        .args(extra)
        .stdout(Stdio::piped())
        .stderr(log)
        .spawn()
        .expect("the server starts");
    let out = process.stdout.take().expect("its output");
    let line = BufReader::new(out).lines().next().expect("a line").expect("text");
    let url = line.rsplit(' ').next().expect("an address").to_owned();
    (process, url)
}

/// A client that opens a connection for every request: while a test waits for a command, the server
/// may close an idle one, which the next request would meet half way.
fn client() -> Client {
    sistership_store::provide_cryptography();
    Client::builder().pool_max_idle_per_host(0).build().unwrap_or_default()
}
