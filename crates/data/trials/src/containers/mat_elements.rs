//! MATLAB 5 files (`save -v7`, `-v6`): nested data elements, read as a stream.

use std::io::{self, Read};

use flate2::read::ZlibDecoder;

/// Bytes before the first element.
const HEADER: usize = 128;
/// Largest number of elements of a file, and largest depth of nested structures.
const ELEMENTS: usize = 10_000;
const DEPTH: usize = 4;
/// Largest size of names and dimensions, bytes.
const SMALL: u64 = 64 << 10;

const COMPRESSED: u32 = 15;
const MATRIX: u32 = 14;
const CELL: u8 = 1;
const STRUCTURE: u8 = 2;
const NUMERIC: std::ops::RangeInclusive<u8> = 6..=15;
const COMPLEX: u8 = 0x08;

/// Array of real numbers, stored column by column, whose numbers are read on request.
pub struct NumberArray<'a> {
    /// Name of the variable.
    pub name: String,
    /// Number of rows.
    pub rows: usize,
    /// Number of columns.
    pub columns: usize,
    kind: u32,
    big: bool,
    input: &'a mut dyn Read,
}

impl NumberArray<'_> {
    /// Reads the next `count` numbers.
    ///
    /// # Errors
    /// Returns an error if the file ends or the type of the numbers is unknown.
    pub fn read_numbers(&mut self, count: usize) -> io::Result<Vec<f64>> {
        let width =
            type_width(self.kind).ok_or_else(|| invalid_data("numbers of an unknown type"))?;
        // No memory is reserved for `count`, which the file declares and may not hold.
        let mut numbers = Vec::new();
        let mut bytes = [0; 8];
        for _ in 0..count {
            self.input.read_exact(&mut bytes[..width])?;
            numbers.push(decode_number(self.kind, self.big, &bytes[..width]));
        }
        Ok(numbers)
    }

    /// Skips the next `count` numbers.
    ///
    /// # Errors
    /// Returns an error if the file cannot be read or the type of the numbers is unknown.
    pub fn skip_numbers(&mut self, count: usize) -> io::Result<()> {
        let width =
            type_width(self.kind).ok_or_else(|| invalid_data("numbers of an unknown type"))?;
        skip_rest(&mut (&mut *self.input).take((count as u64).saturating_mul(width as u64)))
    }
}

/// Bytes of a number by its type in MATLAB's table.
fn type_width(kind: u32) -> Option<usize> {
    match kind {
        1 | 2 => Some(1),
        3 | 4 => Some(2),
        5..=7 => Some(4),
        9 | 12 | 13 => Some(8),
        _ => None,
    }
}

/// Decodes a number by its type in MATLAB's table; integers that an f64 cannot hold are rounded.
fn decode_number(kind: u32, big: bool, bytes: &[u8]) -> f64 {
    let mut low = [0; 8];
    let whole = &mut low[..bytes.len()];
    whole.copy_from_slice(bytes);
    if big {
        whole.reverse();
    }
    let bits = u64::from_le_bytes(low);
    match kind {
        1 => f64::from(bits as u8 as i8),
        3 => f64::from(bits as u16 as i16),
        5 => f64::from(bits as u32 as i32),
        7 => f64::from(f32::from_bits(bits as u32)),
        9 => f64::from_bits(bits),
        12 => bits as i64 as f64,
        _ => bits as f64,
    }
}

/// Calls the visitor with every real array of the file; arrays within structures are named
/// `structure.field`, `structure(2).field` where there are several, and those of cells `cell{2}`.
///
/// # Errors
/// Returns an error if the file is damaged or unpacks to more than `most` bytes, and the error of
/// the visitor.
pub fn visit_arrays(
    input: &mut dyn Read,
    most: u64,
    visitor: &mut dyn FnMut(NumberArray) -> io::Result<()>,
) -> io::Result<()> {
    let mut header = [0; HEADER];
    input.read_exact(&mut header)?;
    let big = match &header[HEADER - 2..] {
        b"IM" => false,
        b"MI" => true,
        _ => return Err(invalid_data("its byte order is unknown")),
    };
    let mut parser = ElementParser { big, left: most, visitor };
    for _ in 0..ELEMENTS {
        match parser.read_tag(input) {
            Ok(tag) => parser.read_element(input, tag)?,
            Err(error) if error.kind() == io::ErrorKind::UnexpectedEof => return Ok(()),
            Err(error) => return Err(error),
        }
    }
    Err(invalid_data("too many variables"))
}

struct ElementParser<'a> {
    big: bool,
    /// Unpacked bytes that may still be read.
    left: u64,
    visitor: &'a mut dyn FnMut(NumberArray) -> io::Result<()>,
}

/// Type, size in bytes, and the data themselves if the tag contains them.
struct ElementTag {
    kind: u32,
    size: u64,
    inside: Option<[u8; 4]>,
}

impl ElementParser<'_> {
    fn decode_word(&self, bytes: [u8; 4]) -> u32 {
        if self.big { u32::from_be_bytes(bytes) } else { u32::from_le_bytes(bytes) }
    }

    fn read_tag(&mut self, input: &mut dyn Read) -> io::Result<ElementTag> {
        let mut bytes = [0; 4];
        input.read_exact(&mut bytes)?;
        let first = self.decode_word(bytes);
        input.read_exact(&mut bytes)?;
        // Small element format: the upper half of the first word is the size, and up to four bytes
        // of data take the place of the size.
        if first >> 16 != 0 {
            let size = u64::from(first >> 16).min(4);
            return Ok(ElementTag { kind: first & 0xffff, size, inside: Some(bytes) });
        }
        Ok(ElementTag { kind: first, size: u64::from(self.decode_word(bytes)), inside: None })
    }

    fn read_element(&mut self, input: &mut dyn Read, tag: ElementTag) -> io::Result<()> {
        // A small element at the top level is no variable.
        if tag.inside.is_some() {
            return Ok(());
        }
        let mut part = input.take(tag.size);
        match tag.kind {
            COMPRESSED => {
                // A compressed element holds exactly one element, which has a tag of its own.
                let mut unpacked = ZlibDecoder::new(&mut part);
                let inner = self.read_tag(&mut unpacked)?;
                if inner.kind == MATRIX && inner.inside.is_none() {
                    self.read_matrix(&mut unpacked, inner.size, "", 0)?;
                }
            }
            MATRIX => self.read_matrix(&mut part, tag.size, "", 0)?,
            _ => {}
        }
        skip_rest(&mut part)
    }

    /// Subtracts bytes from those that may still be read, before they are read.
    fn charge_bytes(&mut self, bytes: u64) -> io::Result<()> {
        self.left = self
            .left
            .checked_sub(bytes)
            .ok_or_else(|| invalid_data("it has too many bytes when unpacked"))?;
        Ok(())
    }

    /// Reads the bytes of a small element.
    fn read_small(&mut self, input: &mut dyn Read) -> io::Result<Vec<u8>> {
        let tag = self.read_tag(input)?;
        if let Some(inside) = tag.inside {
            return Ok(inside[..usize::try_from(tag.size).unwrap_or(0)].to_vec());
        }
        if tag.size > SMALL {
            return Err(invalid_data("a name or a size is too long"));
        }
        let mut bytes = Vec::new();
        input.take(tag.size).read_to_end(&mut bytes)?;
        skip_rest(&mut input.take(padding_bytes(tag.size)))?;
        Ok(bytes)
    }

    fn read_matrix(
        &mut self,
        input: &mut dyn Read,
        size: u64,
        outer: &str,
        depth: usize,
    ) -> io::Result<()> {
        self.charge_bytes(size)?;
        let mut input = input.take(size);
        // An empty field has no content at all.
        if size > 0 {
            self.read_content(&mut input, outer, depth)?;
        }
        skip_rest(&mut input)
    }

    fn read_content(&mut self, input: &mut dyn Read, outer: &str, depth: usize) -> io::Result<()> {
        let flags = self.read_small(input)?;
        let flags = flags.first_chunk().map_or(0, |bytes| self.decode_word(*bytes));
        let (class, flags) = (flags as u8, (flags >> 8) as u8);
        let dimensions = self.read_small(input)?;
        let dimensions = dimensions.as_chunks::<4>().0.iter();
        let dimensions: Vec<usize> =
            dimensions.map(|bytes| self.decode_word(*bytes) as usize).collect();
        let name = String::from_utf8_lossy(&self.read_small(input)?).into_owned();
        // Fields of a structure have an empty name of their own.
        let name = if depth == 0 { name } else { outer.to_owned() };
        // Arrays of more than two dimensions are skipped by the caller.
        let &[rows, columns] = dimensions.as_slice() else { return Ok(()) };
        match class {
            STRUCTURE if depth < DEPTH => {
                self.read_structures(input, &name, (rows.saturating_mul(columns), depth))
            }
            CELL if depth < DEPTH => {
                let count = rows.saturating_mul(columns);
                (1..=count)
                    .try_for_each(|k| self.read_field(input, &format!("{name}{{{k}}}"), depth))
            }
            class if NUMERIC.contains(&class) && flags & COMPLEX == 0 => {
                let tag = self.read_tag(input)?;
                let big = self.big;
                let inside = tag.inside.unwrap_or_default();
                let mut inside = &inside[..];
                let mut part = input.take(tag.size);
                let input: &mut dyn Read =
                    if tag.inside.is_some() { &mut inside } else { &mut part };
                (self.visitor)(NumberArray { name, rows, columns, kind: tag.kind, big, input })
            }
            _ => Ok(()),
        }
    }

    fn read_structures(
        &mut self,
        input: &mut dyn Read,
        name: &str,
        (count, depth): (usize, usize),
    ) -> io::Result<()> {
        // Names of fields have a fixed length, padded by zeros; the fields follow in the same
        // order.
        let length = self.read_small(input)?;
        let length = length.first_chunk().map_or(0, |bytes| self.decode_word(*bytes) as usize);
        let names = self.read_small(input)?;
        let single = count == 1;
        // Structures without fields may claim to be any number.
        let count = if names.is_empty() { 0 } else { count };
        for k in 1..=count {
            let name = if single { name.to_owned() } else { format!("{name}({k})") };
            for field in names.chunks(length.max(1)) {
                let field: Vec<u8> = field.iter().copied().take_while(|byte| *byte != 0).collect();
                let field = format!("{name}.{}", String::from_utf8_lossy(&field));
                self.read_field(input, &field, depth)?;
            }
        }
        Ok(())
    }

    /// Reads an array within another.
    fn read_field(&mut self, input: &mut dyn Read, name: &str, depth: usize) -> io::Result<()> {
        let tag = self.read_tag(input)?;
        if tag.kind != MATRIX || tag.inside.is_some() {
            return Err(invalid_data("a field is not an array"));
        }
        self.read_matrix(input, tag.size, name, depth + 1)
    }
}

/// Returns the number of bytes after an element up to the next multiple of eight.
fn padding_bytes(size: u64) -> u64 {
    size.next_multiple_of(8) - size
}

fn skip_rest(input: &mut dyn Read) -> io::Result<()> {
    io::copy(input, &mut io::sink()).map(|_| ())
}

fn invalid_data(message: &str) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidData, message)
}
