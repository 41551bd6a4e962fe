//! Metrics of the server, for Prometheus.

mod measured;

use std::fmt;
use std::time::Duration;

use axum::http::{Method, StatusCode};
use prometheus_client::encoding::EncodeLabelSet;
use prometheus_client::encoding::text::{encode_eof, encode_registry};
use prometheus_client::metrics::counter::Counter;
use prometheus_client::metrics::family::Family;
use prometheus_client::metrics::histogram::Histogram;
use prometheus_client::registry::Registry;
use sistership_store::Result;

use self::measured::ArchiveMetrics;
use sistership_jobs::archive::Archive;

/// Media type of the metrics.
pub const MEDIA: &str = "application/openmetrics-text; version=1.0.0; charset=utf-8";
/// Upper bounds of the histogram, s: from a lookup to a derivation that takes minutes.
const SECONDS: [f64; 13] =
    [0.001, 0.0025, 0.005, 0.01, 0.025, 0.05, 0.1, 0.25, 1.0, 2.5, 10.0, 60.0, 600.0];

#[derive(Debug, Clone, PartialEq, Eq, Hash, EncodeLabelSet)]
struct AnswerLabels {
    method: &'static str,
    route: String,
    status: u16,
}

#[derive(Debug, Clone, PartialEq, Eq, Hash, EncodeLabelSet)]
struct RouteLabels {
    method: &'static str,
    route: String,
}

/// Metrics of the server.
pub struct ServerMetrics {
    registry: Registry,
    requests: Family<AnswerLabels, Counter>,
    seconds: Family<RouteLabels, Histogram>,
    measured: ArchiveMetrics,
}

impl Default for ServerMetrics {
    fn default() -> Self {
        let mut registry = Registry::with_prefix("sistership");
        let requests = Family::default();
        registry.register(
            "http_requests",
            "Requests answered, by route and status",
            requests.clone(),
        );
        let seconds = Family::new_with_constructor(duration_histogram as fn() -> Histogram);
        registry.register(
            "http_request_duration_seconds",
            "Duration of requests until the response",
            seconds.clone(),
        );
        Self { registry, requests, seconds, measured: ArchiveMetrics::default() }
    }
}

impl fmt::Debug for ServerMetrics {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Metrics").finish_non_exhaustive()
    }
}

fn duration_histogram() -> Histogram {
    Histogram::new(SECONDS)
}

impl ServerMetrics {
    /// Counts an answer. `route` is the path pattern of the router, so that ids do not create new
    /// labels.
    pub fn count_answer(
        &self,
        method: &Method,
        route: &str,
        status: StatusCode,
        elapsed: Duration,
    ) {
        let method = method_label(method);
        // The status is a label of the counter only; with it the histogram would have too many
        // series.
        let labels = AnswerLabels { method, route: route.to_owned(), status: status.as_u16() };
        self.requests.get_or_create(&labels).inc();
        self.seconds
            .get_or_create(&RouteLabels { method, route: labels.route })
            .observe(elapsed.as_secs_f64());
    }

    /// Returns all metrics as text, including those read from the archive.
    pub async fn scrape(&self, archive: &Archive) -> Result<String> {
        let now = self.measured.current_registry(archive).await?;
        let mut text = String::new();
        // Writing to a string does not fail.
        let _ = encode_registry(&mut text, &self.registry);
        let _ = encode_registry(&mut text, &now);
        let _ = encode_eof(&mut text);
        Ok(text)
    }
}

/// Returns the label of a method; unknown methods share one, so that a caller cannot create labels.
fn method_label(method: &Method) -> &'static str {
    match *method {
        Method::GET => "GET",
        Method::HEAD => "HEAD",
        Method::POST => "POST",
        Method::PUT => "PUT",
        Method::DELETE => "DELETE",
        _ => "other",
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn answers_are_counted_by_route_and_status() {
        let metrics = ServerMetrics::default();
        for status in [StatusCode::OK, StatusCode::OK, StatusCode::NOT_FOUND] {
            metrics.count_answer(
                &Method::GET,
                "/v1/ships/{ship}",
                status,
                Duration::from_millis(3),
            );
        }
        metrics.count_answer(
            &Method::from_bytes(b"BREW").unwrap(),
            "none",
            StatusCode::NOT_FOUND,
            Duration::ZERO,
        );
        let mut text = String::new();
        encode_registry(&mut text, &metrics.registry).unwrap();
        let has = |line: &str| assert!(text.lines().any(|other| other == line), "{line}: {text}");
        has(
            r#"sistership_http_requests_total{method="GET",route="/v1/ships/{ship}",status="200"} 2"#,
        );
        has(r#"sistership_http_requests_total{method="other",route="none",status="404"} 1"#);
        has(
            r#"sistership_http_request_duration_seconds_bucket{le="0.0025",method="GET",route="/v1/ships/{ship}"} 0"#,
        );
        has(
            r#"sistership_http_request_duration_seconds_count{method="GET",route="/v1/ships/{ship}"} 3"#,
        );
    }
}
