//! Hash of the samples of a trial, by which one that is given twice is recognised.

use sha2::{Digest, Sha256};

use crate::trial::Trial;

/// Bytes of the hash that are kept: two of a million different trials have the same ones with a
/// probability of 3e-8.
const KEPT: usize = 8;

/// Returns the hash of time and channels, in hexadecimal digits. Name, manoeuvre and warnings are no
/// part of it.
pub fn sample_hash(trial: &Trial) -> String {
    let mut hash = Sha256::new();
    let mut add = |name: &str, values: &[f64]| {
        hash.update(name);
        // The length separates a channel from the next one.
        hash.update((values.len() as u64).to_le_bytes());
        values.iter().for_each(|value| hash.update(value.to_le_bytes()));
    };
    add("t", &trial.t_s);
    trial.channels.iter().for_each(|(channel, values)| add(channel.name(), values));
    hash.finalize()[..KEPT].iter().map(|byte| format!("{byte:02x}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::trial::Channel;

    #[test]
    fn samples_and_no_name_make_the_hash() {
        let trial = |name: &str, last: f64| Trial {
            name: name.to_owned(),
            t_s: vec![0.0, 1.0],
            channels: [(Channel::U, vec![5.0, last])].into(),
            ..Trial::default()
        };
        assert_eq!(sample_hash(&trial("a", 5.1)), sample_hash(&trial("b", 5.1)));
        assert_ne!(sample_hash(&trial("a", 5.1)), sample_hash(&trial("a", 5.2)));
        assert_eq!(sample_hash(&trial("a", 5.1)).len(), 2 * KEPT);
    }
}
