//! The kinds of models that refinements, and what follows them, make.

use sistership_tests::binary;

use super::place::Place;

/// A kind of model.
pub struct Kind {
    /// What it is, which is also the name of its file.
    pub name: &'static str,
    /// Of how many trials it is made.
    pub trials: usize,
    /// Whether these record roll.
    pub has_roll: bool,
    making: Making,
}

/// How a model is made.
enum Making {
    /// By `refine` with these arguments.
    Refined(&'static [&'static str]),
    /// By `branch` with these arguments beside a refined one.
    Corrected(&'static [&'static str]),
    /// By `estimate`.
    Estimated,
    /// By `diagnose`, of the ship's own model on trials with an offset of the rudder.
    Diagnosed,
}

const fn kind(name: &'static str, trials: usize, has_roll: bool, making: Making) -> Kind {
    Kind { name, trials, has_roll, making }
}

use Making::{Corrected, Diagnosed, Estimated, Refined};

/// Every kind, at one, two, five and twelve trials, in three and four degrees of freedom.
pub const KINDS: &[Kind] = &[
    kind("source-1", 1, false, Refined(&["--source", "mariner"])),
    kind("source-2-roll", 2, true, Refined(&["--source", "sr108", "--method", "weak"])),
    kind("source-5-trajectory", 5, false, Refined(&["--source", "kcs", "--method", "trajectory"])),
    kind("across-laws-2", 2, false, Refined(&["--source", "kvlcc2", "--law", "abkowitz"])),
    kind("law-2", 2, false, Refined(&["--law", "abkowitz", "--method", "weak"])),
    kind("law-5-roll", 5, true, Refined(&["--law", "abkowitz-roll", "--method", "weak"])),
    kind("population-5", 5, false, Refined(POPULATION)),
    kind("default-1", 1, false, Refined(&[])),
    kind("default-5-roll", 5, true, Refined(&[])),
    kind("default-12", 12, false, Refined(&[])),
    kind("forest-12", 12, false, Corrected(&["--kind", "forest"])),
    kind("boosted-12-roll", 12, true, Corrected(&["--kind", "boosted"])),
    kind("kernels-5", 5, false, Corrected(&["--kind", "kernels"])),
    kind("perceptron-2", 2, false, Corrected(&["--kind", "perceptron"])),
    kind("serial-5", 5, false, Corrected(&["--kind", "perceptron", "--mode", "serial"])),
    kind("convert-5", 5, false, Corrected(&["--kind", "boosted", "--mode", "convert"])),
    kind("estimate", 1, false, Estimated),
    kind("diagnosed-2", 2, true, Diagnosed),
];

const POPULATION: &[&str] =
    &["--source", "kcs", "--law", "abkowitz", "--prior", "population", "--method", "weak"];

impl Kind {
    /// Its model file.
    ///
    /// # Errors
    /// What the command that should have made it said.
    pub fn made(&self, place: &Place) -> Result<String, String> {
        let out = place.path(&format!("{}.yaml", self.name));
        let (ship, trials) = (place.path("ship.yaml"), place.seen(self.trials, self.has_roll));
        let refine = ["refine", "--ship", &ship, "--trials", &trials, "--out", &out];
        let settings = place.quick();
        let quick = ["--settings", &settings];
        match self.making {
            // The default call is that of a user; where something is named, little is simulated.
            Refined([]) => run(&refine)?,
            Refined(arguments) => run(&[&refine[..], arguments, &quick].concat())?,
            Corrected(arguments) => {
                let source = if self.has_roll { "sr108" } else { "mariner" };
                let named = ["--source", source, "--method", "weak"];
                run(&[&refine[..], &named, &quick].concat())?;
                let foundation = place.path(&format!("{}-foundation.yaml", self.name));
                std::fs::rename(&out, &foundation).map_err(|error| error.to_string())?;
                let branch = ["branch", "--model", &foundation, "--trials", &trials, "--out", &out];
                run(&[&branch[..], arguments].concat())?;
            }
            Estimated => run(&["estimate", "--ship", &ship, "--out", &out])?,
            Diagnosed => {
                let askew = place.path("roll/askew.yaml");
                run(&["diagnose", "--model", "sr108", "--trials", &askew, "--out", &out])?;
            }
        }
        if std::path::Path::new(&out).is_file() { Ok(out) } else { Err(format!("no {out}")) }
    }
}

fn run(arguments: &[&str]) -> Result<(), String> {
    let output = binary::run(arguments);
    match output.status.success() {
        true => Ok(()),
        false => Err(String::from_utf8_lossy(&output.stderr).into_owned()),
    }
}
