//! The same requests against registries of models, one after the other, and a table of what came of
//! them.
//!
//! `cargo run --release -p sistership-tests --example registry -- --sistership
//! http://127.0.0.1:8080 --mlflow http://127.0.0.1:5000`
//!
//! Each must be empty of models called `bench-...`; what is made stays. `--models`, `--versions`,
//! `--reads`, `--creations` and `--moves` set how many; by default 100 models of 100 versions,
//! 20000 reads, 2000 concurrent creations, 500 concurrent moves. An API key is read from
//! `SISTERSHIP_API_KEY`.

mod drive;
mod mlflow;
mod registry;
mod sistership;

use std::process::ExitCode;

use drive::{Figures, Sizes};
use registry::Registry;

type Failure = Box<dyn std::error::Error + Send + Sync>;

#[tokio::main]
async fn main() -> ExitCode {
    sistership_store::provide_cryptography();
    match run().await {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            eprintln!("error: {failure}");
            ExitCode::FAILURE
        }
    }
}

async fn run() -> Result<(), Failure> {
    let (registries, sizes) = arguments()?;
    let mut columns = Vec::new();
    for registry in registries {
        eprintln!("{}", registry.name());
        columns.push((registry.name(), drive::drive(&registry, &sizes).await?));
    }
    print(&columns);
    Ok(())
}

fn arguments() -> Result<(Vec<Registry>, Sizes), Failure> {
    let (mut registries, mut sizes) = (Vec::new(), Sizes::default());
    let mut arguments = std::env::args().skip(1);
    while let Some(flag) = arguments.next() {
        let value = arguments.next().ok_or_else(|| format!("{flag} needs a value"))?;
        match flag.as_str() {
            "--sistership" => registries.push(Registry::Sistership(value)),
            "--mlflow" => registries.push(Registry::Mlflow(value)),
            "--models" => sizes.models = value.parse()?,
            "--versions" => sizes.versions = value.parse()?,
            "--reads" => sizes.reads = value.parse()?,
            "--creations" => sizes.creations = value.parse()?,
            "--moves" => sizes.moves = value.parse()?,
            _ => {
                return Err(format!(
                    "there is no flag {flag}; the head of benches/registry/main.rs has all of them"
                )
                .into());
            }
        }
    }
    match registries.is_empty() {
        true => Err("name at least one registry: --sistership URL or --mlflow URL".into()),
        false => Ok((registries, sizes)),
    }
}

/// One line for each figure, one column for each registry.
fn print(columns: &[(String, Figures)]) {
    let names: Vec<&str> = columns.iter().map(|(name, _)| name.as_str()).collect();
    println!("| | {} |\n| --- |{}", names.join(" | "), " --- |".repeat(names.len()));
    let Some((_, first)) = columns.first() else { return };
    for (row, (label, _)) in first.iter().enumerate() {
        let cells: Vec<&str> = columns
            .iter()
            .map(|(_, figures)| figures.get(row).map_or("", |(_, cell)| cell.as_str()))
            .collect();
        println!("| {label} | {} |", cells.join(" | "));
    }
}
