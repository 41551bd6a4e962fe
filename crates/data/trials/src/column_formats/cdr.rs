//! Bytes of ROS messages: CDR of ROS 2, and the packed form of ROS 1.

use super::ros_schema::{FieldCount, FieldType, MessageField, PrimitiveType};

/// Form of the bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum RosEncoding {
    /// Aligned, after four bytes that state the order of bytes.
    Cdr,
    /// Little-endian without gaps.
    Ros1,
}

/// Number or text of a message, with the path of its field.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum RosValue<'a> {
    Number(f64),
    Text(&'a str),
}

/// Passes every number and text of a message that is no element of an array; `None` if the bytes
/// end before the message does.
pub(crate) fn visit_values<'a>(
    fields: &[MessageField],
    encoding: RosEncoding,
    bytes: &'a [u8],
    take: &mut impl FnMut(&str, RosValue<'a>),
) -> Option<()> {
    let mut reader = CdrReader { bytes, at: 0, is_big_endian: false, encoding };
    if encoding == RosEncoding::Cdr {
        // Second byte: 0 big endian, 1 little endian; alignment counts from the fifth byte.
        reader.is_big_endian = *bytes.get(1)? == 0;
        reader.bytes = bytes.get(4..)?;
    }
    reader.read_fields(fields, &mut String::new(), Some(take))
}

struct CdrReader<'a> {
    bytes: &'a [u8],
    at: usize,
    is_big_endian: bool,
    encoding: RosEncoding,
}

impl<'a> CdrReader<'a> {
    fn read_fields<F: FnMut(&str, RosValue<'a>)>(
        &mut self,
        fields: &[MessageField],
        path: &mut String,
        mut take: Option<&mut F>,
    ) -> Option<()> {
        for field in fields {
            let (count, is_one) = match field.count {
                FieldCount::One => (1, true),
                FieldCount::Fixed(count) => (count, false),
                FieldCount::Sequence => (self.read_unsigned(4)? as usize, false),
            };
            let parent = path.len();
            if parent > 0 {
                path.push('.');
            }
            path.push_str(&field.name);
            for _ in 0..count {
                // Elements without bytes would never reach the end.
                let before = self.at;
                let sink = if is_one { take.as_deref_mut() } else { None };
                self.read_field(&field.kind, path, sink)?;
                if self.at == before {
                    break;
                }
            }
            path.truncate(parent);
        }
        Some(())
    }

    fn read_field<F: FnMut(&str, RosValue<'a>)>(
        &mut self,
        kind: &FieldType,
        path: &mut String,
        take: Option<&mut F>,
    ) -> Option<()> {
        match kind {
            FieldType::Message(fields) => self.read_fields(fields, path, take),
            FieldType::Primitive(primitive) => {
                let value = self.read_primitive(*primitive)?;
                if let Some(take) = take {
                    take(path, value);
                }
                Some(())
            }
        }
    }

    fn read_primitive(&mut self, primitive: PrimitiveType) -> Option<RosValue<'a>> {
        Some(match primitive {
            PrimitiveType::Bool => RosValue::Number(self.read_unsigned(1)? as f64),
            PrimitiveType::Int { size, is_signed } => {
                let (whole, shift) = (self.read_unsigned(size)?, 64 - 8 * size as u32);
                let signed = ((whole << shift) as i64) >> shift;
                RosValue::Number(if is_signed { signed as f64 } else { whole as f64 })
            }
            PrimitiveType::Float { size: 4 } => {
                RosValue::Number(f64::from(f32::from_bits(self.read_unsigned(4)? as u32)))
            }
            PrimitiveType::Float { .. } => RosValue::Number(f64::from_bits(self.read_unsigned(8)?)),
            PrimitiveType::Text => {
                let length = self.read_unsigned(4)? as usize;
                let text = std::str::from_utf8(self.take_slice(length)?).unwrap_or_default();
                RosValue::Text(text.trim_end_matches('\0'))
            }
            PrimitiveType::WideText => {
                let length = self.read_unsigned(4)? as usize;
                self.take_slice(length.checked_mul(2)?)?;
                RosValue::Text("")
            }
        })
    }

    /// Reads a number of 1, 2, 4 or 8 bytes, which is aligned to its size.
    fn read_unsigned(&mut self, size: usize) -> Option<u64> {
        if self.encoding == RosEncoding::Cdr {
            self.at = self.at.next_multiple_of(size);
        }
        let bytes = self.take_slice(size)?;
        let joined = |whole: u64, byte: &u8| (whole << 8) | u64::from(*byte);
        Some(match self.is_big_endian {
            true => bytes.iter().fold(0, joined),
            false => bytes.iter().rev().fold(0, joined),
        })
    }

    fn take_slice(&mut self, length: usize) -> Option<&'a [u8]> {
        let end = self.at.checked_add(length)?;
        let slice = self.bytes.get(self.at..end)?;
        self.at = end;
        Some(slice)
    }
}
