//! Quantities that a column may hold.

/// A quantity of a recording.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Role {
    /// Time.
    Time,
    /// Position north.
    X,
    /// Position east.
    Y,
    /// Latitude.
    Latitude,
    /// Longitude.
    Longitude,
    /// Heading, clockwise from north.
    Psi,
    /// Surge velocity over ground.
    U,
    /// Sway velocity over ground, to starboard.
    V,
    /// Yaw rate, to starboard.
    R,
    /// Roll angle, to starboard.
    Phi,
    /// Roll rate.
    P,
    /// Rudder angle, positive turns to starboard.
    Delta,
    /// Starboard rudder.
    DeltaS,
    /// Port rudder.
    DeltaP,
    /// Propeller revolutions.
    N,
    /// Starboard propeller.
    NS,
    /// Port propeller.
    NP,
    /// Course over ground.
    Course,
    /// Speed over ground.
    Speed,
    /// Speed through the water, ahead.
    UWater,
    /// Speed through the water, to starboard.
    VWater,
    /// Velocity over ground towards north.
    VNorth,
    /// Velocity over ground towards east.
    VEast,
    /// True wind speed.
    WindSpeed,
    /// True wind direction.
    WindFrom,
    /// Apparent wind speed.
    ApparentWindSpeed,
    /// Apparent wind direction.
    ApparentWindFrom,
    /// Water depth.
    Depth,
    /// A quantity that no channel holds.
    Other,
}

/// Physical kind of a quantity.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum QuantityKind {
    /// s.
    Time,
    /// m.
    Length,
    /// m/s.
    Speed,
    /// rad.
    Angle,
    /// rad/s.
    Rate,
    /// 1/s.
    Revolutions,
    /// Anything.
    Any,
}

struct RoleProperties {
    role: Role,
    name: &'static str,
    kind: QuantityKind,
    /// Range, in SI units, of the largest magnitude of nearly every recording, from model basins to
    /// large ships.
    largest: [f64; 2],
    /// True if recorders differ in the sign of the quantity.
    is_signed: bool,
}

const fn role_properties(
    role: Role,
    name: &'static str,
    kind: QuantityKind,
    largest: [f64; 2],
    is_signed: bool,
) -> RoleProperties {
    RoleProperties { role, name, kind, largest, is_signed }
}

// In the order of the variants of `Role`, which index this table.
const TABLE: [RoleProperties; 29] = [
    role_properties(Role::Time, "t", QuantityKind::Time, [0.0, 1e12], false),
    role_properties(Role::X, "x", QuantityKind::Length, [1.0, 1e7], false),
    role_properties(Role::Y, "y", QuantityKind::Length, [1.0, 1e7], true),
    role_properties(Role::Latitude, "latitude", QuantityKind::Angle, [0.001, 1.571], false),
    role_properties(Role::Longitude, "longitude", QuantityKind::Angle, [0.001, 3.15], false),
    role_properties(Role::Psi, "psi", QuantityKind::Angle, [0.2, 60.0], true),
    role_properties(Role::U, "u", QuantityKind::Speed, [0.2, 25.0], true),
    role_properties(Role::V, "v", QuantityKind::Speed, [0.01, 6.0], true),
    role_properties(Role::R, "r", QuantityKind::Rate, [0.002, 1.0], true),
    role_properties(Role::Phi, "phi", QuantityKind::Angle, [0.012, 0.7], true),
    role_properties(Role::P, "p", QuantityKind::Rate, [0.0005, 0.5], true),
    role_properties(Role::Delta, "delta", QuantityKind::Angle, [0.03, 1.7], true),
    role_properties(Role::DeltaS, "delta_s", QuantityKind::Angle, [0.03, 1.7], true),
    role_properties(Role::DeltaP, "delta_p", QuantityKind::Angle, [0.03, 1.7], true),
    role_properties(Role::N, "n", QuantityKind::Revolutions, [0.5, 60.0], false),
    role_properties(Role::NS, "n_s", QuantityKind::Revolutions, [0.5, 60.0], false),
    role_properties(Role::NP, "n_p", QuantityKind::Revolutions, [0.5, 60.0], false),
    role_properties(Role::Course, "course", QuantityKind::Angle, [0.08, 60.0], false),
    role_properties(Role::Speed, "speed", QuantityKind::Speed, [0.2, 25.0], false),
    role_properties(Role::UWater, "u_water", QuantityKind::Speed, [0.2, 25.0], false),
    role_properties(Role::VWater, "v_water", QuantityKind::Speed, [0.01, 6.0], true),
    role_properties(Role::VNorth, "v_north", QuantityKind::Speed, [0.1, 25.0], false),
    role_properties(Role::VEast, "v_east", QuantityKind::Speed, [0.02, 25.0], true),
    role_properties(Role::WindSpeed, "wind_speed", QuantityKind::Speed, [1.0, 45.0], false),
    role_properties(Role::WindFrom, "wind_from", QuantityKind::Angle, [0.05, 6.3], false),
    role_properties(
        Role::ApparentWindSpeed,
        "apparent_wind_speed",
        QuantityKind::Speed,
        [1.0, 60.0],
        false,
    ),
    role_properties(
        Role::ApparentWindFrom,
        "apparent_wind_from",
        QuantityKind::Angle,
        [0.05, 6.3],
        false,
    ),
    role_properties(Role::Depth, "depth", QuantityKind::Length, [0.2, 6000.0], false),
    role_properties(Role::Other, "", QuantityKind::Any, [0.0, f64::INFINITY], false),
];

impl Role {
    /// Returns every quantity for which there is a channel.
    pub fn channels() -> impl Iterator<Item = Self> {
        TABLE.iter().map(|row| row.role).filter(|&role| role != Self::Other)
    }

    fn properties(self) -> &'static RoleProperties {
        &TABLE[self as usize]
    }

    /// Returns the name in manifests; empty for `Other`.
    pub fn name(self) -> &'static str {
        self.properties().name
    }

    /// Returns the quantity of a name in manifests.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::channels().find(|role| role.name() == name)
    }

    /// Returns the physical kind of the quantity.
    pub fn kind(self) -> QuantityKind {
        self.properties().kind
    }

    /// Returns the usual range of the largest magnitude of a recording, in SI units.
    pub fn usual_range(self) -> [f64; 2] {
        self.properties().largest
    }

    /// Returns true if recorders differ in the sign of the quantity.
    pub fn is_signed(self) -> bool {
        self.properties().is_signed
    }

    /// Returns the quantity of the starboard or port side, where there is one.
    pub(crate) fn for_side(self, side: Side) -> Self {
        match (self, side) {
            (Self::Delta, Side::Port) => Self::DeltaP,
            (Self::Delta, Side::Starboard) => Self::DeltaS,
            (Self::N, Side::Port) => Self::NP,
            (Self::N, Side::Starboard) => Self::NS,
            _ => self,
        }
    }
}

/// A side of the ship.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// Left, looking ahead.
    Port,
    /// Right, looking ahead.
    Starboard,
}

/// A unit of a kind: name in manifests, factor to SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Unit {
    /// Name in manifests.
    pub name: &'static str,
    /// Factor to SI units.
    pub to_si: f64,
}

const fn unit(name: &'static str, to_si: f64) -> Unit {
    Unit { name, to_si }
}

const DEG: f64 = std::f64::consts::PI / 180.0;

impl QuantityKind {
    /// Returns per cent of a full scale, which the manifest declares, for a kind that is recorded so.
    pub fn percent_unit(self) -> Option<Unit> {
        matches!(self, Self::Angle | Self::Revolutions).then_some(unit("%", 0.01))
    }

    /// Returns the units in which columns of this kind are recorded, most usual first.
    pub fn known_units(self) -> &'static [Unit] {
        const TIME: [Unit; 6] = [
            unit("s", 1.0),
            unit("ms", 1e-3),
            unit("us", 1e-6),
            unit("min", 60.0),
            unit("h", 3600.0),
            unit("ns", 1e-9),
        ];
        // Exact factors: a nautical mile is 1852 m, a knot one nautical mile per hour.
        const LENGTH: [Unit; 3] = [unit("m", 1.0), unit("km", 1000.0), unit("nmi", 1852.0)];
        const SPEED: [Unit; 3] =
            [unit("m/s", 1.0), unit("kn", 1852.0 / 3600.0), unit("km/h", 1.0 / 3.6)];
        const ANGLE: [Unit; 2] = [unit("deg", DEG), unit("rad", 1.0)];
        const RATE: [Unit; 3] =
            [unit("deg/s", DEG), unit("rad/s", 1.0), unit("deg/min", DEG / 60.0)];
        const REVOLUTIONS: [Unit; 2] = [unit("rpm", 1.0 / 60.0), unit("rps", 1.0)];
        const ANY: [Unit; 1] = [unit("", 1.0)];
        match self {
            Self::Time => &TIME,
            Self::Length => &LENGTH,
            Self::Speed => &SPEED,
            Self::Angle => &ANGLE,
            Self::Rate => &RATE,
            Self::Revolutions => &REVOLUTIONS,
            Self::Any => &ANY,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_is_in_the_order_of_the_roles() {
        for (at, row) in TABLE.iter().enumerate() {
            assert_eq!(row.role as usize, at);
        }
        assert_eq!(Role::from_name("v_north"), Some(Role::VNorth));
    }
}
