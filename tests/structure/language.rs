//! The language of the sources, counted: names of one word, participles as types, how doc comments
//! open, plain comments, odd words. `docs/evidence/language.md` has method and table.

use std::path::Path;

use syn::visit::Visit;

/// A count of a whole.
#[derive(Debug, Default, Clone, Copy)]
struct Share {
    part: usize,
    whole: usize,
}

impl Share {
    fn count(&mut self, is_part: bool) {
        self.part += usize::from(is_part);
        self.whole += 1;
    }

    /// The part by the whole; zero of nothing.
    fn value(self) -> f64 {
        if self.whole == 0 { 0.0 } else { self.part as f64 / self.whole as f64 }
    }
}

/// Counts over source files.
#[derive(Debug, Default)]
pub struct Language {
    functions: Share,
    types: Share,
    participles: Share,
    relative_openings: Share,
    odd_words: Share,
    plain_comments: usize,
    code_lines: usize,
    constructors_called_of: usize,
}

/// First words that make a doc comment a relative clause.
const RELATIVE: [&str; 7] = ["What", "Whether", "Who", "Whose", "Of", "How", "By"];

/// Words of a private dialect, which eight other code bases do not use in comments.
const ODD: [&str; 10] =
    ["told", "tells", "nobody", "whoever", "beside", "sail", "sails", "sailed", "askew", "hears"];

/// Type names that are participles without the usual ending.
const IRREGULAR: [&str; 9] =
    ["Made", "Held", "Known", "Told", "Drawn", "Given", "Kept", "Found", "Written"];

/// Type names with the ending of a participle that are none.
const REGULAR: [&str; 3] = ["Speed", "Seed", "Feed"];

impl Language {
    /// Counts one file.
    ///
    /// # Panics
    /// The text is no Rust.
    pub fn add(&mut self, path: &Path, text: &str) {
        let file =
            syn::parse_file(text).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        self.visit_file(&file);
        let mut follows_doc = false;
        for line in text.lines().map(str::trim) {
            let doc = line.strip_prefix("///").or_else(|| line.strip_prefix("//!"));
            match doc {
                Some(doc) => self.doc_line(doc, follows_doc),
                None => self.other_line(line),
            }
            follows_doc = doc.is_some();
        }
    }

    fn doc_line(&mut self, doc: &str, follows_doc: bool) {
        if let Some(first) = doc.split_whitespace().next().filter(|_| !follows_doc) {
            self.relative_openings.count(RELATIVE.contains(&first));
        }
        self.words(doc);
    }

    fn other_line(&mut self, line: &str) {
        if let Some(comment) = line.strip_prefix("//") {
            self.plain_comments += 1;
            self.words(comment);
        } else if !line.is_empty() {
            self.code_lines += 1;
        }
    }

    fn words(&mut self, text: &str) {
        for word in text.split(|c: char| !c.is_ascii_alphabetic()).filter(|word| !word.is_empty()) {
            self.odd_words.count(ODD.contains(&word.to_ascii_lowercase().as_str()));
        }
    }

    fn function(&mut self, name: &syn::Ident) {
        let name = name.to_string();
        self.functions.count(!name.trim_matches('_').contains('_'));
        self.constructors_called_of += usize::from(name == "of");
    }

    fn type_name(&mut self, name: &syn::Ident) {
        let name = name.to_string();
        let name = name.as_str();
        let is_one_word = name.chars().filter(char::is_ascii_uppercase).count() == 1;
        let is_participle = name.ends_with("ed") && !REGULAR.contains(&name);
        self.types.count(is_one_word);
        self.participles.count(is_one_word && (is_participle || IRREGULAR.contains(&name)));
    }

    /// The table: name, value, and the bound that it is held to, which only ever falls (the share
    /// of plain comments only ever rises).
    pub fn rows(&self) -> [(&'static str, f64, f64); 7] {
        let comments = self.plain_comments as f64 / self.code_lines.max(1) as f64;
        [
            ("functions of one word, %", 100.0 * self.functions.value(), 16.0),
            ("types of one word, %", 100.0 * self.types.value(), 9.0),
            ("types that are participles, %", 100.0 * self.participles.value(), 0.5),
            ("functions called `of`", self.constructors_called_of as f64, 0.0),
            (
                "doc comments opening with a relative clause, %",
                100.0 * self.relative_openings.value(),
                0.5,
            ),
            ("odd words by 10,000 of comments", 1e4 * self.odd_words.value(), 0.5),
            ("lines of code by plain comment", 1.0 / comments, 34.0),
        ]
    }
}

impl<'ast> Visit<'ast> for Language {
    fn visit_item_fn(&mut self, item: &'ast syn::ItemFn) {
        self.function(&item.sig.ident);
        syn::visit::visit_item_fn(self, item);
    }

    fn visit_impl_item_fn(&mut self, item: &'ast syn::ImplItemFn) {
        self.function(&item.sig.ident);
        syn::visit::visit_impl_item_fn(self, item);
    }

    fn visit_trait_item_fn(&mut self, item: &'ast syn::TraitItemFn) {
        self.function(&item.sig.ident);
        syn::visit::visit_trait_item_fn(self, item);
    }

    fn visit_item_struct(&mut self, item: &'ast syn::ItemStruct) {
        self.type_name(&item.ident);
    }

    fn visit_item_enum(&mut self, item: &'ast syn::ItemEnum) {
        self.type_name(&item.ident);
    }

    fn visit_item_trait(&mut self, item: &'ast syn::ItemTrait) {
        self.type_name(&item.ident);
        syn::visit::visit_item_trait(self, item);
    }
}
