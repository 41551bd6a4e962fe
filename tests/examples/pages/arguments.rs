//! What is asked for.

/// The command line.
pub struct Arguments {
    pub ships: usize,
    pub requests: usize,
}

impl Arguments {
    /// Those of the process.
    ///
    /// # Panics
    /// Where they are wrong.
    pub fn given() -> Self {
        let mut all = Self { ships: 10_000, requests: 15 };
        let mut given = std::env::args().skip(1);
        while let Some(flag) = given.next() {
            let value =
                given.next().and_then(|value| value.parse().ok()).expect("a flag with a number");
            match flag.as_str() {
                "--ships" => all.ships = value,
                "--requests" => all.requests = value,
                _ => panic!("there are --ships and --requests, not {flag}"),
            }
        }
        all
    }
}
