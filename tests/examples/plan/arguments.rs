//! What is asked for.

/// The command line.
pub struct Arguments {
    pub ships: u64,
    pub seed: u64,
    pub budget_min: f64,
    pub jobs: usize,
}

impl Arguments {
    /// Those of the process.
    ///
    /// # Panics
    /// Where they are wrong.
    pub fn given() -> Self {
        let mut all = Self { ships: 20, seed: 1300, budget_min: 60.0, jobs: 1 };
        let mut given = std::env::args().skip(1);
        while let Some(flag) = given.next() {
            let value: f64 =
                given.next().and_then(|value| value.parse().ok()).expect("a flag with a number");
            match flag.as_str() {
                "--ships" => all.ships = value as u64,
                "--seed" => all.seed = value as u64,
                "--budget" => all.budget_min = value,
                "--jobs" => all.jobs = value as usize,
                _ => panic!("there are --ships, --seed, --budget and --jobs, not {flag}"),
            }
        }
        all
    }
}
