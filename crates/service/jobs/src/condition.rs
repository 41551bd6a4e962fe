//! Whether the model of a ship still holds: what the newest diagnosis that concerns its present
//! champion found.

use serde::Serialize;
use sistership_store::{Diagnosed, MAX_LIMIT, Page, Store, StoreError, VersionHead};
use utoipa::ToSchema;

use crate::line::{CHAMPION, alias};

/// Whether the champion of a ship still holds, by the newest diagnosis of it, or by the one that it
/// came of.
#[derive(Debug, Clone, Default, Serialize, ToSchema)]
pub struct Condition {
    /// `holds`, `does_not_hold`, or `unknown` where its champion was never diagnosed.
    pub model: Standing,
    /// The same in one sentence.
    pub sentence: String,
    /// The number of its champion.
    pub version: Option<i64>,
    /// What was found of the champion: `complete`, `effects` or `unexplained`.
    pub verdict: Option<String>,
    /// Names of the effects that the champion lacks.
    pub effects: Vec<String>,
    /// Ids of the trials that this was found on.
    pub trials: Vec<String>,
    /// The diagnosis that found it.
    pub found_by: Option<FoundBy>,
    /// The first diagnosis since which each has given the same answer.
    pub since: Option<FoundBy>,
    /// The version with the effects that the champion lacks.
    pub with_effects: Option<MadeVersion>,
}

/// Whether a model holds.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum Standing {
    /// Its residual is what the noise predicts.
    Holds,
    /// Something is missing.
    DoesNotHold,
    /// Nobody has looked.
    #[default]
    Unknown,
}

/// A diagnosis.
#[derive(Debug, Clone, Serialize, ToSchema)]
pub struct FoundBy {
    /// Its id.
    pub diagnosis: String,
    /// When it was made, microseconds since 1970.
    pub at_us: i64,
    /// Where its report is, as data and as a page (`?format=html`).
    pub report: String,
}

/// A version that came of a diagnosis.
#[derive(Debug, Clone, Serialize, ToSchema)]
pub struct MadeVersion {
    /// Its number.
    pub number: i64,
    /// Where it is.
    pub at: String,
}

impl Condition {
    /// The condition of a ship now.
    ///
    /// # Errors
    /// The store does not answer.
    pub async fn of(store: &Store, ship: &str) -> Result<Self, StoreError> {
        let Some(champion) = alias(store, ship, CHAMPION).await? else {
            return Ok(Self {
                sentence: "Unknown: it has no champion yet.".into(),
                ..Self::default()
            });
        };
        let version = store.versions().head(ship, champion.version_number).await?;
        let newest =
            store.diagnoses().by_version(&version.id, &Page::first(MAX_LIMIT)).await?.items;
        let mut condition = Self::found(&version, &newest);
        condition.sentence = condition.in_words();
        if let Some(made) = newest
            .first()
            .filter(|newest| newest.version_id == version.id)
            .and_then(|newest| newest.made_id.as_ref())
        {
            condition.with_effects =
                Some(MadeVersion::of(store.versions().by_id(made).await?.head));
        }
        Ok(condition)
    }

    /// The condition of a ship by its champion and the newest diagnosis that concerns that: without
    /// since when it is so, and without what was made.
    pub fn by_newest(champion: Option<&VersionHead>, newest: Option<&Diagnosed>) -> Self {
        let newest = newest.map_or(&[][..], std::slice::from_ref);
        let found = champion.map(|champion| Self::found(champion, newest));
        Self { since: None, ..found.unwrap_or_default() }
    }

    fn found(version: &VersionHead, newest: &[Diagnosed]) -> Self {
        let number = Some(version.number);
        let Some(last) = newest.first() else { return Self { version: number, ..Self::default() } };
        let list = |text: &str| serde_json::from_str(text).unwrap_or_default();
        let (verdict, effects) = of_version(version, last);
        let same =
            newest.iter().take_while(|earlier| of_version(version, earlier) == (verdict, effects));
        Self {
            model: if verdict == "complete" { Standing::Holds } else { Standing::DoesNotHold },
            sentence: String::new(),
            version: number,
            verdict: Some(verdict.to_owned()),
            effects: list(effects),
            trials: list(&last.trials),
            found_by: Some(FoundBy::of(last)),
            since: same.last().map(FoundBy::of),
            with_effects: None,
        }
    }

    /// Tells one state of the condition from another.
    pub fn tag(&self) -> String {
        let version = self.version.map(|number| format!(".{number}")).unwrap_or_default();
        let found =
            self.found_by.as_ref().map(|found| format!(".{}", found.diagnosis)).unwrap_or_default();
        version + &found
    }

    fn in_words(&self) -> String {
        let trials = match self.trials.len() {
            1 => "1 trial".to_owned(),
            count => format!("{count} trials"),
        };
        let effects = self.effects.join(" and ");
        match (self.model, effects.is_empty(), self.verdict.as_deref()) {
            (Standing::Unknown, ..) => {
                "Unknown: its champion has not been diagnosed on a trial yet.".into()
            }
            (Standing::Holds, ..) => {
                format!("Its model holds: on {trials} its residual is what the noise predicts.")
            }
            (_, false, Some("effects")) => {
                format!("Its model does not hold: on {trials} it lacks {effects}.")
            }
            (_, true, _) => format!(
                "Its model does not hold: on {trials} something is missing that no known effect \
                 explains."
            ),
            (_, false, _) => {
                format!(
                    "Its model does not hold: on {trials} it lacks {effects}, and something that \
                     no known effect explains."
                )
            }
        }
    }
}

/// What a diagnosis says of a version: of the one that came of it, what remained with the effects
/// in place.
fn of_version<'a>(version: &VersionHead, diagnosed: &'a Diagnosed) -> (&'a str, &'a str) {
    match (diagnosed.version_id == version.id, diagnosed.verdict.as_str()) {
        (true, verdict) => (verdict, &diagnosed.effects),
        (false, "effects") => ("complete", "[]"),
        (false, verdict) => (verdict, "[]"),
    }
}

impl FoundBy {
    fn of(diagnosed: &Diagnosed) -> Self {
        let report = format!("/v1/reports/{}", diagnosed.report_id);
        Self { diagnosis: diagnosed.id.clone(), at_us: diagnosed.created_us, report }
    }
}

impl MadeVersion {
    fn of(head: VersionHead) -> Self {
        Self {
            number: head.number,
            at: format!("/v1/models/{}/versions/{}", head.model, head.number),
        }
    }
}
