#![allow(clippy::unwrap_used)]
use super::*;
use crate::load::load_path;
use crate::manifest::read_manifest_file;

const LOG: &str = "Ship: A\nRun 3\n\nDate/Time;Latitude;Longitude;Heading;Rudder angle;Shaft \
 RPM;Rudder order;Crew\n\
                   ;deg;deg;deg;deg;rpm;deg;\n";

/// Northwards at 5 m/s, a second apart.
fn log() -> String {
    let rows = (0..40).map(|k| {
        let latitude = format!("{:.7}", 51.0 + 5.0 / 111_250.0 * f64::from(k)).replace('.', ",");
        let heading = if k % 2 == 0 { "0,01" } else { "359,99" };
        format!("2024-05-01 12:00:{k:02};{latitude};3,5;{heading};1,{k:02};120;0;b\n")
    });
    LOG.to_owned() + &rows.collect::<String>()
}

#[test]
fn a_proposed_manifest_reads_the_file_it_was_made_for() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("run3.csv");
    std::fs::write(&file, log()).unwrap();
    let proposal = propose_manifest("a", &[&file]).unwrap();
    let text = proposal.manifest.to_yaml().unwrap();
    assert_eq!(read_manifest_file("m", &text).unwrap(), proposal.manifest, "{text}");
    let guess = |column: &str| proposal.guesses.iter().find(|one| one.column == column).unwrap();
    assert_eq!(guess("Rudder angle").channel.as_deref(), Some("delta"));
    assert!(guess("Rudder angle").certain, "{:?}", guess("Rudder angle"));
    assert_eq!(guess("Date/Time").unit.as_deref(), Some("timestamp"));
    assert_eq!(guess("Rudder order").channel, None);
    assert_eq!(proposal.manifest.declarations.ignore, ["Crew", "Rudder order"]);
    std::fs::write(folder.path().join("m.yaml"), text).unwrap();
    let loaded = load_path(&folder.path().join("m.yaml")).unwrap();
    let trial = loaded.trials[0].as_ref().unwrap();
    use sistership_model::trial::Channel;
    assert_eq!(trial.len(), 40);
    let u = trial.channel(Channel::U).unwrap();
    assert!(u.iter().all(|u| (u - 5.0).abs() < 0.05), "{u:?}");
    assert!((trial.channel(Channel::N).unwrap()[0] - 2.0).abs() < 1e-12);
    assert!(trial.channel(Channel::R).is_some() && trial.channel(Channel::V).is_some());
}

#[test]
fn further_files_are_trials_or_sensors() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| {
        let path = folder.path().join(name);
        std::fs::write(&path, text).unwrap();
        path
    };
    let one = write("one.csv", "time [s],heading [deg]\n0,10\n1,11\n");
    let two = write("two.csv", "time [s],heading [deg]\n0,20\n1,21\n");
    let rudder = write("rudder.csv", "t_s,rudder port %\n0,50\n1,60\n");
    let proposal = propose_manifest("a", &[&one, &two, &rudder]).unwrap();
    let ManifestFile { manifest, sensors, .. } = &proposal.manifest;
    assert_eq!(manifest.trials.len(), 2);
    assert_eq!((sensors[0][0].file.as_str(), sensors[1].len()), ("rudder.csv", 0));
    let second = write("two_rudder.csv", "t_s,rudder port %\n0,50\n1,60\n");
    let proposal = propose_manifest("a", &[&one, &two, &second]).unwrap();
    assert_eq!(proposal.manifest.sensors[1][0].file, "two_rudder.csv");
    assert_eq!(proposal.guesses[5].channel.as_deref(), Some("delta_p"), "{:?}", proposal.guesses);
    let picture = write("scan.png", "");
    std::fs::write(&picture, b"\x89PNG\r\n\x1a\n").unwrap();
    let missing = folder.path().join("lost.csv");
    let errors = propose_manifest("a", &[&one, &picture, &missing]).unwrap_err();
    assert_eq!(errors.len(), 2);
    assert!(errors[0].to_string().contains("a picture"), "{}", errors[0]);
}

#[test]
fn a_log_tells_itself_what_it_holds() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("log.nmea");
    let summed =
        |body: &str| format!("${body}*{:02X}\n", body.bytes().fold(0, |sum, byte| sum ^ byte));
    let place = summed("GPGGA,120003,5130.000,N,00930.000,E,1,8,1,1,M,1,M,,");
    std::fs::write(&path, place + &summed("HEHDT,10.0,T")).unwrap();
    let proposal = propose_manifest("a", &[&path]).unwrap();
    let channels = proposal.guesses.iter().filter_map(|guess| guess.channel.as_deref());
    assert_eq!(channels.collect::<Vec<_>>(), ["psi", "latitude", "longitude"]);
    assert_eq!(proposal.manifest.declarations.derive.len(), 3);
    assert!(proposal.manifest.manifest.columns.is_empty());
}
