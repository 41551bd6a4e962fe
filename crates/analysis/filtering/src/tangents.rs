//! Directions in which a model is differentiated.

use sistership_model::law::STATES;
use sistership_simulation::state::at;
use sistership_simulation::tape::Direction;

use super::ResidualSystem;
use super::lanes::LANES;
use super::linearised::Detail;

/// Target of a derivative.
#[derive(Debug, Clone, Copy)]
pub(super) enum Place {
    /// A state of the filter.
    State(usize),
    /// A column.
    Column(usize),
}

/// A direction of differentiation, and the target of its derivative.
pub(super) struct Tangent {
    pub place: Place,
    pub direction: Direction<LANES>,
}

/// Directions of the states, for a whole linearisation, and of those parameters of candidates that
/// have a derivative (`by_derivative`).
pub(super) fn tangents(
    system: &ResidualSystem,
    detail: Detail,
    by_derivative: impl Fn(usize) -> bool,
) -> Vec<Tangent> {
    let states = STATES.iter().enumerate().filter_map(|(input, (name, _))| {
        let place = place_of(name);
        let state = system.states.iter().position(|&state| state == place)?;
        Some((Place::State(state), input))
    });
    // The tape of motion takes states, inputs and then the parameters of the candidates.
    let first = STATES.len() + system.inputs.len();
    let column = |j: usize| (Place::Column(system.columns.nuisance.len() + j), first + j);
    let parameters = (0..system.followed.len()).filter(|&j| by_derivative(j)).map(column);
    let tangent = |(place, input)| Tangent { place, direction: system.motion.tape.along(input) };
    states.filter(|_| detail == Detail::Whole).chain(parameters).map(tangent).collect()
}

/// Index in the state vector of a state that laws know by name.
pub(super) fn place_of(name: &str) -> usize {
    match name {
        "u" => at::U,
        "v" => at::V,
        "r" => at::R,
        "p" => at::P,
        "phi" => at::PHI,
        _ => at::PSI,
    }
}
