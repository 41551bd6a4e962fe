//! Figures in the documents and files that the program writes.

use std::path::Path;

use serde_json::Value;

/// What a refinement chose.
#[derive(Debug, Clone, PartialEq)]
pub struct Chosen {
    /// Source model, or a dash.
    pub source: String,
    /// Law.
    pub law: String,
    /// Whether it has a learned correction.
    pub learned: bool,
    /// Number of coefficients.
    pub coefficients: usize,
}

impl Chosen {
    /// That of a document of `refine`.
    pub fn from_document(document: &Value) -> Self {
        let text = |value: &Value| value.as_str().unwrap_or("-").to_owned();
        let coefficients = &document["model"]["coefficients"];
        Self {
            source: text(&document["source"]),
            law: text(&document["model"]["law"]),
            learned: !document["weights"].is_null(),
            coefficients: coefficients.as_object().map_or(0, serde_json::Map::len),
        }
    }
}

/// Standardised mean squared error over six channels and heading error, deg, of a document of
/// `simulate`; absent where a simulation left the physical range.
pub fn errors(document: &Value) -> Option<[f64; 2]> {
    let all = document["trials"].as_array()?;
    if all.iter().any(|trial| trial["diverged"] == true) {
        return None;
    }
    let heading = document["all"]["rmse"]["psi"].as_f64()?.to_degrees();
    Some([document["all"]["standardised_mse"].as_f64()? / 6.0, heading])
}

/// Tactical diameter at an angle, m, of a document of `manoeuvre`.
pub fn tactical_diameter(document: &Value, angle_deg: f64) -> Option<f64> {
    let same = |turn: &&Value| turn["rudder_deg"].as_f64() == Some(angle_deg);
    document["turns"].as_array()?.iter().find(same)?["tactical_diameter_m"].as_f64()
}

/// Surge velocity over time in the only CSV file of a folder.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Speeds {
    /// Time, s.
    pub t_s: Vec<f64>,
    /// Surge velocity, m/s.
    pub u_m_s: Vec<f64>,
}

impl Speeds {
    /// Reads it; absent where there is no such file.
    pub fn read(folder: &Path) -> Option<Self> {
        let file = std::fs::read_dir(folder).ok()?.next()?.ok()?.path();
        let text = std::fs::read_to_string(file).ok()?;
        let mut lines = text.lines();
        let header: Vec<&str> = lines.next()?.split(',').collect();
        let place = |name: &str| header.iter().position(|column| *column == name);
        let (time, speed) = (place("t_s")?, place("u_m_s")?);
        let mut all = Self::default();
        for line in lines {
            let cells: Vec<&str> = line.split(',').collect();
            let read = |place: usize| cells.get(place).and_then(|cell| cell.parse::<f64>().ok());
            if let Some((t_s, u_m_s)) = read(time).zip(read(speed)) {
                all.t_s.push(t_s);
                all.u_m_s.push(u_m_s);
            }
        }
        Some(all)
    }

    /// Speed at a time, of the last sample before it.
    pub fn at(&self, t_s: f64) -> Option<f64> {
        let before = self.t_s.iter().rposition(|t| *t <= t_s + 1e-6)?;
        Some(self.u_m_s[before])
    }

    /// Last speed.
    pub fn last(&self) -> Option<f64> {
        self.u_m_s.last().copied()
    }
}
