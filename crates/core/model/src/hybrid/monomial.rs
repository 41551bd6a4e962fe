//! Monomials and the Taylor expansion: Miyauchi 2024, Eqs. 7 to 11.

use std::collections::BTreeSet;

use super::actuators::ExpansionVariable;
use crate::coefficient::Axis;

/// Product of powers of the expansion's variables, which are given by their indices.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Default)]
pub struct Monomial {
    /// Indices and powers above zero, ordered by index.
    pub powers: Vec<(usize, u32)>,
    /// Indices whose square is written `x|x|`.
    pub moduli: BTreeSet<usize>,
}

/// Returns every monomial up to a degree, ordered by degree, then by the order of the variables.
pub fn expand_monomials(variables: usize, order: u32) -> Vec<Monomial> {
    let mut all = vec![Monomial::default()];
    let mut last = vec![Vec::new()];
    for _ in 0..order {
        // All lists of factors of the next degree.
        last = last
            .iter()
            .flat_map(|factors: &Vec<usize>| append_factor(factors, variables))
            .collect();
        all.extend(last.iter().map(|factors| Monomial::from_factors(factors)));
    }
    all
}

/// Returns the products with one more factor, which is not before the last one.
fn append_factor(factors: &[usize], variables: usize) -> Vec<Vec<usize>> {
    let from = factors.last().copied().unwrap_or(0);
    (from..variables).map(|next| factors.iter().copied().chain([next]).collect()).collect()
}

impl Monomial {
    fn from_factors(factors: &[usize]) -> Self {
        // Factors are sorted, so that equal ones are adjacent.
        let mut powers: Vec<(usize, u32)> = Vec::new();
        for &place in factors {
            match powers.last_mut() {
                Some((last, power)) if *last == place => *power += 1,
                _ => powers.push((place, 1)),
            }
        }
        Self { powers, moduli: BTreeSet::new() }
    }

    /// Sum of the powers.
    pub fn degree(&self) -> u32 {
        self.powers.iter().map(|(_, power)| power).sum()
    }

    /// Indices with a power of two.
    pub fn squared_variables(&self) -> impl Iterator<Item = usize> + '_ {
        self.powers.iter().filter(|(_, power)| *power == 2).map(|&(place, _)| place)
    }

    /// Returns true if it changes sign in the mirror; `x|x|` does if `x` does.
    pub fn is_odd(&self, variables: &[ExpansionVariable]) -> bool {
        let odd = self.powers.iter().filter(|(place, _)| variables[*place].odd);
        // A modulus takes one sign away from the power of its variable.
        let signs =
            odd.filter(|(place, power)| (power - u32::from(self.moduli.contains(place))) % 2 == 1);
        signs.count() % 2 == 1
    }

    /// Returns the monomial with the sides of every pair exchanged.
    pub fn with_sides_exchanged(&self, variables: &[ExpansionVariable]) -> Self {
        let twin = |place: usize| {
            variables.iter().position(|v| v.symbol == variables[place].twin).unwrap_or(place)
        };
        let mut powers: Vec<(usize, u32)> =
            self.powers.iter().map(|&(place, power)| (twin(place), power)).collect();
        powers.sort_unstable();
        Self { powers, moduli: self.moduli.iter().map(|&place| twin(place)).collect() }
    }

    /// Name of its coefficient on an axis, such as `Y_v|v|`.
    pub fn coefficient_name(&self, axis: Axis, variables: &[ExpansionVariable]) -> String {
        let factors: Vec<String> = self
            .powers
            .iter()
            .map(|&(place, power)| self.spell_factor(place, power, variables))
            .collect();
        format!("{axis}_{}", if factors.is_empty() { "0".to_owned() } else { factors.concat() })
    }

    fn spell_factor(&self, place: usize, power: u32, variables: &[ExpansionVariable]) -> String {
        let symbol = &variables[place].symbol;
        if self.moduli.contains(&place) {
            format!("{symbol}|{symbol}|")
        } else {
            symbol.repeat(power as usize)
        }
    }

    /// Formula, in terms of the names of the variables in formulas.
    pub fn to_formula(&self, called: &dyn Fn(usize) -> String) -> String {
        let factor = |&(place, power): &(usize, u32)| match (called(place), power) {
            (name, 2) if self.moduli.contains(&place) => format!("{name}*abs({name})"),
            (name, 1) => name,
            (name, power) => format!("{name}^{power}"),
        };
        let factors: Vec<String> = self.powers.iter().map(factor).collect();
        if factors.is_empty() { "1".to_owned() } else { factors.join("*") }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_expansion_has_every_product_once() {
        let binomial =
            |n: usize, k: usize| (0..k).fold(1, |product, i| product * (n - i) / (i + 1));
        for (variables, order) in [(8, 2), (8, 3), (6, 3), (3, 4)] {
            let all = expand_monomials(variables, order);
            let distinct: BTreeSet<&Monomial> = all.iter().collect();
            assert_eq!(
                (all.len(), distinct.len()),
                (binomial(variables + order as usize, order as usize), all.len())
            );
            assert!(all.iter().all(|monomial| monomial.degree() <= order));
        }
    }
}
