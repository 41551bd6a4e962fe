//! An MLflow tracking server, by its REST API (<https://mlflow.org/docs/latest/rest-api.html>). A
//! version of its registry is a reference to files that are kept elsewhere; the reference alone is
//! made and read here.

use reqwest::{Client, RequestBuilder};
use serde_json::{Value, json};

use crate::Failure;

async fn done(request: RequestBuilder) -> Result<Value, Failure> {
    let response = request.send().await?;
    let status = response.status();
    let text = response.text().await?;
    if status.is_success() {
        Ok(serde_json::from_str(&text)?)
    } else {
        Err(format!("{status}: {text}").into())
    }
}

fn place(url: &str, path: &str) -> String {
    format!("{url}/api/2.0/mlflow/{path}")
}

pub async fn model(client: &Client, url: &str, model: &str) -> Result<(), Failure> {
    done(client.post(place(url, "registered-models/create")).json(&json!({ "name": model })))
        .await
        .map(drop)
}

pub async fn create(client: &Client, url: &str, model: &str) -> Result<u64, Failure> {
    let body = json!({ "name": model, "source": format!("s3://bench/{model}") });
    let made = done(client.post(place(url, "model-versions/create")).json(&body)).await?;
    let number = made["model_version"]["version"].as_str().and_then(|number| number.parse().ok());
    number.ok_or_else(|| format!("no version in {made}").into())
}

pub async fn crown(client: &Client, url: &str, model: &str, version: u64) -> Result<(), Failure> {
    let body = json!({ "name": model, "alias": "champion", "version": version.to_string() });
    done(client.post(place(url, "registered-models/alias")).json(&body)).await.map(drop)
}

pub async fn champion(client: &Client, url: &str, model: &str) -> Result<(), Failure> {
    let request =
        client.get(place(url, &format!("registered-models/alias?name={model}&alias=champion")));
    let found = done(request).await?;
    if found["model_version"].is_object() {
        Ok(())
    } else {
        Err(format!("no champion in {found}").into())
    }
}
