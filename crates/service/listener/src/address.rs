//! Addresses by which connections are counted.

use std::net::{IpAddr, Ipv6Addr};

/// Mask of the part of an IPv6 address that one customer of a network holds.
const NETWORK: u128 = !0 << 64;

/// Returns the address by which a client is counted: an IPv4 address itself; of IPv6 the network of
/// 64 bits, as one client can use any address in it.
pub fn counted_address(address: IpAddr) -> IpAddr {
    match address.to_canonical() {
        IpAddr::V6(v6) if !v6.is_loopback() => Ipv6Addr::from_bits(v6.to_bits() & NETWORK).into(),
        other => other,
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    #[test]
    fn a_network_of_ipv6_is_one_party() {
        let party = |text: &str| super::counted_address(text.parse().unwrap()).to_string();
        assert_eq!(party("::ffff:10.0.0.1"), "10.0.0.1");
        assert_eq!(party("2001:db8::1:2:3:4"), party("2001:db8::9"));
        assert_ne!(party("2001:db8:0:1::1"), party("2001:db8::1"));
        assert_eq!(party("::1"), "::1");
    }
}
