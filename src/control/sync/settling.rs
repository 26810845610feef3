//! Spindle and Z at rest: before a hole's zero is latched, and before Z is let go.

use crate::control::math::filter_share;

/// A fault at run time. The setpoint of the period before it stays valid: hold it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Alarm {
    /// Spindle or Z did not come to rest at the start or the end of a hole.
    NotInPosition {
        /// Seconds waited.
        waited_s: f64,
        /// The spindle's distance from where it should rest.
        spindle_rev: f64,
        /// Z's distance from R.
        z_mm: f64,
    },
}

/// When spindle and Z count as at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Window {
    spindle_rev: f64,
    z_mm: f64,
    /// The same on the side that is too deep, for as long as [`PATIENCE_S`]; twice that once both are at rest, so that
    /// noise does not end it.
    z_deep_mm: f64,
    /// Both have to stay so near this long.
    hold_s: f64,
}

/// Before the zero is latched: what creeps afterwards is error of the hole, so the window is a few percent of a tolerance.
pub(super) const START: Window = Window { spindle_rev: 0.001, z_mm: 0.002, z_deep_mm: 0.002, hold_s: 0.01 };
/// The same where the hole is tapped from where Z stands: what is too deep there is too deep at the bottom.
pub(super) const START_AS_IT_STANDS: Window = Window { z_deep_mm: 0.0003, ..START };
/// Before Z is let go: the tap has left the thread, and the spindle must not turn on with it.
pub(super) const END: Window = Window { spindle_rev: 0.01, z_mm: 0.05, z_deep_mm: 0.05, hold_s: 0.0 };
/// No window is less than this: a resting axis may stand between two counts.
const WINDOW_COUNTS: f64 = 1.0;
/// After this long without, something is wrong with the machine.
const LIMIT_S: f64 = 3.0;

/// So long a Z that stands too deep is waited for: it creeps up, and a friction that lets it jump would let it jump for ever.
const PATIENCE_S: f64 = 0.1;

/// Time over which where Z stands is averaged.
const STANDING_S: f64 = 0.003;

/// Time over which that fades in the hole: what each hole leaves would add up.
const FADE_S: f64 = 2.0;

/// How far spindle and Z are from where they are to rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Off {
    pub(super) spindle_rev: f64,
    pub(super) z_deep_mm: f64,
}

/// Waits for rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Settling {
    period_s: f64,
    count_rev: f64,
    count_mm: f64,
    since_s: Option<f64>,
    in_position_since_s: Option<f64>,
    standing_mm: f64,
}

impl Settling {
    pub(super) fn new(period_s: f64, counts_per_rev: f64, counts_per_mm: f64) -> Self {
        Self {
            period_s,
            count_rev: WINDOW_COUNTS / counts_per_rev,
            count_mm: WINDOW_COUNTS / counts_per_mm,
            since_s: None,
            in_position_since_s: None,
            standing_mm: 0.0,
        }
    }

    /// Whether spindle and Z have stayed where they are to rest for long enough; then the next wait begins.
    ///
    /// # Errors
    /// [`Alarm::NotInPosition`] after [`LIMIT_S`].
    pub(super) fn rested(&mut self, now_s: f64, off: Off, window: &Window) -> Result<bool, Alarm> {
        let Off { spindle_rev, z_deep_mm } = off;
        let since_s = *self.since_s.get_or_insert(now_s);
        let waited_s = now_s - since_s;
        let deepest_mm = match self.in_position_since_s {
            _ if waited_s > PATIENCE_S => window.z_mm,
            Some(_) => (2.0 * window.z_deep_mm).min(window.z_mm),
            None => window.z_deep_mm,
        };
        if spindle_rev.abs() <= window.spindle_rev.max(self.count_rev)
            && -z_deep_mm <= window.z_mm.max(self.count_mm)
            && z_deep_mm <= deepest_mm.max(self.count_mm)
        {
            let rested = now_s - *self.in_position_since_s.get_or_insert(now_s) >= window.hold_s;
            if rested {
                (self.since_s, self.in_position_since_s) = (None, None);
            }
            return Ok(rested);
        }
        self.in_position_since_s = None;
        if waited_s > LIMIT_S {
            return Err(Alarm::NotInPosition { waited_s, spindle_rev, z_mm: -z_deep_mm });
        }
        Ok(false)
    }

    /// One period of waiting for a hole that is tapped from where Z stands: friction holds Z a little off, and its command
    /// comes there. Returns how fast, into the hole.
    pub(super) fn take_as_it_stands(&mut self, z_deep_mm: f64) -> f64 {
        let rests = self.in_position_since_s.is_some();
        // What is too deep here is too deep at the bottom, and error of the hole is the lesser evil.
        let target_mm = if rests { z_deep_mm.min(START_AS_IT_STANDS.z_deep_mm) } else { 0.0 };
        let step_mm = filter_share(self.period_s, STANDING_S) * (target_mm - self.standing_mm);
        self.standing_mm += step_mm;
        step_mm / self.period_s
    }

    /// One period of the hole: its command comes back to the plan, too slowly to be an error of it.
    pub(super) fn fade(&mut self) {
        self.standing_mm -= self.period_s / FADE_S * self.standing_mm;
    }

    /// How much deeper than where it is to rest Z is commanded.
    pub(super) fn standing_mm(&self) -> f64 {
        self.standing_mm
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PERIOD_S: f64 = 0.001;
    const AT_REST: Off = Off { spindle_rev: 0.0, z_deep_mm: 0.0 };

    fn settling() -> Settling {
        Settling::new(PERIOD_S, 16_384.0, 10_000.0)
    }

    /// Periods until rest, each with where the axes are.
    fn waits(window: &Window, off: impl Fn(u32) -> Off) -> Result<u32, Alarm> {
        let mut settling = settling();
        for k in 0.. {
            if settling.rested(f64::from(k) * PERIOD_S, off(k), window)? {
                return Ok(k);
            }
        }
        unreachable!("it waits for seconds, not for ever")
    }

    #[test]
    fn rest_has_to_last() {
        assert_eq!(waits(&START, |_| AT_REST), Ok(10));
        assert_eq!(waits(&START, |k| if k == 5 { Off { spindle_rev: 0.0011, ..AT_REST } } else { AT_REST }), Ok(16));
        assert_eq!(waits(&END, |_| Off { spindle_rev: -0.009, z_deep_mm: 0.049 }), Ok(0));
    }

    #[test]
    fn too_deep_is_waited_for_where_the_hole_starts_from_there() {
        let creeping = |k: u32| Off { z_deep_mm: 0.001_195 - 2e-5 * f64::from(k), ..AT_REST };
        assert_eq!(waits(&START, creeping), Ok(10));
        assert_eq!(waits(&START_AS_IT_STANDS, creeping), Ok(55));
        assert_eq!(waits(&START_AS_IT_STANDS, |k| Off { z_deep_mm: -creeping(k).z_deep_mm, ..AT_REST }), Ok(10));
        // Once in position, noise does not end it.
        let noisy = |k: u32| Off { z_deep_mm: if k.is_multiple_of(2) { 0.0002 } else { 0.0005 }, ..AT_REST };
        assert_eq!(waits(&START_AS_IT_STANDS, noisy), Ok(10));
    }

    #[test]
    fn too_deep_is_not_waited_for_long() {
        let jumping = |k: u32| Off { z_deep_mm: if (k / 7).is_multiple_of(2) { 0.001 } else { -0.001 }, ..AT_REST };
        assert_eq!(waits(&START_AS_IT_STANDS, jumping), Ok(112));
    }

    #[test]
    fn gives_up_with_what_it_saw() {
        let off = Off { spindle_rev: 0.002, z_deep_mm: 0.5 };
        let Err(Alarm::NotInPosition { waited_s, spindle_rev, z_mm }) = waits(&START, |_| off) else { panic!("rests") };
        assert!((waited_s - LIMIT_S).abs() < 2.0 * PERIOD_S);
        assert_eq!((spindle_rev, z_mm), (0.002, -0.5));
    }

    #[test]
    fn command_comes_to_where_z_stands() {
        let (mut settling, off) = (settling(), Off { z_deep_mm: -0.0015, ..AT_REST });
        let mut way_mm = 0.0;
        for k in 0..40 {
            settling.rested(f64::from(k) * PERIOD_S, off, &Window { hold_s: 1.0, ..START_AS_IT_STANDS }).unwrap();
            way_mm += settling.take_as_it_stands(off.z_deep_mm) * PERIOD_S;
        }
        assert!((settling.standing_mm() + 0.0015).abs() < 1e-6 && (way_mm - settling.standing_mm()).abs() < 1e-12);
        (0..2000).for_each(|_| settling.fade());
        assert!((settling.standing_mm() + 0.0015 * (-1.0_f64).exp()).abs() < 1e-6, "{}", settling.standing_mm());
    }
}
