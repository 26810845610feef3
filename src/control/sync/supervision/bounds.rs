//! The last stage of every step: whatever came before, what leaves it is finite, within the machine's limits and smooth.
//!
//! It is a pure function of the setpoint before and the one that is wanted. One that obeys the limits passes as it is.

use crate::control::math::{poly::State, sqrt};

/// Limits of an axis' setpoints.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct AxisBounds {
    /// Least and greatest position.
    pub(super) low: f64,
    pub(super) high: f64,
    pub(super) speed: f64,
    pub(super) acceleration: f64,
}

/// Share of the acceleration with which a wanted position is caught up, so that the end is not overrun.
const CATCH_UP_SHARE: f64 = 0.5;
/// Numbers closer than this are the same but for rounding.
const ROUNDING: f64 = 1e-9;

/// What is sent of one axis, and what its next setpoint is judged by.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Bounded {
    /// The setpoint.
    pub(super) state: State,
    /// Its position less that before, by the time between.
    pub(super) speed: f64,
}

impl Bounded {
    /// A setpoint at rest.
    pub(super) fn at_rest(position: f64) -> Self {
        Self { state: State { position, ..State::default() }, speed: 0.0 }
    }
}

impl AxisBounds {
    /// The setpoint that comes `elapsed_s` after `before`, as near to the wanted one as the limits allow.
    pub(super) fn next(&self, before: &Bounded, wanted: &State, elapsed_s: f64) -> Bounded {
        let wanted =
            if is_finite(wanted) { *wanted } else { State { position: before.state.position, ..State::default() } };
        let from = before.state.position;
        let wanted_speed = (wanted.position - from) / elapsed_s;
        let speed_change = self.acceleration * elapsed_s;
        let passes = (self.low..=self.high).contains(&wanted.position)
            && wanted_speed.abs() <= self.speed
            && (wanted_speed - before.speed).abs() <= speed_change
            && wanted.velocity.abs() <= self.speed
            && wanted.acceleration.abs() <= self.acceleration
            && self.can_stop(wanted.position, wanted_speed);
        if passes {
            return Bounded { state: wanted, speed: wanted_speed };
        }
        let target = wanted.position.max(self.low).min(self.high);
        // Beside what the wanted motion goes in this period itself: else it would settle a period ahead of it.
        let caught_up = wanted.velocity + self.catch_up(target - from - wanted.velocity * elapsed_s, elapsed_s);
        let lowest = (before.speed - speed_change).max(-self.speed);
        let highest = (before.speed + speed_change).min(self.speed);
        let inside = caught_up
            .min(self.stoppable((self.high - from).max(0.0), elapsed_s))
            .max(-self.stoppable((from - self.low).max(0.0), elapsed_s));
        let speed = inside.max(lowest).min(highest);
        let position = from + speed * elapsed_s;
        let acceleration = (speed - before.speed) / elapsed_s;
        Bounded { state: State { position, velocity: speed, acceleration, jerk: 0.0 }, speed }
    }

    /// The speed from which a way can still be braked to its end, in steps of `elapsed_s`; the last one ends on it.
    fn catch_up(&self, way: f64, elapsed_s: f64) -> f64 {
        let acceleration = CATCH_UP_SHARE * self.acceleration;
        let half_step = 0.5 * acceleration * elapsed_s;
        let speed = sqrt(half_step * half_step + 2.0 * acceleration * way.abs()) - half_step;
        let speed = speed.min(way.abs() / elapsed_s).max(0.0);
        if way < 0.0 { -speed } else { speed }
    }

    /// The greatest speed for a period after which what is left of a way still suffices to brake, however long the periods then
    /// are: v²/2a of it, since a host's clock jitters.
    fn stoppable(&self, way: f64, elapsed_s: f64) -> f64 {
        let step = self.acceleration * elapsed_s;
        sqrt(step * step + 2.0 * self.acceleration * way) - step
    }

    /// Whether the axis can stop before it leaves its range.
    fn can_stop(&self, position: f64, speed: f64) -> bool {
        let way = if speed > 0.0 { self.high - position } else { position - self.low };
        speed * speed <= 2.0 * self.acceleration * way + ROUNDING
    }
}

fn is_finite(State { position, velocity, acceleration, jerk }: &State) -> bool {
    [position, velocity, acceleration, jerk].iter().all(|value| value.is_finite())
}

#[cfg(test)]
mod tests {
    use super::{AxisBounds, Bounded};
    use crate::control::math::poly::State;
    use proptest::prelude::*;

    const PERIOD_S: f64 = 0.001;
    /// Share of a limit that sums of doubles may be off.
    const ROUNDING: f64 = 1e-9;
    const Z: AxisBounds = AxisBounds { low: -20.5, high: 5.5, speed: 500.0, acceleration: 10_000.0 };
    const SPINDLE: AxisBounds =
        AxisBounds { low: f64::NEG_INFINITY, high: f64::INFINITY, speed: 133.0, acceleration: 995.0 };

    fn at(position: f64) -> State {
        State { position, ..State::default() }
    }

    fn assert_within(bounds: &AxisBounds, before: &Bounded, now: &Bounded, elapsed_s: f64) {
        let State { position, velocity, acceleration, jerk } = now.state;
        assert!([position, velocity, acceleration, jerk, now.speed].iter().all(|value| value.is_finite()), "{now:?}");
        assert!((bounds.low - ROUNDING..=bounds.high + ROUNDING).contains(&position), "{now:?}");
        let speed = (position - before.state.position) / elapsed_s;
        // The difference of two positions of up to some hundred carries no more.
        assert!((speed - now.speed).abs() < 1e-9, "{now:?}");
        let within = |value: f64, limit: f64| value.abs() <= limit * (1.0 + ROUNDING);
        assert!(within(now.speed, bounds.speed) && within(velocity, bounds.speed), "{now:?}");
        assert!(within(acceleration, bounds.acceleration), "{now:?}");
        assert!(within(now.speed - before.speed, bounds.acceleration * elapsed_s), "{before:?} {now:?}");
    }

    /// Anything that a strategy gone wrong could ask for.
    fn wanted() -> impl Strategy<Value = State> {
        let number = || {
            prop_oneof![
                6 => -30.0..30.0f64,
                2 => -1e4..1e4f64,
                1 => prop_oneof![
                    Just(f64::NAN), Just(f64::INFINITY), Just(f64::NEG_INFINITY), Just(1e300), Just(-1e300),
                    Just(f64::MAX), Just(f64::MIN), Just(5e-324),
                ],
            ]
        };
        (number(), number(), number(), number()).prop_map(|(position, velocity, acceleration, jerk)| State {
            position,
            velocity,
            acceleration,
            jerk,
        })
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 2000, failure_persistence: None, ..ProptestConfig::default() })]

        #[test]
        fn whatever_is_wanted_leaves_within_the_limits(
            wanted in prop::collection::vec((wanted(), 1..80_u32, 0.5..1.5f64), 1..12),
        ) {
            for bounds in [Z, SPINDLE] {
                let mut before = Bounded::at_rest(0.0);
                for (wanted, periods, jitter) in &wanted {
                    // Held for long enough to come near an end at full speed.
                    for _ in 0..*periods {
                        let now = bounds.next(&before, wanted, jitter * PERIOD_S);
                        assert_within(&bounds, &before, &now, jitter * PERIOD_S);
                        before = now;
                    }
                }
            }
        }

        /// From wherever it is, a position inside is reached and kept.
        #[test]
        fn it_catches_up_and_settles(from in -20.0..5.0f64, speed in -300.0..300.0f64, to in -20.5..5.5f64) {
            let way = if speed > 0.0 { Z.high - from } else { from - Z.low };
            prop_assume!(way > 0.55 * speed * speed / Z.acceleration + 0.5);
            let mut before = Bounded { state: State { velocity: speed, ..at(from) }, speed };
            for k in 0..1000 {
                let now = Z.next(&before, &at(to), PERIOD_S);
                assert_within(&Z, &before, &now, PERIOD_S);
                before = now;
                // 26 mm there and back at half of 10 m/s² take 0.3 s.
                if k > 400 {
                    prop_assert!((now.state.position - to).abs() < 1e-6 && now.speed.abs() < 1e-6, "{k}: {now:?}");
                }
            }
            prop_assert_eq!(before.state, at(to));
        }

        /// A motion that obeys passes bit for bit, its derivatives as they are.
        #[test]
        fn what_obeys_passes(from in -18.0..3.0f64, amplitude in 0.01..2.0f64, hz in 0.1..4.0f64) {
            let rad_per_s = std::f64::consts::TAU * hz;
            let motion = |k: u32| {
                let phase = rad_per_s * f64::from(k) * PERIOD_S;
                State {
                    position: from + amplitude * (1.0 - phase.cos()),
                    velocity: amplitude * rad_per_s * phase.sin(),
                    acceleration: amplitude * rad_per_s * rad_per_s * phase.cos(),
                    jerk: 1.0,
                }
            };
            prop_assume!(from + 2.0 * amplitude < Z.high && amplitude * rad_per_s < 0.9 * Z.speed);
            prop_assume!(amplitude * rad_per_s * rad_per_s < 0.9 * Z.acceleration);
            let mut before = Bounded::at_rest(from);
            for k in 0..2000 {
                before = Z.next(&before, &motion(k), PERIOD_S);
                prop_assert_eq!(before.state, motion(k));
            }
        }
    }

    #[test]
    fn a_leap_becomes_the_fastest_way_that_can_stop() {
        let mut before = Bounded::at_rest(0.0);
        let mut fastest: f64 = 0.0;
        let arrived = (1..).find(|_| {
            before = Z.next(&before, &at(-20.0), PERIOD_S);
            fastest = fastest.max(before.speed.abs());
            before.state.position == -20.0
        });
        // Full acceleration to v, half of it back: 20 mm take sqrt(2·20·5000·10000/15000) mm/s at most.
        assert!((fastest - 365.0).abs() < 5.0 && arrived.is_some_and(|periods| periods < 130), "{fastest} {arrived:?}");
    }

    /// A leap in the middle of a motion is caught up with, and the motion then passes again as it is.
    #[test]
    fn after_a_leap_it_is_where_it_is_wanted() {
        let motion = |k: u32| State { velocity: -100.0, ..at(-0.1 * f64::from(k)) };
        let mut before = Bounded { state: motion(0), speed: -100.0 };
        for k in 1..150 {
            let leapt = if k == 10 { motion(k).shifted(0.5) } else { motion(k) };
            before = Z.next(&before, &leapt, PERIOD_S);
            assert!(k < 60 || before.state == motion(k), "{k}: {before:?}");
        }
    }

    #[test]
    fn no_number_brakes_to_rest() {
        let mut before = Bounded { state: State { velocity: 100.0, ..at(0.0) }, speed: 100.0 };
        for _ in 0..12 {
            before = SPINDLE.next(&before, &at(f64::NAN), 0.01);
        }
        assert_eq!((before.speed, before.state.velocity), (0.0, 0.0));
    }
}
