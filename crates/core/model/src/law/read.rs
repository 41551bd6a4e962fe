//! Reading of a law from its file, and its checks.

use std::collections::BTreeMap;

use indexmap::IndexMap;

use super::additions::LawAdditions;
use super::definition::{AxisLaw, Law, LawInput, LawParameter};
use super::dimension::{STATES, acceleration_dimension, axis_dimension};
use super::file::{AxisFile, InputFile, LawFile, ParameterFile, ParameterRole, TermFile};
use super::helm::order_dimension;
use super::submodel::read_submodels;
use super::typical::read_typical;
use super::{limits, symmetry};
use crate::coefficient::{Axis, CoefficientName};
use crate::error::{ErrorContext, FileError};
use crate::name::check_slug;
use crate::particulars;
use sistership_formula::units::{Dimension, Unit};
use sistership_formula::{self as formula, Expr};

impl Law {
    /// Reads and checks a law; `file` is its name in errors.
    ///
    /// # Errors
    /// Returns an error with file, line and field of the first fault: syntax, an unknown name, a
    /// unit, a symmetry.
    pub fn parse(file: &str, text: &str) -> Result<Self, FileError> {
        read_law(file, text)
    }
}

fn read_law(file: &str, text: &str) -> Result<Law, FileError> {
    let blame = ErrorContext::new(file, text);
    let raw: LawFile = blame.deserialize()?;
    check_slug(&raw.name).map_err(|e| blame.field_error("name", e))?;
    limits::check_counts(&raw).map_err(|(field, message)| blame.field_error(&field, message))?;
    let mut law = Law {
        name: raw.name,
        title: raw.title,
        sources: raw.sources,
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
        mirrors: raw.mirrors,
        dressing: LawAdditions::default(),
    };
    let reader = LawReader { blame: &blame };
    // Sections are read in the order of their dependence: a formula may use those before it.
    for (name, input) in &raw.inputs {
        law.inputs.insert(name.clone(), reader.read_input(name, input)?);
    }
    for (name, parameter) in &raw.parameters {
        law.parameters.insert(name.clone(), reader.read_parameter(name, parameter)?);
    }
    reader.read_values(&mut law, &raw.values)?;
    read_submodels(&mut law, &raw.submodels)
        .map_err(|(field, message)| blame.field_error(&field, message))?;
    for (symbol, formula) in &raw.factors {
        let expr = reader.read_formula(&law, &format!("factors.{symbol}"), formula, None)?;
        law.factors.insert(symbol.clone(), expr);
    }
    for (axis, raw_axis) in &raw.axes {
        let read = reader.read_axis(&law, *axis, raw_axis)?;
        law.axes.insert(*axis, read);
    }
    reader.read_terms(&mut law, &raw.axes)?;
    reader.read_mass(&mut law, &raw.mass)?;
    reader.read_kinematics(&mut law, &raw.kinematics)?;
    read_typical(&mut law, &raw.typical)
        .map_err(|(field, message)| blame.field_error(&field, message))?;
    limits::check_size(&law).map_err(|(field, message)| blame.field_error(&field, message))?;
    symmetry::check_law(&law).map_err(|(field, message)| blame.field_error(&field, message))?;
    Ok(law)
}

struct LawReader<'a> {
    blame: &'a ErrorContext<'a>,
}

impl LawReader<'_> {
    fn read_input(&self, name: &str, raw: &InputFile) -> Result<LawInput, FileError> {
        let refuse = |message: String| self.blame.field_error(&format!("inputs.{name}"), message);
        let dimension = Unit::parse(&raw.unit).map_err(|e| refuse(e.to_string()))?.dimension;
        let helm = raw.helm.as_deref().map(formula::parse).transpose();
        let helm = helm.map_err(|e| refuse(e.to_string()))?;
        if let Some(helm) = &helm {
            let found = formula::dimension_of(helm, &order_dimension);
            let found = found.map_err(|e| refuse(format!("`helm` {e}")))?;
            if found != dimension {
                return Err(refuse(format!("`helm` gives {found}, the input is {dimension}")));
            }
        }
        Ok(LawInput { dimension, default: raw.default, helm })
    }

    fn read_parameter(&self, name: &str, raw: &ParameterFile) -> Result<LawParameter, FileError> {
        let field = format!("parameters.{name}");
        let unit = Unit::parse(&raw.unit).map_err(|e| self.blame.field_error(&field, e))?;
        let from = raw
            .from
            .as_deref()
            .map(formula::parse)
            .transpose()
            .map_err(|e| self.blame.field_error(&field, e))?;
        if let Some(from) = &from {
            self.check_derivation(&field, from, unit.dimension)?;
        }
        if raw.prior.is_some_and(|prior| !prior.is_consistent()) {
            let message = "`prior` needs a positive `deviation` and a `value` within its `range`";
            return Err(self.blame.field_error(&field, message));
        }
        Ok(LawParameter {
            dimension: unit.dimension,
            unit: raw.unit.clone(),
            meaning: raw.meaning.clone(),
            from,
            is_approach_speed: raw.role == Some(ParameterRole::ApproachSpeed),
            prior: raw.prior,
        })
    }

    /// Checks that a derivation uses particulars only; a bare number takes the parameter's unit.
    fn check_derivation(
        &self,
        field: &str,
        from: &Expr,
        wanted: Dimension,
    ) -> Result<(), FileError> {
        if from.mentioned_names().is_empty() {
            return Ok(());
        }
        let found = formula::dimension_of(from, &particulars::particular_dimension)
            .map_err(|e| self.blame.field_error(field, e))?;
        if found == wanted {
            Ok(())
        } else {
            Err(self.blame.field_error(
                field,
                format!("`from` has the dimension {found}, but the parameter {wanted}"),
            ))
        }
    }

    fn read_values(&self, law: &mut Law, raw: &IndexMap<String, String>) -> Result<(), FileError> {
        for (name, formula) in raw {
            let field = format!("values.{name}");
            // A value must not have the name of another quantity.
            let taken =
                STATES.iter().any(|(state, _)| state == name) || law.name_dimension(name).is_some();
            if taken {
                return Err(self.blame.field_error(
                    &field,
                    "this name is already a state, input, parameter or particular",
                ));
            }
            let expr = self.read_formula(law, &field, formula, None)?;
            law.add_value(name.clone(), expr);
        }
        Ok(())
    }

    /// Parses a formula and checks its names and its dimension.
    fn read_formula(
        &self,
        law: &Law,
        field: &str,
        text: &str,
        wanted: Option<Dimension>,
    ) -> Result<Expr, FileError> {
        let expr = formula::parse(text).map_err(|e| self.blame.field_error(field, e))?;
        let found = formula::dimension_of(&expr, &|n| law.name_dimension(n))
            .map_err(|e| self.blame.field_error(field, format!("`{text}` {e}")))?;
        match wanted {
            // A literal zero fits every dimension.
            Some(wanted) if wanted != found && expr != Expr::Number(0.0) => {
                Err(self.blame.field_error(
                    field,
                    format!("`{text}` has the dimension {found}; {wanted} is needed"),
                ))
            }
            _ => Ok(expr),
        }
    }

    fn read_axis(&self, law: &Law, axis: Axis, raw: &AxisFile) -> Result<AxisLaw, FileError> {
        let path = format!("axes.{axis}");
        let scale = raw.scale.as_deref().unwrap_or("1");
        let rest = raw.rest.as_deref().unwrap_or("0");
        Ok(AxisLaw {
            scale: self.read_formula(law, &format!("{path}.scale"), scale, None)?,
            terms: IndexMap::new(),
            rest: self.read_formula(
                law,
                &format!("{path}.rest"),
                rest,
                Some(axis_dimension(axis)),
            )?,
            open: raw.open,
        })
    }

    fn read_terms(&self, law: &mut Law, raw: &BTreeMap<Axis, AxisFile>) -> Result<(), FileError> {
        for (axis, raw_axis) in raw {
            for term in &raw_axis.terms {
                let (name, expr) = self.read_term(law, *axis, term)?;
                let axis_law = law
                    .axes
                    .get_mut(axis)
                    .ok_or_else(|| self.blame.field_error("axes", "an axis is missing"))?;
                if axis_law.terms.insert(name.clone(), expr).is_some() {
                    return Err(self
                        .blame
                        .field_error(&format!("axes.{axis}.terms.{name}"), "is listed twice"));
                }
            }
        }
        Ok(())
    }

    fn read_term(
        &self,
        law: &Law,
        axis: Axis,
        raw: &TermFile,
    ) -> Result<(String, Expr), FileError> {
        let name = match raw {
            TermFile::Name(name) => name,
            TermFile::Formula(map) if map.len() == 1 => map.keys().next().unwrap_or(&law.name),
            TermFile::Formula(_) => {
                return Err(self.blame.field_error(
                    &format!("axes.{axis}.terms"),
                    "write one `{name: formula}` per entry",
                ));
            }
        };
        let field = format!("axes.{axis}.terms.{name}");
        let parsed = CoefficientName::parse(name, &law.extra_factors())
            .map_err(|e| self.blame.field_error(&field, e))?;
        if parsed.axis != axis {
            return Err(self.blame.field_error(
                &field,
                format!("acts on {} but is listed under {axis}", parsed.axis),
            ));
        }
        let expr = match raw {
            TermFile::Name(_) => {
                law.factor_product(&parsed).map_err(|e| self.blame.field_error(&field, e))?
            }
            TermFile::Formula(map) => self.read_formula(law, &field, &map[name], None)?,
        };
        Ok((name.clone(), expr))
    }

    fn read_mass(
        &self,
        law: &mut Law,
        raw: &BTreeMap<Axis, BTreeMap<Axis, String>>,
    ) -> Result<(), FileError> {
        for (row, columns) in raw {
            for (column, formula) in columns {
                let field = format!("mass.{row}.{column}");
                if !law.axes.contains_key(row) || !law.axes.contains_key(column) {
                    return Err(self.blame.field_error(&field, "the law has no such axis"));
                }
                // Dimension of an entry: force over acceleration.
                let wanted = axis_dimension(*row) - acceleration_dimension(*column);
                law.mass.insert(
                    (*row, *column),
                    self.read_formula(law, &field, formula, Some(wanted))?,
                );
            }
            // Without its diagonal entry the row cannot give an acceleration.
            if !columns.contains_key(row) {
                return Err(self
                    .blame
                    .field_error(&format!("mass.{row}"), "lacks its own acceleration"));
            }
        }
        match law.axes.keys().find(|axis| !raw.contains_key(axis)) {
            Some(axis) => Err(self.blame.field_error("mass", format!("has no row for {axis}"))),
            None => Ok(()),
        }
    }

    fn read_kinematics(
        &self,
        law: &mut Law,
        raw: &BTreeMap<String, String>,
    ) -> Result<(), FileError> {
        for (name, formula) in raw {
            let field = format!("kinematics.{name}");
            let wanted = match name.as_str() {
                "x" | "y" => Dimension::SPEED,
                "psi" | "phi" => Dimension::RATE,
                _ => {
                    return Err(self
                        .blame
                        .field_error(&field, "only x, y, psi and phi have a kinematic rate"));
                }
            };
            law.kinematics
                .insert(name.clone(), self.read_formula(law, &field, formula, Some(wanted))?);
        }
        Ok(())
    }
}
