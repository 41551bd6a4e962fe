//! Orders of the manoeuvre, and its surroundings.

use crate::error::{PageError, Result};
use crate::form::FormFields;
use crate::language::{Message, say};
use crate::numbers::format_plain;

/// Longest simulation, s.
const LONGEST_S: f64 = 20_000.0;
/// Largest rudder angle, deg.
const HARD_OVER: f64 = 45.0;
/// Largest depth of water, m.
const DEEPEST_M: f64 = 12_000.0;
/// Largest number of lines of a script.
const MOST_LINES: usize = 500;

/// Kind of manoeuvre.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) enum ManoeuvreKind {
    /// A turning circle.
    #[default]
    Turn,
    /// A zigzag.
    Zigzag,
    /// A script of rudder and revolutions over time.
    Script,
}

impl ManoeuvreKind {
    /// Name in the form.
    pub fn name(self) -> &'static str {
        match self {
            Self::Turn => "turn",
            Self::Zigzag => "zigzag",
            Self::Script => "script",
        }
    }
}

/// Orders of a manoeuvre.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ManoeuvreOrders {
    pub kind: ManoeuvreKind,
    pub rudder_deg: f64,
    pub switch_deg: f64,
    pub speed_m_s: Option<f64>,
    /// Revolutions in 1/min.
    pub n_rpm: Option<f64>,
    pub duration_s: Option<f64>,
    pub script: String,
}

impl Default for ManoeuvreOrders {
    fn default() -> Self {
        Self {
            kind: ManoeuvreKind::Turn,
            rudder_deg: 20.0,
            switch_deg: 20.0,
            speed_m_s: None,
            n_rpm: None,
            duration_s: None,
            script: "0 0\n30 20\n150 20\n160 -10\n400 -10".to_owned(),
        }
    }
}

/// One line of a script: time, s; rudder, rad; revolutions, 1/s, if given.
pub(super) type ScriptLine = (f64, f64, Option<f64>);

impl ManoeuvreOrders {
    pub fn from_fields(fields: &FormFields) -> Result<Self> {
        let default = Self::default();
        let kind = match fields.get_text("kind") {
            None | Some("turn") => ManoeuvreKind::Turn,
            Some("zigzag") => ManoeuvreKind::Zigzag,
            Some("script") => ManoeuvreKind::Script,
            Some(other) => {
                let message = say("playground-wrong-kind").with("text", other);
                return Err(PageError::invalid_field("kind", message));
            }
        };
        // Written so that NaN is refused as well.
        let positive = |name: &str, most: f64| match fields.optional_number(name)? {
            Some(number) if !(number > 0.0 && number <= most) => {
                let message = say("playground-positive").with("most", format_plain(most));
                Err(PageError::invalid_field(name, message))
            }
            number => Ok(number),
        };
        Ok(Self {
            kind,
            rudder_deg: fields.number_within(
                "rudder",
                (-HARD_OVER, HARD_OVER),
                default.rudder_deg,
            )?,
            switch_deg: fields.number_within("switch", (1.0, 90.0), default.switch_deg)?,
            speed_m_s: positive("speed", 40.0)?,
            n_rpm: fields.optional_number("n")?,
            duration_s: positive("duration", LONGEST_S)?,
            script: fields.get_text("script").map_or(default.script, str::to_owned),
        })
    }

    /// Parses the lines of the script, in the order of time.
    ///
    /// # Errors
    /// Returns an error that names the wrong line, or the limit that the script exceeds.
    pub fn script_lines(&self) -> Result<Vec<ScriptLine>> {
        // Empty lines are allowed, but counted: an error names the line of the text.
        let written = self.script.lines().map(str::trim).enumerate();
        let written = written.filter(|(_, line)| !line.is_empty());
        let lines =
            written.map(|(at, text)| parse_line(at + 1, text)).collect::<Result<Vec<_>>>()?;
        let wrong = |message: Message| Err(PageError::invalid_field("script", message));
        match lines.as_slice() {
            [] | [_] => wrong(say("playground-two-lines")),
            many if many.len() > MOST_LINES => {
                wrong(say("playground-many-lines").with("most", MOST_LINES))
            }
            all if all.windows(2).any(|pair| pair[1].0 <= pair[0].0) => {
                wrong(say("playground-times-increase"))
            }
            all if all[all.len() - 1].0 - all[0].0 > LONGEST_S => {
                wrong(say("playground-lasts-longer").with("most", format_plain(LONGEST_S)))
            }
            _ => Ok(lines),
        }
    }
}

fn parse_line(number: usize, text: &str) -> Result<ScriptLine> {
    let cells: Vec<Option<f64>> = text
        .split([' ', '\t', ';'])
        // Separators are spaces, tabs and semicolons, since a comma may be decimal.
        .filter(|cell| !cell.is_empty())
        .map(|cell| cell.replace(',', ".").parse().ok().filter(|value: &f64| value.is_finite()))
        .collect();
    match cells.as_slice() {
        [Some(t), Some(rudder)] if rudder.abs() <= HARD_OVER => Ok((*t, rudder.to_radians(), None)),
        [Some(t), Some(rudder), Some(rpm)] if rudder.abs() <= HARD_OVER => {
            Ok((*t, rudder.to_radians(), Some(rpm / 60.0)))
        }
        _ => {
            let message = say("playground-wrong-line").with("number", number).with("text", text);
            let message = message.with("most", format_plain(HARD_OVER));
            Err(PageError::invalid_field("script", message))
        }
    }
}

/// Current, wind and depth.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Surroundings {
    pub current_m_s: f64,
    pub current_to_deg: f64,
    pub wind_m_s: f64,
    pub wind_from_deg: f64,
    pub depth_m: Option<f64>,
}

impl Surroundings {
    pub fn from_fields(fields: &FormFields) -> Result<Self> {
        let depth_m = match fields.optional_number("depth")? {
            Some(depth) if !(depth > 0.0 && depth <= DEEPEST_M) => {
                let message = say("playground-depth-range").with("most", format_plain(DEEPEST_M));
                return Err(PageError::invalid_field("depth", message));
            }
            depth => depth,
        };
        Ok(Self {
            current_m_s: fields.number_within("current", (0.0, 4.0), 0.0)?,
            current_to_deg: fields.number_within("current_to", (-360.0, 360.0), 0.0)?,
            wind_m_s: fields.number_within("wind", (0.0, 40.0), 0.0)?,
            wind_from_deg: fields.number_within("wind_from", (-360.0, 360.0), 0.0)?,
            depth_m,
        })
    }

    /// Velocity of the water to north and east, m/s.
    pub fn current_vector(&self) -> Option<(f64, f64)> {
        north_east(self.current_m_s, self.current_to_deg)
    }

    /// Components of the wind speed from north and from east, m/s.
    pub fn wind_vector(&self) -> Option<(f64, f64)> {
        north_east(self.wind_m_s, self.wind_from_deg)
    }
}

fn north_east(speed: f64, direction_deg: f64) -> Option<(f64, f64)> {
    // A speed of zero means that the effect is absent.
    let (sin, cos) = direction_deg.to_radians().sin_cos();
    (speed > 0.0).then_some((speed * cos, speed * sin))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn a_script_is_read_line_by_line_or_its_line_is_named() {
        let script = |text: &str| {
            ManoeuvreOrders { script: text.to_owned(), ..ManoeuvreOrders::default() }.script_lines()
        };
        let lines = script("0 0\n\n 60; 20 ;90\n").unwrap();
        assert_eq!(lines[1], (60.0, 20_f64.to_radians(), Some(1.5)));
        for (text, says) in [
            ("0 0\n10 90", "line 2"),
            ("0 0", "two lines"),
            ("0 0\n0 1", "increase"),
            ("0 0\n1e9 1", "longer"),
            ("0 a\n1 1", "line 1"),
        ] {
            assert!(script(text).unwrap_err().to_string().contains(says), "{text}");
        }
    }

    #[test]
    fn current_is_where_it_goes() {
        let around = Surroundings { current_m_s: 2.0, current_to_deg: 90.0, ..Default::default() };
        let (north, east) = around.current_vector().unwrap();
        assert!(north.abs() < 1e-12 && (east - 2.0).abs() < 1e-12);
        assert_eq!(around.wind_vector(), None);
    }
}
