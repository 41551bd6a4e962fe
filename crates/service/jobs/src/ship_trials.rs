//! Trials of a ship, read page by page.

use sistership_store::{Result, Store, Trial, read_all_pages, visit_pages};

/// Reads all trials of a ship, oldest first.
pub(crate) async fn all_trials(store: &Store, ship: &str) -> Result<Vec<Trial>> {
    let trials = store.trials();
    read_all_pages(|page| async move { trials.list(ship, &page).await }).await
}

/// Reads the newest trials of a ship that are accepted, at most `count`, oldest first.
pub(crate) async fn newest_trials(
    store: &Store,
    ship: &str,
    count: usize,
    accepts: impl Fn(&Trial) -> bool,
) -> Result<Vec<Trial>> {
    let (trials, mut newest) = (store.trials(), Vec::new());
    // Pages come oldest first; only the last `count` rows are kept in memory.
    let keep_last = |rows: Vec<Trial>| {
        newest.extend(rows.into_iter().filter(&accepts));
        newest.drain(..newest.len().saturating_sub(count));
        Ok(())
    };
    visit_pages(|page| async move { trials.list(ship, &page).await }, keep_last).await?;
    Ok(newest)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use sistership_store::testing::{TestDatabase, TestStore};
    use sistership_store::{NewShip, NewTrial};

    use super::*;
    use crate::test_rows::new_trial;

    /// A ship with more trials than a page has: the first half are turns, the second zigzags.
    async fn with_trials(count: usize) -> TestStore {
        let on = TestDatabase::new_sqlite().open().await;
        let (name, title, category) = ("kcs".to_owned(), "KCS".to_owned(), "container".to_owned());
        let ship = NewShip { name, title, category, document: "{}".to_owned() };
        on.store.ships().create(&ship).await.unwrap();
        let all: Vec<NewTrial> = (0..count)
            .map(|number| {
                let manoeuvre = if 2 * number < count { "turn 35" } else { "zigzag 10/10" };
                new_trial("kcs", &number.to_string(), Some(manoeuvre))
            })
            .collect();
        on.store.trials().insert_all(&all).await.unwrap();
        on
    }

    #[tokio::test]
    async fn trials_beyond_one_page_are_read() {
        let on = with_trials(2100).await;
        let names = |trials: Vec<Trial>| -> Vec<String> {
            trials.into_iter().map(|trial| trial.name).collect()
        };
        let every: Vec<String> = (0..2100).map(|number| number.to_string()).collect();
        assert_eq!(names(all_trials(&on.store, "kcs").await.unwrap()), every);
        let turns = |trial: &Trial| trial.manoeuvre.as_deref() == Some("turn 35");
        let newest = newest_trials(&on.store, "kcs", 3, turns).await.unwrap();
        assert_eq!(names(newest), ["1047", "1048", "1049"]);
    }
}
