//! Z's backlash: on which flank the motor stands, and when it crosses to the other.
//!
//! The screw's force says on which flank the motor has to push. Where that force is next to nothing, friction braking the
//! load just as fast as the path does, it says little: a change of the flank then waits, and the load may cross by itself.
//! So a crossing starts from where motor and scale measure the motor to stand.

use crate::control::math::{filter_share, poly::State, sign};

use super::delay_line::{DelayLine, half_width_periods};

/// Uncertainty of the screw's force, as a share of the load's friction. Within it the motor stands between the flanks, so that
/// an error costs half the backlash, and no small change makes a reversal spike.
const UNCERTAIN_SHARE: f64 = 0.15;
/// Hysteresis of the flank, in that uncertainty: by so much the force has to turn round before the motor follows. Of light
/// tables with much backlash (`[spread]` at friction 0.5–0.9 and 3–5 µm), less lets more of them rattle, and so does more.
const HYSTERESIS: f64 = 0.3;
/// A flank that changes slower than this rests: the motor stands where it was sent.
const RESTING_PER_S: f64 = 20.0;
/// Halves of a crossing at rest after which motor and scale measure where the motor stands: drive and encoders have settled.
const SETTLED_HALVES: u32 = 6;
/// Time constant of that measurement: long against the encoders' noise, short against a load that crosses by itself.
const MEASURED_S: f64 = 0.004;
/// Share of e(k) kept out of the learning while the flank is undetermined; full effect from a backlash of so much. Learned
/// wholly, the chance of one hole makes a reversal spike in the next; not at all, what does repeat stays.
const CHANCE_SHARE: f64 = 0.7;
const CHANCE_BACKLASH_MM: f64 = 0.002;

/// State of the backlash. Flanks are −1…1, 1 where the motor pushes into the hole.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Backlash {
    period_s: f64,
    half_width_periods: u32,
    backlash_mm: f64,
    /// Flank that the screw's force asks for.
    wanted: f64,
    /// Flank on which the motor stands once it has done what it was sent to do.
    flank: f64,
    resting_periods: u32,
    /// What the motor was sent. It differs from the flank by what the load did by itself.
    sent: DelayLine,
    determined: DelayLine,
}

impl Backlash {
    /// For a hole that begins with the motor on a flank; a crossing takes a time.
    pub(super) fn new(period_s: f64, crossing_s: f64, backlash_mm: f64, flank: f64) -> Self {
        Self {
            period_s,
            half_width_periods: half_width_periods(period_s, crossing_s),
            backlash_mm,
            wanted: flank,
            flank,
            resting_periods: 0,
            sent: DelayLine::constant(flank, period_s, crossing_s),
            determined: DelayLine::constant(1.0, period_s, crossing_s),
        }
    }

    /// One period: what the screw will carry, over a load's friction of so much.
    pub(super) fn load(&mut self, screw_n: f64, friction_n: f64) {
        let wanted = if screw_n == 0.0 {
            self.wanted
        } else {
            let flanks = screw_n / (UNCERTAIN_SHARE * friction_n);
            self.wanted.max(flanks - HYSTERESIS).min(flanks + HYSTERESIS).clamp(-1.0, 1.0)
        };
        let change = wanted - self.wanted;
        let end = sign(change);
        // The same share of the travel to its end as the wanted flank moves of its own.
        let moved = if change == 0.0 { 0.0 } else { change / (end - self.wanted) * (end - self.flank) };
        self.wanted = wanted;
        self.flank += moved;
        self.sent.push(self.sent.newest() + moved);
        self.determined.push(wanted.abs());
        self.resting_periods =
            if change.abs() > RESTING_PER_S * self.period_s { 0 } else { self.resting_periods.saturating_add(1) };
    }

    /// One period: how far the motor was measured to lead the load beyond the screw's wind-up.
    pub(super) fn correct(&mut self, deflection_mm: f64) {
        if self.resting_periods < SETTLED_HALVES * self.half_width_periods || !(self.backlash_mm > 0.0) {
            return;
        }
        let measured = (2.0 * deflection_mm / self.backlash_mm).clamp(-1.0, 1.0);
        self.flank += filter_share(self.period_s, MEASURED_S) * (measured - self.flank);
    }

    /// How far the motor was sent ahead of the load, so long before the newest period.
    pub(super) fn sent_mm(&self, ago_s: f64) -> State {
        self.sent.at(ago_s).scaled(0.5 * self.backlash_mm)
    }

    /// Share of an error that the next hole will repeat, at a time before the newest period.
    pub(super) fn repeatable_share(&self, ago_s: f64) -> f64 {
        let undetermined = 1.0 - self.determined.at(ago_s).position.min(1.0);
        1.0 - CHANCE_SHARE * undetermined * (self.backlash_mm / CHANCE_BACKLASH_MM).min(1.0)
    }

    #[cfg(test)]
    pub(super) fn flank(&self) -> f64 {
        self.flank
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PERIOD_S: f64 = 0.001;
    const CROSSING_S: f64 = 0.004;
    const BACKLASH_MM: f64 = 0.004;
    const FRICTION_N: f64 = 100.0;
    const UNCERTAIN_N: f64 = UNCERTAIN_SHARE * FRICTION_N;

    fn begun(flank: f64) -> Backlash {
        Backlash::new(PERIOD_S, CROSSING_S, BACKLASH_MM, flank)
    }

    fn half_width_s() -> f64 {
        f64::from(half_width_periods(PERIOD_S, CROSSING_S)) * PERIOD_S
    }

    fn loaded(backlash: &mut Backlash, periods: usize, screw_n: f64) {
        (0..periods).for_each(|_| backlash.load(screw_n, FRICTION_N));
    }

    fn sent_mm(backlash: &Backlash) -> f64 {
        backlash.sent_mm(half_width_s()).position
    }

    #[test]
    fn motor_crosses_where_the_force_turns_round() {
        let mut backlash = begun(1.0);
        loaded(&mut backlash, 20, 50.0);
        assert!((sent_mm(&backlash) - 0.5 * BACKLASH_MM).abs() < 1e-12);
        loaded(&mut backlash, 20, -50.0);
        assert!((sent_mm(&backlash) + 0.5 * BACKLASH_MM).abs() < 1e-12);
    }

    #[test]
    fn little_force_says_little() {
        let mut backlash = begun(1.0);
        // It stays within the hysteresis of what the force says.
        for (flanks, expected) in [(0.8, 1.0), (0.5, 0.8), (0.6, 0.8), (-0.1, 0.2), (0.4, 0.2), (-1.5, -1.0)] {
            loaded(&mut backlash, 1, flanks * UNCERTAIN_N);
            assert!((backlash.flank() - expected).abs() < 1e-12, "{flanks}: {}", backlash.flank());
        }
        loaded(&mut backlash, 1, 0.0);
        assert_eq!(backlash.flank(), -1.0, "no force says nothing");
        let mut frictionless = begun(1.0);
        frictionless.load(-1.0, 0.0);
        assert_eq!(frictionless.flank(), -1.0);
    }

    /// The load has crossed by itself: the motor is where it will have to push, and is not sent.
    #[test]
    fn crossing_starts_from_where_the_motor_is_measured_to_stand() {
        for (measured, moved) in [(-1.0, 2.0), (0.0, 1.0), (0.5, 0.5), (1.0, 0.0), (3.0, 0.0)] {
            let mut backlash = begun(-1.0);
            for _ in 0..100 {
                loaded(&mut backlash, 1, -50.0);
                backlash.correct(0.5 * BACKLASH_MM * measured);
            }
            let before_mm = sent_mm(&backlash);
            loaded(&mut backlash, 5, 0.2 * UNCERTAIN_N);
            loaded(&mut backlash, 20, 50.0);
            let travel_mm = sent_mm(&backlash) - before_mm;
            assert!((travel_mm - 0.5 * BACKLASH_MM * moved).abs() < 1e-9, "{measured}: {travel_mm}");
        }
    }

    #[test]
    fn what_is_measured_during_a_crossing_does_not_count() {
        for (period_s, crossing_s, resting_s) in
            [(0.001, 0.004, 0.012), (0.000_25, 0.004, 0.012), (0.001, 0.016, 0.048)]
        {
            let mut backlash = Backlash::new(period_s, crossing_s, BACKLASH_MM, -1.0);
            let crossed = (0..1000).take_while(|_| {
                loaded(&mut backlash, 1, 50.0);
                backlash.correct(-0.5 * BACKLASH_MM);
                backlash.flank() == 1.0
            });
            let counted_s = crossed.count() as f64 * period_s;
            assert!((counted_s - resting_s).abs() < 1e-9, "{period_s} {crossing_s}: {counted_s}");
        }
    }

    #[test]
    fn errors_repeat_where_a_flank_is_determined_or_there_is_no_backlash() {
        let mut backlash = begun(1.0);
        let repeats = |backlash: &Backlash| backlash.repeatable_share(half_width_s());
        loaded(&mut backlash, 20, 50.0);
        assert!((repeats(&backlash) - 1.0).abs() < 1e-12);
        loaded(&mut backlash, 20, -HYSTERESIS * UNCERTAIN_N);
        assert!((repeats(&backlash) - (1.0 - CHANCE_SHARE)).abs() < 1e-12);
        backlash.backlash_mm = 0.0;
        assert_eq!(repeats(&backlash), 1.0);
    }
}
