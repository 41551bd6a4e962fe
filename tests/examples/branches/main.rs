//! Learned branches on data, one command each:
//!
//! `cargo run --release -p sistership-branches --example branches -- rm-rf`, or `esso-osaka`,
//! which takes the window in seconds after it, or `wakita`, which takes the epochs, or `rates`.

#[path = "../../src/esso_osaka.rs"]
mod esso_osaka;
mod measured;
mod osaka;
mod rates;
mod rm_rf;
mod rm_rf_data;
#[path = "../../accuracy/esso_osaka/score.rs"]
#[allow(dead_code)]
mod score;
mod wakita;

fn main() {
    let asked = std::env::args().nth(1).unwrap_or_default();
    let window_s = std::env::args().nth(2).and_then(|text| text.parse().ok());
    match asked.as_str() {
        "rm-rf" => rm_rf::run(),
        "esso-osaka" => osaka::run(window_s.unwrap_or(osaka::WINDOW_S)),
        "wakita" => wakita::run(window_s.map_or(wakita::EPOCHS, |epochs: f64| epochs as usize)),
        "rates" => rates::run(),
        _ => println!("which? rm-rf, esso-osaka, wakita or rates"),
    }
}
