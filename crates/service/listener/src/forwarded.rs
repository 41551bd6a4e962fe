//! Address of the client of a request that a proxy has forwarded.

use std::net::IpAddr;
use std::str::FromStr;

use axum::http::HeaderMap;

use crate::address::counted_address;

/// A network of addresses, such as `10.0.0.0/8`; a single address is a network of one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NetworkRange {
    address: IpAddr,
    bits: u32,
}

/// Header in which a trusted proxy states the client's address.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum ForwardedHeader {
    /// `X-Forwarded-For`, by most proxies.
    #[default]
    XForwardedFor,
    /// `Forwarded` (RFC 7239).
    Forwarded,
}

/// Proxies that are trusted to state a client's address.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct TrustedProxies {
    /// Networks of the proxies.
    pub networks: Vec<NetworkRange>,
    /// Header that they write. The other one may come from the client, and is not read.
    pub header: ForwardedHeader,
}

impl NetworkRange {
    fn contains(&self, address: IpAddr) -> bool {
        let same = |mine: u128, other: u128, width: u32| {
            // `checked_shr` refuses a shift by all 128 bits (a prefix of 0 bits): both sides are
            // then 0 and equal.
            let outside = width - self.bits;
            mine.checked_shr(outside).unwrap_or(0) == other.checked_shr(outside).unwrap_or(0)
        };
        // Both are canonical: no network is one of IPv4 addresses mapped into IPv6.
        match (self.address, address.to_canonical()) {
            (IpAddr::V4(mine), IpAddr::V4(other)) => {
                same(mine.to_bits().into(), other.to_bits().into(), 32)
            }
            (IpAddr::V6(mine), IpAddr::V6(other)) => same(mine.to_bits(), other.to_bits(), 128),
            _ => false,
        }
    }

    /// Returns a network of IPv4 addresses mapped into IPv6 as one of IPv4, by which peers are
    /// compared.
    fn into_canonical(self, text: &str) -> Result<Self, String> {
        let address = self.address.to_canonical();
        if address.is_ipv4() == self.address.is_ipv4() {
            return Ok(self);
        }
        // The mapped addresses are `::ffff:0:0/96`; a shorter prefix has other addresses, too.
        let bits = self.bits.checked_sub(96).ok_or_else(|| {
            format!("`{text}` has more than mapped IPv4 addresses; write it as 10.0.0.0/8")
        })?;
        Ok(Self { address, bits })
    }
}

impl FromStr for NetworkRange {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || {
            format!(
                "`{text}` is not a network; write it as 10.0.0.0/8, or give one \
                                address"
            )
        };
        let (address, bits) =
            text.split_once('/').map_or((text, None), |(address, bits)| (address, Some(bits)));
        let address: IpAddr = address.parse().map_err(|_| wrong())?;
        let width = if address.is_ipv4() { 32 } else { 128 };
        let bits = bits.map_or(Ok(width), str::parse).map_err(|_| wrong())?;
        if bits > width { Err(wrong()) } else { Self { address, bits }.into_canonical(text) }
    }
}

impl FromStr for ForwardedHeader {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text.to_ascii_lowercase().as_str() {
            "x-forwarded-for" => Ok(Self::XForwardedFor),
            "forwarded" => Ok(Self::Forwarded),
            _ => Err(format!("choose x-forwarded-for or forwarded, not `{text}`")),
        }
    }
}

impl TrustedProxies {
    /// Returns the address by which a request is counted: the peer or, if that is a trusted proxy,
    /// the last address of the header that is not a trusted proxy.
    pub fn client_address(&self, peer: IpAddr, headers: &HeaderMap) -> IpAddr {
        let mut client = peer;
        let mut hops = self.header_addresses(headers);
        // From the last hop backwards; the first address that is not a trusted proxy is the client.
        // Addresses before it were written by the client itself and prove nothing.
        while self.is_trusted(client) {
            match hops.pop().and_then(|hop| parse_address(&hop)) {
                Some(before) => client = before,
                None => break,
            }
        }
        counted_address(client)
    }

    fn is_trusted(&self, address: IpAddr) -> bool {
        self.networks.iter().any(|network| network.contains(address))
    }

    /// Returns the addresses of the header, that of the last proxy last.
    fn header_addresses(&self, headers: &HeaderMap) -> Vec<String> {
        let name = match self.header {
            ForwardedHeader::XForwardedFor => "x-forwarded-for",
            ForwardedHeader::Forwarded => "forwarded",
        };
        let values = headers.get_all(name).iter().filter_map(|value| value.to_str().ok());
        let elements = values.flat_map(|value| value.split(','));
        match self.header {
            ForwardedHeader::XForwardedFor => elements.map(str::to_owned).collect(),
            ForwardedHeader::Forwarded => elements.map(forwarded_for).collect(),
        }
    }
}

/// Returns the parameter `for` of an element of `Forwarded`; empty if it has none.
fn forwarded_for(element: &str) -> String {
    let pairs = element.split(';').filter_map(|pair| pair.split_once('='));
    let mut named = pairs.filter(|(name, _)| name.trim().eq_ignore_ascii_case("for"));
    named.next().map_or_else(String::new, |(_, node)| node.trim().trim_matches('"').to_owned())
}

/// Parses the address of a node, with or without a port.
fn parse_address(node: &str) -> Option<IpAddr> {
    let node = node.trim();
    let bracketed = node.strip_prefix('[').and_then(|rest| rest.split(']').next());
    let plain = bracketed.unwrap_or(node);
    let without_port = || plain.split_once(':').and_then(|(address, _)| address.parse().ok());
    plain.parse().ok().or_else(without_port)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn client(header: ForwardedHeader, peer: &str, values: &[(&'static str, &str)]) -> String {
        let networks = ["10.0.0.0/8", "2001:db8::/32"].map(|network| network.parse().unwrap());
        let proxies = TrustedProxies { networks: networks.into(), header };
        let mut headers = HeaderMap::new();
        for (name, value) in values {
            headers.append(*name, value.parse().unwrap());
        }
        proxies.client_address(peer.parse().unwrap(), &headers).to_string()
    }

    #[test]
    fn the_last_address_that_is_no_proxy_is_the_client() {
        use ForwardedHeader::{Forwarded, XForwardedFor};
        let xff = "x-forwarded-for";
        for (peer, values, expected) in [
            ("10.0.0.1", vec![(xff, "192.0.2.7")], "192.0.2.7"),
            // What the client wrote itself stands before what a proxy has added.
            ("10.0.0.1", vec![(xff, "1.1.1.1, 192.0.2.7, 10.9.9.9")], "192.0.2.7"),
            ("10.0.0.1", vec![(xff, "1.1.1.1"), (xff, "192.0.2.8:1234")], "192.0.2.8"),
            ("10.0.0.1", vec![(xff, "unknown")], "10.0.0.1"),
            ("10.0.0.1", vec![(xff, "10.0.0.2")], "10.0.0.2"),
            ("10.0.0.1", vec![("forwarded", "for=192.0.2.7")], "10.0.0.1"),
            ("192.0.2.1", vec![(xff, "1.1.1.1")], "192.0.2.1"),
            ("::ffff:10.0.0.1", vec![(xff, "[2003::1]:80")], "2003::"),
            ("2001:db8::9", vec![(xff, "192.0.2.7")], "192.0.2.7"),
        ] {
            assert_eq!(client(XForwardedFor, peer, &values), expected, "{values:?}");
        }
        let value = r#"for=1.1.1.1, for="[2003::1]:47";proto=https, proto=http;For=10.0.0.2"#;
        assert_eq!(client(Forwarded, "10.0.0.1", &[("forwarded", value)]), "2003::");
        assert_eq!(client(Forwarded, "10.0.0.1", &[(xff, "1.1.1.1")]), "10.0.0.1");
    }

    #[test]
    fn networks_are_read() {
        let any: NetworkRange = "0.0.0.0/0".parse().unwrap();
        assert!(any.contains([9, 9, 9, 9].into()));
        let one: NetworkRange = "10.1.2.3".parse().unwrap();
        assert!(one.contains([10, 1, 2, 3].into()) && !one.contains([10, 1, 2, 4].into()));
        let mapped: NetworkRange = "::ffff:10.0.0.0/104".parse().unwrap();
        assert_eq!(mapped, "10.0.0.0/8".parse().unwrap());
        assert!(mapped.contains([10, 1, 2, 3].into()) && !mapped.contains([11, 1, 2, 3].into()));
        assert!(mapped.contains("::ffff:10.1.2.3".parse().unwrap()));
        let one: NetworkRange = "::ffff:10.1.2.3".parse().unwrap();
        assert!(one.contains([10, 1, 2, 3].into()) && !one.contains([10, 1, 2, 4].into()));
        let short = "::ffff:10.0.0.0/90".parse::<NetworkRange>().unwrap_err();
        assert!(short.contains("write it as"), "{short}");
        for wrong in ["10.0.0.0/33", "10.0.0/8", "::/129", "proxy", "10.0.0.0/"] {
            assert!(wrong.parse::<NetworkRange>().is_err(), "{wrong}");
        }
    }
}
