//! Effects whose forces are affine in their parameters, as terms of the law, so that an estimator
//! of coefficients also estimates these parameters.

use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet, HashMap};

use indexmap::IndexMap;

use super::applied::AppliedEffect;
use super::effect_application::qualified_name;
use super::probe::{FormulaProbe, SEEDS};
use crate::Model;
use crate::coefficient::Axis;
use crate::law::{Law, LawAdditions};
use crate::quantity::Quantity;
use sistership_formula::Expr;

/// Model and law with the parameters of all its effects among the coefficients.
#[derive(Debug, Clone)]
pub struct EffectsAsTerms {
    /// The law.
    pub law: Law,
    /// The model, without effects.
    pub model: Model,
    /// The original model.
    of: Model,
    /// Coefficients with the index of the effect and the parameter that they represent.
    terms: Vec<(String, usize, String)>,
}

impl EffectsAsTerms {
    /// Converts a model whose effects only add forces, affine in parameters that each act on one
    /// axis; `None` if an effect does otherwise, or if there is no effect. Each parameter has the
    /// mean of its prior, which is also its source.
    ///
    /// # Errors
    /// The errors of [`Law::with_effects`].
    pub fn new(model: &Model, law: &Law) -> Result<Option<Self>, (String, String)> {
        let dressed = law.with_effects(model)?;
        let LawAdditions { accelerations, lags, bands, measures, .. } = &dressed.dressing;
        if !(accelerations.is_empty() && lags.is_empty() && bands.is_empty() && measures.is_empty())
        {
            return Ok(None);
        }
        // The effects become terms of the law, so that the bare model has none.
        let bare = Model { effects: Vec::new(), propulsion: None, ..model.clone() };
        let mut as_terms =
            Self { law: dressed.clone(), model: bare, of: model.clone(), terms: Vec::new() };
        for (place, effect) in model.effects.iter().enumerate() {
            let Some(by_axis) = AffineEffect::new(&dressed, effect).parameters_by_axis() else {
                return Ok(None);
            };
            by_axis.iter().for_each(|(axis, parameters)| {
                as_terms.add_effect(place, effect, *axis, parameters)
            });
        }
        Ok((!as_terms.terms.is_empty()).then_some(as_terms))
    }

    fn add_effect(
        &mut self,
        place: usize,
        effect: &AppliedEffect,
        axis: Axis,
        parameters: &[String],
    ) {
        let (still, terms) = AffineEffect::new(&self.law, effect).split_terms(axis, parameters);
        let Some(of_axis) = self.law.axes.get_mut(&axis) else { return };
        // The force at zero parameters stays in the rest of the axis.
        of_axis.rest = still;
        for (parameter, term) in parameters.iter().zip(terms) {
            let factor = qualified_name(&effect.name, &effect.form.name, parameter);
            let name = format!("{axis}_{factor}");
            of_axis.terms.insert(name.clone(), term.clone());
            self.law.dressing.parameters.remove(&factor);
            self.law.factors.insert(factor, term);
            let mean = effect.form.parameters.get(parameter).map_or(0.0, |own| own.prior.mean);
            self.model
                .coefficients
                .insert(name.clone(), Quantity::new(mean, format!("prior of {}", effect.name)));
            self.terms.push((name, place, parameter.clone()));
        }
    }

    /// Returns the original model with fitted values of coefficients and of the parameters of
    /// effects.
    pub fn with_fitted_values(&self, coefficients: &BTreeMap<String, Quantity>) -> Model {
        let mut model = self.of.clone();
        for (name, fitted) in coefficients {
            let of_effect = self.terms.iter().find(|(term, ..)| term == name);
            let old = match of_effect {
                Some((_, place, parameter)) => model.effects[*place].parameters.get_mut(parameter),
                None => model.coefficients.get_mut(name),
            };
            old.into_iter().for_each(|old| {
                (old.value, old.standard_error) = (fitted.value, fitted.standard_error)
            });
        }
        model
    }
}

/// Largest number of numbers, names and operators of what is added to an axis, with the values that
/// mention the effect substituted.
const MAX_EXPANDED_SIZE: usize = 20_000;

/// Effect in a law that includes it.
struct AffineEffect<'a> {
    law: &'a Law,
    effect: &'a AppliedEffect,
    /// Values that mention a parameter of the effect, directly or through other values.
    acting: BTreeSet<&'a str>,
}

impl<'a> AffineEffect<'a> {
    fn new(law: &'a Law, effect: &'a AppliedEffect) -> Self {
        let mut affine = Self { law, effect, acting: BTreeSet::new() };
        let mut known = HashMap::new();
        // One map per parameter: the known dependences are those on that parameter.
        for parameter in effect.parameters.keys() {
            known.clear();
            for (name, value) in &law.values {
                if affine.depends_on(value, &affine.qualified_name(parameter), &mut known) {
                    affine.acting.insert(name);
                }
            }
        }
        affine
    }

    /// Returns the size of a formula with the values that mention the effect substituted.
    fn expanded_size(&self, expr: &Expr, known: &mut HashMap<&'a str, usize>) -> usize {
        let Expr::Name(name) = expr else {
            let below = expr.children().into_iter().map(|child| self.expanded_size(child, known));
            return below.fold(1, usize::saturating_add);
        };
        let Some((name, value)) = self
            .law
            .values
            .get_key_value(name.as_str())
            .filter(|(name, _)| self.acting.contains(name.as_str()))
        else {
            return 1;
        };
        if let Some(size) = known.get(name.as_str()) {
            return *size;
        }
        let size = self.expanded_size(value, known);
        known.insert(name, size);
        size
    }

    /// Returns the parameters that act on each axis; `None` if one acts on several axes, elsewhere,
    /// or not in proportion.
    fn parameters_by_axis(&self) -> Option<Vec<(Axis, Vec<String>)>> {
        // Substitution may grow exponentially, so that the size is measured before it is done.
        let mut sizes = HashMap::new();
        if self
            .law
            .axes
            .values()
            .any(|axis| self.expanded_size(&axis.rest, &mut sizes) > MAX_EXPANDED_SIZE)
        {
            return None;
        }
        let acts = |parameter: &String| {
            let (wanted, mut known) = (self.qualified_name(parameter), HashMap::new());
            let on: Vec<Axis> = self
                .law
                .axes
                .iter()
                .filter(|(_, axis)| self.depends_on(&axis.rest, &wanted, &mut known))
                .map(|(axis, _)| *axis)
                .collect();
            // A parameter on several axes would need one coefficient for all of them.
            let [axis] = on[..] else { return None };
            (!self.acts_elsewhere(&wanted, &mut known)).then_some(axis)
        };
        let mut by_axis: Vec<(Axis, Vec<String>)> = Vec::new();
        for parameter in self.effect.parameters.keys() {
            let axis = acts(parameter)?;
            match by_axis.iter_mut().find(|(other, _)| *other == axis) {
                Some((_, parameters)) => parameters.push(parameter.clone()),
                None => by_axis.push((axis, vec![parameter.clone()])),
            }
        }
        by_axis
            .iter()
            .all(|(axis, parameters)| self.is_affine(*axis, parameters))
            .then_some(by_axis)
    }

    fn qualified_name(&self, parameter: &str) -> String {
        qualified_name(&self.effect.name, &self.effect.form.name, parameter)
    }

    /// Returns true if a formula mentions a parameter by its whole name, directly or through
    /// values, each of which is examined once.
    fn depends_on(&self, expr: &Expr, wanted: &str, known: &mut HashMap<&'a str, bool>) -> bool {
        let Expr::Name(name) = expr else {
            return expr.children().into_iter().any(|child| self.depends_on(child, wanted, known));
        };
        if name == wanted {
            return true;
        }
        let Some((name, value)) = self.law.values.get_key_value(name.as_str()) else {
            return false;
        };
        if let Some(depends) = known.get(name.as_str()) {
            return *depends;
        }
        let depends = self.depends_on(value, wanted, known);
        known.insert(name, depends);
        depends
    }

    /// Returns true if anything other than the forces added to the axes mentions a parameter.
    fn acts_elsewhere(&self, wanted: &str, known: &mut HashMap<&'a str, bool>) -> bool {
        let law = self.law;
        let of_axes = law.axes.values().flat_map(|axis| axis.terms.values().chain([&axis.scale]));
        let of_coefficients = law.dressing.coefficients.iter().map(|(_, expr)| expr);
        let all =
            of_axes.chain(of_coefficients).chain(law.factors.values()).chain(law.mass.values());
        all.chain(law.kinematics.values()).any(|expr| self.depends_on(expr, wanted, known))
    }

    /// Returns what is added to an axis without the effect, and the term of each parameter.
    fn split_terms(&self, axis: Axis, parameters: &[String]) -> (Expr, Vec<Expr>) {
        let still = self.rest_with_values(axis, &|_| 0.0);
        let term = |own: &String| {
            // An affine force: its slope is its value at one less that at zero.
            let unit = self.rest_with_values(axis, &|name| f64::from(u8::from(name == own)));
            let force = Expr::Subtract(Box::new(unit), Box::new(still.clone()));
            Expr::Divide(Box::new(force), Box::new(self.law.axes[&axis].scale.clone()))
        };
        let terms = parameters.iter().map(term).collect();
        (still, terms)
    }

    /// Returns what is added to an axis, with numbers for the effect's parameters.
    fn rest_with_values(&self, axis: Axis, number: &dyn Fn(&str) -> f64) -> Expr {
        self.substitute_parameters(&self.law.axes[&axis].rest, number)
    }

    fn substitute_parameters(&self, expr: &Expr, number: &dyn Fn(&str) -> f64) -> Expr {
        let parameters: Vec<&String> = self.effect.parameters.keys().collect();
        expr.replace_names(&|name| {
            if let Some(own) = parameters.iter().find(|own| self.qualified_name(own) == name) {
                return Some(Expr::Number(number(own)));
            }
            let value = self.law.values.get(name)?;
            self.acting.contains(name).then(|| self.substitute_parameters(value, number))
        })
    }

    /// Returns true if, at a few points, what is added to an axis is its value without the effect
    /// plus a multiple of each parameter.
    fn is_affine(&self, axis: Axis, parameters: &[String]) -> bool {
        let none = IndexMap::new();
        SEEDS.iter().all(|&seed| {
            let probe = FormulaProbe {
                parameters: &none,
                values: &self.law.values,
                seed,
                mirrored: false,
                absent: false,
                known: RefCell::default(),
            };
            let of = |number: &dyn Fn(&str) -> f64| {
                probe.evaluate_formula(&self.rest_with_values(axis, number))
            };
            let size = |own: &str| {
                probe.evaluate_formula(&Expr::Name(self.qualified_name(own))).unwrap_or(1.0)
            };
            let Some((together, still)) = of(&size).zip(of(&|_| 0.0)) else { return false };
            let one = |own: &String| {
                Some(size(own) * (of(&|name| f64::from(u8::from(name == own)))? - still))
            };
            let Some(each) = parameters.iter().map(one).collect::<Option<Vec<f64>>>() else {
                return false;
            };
            let scale =
                together.abs() + still.abs() + each.iter().map(|one| one.abs()).sum::<f64>();
            // Affine: the joint effect of all parameters is the sum of their single effects.
            (together - still - each.iter().sum::<f64>()).abs() <= 1e-9 * scale
        })
    }
}
