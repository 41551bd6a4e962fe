//! What the ship of the journey is, and the files of its trials: the heading stands in degrees
//! under a name that says nothing.

use std::collections::BTreeMap;
use std::path::Path;

use sistership_cli::sea_trials::{TrialManoeuvre, record_programme};
use sistership_model::effect::AppliedEffect;
use sistership_model::quantity::Quantity;
use sistership_model::trial::Channel;
use sistership_model::{Trial, Zoo};
use sistership_simulation::Ship;

/// The Mariner's, as a person types them.
pub const PARTICULARS: [(&str, &str); 6] = [
    ("lpp_m", "160.93"),
    ("beam_m", "23,17"),
    ("draught_m", "7.47"),
    ("displacement_m3", "16622"),
    ("service_speed_m_s", "7.72"),
    ("block_coefficient", "0.6"),
];

/// Columns, with the factor from SI to what is written.
const COLUMNS: [(&str, Channel, f64); 7] = [
    ("x_m", Channel::X, 1.0),
    ("y_m", Channel::Y, 1.0),
    ("kompass", Channel::Psi, 180.0 / std::f64::consts::PI),
    ("u_m_s", Channel::U, 1.0),
    ("v_m_s", Channel::V, 1.0),
    ("r_rad_s", Channel::R, 1.0),
    ("delta_rad", Channel::Delta, 1.0),
];

/// Three files of a ship without anything hidden.
pub fn calm(folder: &Path) -> Vec<String> {
    let programme = [
        TrialManoeuvre::Zigzag(10.0, 10.0),
        TrialManoeuvre::Turn(-12.0),
        TrialManoeuvre::Zigzag(-20.0, 20.0),
    ];
    written(folder, &sailed(&programme, None, 21))
}

/// Files of trials in a current of 0.8 m/s to the east.
pub fn in_a_current(folder: &Path) -> Vec<String> {
    let programme = [TrialManoeuvre::Turn(15.0), TrialManoeuvre::Zigzag(15.0, 15.0)];
    let current = [("north_m_s", 0.1), ("east_m_s", 0.8)];
    written(folder, &sailed(&programme, Some(("current", &current)), 22))
}

/// Columns of a German sheet, with the factor from SI to what is written.
const GERMAN: [(&str, Channel, f64); 7] = [
    ("Nord [m]", Channel::X, 1.0),
    ("Ost [m]", Channel::Y, 1.0),
    ("Kurs [Grad]", Channel::Psi, 180.0 / std::f64::consts::PI),
    ("Fahrt voraus [kn]", Channel::U, 3600.0 / 1852.0),
    ("Querfahrt [kn]", Channel::V, 3600.0 / 1852.0),
    ("Drehrate [Grad/min]", Channel::R, 60.0 * 180.0 / std::f64::consts::PI),
    ("Ruderwinkel [Grad]", Channel::Delta, 180.0 / std::f64::consts::PI),
];

/// Three German sheets: decimal commas, spikes of the heading, and an echo sounder of 200 m under a
/// name that says nothing.
pub fn german(folder: &Path) -> Vec<String> {
    let programme = [
        TrialManoeuvre::Zigzag(10.0, 10.0),
        TrialManoeuvre::Turn(-12.0),
        TrialManoeuvre::Zigzag(-20.0, 20.0),
    ];
    let trials = sailed(&programme, None, 23);
    trials.iter().enumerate().map(|(at, trial)| german_sheet(folder, trial, at)).collect()
}

fn german_sheet(folder: &Path, trial: &Trial, at: usize) -> String {
    let names: Vec<&str> = GERMAN.iter().map(|(name, ..)| *name).collect();
    let mut text = format!("Zeit [s];{};Kanal 7\n", names.join(";"));
    let comma = |value: f64| format!("{value:.4}").replace('.', ",");
    for (row, (k, t_s)) in trial.t_s.iter().enumerate().step_by(2).enumerate() {
        let spike = |channel| if channel == Channel::Psi && row % 97 == 41 { 25.0 } else { 0.0 };
        let cell = |(_, channel, factor): &(&str, Channel, f64)| {
            comma(trial.channel(*channel).unwrap()[k] * factor + spike(*channel))
        };
        let cells: Vec<String> = GERMAN.iter().map(cell).collect();
        text += &format!("{};{};200,0\n", comma(*t_s), cells.join(";"));
    }
    let path = folder.join(format!("Fahrt {at}.csv"));
    std::fs::write(&path, text).unwrap();
    path.display().to_string()
}

fn sailed(
    programme: &[TrialManoeuvre],
    hidden: Option<(&str, &[(&str, f64)])>,
    seed: u64,
) -> Vec<Trial> {
    let zoo = Zoo::load_embedded().unwrap();
    let mut model = zoo.find_model("mariner").unwrap();
    if let Some((name, values)) = hidden {
        let effect = zoo.effect(name).unwrap();
        let value =
            |(name, value): &(&str, f64)| ((*name).to_owned(), Quantity::new(*value, "the truth"));
        model.effects.push(AppliedEffect {
            name: name.into(),
            acts_on: effect.acts_on,
            parameters: values.iter().map(value).collect::<BTreeMap<_, _>>(),
            form: effect.forms[0].file.clone(),
        });
    }
    let ship = Ship::new(&model, zoo.law(&model.law).unwrap()).unwrap();
    record_programme(&ship, 7.7, programme, seed).unwrap()
}

fn written(folder: &Path, trials: &[Trial]) -> Vec<String> {
    let one = |trial: &Trial| {
        let names: Vec<&str> = COLUMNS.iter().map(|(name, ..)| *name).collect();
        let mut text = format!("t_s,{}\n", names.join(","));
        for (k, t_s) in trial.t_s.iter().enumerate().step_by(2) {
            let cell = |(_, channel, factor): &(&str, Channel, f64)| {
                (trial.channel(*channel).unwrap()[k] * factor).to_string()
            };
            let cells: Vec<String> = COLUMNS.iter().map(cell).collect();
            text += &format!("{t_s},{}\n", cells.join(","));
        }
        let path = folder.join(&trial.name);
        std::fs::write(&path, text).unwrap();
        path.display().to_string()
    };
    trials.iter().map(one).collect()
}
