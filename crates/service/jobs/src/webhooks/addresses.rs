//! Check of the addresses of webhooks and mail boxes: a server that sends requests to given addresses must not be
//! made to send them into its own network (server-side request forgery; OWASP 2021, A10).

use std::net::{IpAddr, Ipv4Addr, Ipv6Addr};

use lettre::Address;
use reqwest::Url;

/// Endings of names that have no meaning outside of a network (RFC 6761, 6762, 8375; ICANN 2024).
const LOCAL_ENDINGS: [&str; 5] = [".localhost", ".local", ".internal", ".home.arpa", ".lan"];

/// Receiver of events.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Receiver {
    /// A web server.
    Web(Url),
    /// A mail box.
    Mail(Address),
}

/// Parses the address of a receiver: a URL as [`check_url`] takes it, or `mailto:` with one mail
/// box; of a public domain unless private networks are allowed.
///
/// # Errors
/// Returns a message that says what is wrong with it.
pub fn check_receiver(text: &str, private: bool) -> Result<Receiver, String> {
    let Some(mail) = text.strip_prefix("mailto:") else {
        return check_url(text, private).map(Receiver::Web);
    };
    let address: Address = mail.parse().map_err(|_| {
        format!("`{mail}` is not a mail box; write one such as mailto:ann@example.com")
    })?;
    match private || is_public_domain(address.domain()) {
        true => Ok(Receiver::Mail(address)),
        false => Err(format!("{} is not a public domain", address.domain())),
    }
}

/// Returns true if the domain of a mail box is a public name or address.
fn is_public_domain(domain: &str) -> bool {
    // RFC 5321, 4.1.3: an address in brackets, with a tag for IPv6.
    let literal = domain.strip_prefix('[').and_then(|rest| rest.strip_suffix(']'));
    match literal {
        Some(literal) => literal.trim_start_matches("IPv6:").parse().is_ok_and(is_public),
        None => {
            let domain = domain.to_ascii_lowercase();
            domain.contains('.') && !LOCAL_ENDINGS.iter().any(|ending| domain.ends_with(ending))
        }
    }
}

/// Parses the URL of a webhook: https, or also http if private networks are allowed; without name
/// and password.
///
/// # Errors
/// Returns a message that says what is wrong with it.
pub(super) fn check_url(text: &str, private: bool) -> Result<Url, String> {
    let url = Url::parse(text).map_err(|error| format!("is not a URL: {error}"))?;
    // Plain http is for receivers in the same network only.
    let schemes: &[&str] = if private { &["https", "http"] } else { &["https"] };
    if !schemes.contains(&url.scheme()) {
        return Err(format!("must begin with {}://", schemes.join(":// or ")));
    }
    if !url.username().is_empty() || url.password().is_some() {
        return Err(
            "must not contain a user name or password: deliveries are signed instead".to_owned()
        );
    }
    if url.host_str().is_none_or(str::is_empty) {
        return Err("has no host".to_owned());
    }
    // A host name is checked later, by the addresses that it resolves to at each delivery.
    match host_address(&url) {
        Some(address) if !private && !is_public(address) => {
            Err(format!("{address} is not a public address"))
        }
        _ => Ok(url),
    }
}

fn host_address(url: &Url) -> Option<IpAddr> {
    url.host_str()?.trim_matches(['[', ']']).parse().ok()
}

/// Returns true if an address is public by the registries of special addresses (RFC 6890 and IANA's
/// lists for IPv4 and IPv6).
pub(super) fn is_public(address: IpAddr) -> bool {
    match address {
        IpAddr::V4(address) => is_public_v4(address),
        IpAddr::V6(address) => is_public_v6(address),
    }
}

fn is_public_v4(address: Ipv4Addr) -> bool {
    let [a, b, c, _] = address.octets();
    let special = address.is_private()
        || address.is_loopback()
        || address.is_link_local()
        || address.is_documentation()
        || a == 0
        || a >= 224
        || (a == 100 && (64..128).contains(&b))
        || (a == 192 && b == 0 && c == 0)
        || (a == 198 && (18..20).contains(&b));
    !special
}

/// Returns true for global unicast, 2000::/3, without special ranges. An address that embeds an
/// IPv4 address is public if that is.
fn is_public_v6(address: Ipv6Addr) -> bool {
    let segments = address.segments();
    if let Some(inside) = embedded_v4(address) {
        return is_public_v4(inside);
    }
    let documentation = segments[0] == 0x2001 && segments[1] == 0x0db8 || segments[0] == 0x3fff;
    // 2001::/23 is for protocols, Teredo among them.
    let protocols = segments[0] == 0x2001 && segments[1] < 0x0200;
    segments[0] & 0xe000 == 0x2000 && !documentation && !protocols
}

/// Returns the IPv4 address embedded in an IPv6 address: mapped (RFC 4291), translated (RFC 6052),
/// 6to4 (RFC 3056).
fn embedded_v4(address: Ipv6Addr) -> Option<Ipv4Addr> {
    let s = address.segments();
    let v4 = |high: u16, low: u16| Ipv4Addr::from((u32::from(high) << 16) | u32::from(low));
    match s {
        [0x64, 0xff9b, 0, 0, 0, 0, high, low] => Some(v4(high, low)),
        [0x2002, high, low, ..] => Some(v4(high, low)),
        _ => address.to_ipv4_mapped(),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn addresses_of_the_own_network_are_not_public() {
        for private in [
            "127.0.0.1",
            "10.1.2.3",
            "172.16.0.1",
            "192.168.1.1",
            "169.254.169.254",
            "0.0.0.0",
            "100.64.0.1",
            "192.0.0.8",
            "198.18.0.1",
            "224.0.0.1",
            "255.255.255.255",
            "::1",
            "::",
            "fc00::1",
            "fe80::1",
            "ff02::1",
            "::ffff:127.0.0.1",
            "64:ff9b::a9fe:a9fe",
            "2002:7f00:1::",
            "2001:db8::1",
            "2001:0:1::1",
        ] {
            assert!(!is_public(private.parse().unwrap()), "{private}");
        }
        for public in ["1.1.1.1", "172.32.0.1", "100.128.0.1", "2606:4700::1111", "::ffff:8.8.8.8"]
        {
            assert!(is_public(public.parse().unwrap()), "{public}");
        }
    }

    #[test]
    fn mail_boxes_are_of_public_domains() {
        let is_mail =
            |text: &str, private| matches!(check_receiver(text, private), Ok(Receiver::Mail(_)));
        assert!(is_mail("mailto:ann@example.com", false));
        assert!(is_mail("mailto:root@localhost", true));
        let wrong = [
            "ann",
            "a@b@c",
            "root@localhost",
            "ann@host.local",
            "ann@[127.0.0.1]",
            "a@x.y?cc=b@x.y",
        ];
        for box_name in wrong {
            assert!(!is_mail(&format!("mailto:{box_name}"), false), "{box_name}");
        }
        assert!(matches!(check_receiver("https://example.com/", false), Ok(Receiver::Web(_))));
    }

    #[test]
    fn urls_are_taken_or_refused_with_the_reason() {
        let refused = |url: &str, private: bool| check_url(url, private).unwrap_err();
        assert!(check_url("https://example.com/hook?a=1", false).is_ok());
        assert!(check_url("http://127.0.0.1:9000/hook", true).is_ok());
        assert!(refused("http://example.com/", false).contains("https://"));
        assert!(refused("file:///etc/passwd", true).contains("http://"));
        assert!(refused("https://ann:secret@example.com/", false).contains("signed"));
        // Other spellings of 127.0.0.1.
        for url in
            ["https://127.0.0.1/", "https://2130706433/", "https://0x7f.1/", "https://[::1]/"]
        {
            assert!(refused(url, false).contains("not a public address"), "{url}");
        }
    }
}
