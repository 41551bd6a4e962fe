//! Context of a design: the ship, the channels of its trials, and the effects that they have to
//! distinguish.

use sistership_diagnosis::observable_forms;
use sistership_filtering::EffectCandidate;
use sistership_model::trial::Channel;
use sistership_model::{Model, Trial};
use sistership_simulation::Ship;
use sistership_simulation::state::RECORDED_CHANNELS;

use crate::error::PlanError;
use crate::request::PlanRequest;
use crate::thresholds::THRESHOLDS;

/// Context of a design.
pub(crate) struct DesignContext {
    /// Model without the effects to be distinguished.
    pub bare: Model,
    /// Ship without any effect: external influences turn with the heading.
    pub ship: Ship,
    /// Trial whose channels and interval planned trials have.
    pub like: Trial,
    /// Forms of the effects.
    pub effects: Vec<EffectCandidate>,
    /// Remarks on effects that such trials do not show.
    pub remarks: Vec<String>,
}

impl DesignContext {
    /// Prepares the context of a request.
    ///
    /// # Errors
    /// Returns an error if the model cannot be simulated, or if its law has no rudder.
    pub fn new(request: &PlanRequest<'_>) -> Result<Self, PlanError> {
        let mut bare = request.model.clone();
        // Effects to be distinguished are unknown, so they are not part of the known model.
        bare.effects.retain(|own| !request.apart.contains(&own.name));
        let ship = calm_ship(request)?;
        let like = template_trial(request, &ship);
        let (mut effects, mut remarks) = (Vec::new(), Vec::new());
        for name in request.apart {
            let forms = observable_forms(name, request.model, request.law, request.library, &like);
            if forms.is_empty() {
                remarks.push(format!(
                    "{name}: cannot be observed with the channels of these trials; give trials \
                     with further channels"
                ));
            }
            effects.extend(forms);
        }
        Ok(Self { bare, ship, like, effects, remarks })
    }
}

fn calm_ship(request: &PlanRequest<'_>) -> Result<Ship, PlanError> {
    let calm = Model { effects: Vec::new(), ..request.model.clone() };
    let mut ship = Ship::new(&calm, request.law)?;
    if !ship.follows_helm() {
        return Err(PlanError::NoRudder(request.law.name.clone()));
    }
    ship.set_envelope_speed(ship.approach_speed_m_s());
    Ok(ship)
}

/// Trial whose channels and interval planned trials have: the first recorded one, or all motions of
/// the ship, its rudder and revolutions.
fn template_trial(request: &PlanRequest<'_>, ship: &Ship) -> Trial {
    if let Some(first) = request.sailed.first() {
        return (*first).clone();
    }
    let interval_s = THRESHOLDS.interval * ship.lpp_m() / ship.approach_speed_m_s();
    let motions = RECORDED_CHANNELS.iter().map(|(channel, _)| *channel);
    let moves =
        |channel: &Channel| ship.has_roll() || !matches!(channel, Channel::Phi | Channel::P);
    let channels = motions.filter(moves).chain([Channel::Delta, Channel::N]);
    // Two samples suffice: only channels and interval are used.
    Trial {
        name: "planned".into(),
        t_s: vec![0.0, interval_s],
        channels: channels.map(|channel| (channel, vec![0.0; 2])).collect(),
        ..Trial::default()
    }
}
