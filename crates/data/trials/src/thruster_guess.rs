//! Columns of two thrusters whose commands are known, and their thrust is not.

use sistership_columns::{Identification, RecordingSample};
use sistership_model::manifest::ColumnMapping;

use crate::guess::ColumnGuess;

/// Revolutions, 1/s, that a full command stands for until the manifest says otherwise. The law
/// fits a curve of thrust to the command, so that the figure sets its scale alone; that of small
/// electric thrusters.
pub(crate) const FULL_COMMAND_RPS: f64 = 20.0;

/// Columns of a pair of thrusters.
#[derive(Debug, Clone)]
pub(crate) struct ThrusterColumns {
    /// Channel, and the column that is mapped to it.
    pub columns: [(&'static str, ColumnMapping); 2],
    unit: &'static str,
    places: [usize; 2],
    why: String,
}

impl ThrusterColumns {
    /// Returns the pair that was identified in a recording.
    pub(crate) fn from_identification(
        found: &Identification,
        sample: &RecordingSample,
    ) -> Option<Self> {
        let pair = found.thrusters.as_ref()?;
        let (port, starboard) = pair.columns;
        let values = [port, starboard].map(|at| sample.columns.get(at).map(|one| &one.values[..]));
        let unit = command_unit(values.into_iter().flatten().flatten())?;
        // Where one counts the other way, the difference drives: it follows port where it grows
        // with the speed ahead.
        let against_port = pair.is_opposed && pair.speed_correlation < 0.0;
        let reversed = [against_port, pair.is_opposed && !against_port];
        let mapping = |at: usize, reversed: bool| {
            let header = found.columns.get(at)?.header.as_str();
            Some(ColumnMapping { reversed, ..ColumnMapping::new(header, unit) })
        };
        // A ship turns away from the side of the stronger thrust: where it turns towards the one
        // that is called port, the names of the sides are exchanged.
        let away = if against_port { -pair.yaw_correlation } else { pair.yaw_correlation };
        let is_exchanged = away < 0.0;
        let channels = if is_exchanged { ["n_s", "n_p"] } else { ["n_p", "n_s"] };
        let columns = [
            (channels[0], mapping(port, reversed[0])?),
            (channels[1], mapping(starboard, reversed[1])?),
        ];
        let other = match (pair.is_opposed, is_exchanged) {
            (true, true) => ", one of which counts the other way, with their sides exchanged",
            (true, false) => ", one of which counts the other way",
            (false, true) => " with their sides exchanged",
            (false, false) => "",
        };
        let why = format!(
            "the commands of two thrusters{other}: the yaw rate follows one combination with a \
             correlation of {:.2}, the speed ahead the other with {:.2}",
            pair.yaw_correlation, pair.speed_correlation
        );
        Some(Self { columns, unit, places: [port, starboard], why })
    }

    /// Replaces the guesses of both columns, which have no channel by their names alone.
    pub(crate) fn settle_guesses(&self, guesses: &mut [ColumnGuess]) {
        for (place, (channel, column)) in self.places.iter().zip(&self.columns) {
            let Some(guess) = guesses.get_mut(*place) else { continue };
            *guess = ColumnGuess {
                channel: Some((*channel).to_owned()),
                unit: Some(self.unit.to_owned()),
                reversed: column.reversed,
                probability: 1.0,
                why: self.why.clone(),
                certain: true,
                question: None,
                ..guess.clone()
            };
        }
    }

    /// Formats the remark for readers.
    pub(crate) fn format_note(&self) -> String {
        let [(first, one), (second, other)] = &self.columns;
        format!(
            "`{}` and `{}` are {}. They are read as `{first}` and `{second}`, a full command as \
             {FULL_COMMAND_RPS} 1/s: correct `maximum` of n in the manifest where the revolutions \
             are known",
            one.column, other.column, self.why
        )
    }
}

/// Unit of commands by their range: pulses of a speed controller in us, per cent, or shares of the
/// full command. `None` for values that are none of these.
fn command_unit<'a>(values: impl Iterator<Item = &'a f64>) -> Option<&'static str> {
    let ends = values
        .filter(|value| value.is_finite())
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], value| {
            [least.min(*value), most.max(*value)]
        });
    let within = |least: f64, most: f64| least <= ends[0] && ends[1] <= most;
    let units = [("lever", -1.05, 1.05), ("%", -105.0, 105.0), ("pwm", 800.0, 2200.0)];
    units.into_iter().find(|&(_, least, most)| within(least, most)).map(|(unit, ..)| unit)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_range_of_commands_tells_their_unit() {
        assert_eq!(command_unit([1100.0, 1510.0, 1900.0].iter()), Some("pwm"));
        assert_eq!(command_unit([-0.4, f64::NAN, 1.0].iter()), Some("lever"));
        assert_eq!(command_unit([-40.0, 100.0].iter()), Some("%"));
        assert_eq!(command_unit([-900.0, 900.0].iter()), None);
    }
}
