//! An S3-compatible server within the test process: s3s on a temporary folder, with real HTTP and
//! real signatures.

use std::net::SocketAddr;

use hyper_util::rt::{TokioExecutor, TokioIo};
use hyper_util::server::conn::auto::Builder;
use s3s::auth::SimpleAuth;
use s3s::service::{S3Service, S3ServiceBuilder};
use s3s_fs::FileSystem;
use tempfile::TempDir;
use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};
use tokio::net::{TcpListener, TcpStream};
use tokio::task::JoinHandle;

use crate::objects::ObjectStorage;
use crate::objects_place::{ObjectsPlace, S3Place, bucket_builder, bucket_store};

/// Name of the only bucket.
const BUCKET: &str = "samples";
/// Accepted access key and secret.
const KEY: (&str, &str) = ("test", "only-for-tests");

/// A server that stops when this is dropped.
#[derive(Debug)]
pub struct TestS3 {
    address: SocketAddr,
    /// Folder of the server's objects, `samples/...`.
    pub folder: TempDir,
    serving: JoinHandle<()>,
}

impl TestS3 {
    /// Starts a server with an empty bucket.
    pub async fn start() -> Self {
        let folder = tempfile::tempdir().expect("a temporary folder");
        std::fs::create_dir(folder.path().join(BUCKET)).expect("a bucket");
        let mut service =
            S3ServiceBuilder::new(FileSystem::new(folder.path()).expect("a file system"));
        service.set_auth(SimpleAuth::from_single(KEY.0, KEY.1));
        let listener = TcpListener::bind(("127.0.0.1", 0)).await.expect("a free port");
        let address = listener.local_addr().expect("an address");
        Self { address, folder, serving: tokio::spawn(serve(listener, service.build())) }
    }

    /// Returns the options of the command line for a store below a prefix: the URL of the objects
    /// and the endpoint.
    pub fn store_options(&self, prefix: &str) -> [(&'static str, String); 2] {
        [
            ("--objects-url", format!("s3://{BUCKET}/{prefix}")),
            ("--objects-endpoint", format!("http://{}", self.address)),
        ]
    }

    /// Returns the environment variables with which another process is accepted.
    pub fn environment_credentials(&self) -> [(&'static str, &'static str); 2] {
        [("AWS_ACCESS_KEY_ID", KEY.0), ("AWS_SECRET_ACCESS_KEY", KEY.1)]
    }

    /// Opens a store below a prefix.
    pub fn open_objects(&self, prefix: &str) -> ObjectStorage {
        self.objects_as(KEY.0, prefix)
    }

    /// Opens a store below a prefix with another access key.
    pub fn objects_as(&self, user: &str, prefix: &str) -> ObjectStorage {
        let [(_, url), (_, endpoint)] = self.store_options(prefix);
        let ObjectsPlace::S3(place) =
            ObjectsPlace::parse_s3(&url, Some(endpoint), None).expect("a place")
        else {
            unreachable!()
        };
        ObjectStorage::from_store(build_store(&place, user))
    }
}

/// A server that does not answer as a bucket does.
#[derive(Debug)]
pub struct FaultyBucket {
    address: SocketAddr,
    serving: JoinHandle<()>,
}

impl FaultyBucket {
    /// Starts a server that answers every request with a status; without one it accepts requests
    /// and never answers.
    pub async fn start(status: Option<u16>) -> Self {
        let listener = TcpListener::bind(("127.0.0.1", 0)).await.expect("a free port");
        let address = listener.local_addr().expect("an address");
        Self { address, serving: tokio::spawn(answer_all(listener, status)) }
    }

    /// Opens a store in it.
    pub fn open_objects(&self) -> ObjectStorage {
        let (url, endpoint) = (format!("s3://{BUCKET}"), format!("http://{}", self.address));
        let ObjectsPlace::S3(place) =
            ObjectsPlace::parse_s3(&url, Some(endpoint), None).expect("a place")
        else {
            unreachable!()
        };
        ObjectStorage::from_store(build_store(&place, KEY.0))
    }
}

impl Drop for FaultyBucket {
    fn drop(&mut self) {
        self.serving.abort();
    }
}

async fn answer_all(listener: TcpListener, status: Option<u16>) {
    let mut held = Vec::new();
    while let Ok((mut stream, _)) = listener.accept().await {
        let Some(status) = status else {
            held.push(stream);
            continue;
        };
        tokio::spawn(async move {
            let (mut head, answer) = (
                [0; 1 << 14],
                format!(
                    "HTTP/1.1 {status} Fault\r\ncontent-length: 0\r\nconnection: close\r\n\r\n"
                ),
            );
            // The request is not parsed: its head comes with the first read.
            if stream.read(&mut head).await.is_ok() {
                let _ = stream.write_all(answer.as_bytes()).await;
                let _ = stream.shutdown().await;
            }
        });
    }
}

/// Creates the store of a location, with the credentials that the environment of a test does not
/// have.
fn build_store(place: &S3Place, user: &str) -> std::sync::Arc<dyn object_store::ObjectStore> {
    bucket_store(
        bucket_builder(place).with_access_key_id(user).with_secret_access_key(KEY.1),
        place,
    )
    .expect("a bucket")
}

impl Drop for TestS3 {
    fn drop(&mut self) {
        self.serving.abort();
    }
}

async fn serve(listener: TcpListener, service: S3Service) {
    while let Ok((stream, _)) = listener.accept().await {
        tokio::spawn(serve_client(stream, service.clone()));
    }
}

async fn serve_client(stream: TcpStream, service: S3Service) {
    // An error means that the client has hung up, which is no failure.
    let _ =
        Builder::new(TokioExecutor::new()).serve_connection(TokioIo::new(stream), service).await;
}
