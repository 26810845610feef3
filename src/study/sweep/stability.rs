//! When a machine counts as unstable.

use crate::control::cycle::StrokeKind;
use crate::control::sync::ErrorBand;
use crate::run::{Row, RowStage};

/// |e| beyond which a machine counts as unstable.
const LIMIT_UM: f64 = 1000.0;
/// How much of a stroke out is compared at its start and at its end.
const WINDOW_S: f64 = 0.010;
/// How much worse the end may be than the start.
const GROWTH: f64 = 10.0;

/// Watches e(k), measured and true: unstable is |e| over 1 mm, or the last 10 ms of a stroke out worse than its first
/// 10 ms by more than 10 times. Worse is a swing, peak to peak: what grows is an oscillation, and a standing offset none.
#[derive(Clone, Debug)]
pub(super) struct Stability {
    window: usize,
    /// Swing that the encoders' counts and interpolation make of a perfect motion: a first window better than that counts
    /// as that.
    resolution_um: f64,
    unstable: bool,
    /// Periods of the stroke out so far; 0 outside one.
    periods: usize,
    first: [ErrorBand; 2],
    /// The last window's e(k), measured and true, overwritten in turn.
    last_um: Vec<[f64; 2]>,
}

/// The greater swing of measured and true.
fn swing_um(bands: &[ErrorBand; 2]) -> f64 {
    bands.iter().map(ErrorBand::peak_to_peak).fold(0.0, f64::max)
}

impl Stability {
    pub(super) fn new(period_s: f64, resolution_um: f64) -> Self {
        let window = (WINDOW_S / period_s).round().max(1.0) as usize;
        Self {
            window,
            resolution_um,
            unstable: false,
            periods: 0,
            first: Default::default(),
            last_um: vec![[0.0; 2]; window],
        }
    }

    /// For the next machine.
    pub(super) fn reset(&mut self) {
        self.unstable = false;
        self.periods = 0;
    }

    pub(super) fn row(&mut self, row: &Row) {
        let both_um = [row.error_um, row.true_error_um].map(Option::unwrap_or_default);
        if row.stage == RowStage::Stroke(StrokeKind::Out) {
            self.out(both_um);
        } else {
            self.end_stroke();
        }
        self.unstable |= both_um.iter().any(|error_um| !(error_um.abs() <= LIMIT_UM));
    }

    fn out(&mut self, both_um: [f64; 2]) {
        if self.periods == 0 {
            self.first = Default::default();
        }
        if self.periods < self.window {
            add(&mut self.first, both_um);
        }
        if let Some(slot) = self.last_um.get_mut(self.periods % self.window) {
            *slot = both_um;
        }
        self.periods += 1;
    }

    fn end_stroke(&mut self) {
        if self.periods >= self.window {
            let mut last = Default::default();
            self.last_um.iter().for_each(|both_um| add(&mut last, *both_um));
            self.unstable |= swing_um(&last) > GROWTH * swing_um(&self.first).max(self.resolution_um);
        }
        self.periods = 0;
    }

    /// Whether anything so far was unstable; the stroke in force is taken to end here.
    pub(super) fn unstable(&mut self) -> bool {
        self.end_stroke();
        self.unstable
    }
}

fn add(bands: &mut [ErrorBand; 2], both_um: [f64; 2]) {
    bands.iter_mut().zip(both_um).for_each(|(band, error_um)| band.add(error_um));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::port::{Feedback, Setpoint};

    fn unstable(errors_um: impl IntoIterator<Item = (StrokeKind, f64)>) -> bool {
        let mut watch = Stability::new(0.001, 0.2);
        for (k, (kind, error_um)) in (0..).zip(errors_um) {
            watch.row(&Row {
                k,
                time_s: k as f64 * 0.001,
                hole: 1,
                stage: RowStage::Stroke(kind),
                phase: 0,
                setpoint: Setpoint::default(),
                feedback: Feedback::default(),
                bridged: false,
                truth: None,
                spindle_following_error_rev: 0.0,
                z_following_error_um: 0.0,
                correction_um: 0.0,
                slowed: 0.0,
                error_um: Some(error_um),
                true_error_um: Some(0.0),
            });
        }
        watch.unstable()
    }

    /// Every other period 0.
    fn swing(k: u32, peak_to_peak_um: f64) -> f64 {
        if k.is_multiple_of(2) { peak_to_peak_um } else { 0.0 }
    }

    fn out(error_um: impl Fn(u32) -> f64) -> bool {
        unstable((0..100).map(|k| (StrokeKind::Out, error_um(k))))
    }

    #[test]
    fn a_millimetre_is_unstable_wherever_it_is() {
        assert!(unstable([(StrokeKind::In, -1000.1)]) && !unstable([(StrokeKind::In, 1000.0)]));
        assert!(unstable([(StrokeKind::In, f64::NAN)]));
    }

    #[test]
    fn growth_over_the_stroke_out_is_unstable() {
        let late = |k: u32, end_um: f64| swing(k, if k >= 90 { -end_um } else { 2.0 });
        assert!(out(|k| late(k, 20.1)) && !out(|k| late(k, 20.0)));
        // Only the last 10 ms count, and only of a stroke out.
        assert!(!out(|k| swing(k, if (50..90).contains(&k) { 200.0 } else { 2.0 })));
        // An offset that stands is no growth, and hides none.
        assert!(!out(|k| late(k, 20.0) + if k >= 90 { 50.0 } else { 0.0 }));
        assert!(out(|k| late(k, 20.1) + 50.0));
        assert!(!unstable((0..100).map(|k| (StrokeKind::In, late(k, 200.0)))));
        // Each stroke by itself: pecks.
        let second = |k: u32| if k < 100 { (StrokeKind::In, 300.0) } else { (StrokeKind::Out, late(k - 100, 21.0)) };
        assert!(unstable((0..200).map(second)));
    }

    #[test]
    fn what_the_encoders_do_not_resolve_is_no_growth() {
        assert!(!out(|k| swing(k, if k < 90 { 0.0 } else { 1.9 })));
        assert!(out(|k| swing(k, if k < 90 { 0.0 } else { 2.1 })));
    }
}
