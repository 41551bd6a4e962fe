//! Export of traces to a collector of OpenTelemetry, by OTLP over HTTP.

use std::pin::Pin;
use std::time::Duration;

use opentelemetry::global::set_text_map_propagator;
use opentelemetry::trace::TracerProvider as _;
use opentelemetry_http::{Bytes, HttpClient, HttpError, Request, Response};
use opentelemetry_otlp::{SpanExporter, WithExportConfig as _, WithHttpConfig as _};
use opentelemetry_sdk::Resource;
use opentelemetry_sdk::propagation::TraceContextPropagator;
use opentelemetry_sdk::trace::{SdkTracer, SdkTracerProvider};
use tokio::runtime::Runtime;

use crate::failure::Failure;

/// Name of the program in traces.
const SERVICE: &str = "sistership";
/// Path of the collector for traces.
const TRACES_PATH: &str = "/v1/traces";
/// Maximum time for sending a batch of spans.
const SEND_TIMEOUT: Duration = Duration::from_secs(10);
/// Maximum time for sending the last spans when the process ends.
const FLUSH_TIMEOUT: Duration = Duration::from_secs(2);

/// Export of traces; what is left is sent when this is dropped.
#[derive(Debug)]
pub struct TraceExport(SdkTracerProvider);

impl TraceExport {
    /// Starts the export to a collector at `endpoint`, such as `http://127.0.0.1:4318`.
    ///
    /// # Errors
    /// Returns an error if the endpoint is no URL of HTTP.
    pub fn start(endpoint: &str) -> Result<Self, Failure> {
        let wrong = |reason: String| {
            Failure::Call(format!(
                "otlp_endpoint `{endpoint}`: {reason}; give the URL of a collector, such as \
                 http://127.0.0.1:4318"
            ))
        };
        let url = format!("{}{TRACES_PATH}", endpoint.trim_end_matches('/'));
        let parsed = url.parse::<reqwest::Url>().map_err(|error| wrong(error.to_string()))?;
        if !matches!(parsed.scheme(), "http" | "https") {
            return Err(wrong("is neither http nor https".to_owned()));
        }
        let client = CollectorClient::new().map_err(|error| wrong(error.to_string()))?;
        let exporter = SpanExporter::builder().with_http().with_http_client(client);
        let exporter = exporter.with_endpoint(url).with_timeout(SEND_TIMEOUT).build();
        let exporter = exporter.map_err(|error| wrong(error.to_string()))?;
        // A caller's `traceparent` is continued, so that its trace includes ours.
        set_text_map_propagator(TraceContextPropagator::new());
        let resource = Resource::builder().with_service_name(SERVICE).build();
        let provider = SdkTracerProvider::builder().with_resource(resource);
        Ok(Self(provider.with_batch_exporter(exporter).build()))
    }

    /// Returns the tracer of the program.
    pub fn tracer(&self) -> SdkTracer {
        self.0.tracer(SERVICE)
    }
}

impl Drop for TraceExport {
    fn drop(&mut self) {
        // A collector that does not answer must not keep the process.
        let _ = self.0.shutdown_with_timeout(FLUSH_TIMEOUT);
    }
}

/// HTTP client with a runtime of its own, as the exporter sends from a thread outside of any.
#[derive(Debug)]
struct CollectorClient {
    client: reqwest::Client,
    runtime: Runtime,
}

impl CollectorClient {
    fn new() -> Result<Self, HttpError> {
        // The client of TLS takes the provider of the process, which may not be set yet.
        sistership_store::provide_cryptography();
        let client = reqwest::Client::builder().timeout(SEND_TIMEOUT).build()?;
        let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build()?;
        Ok(Self { client, runtime })
    }

    fn send_blocking(&self, request: Request<Bytes>) -> Result<Response<Bytes>, HttpError> {
        self.runtime.block_on(async {
            let answer = self.client.execute(request.try_into()?).await?;
            let response = Response::builder().status(answer.status());
            Ok(response.body(answer.bytes().await?)?)
        })
    }
}

type Sending<'a> = Pin<Box<dyn Future<Output = Result<Response<Bytes>, HttpError>> + Send + 'a>>;

impl HttpClient for CollectorClient {
    fn send_bytes<'a, 'b>(&'a self, request: Request<Bytes>) -> Sending<'b>
    where
        'a: 'b,
        Self: 'b,
    {
        Box::pin(async move { self.send_blocking(request) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_endpoint_that_is_no_url_is_named() {
        for endpoint in ["nowhere", "ftp://collector:4318"] {
            let refused = TraceExport::start(endpoint).map(drop);
            assert!(refused.is_err_and(|failure| {
                failure.message().is_some_and(|text| text.contains(endpoint))
            }));
        }
    }
}
