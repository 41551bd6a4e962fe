//! Content negotiation by the header `Accept`.

use axum::http::{HeaderMap, StatusCode, header};

use crate::problem::{Problem, Result};

/// Returns the offered media type that the caller prefers; the first one if the header is absent.
pub fn choose_media(headers: &HeaderMap, offered: &[&'static str]) -> Result<&'static str> {
    let lines = headers.get_all(header::ACCEPT).into_iter().filter_map(|value| value.to_str().ok());
    let accepted: Vec<(&str, f64)> =
        lines.flat_map(|line| line.split(',')).map(parse_range).collect();
    if accepted.is_empty() {
        return offered.first().copied().ok_or_else(|| Problem::internal("no format is available"));
    }
    let mut best: Option<(&'static str, f64)> = None;
    for media in offered {
        let quality = media_quality(&accepted, media);
        // Strictly greater: of equally preferred forms the first offered one is taken.
        if quality > 0.0 && best.is_none_or(|(_, most)| quality > most) {
            best = Some((media, quality));
        }
    }
    let refusal = || {
        Problem::new(
            StatusCode::NOT_ACCEPTABLE,
            format!("this is available as {}", offered.join(", ")),
        )
    };
    best.map(|(media, _)| media).ok_or_else(refusal)
}

/// Parses a media range and its quality (default 1).
fn parse_range(text: &str) -> (&str, f64) {
    let mut parts = text.split(';').map(str::trim);
    let media = parts.next().unwrap_or_default();
    let quality =
        parts.find_map(|part| part.strip_prefix("q=")).and_then(|q| q.parse().ok()).unwrap_or(1.0);
    (media, quality)
}

/// Returns the quality that the most specific matching range gives a media type; 0 if none matches.
fn media_quality(accepted: &[(&str, f64)], media: &str) -> f64 {
    let family = format!("{}/*", media.split('/').next().unwrap_or_default());
    let of = |wanted: &str| {
        accepted.iter().find(|(range, _)| range.eq_ignore_ascii_case(wanted)).map(|&(_, q)| q)
    };
    of(media).or_else(|| of(&family)).or_else(|| of("*/*")).unwrap_or(0.0)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn chosen(accept: &str) -> Result<&'static str> {
        choose_media(
            &HeaderMap::from_iter([(header::ACCEPT, accept.parse().unwrap())]),
            &["application/json", "text/html"],
        )
    }

    #[test]
    fn the_best_liked_form_is_taken() {
        assert_eq!(choose_media(&HeaderMap::new(), &["a/b"]).unwrap(), "a/b");
        assert_eq!(chosen("*/*").unwrap(), "application/json");
        assert_eq!(chosen("text/html,application/xml;q=0.9,*/*;q=0.8").unwrap(), "text/html");
        assert_eq!(chosen("text/*;q=0.1, application/json;q=0").unwrap(), "text/html");
        assert_eq!(chosen("image/png").unwrap_err().status, 406);
    }
}
