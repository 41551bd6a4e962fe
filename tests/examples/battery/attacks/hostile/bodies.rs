//! Bodies by media type: a good one, spoiled in its values or in its text.

use rand::RngExt as _;
use serde_json::Value;

use super::grammar::Grammar;
use crate::documents;

/// The boundary of forms.
pub const BOUNDARY: &str = "battery";

const HEADINGS: &str = "t_s,x_m,y_m,psi_deg,u_kn,v_m_s,r_deg_s,delta_deg,n_rpm\n";

impl Grammar {
    /// A body of a media type for a schema.
    pub(super) fn body(&mut self, media: &str, schema: &Value) -> Vec<u8> {
        let good = match media {
            "application/json" => self.json(schema),
            "application/yaml" => self.yaml(),
            "text/csv" => self.table().into_bytes(),
            "multipart/form-data" => self.form(),
            _ => self.bytes(),
        };
        if self.chance(0.4) { self.spoil_text(good) } else { good }
    }

    fn json(&mut self, schema: &Value) -> Vec<u8> {
        let mut value = match self.chance(0.1) {
            true => documents::version("target", "hostile").unwrap_or(Value::Null),
            false => self.instance(schema, 0),
        };
        for _ in 0..self.rng.random_range(0..4) {
            self.spoil(&mut value);
        }
        value.to_string().into_bytes()
    }

    /// A law or a ship with another value somewhere.
    fn yaml(&mut self) -> Vec<u8> {
        let name = format!("hostile-{}", self.rng.random_range(0..1_000_000));
        let text = if self.chance(0.5) { documents::law(&name) } else { documents::ship(&name) };
        let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
        for _ in 0..self.rng.random_range(1..4) {
            let (place, formula) = (self.rng.random_range(0..lines.len()), self.formula());
            let line = lines[place].clone();
            match self.rng.random_range(0..5) {
                0 => lines.insert(place, line),
                1 => drop(lines.remove(place)),
                2 => lines[place] = line.replacen(": ", &format!(": {}", self.deep()), 1),
                _ => {
                    if let Some((key, _)) = line.split_once(": ") {
                        lines[place] = format!("{key}: {formula}");
                    }
                }
            }
            if lines.is_empty() {
                break;
            }
        }
        lines.join("\n").into_bytes()
    }

    /// A formula of any depth and length.
    fn formula(&mut self) -> String {
        let size = self.size(30_000);
        let atom = ["u", "v", "r", "1e308", "0", "lpp_m", "U", "unheard_of", "-1e-308"];
        let atom = self.pick(&atom).to_owned();
        match self.rng.random_range(0..10) {
            0 => "(".repeat(size) + &atom + &")".repeat(size),
            1 => "-".repeat(size) + &atom,
            2 => "sqrt(".repeat(size) + &atom + &")".repeat(size),
            3 => atom + &"^2".repeat(size),
            4 => atom.clone() + &format!(" + {atom}").repeat(size),
            5 => atom.clone() + &format!("/{atom}").repeat(size),
            6 => "max(".repeat(size) + &atom + &format!(", {atom})").repeat(size),
            7 => format!("{atom}^{}", "9".repeat(size.min(400))),
            8 => format!("1/({atom} - {atom})"),
            _ => self.text(),
        }
    }

    /// The beginning of something deep.
    fn deep(&mut self) -> String {
        let part =
            self.pick(&["{a: ", "[", "- ", "(", "!!map {", "&a [*a, ", "\"", "? "]).to_owned();
        part.repeat(self.size(20_000))
    }

    /// A table with cells, rows and headings that are not what they should be.
    fn table(&mut self) -> String {
        let columns = HEADINGS.matches(',').count() + 1;
        let mut table = HEADINGS.to_owned();
        for row in 0..self.size(300) {
            let mut cells: Vec<String> = (0..columns)
                .map(|column| format!("{}.{column}", row * usize::from(column == 0)))
                .collect();
            if self.chance(0.1) {
                let place = self.rng.random_range(0..columns);
                let odd = ["NaN", "inf", "-", "1,5", "", "1e999", "\"", "0x10", "\0", "7;8", "١"];
                cells[place] =
                    if self.chance(0.9) { self.pick(&odd).to_owned() } else { self.text() };
            }
            if self.chance(0.02) {
                cells.truncate(self.rng.random_range(0..columns));
            }
            if self.chance(0.02) {
                cells.resize(self.size(2000), "1".to_owned());
            }
            table += &cells.join(",");
            table += self.pick(&["\n", "\n", "\n", "\r\n", "\r", ""]);
        }
        table
    }

    /// A form with a manifest and a file, whose parts may be missing, doubled, unnamed or cut.
    fn form(&mut self) -> Vec<u8> {
        let mut form = String::new();
        for _ in 0..self.rng.random_range(0..4) {
            let text = match self.rng.random_range(0..4) {
                0 => self.table(),
                1 => String::from_utf8_lossy(&self.yaml()).into_owned(),
                2 => self.value().to_string(),
                _ => {
                    r#"{"kind":"trials","ship":"target","trials":[{"file":"one.csv"}]}"#.to_owned()
                }
            };
            let name = self.pick(&["manifest", "file", "file", "ship", "other", ""]).to_owned();
            let file = if self.chance(0.5) {
                format!("; filename=\"{}\"", self.pick(&["one.csv", "../x", "x.parquet", ""]))
            } else {
                String::new()
            };
            form += &format!(
                "--{BOUNDARY}\r\nContent-Disposition: form-data; \
                 name=\"{name}\"{file}\r\n\r\n{text}\r\n"
            );
        }
        if self.chance(0.8) {
            form += &format!("--{BOUNDARY}--\r\n");
        }
        form.into_bytes()
    }

    /// Bytes that begin and end like Parquet, or like nothing.
    fn bytes(&mut self) -> Vec<u8> {
        let mut bytes = vec![0; self.size(100_000)];
        self.rng.fill(&mut bytes[..]);
        if self.chance(0.7) {
            bytes.splice(0..0, *b"PAR1");
            let length = self.rng.random_range(0..2 * bytes.len() as u32);
            bytes.extend(length.to_le_bytes());
            bytes.extend(b"PAR1");
        }
        bytes
    }

    /// Cuts, doubles, deepens or stains a text.
    fn spoil_text(&mut self, mut text: Vec<u8>) -> Vec<u8> {
        let place = self.rng.random_range(0..=text.len());
        match self.rng.random_range(0..6) {
            0 => text.truncate(place),
            1 => drop(text.splice(place..place, self.deep().into_bytes())),
            2 => drop(text.splice(place..place, [0])),
            3 => drop(text.splice(place..place, [0xff, 0xfe, 0xc0])),
            4 => text.extend_from_within(..place),
            _ => text.iter_mut().skip(place).take(3).for_each(|byte| *byte = byte.wrapping_add(1)),
        }
        text
    }
}
