//! Names of coefficients: `Axis_factors`, with one spelling for each.
//!
//! Factors are in the order u, v, r, phi, p, delta, n, then those that a law adds; a factor to a
//! power is repeated, an absolute value is written `|v|` and follows the plain factor: `X_uu`,
//! `Y_vvr`, `N_v|v|`, `X_udeltadelta`, `Y_0`. The deviation of a coefficient under a submodel's
//! conditions is named after it: `X_uu@astern`.

use std::fmt;

use serde::{Deserialize, Serialize};

/// An axis of the equations of motion.
#[derive(
    Debug,
    Clone,
    Copy,
    PartialEq,
    Eq,
    PartialOrd,
    Ord,
    Hash,
    Serialize,
    Deserialize,
    schemars::JsonSchema,
)]
pub enum Axis {
    /// Surge force.
    X,
    /// Sway force.
    Y,
    /// Roll moment.
    K,
    /// Yaw moment.
    N,
}

impl Axis {
    /// Every axis, in the order in which mass matrices list them.
    pub const ALL: [Self; 4] = [Self::X, Self::Y, Self::K, Self::N];

    /// Velocity that the axis accelerates.
    pub fn velocity_name(self) -> &'static str {
        match self {
            Self::X => "u",
            Self::Y => "v",
            Self::K => "p",
            Self::N => "r",
        }
    }

    /// Returns true if the force changes sign when the ship is mirrored port to starboard.
    pub fn is_odd(self) -> bool {
        self != Self::X
    }
}

impl fmt::Display for Axis {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(out, "{self:?}")
    }
}

/// Factors of every law, in order.
pub const STANDARD_FACTORS: [&str; 7] = ["u", "v", "r", "phi", "p", "delta", "n"];

/// One factor of a name.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct NameFactor {
    /// Index in the law's order of factors.
    rank: usize,
    /// True for an absolute value, `|x|`.
    pub absolute: bool,
    /// Its symbol.
    pub symbol: String,
}

/// Name of a coefficient, parsed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CoefficientName {
    /// The axis on which it acts.
    pub axis: Axis,
    /// Factors that multiply it, in canonical order; empty for a constant such as `Y_0`.
    pub factors: Vec<NameFactor>,
    /// Submodel under whose conditions it is added to the coefficient of the same factors, if any.
    pub submodel: Option<String>,
}

/// Reason for which a name is not one of a coefficient.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum NameError {
    /// The name is too long.
    #[error("`{head}...`: a name of {length} characters; the limit is {most}", most = MAX_NAME)]
    Long {
        /// The beginning of the name.
        head: String,
        /// Its length, bytes.
        length: usize,
    },
    /// The name has no underscore.
    #[error("`{0}`: {help}", help = HELP)]
    Form(String),
    /// The axis is unknown.
    #[error("`{0}`: the axis must be X, Y, K or N; {help}", help = HELP)]
    Axis(String),
    /// The factors cannot be read.
    #[error("`{name}`: {fault}; {help}", help = HELP)]
    Factors {
        /// The name.
        name: String,
        /// Description of the error.
        fault: FactorsError,
    },
    /// The factors are in another order.
    #[error("`{name}` is spelled `{canonical}` here")]
    Spelling {
        /// The name.
        name: String,
        /// The canonical spelling.
        canonical: CoefficientName,
    },
}

const HELP: &str = "a coefficient is written Axis_factors, such as X_uu, Y_vvr, N_v|v| or Y_0";

/// Reason for which the end of a name is not a product of factors.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum FactorsError {
    /// An unknown factor.
    #[error("no factor starts at `{0}`")]
    Unknown(String),
    /// A bar is not closed.
    #[error("`|{0}` lacks its closing bar")]
    OpenBar(String),
    /// There are too many factors.
    #[error("it has more than {most} factors", most = MAX_FACTORS)]
    Many,
    /// There are no factors.
    #[error("it has no factors")]
    None,
}

/// Most bytes of a name.
pub const MAX_NAME: usize = 512;

/// Most factors of one name.
pub const MAX_FACTORS: usize = 16;

/// Splits a name into its shared part and its submodel: `X_uu@astern` into `X_uu` and `astern`.
pub fn split_submodel(name: &str) -> (&str, Option<&str>) {
    name.split_once('@').map_or((name, None), |(shared, submodel)| (shared, Some(submodel)))
}

impl CoefficientName {
    /// Parses a name; `extra` are the factors that the law adds to the standard ones, in order.
    ///
    /// # Errors
    /// Returns an error with the reason and, if known, the canonical spelling of the name.
    pub fn parse(name: &str, extra: &[&str]) -> Result<Self, NameError> {
        // The message quotes only the beginning of a long name.
        if name.len() > MAX_NAME {
            return Err(NameError::Long {
                head: sistership_formula::text_head(name),
                length: name.len(),
            });
        }
        let (shared, submodel) = split_submodel(name);
        let (axis, rest) =
            shared.split_once('_').ok_or_else(|| NameError::Form(name.to_owned()))?;
        let axis = Axis::ALL.into_iter().find(|a| a.to_string() == axis);
        let axis = axis.ok_or_else(|| NameError::Axis(name.to_owned()))?;
        let wrong = |fault| NameError::Factors { name: name.to_owned(), fault };
        // `0` means no factors, as in `Y_0`.
        let mut factors =
            if rest == "0" { Vec::new() } else { parse_factors(rest, extra).map_err(wrong)? };
        let as_written = factors.clone();
        // Comparison with the sorted factors accepts one spelling only, so that equal terms have
        // equal names.
        factors.sort();
        let canonical = Self { axis, factors, submodel: submodel.map(str::to_owned) };
        if canonical.factors != as_written {
            return Err(NameError::Spelling { name: name.to_owned(), canonical });
        }
        Ok(canonical)
    }

    /// Returns true if the term changes sign with the symbol.
    pub fn is_odd_in(&self, symbol: &str) -> bool {
        self.factors.iter().filter(|f| !f.absolute && f.symbol == symbol).count() % 2 == 1
    }
}

impl fmt::Display for CoefficientName {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(out, "{}_", self.axis)?;
        if self.factors.is_empty() {
            out.write_str("0")?;
        }
        self.factors.iter().try_for_each(|f| {
            if f.absolute { write!(out, "|{}|", f.symbol) } else { out.write_str(&f.symbol) }
        })?;
        self.submodel.as_ref().map_or(Ok(()), |submodel| write!(out, "@{submodel}"))
    }
}

fn parse_factors(mut rest: &str, extra: &[&str]) -> Result<Vec<NameFactor>, FactorsError> {
    let mut factors = Vec::new();
    while !rest.is_empty() {
        let absolute = rest.starts_with('|');
        let inner = rest.strip_prefix('|').unwrap_or(rest);
        let (rank, symbol) =
            longest_symbol(inner, extra).ok_or_else(|| FactorsError::Unknown(rest.to_owned()))?;
        rest = &inner[symbol.len()..];
        if absolute {
            rest =
                rest.strip_prefix('|').ok_or_else(|| FactorsError::OpenBar(symbol.to_owned()))?;
        }
        factors.push(NameFactor { rank, absolute, symbol: symbol.to_owned() });
        if factors.len() > MAX_FACTORS {
            return Err(FactorsError::Many);
        }
    }
    if factors.is_empty() { Err(FactorsError::None) } else { Ok(factors) }
}

/// Returns the longest known symbol that `text` starts with, so that `phi` is not read as `p`.
fn longest_symbol<'a>(text: &str, extra: &[&'a str]) -> Option<(usize, &'a str)>
where
    'static: 'a,
{
    let known = STANDARD_FACTORS.iter().copied().chain(extra.iter().copied()).enumerate();
    known.filter(|(_, symbol)| text.starts_with(symbol)).max_by_key(|(_, symbol)| symbol.len())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn canonical(name: &str) -> Result<String, String> {
        CoefficientName::parse(name, &["T", "beta", "c", "zeta"])
            .map(|n| n.to_string())
            .map_err(|e| e.to_string())
    }

    #[test]
    fn canonical_names_read_back() {
        for name in [
            "X_uu",
            "Y_vvr",
            "N_v|v|",
            "X_udeltadelta",
            "Y_0",
            "K_vphiphi",
            "N_p",
            "Y_deltac|c|",
            "N_T",
            "Y_urzeta",
            "Y_v|v|@astern",
            "X_0@astern",
        ] {
            assert_eq!(canonical(name).as_deref(), Ok(name));
        }
    }

    #[test]
    fn another_spelling_is_refused_with_the_right_one() {
        assert!(canonical("Y_vu").unwrap_err().contains("`Y_uv`"));
        assert!(canonical("Y_vu@astern").unwrap_err().contains("`Y_uv@astern`"));
        assert!(canonical("Y_|v|v").unwrap_err().contains("`Y_v|v|`"));
        assert!(canonical("X_deltau").unwrap_err().contains("`X_udelta`"));
        assert!(canonical("Q_u").unwrap_err().contains("axis"));
        assert!(canonical("Xu").unwrap_err().contains("Axis_factors"));
        assert!(canonical("X_uw").unwrap_err().contains("`w`"));
        assert!(canonical("X_|u").unwrap_err().contains("bar"));
    }

    #[test]
    fn parity_counts_plain_factors_only() {
        let name = CoefficientName::parse("Y_v|v|delta", &[]).unwrap();
        assert!(name.is_odd_in("v") && name.is_odd_in("delta") && !name.is_odd_in("r"));
    }
}
