//! Documents of one kind by name, each read when it is first requested.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::sync::{Arc, OnceLock};

use include_dir::{Dir, File};
use rayon::prelude::*;

use crate::error::FileError;

/// Function that reads a document from the name of its file and its text.
type ParseFunction<T> = fn(&str, &str) -> Result<T, FileError>;

/// Documents by name.
#[derive(Debug, Clone)]
pub(super) struct ZooEntries<T> {
    parse: ParseFunction<T>,
    by_name: BTreeMap<String, ZooEntry<T>>,
}

#[derive(Debug, Clone)]
struct ZooEntry<T> {
    file: &'static str,
    text: Cow<'static, str>,
    read: OnceLock<Result<Arc<T>, FileError>>,
}

impl<T: Send + Sync> ZooEntries<T> {
    /// Creates an empty collection.
    pub fn new(parse: ParseFunction<T>) -> Self {
        Self { parse, by_name: BTreeMap::new() }
    }

    /// Returns the YAML files of an embedded folder; the name of each file is that of its document.
    ///
    /// # Errors
    /// Returns an error for a file that is not text.
    pub fn from_folder(
        folder: Option<&'static Dir<'static>>,
        parse: ParseFunction<T>,
    ) -> Result<Self, FileError> {
        let files = folder.map(Dir::files).into_iter().flatten();
        let yaml = |file: &&'static File<'static>| {
            file.path().extension().is_some_and(|extension| extension == "yaml")
        };
        Ok(Self { parse, by_name: files.filter(yaml).map(file_entry).collect::<Result<_, _>>()? })
    }

    /// Adds a document that has been read, or replaces the one of the same name.
    pub fn insert(&mut self, name: &str, text: &str, document: Arc<T>) {
        let read = OnceLock::from(Ok(document));
        let entry = ZooEntry { file: "", text: Cow::Owned(text.to_owned()), read };
        self.by_name.insert(name.to_owned(), entry);
    }

    /// Document by name; `None` if it cannot be read.
    pub fn get(&self, name: &str) -> Option<&Arc<T>> {
        self.read_entry(self.by_name.get(name)?).as_ref().ok()
    }

    /// Text of a document.
    pub fn document_text(&self, name: &str) -> Option<&str> {
        self.by_name.get(name).map(|entry| &*entry.text)
    }

    /// Names, in order.
    pub fn names(&self) -> Vec<&str> {
        self.by_name.keys().map(String::as_str).collect()
    }

    /// Every document that can be read, in the order of names; those not yet read are read on all
    /// cores.
    pub fn read_all(&self) -> impl Iterator<Item = &Arc<T>> {
        let unread: Vec<&ZooEntry<T>> =
            self.by_name.values().filter(|entry| entry.read.get().is_none()).collect();
        // All unread documents are read in parallel first; the iterator then finds them in place.
        unread.into_par_iter().for_each(|entry| {
            self.read_entry(entry);
        });
        self.by_name.values().filter_map(|entry| self.read_entry(entry).as_ref().ok())
    }

    /// Error of the first document that cannot be read, in the order of names.
    pub fn first_fault(&self) -> Option<&FileError> {
        self.by_name.values().find_map(|entry| self.read_entry(entry).as_ref().err())
    }

    fn read_entry<'a>(&self, entry: &'a ZooEntry<T>) -> &'a Result<Arc<T>, FileError> {
        entry.read.get_or_init(|| (self.parse)(entry.file, &entry.text).map(Arc::new))
    }
}

/// Entry of a file that is not yet read, with its name without folder and extension.
fn file_entry<T>(file: &'static File<'static>) -> Result<(String, ZooEntry<T>), FileError> {
    let no_text = || FileError {
        file: file.path().display().to_string(),
        line: None,
        field: String::new(),
        message: "is not text".to_owned(),
        further: Vec::new(),
    };
    let path = file.path().to_str().ok_or_else(no_text)?;
    let name = file.path().file_stem().and_then(|stem| stem.to_str()).ok_or_else(no_text)?;
    let text = Cow::Borrowed(file.contents_utf8().ok_or_else(no_text)?);
    Ok((name.to_owned(), ZooEntry { file: path, text, read: OnceLock::new() }))
}
