//! Times of a change: windows of time, and the segments by which they are evaluated first.

use nalgebra::DMatrix;
use sistership_filtering::{FilterGains, LinearisedPart};

use super::super::outcome::ChangeCourse;
use super::super::thresholds::THRESHOLDS;

/// A window of time in which a change is present.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct ChangeWindow {
    pub course: ChangeCourse,
    /// Time at which it begins or ends, s of the trial; unused where it does neither.
    pub at_s: f64,
}

impl ChangeWindow {
    /// Returns true if the window begins or ends within the trial.
    pub fn is_timed(self) -> bool {
        matches!(self.course, ChangeCourse::Begins | ChangeCourse::Ends)
    }

    /// Share of the change that is present at a time of a trial of this span.
    pub fn share_at(self, t_s: f64, [begin_s, end_s]: [f64; 2]) -> f64 {
        match self.course {
            ChangeCourse::Throughout => 1.0,
            ChangeCourse::Begins => f64::from(u8::from(t_s >= self.at_s)),
            ChangeCourse::Ends => f64::from(u8::from(t_s < self.at_s)),
            ChangeCourse::Drifts => (t_s - begin_s) / (end_s - begin_s),
        }
    }
}

/// Segments of a trial, of equal length.
#[derive(Debug, Clone, Copy)]
pub(super) struct TrialSegments {
    pub span_s: [f64; 2],
    pub count: usize,
}

/// Number of courses that a change may have.
const COURSES: f64 = 4.0;

impl TrialSegments {
    /// Divides a trial from its first to its last sample; `length_s` is the time in which the ship
    /// covers its length. Each segment is a column for each of `parameters`.
    pub fn new(span_s: [f64; 2], length_s: f64, parameters: usize) -> Self {
        let limits = THRESHOLDS.changes;
        // About one segment per ship length, within limits of their number and of the columns.
        let wanted = ((span_s[1] - span_s[0]) / (limits.stretch * length_s)).round() as usize;
        let most = (limits.columns / parameters.max(1)).clamp(limits.fewest, limits.most);
        Self { span_s, count: wanted.clamp(limits.fewest, most) }
    }

    /// Length of a segment, s.
    pub fn width_s(self) -> f64 {
        (self.span_s[1] - self.span_s[0]) / self.count as f64
    }

    /// Segment of a time.
    pub fn segment_at(self, t_s: f64) -> usize {
        (((t_s - self.span_s[0]) / self.width_s()) as usize).min(self.count - 1)
    }

    /// Places of the first input of each segment but the first among those of the filter of a part.
    pub fn input_starts(self, part: &LinearisedPart) -> Vec<usize> {
        let mut starts = vec![usize::MAX; self.count - 1];
        let mut begun = 0;
        let mut begin = |t_s: f64, place: usize| {
            let segment = self.segment_at(t_s);
            if segment > begun {
                starts[begun..segment].fill(place);
                begun = segment;
            }
        };
        for (k, &t_s) in part.t_s.iter().enumerate() {
            begin(t_s, FilterGains::input_place(k, false));
            // Accelerations are means over an interval, so their time is that of its middle.
            if let Some(next_s) = part.t_s.get(k + 1) {
                begin(0.5 * (t_s + next_s), FilterGains::input_place(k, true));
            }
        }
        starts
    }

    /// All windows that begin and end at the limits of segments.
    pub fn all_windows(self) -> Vec<ChangeWindow> {
        let timed = |course| {
            let times = (1..self.count).map(|k| self.span_s[0] + self.width_s() * k as f64);
            times.map(move |at_s| ChangeWindow { course, at_s })
        };
        let whole = [ChangeCourse::Throughout, ChangeCourse::Drifts];
        timed(ChangeCourse::Begins)
            .chain(timed(ChangeCourse::Ends))
            .chain(whole.map(|course| ChangeWindow { course, at_s: self.span_s[0] }))
            .collect()
    }

    /// Windows of the same course at times between the neighbours of one.
    pub fn neighbouring_windows(self, window: ChangeWindow) -> Vec<ChangeWindow> {
        let half = THRESHOLDS.changes.finer;
        let at = |k: i32| ChangeWindow {
            at_s: window.at_s + f64::from(k) * self.refined_step_s(),
            ..window
        };
        (1 - half..half).map(at).collect()
    }

    /// Distance between refined times, s.
    pub fn refined_step_s(self) -> f64 {
        self.width_s() / f64::from(THRESHOLDS.changes.finer)
    }

    /// Logarithm of the prior probability of a window that begins or ends at the limits of
    /// segments: all courses are equally probable, and all times of a course.
    pub fn log_prior(self, window: ChangeWindow) -> f64 {
        let times = if window.is_timed() { self.count - 1 } else { 1 };
        -(COURSES * times as f64).ln()
    }

    /// Matrix from the size of each of `parameters` in a window to that in every segment: segments
    /// of the first parameter, then those of the next.
    pub fn window_matrix(self, window: ChangeWindow, parameters: usize) -> DMatrix<f64> {
        // A drift has the share of each segment's middle.
        let middle = |stretch: usize| self.span_s[0] + self.width_s() * (stretch as f64 + 0.5);
        DMatrix::from_fn(parameters * self.count, parameters, |row, column| {
            let share = window.share_at(middle(row % self.count), self.span_s);
            if row / self.count == column { share } else { 0.0 }
        })
    }
}

/// Central interval of a change's time, by times with the evidence of each and the duration that it
/// represents, s.
pub(super) fn central_interval(mut all: Vec<(f64, f64, f64)>) -> [f64; 2] {
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
    // The largest evidence is subtracted before the exponential, so that it cannot overflow.
    let most = all.iter().map(|one| one.1).fold(f64::NEG_INFINITY, f64::max);
    let mass = |one: &(f64, f64, f64)| (one.1 - most).exp() * one.2;
    let tail = THRESHOLDS.changes.tail * all.iter().map(mass).sum::<f64>();
    let reached = |order: &[(f64, f64, f64)]| {
        let mut sum = 0.0;
        let reached = order.iter().find(|one| {
            sum += mass(one);
            sum >= tail
        });
        // From the middle of a time's interval to its edge.
        reached.map_or((f64::NAN, 0.0), |one| (one.0, 0.5 * one.2))
    };
    let (first, before) = reached(&all);
    all.reverse();
    let (last, after) = reached(&all);
    [first - before, last + after]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stretches_follow_each_other_from_end_to_end() {
        let stretches = TrialSegments::new([100.0, 500.0], 20.0, 1);
        assert_eq!((stretches.count, stretches.width_s()), (20, 20.0));
        assert_eq!(TrialSegments::new([100.0, 500.0], 20.0, 10).count, THRESHOLDS.changes.fewest);
        let held = |t_s| stretches.segment_at(t_s);
        assert_eq!([held(100.0), held(121.0), held(500.0)], [0, 1, 19]);
    }

    #[test]
    fn windows_together_are_as_probable_as_a_change() {
        let stretches = TrialSegments::new([0.0, 100.0], 10.0, 1);
        let all =
            stretches.all_windows().into_iter().map(|window| stretches.log_prior(window).exp());
        assert!((all.sum::<f64>() - 1.0).abs() < 1e-12);
    }

    #[test]
    fn a_window_is_there_in_its_stretches() {
        let stretches = TrialSegments { span_s: [0.0, 40.0], count: 4 };
        let shares = |course, at_s| -> Vec<f64> {
            stretches.window_matrix(ChangeWindow { course, at_s }, 1).iter().copied().collect()
        };
        assert_eq!(shares(ChangeCourse::Begins, 30.0), [0.0, 0.0, 0.0, 1.0]);
        assert_eq!(shares(ChangeCourse::Ends, 30.0), [1.0, 1.0, 1.0, 0.0]);
        assert_eq!(shares(ChangeCourse::Throughout, 0.0), [1.0; 4]);
        assert_eq!(shares(ChangeCourse::Drifts, 0.0), [0.125, 0.375, 0.625, 0.875]);
        let two = TrialSegments { span_s: [0.0, 20.0], count: 2 };
        let spread =
            two.window_matrix(ChangeWindow { course: ChangeCourse::Begins, at_s: 10.0 }, 2);
        assert_eq!(spread, DMatrix::from_row_slice(4, 2, &[0., 0., 1., 0., 0., 0., 0., 1.]));
    }

    #[test]
    fn finer_times_stay_between_the_neighbours() {
        let stretches = TrialSegments { span_s: [0.0, 40.0], count: 4 };
        let near = stretches
            .neighbouring_windows(ChangeWindow { course: ChangeCourse::Begins, at_s: 20.0 });
        assert!(near.iter().all(|window| window.at_s > 10.0 && window.at_s < 30.0));
        assert!(near.iter().any(|window| window.at_s == 20.0));
    }

    #[test]
    fn an_interval_holds_the_middle_of_the_probability() {
        let at = |time: f64, evidence: f64| (time, evidence, 1.0);
        let all = vec![at(1.0, -50.0), at(3.0, 0.0), at(2.0, -1.0), at(4.0, -1.0), at(5.0, -50.0)];
        assert_eq!(central_interval(all), [1.5, 4.5]);
    }
}
