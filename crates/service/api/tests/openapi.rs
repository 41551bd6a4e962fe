//! The contract of the server is the file `api/openapi.json`: whoever changes an endpoint changes
//! it there too.

#![allow(clippy::unwrap_used, missing_docs)]

use std::path::Path;

#[test]
fn the_document_is_the_one_in_the_repository() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../api/openapi.json");
    let now = serde_json::to_string_pretty(&sistership_api::openapi()).unwrap() + "\n";
    if std::env::var_os("UPDATE_OPENAPI").is_some() {
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(&path, &now).unwrap();
    }
    let there = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(
        there == now,
        "the endpoints have changed: run `UPDATE_OPENAPI=1 cargo test --workspace --test openapi`, \
         and read the difference of api/openapi.json"
    );
}

/// Two types of one name are one schema in the document, and one of them is described by the other.
#[test]
fn no_two_types_share_a_name() {
    let mut names = std::collections::BTreeMap::<String, Vec<String>>::new();
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let rooms = ["api", "web-support", "jobs"].map(|name| crates.join(name).join("src"));
    for file in rooms.iter().flat_map(|room| walk(room)) {
        let text = std::fs::read_to_string(&file).unwrap();
        let mut lines = text.lines();
        while let Some(line) = lines.next() {
            if line.trim_start().starts_with("#[derive(") && line.contains("ToSchema") {
                let rest: Vec<&str> =
                    lines.by_ref().take_while(|line| !line.trim_end().is_empty()).take(8).collect();
                let name = rest.iter().find_map(|line| name(line));
                let renamed = rest
                    .iter()
                    .find_map(|line| line.split_once("schema(as = ")?.1.split([')', ',']).next());
                let name = renamed.or(name).unwrap_or_else(|| panic!("{}: {line}", file.display()));
                names.entry(name.to_owned()).or_default().push(file.display().to_string());
            }
        }
    }
    names.retain(|_, files| files.len() > 1);
    // The two are never references: a parameter has them in place.
    names.remove("Format");
    assert!(names.is_empty(), "{names:#?}");
}

/// The name of a type that a line declares.
fn name(line: &str) -> Option<&str> {
    let rest = line.split_once("struct ").or_else(|| line.split_once("enum "))?.1;
    rest.split(|c: char| !c.is_alphanumeric() && c != '_').next()
}

fn walk(folder: &Path) -> Vec<std::path::PathBuf> {
    let entries = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    entries.flat_map(|path| if path.is_dir() { walk(&path) } else { vec![path] }).collect()
}

#[test]
fn every_reference_leads_somewhere_and_every_file_that_is_named_is_there() {
    let document = sistership_api::openapi();
    let text = document.to_string();
    for reference in text.split("\"$ref\":\"#").skip(1).map(|rest| rest.split('"').next().unwrap())
    {
        assert!(document.pointer(reference).is_some(), "{reference}");
    }
    for file in text
        .split("models/schema/")
        .skip(1)
        .map(|rest| rest.split(['`', ')', ' ', '"']).next().unwrap())
    {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../models/schema").join(file);
        assert!(path.is_file(), "models/schema/{file} is no file");
    }
}
