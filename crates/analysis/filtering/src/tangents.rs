//! Directions in which a model is differentiated.

use sistership_model::law::STATES;
use sistership_simulation::state::at;
use sistership_simulation::tape::InputDirection;

use super::ResidualSystem;
use super::lanes::LANES;
use super::linearised::LinearisationDetail;

/// Target of a derivative.
#[derive(Debug, Clone, Copy)]
pub(super) enum DerivativeTarget {
    /// A state of the filter.
    State(usize),
    /// A column.
    Column(usize),
}

/// A direction of differentiation, and the target of its derivative.
pub(super) struct TangentDirection {
    pub place: DerivativeTarget,
    pub direction: InputDirection<LANES>,
}

/// Directions of the states, for a whole linearisation, and of those parameters of candidates that
/// have a derivative (`by_derivative`).
pub(super) fn tangents(
    system: &ResidualSystem,
    detail: LinearisationDetail,
    by_derivative: impl Fn(usize) -> bool,
) -> Vec<TangentDirection> {
    let states = STATES.iter().enumerate().filter_map(|(input, (name, _))| {
        let place = state_index(name);
        let state = system.states.iter().position(|&state| state == place)?;
        Some((DerivativeTarget::State(state), input))
    });
    // The tape of motion takes states, inputs and then the parameters of the candidates.
    let first = STATES.len() + system.inputs.len();
    let column =
        |j: usize| (DerivativeTarget::Column(system.columns.nuisance.len() + j), first + j);
    let parameters = (0..system.followed.len()).filter(|&j| by_derivative(j)).map(column);
    let tangent = |(place, input)| TangentDirection {
        place,
        direction: system.motion.tape.tangent_direction(input),
    };
    states.filter(|_| detail == LinearisationDetail::Whole).chain(parameters).map(tangent).collect()
}

/// Index in the state vector of a state that laws know by name.
pub(super) fn state_index(name: &str) -> usize {
    match name {
        "u" => at::U,
        "v" => at::V,
        "r" => at::R,
        "p" => at::P,
        "phi" => at::PHI,
        _ => at::PSI,
    }
}
