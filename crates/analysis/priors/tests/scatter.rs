//! The scatter that each regression's file states is its error against published sets of
//! derivatives of the zoo, one for each hull.

#![allow(clippy::unwrap_used)]

use sistership_model::{Model, Zoo};
use sistership_priors::estimates::RegressionLibrary;
use sistership_priors::estimates::inputs::FormulaInputs;

/// Published sets of the law `mmg` and its kin; one of each hull. Seiun Maru's is left out: part of
/// it comes of formulas.
const HULLS: [&str; 4] = ["kvlcc2", "kcs", "onr-tumblehome-3m", "s175-3m5"];
/// Files whose scatter is chosen, and says so.
const CHOSEN: [&str; 4] = ["fujii-rudder", "ittc-1957", "watson-1998", "zoo-medians"];

fn published(model: &Model, name: &str) -> Option<f64> {
    let parameter = |name: &str| model.parameters.get(name).map(|one| one.value);
    match name {
        "gamma_R" => Some(0.5 * (parameter("gamma_R_plus")? + parameter("gamma_R_minus")?)),
        _ => model.coefficients.get(name).map(|one| one.value).or_else(|| parameter(name)),
    }
}

fn inputs(model: &Model) -> FormulaInputs {
    let speed = model.speed_m_s.unwrap();
    let mut inputs = FormulaInputs::new(&model.ship, &model.particulars, speed).unwrap();
    for name in ["m_x", "m_y"] {
        inputs.set(name, published(model, name).unwrap());
    }
    let x_g = inputs.get("x_g_m").unwrap_or(0.0);
    inputs.set("x_G", x_g / inputs.get("L").unwrap());
    inputs
}

#[test]
fn stated_scatter_is_the_error_against_published_sets() {
    let (zoo, library) =
        (Zoo::load_embedded().unwrap(), RegressionLibrary::parse_embedded().unwrap());
    let models: Vec<Model> = HULLS.iter().map(|name| zoo.find_model(name).unwrap()).collect();
    let mut wrong = Vec::new();
    for regression in &library.regressions {
        if CHOSEN.contains(&regression.name.as_str()) {
            continue;
        }
        for name in regression.value_names() {
            let mut squares = Vec::new();
            let mut stated = 0.0;
            for model in &models {
                let inputs = inputs(model);
                let given = regression.value_for(name, &|name| inputs.get(name)).unwrap();
                stated = given.scatter;
                squares.extend(published(model, name).map(|own| (given.value - own).powi(2)));
            }
            let measured = (squares.iter().sum::<f64>() / squares.len() as f64).sqrt();
            println!("{:<24} {name:<8} {measured:.4}", regression.name);
            if (measured - stated).abs() > 0.02 * measured + 1e-4 {
                wrong.push(format!("{} {name}: {stated} stated, {measured:.4}", regression.name));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
