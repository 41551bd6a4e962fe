//! Pages of a large fleet: bytes, and the time until their first byte.
//!
//! `cargo run --release -p sistership-tests --example pages -- --ships 10000 --requests 15`
//! (`SISTERSHIP_PROGRAM` names another program than the one of this tree and profile).
//!
//! Ships are made by REST in a store of their own, the server is started anew, and every page is
//! asked for once and then so many times, each by a connection of its own. The exit status is 1
//! where a page's median or first request takes more than 20 ms to its first byte, or a page has
//! more than 100 kB beside its plots.

mod arguments;
mod asked;
mod ships;

use std::process::ExitCode;
use std::time::Instant;

use arguments::Arguments;
use asked::Measured;
use sistership_tests::server::TestServer;

/// What is asked for. The ships of the fleet are those that [`ships`] makes.
const PAGES: [&str; 24] = [
    "/",
    "/?sort=name&from=ship-00500",
    "/?category=tanker&particular=lpp_m&particular_min=150&particular_max=200",
    "/?similar_to=kvlcc2",
    "/?similar_to=ship-00077",
    "/ships/kvlcc2",
    "/ships/ship-00077",
    "/ships/kvlcc2/versions/1",
    "/ships/mariner/versions/1",
    "/compare",
    "/compare?v=kvlcc2/1&v=mariner/1",
    "/playground?model=kvlcc2",
    "/zoo",
    "/zoo/laws/mmg",
    "/zoo/effects/wind",
    "/families",
    "/jobs",
    "/audit",
    "/users",
    "/account",
    "/new-ship",
    "/ships/kvlcc2/upload",
    "/sign-in",
    "/?standing=no-model",
];

#[tokio::main]
async fn main() -> ExitCode {
    let arguments = Arguments::given();
    let mut server = TestServer::sqlite().await;
    let begun = Instant::now();
    ships::made(&server, arguments.ships).await;
    println!("{} ships made in {:.0} s", arguments.ships, begun.elapsed().as_secs_f64());
    server.terminate();
    server.restart().await;
    ships::settled(&server).await;
    println!(
        "\n| page | kB | of which plots | first, ms | median of {} | longest |\n| --- | --: | --: \
         | --: | --: | --: |",
        arguments.requests
    );
    let mut met = true;
    for page in PAGES {
        let measured = Measured::of(&server, page, arguments.requests).await;
        println!("{}", measured.row(page));
        met &= measured.is_met();
    }
    println!("\nThe server took {} MB at most.", server.memory_mb().0);
    if met { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
