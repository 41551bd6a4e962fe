//! From a file's headers to the columns that are read.

use sistership_model::manifest::WindKind;
use sistership_model::trial::Channel;

use crate::findings::Findings;
use crate::mapping::Mapping;
use crate::names;
use crate::table::{Column, Target};
use crate::units::Kind;

/// How alike two names must be (Jaro-Winkler, 0 to 1) to be offered as a correction.
const ALIKE: f64 = 0.8;
/// Column names listed in a message.
const LISTED: usize = 40;

/// The columns to read, or nothing after errors.
pub(crate) fn resolve(
    headers: &[String],
    mapping: &Mapping,
    findings: &mut Findings,
) -> Option<Vec<Column>> {
    let mut resolver = Resolver { headers, mapping, columns: Vec::new(), findings };
    resolver.mapped();
    resolver.canonical();
    resolver.timed();
    resolver.doubled();
    resolver.needed();
    resolver.ignored();
    let Resolver { columns, findings, .. } = resolver;
    (!findings.has_errors()).then_some(columns)
}

struct Resolver<'a> {
    headers: &'a [String],
    mapping: &'a Mapping,
    columns: Vec<Column>,
    findings: &'a mut Findings,
}

impl Resolver<'_> {
    /// Columns that the manifest names.
    fn mapped(&mut self) {
        for (name, mapped) in &self.mapping.columns {
            let Some(target) = Target::by_name(name) else {
                let message =
                    format!("`{name}` is not a channel; channels are {}", channel_names());
                self.findings.error(None, Some(&mapped.column), message);
                continue;
            };
            match self.find(&mapped.column) {
                Ok(index) => {
                    self.contradicted(index, target, &mapped.unit);
                    self.add(index, target, &mapped.unit);
                }
                Err(message) => self.findings.error(Some(1), Some(&mapped.column), message),
            }
        }
    }

    /// A header that names one unit, where the manifest says another: one of the two is wrong.
    fn contradicted(&mut self, index: usize, target: Target, unit: &str) {
        let (kind, header) = (Kind::of(target), &self.headers[index]);
        if let Some(named) = kind.named_in(header)
            && let (Ok(one), Ok(other)) = (kind.factor(named), kind.factor(unit))
            && one != other
        {
            let message = format!(
                "the header says `{named}`, the manifest says `{}`; correct the one that is wrong",
                unit.trim()
            );
            let header = header.clone();
            self.findings.error(Some(1), Some(&header), message);
        }
    }

    fn find(&self, wanted: &str) -> Result<usize, String> {
        let mut found =
            self.headers.iter().enumerate().filter(|(_, header)| header.as_str() == wanted.trim());
        match (found.next(), found.next()) {
            (Some((index, _)), None) => Ok(index),
            (Some(_), Some(_)) => Err("this name heads two columns; rename one of them".into()),
            (None, _) => Err(format!(
                "no such column{}; the file has {}",
                self.suggestion(wanted),
                self.listed()
            )),
        }
    }

    fn suggestion(&self, wanted: &str) -> String {
        let close =
            self.headers.iter().map(|header| (strsim::jaro_winkler(header, wanted), header));
        match close.max_by(|a, b| a.0.total_cmp(&b.0)) {
            Some((alike, header)) if alike >= ALIKE => format!(", did you mean `{header}`?"),
            _ => String::new(),
        }
    }

    fn listed(&self) -> String {
        let names: Vec<String> =
            self.headers.iter().take(LISTED).map(|header| format!("`{header}`")).collect();
        let more = self.headers.len().saturating_sub(LISTED);
        if more > 0 { format!("{} and {more} more", names.join(", ")) } else { names.join(", ") }
    }

    fn add(&mut self, index: usize, target: Target, unit: &str) {
        let header = self.headers[index].clone();
        match Kind::of(target).factor(unit) {
            Ok(to_si) => self.columns.push(Column {
                index,
                header,
                target: self.redirect(target),
                unit: unit.trim().into(),
                to_si,
            }),
            Err(message) => {
                self.findings.error(None, Some(&header), format!("{}: {message}", target.name()))
            }
        }
    }

    /// Apparent wind goes to its own channels, so that nothing downstream can take it for the true one.
    fn redirect(&self, target: Target) -> Target {
        match (self.mapping.conventions.wind.kind, target) {
            (WindKind::Apparent, Target::Channel(Channel::WindSpeed)) => {
                Target::Channel(Channel::ApparentWindSpeed)
            }
            (WindKind::Apparent, Target::Channel(Channel::WindFrom)) => {
                Target::Channel(Channel::ApparentWindFrom)
            }
            _ => target,
        }
    }

    /// Columns that carry a canonical name, for channels that the manifest leaves open.
    fn canonical(&mut self) {
        let claimed: Vec<Target> =
            self.mapping.columns.iter().filter_map(|(name, _)| Target::by_name(name)).collect();
        for index in 0..self.headers.len() {
            let taken = self.columns.iter().any(|column| column.index == index);
            if let Some((target, unit)) = names::canonical(&self.headers[index]).filter(|_| !taken)
                && !claimed.contains(&target)
            {
                self.add(index, target, unit);
            }
        }
    }

    /// Where nothing else is time, the first column that has a common name of it.
    fn timed(&mut self) {
        let free = |index: usize| self.columns.iter().all(|column| column.index != index);
        let claimed = self.mapping.columns.iter().any(|(name, _)| name == "t");
        if !claimed && self.columns.iter().all(|column| column.target != Target::Time) {
            let named =
                (0..self.headers.len()).find(|&k| free(k) && names::is_time(&self.headers[k]));
            if let Some(index) = named {
                self.add(index, Target::Time, "auto");
            }
        }
    }

    fn doubled(&mut self) {
        for (position, column) in self.columns.iter().enumerate() {
            let before = &self.columns[..position];
            let message = if let Some(first) =
                before.iter().find(|first| first.target == column.target)
            {
                format!(
                    "`{}` and `{}` both give {}; keep one",
                    first.header,
                    column.header,
                    column.target.name()
                )
            } else if let Some(first) = before.iter().find(|first| first.index == column.index) {
                format!(
                    "is mapped to {} and to {}; a column holds one channel",
                    first.target.name(),
                    column.target.name()
                )
            } else {
                continue;
            };
            self.findings.error(Some(1), Some(&column.header), message);
        }
    }

    fn needed(&mut self) {
        if self.findings.has_errors() {
            return;
        }
        if !self.columns.iter().any(|column| column.target == Target::Time) {
            let message = format!(
                "no column for time{}; name it `t_s` or map `t`; the file has {}",
                self.suggestion("t_s"),
                self.listed()
            );
            self.findings.error(Some(1), None, message);
        } else if self.columns.len() == 1 {
            let message = format!(
                "no column for any channel; name them as {} or map them; the file has {}",
                canonical_names(),
                self.listed()
            );
            self.findings.error(Some(1), None, message);
        }
    }

    fn ignored(&mut self) {
        let used = |index: usize| self.columns.iter().any(|column| column.index == index);
        let ignored: Vec<&str> = self
            .headers
            .iter()
            .enumerate()
            .filter(|(index, _)| !used(*index))
            .map(|(_, header)| header.as_str())
            .collect();
        if !ignored.is_empty() {
            self.findings.warning(
                Some(1),
                None,
                format!("columns not read: {}", ignored.join(", ")),
            );
        }
    }
}

/// Every channel name of a manifest.
pub(crate) fn channel_names() -> String {
    std::iter::once("t").chain(Channel::all().map(Channel::name)).collect::<Vec<_>>().join(", ")
}

fn canonical_names() -> String {
    Channel::all().map(Channel::column).collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
#[path = "resolve_tests.rs"]
mod tests;
