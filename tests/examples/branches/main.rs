//! Learned branches on data, one command each:
//!
//! `cargo run --release -p sistership-learned --example branches -- rm-rf`, or `esso-osaka`,
//! which takes the window in seconds after it, or `wakita`, which takes the epochs and then names
//! of types, or `rates`; of Kanazawa 2023 on a virtual ship `paper-i`, `paper-ii`, `paper-iii`,
//! `paper-vi`, and `paper-iv`, which takes a ship of the zoo after it.

#[path = "../../src/esso_osaka.rs"]
mod esso_osaka;
mod measured;
mod osaka;
mod paper_i;
mod paper_ii;
mod paper_iii;
mod paper_iv;
mod paper_vi;
mod rates;
mod rm_rf;
mod rm_rf_data;
#[path = "../../accuracy/esso_osaka/score.rs"]
#[allow(dead_code)]
mod score;
mod vessel;
mod wakita;

fn main() {
    let asked = std::env::args().nth(1).unwrap_or_default();
    let window_s = std::env::args().nth(2).and_then(|text| text.parse().ok());
    match asked.as_str() {
        "rm-rf" => rm_rf::run(),
        "esso-osaka" => osaka::run(window_s.unwrap_or(osaka::WINDOW_S)),
        "wakita" => {
            let epochs = window_s.map_or(wakita::EPOCHS, |epochs: f64| epochs as usize);
            let wanted: Vec<String> = std::env::args().skip(3).collect();
            wakita::run(epochs, &wanted);
        }
        "rates" => rates::run(),
        "paper-i" => paper_i::run(paper_i::Size::PAPER),
        "paper-ii" => paper_ii::run(paper_ii::Size::PAPER),
        "paper-iii" => paper_iii::run(paper_iii::Size::PAPER),
        "paper-iv" => {
            let vessel = std::env::args().nth(2);
            let vessel = vessel.as_deref().unwrap_or(vessel::hull::VESSEL);
            paper_iv::run(vessel, paper_iv::Size::PAPER);
        }
        "paper-vi" => paper_vi::run(20),
        _ => println!("which? rm-rf, esso-osaka, wakita, rates, paper-i to paper-iv or paper-vi"),
    }
}
