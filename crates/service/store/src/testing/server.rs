//! A private PostgreSQL server, one per test process.
//!
//! It runs below a shell that reads a pipe from the test process. However that process ends, the
//! pipe closes, and the shell stops the server and removes its folder.

use std::fs;
use std::os::unix::fs::{MetadataExt as _, chown};
use std::os::unix::process::CommandExt as _;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::OnceLock;
use std::time::{Duration, Instant};

use sqlx::postgres::PgConnectOptions;

const PATIENCE: Duration = Duration::from_secs(60);

/// Shell script of the keeper: `$1` is the program, `$2` the folder. Nothing is synced to disk: the
/// data need not outlive the process.
const KEEPER: &str = r#"
"$1" -D "$2/data" -k "$2" -c listen_addresses= -c max_connections=300 -c shared_buffers=32MB \
    -c fsync=off -c synchronous_commit=off -c full_page_writes=off >"$2/log" 2>&1 </dev/null &
cat >/dev/null
kill -QUIT $!
wait
cd /
rm -rf "$2"
"#;

/// The server, which lives as long as the process: dropping the keeper's pipe stops it.
pub(super) struct PostgresServer {
    folder: PathBuf,
    _keeper: Child,
}

/// Returns the server of this process, if PostgreSQL is installed.
pub(super) fn shared_server() -> Option<&'static PostgresServer> {
    static SERVER: OnceLock<Option<PostgresServer>> = OnceLock::new();
    SERVER
        .get_or_init(|| {
            find_programs().map(|programs| PostgresServer::start(&programs)).or_else(skip_tests)
        })
        .as_ref()
}

fn skip_tests() -> Option<PostgresServer> {
    let required = std::env::var("SISTERSHIP_REQUIRE_POSTGRES").is_ok_and(|value| value == "1");
    assert!(!required, "no PostgreSQL binaries, and SISTERSHIP_REQUIRE_POSTGRES=1");
    eprintln!("skipped: no PostgreSQL binaries");
    None
}

/// Returns the folder of `initdb` and `postgres`, from the search path or Debian's location.
fn find_programs() -> Option<PathBuf> {
    let path = std::env::var_os("PATH").unwrap_or_default();
    let mut debian: Vec<_> =
        fs::read_dir("/usr/lib/postgresql").into_iter().flatten().flatten().collect();
    debian.sort_by_key(|entry| std::cmp::Reverse(entry.file_name()));
    std::env::split_paths(&path)
        .chain(debian.into_iter().map(|entry| entry.path().join("bin")))
        .find(|folder| folder.join("initdb").exists() && folder.join("postgres").exists())
}

impl PostgresServer {
    fn start(programs: &Path) -> Self {
        let folder = tempfile::Builder::new()
            .prefix("sistership-pg-")
            .tempdir()
            .expect("a temporary folder")
            .keep();
        let user = run_user(&folder);
        if let Some((uid, gid)) = user {
            chown(&folder, Some(uid), Some(gid)).expect("the folder for another user");
        }
        initialise_cluster(programs, &folder, user);
        // The folder is not removed by this process: the keeper does so after the server has
        // stopped.
        let keeper = spawn_keeper(programs, &folder, user);
        await_ready(&folder);
        Self { folder, _keeper: keeper }
    }

    /// Returns the options of a connection to the server itself.
    pub(super) fn connect_options(&self) -> PgConnectOptions {
        PgConnectOptions::new().socket(&self.folder).username("postgres").database("postgres")
    }

    /// Returns the URL of a database on the server.
    pub(super) fn database_url(&self, database: &str) -> String {
        format!("postgres://postgres@localhost/{database}?host={}", self.folder.display())
    }
}

/// Returns user and group to run as if this process is root, which PostgreSQL refuses: those of
/// `postgres`, or of the unprivileged default user.
fn run_user(own: &Path) -> Option<(u32, u32)> {
    if fs::metadata(own).expect("a folder of our own").uid() != 0 {
        return None;
    }
    let users = fs::read_to_string("/etc/passwd").unwrap_or_default();
    let find = |name: &str| users.lines().find_map(|line| parse_ids(line, name));
    find("postgres").or_else(|| find("nobody"))
}

/// Parses user and group from a line of `/etc/passwd`, if it is about `name`.
fn parse_ids(line: &str, name: &str) -> Option<(u32, u32)> {
    let mut fields = line.split(':');
    (fields.next()? == name).then_some(())?;
    // Fields after the name: password, user, group.
    Some((fields.nth(1)?.parse().ok()?, fields.next()?.parse().ok()?))
}

fn isolated_command(
    program: impl AsRef<std::ffi::OsStr>,
    folder: &Path,
    user: Option<(u32, u32)>,
) -> Command {
    let mut command = Command::new(program);
    command
        .current_dir(folder)
        // A group of its own: an interrupt of the terminal must not stop the server before the
        // tests.
        .process_group(0)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null());
    if let Some((uid, gid)) = user {
        command.uid(uid).gid(gid);
    }
    command
}

fn initialise_cluster(programs: &Path, folder: &Path, user: Option<(u32, u32)>) {
    let mut initdb = isolated_command(programs.join("initdb"), folder, user);
    initdb.args([
        "--username=postgres",
        "--auth=trust",
        "--encoding=UTF8",
        "--locale=C",
        "--no-sync",
        "--pgdata=data",
    ]);
    let output = initdb.stderr(Stdio::piped()).output().expect("initdb");
    assert!(output.status.success(), "initdb: {}", String::from_utf8_lossy(&output.stderr));
}

fn spawn_keeper(programs: &Path, folder: &Path, user: Option<(u32, u32)>) -> Child {
    let mut keeper = isolated_command("/bin/sh", folder, user);
    keeper.args(["-c", KEEPER, "keeper"]).arg(programs.join("postgres")).arg(folder);
    keeper.stdin(Stdio::piped()).spawn().expect("the keeper of a private PostgreSQL server")
}

/// Waits until the eighth line of `postmaster.pid` says that the server accepts connections.
fn await_ready(folder: &Path) {
    let start = Instant::now();
    let status = || fs::read_to_string(folder.join("data/postmaster.pid")).unwrap_or_default();
    while status().lines().nth(7).is_none_or(|line| line.trim() != "ready") {
        let log = || fs::read_to_string(folder.join("log")).unwrap_or_default();
        assert!(
            start.elapsed() < PATIENCE,
            "the private PostgreSQL server did not start: {}",
            log()
        );
        std::thread::sleep(Duration::from_millis(20));
    }
}
