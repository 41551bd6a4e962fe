//! Evidence of a header: the quantities, unit, side and sign that its words name.

use crate::role::{QuantityKind, Role, Side};
use crate::vocabulary::{Phrase, PhraseMeaning, vocabulary};
use crate::words::{is_ideographic, split_words};

/// Log odds of a quantity whose phrase explains every word of a header: 400 to 1.
const EXACT: f64 = 6.0;
/// Log odds of a phrase of one letter, which is ambiguous.
const LETTER: f64 = 3.5;
/// Log odds lost with each word that a phrase does not explain.
const UNEXPLAINED: f64 = 2.0;

/// Quantities, units, side and sign named by a header.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct HeaderEvidence {
    /// Quantities and their log odds, best first.
    pub candidates: Vec<(PhraseMeaning, f64)>,
    /// Units written in the header or below it, by their names in manifests.
    pub units: Vec<String>,
    pub side: Option<Side>,
    pub is_port_positive: bool,
}

impl HeaderEvidence {
    /// Reads a header and the cell of a row of units below it.
    pub(crate) fn new(header: &str, below: Option<&str>) -> Self {
        let own = Self::from_text(header, below);
        // Fields of structures have their path before the name, which the whole text may hide.
        match last_field(header).map(|field| Self::from_text(field, below)) {
            Some(field) if field.best_odds() > own.best_odds() => field,
            _ => own,
        }
    }

    fn from_text(header: &str, below: Option<&str>) -> Self {
        let parts = HeaderParts::new(header);
        let mut units = parts.units.clone();
        units.extend(below.and_then(unit_named));
        let mut evidence = Self {
            candidates: Vec::new(),
            is_port_positive: is_port_positive(header),
            side: parts.find_side(),
            units,
        };
        for phrase in &vocabulary().phrases {
            if let Some(odds) = parts.phrase_odds(phrase) {
                evidence.add_candidate(&phrase.meaning, odds);
            }
        }
        // Six candidates suffice: the search takes them up by log odds.
        evidence.candidates.sort_by(|a, b| b.1.total_cmp(&a.1));
        evidence.candidates.truncate(6);
        evidence
    }

    fn add_candidate(&mut self, meaning: &PhraseMeaning, odds: f64) {
        // `rudder port` names the port rudder: a side in the header makes the quantity that of the
        // side.
        let meaning = match meaning {
            PhraseMeaning::Channel(role) => {
                let role = self.rate_by_unit(*role);
                PhraseMeaning::Channel(self.side.map_or(role, |side| role.for_side(side)))
            }
            PhraseMeaning::Other(_) => meaning.clone(),
        };
        match self.candidates.iter_mut().find(|(known, _)| *known == meaning) {
            Some((_, most)) => *most = most.max(odds),
            None => self.candidates.push((meaning, odds)),
        }
    }

    /// Returns the rate of a quantity where the written unit is one of its rate: `Yaw` in deg/s.
    fn rate_by_unit(&self, role: Role) -> Role {
        let rate = match role {
            Role::Psi => Role::R,
            Role::Phi => Role::P,
            Role::X => Role::VNorth,
            Role::Y => Role::VEast,
            _ => return role,
        };
        let is_written = |kind: QuantityKind| self.unit_of_kind(kind).is_some();
        if is_written(rate.kind()) && !is_written(role.kind()) { rate } else { role }
    }

    /// Returns the log odds of a channel against a column that holds no channel.
    pub(crate) fn role_odds(&self, role: Role) -> Option<f64> {
        let of_role =
            |(meaning, _): &&(PhraseMeaning, f64)| *meaning == PhraseMeaning::Channel(role);
        self.candidates.iter().find(of_role).map(|(_, odds)| *odds)
    }

    /// Returns the quantity named by the header that no channel holds, and its log odds.
    pub(crate) fn other_quantity(&self) -> Option<(&str, f64)> {
        self.candidates.iter().find_map(|(meaning, odds)| match meaning {
            PhraseMeaning::Other(name) => Some((name.as_str(), *odds)),
            PhraseMeaning::Channel(_) => None,
        })
    }

    /// Returns the highest log odds of all candidates, 0 if there is none.
    pub(crate) fn best_odds(&self) -> f64 {
        self.candidates.first().map_or(0.0, |(_, odds)| *odds)
    }

    /// Returns the first written unit that measures the given kind of quantity.
    pub(crate) fn unit_of_kind(&self, kind: QuantityKind) -> Option<&str> {
        let fits = |unit: &&String| unit_is(kind, unit);
        self.units.iter().find(fits).map(String::as_str)
    }
}

/// Returns the last field of a path such as `data.nav.u`.
fn last_field(header: &str) -> Option<&str> {
    let is_path = !header.contains([' ', '[', '(', '/']);
    let (_, field) = header.rsplit_once('.').filter(|_| is_path)?;
    field.starts_with(char::is_alphabetic).then_some(field)
}

fn unit_is(kind: QuantityKind, unit: &str) -> bool {
    kind.percent_unit().iter().chain(kind.known_units()).any(|known| known.name == unit)
}

/// Returns the unit that a text denotes, by its name in manifests.
pub(crate) fn unit_named(text: &str) -> Option<String> {
    let inner = text.trim().trim_matches(['[', ']', '(', ')', '{', '}']).trim().to_lowercase();
    let inner: String = inner.split_whitespace().collect::<Vec<_>>().join(" ");
    let spelled = vocabulary().units.iter().find(|(spelling, _)| *spelling == inner);
    spelled.map(|(_, unit)| unit.clone())
}

fn is_port_positive(header: &str) -> bool {
    let small = header.to_lowercase();
    vocabulary().port_positive.iter().any(|phrase| small.contains(phrase.as_str()))
}

/// Words, units and letters of a header.
struct HeaderParts {
    /// Words outside units, without the words that state a sign.
    words: Vec<String>,
    /// All words, joined without a separator.
    joined: String,
    /// The letter of a header of one letter, in its original case.
    letter: Option<char>,
    /// Units in brackets or at the end.
    units: Vec<String>,
    /// Units formed by the last words, each with the number of words that it takes.
    ending: Vec<(String, usize)>,
}

impl HeaderParts {
    fn new(header: &str) -> Self {
        let (name, units) = split_units(header);
        let all = split_words(&name);
        let ending = ending_units(&all);
        let mut letters = name.trim().chars();
        let letter = letters.next().filter(|_| letters.next().is_none());
        let mut units = units;
        // The last words state the unit: `rpm_rps` is a column named after another unit.
        units.extend(ending.iter().map(|(unit, _)| unit.clone()));
        let long = all.iter().rev().filter(|word| word.len() > 1);
        units.extend(long.filter_map(|word| unit_named(word)));
        // Words that only state a sign (`port positive`) name no side of the ship, and are removed.
        let sign = vocabulary().port_positive.iter().any(|text| name.to_lowercase().contains(text));
        let kept = |word: &String| !(sign && is_sign_word(word));
        let all: Vec<String> = all.into_iter().filter(kept).collect();
        Self { joined: all.concat(), words: all, letter, units, ending }
    }

    fn find_side(&self) -> Option<Side> {
        let several = self.words.len() > 1;
        let of_word = |word: &String| {
            let sides = vocabulary().sides.iter();
            let long = |text: &str| text.chars().count() > 1 || is_ideographic(text);
            let same = |text: &str| word == text && (several || long(text));
            sides.clone().find(|(text, _)| same(text)).map(|(_, side)| *side)
        };
        let written = || {
            let within = |text: &str| is_ideographic(text) && self.joined.contains(text);
            vocabulary().sides.iter().find(|(text, _)| within(text)).map(|(_, side)| *side)
        };
        // The last word names the side more often than the first (`rudder port`); then the first,
        // then ideographic text within the header, then a letter at the end of a known stem.
        self.words
            .iter()
            .skip(usize::from(several))
            .rev()
            .find_map(of_word)
            .or_else(|| self.words.first().and_then(of_word))
            .or_else(written)
            .or_else(|| self.side_suffix().map(|(_, side)| side))
    }

    /// Returns the stem and the side of a single word that ends in the letter of a side, such as
    /// `deltal`.
    fn side_suffix(&self) -> Option<(&str, Side)> {
        let [word] = self.words.as_slice() else { return None };
        let sides =
            [('l', Side::Port), ('p', Side::Port), ('r', Side::Starboard), ('s', Side::Starboard)];
        sides.into_iter().find_map(|(letter, side)| {
            let stem = word.strip_suffix(letter).filter(|stem| stem.len() > 2)?;
            let known = ["delta", "rudder", "rpm", "rud", "prop", "azi", "shaft"].contains(&stem);
            known.then_some((stem, side))
        })
    }

    /// Returns the log odds of a phrase; `None` if the header does not contain it.
    fn phrase_odds(&self, phrase: &Phrase) -> Option<f64> {
        if phrase.joined.chars().count() == 1 && !is_ideographic(&phrase.joined) {
            return self.letter_odds(phrase);
        }
        if is_ideographic(&phrase.joined) {
            return self.ideographic_odds(&phrase.joined);
        }
        let stem = self.side_suffix().map(|(stem, _)| stem);
        if self.joined == phrase.joined || stem == Some(phrase.joined.as_str()) {
            return Some(EXACT);
        }
        let holds =
            phrase.words.iter().all(|word| self.words.iter().any(|one| is_same_word(one, word)));
        holds.then(|| self.partial_odds(phrase)).filter(|odds| *odds > 0.0)
    }

    fn partial_odds(&self, phrase: &Phrase) -> f64 {
        let open = self.unexplained_words(phrase);
        // A word of a quantity that is not read (ordered, error, force) makes the whole header one.
        let weight = match &phrase.meaning {
            PhraseMeaning::Other(name) if name != "count or mark" => 1.0,
            _ => UNEXPLAINED,
        };
        // Of phrases that explain equally many words, the longer one is more specific.
        EXACT - weight * open as f64 + 0.3 * (phrase.words.len() as f64 - 1.0)
    }

    /// Counts the words explained by neither the phrase, nor a unit, nor a side, nor the list of
    /// common words.
    fn unexplained_words(&self, phrase: &Phrase) -> usize {
        let kind = match phrase.meaning {
            PhraseMeaning::Channel(role) => role.kind(),
            PhraseMeaning::Other(_) => QuantityKind::Any,
        };
        let fits = |unit: &str| kind == QuantityKind::Any || unit_is(kind, unit);
        let ends = self.ending.iter().filter(|(unit, _)| fits(unit)).map(|(_, count)| *count);
        // The words of a fitting unit at the end need no other explanation.
        let kept = self.words.len() - ends.max().unwrap_or(0);
        let words = vocabulary();
        let common = |word: &String| {
            words.passed_over.contains(word)
                || words.sides.iter().any(|(side, _)| side == word)
                || word.chars().all(|letter| letter.is_ascii_digit())
                || unit_named(word).is_some_and(|unit| fits(&unit))
        };
        let open = |word: &&String| {
            !phrase.words.iter().any(|one| is_same_word(word, one)) && !common(word)
        };
        self.words[..kept].iter().filter(open).count()
    }

    fn letter_odds(&self, phrase: &Phrase) -> Option<f64> {
        // `N` is north, `n` revolutions; a capital in the vocabulary means the capital alone.
        let first = self.words.first()?;
        if *first != phrase.joined {
            return None;
        }
        let rest = self.unexplained_words(phrase);
        let capital = self.letter.is_some_and(char::is_uppercase);
        let is_place = matches!(phrase.meaning, PhraseMeaning::Channel(Role::X | Role::Y));
        let odds = match (is_place && matches!(phrase.joined.as_str(), "n" | "e"), capital) {
            (true, false) => return None,
            (true, true) => LETTER + 1.0,
            _ => LETTER,
        };
        (rest == 0).then_some(odds)
    }

    /// Scripts without spaces are compared by substring; characters that remain are unexplained.
    fn ideographic_odds(&self, phrase: &str) -> Option<f64> {
        let mut rest = self.joined.clone();
        if !rest.contains(phrase) {
            return None;
        }
        rest = rest.replacen(phrase, "", 1);
        let words = vocabulary();
        let sides = words.sides.iter().map(|(side, _)| side);
        for common in words.passed_over.iter().chain(sides).filter(|word| is_ideographic(word)) {
            rest = rest.replace(common.as_str(), "");
        }
        let open = rest.chars().filter(|letter| is_ideographic(&letter.to_string())).count();
        let odds = EXACT - UNEXPLAINED * open as f64 + 0.3 * (phrase.chars().count() as f64 - 1.0);
        Some(odds).filter(|odds| *odds > 0.0)
    }
}

/// Returns true if two words are equal, apart from digits at the end of the written one.
fn is_same_word(written: &str, known: &str) -> bool {
    let stem = written.trim_end_matches(|letter: char| letter.is_ascii_digit());
    written == known || (stem.len() > 1 && stem == known)
}

fn is_sign_word(word: &str) -> bool {
    vocabulary()
        .port_positive
        .iter()
        .any(|phrase| split_words(phrase).iter().any(|one| one == word))
}

/// Returns the header without the units in brackets or after a separator, and these units.
fn split_units(header: &str) -> (String, Vec<String>) {
    let (mut name, mut units, mut rest) = (String::new(), Vec::new(), header);
    while let Some(open) = rest.find(['[', '(', '{', '（', '［']) {
        let inner = &rest[open..];
        // Brackets may be full-width characters of several bytes, so that lengths come from the
        // text.
        let first = inner.chars().next().map_or(1, char::len_utf8);
        let close = inner.find([']', ')', '}', '）', '］']).unwrap_or(inner.len());
        let text = &inner[first.min(close)..close];
        name.push_str(&rest[..open]);
        // A bracket may state the unit and the sign: `(m/s; + to stbd)`.
        let parts =
            if unit_named(text).is_some() { vec![text] } else { text.split([',', ';']).collect() };
        for part in parts {
            match unit_named(part) {
                Some(unit) => units.push(unit),
                None => name.extend([" ", part, " "]),
            }
        }
        let after = inner[close..].chars().next().map_or(0, char::len_utf8);
        rest = &inner[close + after..];
    }
    name.push_str(rest);
    // A unit may follow a blank or punctuation, or a slash: `speed, kn` and `speed/kn`.
    let ends: [&[char]; 2] = [&[' ', ',', ';', ':'], &['/']];
    for end in ends {
        if units.is_empty()
            && let Some(at) = name.trim_end().rfind(end).filter(|at| *at > 0)
            && let Some(unit) = unit_named(&name[at + 1..]).filter(|_| is_clear(&name[at + 1..]))
        {
            units.push(unit);
            name.truncate(at);
        }
    }
    (name, units)
}

/// Returns true if a unit at the end of a header cannot be the letter of a side or an axis.
fn is_clear(unit: &str) -> bool {
    let unit = unit.trim();
    // `%` and `°` are signs, no letters.
    unit.chars().count() > 1 || is_ideographic(unit) || !unit.chars().any(char::is_alphabetic)
}

/// Returns the units formed by the last one or two words, such as `deg`, `deg_s`, `m_s`, with the
/// number of words of each.
fn ending_units(words: &[String]) -> Vec<(String, usize)> {
    let counts = (1..=2).filter(|count| *count < words.len());
    counts
        .flat_map(|count| {
            let last = &words[words.len() - count..];
            ["/", "_", " "].into_iter().filter_map(move |between| {
                unit_named(&last.join(between)).map(|unit| (unit, count))
            })
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn best(header: &str) -> Option<&'static str> {
        match HeaderEvidence::new(header, None).candidates.first() {
            Some((PhraseMeaning::Channel(role), _)) => Some(role.name()),
            _ => None,
        }
    }

    #[test]
    fn headers_in_nine_languages_are_recognised() {
        for (header, wanted) in [
            ("Rudder Angle [deg]", "delta"),
            ("RUDDER_PORT (deg)", "delta_p"),
            ("deltal", "delta_p"),
            ("GPS Latitude", "latitude"),
            ("Speed over ground", "speed"),
            ("Relative wind speed", "apparent_wind_speed"),
            ("True Wind Direction", "wind_from"),
            ("Yaw rate", "r"),
            ("YawRate_deg_s", "r"),
            ("u [m/s]", "u"),
            ("Date/Time", "t"),
            ("Shaft RPM starboard", "n_s"),
            ("u_velo [m/s]", "u"),
            ("vm_velo [m/s]", "v"),
            ("r_angvelo [rad/s]", "r"),
            ("n_prop [rps]", "n"),
            ("wind_dir_relative_mid [rad]", "apparent_wind_from"),
            ("wind_velo_true [m/s]", "wind_speed"),
            ("Rudder (port positive)", "delta"),
            ("Sway speed [kn]", "v"),
            ("Shaft [rpm]", "n"),
            ("original_timestamp", "t"),
            ("N", "x"),
            ("n", "n"),
            ("STW (kn)", "u_water"),
            ("Drehgeschwindigkeit (°/s)", "r"),
            ("Fahrt über Grund [kn]", "speed"),
            ("Krängung", "phi"),
            ("Rorvinkel [grader]", "delta"),
            ("Svingehastighet", "r"),
            ("Vitesse de lacet (deg/s)", "r"),
            ("Angle de barre", "delta"),
            ("Ángulo de timón [grados]", "delta"),
            ("Giri elica", "n"),
            ("舵角", "delta"),
            ("船首方位 [度]", "psi"),
            ("左舷プロペラ回転数", "n_p"),
            ("선수각", "psi"),
            ("대지속도 (kn)", "speed"),
            ("转首角速度", "r"),
            ("对水航速", "u_water"),
        ] {
            assert_eq!(best(header), Some(wanted), "{header}");
        }
    }

    #[test]
    fn quantities_that_no_channel_holds_are_not_taken_for_one() {
        for header in [
            "Rudder order",
            "engine u load",
            "",
            "[deg]",
            "yaw_acc",
            "right_force",
            "thr_left",
            "surge_dot_bias",
            "Ruderlage Soll",
            "Pitch angle",
            "thr_left_pwm_zero_point",
        ] {
            assert_eq!(best(header), None, "{header}");
        }
    }

    #[test]
    fn units_of_rates_paths_and_signs_change_what_a_name_means() {
        for (header, wanted) in [
            ("Yaw [deg/s]", "r"),
            ("Yaw [deg]", "psi"),
            ("Roll (deg/s)", "p"),
            ("North [m/s]", "v_north"),
            ("data.nav.u", "u"),
            ("data.act.rudder_deg", "delta"),
            ("Velocity u", "u"),
            ("Speed thr. water (knots)", "u_water"),
            ("Rudder angle (deg, +ve to port)", "delta"),
            ("Sway (m/s; + to stbd)", "v"),
        ] {
            assert_eq!(best(header), Some(wanted), "{header}");
        }
        let other = HeaderEvidence::new("rpm_rps", None);
        assert_eq!(other.unit_of_kind(QuantityKind::Revolutions), Some("rps"));
        let below = HeaderEvidence::new("Yaw", Some("deg/s"));
        assert_eq!(below.candidates[0].0, PhraseMeaning::Channel(Role::R));
        let rudder = HeaderEvidence::new("Rudder angle (deg, +ve to port)", None);
        assert!(rudder.is_port_positive && rudder.side.is_none());
        assert_eq!(rudder.unit_of_kind(QuantityKind::Angle), Some("deg"));
    }

    #[test]
    fn units_sides_and_signs_are_read() {
        let of = |header: &str| HeaderEvidence::new(header, None);
        assert_eq!(of("Sway speed [kn]").unit_of_kind(QuantityKind::Speed), Some("kn"));
        assert_eq!(of("yaw_rate_deg_s").unit_of_kind(QuantityKind::Rate), Some("deg/s"));
        assert_eq!(of("rpm_port").unit_of_kind(QuantityKind::Revolutions), Some("rpm"));
        assert_eq!(of("Drehzahl 1/min").unit_of_kind(QuantityKind::Revolutions), Some("rpm"));
        assert_eq!(of("rpm_port").side, Some(Side::Port));
        let percent = of("rudder port %");
        assert_eq!(percent.unit_of_kind(QuantityKind::Angle), Some("%"));
        assert_eq!(percent.side, Some(Side::Port));
        assert!(of("Rudder (port positive)").is_port_positive);
        assert_eq!(
            HeaderEvidence::new("speed", Some("knots")).unit_of_kind(QuantityKind::Speed),
            Some("kn")
        );
    }
}
