#![allow(clippy::unwrap_used)]
use std::time::{Duration, Instant};

use super::*;

fn refused(text: &str) -> String {
    let began = Instant::now();
    let error = read_document::<serde_yaml::Value>(text).unwrap_err();
    let took = began.elapsed();
    assert!(
        took < Duration::from_secs(5),
        "{took:?}: {}",
        text.chars().take(40).collect::<String>()
    );
    error.message
}

#[test]
fn brackets_are_bounded_however_they_are_written() {
    let before = [
        "",
        "a: ",
        "- ",
        "'it''s': ",
        "x: |\n  it's \"\ny: ",
        "# it's \"\n",
        "a: it's\nb: ",
        "? ",
        "a: {b: \"\\\"\", c: ",
    ];
    for open in [
        "{a: ",
        "[",
        "[[",
        "{? ",
        "{\"a\": ",
        "[a, ",
        "{a: it's, b: ",
        "[ # \"\n",
        "[\u{85}'\u{85}',",
        "[!<]]]> ",
    ] {
        for before in before {
            for count in [700, 50_000] {
                let message = refused(&format!("{before}{}", open.repeat(count)));
                assert!(
                    message.contains("64 deep") || message.contains("brackets nest"),
                    "{before}{open}: {message}"
                );
            }
        }
    }
    let nested = |depth: usize| format!("{}{}", "[".repeat(depth), "]".repeat(depth));
    assert!(read_document::<serde_yaml::Value>(&nested(MAX_DEPTH)).is_ok());
    assert!(refused(&format!("a: 1\nb: {}", nested(MAX_DEPTH + 1))).ends_with("at line 2"));
}

#[test]
fn aliases_and_tags_are_refused() {
    assert!(refused("a: &x [1]\nb: *x").contains("write out what `&x` stands for at line 2"));
    assert!(refused("[&x 1,*x]").contains("alias"));
    assert!(
        refused(&format!("a: &x \"{}\"\nb: [{}]", "y".repeat(1 << 20), "*x, ".repeat(300_000)))
            .contains("alias")
    );
    assert!(refused("%TAG !a! b\n---\na: 1").contains("%TAG"));
    assert!(read_document::<serde_yaml::Value>("a: 2 *x & y\nb: R&D\nc: u *v\nd: '&'").is_ok());
}

/// Documents as users write them: brackets in text, in comments and in strings.
#[test]
fn honest_documents_are_read() {
    let note = "note: half open [0, 1) and \"[[\" it's {\n# [[[ 'x\n";
    let entry = "- { value: 1.5, source: 'a [1]', note: \"b: {c\", list: [1, [2, 3]] }\n";
    let text =
        format!("{note}text: |\n  it's [ \"quoted\n  {{ open\nlist:\n{}", entry.repeat(20_000));
    let value: serde_yaml::Value = read_document(&text).unwrap();
    assert_eq!(value["list"].as_sequence().unwrap().len(), 20_000);
    assert!(
        read_document::<serde_yaml::Value>(&"a".repeat(MAX_BYTES + 1))
            .unwrap_err()
            .message
            .contains("the limit is")
    );
}

/// The most time that 4 MB can take, by construct: none may be worse than in proportion.
#[test]
fn no_construct_takes_more_than_its_share() {
    let fill = |unit: &str| unit.repeat((4 << 20) / unit.len());
    let blocks: String = (0..2000).map(|depth| format!("{}a:\n", " ".repeat(depth))).collect();
    let unclosed = format!("{}{}", "{\" ".repeat(200_000), fill("\" "));
    let texts = [
        ("sequences in sequences", fill("- ")),
        ("keys in keys", fill("? ")),
        ("maps in maps", blocks),
        ("strings never closed", unclosed),
        ("unclosed strings", fill("{\"")),
        ("unclosed comments", fill("[#")),
        ("small items", format!("[{}]", fill("a,"))),
        ("small maps", format!("[{}]", fill("{},"))),
        ("as many items as may be", format!("[{}]", "a,".repeat(MAX_ITEMS - 2))),
        ("as many sequences as may be", "- ".repeat(MAX_ITEMS)),
        ("a long key", format!("{}: 1", fill("k"))),
        ("long quoted key", format!("\"{}\": 1", fill("k"))),
        ("anchors", (0..300_000).map(|n| format!("- &a{n} 1\n")).collect()),
        ("documents", fill("---\na\n")),
        ("a block scalar", format!("a: |\n{}", fill("  x\n"))),
        ("blank lines", format!("a: |\n{}", fill("\n"))),
        ("tags", fill("- !a 1\n")),
        ("colons", fill(": ")),
        ("closed brackets", fill("]")),
    ];
    for (what, text) in texts {
        let began = Instant::now();
        let read = read_document::<serde_yaml::Value>(&text)
            .map(|_| ())
            .map_err(|e| e.message.chars().take(60).collect::<String>());
        let took = began.elapsed();
        println!("{what}: {took:?}: {read:?}");
        assert!(took < Duration::from_secs(4), "{what}: {took:?}: {read:?}");
    }
}

#[test]
fn a_thousand_faults_are_told_in_time() {
    let began = Instant::now();
    let fields: String = (0..90_000).map(|k| format!("f{k}: 1\n")).collect();
    let error = crate::Vessel::parse("v", &format!("kind: vessel\n{fields}")).unwrap_err();
    assert!(error.further.len() < 40 && error.to_string().len() < 20_000);
    let values: String = (0..90_000).map(|k| format!("    f{k}: 1\n")).collect();
    let head = "kind: vessel\nname: a\ntitle: A\ncategory: tanker\nsources: { s: { citation: C } }";
    let text = format!("{head}\nparticulars:\n  source: s\n  values:\n{values}");
    let error = crate::Vessel::parse("v", &text).unwrap_err();
    assert_eq!(error.further.len(), MAX_FAULTS - 1);
    assert!(began.elapsed() < Duration::from_secs(20), "{:?}", began.elapsed());
}

#[test]
fn what_may_not_be_parsed_is_not_parsed_for_its_shape() {
    let began = Instant::now();
    let text = format!("kind: vessel\nname: {}", "{a: ".repeat(50_000));
    let error = crate::Vessel::parse("v", &text).unwrap_err();
    assert!(error.further.is_empty() && error.message.contains("deep"), "{error}");
    assert!(began.elapsed() < Duration::from_secs(2), "{:?}", began.elapsed());
}
