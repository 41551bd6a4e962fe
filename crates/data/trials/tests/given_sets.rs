//! Recordings of others, read as they are: columns without names, faults, port-positive rudders.

#![allow(clippy::unwrap_used)]

#[path = "../../../../tests/src/shared.rs"]
#[allow(dead_code)]
mod shared;

use std::path::{Path, PathBuf};

use sistership_model::manifest::RudderSign;
use sistership_model::trial::{Channel, Trial};
use sistership_trials::{
    ManifestProposal, ProposalRequest, load_cleaned, load_path, propose_files,
};

/// Files of a set by the ending of their names, in order.
fn files(folder: &Path, ending: &str) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let mut files: Vec<PathBuf> =
        entries.filter(|path| path.extension().is_some_and(|known| known == ending)).collect();
    files.sort();
    files
}

/// Imports files: the proposal with what is excluded, and the trials that it reads.
fn import(files: &[PathBuf]) -> (ManifestProposal, Vec<Result<Trial, String>>) {
    let folder = tempfile::tempdir().unwrap();
    let place = folder.path().join("trials.yaml");
    let paths: Vec<&Path> = files.iter().map(PathBuf::as_path).collect();
    let request =
        ProposalRequest { ship: "", files: &paths, folder: Some(folder.path()), given: &[] };
    let mut proposal = propose_files(&request).unwrap();
    let write = |proposal: &ManifestProposal| {
        std::fs::write(&place, proposal.manifest.to_yaml().unwrap()).unwrap();
    };
    write(&proposal);
    proposal.manifest.declarations.exclude = load_cleaned(&place).unwrap().excluded;
    write(&proposal);
    for one in &proposal.manifest.declarations.exclude {
        println!("{}: {} ({})", one.file, one.summary_text(), one.rows.clone().unwrap_or_default());
    }
    let read = load_path(&place).unwrap().trials;
    let trials = read.into_iter().map(|trial| trial.map_err(|refusal| refusal.to_string()));
    (proposal, trials.collect())
}

fn channel<'a>(proposal: &'a ManifestProposal, column: &str) -> Option<&'a str> {
    let guess = proposal.guesses.iter().find(|guess| guess.column == column).unwrap();
    guess.channel.as_deref()
}

#[test]
fn a_full_scale_log_is_read_with_its_faults_excluded() {
    let Some(folder) = shared::data("gunnerus") else { return };
    let (proposal, trials) = import(&files(&folder, "csv"));
    for (column, wanted) in [
        ("tvec", "t"),
        ("N", "x"),
        ("E", "y"),
        ("phi", "phi"),
        ("psi", "psi"),
        ("u", "u"),
        ("v", "v"),
        ("r", "r"),
        ("Azi", "delta"),
        ("RPM", "n"),
    ] {
        assert_eq!(channel(&proposal, column), Some(wanted), "{column}");
    }
    let manifest = &proposal.manifest.manifest;
    assert_eq!(manifest.conventions.rudder_positive, RudderSign::PortTurn);
    assert_eq!((&*manifest.columns["psi"].unit, &*manifest.columns["r"].unit), ("deg", "deg/s"));
    let excluded = &proposal.manifest.declarations.exclude;
    let count = |channel: &str, why: &str| -> usize {
        let of = excluded.iter().filter(|one| one.channel.as_deref() == Some(channel));
        of.filter(|one| one.why.contains(why)).map(|one| one.rows.as_ref().unwrap().count()).sum()
    };
    assert!((20..80).contains(&count("psi", "averages")), "{excluded:?}");
    let trial = trials.into_iter().next().unwrap().unwrap();
    assert!(trial.len() > 8500, "{}", trial.len());
}

#[test]
fn tank_files_without_names_are_read() {
    let Some(folder) = shared::data("kvlcc2-hsva") else { return };
    let (proposal, trials) = import(&files(&folder, "dat"));
    let wanted = ["t", "x", "y", "psi", "v_north", "v_east", "r"];
    for (place, wanted) in wanted.into_iter().enumerate() {
        assert_eq!(channel(&proposal, &format!("#{}", place + 1)), Some(wanted));
    }
    assert_eq!(channel(&proposal, "#9"), Some("delta"));
    assert_eq!(channel(&proposal, "#10"), Some("n"));
    for number in ["#8", "#11", "#12"] {
        assert_eq!(channel(&proposal, number), None, "{number}");
    }
    let manifest = &proposal.manifest.manifest;
    assert_eq!(manifest.conventions.rudder_positive, RudderSign::PortTurn);
    assert_eq!((trials.len(), &*manifest.columns["n"].unit), (8, "rps"));
    for trial in trials {
        let trial = trial.unwrap();
        let u = trial.channel(Channel::U).unwrap();
        assert!(u.iter().all(|u| (0.3..1.5).contains(u)), "{}", trial.name);
    }
}

#[test]
fn a_catamaran_is_read_and_its_thrusters_are_named() {
    let Some(folder) = shared::data("blueboat") else { return };
    let (proposal, trials) = import(&files(&folder, "csv"));
    assert_eq!(&*proposal.manifest.manifest.columns["t"].unit, "ms");
    assert_eq!(channel(&proposal, "x_ned"), Some("x"));
    assert_eq!(channel(&proposal, "yaw_rate"), Some("r"));
    assert_eq!(channel(&proposal, "right_force"), None);
    assert!(proposal.notes[0].contains("thr_left") && proposal.notes[0].contains("maximum"));
    // The ship turns towards the thruster that the file calls the left one.
    assert_eq!(channel(&proposal, "thr_left"), Some("n_s"));
    assert_eq!(channel(&proposal, "thr_right"), Some("n_p"));
    assert_eq!(&*proposal.manifest.manifest.columns["n_p"].unit, "pwm");
    assert_eq!(trials.len(), 8);
    for trial in trials {
        println!("{:?}", trial.as_ref().map(|trial| (trial.name.clone(), trial.len())));
        let trial = trial.unwrap();
        let starboard = trial.channel(Channel::NS).unwrap();
        assert!(starboard.iter().all(|n_rps| n_rps.abs() <= 20.0), "{}", trial.name);
    }
}

#[test]
fn a_patrol_ship_with_two_rudders_is_read() {
    let Some(folder) = shared::data("patrol-ship") else { return };
    let (proposal, trials) = import(&files(&folder, "csv"));
    for (column, wanted) in [("deltal", "delta_p"), ("deltar", "delta_s"), ("n", "n"), ("p", "p")] {
        assert_eq!(channel(&proposal, column), Some(wanted), "{column}");
    }
    for column in ["Vw", "alpha_x", "alpha_y"] {
        assert_eq!(channel(&proposal, column), None, "{column}");
    }
    let manifest = &proposal.manifest.manifest;
    for name in ["delta_p", "phi", "r", "p"] {
        assert!(manifest.columns[name].unit.starts_with("rad"), "{name}");
    }
    assert_eq!(&*manifest.columns["n"].unit, "rpm");
    trials.into_iter().next().unwrap().unwrap();
}
