use sistership_store::{
    CommittedRefinement, ExpectedRevision, JobFilter, JobState, NewRefinement, PageRequest,
    RefinementRows, Result,
};

use crate::jobs::{claim, let_the_lease_run_out};
use crate::support::*;

fn refinement() -> NewRefinement {
    NewRefinement {
        version: version("kcs"),
        moves: vec![champion(ExpectedRevision::Any)],
        report: Some(report("kcs")),
        next: None,
    }
}

async fn commit(on: &TestStore, job: &str, fence: i64) -> Result<CommittedRefinement> {
    let result = |kept: &RefinementRows<'_>| format!(r#"{{"version":{}}}"#, kept.version.number);
    on.store.commit_refinement(None, (job, fence), &refinement(), result).await
}

async fn all_of_it_is_kept(on: &TestStore) {
    on.store.jobs().enqueue(&job("kcs")).await.unwrap();
    let running = claim(on, "a").await.unwrap();
    let kept = commit(on, &running.id, running.fence).await.unwrap();
    assert_eq!(
        (kept.job.state, kept.job.result.as_deref()),
        (JobState::Succeeded, Some(r#"{"version":1}"#))
    );
    assert_eq!(on.store.aliases().get("kcs", "champion").await.unwrap().version_number, 1);
    let reports = on
        .store
        .reports()
        .by_version(&kept.version.id, &PageRequest::first_page(9))
        .await
        .unwrap()
        .items;
    assert_eq!(reports, [kept.report.unwrap()]);
    assert_conflict(commit(on, &running.id, running.fence).await, "succeeded");
    assert_eq!(on.store.versions().latest("kcs").await.unwrap().head.number, 1);
}

async fn a_fenced_worker_leaves_nothing_behind(on: &TestStore) {
    on.store.jobs().enqueue(&job("kcs")).await.unwrap();
    let old = claim(on, "old").await.unwrap();
    let_the_lease_run_out(on).await;
    let new = claim(on, "new").await.unwrap();
    assert_conflict(commit(on, &old.id, old.fence).await, "no longer valid");
    assert_not_found(on.store.versions().latest("kcs").await, "model");
    assert_not_found(on.store.aliases().get("kcs", "champion").await, "alias");
    assert_eq!(on.store.jobs().get(&old.id).await.unwrap(), new);
    let kept = commit(on, &new.id, new.fence).await.unwrap();
    assert_eq!(kept.version.number, 1);
    let history = on
        .store
        .aliases()
        .list_history("kcs", "champion", &PageRequest::first_page(9))
        .await
        .unwrap()
        .items;
    assert_eq!((history.len(), history[0].from_number), (1, None));
}

async fn a_refused_part_leaves_the_job_running(on: &TestStore) {
    on.store.jobs().enqueue(&job("kcs")).await.unwrap();
    let running = claim(on, "a").await.unwrap();
    let refused =
        NewRefinement { moves: vec![champion(ExpectedRevision::Revision(4))], ..refinement() };
    let result = |_: &RefinementRows<'_>| "{}".to_owned();
    assert_stale(
        on.store.commit_refinement(None, (&running.id, running.fence), &refused, result).await,
        None,
    );
    let result = |_: &RefinementRows<'_>| "{".to_owned();
    assert_invalid(
        on.store.commit_refinement(None, (&running.id, running.fence), &refinement(), result).await,
        "result",
    );
    assert_eq!(on.store.jobs().get(&running.id).await.unwrap(), running);
    assert_not_found(on.store.versions().latest("kcs").await, "model");
}

async fn the_job_that_goes_on_comes_with_the_version_or_not_at_all(on: &TestStore) {
    on.store.jobs().enqueue(&job("kcs")).await.unwrap();
    let running = claim(on, "a").await.unwrap();
    let next = NewRefinement { next: Some(job("kcs")), ..refinement() };
    let all = |on: &TestStore| {
        let store = on.store.clone();
        async move {
            store
                .jobs()
                .list(&JobFilter::default(), &PageRequest::first_page(9))
                .await
                .unwrap()
                .items
        }
    };
    let named = |kept: &RefinementRows<'_>| format!(r#"{{"next":"{}"}}"#, kept.next.unwrap().id);
    let place = (running.id.as_str(), running.fence);
    let lost = on.store.commit_refinement(None, (place.0, place.1 - 1), &next, named).await;
    assert_conflict(lost, "no longer valid");
    assert_eq!(all(on).await.len(), 1);
    let kept = on.store.commit_refinement(None, place, &next, named).await.unwrap();
    let jobs = all(on).await;
    let queued = jobs.iter().find(|job| job.state == JobState::Queued).unwrap();
    assert_eq!(kept.job.result, Some(format!(r#"{{"next":"{}"}}"#, queued.id)));
}

on_both_databases!(
    all_of_it_is_kept,
    the_job_that_goes_on_comes_with_the_version_or_not_at_all,
    a_fenced_worker_leaves_nothing_behind,
    a_refused_part_leaves_the_job_running
);
