//! A database whose connections go silent, as after a fail-over or behind a firewall that has
//! forgotten them: nothing comes, and nothing tells of it.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

use sistership_store::testing::TestDatabase;
use sistership_store::{RequestClaim, Store, SystemClock, sha256_hex};
use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};
use tokio::net::{UnixListener, UnixStream};

use crate::support::ship;

/// The name of PostgreSQL's socket in its folder.
const SOCKET: &str = ".s.PGSQL.5432";

/// What stands between a store and its server.
struct Proxy {
    folder: tempfile::TempDir,
    /// Connections made before this many silences pass nothing any more.
    silences: Arc<AtomicU64>,
}

impl Proxy {
    fn before(server: PathBuf) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let listener = UnixListener::bind(folder.path().join(SOCKET)).unwrap();
        let silences = Arc::new(AtomicU64::new(0));
        let known = Arc::clone(&silences);
        tokio::spawn(async move {
            while let Ok((client, _)) = listener.accept().await {
                let server = UnixStream::connect(server.join(SOCKET)).await.unwrap();
                let (from_client, to_client) = client.into_split();
                let (from_server, to_server) = server.into_split();
                tokio::spawn(pass(from_client, to_server, Arc::clone(&known)));
                tokio::spawn(pass(from_server, to_client, Arc::clone(&known)));
            }
        });
        Self { folder, silences }
    }

    fn silence(&self) {
        self.silences.fetch_add(1, Ordering::SeqCst);
    }
}

/// Passes bytes on until there is a silence; then the connection stays open.
async fn pass(
    mut from: tokio::net::unix::OwnedReadHalf,
    mut to: tokio::net::unix::OwnedWriteHalf,
    silences: Arc<AtomicU64>,
) {
    let (made, mut bytes) = (silences.load(Ordering::SeqCst), vec![0; 1 << 16]);
    while let Ok(read @ 1..) = from.read(&mut bytes).await {
        if silences.load(Ordering::SeqCst) != made {
            std::future::pending::<()>().await;
        }
        if to.write_all(&bytes[..read]).await.is_err() {
            return;
        }
    }
}

async fn behind_proxy(database: &TestDatabase) -> (Proxy, Store) {
    let (front, folder) = database.url.split_once("?host=").unwrap();
    let proxy = Proxy::before(Path::new(folder).to_path_buf());
    let url = format!("{front}?host={}", proxy.folder.path().display());
    let store = Store::connect(&url, Arc::new(SystemClock)).await.unwrap();
    (proxy, store)
}

/// Within 15 s reading and writing go on without anybody's help; meanwhile health is told within a
/// second.
#[tokio::test(flavor = "multi_thread")]
async fn a_store_gives_up_connections_that_go_silent() {
    let Some(database) = TestDatabase::new_postgres().await else { return };
    let (proxy, store) = behind_proxy(&database).await;
    let names = ["kcs", "kvlcc2", "sr108"];
    store.ships().create(&ship(names[0])).await.unwrap();
    for (round, name) in names.into_iter().enumerate().skip(1) {
        // All connections of the pool are made before they go silent.
        let ask = async || store.ships().get(names[0]).await;
        let asks = (0..16).map(|_| ask());
        futures::future::join_all(asks).await;
        // A transaction that holds the row which is written afterwards.
        let held = store.begin_unit();
        held.store().ships().create(&ship(name)).await.unwrap();
        proxy.silence();
        let start = Instant::now();
        assert!(store.check_health().await.is_err(), "round {round}");
        assert!(start.elapsed() < Duration::from_secs(1), "{:?}", start.elapsed());
        while store.ships().create(&ship(name)).await.is_err() {
            assert!(start.elapsed() < Duration::from_secs(15), "round {round}");
        }
        assert!(store.ships().get(name).await.is_ok());
        assert!(store.check_health().await.is_ok());
        println!("recovered after {:?}", start.elapsed());
    }
}

/// The key of a request that failed because the database did not answer can be used again soon
/// after it does, not only when the key expires.
#[tokio::test(flavor = "multi_thread")]
async fn a_key_is_given_up_when_the_database_answers_again() {
    let Some(database) = TestDatabase::new_postgres().await else { return };
    let (proxy, store) = behind_proxy(&database).await;
    let hash = sha256_hex(b"a request");
    let begin = async || store.idempotency().begin_request("POST /v1/ships", "key", &hash).await;
    let Ok(RequestClaim::New(ticket)) = begin().await else { panic!() };
    proxy.silence();
    store.idempotency().abandon_in_background(ticket);
    let start = Instant::now();
    while !matches!(begin().await, Ok(RequestClaim::New(_))) {
        assert!(start.elapsed() < Duration::from_secs(20), "{:?}", start.elapsed());
        tokio::time::sleep(Duration::from_millis(200)).await;
    }
}
