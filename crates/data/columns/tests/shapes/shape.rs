//! Shapes that are made of the given recordings by a seed.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use sistership_columns::{ColumnData, QuantityKind, RecordingSample, Role, Unit};

use crate::names::NAMINGS;
use crate::source::Source;

/// What a column truly is; nothing for one that no channel holds.
pub type Truth = Option<(Role, &'static str, bool)>;

/// A recording in some shape.
pub struct Shape {
    /// The naming, or `no names`.
    pub kind: &'static str,
    pub source: &'static str,
    pub sample: RecordingSample,
    pub truths: Vec<Truth>,
}

/// Metres of a degree, and the place that positions are put at.
const DEGREE_M: f64 = 111_195.0;
const PLACE: (f64, f64) = (63.4, 10.4);

struct Maker {
    random: ChaCha8Rng,
    /// Whether rudders count to port.
    is_port: bool,
}

/// The shape of a seed.
pub fn shape(sources: &[Source], seed: u64, with_names: bool) -> Shape {
    let is_port = seed.is_multiple_of(3);
    let mut maker = Maker { random: ChaCha8Rng::seed_from_u64(seed), is_port };
    // Each of the four sets as often as the others, whatever its number of files.
    let sets = ["gunnerus", "patrol ship", "tank", "catamaran"];
    let set = sets[(seed % 4) as usize];
    let of_set: Vec<&Source> = sources.iter().filter(|source| source.name == set).collect();
    let mut source = of_set[maker.below(of_set.len())].clone();
    maker.cut(&mut source);
    maker.finish_shape(source, with_names)
}

/// A whole recording in the shape of a seed: all recordings of a seed have the same.
pub fn whole_shape(source: &Source, seed: u64) -> Shape {
    let is_port = seed.is_multiple_of(3);
    let mut maker = Maker { random: ChaCha8Rng::seed_from_u64(seed), is_port };
    maker.finish_shape(source.clone(), true)
}

impl Maker {
    fn finish_shape(&mut self, mut source: Source, with_names: bool) -> Shape {
        let set = source.name;
        self.change_frame(&mut source);
        let naming = &NAMINGS[self.below(NAMINGS.len())];
        let mut columns: Vec<(ColumnData, Truth)> = Vec::new();
        let units = self.unit_system();
        let style = self.below(5);
        for (role, values) in &source.columns {
            let header =
                naming.headers.iter().find(|(known, _)| known == role).map_or("?", |row| row.1);
            columns.push(self.column((*role, header), values, &units, style));
        }
        if set == "gunnerus" || set == "catamaran" {
            self.average_heading(&mut columns);
        }
        self.others(&mut columns);
        self.shuffle(&mut columns);
        if !with_names {
            for (at, (column, _)) in columns.iter_mut().enumerate() {
                column.header = format!("#{}", at + 1);
            }
            columns.iter_mut().for_each(|(column, _)| column.below = None);
        }
        let (columns, truths) = columns.into_iter().unzip();
        Shape {
            kind: if with_names { naming.name } else { "no names" },
            source: set,
            sample: RecordingSample { columns, breaks: Vec::new() },
            truths,
        }
    }

    fn below(&mut self, count: usize) -> usize {
        self.random.random_range(0..count)
    }

    fn chance(&mut self, part: f64) -> bool {
        self.random.random_range(0.0..1.0) < part
    }

    /// A window of a long recording.
    fn cut(&mut self, source: &mut Source) {
        let rows = source.columns[0].1.len();
        let count = rows.min(2000);
        let first = self.below(rows - count + 1);
        for (_, values) in &mut source.columns {
            *values = values[first..first + count].to_vec();
        }
    }

    /// Positions as latitude and longitude, speed and course beside or in place of u and v.
    fn change_frame(&mut self, source: &mut Source) {
        let find = |source: &Source, role: Role| {
            source
                .columns
                .iter()
                .find(|(known, _)| *known == role)
                .map(|(_, values)| values.clone())
        };
        if self.chance(0.25) {
            let scale = DEGREE_M * PLACE.0.to_radians().cos();
            for (role, values) in &mut source.columns {
                let (to, each, from) = match role {
                    Role::X => (Role::Latitude, DEGREE_M, PLACE.0),
                    Role::Y => (Role::Longitude, scale, PLACE.1),
                    _ => continue,
                };
                *role = to;
                values.iter_mut().for_each(|value| *value = (*value / each + from).to_radians());
            }
        }
        let (u, v, psi) = (find(source, Role::U), find(source, Role::V), find(source, Role::Psi));
        let (Some(u), Some(v), Some(psi)) = (u, v, psi) else { return };
        let ahead = u.iter().filter(|u| **u > 0.0).count() * 10 > 9 * u.len();
        if ahead && self.chance(0.4) {
            let both = u.iter().zip(&v);
            let speed = both.clone().map(|(u, v)| u.hypot(*v)).collect();
            let turn = std::f64::consts::TAU;
            let course = both.zip(&psi).map(|((u, v), psi)| (psi + v.atan2(*u)).rem_euclid(turn));
            source.columns.push((Role::Speed, speed));
            source.columns.push((Role::Course, course.collect()));
            if self.chance(0.5) {
                source.columns.retain(|(role, _)| !matches!(role, Role::U | Role::V));
            }
        }
    }

    /// The unit of each kind in this recording.
    fn unit_system(&mut self) -> Vec<(QuantityKind, Unit)> {
        let kinds = [
            QuantityKind::Time,
            QuantityKind::Length,
            QuantityKind::Speed,
            QuantityKind::Angle,
            QuantityKind::Rate,
            QuantityKind::Revolutions,
        ];
        kinds
            .into_iter()
            .map(|kind| {
                let most = match kind {
                    QuantityKind::Time => 2,
                    QuantityKind::Length => 1,
                    kind => kind.known_units().len(),
                };
                (kind, kind.known_units()[self.below(most)])
            })
            .collect()
    }

    fn column(
        &mut self,
        (role, header): (Role, &str),
        values: &[f64],
        units: &[(QuantityKind, Unit)],
        style: usize,
    ) -> (ColumnData, Truth) {
        let unit = units.iter().find(|(kind, _)| *kind == role.kind()).map(|row| row.1);
        let mut unit = unit.expect("a unit");
        if matches!(role, Role::Latitude | Role::Longitude) {
            unit = QuantityKind::Angle.known_units()[0];
        }
        let is_rudder = matches!(role, Role::Delta | Role::DeltaS | Role::DeltaP);
        let reversed = is_rudder && self.is_port;
        let sign = if reversed { -1.0 } else { 1.0 };
        let mut values: Vec<f64> = values.iter().map(|value| sign * value / unit.to_si).collect();
        self.round(role, &mut values);
        self.faults(role, &mut values);
        let below = (style == 4).then(|| unit.name.to_owned());
        let header = match style {
            0 => format!("{header} [{}]", unit.name),
            1 => format!("{header} ({})", unit.name),
            2 => format!("{header}_{}", unit.name.replace('/', "_")),
            _ => header.to_owned(),
        };
        let data = ColumnData { header, below, values, written_time: None };
        (data, Some((role, unit.name, reversed)))
    }

    /// Digits as recorders keep them.
    fn round(&mut self, role: Role, values: &mut [f64]) {
        if matches!(role, Role::Latitude | Role::Longitude | Role::Time) {
            return;
        }
        let largest = values.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
        let step = 10_f64.powi((largest.max(1e-9).log10().ceil() as i32) - 5);
        values.iter_mut().for_each(|value| *value = (*value / step).round() * step);
    }

    /// Spikes and lost cells, at most one in two hundred.
    fn faults(&mut self, role: Role, values: &mut [f64]) {
        if role == Role::Time || !self.chance(0.4) {
            return;
        }
        let largest = values.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
        for _ in 0..values.len() / 400 {
            let at = self.below(values.len());
            let spike = largest * self.random.random_range(-1.0..1.0);
            values[at] = if self.chance(0.5) { f64::NAN } else { spike };
        }
    }

    /// Headings averaged across the full turn, as a recorder does.
    fn average_heading(&mut self, columns: &mut [(ColumnData, Truth)]) {
        for (column, truth) in columns {
            let Some((Role::Psi, unit, _)) = truth else { continue };
            let period = if *unit == "deg" { 360.0 } else { std::f64::consts::TAU };
            let values = &mut column.values;
            values.iter_mut().for_each(|value| *value = value.rem_euclid(period));
            for k in 1..values.len() {
                if (values[k] - values[k - 1]).abs() > 0.7 * period {
                    values[k] = 0.5 * (values[k] + values[k - 1]);
                }
            }
        }
    }

    /// Quantities that no channel holds.
    fn others(&mut self, columns: &mut Vec<(ColumnData, Truth)>) {
        let rows = columns[0].0.values.len();
        let data = |header: &str, values: Vec<f64>| ColumnData {
            header: header.to_owned(),
            below: None,
            values,
            written_time: None,
        };
        if self.chance(0.5) {
            columns.push((data("", (0..rows).map(|k| k as f64).collect()), None));
        }
        if self.chance(0.5) {
            let mut temperature = 18.0;
            let values = (0..rows).map(|_| {
                temperature += self.random.random_range(-0.02..0.02);
                (temperature * 10.0_f64).round() / 10.0
            });
            let values = values.collect();
            columns.push((data("Temperature", values), None));
        }
    }

    fn shuffle(&mut self, columns: &mut [(ColumnData, Truth)]) {
        for at in (1..columns.len()).rev() {
            let other = self.below(at + 1);
            columns.swap(at, other);
        }
    }
}
