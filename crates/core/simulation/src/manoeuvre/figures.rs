//! List of the named figures of the standard manoeuvres.

use super::StandardManoeuvres;

/// One figure of a manoeuvre or criterion.
#[derive(Debug, Clone, PartialEq)]
pub struct NamedFigure {
    /// Name of the manoeuvre or criterion and of the figure, such as `turn 35 deg: tactical
    /// diameter` or `IMO: advance`.
    pub name: String,
    /// Unit of the value.
    pub unit: String,
    /// Value; absent if the manoeuvre did not reach it.
    pub value: Option<f64>,
    /// True if a criterion is met; absent for figures that are no criterion.
    pub pass: Option<bool>,
}

impl StandardManoeuvres {
    /// Returns every figure, in an order that depends only on the manoeuvres that were simulated.
    pub fn list_figures(&self) -> Vec<NamedFigure> {
        let plain = |name: String, unit: &str, value| NamedFigure {
            name,
            unit: unit.to_owned(),
            value,
            pass: None,
        };
        let mut all = Vec::new();
        for turn in &self.turns {
            let of = |what: &str, value| {
                plain(format!("turn {} deg: {what}", turn.rudder_deg), "m", value)
            };
            all.push(of("advance", turn.advance_m));
            all.push(of("transfer", turn.transfer_m));
            all.push(of("tactical diameter", turn.tactical_diameter_m));
            all.push(of("steady radius", turn.steady_radius_m));
        }
        for zigzag in &self.zigzags {
            let of = |what: &str, unit, value| {
                plain(
                    format!("zigzag {}/{}: {what}", zigzag.rudder_deg, zigzag.switch_deg),
                    unit,
                    value,
                )
            };
            all.push(of("first overshoot", "deg", zigzag.first_overshoot_deg));
            all.push(of("second overshoot", "deg", zigzag.second_overshoot_deg));
            all.push(of("period", "s", zigzag.period_s));
        }
        all.push(plain("initial turning".to_owned(), "m", self.initial_turning_m));
        for criterion in &self.imo {
            let name = format!("IMO: {}", criterion.criterion);
            all.push(NamedFigure {
                name,
                unit: criterion.unit.clone(),
                value: criterion.value,
                pass: criterion.pass,
            });
        }
        all
    }
}
