//! Verification that a version is what its recipe gives, byte for byte.

use std::sync::Arc;

use serde::Serialize;
use serde_json::Value;
use sistership_model::version::{code_revision, sha256_hex};
use utoipa::ToSchema;

use crate::archive::{Archive, version_document};
use crate::derive::{DeriveError, ProgressCallback, derive};
use crate::memory::{BYTES_PER_SAMPLE, trial_bytes};
use crate::recipe::DerivationRecipe;
use crate::version::VersionDocument;

/// Relative difference below which numbers count as rounded differently.
const ROUNDING: f64 = 1e-6;

/// Result of deriving a version again.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, ToSchema)]
pub struct Verification {
    /// The name of the ship.
    pub model: String,
    /// The version's number.
    pub number: i64,
    /// The hash that the store has.
    pub sha256: String,
    /// The hash of the stored bytes.
    pub stored_sha256: String,
    /// The hash of the bytes derived now.
    pub derived_sha256: String,
    /// True if all three are the same.
    pub identical: bool,
    /// Revision of the program that made the version, from its recipe; null for a published model.
    pub made_by: Option<String>,
    /// Revision of this program.
    pub checked_by: String,
    /// First difference of the two (a JSON pointer), and other remarks.
    pub remarks: Vec<String>,
}

/// Derives a version again from its recipe and compares the bytes.
///
/// # Errors
/// Returns an error if an input of the recipe is missing, or if the derivation is refused.
pub async fn verify_version(
    archive: &Archive,
    ship: &str,
    number: i64,
) -> Result<Verification, DeriveError> {
    verify_with_progress(archive, ship, number, Arc::new(|_, _| true)).await
}

/// Estimates the memory that a verification needs, bytes.
///
/// # Errors
/// Returns an error if the version or an object of its samples is missing.
pub async fn memory_demand(archive: &Archive, ship: &str, number: i64) -> Result<u64, DeriveError> {
    let version = archive.store.versions().get(ship, number).await?;
    let recipe = version_document(&version)?.recipe;
    let mut each = Vec::with_capacity(recipe.trials().len());
    for trial in recipe.trials() {
        // Samples are compressed to about a third of their size in memory.
        let samples = 3 * archive.objects.object_size(&trial.sha256).await? / trial_bytes(1);
        each.push(samples * BYTES_PER_SAMPLE);
    }
    Ok(match recipe {
        // One trial after the other is reduced to its statistics.
        DerivationRecipe::Family(_) => each.into_iter().max().unwrap_or(0),
        _ => each.into_iter().sum(),
    })
}

/// Derives a version again and compares the bytes, with a progress callback that can stop it.
///
/// # Errors
/// Returns an error if an input of the recipe is missing, or if the derivation is refused or
/// stopped.
pub async fn verify_with_progress(
    archive: &Archive,
    ship: &str,
    number: i64,
    progress: ProgressCallback,
) -> Result<Verification, DeriveError> {
    let version = archive.store.versions().get(ship, number).await?;
    let stored = version_document(&version)?;
    let derived = match &stored.recipe {
        // Nothing to derive: the document is checked and serialised again.
        DerivationRecipe::Registered(recipe) => {
            check_registered(archive, &stored, &recipe.law_sha256).await?
        }
        recipe => {
            let derived = derive(archive, ship, recipe, progress).await?;
            // The document names weights by hash only; the stored ones must be intact, too.
            archive.attach_weights(&mut stored.model.clone()).await?;
            derived.document.to_canonical_json()?
        }
    };
    let (stored_sha256, derived_sha256) =
        (sha256_hex(version.document.as_bytes()), sha256_hex(derived.as_bytes()));
    let made_by = stored.recipe.code_revision().map(str::to_owned);
    let identical = version.head.sha256 == stored_sha256 && version.document == derived;
    let remarks = list_remarks(
        made_by.as_deref(),
        (&version.document, &derived),
        version.head.sha256 == stored_sha256,
    );
    Ok(Verification {
        model: ship.to_owned(),
        number,
        sha256: version.head.sha256,
        stored_sha256,
        derived_sha256,
        identical,
        made_by,
        checked_by: code_revision().to_owned(),
        remarks,
    })
}

/// Checks a model that was made elsewhere against its law, and serialises it again: it has no
/// derivation.
async fn check_registered(
    archive: &Archive,
    stored: &VersionDocument,
    law_sha256: &str,
) -> Result<String, DeriveError> {
    let law = archive.law_by_hash(&stored.model.law, law_sha256).await?;
    let wrong =
        |(field, message): (String, String)| DeriveError::Lost(format!("{field}: {message}"));
    stored.model.check_against(&law).map_err(wrong)?;
    archive.attach_weights(&mut stored.model.clone()).await?;
    Ok(stored.to_canonical_json()?)
}

fn list_remarks(
    made_by: Option<&str>,
    (stored, derived): (&str, &str),
    undamaged: bool,
) -> Vec<String> {
    let mut remarks = Vec::new();
    if !undamaged {
        remarks.push(
            "the stored bytes do not have the recorded hash: the database is damaged or \
            was changed"
                .to_owned(),
        );
    }
    // A derivation copies the recorded recipe, so the revision itself is no difference.
    if let Some(other) = made_by.filter(|revision| *revision != code_revision()) {
        remarks.push(format!(
            "made by revision {other}, checked by {}: the comparison ignores the revision",
            code_revision()
        ));
    }
    let read = |text| serde_json::from_str::<Value>(text).unwrap_or_default();
    if stored != derived {
        let (stored, derived) = (read(stored), read(derived));
        let place = first_difference(&stored, &derived, String::new());
        remarks.push(
            place.unwrap_or_else(|| "the values are equal, but written differently".to_owned()),
        );
        remarks.extend(rounding_difference(&stored, &derived).map(|largest| {
            format!(
                "only numbers differ, relatively by at most {largest:.0e}: this is rounding by \
                 another processor (without fused multiplication) or C library; no input differs"
            )
        }));
    }
    remarks
}

/// Returns the largest relative difference of two documents that differ only in the last digits of
/// numbers; `None` for any other difference.
fn rounding_difference(stored: &Value, derived: &Value) -> Option<f64> {
    let largest = |mut all: &mut dyn Iterator<Item = Option<f64>>| {
        (&mut all).try_fold(0.0, |most: f64, one| Some(most.max(one?)))
    };
    match (stored, derived) {
        (Value::Object(a), Value::Object(b)) if a.keys().eq(b.keys()) => {
            largest(&mut a.values().zip(b.values()).map(|(a, b)| rounding_difference(a, b)))
        }
        (Value::Array(a), Value::Array(b)) if a.len() == b.len() => {
            largest(&mut a.iter().zip(b).map(|(a, b)| rounding_difference(a, b)))
        }
        (Value::Number(a), Value::Number(b)) => {
            let (a, b) = (a.as_f64()?, b.as_f64()?);
            let share = if a == b { 0.0 } else { (a - b).abs() / a.abs().max(b.abs()) };
            // Both zero is handled by equality, so the denominator is positive.
            (share < ROUNDING).then_some(share)
        }
        _ => (stored == derived).then_some(0.0),
    }
}

/// Describes the first place at which two documents differ.
fn first_difference(stored: &Value, derived: &Value, path: String) -> Option<String> {
    match (stored, derived) {
        (Value::Object(a), Value::Object(b)) if a.keys().eq(b.keys()) => a
            .iter()
            .zip(b.values())
            .find_map(|((key, a), b)| first_difference(a, b, format!("{path}/{key}"))),
        (Value::Array(a), Value::Array(b)) if a.len() == b.len() => a
            .iter()
            .zip(b)
            .enumerate()
            .find_map(|(index, (a, b))| first_difference(a, b, format!("{path}/{index}"))),
        _ if stored == derived => None,
        _ => Some(format!(
            "first difference at {path}: stored {}, derived {}",
            abbreviate(stored),
            abbreviate(derived)
        )),
    }
}

fn abbreviate(value: &Value) -> String {
    value.to_string().chars().take(80).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn the_first_difference_is_placed() {
        let (a, b) = (json!({"model": {"X_uu": [1, 2.5]}}), json!({"model": {"X_uu": [1, 2.25]}}));
        let place = first_difference(&a, &b, String::new()).unwrap_or_default();
        assert_eq!(place, "first difference at /model/X_uu/1: stored 2.5, derived 2.25");
        assert_eq!(first_difference(&a, &a, String::new()), None);
    }

    #[test]
    fn rounding_is_told_from_another_input() {
        let said = |derived: &str| list_remarks(None, (r#"{"a":[1.0,2],"b":"x"}"#, derived), true);
        assert!(said(r#"{"a":[1.0000000001,2],"b":"x"}"#)[1].contains("by at most 1e-10"));
        for other in
            [r#"{"a":[1.1,2],"b":"x"}"#, r#"{"a":[1.0,2],"b":"y"}"#, r#"{"a":[1.0],"b":"x"}"#]
        {
            assert_eq!(said(other).len(), 1, "{other}");
        }
    }

    #[test]
    fn another_revision_is_said() {
        assert!(
            list_remarks(Some("0.0.0-other"), ("{}", "{}"), true)[0]
                .contains("made by revision 0.0.0-other")
        );
        assert!(list_remarks(Some(code_revision()), ("{}", "{}"), true).is_empty());
        assert!(list_remarks(None, ("{}", "{}"), false)[0].contains("damaged"));
    }
}
