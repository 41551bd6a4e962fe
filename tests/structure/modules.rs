//! Which module of a crate refers to which, read from its source: `use` lines and paths in code
//! alike. A name that a module only hands on (`pub use child::Name`) counts for the module that
//! defines it, so a folder's `mod.rs` may show what its files hold without a circle.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use proc_macro2::{TokenStream, TokenTree};
use syn::visit::Visit;

/// A module by the names of its folders and file; the crate's root is empty.
pub type Module = Vec<String>;
/// What each module refers to.
pub type References = BTreeMap<Module, BTreeSet<Module>>;

/// What one file says.
#[derive(Default)]
struct Source {
    /// The modules that it declares.
    children: BTreeSet<String>,
    /// What it hands on: the name, and where it comes from.
    handed_on: Vec<(String, Vec<String>)>,
    /// Every path in it that is not only handed on.
    paths: Vec<Vec<String>>,
}

/// The references between the modules of a crate, tests left out.
pub fn references(root: &Path) -> References {
    let sources = read(root);
    let known =
        |module: &Module| sources.get(module).map(|source| of_file(&sources, module, source));
    sources.keys().filter_map(|module| Some((module.clone(), known(module)?))).collect()
}

fn of_file(
    sources: &BTreeMap<Module, Source>,
    module: &Module,
    source: &Source,
) -> BTreeSet<Module> {
    let all = source.paths.iter().filter_map(|path| definition(sources, module, path, 0));
    all.filter(|target| target != module).collect()
}

/// The module that defines what a path, as written in `module`, leads to.
fn definition(
    sources: &BTreeMap<Module, Source>,
    module: &Module,
    path: &[String],
    depth: usize,
) -> Option<Module> {
    const HANDED_ON_AT_MOST: usize = 8;
    let (mut at, mut rest) = begin(sources, module, path)?;
    while let Some((name, after)) = rest.split_first() {
        let inner: Module = at.iter().chain([name]).cloned().collect();
        if sources.contains_key(&inner) {
            (at, rest) = (inner, after);
            continue;
        }
        let source = sources.get(&at)?;
        let from = source.handed_on.iter().find(|(handed, _)| handed == name).map(|(_, from)| from);
        let further = from
            .filter(|_| depth < HANDED_ON_AT_MOST)
            .and_then(|from| definition(sources, &at, from, depth + 1));
        return Some(further.unwrap_or(at));
    }
    Some(at)
}

/// Where a path begins: `crate`, `super`, `self` or a module declared here; nothing for other
/// crates and local names.
fn begin<'a>(
    sources: &BTreeMap<Module, Source>,
    module: &Module,
    path: &'a [String],
) -> Option<(Module, &'a [String])> {
    let ups = path.iter().take_while(|name| *name == "super").count();
    match path.first()?.as_str() {
        "crate" => Some((Module::new(), &path[1..])),
        "self" => Some((module.clone(), &path[1..])),
        "super" => Some((module[..module.len().checked_sub(ups)?].to_vec(), &path[ups..])),
        child if sources.get(module)?.children.contains(child) => Some((module.clone(), path)),
        _ => None,
    }
}

/// The source files of a crate, tests left out, with what stands in them before their own tests.
pub fn texts(root: &Path) -> Vec<(PathBuf, String)> {
    let product = |(_, path): (Module, PathBuf)| {
        let text = text(&path);
        let end = text.find("#[cfg(test)]\nmod tests {").unwrap_or(text.len());
        (path, text[..end].to_owned())
    };
    files(root).into_iter().map(product).collect()
}

fn read(root: &Path) -> BTreeMap<Module, Source> {
    files(root).into_iter().map(|(module, path)| (module, source(&path))).collect()
}

fn files(root: &Path) -> Vec<(Module, PathBuf)> {
    let mut files = Vec::new();
    let mut open = vec![root.to_owned()];
    while let Some(folder) = open.pop() {
        for entry in std::fs::read_dir(&folder)
            .unwrap_or_else(|error| panic!("{}: {error}", folder.display()))
        {
            let path = entry.expect("a listed file").path();
            if path.is_dir() {
                open.push(path);
            } else if let Some(module) = module_of(root, &path).filter(|module| !is_test(module)) {
                files.push((module, path));
            }
        }
    }
    files
}

fn text(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

fn module_of(root: &Path, path: &Path) -> Option<Module> {
    let inside = path.strip_prefix(root).ok()?.with_extension("");
    let mut module: Module =
        inside.iter().map(|part| part.to_string_lossy().into_owned()).collect();
    if path.extension()? != "rs" {
        return None;
    }
    if matches!(module.last().map(String::as_str), Some("lib" | "main" | "mod")) {
        module.pop();
    }
    Some(module)
}

/// Tests may look at anything.
fn is_test(module: &Module) -> bool {
    module.iter().any(|part| {
        ["tests", "testing", "journey"].contains(&part.as_str()) || part.ends_with("_tests")
    })
}

fn source(path: &Path) -> Source {
    let file =
        syn::parse_file(&text(path)).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let mut source = Source::default();
    source.visit_file(&file);
    source
}

fn only_for_tests(attributes: &[syn::Attribute]) -> bool {
    let says_test = |attribute: &syn::Attribute| match &attribute.meta {
        syn::Meta::List(list) => {
            list.path.is_ident("cfg") && list.tokens.to_string().contains("test")
        }
        _ => false,
    };
    attributes.iter().any(says_test)
}

impl<'ast> Visit<'ast> for Source {
    fn visit_item_mod(&mut self, item: &'ast syn::ItemMod) {
        if only_for_tests(&item.attrs) {
            return;
        }
        match &item.content {
            None => drop(self.children.insert(item.ident.to_string())),
            Some(_) => syn::visit::visit_item_mod(self, item),
        }
    }

    fn visit_item_fn(&mut self, item: &'ast syn::ItemFn) {
        if !only_for_tests(&item.attrs) {
            syn::visit::visit_item_fn(self, item);
        }
    }

    fn visit_item_use(&mut self, item: &'ast syn::ItemUse) {
        if only_for_tests(&item.attrs) {
            return;
        }
        let public = !matches!(item.vis, syn::Visibility::Inherited);
        for (path, name) in leaves(&item.tree, &mut Vec::new()) {
            if public {
                self.handed_on.push((name, path.clone()));
            }
            // A folder that shows what its own files hold depends on nothing.
            if !(public && self.children.contains(&path[0])) {
                self.paths.push(path);
            }
        }
    }

    /// Who may see a thing is no use of whoever may.
    fn visit_visibility(&mut self, _: &'ast syn::Visibility) {}

    fn visit_path(&mut self, path: &'ast syn::Path) {
        self.paths.push(path.segments.iter().map(|segment| segment.ident.to_string()).collect());
        syn::visit::visit_path(self, path);
    }

    fn visit_macro(&mut self, item: &'ast syn::Macro) {
        self.visit_path(&item.path);
        self.tokens(item.tokens.clone());
    }
}

impl Source {
    /// Paths in the arguments of a macro, which are tokens only.
    fn tokens(&mut self, tokens: TokenStream) {
        let mut path = Vec::new();
        let mut colons = 0;
        for token in tokens {
            match token {
                TokenTree::Ident(name) => {
                    if colons != 2 {
                        self.end(&mut path);
                    }
                    path.push(name.to_string());
                    colons = 0;
                }
                TokenTree::Punct(mark) if mark.as_char() == ':' => colons += 1,
                TokenTree::Group(group) => {
                    self.end(&mut path);
                    self.tokens(group.stream());
                }
                _ => self.end(&mut path),
            }
        }
        self.end(&mut path);
    }

    fn end(&mut self, path: &mut Vec<String>) {
        let path = std::mem::take(path);
        if path.len() > 1 {
            self.paths.push(path);
        }
    }
}

/// The paths of a `use`, with the name that each is known by.
fn leaves(tree: &syn::UseTree, before: &mut Vec<String>) -> Vec<(Vec<String>, String)> {
    let with =
        |name: &syn::Ident| before.iter().cloned().chain([name.to_string()]).collect::<Vec<_>>();
    match tree {
        syn::UseTree::Name(leaf) if leaf.ident == "self" => {
            vec![(before.clone(), before.last().cloned().unwrap_or_default())]
        }
        syn::UseTree::Name(leaf) => vec![(with(&leaf.ident), leaf.ident.to_string())],
        syn::UseTree::Rename(leaf) => vec![(with(&leaf.ident), leaf.rename.to_string())],
        syn::UseTree::Glob(_) => vec![(before.clone(), "*".to_owned())],
        syn::UseTree::Group(group) => {
            group.items.iter().flat_map(|item| leaves(item, before)).collect()
        }
        syn::UseTree::Path(path) => {
            before.push(path.ident.to_string());
            let found = leaves(&path.tree, before);
            before.pop();
            found
        }
    }
}
