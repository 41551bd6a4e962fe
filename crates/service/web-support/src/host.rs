//! Target of a request (`Host`), and its origin as stated by a browser.

use std::net::IpAddr;

use axum::extract::Request;
use axum::http::uri::Authority;
use axum::http::{HeaderMap, HeaderName, Method, StatusCode, Version, header};

use crate::problem::{Problem, Result};

const SEC_FETCH_SITE: HeaderName = HeaderName::from_static("sec-fetch-site");

/// Returns the authority to which a request is addressed: exactly one (RFC 9112, 3.2). HTTP/1.0 has
/// no `Host`, and no browser uses it: there it may be missing.
pub fn request_authority(request: &Request) -> Result<Option<Authority>> {
    let host = single_header(request.headers(), &header::HOST)?;
    let host = host.map(|host| host.parse::<Authority>().map_err(|_| wrong_host())).transpose()?;
    if host.as_ref().is_some_and(|host| host.as_str().contains('@')) {
        return Err(wrong_host());
    }
    if host.is_none() && request.version() >= Version::HTTP_11 {
        return Err(Problem::bad_request(
            "the header `Host` is missing; send one, with the name or address and the port",
        ));
    }
    // A target with an authority (a proxy's form) must agree with `Host`.
    match (request.uri().authority(), host) {
        (Some(target), Some(host)) if *target != host => Err(Problem::bad_request(
            "the header `Host` differs from the host in the request's target; send the same in \
             both",
        )),
        (_, host) => Ok(host),
    }
}

fn wrong_host() -> Problem {
    Problem::bad_request(
        "the header `Host` must be a name or an address with an optional port, such as \
         localhost:8080",
    )
}

/// Returns the value of a header that may occur once.
pub fn single_header<'a>(headers: &'a HeaderMap, name: &HeaderName) -> Result<Option<&'a str>> {
    let mut values = headers.get_all(name).iter();
    let first = values.next();
    if values.next().is_some() {
        return Err(Problem::bad_request(format!(
            "the header `{name}` was sent more than once; send it once"
        )));
    }
    let text = |value: &'a axum::http::HeaderValue| {
        value.to_str().map_err(|_| {
            Problem::bad_request(format!(
                "the header `{name}` must be of printable ASCII characters"
            ))
        })
    };
    first.map(text).transpose()
}

/// Checks that a request comes from this machine, on a server without an API key. Web pages of
/// other sites in a browser on this machine must not reach the server, neither by a host name that
/// points here (`Host`) nor by forms (`Origin`, `Sec-Fetch-Site`).
pub fn check_local_origin(
    method: &Method,
    headers: &HeaderMap,
    host: Option<&Authority>,
) -> Result<()> {
    if let Some(host) = host.filter(|host| !is_local(host.host())) {
        return Err(forbidden_problem(format!(
            "without an API key this server answers to localhost only, not to `{host}`"
        )));
    }
    let (origin, site) =
        (single_header(headers, &header::ORIGIN)?, single_header(headers, &SEC_FETCH_SITE)?);
    if method.is_safe() {
        return Ok(());
    }
    if let Some(origin) = origin.filter(|origin| !is_own(origin, host)) {
        return Err(forbidden_problem(format!(
            "without an API key this server accepts no changes from the web site `{origin}`"
        )));
    }
    // `none` is a request by a person, typed or from a bookmark.
    match site.filter(|site| !["same-origin", "none"].contains(site)) {
        Some(site) => Err(forbidden_problem(format!(
            "without an API key this server accepts no changes from other web sites \
             (Sec-Fetch-Site: {site})"
        ))),
        None => Ok(()),
    }
}

/// Returns true if a browser states that the request comes from a page of this server. The scheme
/// may differ where a proxy is in front of the server.
pub fn is_same_origin(headers: &HeaderMap, host: Option<&Authority>) -> Result<bool> {
    let (origin, site) =
        (single_header(headers, &header::ORIGIN)?, single_header(headers, &SEC_FETCH_SITE)?);
    let authority = origin.and_then(|origin| origin.split_once("://")).map(|(_, own)| own);
    let own =
        authority.zip(host).is_some_and(|(own, host)| own.eq_ignore_ascii_case(host.as_str()));
    Ok(own && site.is_none_or(|site| site == "same-origin"))
}

fn forbidden_problem(detail: String) -> Problem {
    Problem::new(StatusCode::FORBIDDEN, detail)
}

/// Returns true if an origin is this server: scheme, name and port (RFC 6454). The server itself
/// uses http; one that is reached by https is behind a proxy, and has a key.
fn is_own(origin: &str, host: Option<&Authority>) -> bool {
    let Some((scheme, authority)) = origin.split_once("://") else { return false };
    let (Ok(authority), Some(host)) = (authority.parse::<Authority>(), host) else { return false };
    // The default port of http; https is not served here.
    let port = |authority: &Authority| authority.port_u16().unwrap_or(80);
    scheme.eq_ignore_ascii_case("http")
        && authority.host().eq_ignore_ascii_case(host.host())
        && port(&authority) == port(host)
}

fn is_local(host: &str) -> bool {
    let name = host.strip_prefix('[').and_then(|rest| rest.strip_suffix(']')).unwrap_or(host);
    name.eq_ignore_ascii_case("localhost") || name.parse().is_ok_and(|ip: IpAddr| ip.is_loopback())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn headers(pairs: &[(&'static str, &str)]) -> HeaderMap {
        let mut all = HeaderMap::new();
        for (name, value) in pairs {
            all.append(*name, value.parse().unwrap());
        }
        all
    }

    fn addressed_as(version: Version, target: &str, hosts: &[&str]) -> Result<Option<Authority>> {
        let pairs: Vec<_> = hosts.iter().map(|host| ("host", *host)).collect();
        let mut request = Request::builder()
            .version(version)
            .uri(target)
            .body(axum::body::Body::empty())
            .unwrap();
        *request.headers_mut() = headers(&pairs);
        request_authority(&request)
    }

    #[test]
    fn a_request_has_one_host() {
        let of = |hosts: &[&str]| {
            addressed_as(Version::HTTP_11, "/", hosts).map_err(|problem| problem.status)
        };
        assert!(of(&["localhost:8080"]).is_ok() && of(&["[::1]:80"]).is_ok());
        for wrong in [
            &[][..],
            &["localhost", "localhost"],
            &["localhost", "evil.example"],
            &[""],
            &["a b"],
            &["me@localhost"],
        ] {
            assert_eq!(of(wrong), Err(400), "{wrong:?}");
        }
        assert_eq!(addressed_as(Version::HTTP_10, "/", &[]), Ok(None));
        assert!(addressed_as(Version::HTTP_10, "/", &["a", "b"]).is_err());
        assert!(addressed_as(Version::HTTP_11, "http://localhost/", &["LOCALHOST"]).is_ok());
        assert!(addressed_as(Version::HTTP_11, "http://evil.example/", &["localhost"]).is_err());
    }

    #[test]
    fn a_form_of_this_server_is_told_from_others() {
        let host = "ships.example".parse().unwrap();
        let own =
            |pairs: &[(&'static str, &str)]| is_same_origin(&headers(pairs), Some(&host)).unwrap();
        assert!(own(&[("origin", "https://ships.example"), ("sec-fetch-site", "same-origin")]));
        assert!(own(&[("origin", "http://Ships.example")]));
        for other in [
            &[][..],
            &[("sec-fetch-site", "same-origin")],
            &[("origin", "null")],
            &[("origin", "https://evil.example")],
            &[("origin", "https://ships.example:8443")],
            &[("origin", "https://ships.example"), ("sec-fetch-site", "cross-site")],
        ] {
            assert!(!own(other), "{other:?}");
        }
    }

    #[test]
    fn without_a_key_other_sites_are_kept_out() {
        let asks = |method: Method, host: &str, pairs: &[(&'static str, &str)]| {
            check_local_origin(&method, &headers(pairs), Some(&host.parse().unwrap()))
                .map_err(|problem| problem.status)
        };
        for host in ["localhost:8080", "127.0.0.1:1", "[::1]:80", "LOCALHOST"] {
            assert_eq!(asks(Method::GET, host, &[]), Ok(()), "{host}");
        }
        assert_eq!(asks(Method::GET, "evil.example", &[]), Err(403));
        let changes = |pairs: &[(&'static str, &str)]| asks(Method::POST, "127.0.0.1:8080", pairs);
        for allowed in [
            &[][..],
            &[("origin", "http://127.0.0.1:8080")],
            &[("sec-fetch-site", "same-origin")],
            &[("sec-fetch-site", "none")],
            &[("origin", "http://127.0.0.1:8080"), ("sec-fetch-site", "same-origin")],
        ] {
            assert_eq!(changes(allowed), Ok(()), "{allowed:?}");
        }
        for refused in [
            ("origin", "http://evil.example"),
            ("origin", "https://127.0.0.1:8080"),
            ("origin", "http://127.0.0.1:8081"),
            ("origin", "127.0.0.1:8080"),
            ("origin", "null"),
            ("sec-fetch-site", "cross-site"),
            ("sec-fetch-site", "same-site"),
        ] {
            assert_eq!(changes(&[refused]), Err(403), "{refused:?}");
        }
        assert_eq!(
            changes(&[("origin", "http://127.0.0.1:8080"), ("origin", "http://evil.example")]),
            Err(400)
        );
        assert_eq!(asks(Method::POST, "localhost", &[("origin", "http://localhost:80")]), Ok(()));
        assert_eq!(
            asks(Method::GET, "localhost", &[("sec-fetch-site", "cross-site")]),
            Ok(()),
            "a link from elsewhere"
        );
    }
}
