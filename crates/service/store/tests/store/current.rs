//! What an alias stands for, asked by many at once.

use std::sync::Arc;
use std::sync::atomic::{AtomicI64, Ordering};

use futures::future::join_all;
use sistership_store::{ExpectedRevision, NewReport, Store};

use crate::support::*;

/// More ships than one statement asks for.
const SHIPS: usize = 40;

fn name(ship: usize) -> String {
    format!("ship-{ship:02}")
}

async fn fleet(on: &TestStore) {
    for number in 0..SHIPS {
        on.store.ships().create(&ship(&name(number))).await.unwrap();
        on.store
            .versions()
            .create(&version(&name(number)), &[champion(ExpectedRevision::Any)])
            .await
            .unwrap();
    }
}

async fn number(store: &Store, ship: &str, alias: &str) -> Option<i64> {
    let current = store.versions().current_version(ship, alias).await.unwrap()?;
    assert_eq!(current.model, ship);
    Some(current.number)
}

async fn each_who_asks_gets_an_answer_of_their_own(on: &TestStore) {
    fleet(on).await;
    let candidate = sistership_store::AliasMove {
        alias: "candidate".into(),
        ..champion(ExpectedRevision::Any)
    };
    let second = on.store.versions().create(&version("ship-07"), &[candidate]).await.unwrap();
    let new = NewReport { version_id: Some(second.id.clone()), ..report("ship-07") };
    on.store.reports().insert(&new).await.unwrap();
    let newest = on.store.reports().insert(&new).await.unwrap().id;
    on.store.ships().delete("ship-09", None).await.unwrap();
    let asked = (0..SHIPS + 10).map(|ship| async move {
        let name = name(ship);
        let both = futures::join!(
            number(&on.store, &name, "champion"),
            number(&on.store, &name, "candidate")
        );
        (ship, both)
    });
    for (ship, (champion, candidate)) in join_all(asked).await {
        assert_eq!(champion, (ship < SHIPS && ship != 9).then_some(1), "{ship}");
        assert_eq!(candidate, (ship == 7).then_some(2), "{ship}");
    }
    let current =
        on.store.versions().current_version("ship-07", "candidate").await.unwrap().unwrap();
    assert_eq!((current.id, current.report), (second.id, Some(newest)));
    assert_invalid(on.store.versions().current_version("a\0b", "champion").await, "ship");
}

/// A move that was acknowledged before somebody asks is in the answer.
async fn nobody_reads_an_alias_as_it_was_before_the_question(on: &TestStore) {
    fleet(on).await;
    let kept: Arc<Vec<AtomicI64>> = Arc::new((0..SHIPS).map(|_| AtomicI64::new(1)).collect());
    let writer = async |first: usize| {
        for turn in 0..60 {
            let ship = (first + 7 * turn) % SHIPS;
            let made = on
                .store
                .versions()
                .create(&version(&name(ship)), &[champion(ExpectedRevision::Any)])
                .await
                .unwrap();
            kept[ship].fetch_max(made.number, Ordering::SeqCst);
        }
    };
    let readers: Vec<_> = (0..32)
        .map(|reader| tokio::spawn(read(on.store.clone(), Arc::clone(&kept), reader)))
        .collect();
    futures::join!(writer(0), writer(3));
    for reader in readers {
        reader.await.unwrap();
    }
}

async fn read(store: Store, kept: Arc<Vec<AtomicI64>>, reader: usize) {
    for turn in 0..200 {
        let ship = (reader + 11 * turn) % SHIPS;
        let least = kept[ship].load(Ordering::SeqCst);
        let found = number(&store, &name(ship), "champion").await.unwrap();
        assert!(found >= least, "{found} where {least} was kept");
    }
}

/// Those who go away do not keep others waiting.
async fn whoever_goes_away_holds_up_nobody(on: &TestStore) {
    fleet(on).await;
    for _ in 0..20 {
        let asked = (0..SHIPS).map(|ship| {
            let store = on.store.clone();
            tokio::spawn(async move { number(&store, &name(ship), "champion").await })
        });
        let asked: Vec<_> = asked.collect();
        asked.iter().step_by(2).for_each(tokio::task::JoinHandle::abort);
        for one in asked.into_iter().skip(1).step_by(2) {
            assert_eq!(one.await.unwrap(), Some(1));
        }
    }
}

on_both_databases!(
    each_who_asks_gets_an_answer_of_their_own,
    nobody_reads_an_alias_as_it_was_before_the_question,
    whoever_goes_away_holds_up_nobody
);
