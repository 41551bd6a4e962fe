//! Values of common ROS messages as channels: axes by REP 103 (east, north, up; ahead, to port, up),
//! unless the frame of the message says `ned` or `frd`.

use std::collections::BTreeMap;
use std::f64::consts::{FRAC_PI_2, TAU};

use super::message_log::MessageValue;

/// Numbers and frames of a message.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct TopicMessage {
    /// Numbers by the path of their field.
    pub numbers: BTreeMap<String, f64>,
    /// Frame of positions, and frame of velocities where it is another.
    pub frame: String,
    pub child_frame: String,
}

/// Paths of the parts of a type.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct TypeParts {
    pub kind: &'static str,
    pub position: Option<&'static str>,
    pub orientation: Option<&'static str>,
    pub linear: Option<&'static str>,
    pub angular: Option<&'static str>,
}

const fn pose_type(
    kind: &'static str,
    position: &'static str,
    orientation: &'static str,
) -> TypeParts {
    let (position, orientation) = (Some(position), Some(orientation));
    TypeParts { kind, position, orientation, linear: None, angular: None }
}

const fn twist_type(kind: &'static str, linear: &'static str, angular: &'static str) -> TypeParts {
    let (linear, angular) = (Some(linear), Some(angular));
    TypeParts { kind, position: None, orientation: None, linear, angular }
}

const TYPES: [TypeParts; 7] = [
    TypeParts {
        kind: "Odometry",
        position: Some("pose.pose.position"),
        orientation: Some("pose.pose.orientation"),
        linear: Some("twist.twist.linear"),
        angular: Some("twist.twist.angular"),
    },
    TypeParts {
        kind: "Imu",
        position: None,
        orientation: Some("orientation"),
        linear: None,
        angular: Some("angular_velocity"),
    },
    pose_type("PoseStamped", "pose.position", "pose.orientation"),
    pose_type("PoseWithCovarianceStamped", "pose.pose.position", "pose.pose.orientation"),
    twist_type("TwistStamped", "twist.linear", "twist.angular"),
    twist_type("TwistWithCovarianceStamped", "twist.twist.linear", "twist.twist.angular"),
    twist_type("Twist", "linear", "angular"),
];

impl TopicMessage {
    /// Sets a frame, if the path is that of one.
    pub(crate) fn set_frame(&mut self, path: &str, text: &str) {
        match path {
            "header.frame_id" | "frame_id" => text.clone_into(&mut self.frame),
            "child_frame_id" => text.clone_into(&mut self.child_frame),
            _ => {}
        }
    }

    fn axis_number(&self, part: &str, axis: &str) -> Option<f64> {
        self.numbers.get(&format!("{part}.{axis}")).copied()
    }

    fn has_frame(&self, names: &[&str]) -> bool {
        let holds = |frame: &str| names.iter().any(|name| frame.to_lowercase().contains(name));
        holds(&self.frame) || holds(&self.child_frame)
    }
}

/// Words of a topic that asks for a motion and does not measure it.
const COMMANDS: [&str; 7] =
    ["cmd", "command", "setpoint", "desired", "reference", "goal", "target"];

/// Returns true if the motions of a topic are wanted ones, such as those of `/cmd_vel`.
pub(crate) fn is_command(topic: &str) -> bool {
    let topic = topic.to_lowercase();
    COMMANDS.iter().any(|word| topic.contains(word))
}

/// Returns the values of a message: channels of a common type, and the plain numbers of any other.
pub(crate) fn topic_values(topic: &str, kind: &str, message: &TopicMessage) -> Vec<MessageValue> {
    let kind = kind.rsplit(['/', '.']).next().unwrap_or_default();
    if matches!(kind, "NavSatFix" | "LocationFix") {
        return place_values(message);
    }
    match TYPES.iter().find(|parts| parts.kind == kind) {
        Some(parts) if !is_command(topic) => motion_values(parts, message),
        _ => plain_values(topic, message),
    }
}

fn channel_value(name: &str, unit: &'static str, number: Option<f64>) -> Option<MessageValue> {
    number.map(|number| MessageValue { name: name.to_owned(), unit, number })
}

fn place_values(message: &TopicMessage) -> Vec<MessageValue> {
    // A negative status is a receiver without a fix.
    if message.numbers.get("status.status").is_some_and(|&status| status < 0.0) {
        return Vec::new();
    }
    let degrees = |name: &str| message.numbers.get(name).copied();
    let latitude = channel_value("latitude_deg", "deg", degrees("latitude"));
    let longitude = channel_value("longitude_deg", "deg", degrees("longitude"));
    latitude.into_iter().chain(longitude).collect()
}

/// Returns the channels of a pose or a twist.
pub(crate) fn motion_values(parts: &TypeParts, message: &TopicMessage) -> Vec<MessageValue> {
    let is_down = message.has_frame(&["ned", "frd"]);
    let axis =
        |part: Option<&str>, axis: &str| part.and_then(|part| message.axis_number(part, axis));
    let (first, second) = (axis(parts.position, "x"), axis(parts.position, "y"));
    let (north, east) = if is_down { (first, second) } else { (second, first) };
    // Up and to port against down and to starboard.
    let sign = if is_down { 1.0 } else { -1.0 };
    let turned = |number: Option<f64>| number.map(|number| sign * number);
    let attitude = parts.orientation.and_then(|part| heading_and_roll(message, part, is_down));
    let (heading, roll) = (attitude.map(|both| both.0), attitude.map(|both| both.1));
    [
        channel_value("x_m", "m", north),
        channel_value("y_m", "m", east),
        channel_value("psi_rad", "rad", heading),
        channel_value("phi_rad", "rad", roll),
        channel_value("u_m_s", "m/s", axis(parts.linear, "x")),
        channel_value("v_m_s", "m/s", turned(axis(parts.linear, "y"))),
        channel_value("r_rad_s", "rad/s", turned(axis(parts.angular, "z"))),
        channel_value("p_rad_s", "rad/s", axis(parts.angular, "x")),
    ]
    .into_iter()
    .flatten()
    .collect()
}

/// Returns the heading from north, clockwise, and the roll to starboard, rad, of a quaternion;
/// `None` for one that is zero, which stands for an unknown orientation.
fn heading_and_roll(message: &TopicMessage, part: &str, is_down: bool) -> Option<(f64, f64)> {
    let axis = |name: &str| message.axis_number(part, name);
    let (x, y, z, w) = (axis("x")?, axis("y")?, axis("z")?, axis("w")?);
    if x * x + y * y + z * z + w * w < 0.5 {
        return None;
    }
    let yaw = (2.0 * (w * z + x * y)).atan2(1.0 - 2.0 * (y * y + z * z));
    let roll = (2.0 * (w * x + y * z)).atan2(1.0 - 2.0 * (x * x + y * y));
    // From east, anticlockwise, where z points up.
    let heading = if is_down { yaw } else { FRAC_PI_2 - yaw };
    Some((heading.rem_euclid(TAU), roll))
}

fn plain_values(topic: &str, message: &TopicMessage) -> Vec<MessageValue> {
    let topic = topic.trim_matches('/');
    let is_stamp = |path: &str| path.starts_with("header.") || path.starts_with("stamp.");
    let numbers = message.numbers.iter().filter(|(path, _)| !is_stamp(path));
    let name = |path: &str| match path {
        "data" | "value" => topic.to_owned(),
        path => format!("{topic}.{path}"),
    };
    numbers.map(|(path, &number)| MessageValue { name: name(path), unit: "", number }).collect()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn message(frame: &str, numbers: &[(&str, f64)]) -> TopicMessage {
        let numbers = numbers.iter().map(|&(path, number)| (path.to_owned(), number)).collect();
        TopicMessage { numbers, frame: frame.to_owned(), child_frame: String::new() }
    }

    fn number(values: &[MessageValue], name: &str) -> f64 {
        values.iter().find(|value| value.name == name).unwrap().number
    }

    #[test]
    fn axes_are_those_of_the_frame() {
        // A turn of 90 degrees about z: north where z points up, east where it points down.
        let half = 0.5_f64.sqrt();
        let numbers = [
            ("orientation.x", 0.0),
            ("orientation.y", 0.0),
            ("orientation.z", half),
            ("orientation.w", half),
            ("angular_velocity.z", 0.2),
        ];
        let up = topic_values("/imu", "sensor_msgs/msg/Imu", &message("imu_link", &numbers));
        assert!(number(&up, "psi_rad").sin().abs() < 1e-9 && number(&up, "psi_rad").cos() > 0.0);
        assert_eq!(number(&up, "r_rad_s"), -0.2);
        let down = topic_values("/imu", "sensor_msgs/Imu", &message("base_link_frd", &numbers));
        assert!((number(&down, "psi_rad") - FRAC_PI_2).abs() < 1e-9);
        assert_eq!(number(&down, "r_rad_s"), 0.2);
        let plain =
            topic_values("/rudder/angle", "std_msgs/msg/Float64", &message("", &[("data", 0.1)]));
        assert_eq!((plain[0].name.as_str(), plain[0].number), ("rudder/angle", 0.1));
        let wanted = message("", &[("linear.x", 2.0), ("angular.z", 0.1)]);
        let wanted = topic_values("/cmd_vel", "geometry_msgs/msg/Twist", &wanted);
        assert!(wanted.iter().all(|value| value.name.starts_with("cmd_vel.")), "{wanted:?}");
        let lost = message("", &[("status.status", -1.0), ("latitude", 1.0)]);
        assert!(topic_values("/fix", "sensor_msgs/msg/NavSatFix", &lost).is_empty());
    }
}
