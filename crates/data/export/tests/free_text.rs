//! Names and sources of a model in exports: no text of a model becomes code.
#![allow(clippy::unwrap_used)]

mod shared;

use sistership_model::Zoo;

const NAME: &str = "o'neill \"two\" \\ */\nimport os";
const SOURCE: &str = "a \"book\" '\\ */\nimport os @@order";

/// The export of a model whose name and sources are hostile.
fn exported(format: &str) -> String {
    let zoo = Zoo::load_embedded().unwrap();
    let mut model = zoo.find_model("mariner").unwrap();
    model.name = NAME.to_owned();
    let quantities = model.coefficients.values_mut().chain(model.parameters.values_mut());
    quantities.chain(model.particulars.values_mut()).for_each(|one| one.source = SOURCE.to_owned());
    let bytes = shared::written(&zoo, &model, format);
    String::from_utf8(bytes).unwrap()
}

#[test]
fn a_name_is_escaped_in_strings() {
    let matlab = exported("matlab");
    let line = "model.name = 'o''neill \"two\" \\ */ import os';";
    assert!(matlab.lines().any(|one| one == line), "{matlab}");
    let modelica = exported("modelica");
    let end = "\"Ship manoeuvring model o'neill \\\"two\\\" \\\\ */ import os\"";
    assert!(modelica.lines().next().unwrap().ends_with(end), "{modelica}");
}

#[test]
fn a_source_stays_within_its_comment() {
    // Strings of MATLAB and Modelica hold the name and the sources.
    let formats = [
        ("matlab", "%", "model.name = '"),
        ("python", "#", "no string holds a source"),
        ("modelica", "//", " \""),
    ];
    for (format, comment, string) in formats {
        let text = exported(format);
        assert!(text.contains("import os @ @order"), "{format}");
        for line in text.lines() {
            let code = line.split(comment).next().unwrap();
            let is_text = code.contains(string) || !code.contains("import os");
            assert!(is_text, "{format}: {line}");
        }
    }
}

#[test]
fn a_source_does_not_end_a_comment_of_c() {
    let text = exported("c");
    let code: String =
        text.split("/*").map(|part| part.split_once("*/").map_or(part, |(_, code)| code)).collect();
    assert!(text.contains("import os") && !code.contains("import os"), "{code}");
}
