//! Champions as they were answered before: a version never changes, so that its answer does not
//! either.

use axum::http::HeaderValue;
use bytes::Bytes;
use quick_cache::Weighter;
use quick_cache::sync::Cache;

/// What the answers may take, bytes.
const MOST: u64 = 16 << 20;
/// About as many answers as that is.
const COUNT: usize = 4096;

/// What makes an answer: the version, the report on it, and the form.
pub type AnswerKey = (String, Option<String>, &'static str);

/// An answer.
#[derive(Debug, Clone)]
pub struct Answer {
    /// Its tag.
    pub etag: HeaderValue,
    /// Its bytes.
    pub body: Bytes,
}

/// Answers by what makes them, the least used of which go first.
#[derive(Debug)]
pub struct Answers(Cache<AnswerKey, Answer, Size>);

#[derive(Debug, Clone)]
struct Size;

impl Weighter<AnswerKey, Answer> for Size {
    fn weight(&self, _: &AnswerKey, answer: &Answer) -> u64 {
        answer.body.len() as u64 + 300
    }
}

impl Default for Answers {
    fn default() -> Self {
        Self(Cache::with_weighter(COUNT, MOST, Size))
    }
}

impl Answers {
    /// An answer that was given before.
    pub fn get(&self, key: &AnswerKey) -> Option<Answer> {
        self.0.get(key)
    }

    /// Keeps an answer for the next time.
    pub fn keep(&self, key: AnswerKey, answer: Answer) {
        self.0.insert(key, answer);
    }
}
