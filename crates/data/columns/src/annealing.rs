//! Search by simulated annealing, for recordings whose headers leave columns open: single changes
//! end in local optima there.

use crate::hypothesis::{Assignment, Hypothesis};
use crate::search::{AssignmentSearch, COUPLED};

/// Number of runs, and of changes that each tries.
const RUNS: u64 = 4;
const STEPS: usize = 20_000;
/// First and last temperature, in log odds.
const HOT: f64 = 4.0;
const COLD: f64 = 0.5;
/// Part of the log odds of a column alone by which its hypotheses are proposed.
const GUIDED: f64 = 0.5;

/// Returns the best assignment of each run, improved by single changes, with its log odds.
pub(crate) fn anneal_assignments(
    search: &AssignmentSearch,
    start: &Assignment,
) -> Vec<(Assignment, f64)> {
    let proposals = ProposalTable::new(search);
    let run = |seed: u64| search.improve_assignment(anneal_once(search, &proposals, start, seed));
    (1..=RUNS).map(run).collect()
}

fn anneal_once(
    search: &AssignmentSearch,
    proposals: &ProposalTable,
    start: &Assignment,
    seed: u64,
) -> Assignment {
    let mut random = SplitMix(seed);
    let (mut now, mut odds) = (start.clone(), search.assignment_odds(start));
    let (mut best, mut most) = (now.clone(), odds);
    for step in 0..STEPS {
        let temperature = HOT * (COLD / HOT).powf(step as f64 / STEPS as f64);
        let Some(other) = proposals.propose_change(search, &now, &mut random) else { continue };
        let found = search.assignment_odds(&other);
        if found >= odds || random.next_part() < ((found - odds) / temperature).exp() {
            (now, odds) = (other, found);
        }
        if odds > most {
            (best, most) = (now.clone(), odds);
        }
    }
    best
}

/// Hypotheses of each column with their cumulative weights; `None` for a column that is not read.
struct ProposalTable {
    columns: Vec<Vec<(Option<Hypothesis>, f64)>>,
}

impl ProposalTable {
    fn new(search: &AssignmentSearch) -> Self {
        let of_column = |at: usize| {
            let own = &search.own[at];
            let mut sum = 0.0;
            let each = search.hypotheses[at].iter().copied().map(Some).chain([None]);
            let weighted = each.map(|what| {
                let odds = what.map_or(0.0, |what| own.hypothesis_odds(&what));
                sum += (GUIDED * odds).exp();
                (what, sum)
            });
            weighted.collect()
        };
        Self { columns: (0..search.own.len()).map(of_column).collect() }
    }

    /// Returns a change of one column, an exchange of two, or another pair of coupled quantities.
    fn propose_change(
        &self,
        search: &AssignmentSearch,
        of: &Assignment,
        random: &mut SplitMix,
    ) -> Option<Assignment> {
        let (i, j) = (random.next_below(self.columns.len()), random.next_below(self.columns.len()));
        let kind = random.next_below(10);
        if kind < 6 || i == j {
            return (search.time != Some(i)).then(|| of.with_column(i, self.draw(i, random)));
        }
        let roles = match (kind < 8, of.columns[i], of.columns[j]) {
            (true, Some(a), Some(b)) => (b.role, a.role),
            _ => COUPLED[random.next_below(COUPLED.len())],
        };
        let mut pick = |column: usize, role| {
            let all: Vec<Hypothesis> = search.hypotheses_for(column, role).collect();
            (!all.is_empty()).then(|| all[random.next_below(all.len())])
        };
        let (a, b) = (pick(i, roles.0)?, pick(j, roles.1)?);
        Some(of.with_column(i, Some(a)).with_column(j, Some(b)))
    }

    fn draw(&self, column: usize, random: &mut SplitMix) -> Option<Hypothesis> {
        let all = &self.columns[column];
        let sum = all.last().map_or(0.0, |last| last.1);
        let drawn = random.next_part() * sum;
        all.iter().find(|one| one.1 >= drawn).and_then(|one| one.0)
    }
}

/// Random numbers by SplitMix64 (Steele, Lea and Flood, 2014), the same at every call.
struct SplitMix(u64);

impl SplitMix {
    fn next_number(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut mixed = self.0;
        mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ (mixed >> 31)
    }

    /// Returns a number from 0 to 1, 1 excluded.
    fn next_part(&mut self) -> f64 {
        // The upper 53 bits are the digits of a double.
        (self.next_number() >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn next_below(&mut self, count: usize) -> usize {
        (self.next_part() * count as f64) as usize
    }
}
