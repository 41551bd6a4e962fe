//! Reading of a form from a file, or from a model that has the effect, and its checks.

use indexmap::IndexMap;

use super::file::{ActsOn, EffectParameterFile, FormFile};
use super::form::{EffectForm, EffectParameter, ReportedFigure};
use super::scope::{FieldFault, FormScope};
use super::{names, symmetry};
use crate::coefficient::Axis;
use crate::law::limits::{FormulaDepths, check_count};
use crate::law::{acceleration_dimension, axis_dimension};
use crate::particulars;
use crate::trial::Channel;
use sistership_formula::Expr;
use sistership_formula::units::{Dimension, Unit};

/// Endings of reported names: dimension of the formula, and the factor that converts its value from
/// SI and radians.
const REPORT_ENDINGS: [(&str, Dimension, f64); 8] = [
    ("_deg_s", Dimension::RATE, 180.0 / std::f64::consts::PI),
    ("_deg", Dimension::NONE, 180.0 / std::f64::consts::PI),
    ("_percent", Dimension::NONE, 100.0),
    ("_m_s", Dimension::SPEED, 1.0),
    ("_n_m", Dimension::MOMENT, 1.0),
    ("_n", Dimension::FORCE, 1.0),
    ("_m", Dimension::LENGTH, 1.0),
    ("_s", Dimension::TIME, 1.0),
];

impl EffectForm {
    /// Reads and checks a form.
    ///
    /// # Errors
    /// Returns the dotted field at fault below the form, and the reason: syntax, an unknown name, a
    /// unit, a channel missing in `needs`, a symmetry, or an effect that does not vanish at its
    /// absence.
    pub fn from_file(acts_on: ActsOn, file: &FormFile) -> Result<Self, (String, String)> {
        check_actions(acts_on, file)?;
        check_counts(file)?;
        // Order matters: values may use parameters, all other sections both.
        let mut scope = FormScope::new(acts_on == ActsOn::Measurement);
        let parameters = read_parameters(&mut scope, file)?;
        let values = scope.read_values(&file.values)?;
        let form = Self {
            particulars: scope.read_section(
                "particulars",
                &file.particulars,
                &|name| particular_dimension(name),
                true,
            )?,
            reports: read_reports(&scope, file)?,
            sees: scope.read_section(
                "sees",
                &file.sees,
                &|name| replaced_dimension(name),
                false,
            )?,
            accelerates: scope.read_section(
                "accelerates",
                &file.accelerates,
                &|axis| Ok(acceleration_dimension(*axis)),
                false,
            )?,
            coefficients: scope.read_section(
                "coefficients",
                &file.coefficients,
                &|name| factor_dimension(name),
                false,
            )?,
            lags: scope.read_section("lags", &file.lags, &|name| lag_dimension(name), false)?,
            bands: scope.read_section("bands", &file.bands, &|name| band_dimension(name), false)?,
            forces: scope.read_section(
                "forces",
                &file.forces,
                &|axis| Ok(axis_dimension(*axis)),
                false,
            )?,
            measures: scope.read_section(
                "measures",
                &file.measures,
                &|channel| Ok(Channel::dimension(*channel)),
                false,
            )?,
            file: file.clone(),
            parameters,
            values,
        };
        scope.check_needs(&file.needs)?;
        form.check_size()?;
        symmetry::check_form(&form)?;
        Ok(form)
    }
}

/// Largest number of parameters, values, particulars, reports, and entries of each way of acting.
const MAX_NAMES: usize = 100;

/// Largest depth of operators from a formula of a form down through its values.
const MAX_DEPTH: usize = 128;

/// Largest number of numbers, names and operators of all formulas of a form.
const MAX_SIZE: usize = 5000;

fn check_counts(file: &FormFile) -> Result<(), FieldFault> {
    let sections = [
        ("parameters", file.parameters.len()),
        ("values", file.values.len()),
        ("particulars", file.particulars.len()),
    ];
    let acting = [
        ("sees", file.sees.len()),
        ("coefficients", file.coefficients.len()),
        ("lags", file.lags.len()),
        ("bands", file.bands.len()),
    ];
    let all = sections.into_iter().chain(acting).chain([("reports", file.reports.len())]);
    all.into_iter().try_for_each(|(section, count)| check_count(section, count, MAX_NAMES))
}

impl EffectForm {
    /// Refuses formulas that are too many, or too deep through the values that they mention.
    fn check_size(&self) -> Result<(), FieldFault> {
        let depths = FormulaDepths::new(&self.values);
        let reports = self.reports.values().map(|report| &report.formula);
        let all = || self.acting_formulas().chain(self.particulars.values()).chain(reports.clone());
        let size = all().map(Expr::node_count).sum();
        check_count("", size, MAX_SIZE).map_err(|(_, e)| {
            (String::new(), format!("numbers, names and operators of all formulas: {e}"))
        })?;
        all().try_for_each(|expr| depths.check("values", expr, MAX_DEPTH))
    }
}

/// Checks that each way of acting belongs to the part on which the effect acts; an effect on the
/// flow about the hull may be given as the forces that it adds.
fn check_actions(acts_on: ActsOn, file: &FormFile) -> Result<(), FieldFault> {
    let counts = [
        ("sees", ActsOn::Inflow, file.sees.len()),
        ("accelerates", ActsOn::Inflow, file.accelerates.len()),
        ("coefficients", ActsOn::Inflow, file.coefficients.len()),
        ("lags", ActsOn::Inflow, file.lags.len()),
        ("bands", ActsOn::Inflow, file.bands.len()),
        ("forces", ActsOn::Force, file.forces.len()),
        ("measures", ActsOn::Measurement, file.measures.len()),
    ];
    let may = |of: ActsOn| of == acts_on || (acts_on, of) == (ActsOn::Inflow, ActsOn::Force);
    let stray = counts.iter().find(|(_, of, count)| !may(*of) && *count > 0);
    if let Some((section, of, _)) = stray {
        return Err((
            (*section).into(),
            format!("belongs to effects that act on {}", section_names(*of)),
        ));
    }
    if counts.iter().all(|(.., count)| *count == 0) {
        return Err((
            String::new(),
            format!(
                "has no formulas; an effect that acts on {} needs some",
                section_names(acts_on)
            ),
        ));
    }
    if file.parameters.is_empty() {
        Err(("parameters".into(), "give at least one".into()))
    } else {
        Ok(())
    }
}

fn section_names(acts_on: ActsOn) -> &'static str {
    match acts_on {
        ActsOn::Force => "`force` (`forces`)",
        ActsOn::Inflow => "`inflow` (`sees`, `accelerates`, `coefficients`, `lags`, `bands`)",
        ActsOn::Measurement => "`measurement` (`measures`)",
    }
}

fn read_parameters(
    scope: &mut FormScope,
    file: &FormFile,
) -> Result<IndexMap<String, EffectParameter>, FieldFault> {
    let mut parameters = IndexMap::new();
    for (name, raw) in &file.parameters {
        let field = format!("parameters.{name}");
        let read = read_parameter(raw).map_err(|e| (field.clone(), e))?;
        scope.add_parameter(&field, name, read.dimension)?;
        parameters.insert(name.clone(), read);
    }
    Ok(parameters)
}

fn read_parameter(raw: &EffectParameterFile) -> Result<EffectParameter, String> {
    let unit = Unit::parse(&raw.unit).map_err(|e| e.to_string())?;
    if unit.to_si != 1.0 {
        return Err(format!(
            "effects use SI units and radians; `{}` is not one of these",
            raw.unit
        ));
    }
    // By default a search starts at the absence of the effect.
    let start = raw.start.unwrap_or(raw.absent);
    let [low, high] = raw.bounds;
    if !(low.is_finite() && high.is_finite() && low < high) {
        return Err(format!("bounds [{low}, {high}] must be finite and in order"));
    }
    for (what, value) in
        [("absent", raw.absent), ("start", start), ("the mean of the prior", raw.prior.mean)]
    {
        if !(low..=high).contains(&value) {
            return Err(format!("{what}, {value}, is outside the bounds [{low}, {high}]"));
        }
    }
    let prior_deviation = raw.prior.deviation;
    if !(prior_deviation.is_finite() && prior_deviation > 0.0) {
        return Err(format!(
            "the deviation of the prior must be finite and above zero, not {prior_deviation}"
        ));
    }
    Ok(EffectParameter {
        dimension: unit.dimension,
        prior_mean: raw.prior.mean,
        prior_deviation,
        bounds: raw.bounds,
        absent: raw.absent,
        start,
        shape: raw.shape,
        mirror: raw.mirror,
    })
}

fn read_reports(
    scope: &FormScope,
    file: &FormFile,
) -> Result<IndexMap<String, ReportedFigure>, FieldFault> {
    let mut reports = IndexMap::new();
    for (name, formula) in &file.reports {
        let field = format!("reports.{name}");
        let ending = REPORT_ENDINGS.iter().find(|(ending, ..)| name.ends_with(ending));
        let formula =
            scope.read_constant(&field, formula, ending.map(|(_, dimension, _)| *dimension))?;
        reports.insert(
            name.clone(),
            ReportedFigure { formula, factor: ending.map_or(1.0, |(.., factor)| *factor) },
        );
    }
    Ok(reports)
}

fn particular_dimension(name: &str) -> Result<Dimension, String> {
    particulars::particular_dimension(name).ok_or_else(|| "unknown particular".into())
}

fn replaced_dimension(name: &str) -> Result<Dimension, String> {
    names::replaceable_dimension(name).ok_or_else(|| {
        "a law has the inputs u, v, r, p, phi, psi and channels such as delta, n and depth".into()
    })
}

fn lag_dimension(name: &str) -> Result<Dimension, String> {
    names::input_dimension(name)
        .map(|_| Dimension::TIME)
        .ok_or_else(|| "only an input such as delta or n can lag".into())
}

fn band_dimension(name: &str) -> Result<Dimension, String> {
    names::input_dimension(name)
        .ok_or_else(|| "only an input such as delta or n can have a dead band".into())
}

fn factor_dimension(name: &str) -> Result<Dimension, String> {
    let axis = name.split_once('_').map(|(axis, _)| axis);
    let known = Axis::ALL.iter().any(|known| axis == Some(known.to_string().as_str()));
    if known {
        Ok(Dimension::NONE)
    } else {
        Err("a coefficient is written Axis_factors, such as Y_v or N_vvr".into())
    }
}
