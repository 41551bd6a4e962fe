//! Names within one form, and formulas read against them.

use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Display;

use indexmap::IndexMap;

use super::names;
use crate::trial::Channel;
use sistership_formula::units::Dimension;
use sistership_formula::{self as formula, Expr};

/// A field at fault and the reason.
pub type FieldFault = (String, String);

/// Names that formulas of a form may use so far.
pub struct FormScope {
    measuring: bool,
    parameters: BTreeMap<String, Dimension>,
    values: BTreeMap<String, Dimension>,
    /// Channels that formulas use, with the field that does.
    needed: RefCell<BTreeMap<Channel, String>>,
}

impl FormScope {
    /// Creates a scope with the names of every formula; `measuring` adds positions and rates of
    /// change.
    pub fn new(measuring: bool) -> Self {
        Self {
            measuring,
            parameters: BTreeMap::new(),
            values: BTreeMap::new(),
            needed: RefCell::default(),
        }
    }

    pub fn add_parameter(
        &mut self,
        field: &str,
        name: &str,
        dimension: Dimension,
    ) -> Result<(), FieldFault> {
        self.check_name(field, name)?;
        self.parameters.insert(name.to_owned(), dimension);
        Ok(())
    }

    /// Reads values in order, each from earlier ones.
    pub fn read_values(
        &mut self,
        raw: &IndexMap<String, String>,
    ) -> Result<IndexMap<String, Expr>, FieldFault> {
        let mut values = IndexMap::new();
        for (name, text) in raw {
            let field = format!("values.{name}");
            self.check_name(&field, name)?;
            let (expr, dimension) = self.read_expr(&field, text, &|n| self.name_dimension(n))?;
            self.values.insert(name.clone(), dimension);
            values.insert(name.clone(), expr);
        }
        Ok(values)
    }

    /// Reads a section of formulas, each of the dimension that `wanted` returns; if `constant` is
    /// true, they may use particulars only.
    pub fn read_section<'a, K, M>(
        &self,
        section: &str,
        raw: impl IntoIterator<Item = (&'a K, &'a String)>,
        wanted: &dyn Fn(&K) -> Result<Dimension, String>,
        constant: bool,
    ) -> Result<M, FieldFault>
    where
        K: Display + Clone + 'a,
        M: FromIterator<(K, Expr)>,
    {
        let one = |(key, text): (&K, &String)| {
            let field = format!("{section}.{key}");
            let wanted = wanted(key).map_err(|e| (field.clone(), e))?;
            let known = |name: &str| {
                if constant { names::constant_dimension(name) } else { self.name_dimension(name) }
            };
            Ok((key.clone(), self.read_formula(&field, text, Some(wanted), &known)?))
        };
        raw.into_iter().map(one).collect()
    }

    /// Reads a formula of parameters and particulars.
    pub fn read_constant(
        &self,
        field: &str,
        text: &str,
        wanted: Option<Dimension>,
    ) -> Result<Expr, FieldFault> {
        self.read_formula(field, text, wanted, &|name| {
            self.parameters.get(name).copied().or_else(|| names::constant_dimension(name))
        })
    }

    /// Checks that the channels that formulas use are listed, so that the form is fitted only to
    /// trials that recorded them.
    pub fn check_needs(&self, listed: &[Channel]) -> Result<(), FieldFault> {
        match self.needed.borrow().iter().find(|(channel, _)| !listed.contains(channel)) {
            Some((channel, field)) => {
                Err((field.clone(), format!("uses `{channel}`, which `needs` does not list")))
            }
            None => Ok(()),
        }
    }

    fn name_dimension(&self, name: &str) -> Option<Dimension> {
        let own = self.parameters.get(name).or_else(|| self.values.get(name)).copied();
        own.or_else(|| names::name_dimension(name, self.measuring))
    }

    fn check_name(&self, field: &str, name: &str) -> Result<(), FieldFault> {
        // The text must be parsed as a single name, not as a number or a call.
        if formula::parse(name) != Ok(Expr::Name(name.to_owned())) {
            return Err((field.to_owned(), "is not a valid name in formulas".into()));
        }
        if self.name_dimension(name).or_else(|| names::name_dimension(name, true)).is_some() {
            return Err((
                field.to_owned(),
                "this name is already a state, channel, particular, parameter or value".into(),
            ));
        }
        Ok(())
    }

    fn read_formula(
        &self,
        field: &str,
        text: &str,
        wanted: Option<Dimension>,
        known: &dyn Fn(&str) -> Option<Dimension>,
    ) -> Result<Expr, FieldFault> {
        let (expr, found) = self.read_expr(field, text, known)?;
        match wanted {
            // A literal zero fits every dimension.
            Some(wanted) if wanted != found && expr != Expr::Number(0.0) => Err((
                field.to_owned(),
                format!("`{text}` has the dimension {found}; {wanted} is needed"),
            )),
            _ => Ok(expr),
        }
    }

    fn read_expr(
        &self,
        field: &str,
        text: &str,
        known: &dyn Fn(&str) -> Option<Dimension>,
    ) -> Result<(Expr, Dimension), FieldFault> {
        let expr = formula::parse(text).map_err(|e| (field.to_owned(), e.to_string()))?;
        let dimension = formula::dimension_of(&expr, known)
            .map_err(|e| (field.to_owned(), format!("`{text}` {e}")))?;
        let names: BTreeSet<&str> = expr.mentioned_names();
        for channel in names
            .into_iter()
            .filter(|name| !self.parameters.contains_key(*name))
            .filter_map(names::required_channel)
        {
            self.needed.borrow_mut().entry(channel).or_insert_with(|| field.to_owned());
        }
        Ok((expr, dimension))
    }
}
