//! Journeys through the real server process, over HTTP and the command line, on SQLite and on
//! PostgreSQL.

mod backup;
mod bad_input;
mod branches;
mod command_line;
mod crash;
mod crowd;
mod diagnosis_on_files;
mod diagnosis_over_http;
mod exports;
mod families;
mod fleet;
mod full_disk;
mod import;
mod lacking;
mod memory;
mod operation;
mod over_http;
mod pages;
mod predictions;
mod python_client;
mod rights;
mod sea_trials;
mod sisters;
mod stopping;
mod upkeep;
