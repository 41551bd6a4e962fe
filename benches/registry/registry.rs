//! What is asked of a registry, whichever it is.

use reqwest::Client;

use crate::{Failure, mlflow, sistership};

/// A registry by its URL.
#[derive(Debug, Clone)]
pub enum Registry {
    /// This project's server.
    Sistership(String),
    /// An MLflow tracking server.
    Mlflow(String),
}

/// What a conditional move came to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Moved {
    /// It was made.
    Won,
    /// Another was first.
    Lost,
}

impl Registry {
    /// Which it is, for the table.
    pub fn name(&self) -> String {
        match self {
            Self::Sistership(url) => format!("Sistership {url}"),
            Self::Mlflow(url) => format!("MLflow {url}"),
        }
    }

    /// Makes an empty model.
    pub async fn model(&self, client: &Client, model: &str) -> Result<(), Failure> {
        match self {
            Self::Sistership(url) => sistership::model(client, url, model).await,
            Self::Mlflow(url) => mlflow::model(client, url, model).await,
        }
    }

    /// Makes the next version of a model, and returns its number.
    pub async fn create(&self, client: &Client, model: &str) -> Result<u64, Failure> {
        match self {
            Self::Sistership(url) => sistership::create(client, url, model).await,
            Self::Mlflow(url) => mlflow::create(client, url, model).await,
        }
    }

    /// Moves the alias `champion` of a model to a version, whatever it stood for.
    pub async fn crown(&self, client: &Client, model: &str, version: u64) -> Result<(), Failure> {
        match self {
            Self::Sistership(url) => sistership::crown(client, url, model, version).await,
            Self::Mlflow(url) => mlflow::crown(client, url, model, version).await,
        }
    }

    /// Waits until what the registry does in the background about so many models is done.
    pub async fn settle(&self, client: &Client, models: usize) -> Result<(), Failure> {
        match self {
            Self::Sistership(url) => sistership::settle(client, url, models).await,
            Self::Mlflow(_) => Ok(()),
        }
    }

    /// Reads the champion of a model.
    pub async fn champion(&self, client: &Client, model: &str) -> Result<(), Failure> {
        match self {
            Self::Sistership(url) => sistership::champion(client, url, model).await,
            Self::Mlflow(url) => mlflow::champion(client, url, model).await,
        }
    }

    /// What a move must present, where the registry has conditional moves.
    pub async fn tag(&self, client: &Client, model: &str) -> Result<Option<String>, Failure> {
        match self {
            Self::Sistership(url) => sistership::tag(client, url, model).await.map(Some),
            Self::Mlflow(_) => Ok(None),
        }
    }

    /// Moves the champion if it is still what `tag` says.
    pub async fn swap(
        &self,
        client: &Client,
        model: &str,
        version: u64,
        tag: &str,
    ) -> Result<Moved, Failure> {
        match self {
            Self::Sistership(url) => sistership::swap(client, url, model, version, tag).await,
            Self::Mlflow(_) => Err("MLflow has no conditional moves".into()),
        }
    }
}
