//! A source of one law as the prior of another: what the trials do not tell stays as the source
//! says.

use sistership_identification::refine::{
    EstimationMethod, Refinement, RefinementSettings, RefinementSpec, TermFamily, refine,
};
use sistership_model::trial::{Channel, Trial};
use sistership_model::{Law, Model, Zoo};
use sistership_priors::transfer::{blank_model, trial_approach};
use sistership_simulation::manoeuvre::{ManoeuvreSettings, simulate_turn, simulate_zigzag};
use sistership_simulation::state::{RECORDED_CHANNELS, at};

use super::{model, ready};

/// A ship like the KVLCC2, whose hull damps less and whose rudder does less.
fn sister(source: &Model) -> Model {
    let mut truth = source.clone();
    for (name, factor) in [("Y_v", 0.85), ("N_v", 1.1), ("Y_r", 1.15), ("N_r", 0.85)] {
        truth.coefficients.get_mut(name).into_iter().for_each(|quantity| quantity.value *= factor);
    }
    truth
}

/// Zigzags by the truth at two samples a second.
fn zigzags(truth: &Model, law: &Law) -> Vec<Trial> {
    let ship = ready(truth, law);
    let settings = ManoeuvreSettings {
        step_s: Some(0.5),
        duration_s: Some(900.0),
        ..ManoeuvreSettings::default()
    };
    let one = |(rudder, switch): (f64, f64)| {
        let track = simulate_zigzag(&ship, rudder, switch, &settings).expect("a zigzag").track;
        let columns = RECORDED_CHANNELS[..6].iter().chain(&[(Channel::Delta, at::DELTA)]);
        let mut channels: std::collections::BTreeMap<_, _> =
            columns.map(|&(c, place)| (c, track.state_column(place))).collect();
        channels.insert(Channel::N, track.n_rps.clone());
        Trial {
            name: format!("zigzag {rudder}/{switch}"),
            t_s: track.t_s,
            channels,
            ..Trial::default()
        }
    };
    [(10.0, 10.0), (-10.0, 10.0), (20.0, 20.0), (-20.0, 20.0)].map(one).to_vec()
}

fn refined(source: &Model, own: &Law, law: &Law, trials: &[Trial]) -> Refinement {
    let zoo = Zoo::load_embedded().unwrap_or_else(|error| panic!("{error}"));
    let target = zoo.vessel("kvlcc2").expect("in the zoo");
    let trials: Vec<&Trial> = trials.iter().collect();
    let strengths = vec![1.0, 0.1, 1e-2, 1e-3];
    let settings = RefinementSettings {
        method: EstimationMethod::Weak,
        families: vec![TermFamily::Own],
        strengths,
        ..RefinementSettings::default()
    };
    let request = RefinementSpec {
        target,
        source,
        source_law: Some(own),
        law,
        trials: &trials,
        population: &[],
        settings: &settings,
    };
    refine(&request, &|_, _| true).unwrap_or_else(|error| panic!("{error}"))
}

/// Tactical diameter at 35 deg in lengths; none where it does not turn.
fn diameter(model: &Model, law: &Law) -> Option<f64> {
    let ship = ready(model, law);
    let turn = simulate_turn(&ship, 35.0, &ManoeuvreSettings::default()).ok()?;
    Some(turn.metrics.tactical_diameter_m? / ship.lpp_m())
}

/// Zigzags tell a law of 189 coefficients little of a hard turn: a source of another law does.
#[test]
fn an_mmg_source_keeps_the_turn_of_a_polynomial_that_saw_only_zigzags() {
    let (source, own) = model("kvlcc2");
    let truth = sister(&source);
    let trials = zigzags(&truth, &own);
    let (zoo, law) = (Zoo::load_embedded().unwrap_or_else(|error| panic!("{error}")), "low-speed");
    let law = zoo.law(law).expect("in the zoo");
    let across = refined(&source, &own, law, &trials);
    let nothing = blank_model(
        law,
        zoo.vessel("kvlcc2").expect("in the zoo"),
        trial_approach(&trials.iter().collect::<Vec<_>>()),
    );
    let alone = refined(&nothing.unwrap_or_else(|error| panic!("{error}")), law, law, &trials);
    let wanted = diameter(&truth, &own).expect("the truth turns");
    let off_by = |model: &Model| {
        diameter(model, law).map_or(f64::INFINITY, |diameter| (diameter - wanted).abs())
    };
    let off = |refinement: &Refinement| off_by(&refinement.model);
    println!(
        "truth {wanted:.3}, with the source off by {:.3}, without by {:.3} lengths",
        off(&across),
        off(&alone)
    );
    assert!(off(&across) < 0.125 * wanted && off(&across) < 0.5 * off(&alone));
    assert!(off(&across) < off_by(&across.transferred), "the trials have improved its turn");
    assert!(
        across.held_out.refined["psi"] < across.held_out.source["psi"],
        "the trials have improved it"
    );
    let said = across
        .remarks
        .iter()
        .find(|remark| remark.contains("the source `kvlcc2/mmg` has the law `mmg`"));
    assert!(said.is_some_and(|said| said.contains("low-speed")), "{:?}", across.remarks);
}

/// Where the other law can say all that the source says, it does.
#[test]
fn a_law_under_another_name_says_the_same() {
    let (kvlcc2, mmg) = model("kvlcc2");
    let trials = zigzags(&kvlcc2, &mmg);
    let zoo = Zoo::load_embedded().unwrap_or_else(|error| panic!("{error}"));
    let law = zoo.law("low-speed").expect("in the zoo");
    let source = refined(&kvlcc2, &mmg, law, &trials).transferred;
    let renamed = Law { name: "low-speed-again".into(), ..(**law).clone() };
    let again = refined(&source, law, &renamed, &trials).transferred;
    let [before, after] = [&source, &again].map(|model| diameter(model, law).expect("it turns"));
    assert!((before - after).abs() < 0.01 * before, "{before} became {after}");
}
