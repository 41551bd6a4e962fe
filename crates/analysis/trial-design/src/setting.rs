//! What a plan is made with: the ship, what its trials will record, and the effects that they are
//! to tell apart.

use sistership_diagnosis::forms_of;
use sistership_filtering::EffectCandidate;
use sistership_model::trial::Channel;
use sistership_model::{Model, Trial};
use sistership_simulation::Ship;
use sistership_simulation::state::RECORDED;

use crate::error::PlanError;
use crate::request::PlanRequest;
use crate::thresholds::THRESHOLDS;

/// All of it.
pub(crate) struct Setting {
    /// The model without the effects that are to be told apart.
    pub bare: Model,
    /// The ship, without any effect: what comes from outside turns with the heading.
    pub ship: Ship,
    /// What planned trials are recorded like.
    pub like: Trial,
    /// The forms of the effects.
    pub effects: Vec<EffectCandidate>,
    /// What is said of those that such trials do not show.
    pub remarks: Vec<String>,
}

impl Setting {
    /// What a request needs.
    ///
    /// # Errors
    /// The model does not sail, or its law has no rudder.
    pub fn new(request: &PlanRequest<'_>) -> Result<Self, PlanError> {
        let mut bare = request.model.clone();
        bare.effects.retain(|own| !request.apart.contains(&own.name));
        let ship = ship(request)?;
        let like = like(request, &ship);
        let (mut effects, mut remarks) = (Vec::new(), Vec::new());
        for name in request.apart {
            let forms = forms_of(name, request.model, request.law, request.library, &like);
            if forms.is_empty() {
                remarks.push(format!(
                    "{name}: trials with these records do not show it; give some that do"
                ));
            }
            effects.extend(forms);
        }
        Ok(Self { bare, ship, like, effects, remarks })
    }
}

fn ship(request: &PlanRequest<'_>) -> Result<Ship, PlanError> {
    let calm = Model { effects: Vec::new(), ..request.model.clone() };
    let mut ship = Ship::new(&calm, request.law)?;
    if !ship.has_rudder() {
        return Err(PlanError::NoRudder(request.law.name.clone()));
    }
    ship.set_envelope_speed(ship.approach_speed_m_s());
    Ok(ship)
}

/// What planned trials are recorded like: the first that was sailed, or every motion of the ship,
/// its rudder and revolutions.
fn like(request: &PlanRequest<'_>, ship: &Ship) -> Trial {
    if let Some(first) = request.sailed.first() {
        return (*first).clone();
    }
    let interval_s = THRESHOLDS.interval * ship.lpp_m() / ship.approach_speed_m_s();
    let motions = RECORDED.iter().map(|(channel, _)| *channel);
    let moves =
        |channel: &Channel| ship.has_roll() || !matches!(channel, Channel::Phi | Channel::P);
    let channels = motions.filter(moves).chain([Channel::Delta, Channel::N]);
    Trial {
        name: "planned".into(),
        t_s: vec![0.0, interval_s],
        channels: channels.map(|channel| (channel, vec![0.0; 2])).collect(),
        ..Trial::default()
    }
}
