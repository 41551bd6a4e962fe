//! MCAP logs: messages of ROS 2, of ROS 1 and in JSON as columns on one clock.

use std::collections::{BTreeSet, HashMap};
use std::io::{self, Read};

use serde_json::Value;

use super::cdr::{RosEncoding, RosValue, visit_values};
use super::mcap_records::{McapRecord, visit_records};
use super::message_log::MessageLog;
use super::ros_schema::{MessageField, parse_schema};
use super::ros_topics::{TopicMessage, topic_values};
use crate::column_source::MemoryColumns;
use crate::limits::FileLimits;

/// Nanoseconds of a second.
const SECOND_NS: f64 = 1e9;
/// Largest difference, s, of the time of a measurement and of the log, beyond which they are of
/// different clocks.
const CLOCKS_S: f64 = 3600.0;
/// Largest number of values of a JSON message, and depth of objects in objects.
const MAX_VALUES: usize = 2000;
const MAX_DEPTH: usize = 10;

/// Form of the messages of a topic.
enum TopicForm {
    Json,
    Ros(RosEncoding, Vec<MessageField>),
}

struct LogTopic {
    name: String,
    kind: String,
    form: TopicForm,
}

/// Type of a message and its definition.
struct TopicSchema {
    kind: String,
    text: String,
}

/// Log that is read record by record.
struct McapReader {
    schemas: HashMap<u16, TopicSchema>,
    topics: HashMap<u16, LogTopic>,
    /// Encodings of topics that are not read.
    unread: BTreeSet<String>,
    log: MessageLog,
    is_dated: bool,
}

/// Reads the topics of a log.
///
/// # Errors
/// Returns an error if the log is damaged, holds more than the limits allow, or has no topic of use.
pub(crate) fn read_mcap(input: impl Read, limits: FileLimits) -> io::Result<MemoryColumns> {
    let mut reader = McapReader {
        schemas: HashMap::new(),
        topics: HashMap::new(),
        unread: BTreeSet::new(),
        log: MessageLog::new(limits),
        is_dated: false,
    };
    visit_records(input, limits, &mut |record| reader.add_record(record))?;
    let unread: Vec<String> = reader.unread.into_iter().collect();
    let is_dated = reader.is_dated;
    reader.log.into_columns(is_dated).map_err(|error| match unread.is_empty() {
        true => error,
        false => {
            io::Error::other(format!("{error}; messages in {} are not read", unread.join(", ")))
        }
    })
}

impl McapReader {
    fn add_record(&mut self, record: McapRecord) -> io::Result<()> {
        match record {
            McapRecord::Schema { id, name, text, .. } => {
                let text = String::from_utf8_lossy(text).into_owned();
                self.schemas.insert(id, TopicSchema { kind: name.to_owned(), text });
            }
            McapRecord::Channel { id, schema, topic, encoding } => {
                self.add_topic(id, schema, topic, encoding);
            }
            McapRecord::Message { channel, log_time_ns, data } => {
                return self.add_message(channel, log_time_ns as f64 / SECOND_NS, data);
            }
        }
        Ok(())
    }

    fn add_topic(&mut self, id: u16, schema: u16, topic: &str, encoding: &str) {
        let schema = self.schemas.get(&schema);
        let fields = || schema.and_then(|schema| parse_schema(&schema.text));
        let form = match encoding {
            "json" => Some(TopicForm::Json),
            "cdr" => fields().map(|fields| TopicForm::Ros(RosEncoding::Cdr, fields)),
            "ros1" => fields().map(|fields| TopicForm::Ros(RosEncoding::Ros1, fields)),
            _ => None,
        };
        let kind = schema.map_or(String::new(), |schema| schema.kind.clone());
        match form {
            Some(form) => {
                self.topics.entry(id).or_insert(LogTopic { name: topic.to_owned(), kind, form });
            }
            None => {
                self.unread.insert(format!("`{encoding}`"));
            }
        }
    }

    fn add_message(&mut self, channel: u16, log_s: f64, data: &[u8]) -> io::Result<()> {
        let Some(topic) = self.topics.get(&channel) else { return Ok(()) };
        // A damaged message is left out.
        let message = match &topic.form {
            TopicForm::Json => json_message(data),
            TopicForm::Ros(encoding, fields) => ros_message(fields, *encoding, data),
        };
        let Some(message) = message else { return Ok(()) };
        let t_s = stamp_seconds(&message)
            .filter(|stamp_s| (stamp_s - log_s).abs() < CLOCKS_S)
            .unwrap_or(log_s);
        self.is_dated = t_s > 1e9;
        for value in topic_values(&topic.name, &topic.kind, &message) {
            self.log.add_value(t_s, u32::from(channel), value)?;
        }
        Ok(())
    }
}

/// Returns the time of the measurement, s since 1970, where the message has it.
fn stamp_seconds(message: &TopicMessage) -> Option<f64> {
    let part = |names: [&str; 2]| {
        names.iter().find_map(|name| message.numbers.get(&format!("header.stamp.{name}")))
    };
    let (seconds, nanoseconds) = (part(["sec", "secs"])?, part(["nanosec", "nsec"])?);
    Some(seconds + nanoseconds / SECOND_NS)
}

fn ros_message(
    fields: &[MessageField],
    encoding: RosEncoding,
    data: &[u8],
) -> Option<TopicMessage> {
    let mut message = TopicMessage::default();
    visit_values(fields, encoding, data, &mut |path, value| match value {
        RosValue::Number(number) => {
            message.numbers.insert(path.to_owned(), number);
        }
        RosValue::Text(text) => message.set_frame(path, text),
    })?;
    Some(message)
}

fn json_message(data: &[u8]) -> Option<TopicMessage> {
    let mut message = TopicMessage::default();
    add_json(&mut message, "", &serde_json::from_slice(data).ok()?, 0);
    Some(message)
}

fn add_json(message: &mut TopicMessage, path: &str, value: &Value, depth: usize) {
    match value {
        Value::Object(fields) if depth < MAX_DEPTH => {
            for (name, value) in fields {
                let path = if path.is_empty() { name.clone() } else { format!("{path}.{name}") };
                add_json(message, &path, value, depth + 1);
            }
        }
        Value::String(text) => message.set_frame(path, text),
        value => {
            if let Some(number) = value.as_f64().filter(|_| message.numbers.len() < MAX_VALUES) {
                message.numbers.insert(path.to_owned(), number);
            }
        }
    }
}
