//! `oidc-provider` of npm (MIT), certified by the OpenID Foundation, as a separate process: an
//! interpretation of the standard that is independent of this crate.

use std::io::{BufRead as _, BufReader};
use std::path::Path;
use std::process::{Child, Command, Stdio};

/// A certified provider, which accepts any person under any name. It is killed when this is
/// dropped.
#[derive(Debug)]
pub struct RealProvider {
    process: Child,
    /// Its issuer.
    pub issuer: String,
}

impl RealProvider {
    /// Secret of the client `ships`.
    pub const SECRET: &str = "of the test & no other";

    /// Starts a provider for a server at a URL; returns none, with a message, if it is not
    /// installed (`npm ci` in `tests/npm`).
    ///
    /// # Panics
    /// Panics if it is not installed although `SISTERSHIP_REQUIRE_OPENID=1` requires it, or if it
    /// does not start.
    pub fn start(url: &str) -> Option<Self> {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../tests/npm");
        if !folder.join("node_modules/oidc-provider").is_dir() {
            let required =
                std::env::var("SISTERSHIP_REQUIRE_OPENID").is_ok_and(|value| value == "1");
            assert!(!required, "tests/npm has no oidc-provider and SISTERSHIP_REQUIRE_OPENID=1");
            println!("skipped: oidc-provider is not installed in tests/npm");
            return None;
        }
        let mut process = Command::new("node")
            .current_dir(folder)
            .args(["provider.mjs", &format!("{url}/sign-in/oidc/callback")])
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .expect("node runs");
        let out = process.stdout.take().expect("its output");
        let issuer = BufReader::new(out).lines().next().expect("a line").expect("text");
        Some(Self { process, issuer })
    }
}

impl Drop for RealProvider {
    fn drop(&mut self) {
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}
