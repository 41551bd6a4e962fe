use sistership_store::MAX_TEMPLATES;

use crate::support::*;

const DOCUMENT: &str = r#"{"columns":[]}"#;

async fn names(on: &TestStore, ship: &str) -> Vec<(String, String)> {
    let all = on.store.templates().list_for_ship(ship).await.unwrap();
    all.into_iter().map(|row| (row.ship, row.name)).collect()
}

async fn templates_of_a_ship_come_before_those_of_the_server(on: &TestStore) {
    on.store.ships().create(&ship("kcs")).await.unwrap();
    let templates = on.store.templates();
    for (of, name) in [("", "any"), ("kcs", "yard-x"), ("kcs", "a")] {
        templates.save(of, name, DOCUMENT).await.unwrap();
    }
    let own = |name: &str| ("kcs".to_owned(), name.to_owned());
    let all = [own("a"), own("yard-x"), (String::new(), "any".to_owned())];
    assert_eq!(names(on, "kcs").await, all);
    assert_eq!(names(on, "pcc").await, all[2..]);
    templates.save("kcs", "a", "{}").await.unwrap();
    let changed = &templates.list_for_ship("kcs").await.unwrap()[0];
    assert_eq!((changed.name.as_str(), changed.document.as_str()), ("a", "{}"));
    templates.remove("kcs", "a").await.unwrap();
    assert_eq!(names(on, "kcs").await, all[1..]);
    assert_eq!(audited_actions(on).await[..2], ["template.remove", "template.save"]);
}

async fn a_template_that_cannot_be_kept_is_refused(on: &TestStore) {
    let templates = on.store.templates();
    assert_not_found(templates.save("nobody", "a", DOCUMENT).await, "ship");
    assert_not_found(templates.remove("", "a").await, "template");
    assert!(templates.save("", "a b", DOCUMENT).await.is_err());
    assert!(templates.save("", "a", "no JSON").await.is_err());
    for k in 0..MAX_TEMPLATES {
        templates.save("", &format!("t{k}"), DOCUMENT).await.unwrap();
    }
    assert_conflict(templates.save("", "more", DOCUMENT).await, "is the limit");
    templates.save("", "t0", "{}").await.unwrap();
}

on_both_databases!(
    templates_of_a_ship_come_before_those_of_the_server,
    a_template_that_cannot_be_kept_is_refused
);
