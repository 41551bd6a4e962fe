//! Small uploads one after the other, each diagnosed from what the earlier ones have said.

use sistership_diagnosis::{Diagnosis, EffectHistory, Settings};
use sistership_model::Trial;

use super::baseline::{BASELINE, diagnosed};
use super::cases::programme;
use super::truth::{Hidden, effect, trials};

/// Trials of one upload each, with a rudder offset from one of them on.
#[derive(Debug, Clone, Copy)]
pub struct Uploads {
    pub count: u64,
    /// First upload with the offset, from 1.
    pub first: u64,
    pub offset_rad: f64,
}

impl Uploads {
    /// The trials, in order.
    pub fn trials(self, seed: u64) -> Vec<Trial> {
        let programme = programme();
        let offset = effect("rudder-offset", "constant", &[("offset_rad", self.offset_rad)]);
        let (sound, shifted) =
            (Hidden::default(), Hidden { effects: vec![offset], ..Hidden::default() });
        let one = |upload: u64| {
            let place = (upload % programme.len() as u64) as usize;
            let hidden = if upload + 1 >= self.first { &shifted } else { &sound };
            let sailed = trials(hidden, &programme[place..=place], seed + upload);
            let name = format!("upload {}", upload + 1);
            sailed.into_iter().map(move |trial| Trial { name: name.clone(), ..trial })
        };
        (0..self.count).flat_map(one).collect()
    }
}

/// Diagnoses each trial by itself, from the history of those before.
pub fn in_sequence(all: &[Trial]) -> Vec<Diagnosis> {
    let mut earlier: Option<EffectHistory> = None;
    let one = |trial: &Trial| {
        let settings = Settings { earlier: earlier.take(), ..Settings::default() };
        let diagnosis = diagnosed(&BASELINE, std::slice::from_ref(trial), &settings);
        earlier.clone_from(&diagnosis.history);
        diagnosis
    };
    all.iter().map(one).collect()
}

/// Names of the effects of a diagnosis.
pub fn effect_names(diagnosis: &Diagnosis) -> Vec<&str> {
    diagnosis.effects.iter().map(|found| found.name.as_str()).collect()
}
