//! Learned branches on data, one command each:
//!
//! `cargo run --release -p sistership-branches --example branches -- rm-rf | esso-osaka | rates`

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

fn main() {
    let asked = std::env::args().nth(1).unwrap_or_default();
    match asked.as_str() {
        "rm-rf" => rm_rf::run(),
        "esso-osaka" => osaka::run(),
        "rates" => rates::run(),
        _ => println!("which? rm-rf, esso-osaka or rates"),
    }
}
