//! A folder with a ship and its trials.

use sistership_cli::sea_trials::TrialManoeuvre;
use sistership_model::Trial;
use sistership_model::trial::Channel;

use crate::sea_trials::{csv, manifest, sailed, ship};

/// Of what is recorded twice a second, one sample in so many.
const EVERY: usize = 6;
/// What the ship sails, in the order in which it is given to refinements.
const PROGRAMME: [TrialManoeuvre; 12] = [
    TrialManoeuvre::Zigzag(20.0, 20.0),
    TrialManoeuvre::Turn(20.0),
    TrialManoeuvre::Zigzag(10.0, 10.0),
    TrialManoeuvre::Turn(-20.0),
    TrialManoeuvre::Turn(12.0),
    TrialManoeuvre::Zigzag(15.0, 15.0),
    TrialManoeuvre::Turn(-12.0),
    TrialManoeuvre::Zigzag(20.0, 10.0),
    TrialManoeuvre::Turn(16.0),
    TrialManoeuvre::Zigzag(10.0, 5.0),
    TrialManoeuvre::Turn(-16.0),
    TrialManoeuvre::Zigzag(12.0, 12.0),
];
/// What no refinement sees.
const LATER: [TrialManoeuvre; 2] = [TrialManoeuvre::Zigzag(15.0, 10.0), TrialManoeuvre::Turn(15.0)];

/// A folder with a ship and its trials.
pub struct Place(tempfile::TempDir);

impl Place {
    pub fn new() -> Self {
        let place = Self(tempfile::tempdir().expect("a temporary folder"));
        place.write("ship.yaml", ship().as_bytes());
        place.write("quick.yaml", b"{ bands: { samples: 10 }, calibration_samples: 1 }\n");
        let seen: Vec<Trial> = sailed(&PROGRAMME, 3).into_iter().map(thin).collect();
        let later: Vec<Trial> = sailed(&LATER, 8).into_iter().map(thin).collect();
        for (has_roll, folder) in [(true, "roll"), (false, "plane")] {
            std::fs::create_dir(place.0.path().join(folder)).expect("a folder");
            for count in [1, 2, 5, 12] {
                place.trials(&format!("{folder}/seen_{count}"), &seen[..count], has_roll);
            }
            place.trials(&format!("{folder}/later"), &later, has_roll);
        }
        let askew: Vec<Trial> = seen[..2].iter().cloned().map(with_offset).collect();
        place.trials("roll/askew", &askew, true);
        place
    }

    /// A file of the folder.
    pub fn path(&self, name: &str) -> String {
        self.0.path().join(name).display().to_string()
    }

    /// Settings of refinements that simulate little beside what is fitted.
    pub fn quick(&self) -> String {
        self.path("quick.yaml")
    }

    /// The manifest of so many trials that refinements see.
    pub fn seen(&self, count: usize, has_roll: bool) -> String {
        self.path(&format!("{}/seen_{count}.yaml", folder(has_roll)))
    }

    /// That of those that they do not.
    pub fn later(&self, has_roll: bool) -> String {
        self.path(&format!("{}/later.yaml", folder(has_roll)))
    }

    fn trials(&self, name: &str, trials: &[Trial], has_roll: bool) {
        let named = trials.iter().enumerate().map(|(k, trial)| {
            let file = format!("{}_{k}.csv", name.rsplit('/').next().unwrap_or(name));
            Trial { name: file, ..trial.clone() }
        });
        let trials: Vec<Trial> =
            named.map(|trial| if has_roll { trial } else { plane(trial) }).collect();
        for trial in &trials {
            self.write(&format!("{}/{}", folder(has_roll), trial.name), &csv(trial));
        }
        self.write(&format!("{name}.yaml"), manifest(&trials).as_bytes());
    }

    fn write(&self, name: &str, bytes: &[u8]) {
        std::fs::write(self.0.path().join(name), bytes).expect("written");
    }
}

/// A trial whose rudder was two degrees off what was recorded.
fn with_offset(mut trial: Trial) -> Trial {
    if let Some(rudder) = trial.channels.get_mut(&Channel::Delta) {
        rudder.iter_mut().for_each(|angle_rad| *angle_rad += 2.0_f64.to_radians());
    }
    trial
}

fn folder(has_roll: bool) -> &'static str {
    if has_roll { "roll" } else { "plane" }
}

fn thin(mut trial: Trial) -> Trial {
    let kept = |samples: &mut Vec<f64>| *samples = samples.iter().copied().step_by(EVERY).collect();
    kept(&mut trial.t_s);
    trial.channels.values_mut().for_each(kept);
    trial
}

/// A trial whose roll nobody recorded.
fn plane(mut trial: Trial) -> Trial {
    trial.channels.retain(|channel, _| !matches!(channel, Channel::Phi | Channel::P));
    trial
}
