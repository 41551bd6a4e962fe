//! Conversion of latitude and longitude to m north and east of the first fix, and of positions of
//! an antenna to midship.

use std::f64::consts::{FRAC_PI_2, TAU};

use geographiclib_rs::{Geodesic, InverseGeodesic};
use sistership_model::trial::Channel;

use crate::declarations::{Antenna, GeographicPosition};
use crate::findings::{Findings, Severity};
use crate::recording::Recording;
use crate::table::RawQuantity;

/// Computes `x` and `y` from fixes, if there are any and positions are not given in m.
pub(crate) fn fixes_to_metres(recording: &mut Recording, findings: &mut Findings) {
    let fixes = (
        recording.raw.remove(&RawQuantity::Latitude),
        recording.raw.remove(&RawQuantity::Longitude),
    );
    let (latitude, longitude) = match fixes {
        (Some(latitude), Some(longitude)) => (latitude, longitude),
        (None, None) => return,
        _ => return findings.error(None, None, "a position needs both latitude and longitude"),
    };
    if recording.channel(Channel::X).is_some() || recording.channel(Channel::Y).is_some() {
        let message = "positions in m are read; latitude and longitude are not";
        return findings.warning(None, None, message);
    }
    // Longitudes may count from 0 to 360 degrees.
    let off = recording.find_samples(0..latitude.len(), |k| {
        latitude[k].abs() > FRAC_PI_2 || longitude[k].abs() > TAU
    });
    if !off.is_empty() {
        findings.report_rows(Severity::Error, RawQuantity::Latitude.name(), &off, |k| {
            let (north, east) = (latitude[k].to_degrees(), longitude[k].to_degrees());
            format!(
                "{north:.4} deg north, {east:.4} deg east is not a position; declare `deg` or \
                     `rad`"
            )
        });
        return;
    }
    project_fixes(recording, &latitude, &longitude, findings);
}

/// Projects fixes by distance and azimuth on the ellipsoid WGS 84 from the first fix, so that
/// distances from there are true.
fn project_fixes(
    recording: &mut Recording,
    latitude: &[f64],
    longitude: &[f64],
    findings: &mut Findings,
) {
    let Some((&north, &east)) = latitude.first().zip(longitude.first()) else { return };
    let (north, east) = (north.to_degrees(), east.to_degrees());
    let earth = Geodesic::wgs84();
    let place = |(latitude, longitude): (&f64, &f64)| {
        let (latitude, longitude) = (latitude.to_degrees(), longitude.to_degrees());
        let (distance, azimuth, _, _): (f64, f64, f64, f64) =
            earth.inverse(north, east, latitude, longitude);
        let (sin, cos) = azimuth.to_radians().sin_cos();
        (distance * cos, distance * sin)
    };
    let (x, y) = latitude.iter().zip(longitude).map(place).unzip();
    recording.trial.channels.insert(Channel::X, x);
    recording.trial.channels.insert(Channel::Y, y);
    // Longitudes that count to 360 degrees are those to the west above 180. To a centimetre: the
    // conversion from radians leaves digits that no instrument has read.
    let round = |degrees: f64| (1e7 * degrees).round() / 1e7;
    let longitude_deg = round((east + 180.0).rem_euclid(360.0) - 180.0);
    recording.origin = Some(GeographicPosition { latitude_deg: round(north), longitude_deg });
    let message = format!(
        "x and y are m north and east of the first fix, {north:.6} deg north and {east:.6} deg east"
    );
    findings.warning(None, None, message);
}

/// Moves positions from the antenna to midship.
pub(crate) fn move_to_midship(
    recording: &mut Recording,
    antenna: Antenna,
    findings: &mut Findings,
) {
    let channels = &mut recording.trial.channels;
    let (Some(mut x), Some(mut y)) = (channels.remove(&Channel::X), channels.remove(&Channel::Y))
    else {
        return;
    };
    match channels.get(&Channel::Psi) {
        Some(psi) => {
            for ((x, y), psi) in x.iter_mut().zip(&mut y).zip(psi) {
                let (sin, cos) = psi.sin_cos();
                // The offset of the antenna, rotated from ship-fixed to earth-fixed axes.
                *x -= antenna.x_m * cos - antenna.y_m * sin;
                *y -= antenna.x_m * sin + antenna.y_m * cos;
            }
        }
        None => {
            let message = "an antenna off midship needs a heading; map `psi`, or remove `antenna`";
            findings.error(None, None, message);
        }
    }
    channels.insert(Channel::X, x);
    channels.insert(Channel::Y, y);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{finding_messages, test_recording};

    fn ship(latitude: &[f64], longitude: &[f64]) -> (Recording, String) {
        let mut ship = test_recording(&[(Channel::Psi, vec![FRAC_PI_2; latitude.len()])]);
        let radians = |degrees: &[f64]| degrees.iter().map(|value| value.to_radians()).collect();
        ship.raw.insert(RawQuantity::Latitude, radians(latitude));
        ship.raw.insert(RawQuantity::Longitude, radians(longitude));
        let mut findings = Findings::default();
        fixes_to_metres(&mut ship, &mut findings);
        (ship, finding_messages(findings))
    }

    #[test]
    fn a_minute_of_latitude_is_a_nautical_mile() {
        let (ship, text) = ship(&[45.0, 45.0 + 1.0 / 60.0, 45.0], &[179.999, 179.999, -179.999]);
        let (x, y) = (&ship.trial.channels[&Channel::X], &ship.trial.channels[&Channel::Y]);
        assert!((x[1] - 1852.2).abs() < 0.2 && y[1].abs() < 1e-6, "{x:?}");
        // Over the date line: 0.002 deg of a parallel whose radius is 4517.6 km.
        assert!((y[2] - 157.69).abs() < 0.01 && x[2].abs() < 0.01, "{y:?}");
        assert_eq!((x[0], y[0]), (0.0, 0.0));
        assert!(text.contains("45.000000 deg north"), "{text}");
        let origin = ship.origin.map(|origin| (origin.latitude_deg, origin.longitude_deg));
        assert!(origin.is_some_and(|(north, east)| north == 45.0 && (east - 179.999).abs() < 1e-9));
    }

    #[test]
    fn what_is_no_place_is_refused() {
        assert!(ship(&[45.0, 91.0, 45.0], &[0.0; 3]).1.contains("error Some(3)"));
    }

    #[test]
    fn an_antenna_is_moved_to_midship() {
        // Heading east, 10 m forward and 2 m to starboard: 10 m east and 2 m south.
        let (mut ship, _) = ship(&[45.0; 3], &[7.0; 3]);
        let antenna = Antenna { x_m: 10.0, y_m: 2.0 };
        let mut findings = Findings::default();
        move_to_midship(&mut ship, antenna, &mut findings);
        let at = |channel| ship.trial.channels[&channel][0];
        assert!((at(Channel::X) - 2.0).abs() < 1e-9 && (at(Channel::Y) + 10.0).abs() < 1e-9);
        ship.trial.channels.remove(&Channel::Psi);
        move_to_midship(&mut ship, antenna, &mut findings);
        assert!(finding_messages(findings).contains("map `psi`"));
    }
}
