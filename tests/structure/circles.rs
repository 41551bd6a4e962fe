//! Modules that refer to each other in a circle: the strongly connected components of the
//! references (Tarjan 1972, SIAM J Comput 1, 146-160).

use std::collections::BTreeMap;

use super::modules::{Module, References};

/// Every set of two or more modules each of which leads to all the others.
pub fn circles(references: &References) -> Vec<Vec<Module>> {
    let mut search = Search { references, ..Search::new(references) };
    for module in references.keys() {
        if !search.found.contains_key(module) {
            search.visit(module);
        }
    }
    search.circles
}

struct Search<'a> {
    references: &'a References,
    /// When each module was come upon first, and the earliest that it leads back to.
    found: BTreeMap<&'a Module, (usize, usize)>,
    path: Vec<&'a Module>,
    circles: Vec<Vec<Module>>,
}

impl<'a> Search<'a> {
    fn new(references: &'a References) -> Self {
        Self { references, found: BTreeMap::new(), path: Vec::new(), circles: Vec::new() }
    }

    fn visit(&mut self, module: &'a Module) -> usize {
        let order = self.found.len();
        self.found.insert(module, (order, order));
        self.path.push(module);
        let mut earliest = order;
        for target in self.references.get(module).into_iter().flatten() {
            let Some((target, _)) = self.references.get_key_value(target) else { continue };
            let back = match self.found.get(target) {
                None => self.visit(target),
                Some(&(_, back)) if self.path.contains(&target) => back,
                Some(_) => continue,
            };
            earliest = earliest.min(back);
        }
        self.found.insert(module, (order, earliest));
        if earliest == order {
            self.close(module);
        }
        earliest
    }

    fn close(&mut self, module: &Module) {
        let from = self.path.iter().position(|open| *open == module).unwrap_or_default();
        let closed: Vec<Module> = self.path.drain(from..).cloned().collect();
        if closed.len() > 1 {
            self.circles.push(closed);
        }
    }
}
