//! One term of a grammar, and its form.

use std::collections::BTreeMap;

use indexmap::IndexMap;

use super::file::{EffectParameterFile, FormFile, GrammarFile, Mirror, PriorFile};
use super::names;
use crate::coefficient::Axis;
use crate::trial::Channel;
use sistership_formula::{self as formula, Expr};

/// Meaning of a factor of a coefficient's name.
#[derive(Debug, Clone, PartialEq)]
pub struct GrammarFactor {
    pub symbol: String,
    pub text: String,
    /// True if it changes its sign in the mirror.
    pub odd: bool,
    pub absolute: bool,
}

/// Factors of a term, of which the last may be an absolute value.
pub struct GrammarTerm<'a> {
    pub factors: Vec<&'a GrammarFactor>,
    pub bars: bool,
}

impl GrammarTerm<'_> {
    /// Returns true if its parity is that of the axis.
    pub fn fits_axis(&self, axis: Axis) -> bool {
        let odd = self.factors.iter().filter(|factor| factor.odd).count();
        // Bars make the last factor even.
        let in_bars = self.factors.last().filter(|factor| self.bars && factor.odd).map_or(0, |_| 1);
        ((odd - in_bars) % 2 == 1) == axis.is_odd()
    }

    /// Name of the term, like that of a coefficient. Formulas cannot contain bars, so that the
    /// parameter has another mark in their place.
    fn coefficient_name(&self, axis: Axis, bar: &str) -> String {
        let Some(last) = self.factors.len().checked_sub(1) else { return format!("{axis}_0") };
        let symbol = |(place, factor): (usize, &&GrammarFactor)| {
            if self.bars && place == last {
                format!("{bar}{}{bar}", factor.symbol)
            } else {
                factor.symbol.clone()
            }
        };
        format!("{axis}_{}", self.factors.iter().enumerate().map(symbol).collect::<String>())
    }

    fn product_formula(&self) -> String {
        let Some(last) = self.factors.len().checked_sub(1) else { return "1".into() };
        let one = |(place, factor): (usize, &&GrammarFactor)| {
            if self.bars && place == last {
                format!("abs({})", factor.text)
            } else {
                format!("({})", factor.text)
            }
        };
        self.factors.iter().enumerate().map(one).collect::<Vec<_>>().join("*")
    }

    /// Form of the term on an axis.
    pub fn to_form(&self, grammar: &GrammarFile, axis: Axis) -> FormFile {
        // A trailing mark is dropped from the name of the parameter.
        let (name, parameter) = (
            self.coefficient_name(axis, "|"),
            self.coefficient_name(axis, "_abs_").trim_end_matches("_abs_").to_owned(),
        );
        let force = format!("{parameter}*({})*{}", grammar.scales[&axis], self.product_formula());
        FormFile {
            meaning: format!("the term {name} of the hull's polynomial"),
            name,
            needs: required_channels(&force),
            unless: Vec::new(),
            only_without_roll: false,
            only_as_change: false,
            misfit: None,
            particulars: IndexMap::new(),
            parameters: IndexMap::from([(
                parameter,
                coefficient_parameter(grammar.deviations[&axis], self.fits_axis(axis)),
            )]),
            reports: IndexMap::new(),
            values: IndexMap::new(),
            sees: IndexMap::new(),
            accelerates: BTreeMap::new(),
            coefficients: IndexMap::new(),
            lags: IndexMap::new(),
            bands: IndexMap::new(),
            forces: BTreeMap::from([(axis, force)]),
            measures: BTreeMap::new(),
        }
    }
}

/// Channels that a formula uses and that trials may lack.
fn required_channels(formula: &str) -> Vec<Channel> {
    let parsed = formula::parse(formula);
    let mut needs: Vec<Channel> =
        parsed.iter().flat_map(Expr::mentioned_names).filter_map(names::required_channel).collect();
    needs.sort_unstable();
    needs
}

fn coefficient_parameter(deviation: f64, is_symmetric: bool) -> EffectParameterFile {
    EffectParameterFile {
        unit: "1".into(),
        meaning: "the coefficient".into(),
        prior: PriorFile { mean: 0.0, deviation },
        bounds: [-20.0 * deviation, 20.0 * deviation],
        absent: 0.0,
        start: None,
        shape: false,
        mirror: if is_symmetric { Mirror::Same } else { Mirror::Opposite },
    }
}
