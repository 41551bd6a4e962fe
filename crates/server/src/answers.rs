//! Champions as they were answered before: a version never changes, so that its answer does not either.

use bytes::Bytes;
use quick_cache::Weighter;
use quick_cache::sync::Cache;

/// What the answers may take, bytes.
const MOST: u64 = 64 << 20;
/// About as many answers as that is.
const COUNT: usize = 4096;

/// What makes an answer: the version, the report on it, and the form.
pub(crate) type AnswerKey = (String, Option<String>, &'static str);

/// Answers by what makes them, the least used of which go first.
#[derive(Debug)]
pub(crate) struct Answers(Cache<AnswerKey, Bytes, Size>);

#[derive(Debug, Clone)]
struct Size;

impl Weighter<AnswerKey, Bytes> for Size {
    fn weight(&self, _: &AnswerKey, answer: &Bytes) -> u64 {
        answer.len() as u64 + 200
    }
}

impl Default for Answers {
    fn default() -> Self {
        Self(Cache::with_weighter(COUNT, MOST, Size))
    }
}

impl Answers {
    /// An answer that was given before.
    pub(crate) fn get(&self, key: &AnswerKey) -> Option<Bytes> {
        self.0.get(key)
    }

    /// Keeps an answer for the next time.
    pub(crate) fn keep(&self, key: AnswerKey, answer: Bytes) {
        self.0.insert(key, answer);
    }
}
