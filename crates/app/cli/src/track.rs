//! CSV files of simulated states, with canonical columns.

use sistership_model::Law;
use sistership_model::trial::{Channel, Trial};
use sistership_simulation::Trajectory;
use sistership_simulation::state::at;
use sistership_trials::samples::to_csv;

use crate::failure::Failure;

/// Channels of every track, in the order of the columns.
const TRACK_CHANNELS: [(Channel, usize); 9] = [
    (Channel::X, at::X),
    (Channel::Y, at::Y),
    (Channel::Psi, at::PSI),
    (Channel::U, at::U),
    (Channel::V, at::V),
    (Channel::R, at::R),
    (Channel::Phi, at::PHI),
    (Channel::P, at::P),
    (Channel::Delta, at::DELTA),
];

/// Returns the bytes of the file; roll only if the law has it, revolutions on request.
///
/// # Errors
/// Returns an error if the samples cannot be written.
pub fn track_csv(track: &Trajectory, law: &Law, with_n: bool) -> Result<Vec<u8>, Failure> {
    let mut trial = Trial { t_s: track.t_s.clone(), ..Trial::default() };
    let is_told =
        |channel: Channel| law.has_roll() || !matches!(channel, Channel::Phi | Channel::P);
    for (channel, index) in TRACK_CHANNELS.into_iter().filter(|(channel, _)| is_told(*channel)) {
        trial.channels.insert(channel, track.state_column(index));
    }
    if with_n {
        trial.channels.insert(Channel::N, track.n_rps.clone());
    }
    let mut bytes = Vec::new();
    to_csv(&mut bytes, &trial).map_err(|error| Failure::Refused(error.to_string()))?;
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use sistership_model::Zoo;
    use sistership_simulation::state::straight_state;

    #[test]
    fn columns_are_canonical_and_those_that_the_law_has() {
        let zoo = Zoo::load_embedded().unwrap();
        let mut track = Trajectory::default();
        track.push(0.0, straight_state(7.0), 1.5);
        let first = |law: &str, n: bool| {
            let text =
                String::from_utf8(track_csv(&track, zoo.law(law).unwrap(), n).unwrap()).unwrap();
            text.lines().next().unwrap().to_owned()
        };
        assert_eq!(first("abkowitz", false), "t_s,x_m,y_m,psi_rad,u_m_s,v_m_s,r_rad_s,delta_rad");
        assert!(first("son-nomoto", true).ends_with("r_rad_s,phi_rad,p_rad_s,delta_rad,n_rps"));
    }
}
