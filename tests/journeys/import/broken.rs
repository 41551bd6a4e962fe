//! Files that cannot be imported: each answer says what is wrong and what to do.

use sistership_tests::binary;

/// A file's name, its bytes, and what the message must contain.
const BROKEN: [(&str, &[u8], &str); 6] = [
    ("picture.csv", b"\x89PNG\r\n\x1a\n0000", "PNG"),
    ("empty.csv", b"", "the file is empty"),
    ("text.csv", b"these are notes\nof a voyage\n", "no column for time"),
    ("no_time.csv", b"surge [m/s],rudder [deg]\n1,2\n1,2\n1,2\n", "no column for time"),
    (
        "days.csv",
        b"timestamp,surge [m/s]\n05/01/2024 10:00:00,1\n05/01/2024 10:00:01,1\n",
        "`day/month/year` or `month/day/year`",
    ),
    ("old.xls", b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1xxxxxxxx", "save it as .xlsx"),
];

#[test]
fn what_cannot_be_read_says_why() {
    for (name, bytes, wanted) in BROKEN {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join(name);
        std::fs::write(&path, bytes).expect("written");
        let path = path.to_str().expect("text");
        let output = binary::run(&["import", path, "--ship", "a"]);
        let said = String::from_utf8_lossy(&output.stderr).into_owned()
            + &String::from_utf8_lossy(&output.stdout);
        assert_eq!(output.status.code(), Some(1), "{name}: {said}");
        assert!(said.contains(wanted), "{name}: {said}");
        // With columns the manifest stays, to be put right.
        let has_columns = ["text.csv", "no_time.csv", "days.csv"].contains(&name);
        assert_eq!(folder.path().join("trials.yaml").exists(), has_columns, "{name}");
    }
}
