//! A disk that is full: what is to be kept gets 507, reading goes on, also after a restart, and
//! writing once there is room.

use std::fs::{self, File};
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;

use reqwest::Method;
use reqwest::multipart::{Form, Part};
use serde_json::Value;
use sistership_store::testing::TestDatabase;
use sistership_tests::server::{TestServer, json as answer};

use super::over_http::create;
use super::sea_trials::{NAME, csv, manifest, trials};

/// A small disk on a folder.
struct Disk(PathBuf);

impl Disk {
    /// None, said plainly, where this process may not mount one.
    fn on(folder: &Path) -> Option<Self> {
        let mounted = Command::new("mount")
            .args(["-t", "tmpfs", "-o", "size=32m", "tmpfs"])
            .arg(folder)
            .status();
        if mounted.is_ok_and(|status| status.success()) {
            return Some(Self(folder.to_path_buf()));
        }
        eprintln!(
            "skipped: no small disk can be mounted here (it takes root on Linux); unit tests try \
             the answers alone"
        );
        None
    }

    /// Leaves no room.
    fn fill(&self) {
        let mut file =
            File::options().create(true).append(true).open(self.filler()).expect("a file");
        for size in [1 << 20, 4096, 1] {
            while file.write_all(&vec![0; size]).is_ok() {}
        }
    }

    fn empty(&self) {
        fs::remove_file(self.filler()).expect("the file is removed");
    }

    fn filler(&self) -> PathBuf {
        self.0.join("filler")
    }
}

impl Drop for Disk {
    fn drop(&mut self) {
        let _ = Command::new("umount").arg("-l").arg(&self.0).status();
    }
}

async fn upload(server: &TestServer) -> (u16, Value) {
    let trials = trials();
    let form = Form::new().text("manifest", manifest(&trials));
    let form = trials.iter().fold(form, |form, trial| {
        form.part("file", Part::bytes(csv(trial)).file_name(trial.name.clone()))
    });
    answer(
        server.request(Method::POST, "/v1/trials").multipart(form).send().await.expect("an answer"),
    )
    .await
}

/// Reads as ever; says that it cannot write.
async fn only_reads(server: &TestServer) {
    assert_eq!(server.get(&format!("/v1/ships/{NAME}")).await["name"], NAME);
    assert_eq!(server.get("/readyz").await["writes"], "no space");
    let (status, refused) = upload(server).await;
    assert_eq!(
        (status, &refused["type"]),
        (507, &"urn:sistership:problem:no-room".into()),
        "{refused}"
    );
    // Many of them: whatever pages are still free are used up, and nothing else than 507 may come
    // of it.
    let mut refused = 0;
    for number in 0..200 {
        let tag = format!("/v1/ships/{NAME}/tags/a-tag-that-takes-some-room-{number}");
        // Taken off again, so that there are never too many.
        for method in [Method::PUT, Method::DELETE] {
            let status = server.send(method, &tag, &Value::Null, &[]).await.0;
            assert!(matches!(status, 204 | 404 | 507), "{status}");
            refused += usize::from(status == 507);
        }
    }
    assert!(refused > 0, "the database found room");
}

#[tokio::test(flavor = "multi_thread")]
async fn a_full_disk_is_answered_by_507_and_read_from() {
    let database = TestDatabase::new_sqlite();
    let Some(disk) = Disk::on(database.folder.path()) else { return };
    let mut server = TestServer::on(database, &[]).await;
    create(&server).await;
    disk.fill();
    assert_eq!(upload(&server).await.0, 507);
    only_reads(&server).await;
    server.kill();
    server.restart().await;
    only_reads(&server).await;
    server.terminate();
    disk.fill();
    server.restart().await;
    only_reads(&server).await;
    disk.empty();
    for _ in 0..100 {
        if server.get("/readyz").await["writes"] == "ok" {
            break;
        }
        tokio::time::sleep(Duration::from_millis(100)).await;
    }
    let (status, uploaded) = upload(&server).await;
    assert_eq!((status, &uploaded["new"]), (201, &4.into()), "{uploaded}");
    server.kill();
    drop(disk);
}
