//! Kinematic relations between the columns of a table: rates of headings and positions by other
//! columns, and integrals of rates and velocities.

use std::iter::zip;

use sistership_model::trial::Channel;

use crate::series::shorter_way;
use crate::table::{ColumnTarget, RawQuantity, TableValues};

/// Mean radius of the earth, m.
pub(crate) const METRES_PER_RADIAN: f64 = 6.371e6;

/// Returns the order in which columns are judged, so that those are known before from which the rate
/// of one is computed: positions last, angles before them.
pub(crate) fn kinematic_order(target: ColumnTarget) -> u8 {
    match target {
        target if is_position(target) => 2,
        ColumnTarget::Channel(Channel::Psi | Channel::Phi) => 1,
        _ => 0,
    }
}

/// Returns true for positions in metres and as latitude and longitude.
pub(crate) fn is_position(target: ColumnTarget) -> bool {
    matches!(
        target,
        ColumnTarget::Channel(Channel::X | Channel::Y)
            | ColumnTarget::Raw(RawQuantity::Latitude | RawQuantity::Longitude)
    )
}

/// Returns the rate of a column by other columns, in SI units and seconds.
pub(crate) fn column_rate(table: &impl TableValues, target: ColumnTarget) -> Option<Vec<f64>> {
    let is_north = match target {
        ColumnTarget::Channel(Channel::Psi) => {
            return table.channel_values(Channel::R).map(Vec::from);
        }
        ColumnTarget::Channel(Channel::Phi) => {
            return table.channel_values(Channel::P).map(Vec::from);
        }
        ColumnTarget::Channel(Channel::X) | ColumnTarget::Raw(RawQuantity::Latitude) => true,
        ColumnTarget::Channel(Channel::Y) | ColumnTarget::Raw(RawQuantity::Longitude) => false,
        _ => return None,
    };
    let mut rate = earth_velocity(table, is_north)?;
    if let ColumnTarget::Raw(_) = target {
        let metres = metres_per_radian(table, is_north);
        rate.iter_mut().for_each(|rate| *rate /= metres);
    }
    Some(rate)
}

/// Returns the velocity north or east, m/s: by velocities north and east, by heading and velocities
/// of the ship, or by course and speed.
fn earth_velocity(table: &impl TableValues, is_north: bool) -> Option<Vec<f64>> {
    let direct = if is_north { RawQuantity::VNorth } else { RawQuantity::VEast };
    if let Some(velocity) = table.raw_values(direct) {
        return Some(velocity.to_vec());
    }
    let part = |angle: &f64| if is_north { angle.cos() } else { angle.sin() };
    let [psi, u, v] = [Channel::Psi, Channel::U, Channel::V].map(|one| table.channel_values(one));
    if let (Some(psi), Some(u), Some(v)) = (psi, u, v) {
        // To starboard is a quarter of a turn beyond the heading.
        let athwart = |angle: &f64| if is_north { -angle.sin() } else { angle.cos() };
        let each = zip(zip(u, v), psi);
        return Some(each.map(|((u, v), psi)| u * part(psi) + v * athwart(psi)).collect());
    }
    let (course, speed) =
        (table.raw_values(RawQuantity::Course)?, table.raw_values(RawQuantity::Speed)?);
    Some(zip(course, speed).map(|(course, speed)| speed * part(course)).collect())
}

/// Returns the integral of a rate or a velocity by other columns: the heading without jumps of
/// whole turns, the roll angle, or the way made good along the ship or athwart.
pub(crate) fn column_integral(table: &impl TableValues, target: ColumnTarget) -> Option<Vec<f64>> {
    let ColumnTarget::Channel(channel) = target else { return None };
    match channel {
        Channel::R => table.channel_values(Channel::Psi).map(continuous_angle),
        Channel::P => table.channel_values(Channel::Phi).map(Vec::from),
        Channel::U => way_made_good(table, 0.0),
        Channel::V => way_made_good(table, std::f64::consts::FRAC_PI_2),
        _ => None,
    }
}

/// Removes jumps of whole turns; a gap stays one.
fn continuous_angle(angle: &[f64]) -> Vec<f64> {
    let mut last: Option<(f64, f64)> = None;
    let follow = |&value: &f64| {
        if !value.is_finite() {
            return f64::NAN;
        }
        let angle = last.map_or(value, |(before, sum)| sum + shorter_way(value - before));
        last = Some((value, angle));
        angle
    };
    angle.iter().map(follow).collect()
}

/// Returns the way made good in a direction relative to the heading, m.
fn way_made_good(table: &impl TableValues, relative: f64) -> Option<Vec<f64>> {
    let psi = table.channel_values(Channel::Psi)?;
    let metres = |channel: Channel, raw: RawQuantity, is_north: bool| {
        let fixes =
            || table.raw_values(raw).map(|values| (values, metres_per_radian(table, is_north)));
        table.channel_values(channel).map(|values| (values, 1.0)).or_else(fixes)
    };
    let (x, north) = metres(Channel::X, RawQuantity::Latitude, true)?;
    let (y, east) = metres(Channel::Y, RawQuantity::Longitude, false)?;
    let mut sum = 0.0;
    let step = |k: usize| {
        let direction = psi[k] + relative;
        let way = (x[k] - x[k - 1]) * north * direction.cos()
            + (y[k] - y[k - 1]) * east * direction.sin();
        if way.is_finite() {
            sum += way;
            sum
        } else {
            f64::NAN
        }
    };
    Some(std::iter::once(0.0).chain((1..psi.len()).map(step)).collect())
}

/// Returns the metres to a radian of latitude, or of longitude at the first latitude.
fn metres_per_radian(table: &impl TableValues, is_north: bool) -> f64 {
    let latitude =
        || table.raw_values(RawQuantity::Latitude)?.iter().copied().find(|one| one.is_finite());
    if is_north { METRES_PER_RADIAN } else { METRES_PER_RADIAN * latitude().unwrap_or(0.0).cos() }
}
