//! W3C trace context: the remote parent of a span, named by the header of a request or the row of
//! a job. Without an exporter of traces there is none.

use std::collections::HashMap;

use opentelemetry::global::get_text_map_propagator;
use tracing::Span;
use tracing_opentelemetry::OpenTelemetrySpanExt as _;

/// Header of requests, and the key of the propagator.
pub const TRACE_PARENT: &str = "traceparent";

/// Makes a span, not yet entered, the child of the span that a `traceparent` names.
pub fn set_remote_parent(span: &Span, parent: Option<&str>) {
    let Some(parent) = parent else { return };
    let carrier = HashMap::from([(TRACE_PARENT.to_owned(), parent.to_owned())]);
    let context = get_text_map_propagator(|propagator| propagator.extract(&carrier));
    // Fails without an exporter.
    let _ = span.set_parent(context);
}

/// Returns the `traceparent` of the present span, if traces are exported.
pub fn current_trace_parent() -> Option<String> {
    let (context, mut carrier) = (Span::current().context(), HashMap::new());
    get_text_map_propagator(|propagator| propagator.inject_context(&context, &mut carrier));
    carrier.remove(TRACE_PARENT)
}
