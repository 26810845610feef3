//! The in-position check: spindle and Z at rest before a hole's zero is latched, and before Z is released after it.

use crate::control::machine::{Machine, Takes};
use crate::control::math::filter_share;

use super::frame::{PositionError, Scale};
use super::supervision::alarm::{Alarm, SETTLE_TIMEOUT_S};

/// When spindle and Z are in position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Window {
    spindle_rev: f64,
    z_mm: f64,
    /// The same where Z is too deep, until [`DEEP_TIMEOUT_S`]; twice that once both are in position, so that noise does not
    /// end it.
    z_deep_mm: f64,
    /// Both have to stay in position this long.
    hold_s: f64,
}

/// Before the zero is latched. What creeps afterwards is error of the hole, so the window is a few percent of a tolerance.
pub(super) const START: Window = Window { spindle_rev: 0.001, z_mm: 0.002, z_deep_mm: 0.002, hold_s: 0.01 };
/// The same where the hole is tapped with a start offset: what is too deep there is too deep at the bottom.
pub(super) const START_WITH_OFFSET: Window = Window { z_deep_mm: 0.0003, ..START };
/// Before Z is released: the tap has left the thread, and the spindle must not turn on with it.
pub(super) const END: Window = Window { spindle_rev: 0.01, z_mm: 0.05, z_deep_mm: 0.05, hold_s: 0.0 };
/// Least width of a window in counts: a resting axis may stand between two.
const LEAST_COUNTS: f64 = 1.0;
/// Nothing holds the angle of a spindle whose drive takes a speed alone, and the hole counts from where it stands: it rests where
/// it stays within so much for so long.
const STAYS_REV: f64 = 0.002;
const STAYS_S: f64 = 0.02;
/// Timeout of the tighter window below R. Z creeps up into it; with stick-slip it may never be met.
const DEEP_TIMEOUT_S: f64 = 0.1;
/// Time constant over which Z's position error becomes the start offset.
const OFFSET_S: f64 = 0.003;
/// Decay of the start offset during the hole: what each hole leaves would add up.
const OFFSET_DECAY_S: f64 = 2.0;

/// Checks for in position, and keeps the start offset.
///
/// Friction may hold Z a little off R. Under model-based compensation the hole is tapped from there: Z's command moves to
/// where Z stands, by the start offset, and comes back to the plan too slowly to be an error of the hole.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct InPosition {
    period_s: f64,
    least_rev: f64,
    /// Where the spindle was when it was last seen to turn; none where its angle is held.
    stays_at_rev: Option<f64>,
    count_mm: f64,
    waiting_since_s: Option<f64>,
    in_position_since_s: Option<f64>,
    start_offset_mm: f64,
}

impl InPosition {
    pub(super) fn new(machine: &Machine) -> Self {
        let scale = Scale::of(machine);
        Self {
            period_s: machine.spec().control.period_s,
            least_rev: LEAST_COUNTS / scale.counts_per_rev,
            stays_at_rev: (machine.spec().drive.spindle_takes == Takes::Speed).then_some(f64::INFINITY),
            count_mm: LEAST_COUNTS / scale.counts_per_mm,
            waiting_since_s: None,
            in_position_since_s: None,
            start_offset_mm: 0.0,
        }
    }

    /// Whether spindle and Z have stayed in position for long enough; then the next wait begins.
    ///
    /// # Errors
    /// [`Alarm::NotInPosition`] after [`SETTLE_TIMEOUT_S`].
    pub(super) fn check(&mut self, now_s: f64, error: PositionError, window: &Window) -> Result<bool, Alarm> {
        let PositionError { spindle_rev, z_deep_mm } = error;
        let waited_s = now_s - *self.waiting_since_s.get_or_insert(now_s);
        let deepest_mm = match self.in_position_since_s {
            _ if waited_s > DEEP_TIMEOUT_S => window.z_mm,
            Some(_) => (2.0 * window.z_deep_mm).min(window.z_mm),
            None => window.z_deep_mm,
        };
        let (spindle_stands, hold_s) = match &mut self.stays_at_rev {
            None => (spindle_rev.abs() <= window.spindle_rev.max(self.least_rev), window.hold_s),
            Some(at_rev) => {
                let stays = (spindle_rev - *at_rev).abs() <= STAYS_REV.max(self.least_rev);
                if !stays {
                    *at_rev = spindle_rev;
                }
                (stays, window.hold_s.max(STAYS_S))
            }
        };
        if spindle_stands && -z_deep_mm <= window.z_mm.max(self.count_mm) && z_deep_mm <= deepest_mm.max(self.count_mm)
        {
            let held = now_s - *self.in_position_since_s.get_or_insert(now_s) >= hold_s;
            if held {
                (self.waiting_since_s, self.in_position_since_s) = (None, None);
            }
            return Ok(held);
        }
        self.in_position_since_s = None;
        if waited_s > SETTLE_TIMEOUT_S {
            self.waiting_since_s = None;
            return Err(Alarm::NotInPosition { waited_s, spindle_rev, z_mm: -z_deep_mm });
        }
        Ok(false)
    }

    /// One period of the wait: the start offset follows Z. Returns its speed in mm/s, positive into the hole.
    pub(super) fn follow_z(&mut self, z_deep_mm: f64) -> f64 {
        let in_position = self.in_position_since_s.is_some();
        // A start offset that is too deep is too deep at the bottom, where an error of the hole is the lesser evil.
        let target_mm = if in_position { z_deep_mm.min(START_WITH_OFFSET.z_deep_mm) } else { 0.0 };
        let step_mm = filter_share(self.period_s, OFFSET_S) * (target_mm - self.start_offset_mm);
        self.start_offset_mm += step_mm;
        step_mm / self.period_s
    }

    /// The hole is gone on with where Z stands beside its plan.
    pub(super) fn stand(&mut self, z_deep_mm: f64) {
        self.start_offset_mm = z_deep_mm;
    }

    /// One period of the hole.
    pub(super) fn decay_offset(&mut self) {
        self.start_offset_mm -= self.period_s / OFFSET_DECAY_S * self.start_offset_mm;
    }

    /// How much deeper than the plan Z is commanded.
    pub(super) fn start_offset_mm(&self) -> f64 {
        self.start_offset_mm
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PERIOD_S: f64 = 0.001;
    const AT_REST: PositionError = PositionError { spindle_rev: 0.0, z_deep_mm: 0.0 };

    fn in_position() -> InPosition {
        InPosition::new(&Machine::reference())
    }

    /// Periods until in position, each with the axes' position errors.
    fn waits(window: &Window, off: impl Fn(u32) -> PositionError) -> Result<u32, Alarm> {
        let mut check = in_position();
        for k in 0.. {
            if check.check(f64::from(k) * PERIOD_S, off(k), window)? {
                return Ok(k);
            }
        }
        unreachable!("it waits for seconds, not for ever")
    }

    #[test]
    fn in_position_has_to_last() {
        assert_eq!(waits(&START, |_| AT_REST), Ok(10));
        assert_eq!(
            waits(&START, |k| if k == 5 { PositionError { spindle_rev: 0.0011, ..AT_REST } } else { AT_REST }),
            Ok(16)
        );
        assert_eq!(waits(&END, |_| PositionError { spindle_rev: -0.009, z_deep_mm: 0.049 }), Ok(0));
    }

    /// A frequency converter's spindle stands somewhere, and creeps no more.
    #[test]
    fn a_spindle_without_position_loop_has_to_stay_where_it_is() {
        let machine = Machine::reference().with(|spec| spec.drive.spindle_takes = Takes::Speed).unwrap();
        let periods = |rev: &dyn Fn(u32) -> f64| {
            let mut check = InPosition::new(&machine);
            (0..500_u32).find(|k| {
                let error = PositionError { spindle_rev: rev(*k), ..AT_REST };
                check.check(f64::from(*k) * PERIOD_S, error, &END) == Ok(true)
            })
        };
        assert_eq!(periods(&|_| 0.3), Some(21));
        assert_eq!(periods(&|k| 0.0002 * f64::from(k)), None, "12 rpm");
        // It comes to rest after 0.1 s.
        assert!(periods(&|k| 0.001 * f64::from(k.min(100))).is_some_and(|k| (115..125).contains(&k)));
    }

    #[test]
    fn too_deep_is_waited_for_where_the_hole_starts_with_an_offset() {
        let creeping = |k: u32| PositionError { z_deep_mm: 0.001_195 - 2e-5 * f64::from(k), ..AT_REST };
        assert_eq!(waits(&START, creeping), Ok(10));
        assert_eq!(waits(&START_WITH_OFFSET, creeping), Ok(55));
        assert_eq!(
            waits(&START_WITH_OFFSET, |k| PositionError { z_deep_mm: -creeping(k).z_deep_mm, ..AT_REST }),
            Ok(10)
        );
        // Once in position, noise does not end it.
        let noisy = |k: u32| PositionError { z_deep_mm: if k.is_multiple_of(2) { 0.0002 } else { 0.0005 }, ..AT_REST };
        assert_eq!(waits(&START_WITH_OFFSET, noisy), Ok(10));
    }

    #[test]
    fn too_deep_is_not_waited_for_long() {
        let jumping =
            |k: u32| PositionError { z_deep_mm: if (k / 7).is_multiple_of(2) { 0.001 } else { -0.001 }, ..AT_REST };
        assert_eq!(waits(&START_WITH_OFFSET, jumping), Ok(112));
    }

    #[test]
    fn gives_up_with_what_it_saw() {
        let off = PositionError { spindle_rev: 0.002, z_deep_mm: 0.5 };
        let Err(Alarm::NotInPosition { waited_s, spindle_rev, z_mm, .. }) = waits(&START, |_| off) else {
            panic!("rests")
        };
        assert!((waited_s - SETTLE_TIMEOUT_S).abs() < 2.0 * PERIOD_S);
        assert_eq!((spindle_rev, z_mm), (0.002, -0.5));
    }

    #[test]
    fn command_comes_to_where_z_stands() {
        let (mut check, off) = (in_position(), PositionError { z_deep_mm: -0.0015, ..AT_REST });
        let mut sum_mm = 0.0;
        for k in 0..40 {
            check.check(f64::from(k) * PERIOD_S, off, &Window { hold_s: 1.0, ..START_WITH_OFFSET }).unwrap();
            sum_mm += check.follow_z(off.z_deep_mm) * PERIOD_S;
        }
        assert!((check.start_offset_mm() + 0.0015).abs() < 1e-6 && (sum_mm - check.start_offset_mm()).abs() < 1e-12);
        (0..2000).for_each(|_| check.decay_offset());
        assert!((check.start_offset_mm() + 0.0015 * (-1.0_f64).exp()).abs() < 1e-6, "{}", check.start_offset_mm());
    }
}
