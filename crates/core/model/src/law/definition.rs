//! A law of motion: formulas over states, inputs, particulars and parameters, linear in its
//! coefficients.

use std::collections::BTreeMap;

use indexmap::IndexMap;

use super::dimension::{STATES, axis_dimension};
use super::dressing::Dressing;
use super::error::TermError;
use crate::coefficient::{Axis, CoefficientName, split_submodel};
use crate::particulars;
use crate::quantity::Quantity;
use crate::source::Source;
use sistership_formula::Expr;
use sistership_formula::units::Dimension;

/// A law, read and checked.
#[derive(Debug, Clone, PartialEq)]
pub struct Law {
    /// Its name in the zoo.
    pub name: String,
    /// One line for people.
    pub title: String,
    /// Where it was published.
    pub sources: BTreeMap<String, Source>,
    /// What it takes from outside besides the states: rudder, revolutions, depth.
    pub inputs: IndexMap<String, Input>,
    /// Nonlinear parameters: everything a vessel must give besides coefficients.
    pub parameters: IndexMap<String, Parameter>,
    /// Intermediate values, in an order in which each needs only earlier ones.
    pub values: IndexMap<String, Expr>,
    /// Their dimensions, each found once: found anew, that of a value named twice in the next would
    /// be found twice.
    pub value_dimensions: BTreeMap<String, Dimension>,
    /// What a factor of a coefficient's name stands for in a regressor.
    pub factors: IndexMap<String, Expr>,
    /// Submodels by name, the first whose conditions hold applies; each one's indicator is the
    /// value [`indicator`].
    pub submodels: IndexMap<String, Submodel>,
    /// The right-hand sides.
    pub axes: BTreeMap<Axis, AxisLaw>,
    /// The mass matrix, by axis and the axis whose acceleration it multiplies; what is absent is
    /// zero.
    pub mass: BTreeMap<(Axis, Axis), Expr>,
    /// Rates of x, y, psi and phi, where they differ from those of motion in the horizontal plane.
    pub kinematics: BTreeMap<String, Expr>,
    /// What parameters and inputs become when the ship is mirrored port to starboard: another one,
    /// or `-name` for the opposite.
    pub mirrors: BTreeMap<String, String>,
    /// What effects add; nothing in a law as its file writes it.
    pub dressing: Dressing,
}

/// Something the law takes from outside.
#[derive(Debug, Clone, PartialEq)]
pub struct Input {
    /// Its dimension.
    pub dimension: Dimension,
    /// What it is where nobody says; without a default it must be given.
    pub default: Option<f64>,
}

/// A nonlinear parameter.
#[derive(Debug, Clone, PartialEq)]
pub struct Parameter {
    /// Its dimension.
    pub dimension: Dimension,
    /// The unit as the law writes it.
    pub unit: String,
    /// What it means.
    pub meaning: String,
    /// How it follows from particulars; used where a vessel does not state it, and when a model
    /// moves to another ship.
    pub from: Option<Expr>,
    /// Whether it is the speed about which the law is expanded, which belongs to the trials and not
    /// to the ship.
    pub is_approach_speed: bool,
}

/// Conditions under which coefficients deviate from the shared ones: while they hold, `X_u@name` is
/// added to `X_u`.
#[derive(Debug, Clone, PartialEq)]
pub struct Submodel {
    /// What it stands for.
    pub meaning: String,
    /// How many times the precision of a deviation's prior, which pulls it to zero, is that of the
    /// shared coefficient's.
    pub shrinkage: f64,
}

/// The name of the value that is 1 while a submodel applies and 0 elsewhere; no formula of a file
/// can spell it.
pub fn indicator(submodel: &str) -> String {
    format!("@{submodel}")
}

/// The right-hand side of one axis.
#[derive(Debug, Clone, PartialEq)]
pub struct AxisLaw {
    /// Multiplies every term: makes a force in N (moment in N m) of a dimensionless sum.
    pub scale: Expr,
    /// Regressors of the coefficients in which the law is linear, without the scale.
    pub terms: IndexMap<String, Expr>,
    /// What is added as it is, in N or N m.
    pub rest: Expr,
    /// Whether a vessel may add any further term that the factors can spell.
    pub open: bool,
}

impl Law {
    /// A law of nothing: what stands in where a vessel has no model at all.
    pub(crate) fn empty() -> Self {
        Self {
            name: String::new(),
            title: String::new(),
            sources: BTreeMap::new(),
            inputs: IndexMap::new(),
            parameters: IndexMap::new(),
            values: IndexMap::new(),
            value_dimensions: BTreeMap::new(),
            factors: IndexMap::new(),
            submodels: IndexMap::new(),
            axes: BTreeMap::new(),
            mass: BTreeMap::new(),
            kinematics: BTreeMap::new(),
            mirrors: BTreeMap::new(),
            dressing: Dressing::default(),
        }
    }

    /// The factors this law adds to the standard ones.
    pub fn extra_factors(&self) -> Vec<&str> {
        self.factors
            .keys()
            .map(String::as_str)
            .filter(|f| !crate::coefficient::STANDARD_FACTORS.contains(f))
            .collect()
    }

    /// The regressor of a coefficient with its axis' scale: the force in N (or N m) per unit of the
    /// coefficient.
    ///
    /// # Errors
    /// Says why the law has no such coefficient.
    pub fn regressor(&self, name: &str) -> Result<(Axis, Expr), TermError> {
        let (axis, term) = self.term(name)?;
        Ok((axis, self.axes[&axis].scale.clone().times(term)))
    }

    /// The regressor of a coefficient without its axis' scale.
    ///
    /// # Errors
    /// Says why the law has no such coefficient.
    pub fn term(&self, name: &str) -> Result<(Axis, Expr), TermError> {
        let parsed = CoefficientName::parse(name, &self.extra_factors())?;
        let axis = self
            .axes
            .get(&parsed.axis)
            .ok_or_else(|| TermError::Axis { law: self.name.clone(), axis: parsed.axis })?;
        let (shared, submodel) = split_submodel(name);
        let term = match axis.terms.get(shared) {
            Some(term) => term.clone(),
            None if axis.open => self.product(&parsed)?,
            None => {
                let known: Vec<&str> = axis.terms.keys().map(String::as_str).collect();
                let (law, known) = (self.name.clone(), known.join(", "));
                return Err(TermError::Unlisted { law, name: name.to_owned(), known });
            }
        };
        let term = submodel.map_or(Ok(term.clone()), |submodel| self.under(submodel, term))?;
        let factors = self.dressing.coefficients.iter().filter(|(of, _)| of == shared);
        let term = factors.fold(term, |term, (_, factor)| term.times(factor.clone()));
        let straight = self.dressing.straight.as_ref();
        Ok((parsed.axis, straight.map_or(term.clone(), |of| of.blended(term, &axis.scale))))
    }

    /// The regressor that a name spells: the product of what its factors stand for.
    pub(crate) fn product(&self, name: &CoefficientName) -> Result<Expr, TermError> {
        name.factors.iter().try_fold(Expr::Number(1.0), |product, factor| {
            let of = self.factors.get(&factor.symbol);
            let of = of.ok_or_else(|| TermError::Factor {
                law: self.name.clone(),
                symbol: factor.symbol.clone(),
            })?;
            let of = of.clone();
            let of = if factor.absolute {
                Expr::Call(sistership_formula::Function::Abs, vec![of])
            } else {
                of
            };
            Ok(if product == Expr::Number(1.0) { of } else { product.times(of) })
        })
    }

    /// A term while a submodel applies, nothing elsewhere.
    fn under(&self, submodel: &str, term: Expr) -> Result<Expr, TermError> {
        if self.submodels.contains_key(submodel) {
            return Ok(term.times(Expr::Name(indicator(submodel))));
        }
        let known: Vec<&str> = self.submodels.keys().map(String::as_str).collect();
        let known = if known.is_empty() { "none".to_owned() } else { known.join(", ") };
        Err(TermError::Submodel { law: self.name.clone(), submodel: submodel.to_owned(), known })
    }

    /// The unit of a coefficient, which follows from its regressor; `1` in a prime system.
    ///
    /// # Errors
    /// As [`Law::regressor`].
    pub fn coefficient_dimension(&self, name: &str) -> Result<Dimension, TermError> {
        let (axis, regressor) = self.regressor(name)?;
        Ok(axis_dimension(axis)
            - sistership_formula::dimension_of(&regressor, &|n| self.dimension(n))?)
    }

    /// The dimension of any name that a formula of this law may mention.
    pub fn dimension(&self, name: &str) -> Option<Dimension> {
        let state =
            STATES.iter().find(|(state, _)| *state == name).map(|&(_, dimension)| dimension);
        state
            .or_else(|| sistership_formula::builtin(name).map(|(_, dimension)| dimension))
            .or_else(|| self.inputs.get(name).map(|input| input.dimension))
            .or_else(|| self.parameters.get(name).map(|parameter| parameter.dimension))
            .or_else(|| self.value_dimensions.get(name).copied())
            .or_else(|| particulars::dimension(name))
    }

    /// Adds a value that needs only earlier ones.
    pub fn add_value(&mut self, name: String, expr: Expr) {
        if let Ok(dimension) = sistership_formula::dimension_of(&expr, &|n| self.dimension(n)) {
            self.value_dimensions.insert(name.clone(), dimension);
        }
        self.values.insert(name, expr);
    }

    /// The value of a parameter for a ship: how it follows from its particulars, where the law says
    /// so and they suffice.
    pub fn derived_parameter(&self, name: &str, ship: &BTreeMap<String, Quantity>) -> Option<f64> {
        let from = self.parameters.get(name)?.from.as_ref()?;
        from.value(&|particular| particulars::value(ship, particular))
            .filter(|value| value.is_finite())
    }

    /// The parameter about which the law is expanded, if it has one.
    pub fn approach_speed_parameter(&self) -> Option<&str> {
        self.parameters
            .iter()
            .find(|(_, parameter)| parameter.is_approach_speed)
            .map(|(name, _)| name.as_str())
    }

    /// Whether roll is a state of its own.
    pub fn has_roll(&self) -> bool {
        self.axes.contains_key(&Axis::K)
    }
}
