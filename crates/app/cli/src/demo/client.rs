//! Client of the server's REST interface, as a user of it would write one.

use reqwest::multipart::{Form, Part};
use reqwest::{Client, RequestBuilder, Response};
use serde_json::Value;

use crate::failure::Failure;

/// Client of one server.
pub struct ApiClient {
    client: Client,
    url: String,
}

impl ApiClient {
    /// Creates a client of the server at a URL.
    pub fn new(url: String) -> Self {
        Self { client: Client::new(), url }
    }

    /// Returns the JSON of a path.
    ///
    /// # Errors
    /// Returns the server's message if it refuses the request.
    pub async fn get(&self, path: &str) -> Result<Value, Failure> {
        send_for_json(self.client.get(self.full_url(path))).await
    }

    /// Returns the text of a path in a media type.
    ///
    /// # Errors
    /// Same as [`ApiClient::get`].
    pub async fn get_text(&self, path: &str, accept: &str) -> Result<String, Failure> {
        let response =
            send_request(self.client.get(self.full_url(path)).header("accept", accept)).await?;
        response.text().await.map_err(connection_failure)
    }

    /// Sends YAML.
    ///
    /// # Errors
    /// Same as [`ApiClient::get`].
    pub async fn post_yaml(&self, path: &str, body: String) -> Result<Value, Failure> {
        send_for_json(
            self.client
                .post(self.full_url(path))
                .header("content-type", "application/yaml")
                .body(body),
        )
        .await
    }

    /// Sends JSON.
    ///
    /// # Errors
    /// Same as [`ApiClient::get`].
    pub async fn post_json(&self, path: &str, body: &Value) -> Result<Value, Failure> {
        send_for_json(self.client.post(self.full_url(path)).json(body)).await
    }

    /// Uploads files with their manifest.
    ///
    /// # Errors
    /// Same as [`ApiClient::get`].
    pub async fn upload_trials(
        &self,
        manifest: String,
        files: Vec<(String, Vec<u8>)>,
    ) -> Result<Value, Failure> {
        let form = Form::new().text("manifest", manifest);
        let form = files.into_iter().fold(form, |form, (name, bytes)| {
            form.part("file", Part::bytes(bytes).file_name(name))
        });
        send_for_json(self.client.post(self.full_url("/v1/trials")).multipart(form)).await
    }

    /// Deletes the resource of a path; this can be undone.
    ///
    /// # Errors
    /// Same as [`ApiClient::get`].
    pub async fn delete(&self, path: &str) -> Result<(), Failure> {
        send_request(self.client.delete(self.full_url(path))).await.map(drop)
    }

    fn full_url(&self, path: &str) -> String {
        format!("{}{path}", self.url)
    }
}

async fn send_for_json(request: RequestBuilder) -> Result<Value, Failure> {
    send_request(request).await?.json().await.map_err(connection_failure)
}

/// Sends a request; returns the answer, or the problem reported by the server.
async fn send_request(request: RequestBuilder) -> Result<Response, Failure> {
    let response = request.send().await.map_err(connection_failure)?;
    if response.status().is_success() {
        return Ok(response);
    }
    // A refusal of the server is a problem document with a `detail`.
    let problem: Value = response.json().await.map_err(connection_failure)?;
    Err(Failure::Refused(format!(
        "the server refused the request: {}",
        problem["detail"].as_str().unwrap_or("no reason given")
    )))
}

fn connection_failure(error: reqwest::Error) -> Failure {
    Failure::Refused(format!("the server did not answer: {error}"))
}
