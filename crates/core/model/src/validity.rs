//! Range of motion covered by a model's trials, and the distance of another motion from it.
//!
//! The region is the octagon of Miné 2006 (Higher-Order and Symbolic Computation 19, 31-100): the
//! hull of the samples, bounded along every channel and along every sum and difference of two, each
//! scaled to its own range. It is convex, contains the convex hull, and needs two numbers for each
//! of n^2 directions.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A convex region of some channels.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Region {
    /// Least and greatest value by channel (`u`, `v`, `r`, `delta`, `n`), SI and radians.
    pub ranges: BTreeMap<String, [f64; 2]>,
    /// Least and greatest sum and difference of two channels, each scaled to -1 at its least and 1
    /// at its greatest value: `v+r`, `v-r`.
    pub pairs: BTreeMap<String, [f64; 2]>,
    /// Least and greatest wind speed and depth that the trials recorded, by channel, SI; absent for
    /// channels that none recorded. Not part of the convex region.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub environment: BTreeMap<String, [f64; 2]>,
}

/// Excursion of a motion from a region.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Excursion {
    /// Time of the first sample outside, s.
    pub first_s: f64,
    /// Share of the samples outside.
    pub share: f64,
    /// The channel, or the pair of channels, along which it went furthest.
    pub along: String,
    /// Largest distance, in half ranges covered by the trials.
    pub beyond: f64,
}

impl Region {
    /// Returns the smallest region that contains samples, given by channel; `None` if there is no
    /// sample.
    pub fn from_samples(columns: &BTreeMap<String, Vec<f64>>) -> Option<Self> {
        let range = |values: &mut dyn Iterator<Item = f64>| {
            values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| {
                [low.min(x), high.max(x)]
            })
        };
        let ranges: BTreeMap<String, [f64; 2]> = columns
            .iter()
            .map(|(name, column)| (name.clone(), range(&mut column.iter().copied())))
            .collect();
        // Empty columns give infinite bounds.
        if ranges.is_empty() || ranges.values().flatten().any(|bound| !bound.is_finite()) {
            return None;
        }
        let scaled = |name: &String| {
            columns[name].iter().map(|x| scale_to_range(*x, ranges[name])).collect::<Vec<f64>>()
        };
        let of_pair = |(a, b): (&String, &String)| {
            let (first, second) = (scaled(a), scaled(b));
            let along =
                |sign: f64| range(&mut first.iter().zip(&second).map(|(x, y)| x + sign * y));
            [(format!("{a}+{b}"), along(1.0)), (format!("{a}-{b}"), along(-1.0))]
        };
        let pairs = name_pairs(&ranges).flat_map(of_pair).collect();
        Some(Self { ranges, pairs, environment: BTreeMap::new() })
    }

    /// Returns the distance of a point from the region, in half ranges, with its direction; `None`
    /// if it is inside. Channels that the point lacks do not count.
    pub fn distance_beyond(&self, value: &dyn Fn(&str) -> Option<f64>) -> Option<(String, f64)> {
        let resolved = ResolvedRegion::new(self);
        let (along, beyond) = resolved.furthest_direction(value, &mut Vec::new())?;
        Some((resolved.direction_name(along), beyond))
    }

    /// Returns the excursion of a motion; `None` if it stays inside. `value(k, name)` is a channel
    /// at sample `k`.
    pub fn find_excursion(
        &self,
        t_s: &[f64],
        value: &dyn Fn(usize, &str) -> Option<f64>,
    ) -> Option<Excursion> {
        let (resolved, mut room) = (ResolvedRegion::new(self), Vec::new());
        let mut furthest: Option<(f64, Direction, f64)> = None;
        let mut count = 0_usize;
        for (k, t) in t_s.iter().enumerate() {
            let found = resolved.furthest_direction(&|name| value(k, name), &mut room);
            let Some((along, beyond)) = found else { continue };
            count += 1;
            // The first sample outside fixes the time; later ones may increase the distance.
            let furthest = furthest.get_or_insert((*t, along, beyond));
            if beyond > furthest.2 {
                (furthest.1, furthest.2) = (along, beyond);
            }
        }
        let (first_s, along, beyond) = furthest?;
        let share = count as f64 / t_s.len() as f64;
        Some(Excursion { first_s, share, along: resolved.direction_name(along), beyond })
    }

    /// Bounded directions, for repeated evaluation.
    pub fn half_spaces(&self) -> Vec<HalfSpace<'_>> {
        let single = self.ranges.keys().map(|name| HalfSpace {
            terms: vec![self.half_space_term(name, 1.0)],
            bounds: [-1.0, 1.0],
        });
        let together = name_pairs(&self.ranges).flat_map(|(a, b)| {
            let of = |sign: char, factor: f64| {
                // A pair without bounds does not limit the region.
                let bounds = *self.pairs.get(&format!("{a}{sign}{b}"))?;
                Some(HalfSpace {
                    terms: vec![self.half_space_term(a, 1.0), self.half_space_term(b, factor)],
                    bounds,
                })
            };
            [of('+', 1.0), of('-', -1.0)].into_iter().flatten().collect::<Vec<_>>()
        });
        single.chain(together).collect()
    }

    fn half_space_term<'a>(&self, channel: &'a str, sign: f64) -> HalfSpaceTerm<'a> {
        let (centre, half) = centre_and_half(self.ranges[channel]);
        HalfSpaceTerm { channel, centre, factor: sign / half }
    }

    /// Checks that bounds are in order.
    ///
    /// # Errors
    /// Returns an error that names the channel.
    pub fn check_bounds(&self) -> Result<(), RangeError> {
        let wrong = |(_, [low, high]): &(&String, &[f64; 2])| {
            !(low.is_finite() && high.is_finite() && low <= high)
        };
        match self.ranges.iter().chain(&self.pairs).find(wrong) {
            Some((name, &[low, high])) => Err(RangeError { name: name.clone(), low, high }),
            None => Ok(()),
        }
    }
}

/// Region whose names are looked up once: a motion has thousands of samples.
struct ResolvedRegion<'a> {
    /// Name, middle of the range and half its width.
    channels: Vec<(&'a str, f64, f64)>,
    pairs: Vec<ResolvedPair>,
}

/// Two channels by their indices, and the bounds of their sum and of their difference.
struct ResolvedPair {
    places: [usize; 2],
    bounds: [Option<[f64; 2]>; 2],
}

/// Direction: a channel, or the sum or the difference of two, by their indices.
#[derive(Debug, Clone, Copy)]
enum Direction {
    One(usize),
    Two(usize, char, usize),
}

impl<'a> ResolvedRegion<'a> {
    fn new(region: &'a Region) -> Self {
        let channel = |(name, range): (&'a String, &[f64; 2])| {
            let (centre, half) = centre_and_half(*range);
            (name.as_str(), centre, half)
        };
        let channels: Vec<_> = region.ranges.iter().map(channel).collect();
        let pair = |(i, j): (usize, usize)| {
            let (a, b) = (channels[i].0, channels[j].0);
            let of = |sign: char| region.pairs.get(&format!("{a}{sign}{b}")).copied();
            ResolvedPair { places: [i, j], bounds: [of('+'), of('-')] }
        };
        let places = 0..channels.len();
        let two = places.clone().flat_map(|i| places.clone().skip(i + 1).map(move |j| (i, j)));
        let pairs = two.map(pair).collect();
        Self { channels, pairs }
    }

    /// Returns the largest distance of a point, with its direction; `scaled` is a workspace for its
    /// channels.
    fn furthest_direction(
        &self,
        value: &dyn Fn(&str) -> Option<f64>,
        scaled: &mut Vec<Option<f64>>,
    ) -> Option<(Direction, f64)> {
        let scale = |&(name, centre, half): &(&str, f64, f64)| Some((value(name)? - centre) / half);
        scaled.clear();
        scaled.extend(self.channels.iter().map(scale));
        let single = scaled.iter().enumerate();
        // A channel is scaled so that its range is [-1, 1].
        let single = single
            .filter_map(|(i, x)| Some((Direction::One(i), distance_outside((*x)?, [-1.0, 1.0]))));
        let together = self.pairs.iter().filter_map(|pair| {
            let ([i, j], [sum, difference]) = (pair.places, pair.bounds);
            let (x, y) = (scaled[i]?, scaled[j]?);
            let far =
                |at: f64, bounds: Option<[f64; 2]>| bounds.map_or(0.0, |b| distance_outside(at, b));
            let (sum, difference) = (far(x + y, sum), far(x - y, difference));
            Some(if sum >= difference {
                (Direction::Two(i, '+', j), sum)
            } else {
                (Direction::Two(i, '-', j), difference)
            })
        });
        // At equal distance a single channel is named rather than a pair.
        single.chain(together).filter(|(_, beyond)| *beyond > EXCURSION_TOLERANCE).fold(
            None,
            |furthest, one| match furthest {
                Some((_, beyond)) if one.1 <= beyond => furthest,
                _ => Some(one),
            },
        )
    }

    fn direction_name(&self, along: Direction) -> String {
        match along {
            Direction::One(i) => self.channels[i].0.to_owned(),
            Direction::Two(i, sign, j) => {
                format!("{}{sign}{}", self.channels[i].0, self.channels[j].0)
            }
        }
    }
}

/// Error of bounds that are not in order.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{name}: {low} to {high} is not a range")]
pub struct RangeError {
    /// Name of the channel or the pair.
    pub name: String,
    /// The lower bound.
    pub low: f64,
    /// The upper bound.
    pub high: f64,
}

/// Direction in which a region is bounded: a channel, or a sum or difference of two.
#[derive(Debug, Clone, PartialEq)]
pub struct HalfSpace<'a> {
    /// Terms of the sum, each scaled to its range.
    pub terms: Vec<HalfSpaceTerm<'a>>,
    /// Least and greatest sum inside.
    pub bounds: [f64; 2],
}

/// Scaled channel, `factor (value - centre)`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HalfSpaceTerm<'a> {
    /// The channel.
    pub channel: &'a str,
    /// Middle of its range.
    pub centre: f64,
    /// Inverse of half its range, with the sign.
    pub factor: f64,
}

impl Excursion {
    /// Description in words.
    pub fn describe(&self) -> String {
        let Self { first_s, share, along, beyond } = self;
        let percent = 100.0 * share;
        let distance = match *beyond {
            beyond if beyond > FAR_OUTSIDE => {
                format!("far outside, by more than {FAR_OUTSIDE:.0} times half the range")
            }
            beyond => format!("by at most {:.0} % of half the range", 100.0 * beyond),
        };
        format!(
            "outside the range covered by its trials from {first_s:.0} s on, {percent:.0} % of the \
             time; {distance}, in {along}"
        )
    }
}

/// Distance from which a percentage is replaced by words, in half ranges.
const FAR_OUTSIDE: f64 = 10.0;

/// Tolerance of an excursion, in half ranges: a hard turn at 35 deg where the rudder was recorded
/// at 34.9 is none.
pub const EXCURSION_TOLERANCE: f64 = 0.005;
/// Half range of a channel that did not vary, relative to its value: a speed that was constant
/// within a per cent.
const CONSTANT_HALF_RANGE: f64 = 0.01;

/// Scales a value to -1 at the low and 1 at the high end of a range.
fn scale_to_range(x: f64, range: [f64; 2]) -> f64 {
    let (centre, half) = centre_and_half(range);
    (x - centre) / half
}

/// Returns the middle of a range and half its width; 1 for a channel that was constantly zero.
fn centre_and_half([low, high]: [f64; 2]) -> (f64, f64) {
    let (centre, half) = (0.5 * (low + high), 0.5 * (high - low));
    let half = half.max(CONSTANT_HALF_RANGE * centre.abs());
    (centre, if half > 0.0 { half } else { 1.0 })
}

fn distance_outside(x: f64, [low, high]: [f64; 2]) -> f64 {
    (low - x).max(x - high).max(0.0)
}

/// Returns every pair of names.
fn name_pairs(ranges: &BTreeMap<String, [f64; 2]>) -> impl Iterator<Item = (&String, &String)> {
    ranges.keys().enumerate().flat_map(|(i, a)| ranges.keys().skip(i + 1).map(move |b| (a, b)))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn region() -> Region {
        // v and r along a line, u apart from both.
        let t = || (0..100).map(|k| 0.1 * f64::from(k));
        let columns = [
            ("u", t().map(|t| 5.0 + t.cos()).collect()),
            ("v", t().map(|t| 0.5 * (2.0 * t).sin()).collect()),
            ("r", t().map(|t| -0.01 * (2.0 * t).sin()).collect()),
        ];
        Region::from_samples(
            &columns.map(|(name, column): (_, Vec<f64>)| (name.to_owned(), column)).into(),
        )
        .unwrap()
    }

    fn beyond(u: f64, v: f64, r: f64) -> Option<(String, f64)> {
        region().distance_beyond(&|name| match name {
            "u" => Some(u),
            "v" => Some(v),
            "r" => Some(r),
            _ => None,
        })
    }

    #[test]
    fn what_was_seen_is_inside_and_so_is_what_lies_between() {
        assert_eq!(beyond(5.0, 0.0, 0.0), None);
        assert_eq!(beyond(5.5, 0.2, -0.004), None);
    }

    #[test]
    fn each_channel_may_be_seen_and_both_together_not() {
        let (along, far) = beyond(5.0, 0.4, 0.008).unwrap();
        assert_eq!(along, "r+v");
        assert!((far - 1.6).abs() < 0.1, "{far}");
    }

    #[test]
    fn what_is_hardly_outside_is_not() {
        assert_eq!(beyond(6.004, 0.0, 0.0), None);
        assert!(beyond(6.02, 0.0, 0.0).is_some());
    }

    #[test]
    fn a_faster_ship_is_outside_by_speed() {
        let (along, far) = beyond(8.0, 0.0, 0.0).unwrap();
        assert!(along == "u" && (far - 2.0).abs() < 0.1);
    }

    #[test]
    fn an_excursion_says_when_how_long_and_how_far() {
        let t_s: Vec<f64> = (0..10).map(f64::from).collect();
        let inside = region().find_excursion(&t_s, &|_, name| (name == "u").then_some(5.0));
        assert_eq!(inside, None);
        let out = region()
            .find_excursion(&t_s, &|k, name| {
                (name == "u").then_some(if k < 4 { 5.0 } else { 4.0 + k as f64 })
            })
            .unwrap();
        assert_eq!((out.first_s, out.share, out.along.as_str()), (4.0, 0.6, "u"));
        assert!(out.beyond > 5.0 && out.describe().contains("from 4 s on, 60 % of the time"));
        assert!(out.describe().contains(" % of half the range, in u"));
        let far = Excursion { beyond: 201.76, ..out };
        assert!(far.describe().contains("far outside, by more than 10 times half the range"));
    }

    #[test]
    fn faces_say_the_same_as_the_region() {
        let region = region();
        for (u, v, r) in [(5.0, 0.4, 0.008), (8.0, 0.0, 0.0), (3.0, -0.9, 0.002)] {
            let value = |name: &str| match name {
                "u" => u,
                "v" => v,
                _ => r,
            };
            let one = |face: HalfSpace<'_>| {
                let term = |t: &HalfSpaceTerm<'_>| t.factor * (value(t.channel) - t.centre);
                let sum: f64 = face.terms.iter().map(term).sum();
                distance_outside(sum, face.bounds)
            };
            let furthest = region.half_spaces().into_iter().map(one).fold(0.0, f64::max);
            let (_, beyond) = region.distance_beyond(&|name| Some(value(name))).unwrap();
            assert!((furthest - beyond).abs() < 1e-12, "{furthest} {beyond}");
        }
    }

    #[test]
    fn a_constant_channel_has_a_range_of_a_per_cent() {
        let region = Region::from_samples(&[("n".to_owned(), vec![2.0; 5])].into()).unwrap();
        assert_eq!(region.distance_beyond(&|_| Some(2.01)), None);
        assert!(region.distance_beyond(&|_| Some(2.1)).is_some());
        assert_eq!(Region::from_samples(&BTreeMap::new()), None);
    }
}
