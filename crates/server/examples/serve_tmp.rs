#[tokio::main]
async fn main() {
    tracing_subscriber();
    let mut c = sistership_server::Config::new(std::env::args().nth(1).unwrap());
    c.listen = "127.0.0.1:8099".parse().unwrap();
    c.api_key = std::env::var("KEY").ok();
    let r = match sistership_server::Server::start(c).await {
        Ok(r) => r,
        Err(e) => {
            eprintln!("{e}");
            std::process::exit(2)
        }
    };
    println!("{}", r.url());
    tokio::signal::ctrl_c().await.unwrap();
    r.stop().await;
    println!("stopped");
}
fn tracing_subscriber() {}
