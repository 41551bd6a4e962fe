//! Ships and trials as people have them: a vessel file, CSV files, a manifest.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use sistership_model::Trial;
use sistership_trials::samples::to_csv;

use super::dimensions::Dimensions;

/// Writes the vessel file of a ship into a folder: particulars and category, no model.
///
/// # Panics
/// Where it cannot be written.
pub fn write_vessel(folder: &Path, ship: &Dimensions) -> PathBuf {
    let path = folder.join(format!("{}.yaml", ship.name));
    std::fs::write(&path, vessel(ship)).expect("the vessel file is written");
    path
}

/// The text of a vessel file.
pub fn vessel(ship: &Dimensions) -> String {
    let mut text = format!(
        "kind: vessel\nname: {name}\ntitle: Synthetic ship {name}\ncategory: {category}\n\
         sources:\n  yard: {{ citation: \"Papers of a ship that was never built\" }}\n\
         conventions: {{ rudder_positive: starboard_turn }}\n\
         particulars:\n  source: yard\n  values:\n",
        name = ship.name,
        category = ship.category,
    );
    for (name, value) in particulars(ship) {
        let _ = writeln!(text, "    {name}: {value:?}");
    }
    text + "models: []\n"
}

/// The particulars by their names in vessel files.
pub fn particulars(ship: &Dimensions) -> Vec<(&'static str, f64)> {
    let mut all = vec![
        ("lpp_m", ship.lpp_m),
        ("beam_m", ship.beam_m),
        ("draught_m", ship.draught_m),
        ("displacement_m3", ship.volume_m3()),
        ("block_coefficient", ship.block_coefficient),
        ("x_g_m", ship.x_g_m),
        ("yaw_gyradius_ratio", ship.yaw_gyradius_ratio),
        ("rudder_area_m2", ship.rudder_area_m2),
        ("rudder_height_m", ship.rudder_height_m),
        ("propeller_diameter_m", ship.propeller_diameter_m),
        ("service_speed_m_s", ship.speed_m_s),
        ("water_density_kg_m3", ship.density_kg_m3),
    ];
    if let Some(upright) = ship.upright {
        all.extend([("gm_m", upright.gm_m), ("kg_m", upright.kg_m)]);
    }
    all
}

/// Writes trials as CSV files with canonical columns, and a manifest that lists them, whose path is
/// returned.
///
/// # Panics
/// Where a file cannot be written.
pub fn write_trials(folder: &Path, ship: &str, trials: &[&Trial]) -> PathBuf {
    let mut manifest = format!("kind: trials\nship: {ship}\ntrials:\n");
    for trial in trials {
        let file = std::fs::File::create(folder.join(&trial.name)).expect("a trial file");
        to_csv(std::io::BufWriter::new(file), trial).expect("the trial is written");
        let _ = writeln!(manifest, "  - {{ file: \"{}\" }}", trial.name);
    }
    let path = folder.join("trials.yaml");
    std::fs::write(&path, manifest).expect("the manifest is written");
    path
}
