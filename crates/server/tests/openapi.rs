//! The contract of the server is the file `api/openapi.json`: whoever changes an endpoint changes it there too.

#![allow(clippy::unwrap_used, missing_docs)]

use std::path::Path;

#[test]
fn the_document_is_the_one_in_the_repository() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../api/openapi.json");
    let now = sistership_server::openapi().to_pretty_json().unwrap() + "\n";
    if std::env::var_os("UPDATE_OPENAPI").is_some() {
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(&path, &now).unwrap();
    }
    let there = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(there == now, "the endpoints have changed: run `UPDATE_OPENAPI=1 cargo test -p sistership-server --test openapi`");
}
