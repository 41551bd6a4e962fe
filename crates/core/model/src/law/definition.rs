//! Law of motion: formulas of states, inputs, particulars and parameters, linear in its
//! coefficients.

use std::collections::BTreeMap;

use indexmap::IndexMap;

use super::additions::LawAdditions;
use super::dimension::{STATES, axis_dimension};
use super::error::TermError;
use super::file::ParameterPrior;
use crate::coefficient::{Axis, CoefficientName, split_submodel};
use crate::particulars;
use crate::quantity::Quantity;
use crate::source::Source;
use sistership_formula::Expr;
use sistership_formula::units::Dimension;

/// Law, read and checked.
#[derive(Debug, Clone, PartialEq)]
pub struct Law {
    /// Name in the zoo.
    pub name: String,
    /// One line for readers.
    pub title: String,
    /// Publications of the law.
    pub sources: BTreeMap<String, Source>,
    /// Inputs in addition to the states: rudder, revolutions, depth.
    pub inputs: IndexMap<String, LawInput>,
    /// Nonlinear parameters: everything that a vessel must give besides coefficients.
    pub parameters: IndexMap<String, LawParameter>,
    /// Intermediate values, ordered so that each needs only earlier ones.
    pub values: IndexMap<String, Expr>,
    /// Dimensions of the values, each determined once: a repeated search would double with each
    /// value that names another one twice.
    pub value_dimensions: BTreeMap<String, Dimension>,
    /// Meaning of each factor of a coefficient's name in a regressor.
    pub factors: IndexMap<String, Expr>,
    /// Submodels by name; the first one whose conditions hold applies. The indicator of each is the
    /// value [`indicator`].
    pub submodels: IndexMap<String, LawSubmodel>,
    /// Right-hand sides by axis.
    pub axes: BTreeMap<Axis, AxisLaw>,
    /// Mass matrix, by axis and the axis whose acceleration it multiplies; absent entries are zero.
    pub mass: BTreeMap<(Axis, Axis), Expr>,
    /// Rates of x, y, psi and phi, where they differ from those of motion in the horizontal plane.
    pub kinematics: BTreeMap<String, Expr>,
    /// Typical values of coefficients by name; the prior of a model without a source.
    pub typical: IndexMap<String, CoefficientPrior>,
    /// Transformation of parameters and inputs when the ship is mirrored port to starboard: another
    /// name, or `-name` for the opposite.
    pub mirrors: BTreeMap<String, String>,
    /// Additions of effects; empty in a law as its file writes it.
    pub dressing: LawAdditions,
}

/// Formulas of a coefficient's typical value and of its standard deviation over ships.
#[derive(Debug, Clone, PartialEq)]
pub struct CoefficientPrior {
    /// Typical value.
    pub value: Expr,
    /// Standard deviation over ships.
    pub deviation: Expr,
}

/// Input of the law.
#[derive(Debug, Clone, PartialEq)]
pub struct LawInput {
    /// Its dimension.
    pub dimension: Dimension,
    /// Default value; an input without a default must be given.
    pub default: Option<f64>,
    /// Value under an order of helm, as a formula of `delta` (rad) and `n` (1/s): manoeuvres order
    /// these two alone.
    pub helm: Option<Expr>,
}

/// Nonlinear parameter.
#[derive(Debug, Clone, PartialEq)]
pub struct LawParameter {
    /// Its dimension.
    pub dimension: Dimension,
    /// The unit as the law writes it.
    pub unit: String,
    /// Its meaning.
    pub meaning: String,
    /// Formula of particulars; used if a vessel does not state the parameter, and when a model is
    /// transferred to another ship.
    pub from: Option<Expr>,
    /// True for the speed about which the law is expanded, which belongs to the trials and not to
    /// the ship.
    pub is_approach_speed: bool,
    /// Prior by which trials determine it; none for a parameter that keeps the source's value.
    pub prior: Option<ParameterPrior>,
}

/// Conditions under which coefficients deviate from the shared ones: while they hold, `X_u@name` is
/// added to `X_u`.
#[derive(Debug, Clone, PartialEq)]
pub struct LawSubmodel {
    /// Its meaning.
    pub meaning: String,
    /// Precision of a deviation's prior, which shrinks it to zero, relative to that of the shared
    /// coefficient's prior.
    pub shrinkage: f64,
}

/// Name of the value that is 1 while a submodel applies and 0 otherwise; formulas of files cannot
/// contain it.
pub fn indicator_name(submodel: &str) -> String {
    format!("@{submodel}")
}

/// Right-hand side of one axis.
#[derive(Debug, Clone, PartialEq)]
pub struct AxisLaw {
    /// Factor of every term: converts a dimensionless sum to a force in N (moment in N m).
    pub scale: Expr,
    /// Regressors of the coefficients in which the law is linear, without the scale.
    pub terms: IndexMap<String, Expr>,
    /// Force without coefficients, N or N m.
    pub rest: Expr,
    /// True if a vessel may add any term that the factors can express.
    pub open: bool,
}

impl Law {
    /// Returns a law without formulas, for a vessel that has no model.
    pub(crate) fn empty_law() -> Self {
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
            typical: IndexMap::new(),
            mirrors: BTreeMap::new(),
            dressing: LawAdditions::default(),
        }
    }

    /// Factors that the law adds to the standard ones.
    pub fn extra_factors(&self) -> Vec<&str> {
        self.factors
            .keys()
            .map(String::as_str)
            .filter(|f| !crate::coefficient::STANDARD_FACTORS.contains(f))
            .collect()
    }

    /// Returns the regressor of a coefficient with the scale of its axis: the force in N (or N m)
    /// per unit of the coefficient.
    ///
    /// # Errors
    /// Returns an error if the law has no such coefficient.
    pub fn scaled_regressor(&self, name: &str) -> Result<(Axis, Expr), TermError> {
        let (axis, term) = self.unscaled_regressor(name)?;
        Ok((axis, self.axes[&axis].scale.clone().times(term)))
    }

    /// Returns the regressor of a coefficient without the scale of its axis.
    ///
    /// # Errors
    /// Returns an error if the law has no such coefficient.
    pub fn unscaled_regressor(&self, name: &str) -> Result<(Axis, Expr), TermError> {
        let parsed = CoefficientName::parse(name, &self.extra_factors())?;
        let axis = self
            .axes
            .get(&parsed.axis)
            .ok_or_else(|| TermError::Axis { law: self.name.clone(), axis: parsed.axis })?;
        let (shared, submodel) = split_submodel(name);
        // A listed term has its own formula; an open axis also accepts products of known factors.
        let term = match axis.terms.get(shared) {
            Some(term) => term.clone(),
            None if axis.open => self.factor_product(&parsed)?,
            None => {
                let known: Vec<&str> = axis.terms.keys().map(String::as_str).collect();
                let (law, known) = (self.name.clone(), known.join(", "));
                return Err(TermError::Unlisted { law, name: name.to_owned(), known });
            }
        };
        let term =
            submodel.map_or(Ok(term.clone()), |submodel| self.conditional_term(submodel, term))?;
        // Effects may scale the coefficient.
        let factors = self.dressing.coefficients.iter().filter(|(of, _)| of == shared);
        let term = factors.fold(term, |term, (_, factor)| term.times(factor.clone()));
        // Outside the range covered by trials the propulsion balance replaces the term straight
        // ahead.
        let straight = self.dressing.straight.as_ref();
        Ok((parsed.axis, straight.map_or(term.clone(), |of| of.subtract_share(term, &axis.scale))))
    }

    /// Returns the regressor that a name expresses: the product of its factors.
    pub(crate) fn factor_product(&self, name: &CoefficientName) -> Result<Expr, TermError> {
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

    /// Returns a term that is zero unless a submodel applies.
    fn conditional_term(&self, submodel: &str, term: Expr) -> Result<Expr, TermError> {
        if self.submodels.contains_key(submodel) {
            // The indicator is 1 while the submodel applies and 0 otherwise.
            return Ok(term.times(Expr::Name(indicator_name(submodel))));
        }
        let known: Vec<&str> = self.submodels.keys().map(String::as_str).collect();
        let known = if known.is_empty() { "none".to_owned() } else { known.join(", ") };
        Err(TermError::Submodel { law: self.name.clone(), submodel: submodel.to_owned(), known })
    }

    /// Unit of a coefficient, which follows from its regressor; `1` in a prime system.
    ///
    /// # Errors
    /// The errors of [`Law::regressor`].
    pub fn coefficient_dimension(&self, name: &str) -> Result<Dimension, TermError> {
        let (axis, regressor) = self.scaled_regressor(name)?;
        Ok(axis_dimension(axis)
            - sistership_formula::dimension_of(&regressor, &|n| self.name_dimension(n))?)
    }

    /// Dimension of any name that a formula of this law may use; `None` for an unknown name.
    pub fn name_dimension(&self, name: &str) -> Option<Dimension> {
        let state =
            STATES.iter().find(|(state, _)| *state == name).map(|&(_, dimension)| dimension);
        state
            .or_else(|| sistership_formula::builtin_constant(name).map(|(_, dimension)| dimension))
            .or_else(|| self.inputs.get(name).map(|input| input.dimension))
            .or_else(|| self.parameters.get(name).map(|parameter| parameter.dimension))
            .or_else(|| self.value_dimensions.get(name).copied())
            .or_else(|| particulars::particular_dimension(name))
    }

    /// Adds a value that needs only earlier ones.
    pub fn add_value(&mut self, name: String, expr: Expr) {
        // A value whose dimension cannot be determined stays unknown to later checks of units.
        if let Ok(dimension) = sistership_formula::dimension_of(&expr, &|n| self.name_dimension(n))
        {
            self.value_dimensions.insert(name.clone(), dimension);
        }
        self.values.insert(name, expr);
    }

    /// Value of a parameter that follows from the particulars of a ship; `None` if the law has no
    /// formula for it, or if the particulars do not suffice.
    pub fn derived_parameter(&self, name: &str, ship: &BTreeMap<String, Quantity>) -> Option<f64> {
        let from = self.parameters.get(name)?.from.as_ref()?;
        from.value(&|particular| particulars::particular_value(ship, particular))
            .filter(|value| value.is_finite())
    }

    /// Name of the parameter about which the law is expanded, if it has one.
    pub fn approach_speed_parameter(&self) -> Option<&str> {
        self.parameters
            .iter()
            .find(|(_, parameter)| parameter.is_approach_speed)
            .map(|(name, _)| name.as_str())
    }

    /// Names of the parameters that trials determine, with their priors.
    pub fn parameter_priors(&self) -> impl Iterator<Item = (&String, ParameterPrior)> {
        self.parameters.iter().filter_map(|(name, parameter)| Some((name, parameter.prior?)))
    }

    /// Returns true for a 4-DOF law, in which roll is a state.
    pub fn has_roll(&self) -> bool {
        self.axes.contains_key(&Axis::K)
    }
}
