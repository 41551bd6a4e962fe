//! Checks of behaviour that every ship has, whatever its law: it keeps its course, slows down when
//! driven too fast, turns to the side of its rudder, loses speed in the turn, and does so nearly
//! alike on both sides.

use sistership_simulation::Ship;
use sistership_simulation::manoeuvre::{
    Manoeuvre, ManoeuvreSettings, SimulatedManoeuvre, simulate_manoeuvre_batch,
};
use sistership_simulation::metrics::TurningMetrics;
use sistership_simulation::state::{at, horizontal_speed};

use crate::validation::appraisal::ModelAppraisal;
use crate::validation::finding::ReviewFinding;
use crate::validation::limits::{
    FIRST_OVERSHOOTS_DEG, HEADING_KEPT_DEG, SIDES_SHARE, SPEED_KEPT_SHARE, TACTICAL_DIAMETERS,
};

/// Length of the straight runs, ship lengths.
const STRAIGHT_LENGTHS: f64 = 10.0;

/// Checks the behaviour of a model; `appraisal` has its standard manoeuvres.
pub fn check_physics(ship: &Ship, appraisal: &ModelAppraisal) -> Vec<ReviewFinding> {
    let about = format!("models.{}", model_name(&appraisal.model));
    let failures = appraisal.manoeuvres.failures.iter();
    let mut found: Vec<ReviewFinding> = failures
        .map(|failure| ReviewFinding::refused(&about, format!("cannot be simulated: {failure}")))
        .collect();
    found.extend(straight_findings(ship, &about));
    found.extend(drag_finding(ship, &about));
    found.extend(
        appraisal.manoeuvres.turns.iter().flat_map(|turn| turning_findings(ship, turn, &about)),
    );
    found.extend(side_finding(&appraisal.manoeuvres.turns, &about));
    found.extend(overshoot_findings(appraisal, &about));
    found
}

fn model_name(model: &str) -> &str {
    model.split_once('/').map_or(model, |(_, name)| name)
}

/// A run with the rudder amidships at the model's own revolutions, from a share of its approach
/// speed.
fn straight_run(ship: &Ship, share_of_speed: f64) -> Result<SimulatedManoeuvre, String> {
    let own = ship.approach_speed_m_s();
    let settings = ManoeuvreSettings {
        speed_m_s: Some(share_of_speed * own),
        n_rps: Some(ship.revolutions_at(own)),
        duration_s: Some(STRAIGHT_LENGTHS * ship.lpp_m() / own),
        ..ManoeuvreSettings::default()
    };
    let ahead = (Manoeuvre::Turn { rudder: 0.0 }, &[][..]);
    simulate_manoeuvre_batch(ship, &[ahead], &settings)
        .remove(0)
        .map_err(|stopped| stopped.to_string())
}

fn straight_findings(ship: &Ship, about: &str) -> Vec<ReviewFinding> {
    let sailed = match straight_run(ship, 1.0) {
        Ok(sailed) => sailed,
        Err(stopped) => {
            return vec![ReviewFinding::refused(about, format!("straight running: {stopped}"))];
        }
    };
    let Some(last) = sailed.after.last() else { return Vec::new() };
    let own = ship.approach_speed_m_s();
    let mut found = Vec::new();
    let changed = horizontal_speed(last) / own - 1.0;
    // At its own revolutions a balanced model keeps its approach speed.
    if changed.abs() > SPEED_KEPT_SHARE {
        let message = format!(
            "with the rudder amidships the speed changes by {:.0} % in {STRAIGHT_LENGTHS} \
             lengths: check that thrust and resistance balance at {own} m/s and its revolutions",
            100.0 * changed
        );
        found.push(ReviewFinding::for_review(about, message));
    }
    let turned = last[at::PSI].to_degrees();
    if turned.abs() > HEADING_KEPT_DEG {
        let message = format!(
            "with the rudder amidships the heading changes by {turned:.1} deg in \
             {STRAIGHT_LENGTHS} lengths: check that this asymmetry is intended"
        );
        found.push(ReviewFinding::for_review(about, message));
    }
    found
}

/// Finding if a ship above its approach speed, at the revolutions of the approach, does not slow
/// down.
fn drag_finding(ship: &Ship, about: &str) -> Option<ReviewFinding> {
    let fast = straight_run(ship, 1.1).ok()?;
    let slow = straight_run(ship, 0.9).ok()?;
    let ended = |sailed: &SimulatedManoeuvre| sailed.after.last().map(horizontal_speed);
    let (from_fast, from_slow) = (ended(&fast)?, ended(&slow)?);
    let own = ship.approach_speed_m_s();
    let apart = from_fast - from_slow;
    // Runs from 1.1 and 0.9 of the speed begin 0.2 of it apart; resistance that grows with speed
    // brings them together.
    if from_fast.is_finite() && apart < 0.2 * own * 0.999 {
        return None;
    }
    let message = format!(
        "simulations from 1.1 and 0.9 times {own} m/s differ by {apart:.3} m/s after \
         {STRAIGHT_LENGTHS} lengths: resistance does not increase with speed; check the sign of \
         X_u"
    );
    Some(ReviewFinding::refused(about, message))
}

fn turning_findings(ship: &Ship, turn: &TurningMetrics, about: &str) -> Vec<ReviewFinding> {
    let mut found = Vec::new();
    let name = format!("turn {} deg", turn.rudder_deg);
    // A turn to the wrong side never reaches 180 deg to the side of the rudder.
    match turn.tactical_diameter_m {
        None => found.push(ReviewFinding::refused(
            about,
            format!(
                "{name}: the heading does not change by 180 deg to the side of the rudder; check \
                 `rudder_positive`"
            ),
        )),
        Some(diameter) => {
            let lengths = diameter / ship.lpp_m();
            if !TACTICAL_DIAMETERS.contains(&lengths) {
                let message = format!("{name}: tactical diameter {lengths:.2} L");
                found.push(ReviewFinding::for_review(about, message));
            }
        }
    }
    if turn.speed_loss_m_s < 0.0 {
        let message = format!("{name}: the ship gains {:.3} m/s in the turn", -turn.speed_loss_m_s);
        found.push(ReviewFinding::refused(about, message));
    }
    found
}

fn side_finding(turns: &[TurningMetrics], about: &str) -> Option<ReviewFinding> {
    let diameter = |starboard: bool| {
        let side = |turn: &&TurningMetrics| (turn.rudder_deg > 0.0) == starboard;
        turns.iter().find(side)?.tactical_diameter_m
    };
    let (starboard, port) = (diameter(true)?, diameter(false)?);
    // Relative to the mean of both sides.
    let apart = (starboard - port).abs() / (0.5 * (starboard + port));
    (apart > SIDES_SHARE).then(|| {
        let message = format!(
            "tactical diameter {starboard:.1} m to starboard, {port:.1} m to port: a difference \
             of {:.0} %",
            100.0 * apart
        );
        ReviewFinding::for_review(about, message)
    })
}

fn overshoot_findings(appraisal: &ModelAppraisal, about: &str) -> Vec<ReviewFinding> {
    let odd = |zigzag: &&sistership_simulation::metrics::ZigzagMetrics| {
        zigzag.first_overshoot_deg.is_none_or(|angle| !FIRST_OVERSHOOTS_DEG.contains(&angle))
    };
    let said = |zigzag: &sistership_simulation::metrics::ZigzagMetrics| {
        let angle =
            zigzag.first_overshoot_deg.map_or("none".into(), |angle| format!("{angle:.1} deg"));
        let name = format!("zigzag {}/{}", zigzag.rudder_deg, zigzag.switch_deg);
        ReviewFinding::for_review(about, format!("{name}: first overshoot {angle}"))
    };
    appraisal.manoeuvres.zigzags.iter().filter(odd).map(said).collect()
}
