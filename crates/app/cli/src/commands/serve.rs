//! `sistership serve`: the REST server.

use std::net::SocketAddr;
use std::path::{Path, PathBuf};

use clap::Args;
use sistership_api::{
    Config, DEFAULT_LISTEN, ForwardedHeader, Limits, MailSettings, RunningServer, Server,
    StartError, TrustedProxies,
};
use sistership_auth::openid::OpenIdArguments;

use super::config_file::ConfigFile;
use super::log::LogArguments;
use super::running::{LeaseArguments, memory_bytes, run_until_stopped, worker_count};
use super::store::StoreArguments;
use crate::failure::{Failure, about_file};
use crate::output;
use crate::values::address;
use crate::zoo::read_text_file;

/// Environment variable with the API key.
const API_KEY_VARIABLE: &str = "SISTERSHIP_API_KEY";
/// Environment variable with the URL of the SMTP server.
const SMTP_URL_VARIABLE: &str = "SISTERSHIP_SMTP_URL";

const EXAMPLES: &str = "\
Examples:
  sistership serve
  sistership serve --listen 127.0.0.1:9000 --data-dir /var/lib/sistership
  sistership serve --listen 0.0.0.0:8080 --database-url postgres://user@host/sistership --api-key-file /run/secrets/key

The API key is read from SISTERSHIP_API_KEY or --api-key-file, never from a flag that others could
see; requests carry it as `Authorization: Bearer KEY`. Without a key or --accounts the server
listens on loopback only. Stop it with Ctrl-C or SIGTERM: running jobs get --drain-s to finish and
then return to the queue.";

/// Run the REST server.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct ServeArguments {
    /// Address and port; port 0 selects a free one [default: 127.0.0.1:8080].
    #[arg(long, value_name = "ADDRESS:PORT", env = "SISTERSHIP_LISTEN", value_parser = address)]
    listen: Option<SocketAddr>,
    #[command(flatten)]
    store: StoreArguments,
    /// File with the API key; overrides SISTERSHIP_API_KEY.
    #[arg(long, value_name = "FILE", env = "SISTERSHIP_API_KEY_FILE")]
    api_key_file: Option<PathBuf>,
    /// Require users to sign in with name and password (`sistership users`) or a key.
    #[arg(long, env = "SISTERSHIP_ACCOUNTS")]
    accounts: bool,
    /// Number of concurrent jobs, 0 to 64, and one small job besides; with 0 jobs are left to other processes on the same
    /// database (`sistership work`) [default: 1].
    #[arg(long, value_name = "N", env = "SISTERSHIP_WORKERS")]
    workers: Option<u16>,
    /// Run no jobs; overrides --workers.
    #[arg(long)]
    no_worker: bool,
    /// Memory for all requests together, MB, at least 32; requests beyond it wait or are refused
    /// [default: 256].
    #[arg(long, value_name = "MB", env = "SISTERSHIP_REQUEST_MEMORY_MB")]
    request_memory_mb: Option<u64>,
    /// Memory for all jobs together, MB, at least 32 [default: 1024].
    #[arg(long, value_name = "MB", env = "SISTERSHIP_JOB_MEMORY_MB")]
    job_memory_mb: Option<u64>,
    /// Largest number of jobs of one person that wait or run at a time, 1 to 1000000 [default:
    /// 1000].
    #[arg(long, value_name = "N", env = "SISTERSHIP_JOBS_PER_PERSON")]
    jobs_per_person: Option<u32>,
    /// Largest number of connections, 16 to 65536 [default: 1024].
    #[arg(long, value_name = "N", env = "SISTERSHIP_CONNECTIONS")]
    connections: Option<u32>,
    /// Largest number of connections of one address; raise it behind a proxy [default: half of the
    /// connections].
    #[arg(long, value_name = "N", env = "SISTERSHIP_CONNECTIONS_PER_ADDRESS")]
    connections_per_address: Option<u32>,
    /// Trusted proxy, by address or network such as 10.0.0.0/8, whose header gives the address of a
    /// client for limits and the audit; repeatable.
    #[arg(long, value_name = "CIDR", env = "SISTERSHIP_TRUSTED_PROXIES", value_delimiter = ',')]
    trusted_proxy: Vec<String>,
    /// Header with the address of the client, x-forwarded-for or forwarded [default:
    /// x-forwarded-for].
    #[arg(long, value_name = "NAME", env = "SISTERSHIP_FORWARDED_HEADER")]
    forwarded_header: Option<String>,
    /// Allow webhooks to addresses of private networks and over plain http; administrators set the
    /// addresses.
    #[arg(long, env = "SISTERSHIP_WEBHOOKS_PRIVATE")]
    webhooks_private: bool,
    /// File with the URL of the SMTP server that mails events, such as
    /// smtps://user:password@host:465; overrides SISTERSHIP_SMTP_URL.
    #[arg(long, value_name = "FILE", env = "SISTERSHIP_SMTP_URL_FILE")]
    smtp_url_file: Option<PathBuf>,
    /// Address of the sender of mail.
    #[arg(long, value_name = "ADDRESS", env = "SISTERSHIP_MAIL_FROM")]
    mail_from: Option<String>,
    #[command(flatten)]
    openid: Box<OpenIdArguments>,
    #[command(flatten)]
    lease: LeaseArguments,
    #[command(flatten)]
    log: LogArguments,
}

/// Runs the command until it is stopped.
///
/// # Errors
/// Returns an error if the configuration is refused, or if the store or the address cannot be used.
pub fn run(serve: &ServeArguments, zoo: &[PathBuf]) -> Result<(), Failure> {
    if !zoo.is_empty() {
        // Folders of a zoo would make versions depend on files outside of the store.
        return Err(Failure::Call(
            "a server has no --zoo: its ships and laws are in its database; send them to \
             /v1/ships and /v1/laws. Diagnoses use the effects of the program"
                .into(),
        ));
    }
    let file = serve.store.read_config()?;
    let config = server_config(serve, &file)?;
    // After the configuration: its faults are printed as errors of the call, not logged.
    let _traces = serve.log.start_log(&file)?;
    let start = async {
        let running = Server::start(config.clone()).await.map_err(start_failure)?;
        let url = running.url();
        output::print_result(false, &(), || format!("sistership listens on {url}"))?;
        Ok(running)
    };
    run_until_stopped(config.stop_deadline(), start, RunningServer::stop)
}

fn server_config(serve: &ServeArguments, file: &ConfigFile) -> Result<Config, Failure> {
    let place = serve.store.resolve_place(file)?;
    let mut config = Config::new(place.data_dir);
    config.objects = place.objects;
    config.listen = serve.listen.or(file.listen).unwrap_or(DEFAULT_LISTEN);
    config.database_url = place.database_url;
    // Flags and environment variables come before the file.
    config.workers = if serve.no_worker { 0 } else { worker_count(serve.workers, file, 0)? };
    config.leases = serve.lease.lease_settings(file)?;
    config.limits = numeric_limits(serve, file)?;
    let limits = &mut config.limits;
    limits.request_memory = memory_bytes(
        "request_memory_mb",
        serve.request_memory_mb,
        file.request_memory_mb,
        limits.request_memory,
    )?;
    limits.job_memory =
        memory_bytes("job_memory_mb", serve.job_memory_mb, file.job_memory_mb, limits.job_memory)?;
    let key_files = [&serve.api_key_file, &file.api_key_file];
    config.api_key = read_secret(key_files, API_KEY_VARIABLE)?;
    config.mail = mail_settings(serve, file)?;
    config.proxies = trusted_proxies(serve, file)?;
    config.accounts = serve.accounts || file.accounts.unwrap_or(false);
    config.openid = serve
        .openid
        .resolve_settings(&file.oidc)
        .map_err(|error| Failure::Call(error.to_string()))?;
    // Without a key or accounts only a loopback address is allowed.
    config.check().map_err(start_failure)?;
    Ok(config)
}

/// Returns the trusted proxies of the flags, else of the file.
fn trusted_proxies(serve: &ServeArguments, file: &ConfigFile) -> Result<TrustedProxies, Failure> {
    let named = match serve.trusted_proxy.is_empty() {
        true => file.trusted_proxies.as_deref().unwrap_or_default(),
        false => &serve.trusted_proxy,
    };
    let wrong = |field: &str, message: String| Failure::Call(format!("{field}: {message}"));
    let network = |text: &String| text.parse().map_err(|why| wrong("trusted_proxy", why));
    let header = serve.forwarded_header.as_ref().or(file.forwarded_header.as_ref());
    Ok(TrustedProxies {
        networks: named.iter().map(network).collect::<Result<_, _>>()?,
        header: header
            .map_or(Ok(ForwardedHeader::default()), |name| name.parse())
            .map_err(|why| wrong("forwarded_header", why))?,
    })
}

/// Returns the limits of connections and of jobs.
fn numeric_limits(serve: &ServeArguments, file: &ConfigFile) -> Result<Limits, Failure> {
    // Checked here, with the name of the setting; the server takes the numbers as they are.
    let within = |name: &str, value: u32, least: u32, most: u32| match (least..=most)
        .contains(&value)
    {
        true => Ok(value as usize),
        false => Err(Failure::Call(format!("{name} must be from {least} to {most}, not {value}"))),
    };
    let mut limits = Limits { webhooks_private: serve.webhooks_private, ..Limits::default() };
    if let Some(connections) = serve.connections.or(file.connections) {
        limits.connections = within("connections", connections, 16, 1 << 16)?;
        // The default of one address follows the total, unless it is set below.
        limits.connections_per_address = limits.connections / 2;
    }
    if let Some(jobs) = serve.jobs_per_person.or(file.jobs_per_person) {
        limits.jobs_per_person = within("jobs_per_person", jobs, 1, 1_000_000)? as u32;
    }
    if let Some(share) = serve.connections_per_address.or(file.connections_per_address) {
        limits.connections_per_address =
            within("connections_per_address", share, 1, limits.connections as u32)?;
    }
    Ok(limits)
}

/// Returns the settings of mail; both are set or none.
fn mail_settings(
    serve: &ServeArguments,
    file: &ConfigFile,
) -> Result<Option<MailSettings>, Failure> {
    let smtp_url = read_secret([&serve.smtp_url_file, &file.smtp_url_file], SMTP_URL_VARIABLE)?;
    let from = serve.mail_from.as_ref().or(file.mail_from.as_ref());
    match (smtp_url, from) {
        (None, None) => Ok(None),
        (Some(smtp_url), Some(from)) => Ok(Some(MailSettings { smtp_url, from: from.clone() })),
        (Some(_), None) => Err(Failure::Call(
            "mail_from: mail needs a sender; set --mail-from, such as ships@example.com".into(),
        )),
        (None, Some(_)) => Err(Failure::Call(format!(
            "mail_from: mail needs a server; set {SMTP_URL_VARIABLE} or --smtp-url-file"
        ))),
    }
}

/// Returns a secret from the file of the flag, the environment, or the file that the configuration
/// names.
fn read_secret(
    [flag, configured]: [&Option<PathBuf>; 2],
    variable: &str,
) -> Result<Option<String>, Failure> {
    if let Some(path) = flag {
        // A flag comes before the environment, the environment before the configuration file.
        return read_secret_file(path).map(Some);
    }
    match std::env::var(variable).ok().filter(|secret| !secret.is_empty()) {
        Some(secret) => Ok(Some(secret)),
        None => configured.as_deref().map(read_secret_file).transpose(),
    }
}

fn read_secret_file(file: &Path) -> Result<String, Failure> {
    let secret = read_text_file(file)?.trim().to_owned();
    if secret.is_empty() {
        Err(about_file(file, "is empty; write the secret into it"))
    } else {
        Ok(secret)
    }
}

/// Converts an error; one that concerns only the call gives the exit status of a wrong call.
fn start_failure(error: StartError) -> Failure {
    match error {
        StartError::OpenWithoutKey(listen) => Failure::Call(format!(
            "refusing to listen on {listen} without an API key: set {API_KEY_VARIABLE} or \
             --api-key-file, use accounts with --accounts, or listen on 127.0.0.1"
        )),
        // Errors of the call, which the user can correct without looking at the data.
        StartError::Key | StartError::OpenIdWithoutAccounts | StartError::Mail(_) => {
            Failure::Call(error.to_string())
        }
        other => Failure::Refused(other.to_string()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_are_read() {
        assert_eq!(address("127.0.0.1:8080"), Ok(DEFAULT_LISTEN));
        assert!(address("8080").is_err_and(|error| error.to_string().contains("127.0.0.1:8080")));
    }

    #[test]
    fn an_open_server_is_a_call_that_is_wrong() {
        let failure = start_failure(StartError::OpenWithoutKey(([0, 0, 0, 0], 80).into()));
        assert_eq!(failure.exit_status(), 2);
        assert!(failure.message().is_some_and(|message| message.contains("--api-key-file")));
    }
}
