//! Cache of answers with champions: a version never changes, and neither does its answer.

use axum::http::HeaderValue;
use bytes::Bytes;
use quick_cache::Weighter;
use quick_cache::sync::Cache;

/// Maximum size of the cache, bytes.
const MOST: u64 = 16 << 20;
/// Estimated number of answers of that size.
const COUNT: usize = 4096;

/// Key of an answer: the id of the version, that of the report on it, and the media type.
pub type AnswerKey = (String, Option<String>, &'static str);

/// A cached answer.
#[derive(Debug, Clone)]
pub struct CachedAnswer {
    /// Entity tag.
    pub etag: HeaderValue,
    /// Body.
    pub body: Bytes,
}

/// Cache of answers; the least used are removed first.
#[derive(Debug)]
pub struct AnswerCache(Cache<AnswerKey, CachedAnswer, AnswerWeight>);

#[derive(Debug, Clone)]
struct AnswerWeight;

impl Weighter<AnswerKey, CachedAnswer> for AnswerWeight {
    fn weight(&self, _: &AnswerKey, answer: &CachedAnswer) -> u64 {
        // The body, and about 300 bytes for key, tag and the entry itself.
        answer.body.len() as u64 + 300
    }
}

impl Default for AnswerCache {
    fn default() -> Self {
        Self(Cache::with_weighter(COUNT, MOST, AnswerWeight))
    }
}

impl AnswerCache {
    /// Returns a cached answer.
    pub fn get(&self, key: &AnswerKey) -> Option<CachedAnswer> {
        self.0.get(key)
    }

    /// Adds an answer to the cache.
    pub fn insert_answer(&self, key: AnswerKey, answer: CachedAnswer) {
        self.0.insert(key, answer);
    }
}
