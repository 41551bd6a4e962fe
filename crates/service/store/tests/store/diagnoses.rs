use sistership_store::{
    CommittedDiagnosis, ExpectedRevision, JobState, NewDiagnosis, NewDiagnosisRow, NewReport,
    PageRequest, PartDiagnosis, Result,
};

use crate::jobs::{claim, let_the_lease_run_out};
use crate::support::*;

fn diagnosis(version_id: &str, with_version: bool) -> NewDiagnosis {
    let verdict = if with_version { "effects" } else { "complete" };
    let found = NewDiagnosisRow {
        version_id: version_id.into(),
        verdict: verdict.into(),
        effects: r#"["current"]"#.into(),
        trials: r#"["a"]"#.into(),
        unexplained: "[]".into(),
        drift: Some(r#"{"ratio":3.0}"#.into()),
    };
    let report = NewReport { kind: "diagnosis".into(), ..report("kcs") };
    NewDiagnosis {
        version: with_version.then(|| (version("kcs"), vec![champion(ExpectedRevision::Any)])),
        report,
        found,
        of_new: None,
        drift: Some(3.0),
    }
}

async fn commit(
    on: &TestStore,
    job: &str,
    fence: i64,
    diagnosis: &NewDiagnosis,
) -> Result<CommittedDiagnosis> {
    let result = |version: Option<&sistership_store::VersionHead>, _: &_| {
        format!(r#"{{"version":{}}}"#, version.is_some())
    };
    on.store.commit_diagnosis(job, fence, diagnosis, result).await
}

/// A version, diagnosed.
pub async fn one(on: &TestStore) {
    let diagnosed = versions(on, "kcs", 1).await.remove(0).id;
    on.store.jobs().enqueue(&job("kcs")).await.unwrap();
    let running = claim(on, "a").await.unwrap();
    commit(on, &running.id, running.fence, &diagnosis(&diagnosed, false)).await.unwrap();
}

async fn diagnoses_are_found_by_version(on: &TestStore) {
    let diagnosed = versions(on, "kcs", 1).await.remove(0).id;
    for with_version in [false, true] {
        on.store.jobs().enqueue(&job("kcs")).await.unwrap();
        let running = claim(on, "a").await.unwrap();
        let kept = commit(on, &running.id, running.fence, &diagnosis(&diagnosed, with_version))
            .await
            .unwrap();
        assert_eq!((kept.job.state, kept.version.is_some()), (JobState::Succeeded, with_version));
        assert_eq!(kept.report.version_id, kept.version.as_ref().map(|version| version.id.clone()));
        assert_eq!(
            (&kept.found.report_id, kept.found.made_id.is_some()),
            (&kept.report.id, with_version)
        );
        let newest = on
            .store
            .diagnoses()
            .by_version(&diagnosed, &PageRequest::first_page(1))
            .await
            .unwrap()
            .items;
        assert_eq!(newest, std::slice::from_ref(&kept.found));
        if let Some(made) = kept.version {
            let of_made = on
                .store
                .diagnoses()
                .by_version(&made.id, &PageRequest::first_page(9))
                .await
                .unwrap()
                .items;
            assert_eq!(
                of_made,
                [kept.found],
                "a version is found with the diagnosis that it came of"
            );
        }
    }
    assert_eq!(
        on.store
            .diagnoses()
            .by_version(&diagnosed, &PageRequest::first_page(9))
            .await
            .unwrap()
            .items
            .len(),
        2
    );
}

/// A diagnosis of the whole is kept with that of what is new, older first.
async fn what_is_new_is_kept_with_the_whole(on: &TestStore) {
    let diagnosed = versions(on, "kcs", 1).await.remove(0).id;
    on.store.jobs().enqueue(&job("kcs")).await.unwrap();
    let running = claim(on, "a").await.unwrap();
    let whole = diagnosis(&diagnosed, false);
    let part = PartDiagnosis {
        report: NewReport { kind: "diagnosis".into(), ..report("kcs") },
        found: NewDiagnosisRow {
            verdict: "unexplained".into(),
            unexplained: r#"["b"]"#.into(),
            trials: r#"["b"]"#.into(),
            ..whole.found.clone()
        },
    };
    let both = NewDiagnosis { of_new: Some(part), ..whole };
    commit(on, &running.id, running.fence, &both).await.unwrap();
    let kept = on
        .store
        .diagnoses()
        .by_version(&diagnosed, &PageRequest::first_page(9))
        .await
        .unwrap()
        .items;
    let said = |at: usize| (kept[at].verdict.as_str(), kept[at].unexplained.as_str());
    assert_eq!(
        (kept.len(), said(0), said(1)),
        (2, ("complete", "[]"), ("unexplained", r#"["b"]"#))
    );
    assert_eq!(kept[0].drift.as_deref(), Some(r#"{"ratio":3.0}"#));
    assert_ne!(kept[0].report_id, kept[1].report_id);
}

async fn a_fenced_worker_leaves_no_diagnosis_behind(on: &TestStore) {
    let diagnosed = versions(on, "kcs", 1).await.remove(0).id;
    on.store.jobs().enqueue(&job("kcs")).await.unwrap();
    let old = claim(on, "old").await.unwrap();
    let_the_lease_run_out(on).await;
    claim(on, "new").await.unwrap();
    assert_conflict(
        commit(on, &old.id, old.fence, &diagnosis(&diagnosed, true)).await,
        "no longer valid",
    );
    assert!(
        on.store
            .diagnoses()
            .by_version(&diagnosed, &PageRequest::first_page(9))
            .await
            .unwrap()
            .items
            .is_empty()
    );
    assert_eq!(on.store.versions().latest("kcs").await.unwrap().head.number, 1);
}

async fn a_diagnosis_is_of_a_version_that_is_there(on: &TestStore) {
    on.store.jobs().enqueue(&job("kcs")).await.unwrap();
    let running = claim(on, "a").await.unwrap();
    assert_invalid(
        commit(on, &running.id, running.fence, &diagnosis("none", false)).await,
        "version_id",
    );
}

on_both_databases!(
    diagnoses_are_found_by_version,
    what_is_new_is_kept_with_the_whole,
    a_fenced_worker_leaves_no_diagnosis_behind,
    a_diagnosis_is_of_a_version_that_is_there
);
