//! Tests through the real server, on SQLite, and on PostgreSQL if this machine has it.

#![allow(clippy::unwrap_used)]

/// Makes two tests of each function: one on SQLite, one on PostgreSQL.
macro_rules! on_both_databases {
    ($($name:ident),* $(,)?) => {
        mod sqlite {$(
            #[tokio::test(flavor = "multi_thread", worker_threads = 2)]
            async fn $name() {
                super::$name(super::TestDatabase::new_sqlite()).await;
            }
        )*}

        mod postgres {$(
            #[tokio::test(flavor = "multi_thread", worker_threads = 2)]
            async fn $name() {
                let Some(database) = super::TestDatabase::new_postgres().await else { return };
                super::$name(database).await;
            }
        )*}
    };
}

mod access;
mod contract;
mod documents;
mod foreign;
mod form_jobs;
mod harness;
mod keys;
mod loops;
mod mail;
mod network;
mod observed;
mod openid;
mod refusals;
mod registry;
mod search;
mod sessions;
mod statements;
mod under_way;
mod uploads;
mod webhooks;
