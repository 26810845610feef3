//! The synchronous stop of a spindle that does not follow its command: it brakes with what torque there is, and Z follows
//! where it really is.
//!
//! The command falls behind the measured spindle until the drive's loops alone ask for all of the motor's torque: with gains
//! kp and kv that is v − kp·(l − lag), l = a/(kp·kv), since kv·(kp·(l − lag) + kp·lag) = a. What it is told beyond that is no
//! help, and would be run after later.

use crate::control::math::{exp, filter_share, poly::State};
use crate::control::motor::Motor;
use crate::control::sync::frame::AxisCommands;
use crate::control::sync::observer::SpindleObserver;

use super::rest::RestMonitor;

/// The command is no further ahead of the measured spindle.
const LEASH_REV: f64 = 0.02;
/// A spindle that is told to brake and speeds up by this share and speed for so long is driven by what its encoder says: that
/// is not where it is.
const RUNAWAY_SHARE: f64 = 0.05;
const RUNAWAY_REV_PER_S: f64 = 1.0;
const RUNAWAY_S: f64 = 0.005;
/// Memory of what Z's reference has beside the spindle's travel: longer than a fault takes to be seen.
const BESIDE_S: f64 = 0.02;
/// Poles of the observers times the period: Z follows the spindle closely, and the command is calm where the shaft of a tap that
/// jams rings at some hundred Hz.
const Z_POLES: f64 = 1.0;
const SPINDLE_POLES: f64 = 0.15;

/// Z goes over from the plan to the measured spindle like a critically damped mass of this frequency times the period: faster it
/// would ring.
const JOINING_POLES: f64 = 0.25;

/// What a followed stop is made of.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct StopConfig {
    pub(super) motor: Motor,
    /// Gains of the spindle's drive, 1/s.
    pub(super) position_gain_per_s: f64,
    pub(super) velocity_gain_per_s: f64,
    pub(super) counts_per_rev: f64,
    pub(super) pitch_mm: f64,
    pub(super) period_s: f64,
    /// From a sample of the spindle to the instant that Z acts on it.
    pub(super) horizon_s: f64,
}

impl StopConfig {
    /// How hard to brake from a speed: with all there is, and so that it ends at rest.
    fn braking(&self, speed: f64) -> f64 {
        self.motor.acceleration_rev_per_s2(speed, 1.0).min(self.velocity_gain_per_s * speed)
    }
}

/// The measured spindle, what Z has beside it, and the stop where one is under way. Positive into the hole.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct FollowedStop {
    config: StopConfig,
    observer: SpindleObserver,
    calm: SpindleObserver,
    /// Z's reference beside the spindle's travel, as it was before the fault.
    z_beside_mm: f64,
    /// Z's force beyond its acceleration's, as it was commanded last.
    z_force_n: f64,
    under_way: Option<UnderWay>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct UnderWay {
    /// Where the spindle is commanded to be.
    spindle_rev: f64,
    /// By how much Z is not yet beside the measured spindle as it was before the fault; before the first period, where Z was sent.
    apart: Apart,
    rest: RestMonitor,
    runaway: Runaway,
    /// Where Z is held once both rest: counts that flicker move nothing.
    held_mm: Option<f64>,
}

/// Whether the spindle speeds up in its stop, as one does whose encoder counts too much: a command led by it pulls it on.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Runaway {
    slowest: f64,
    faster_s: f64,
}

impl Runaway {
    const NONE: Self = Self { slowest: f64::INFINITY, faster_s: 0.0 };

    /// One period's speed; true from when it has run away, and for good.
    fn observe(&mut self, speed: f64, period_s: f64) -> bool {
        if self.faster_s >= RUNAWAY_S {
            return true;
        }
        self.slowest = self.slowest.min(speed.abs());
        let faster = speed.abs() > (1.0 + RUNAWAY_SHARE) * self.slowest + RUNAWAY_REV_PER_S;
        self.faster_s = if faster { self.faster_s + period_s } else { 0.0 };
        self.faster_s >= RUNAWAY_S
    }
}

/// Z's way from the plan to the measured spindle.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Apart {
    /// Z as it was sent last.
    Sent(State),
    /// What is left of the difference.
    Left(State),
}

impl FollowedStop {
    pub(super) fn new(config: StopConfig) -> Self {
        let of = |poles: f64| SpindleObserver::of_angle(config.period_s, poles / config.period_s);
        let (observer, calm) = (of(Z_POLES), of(SPINDLE_POLES));
        Self { config, observer, calm, z_beside_mm: 0.0, z_force_n: 0.0, under_way: None }
    }

    /// The hole begins with the spindle at rest in it.
    pub(super) fn rest_at(&mut self, spindle_rev: f64) {
        self.observer.rest_at(spindle_rev);
        self.calm.rest_at(spindle_rev);
    }

    /// A synchronous period's travel of the spindle.
    pub(super) fn observe(&mut self, spindle_rev: f64) {
        self.observer.update(spindle_rev, false);
        self.calm.update(spindle_rev, false);
        if let Some(under_way) = &mut self.under_way {
            under_way.rest.observe(spindle_rev);
        }
    }

    /// What the plan commands: its part beside the spindle's travel goes on in a stop.
    pub(super) fn note(&mut self, commands: &AxisCommands, deeper_mm: f64) {
        let ahead_rev = self.observer.predict(self.config.horizon_s).position;
        let beside_mm = commands.z.position + deeper_mm - self.config.pitch_mm * ahead_rev;
        self.z_beside_mm += filter_share(self.config.period_s, BESIDE_S) * (beside_mm - self.z_beside_mm);
        self.z_force_n = commands.z_force_n;
    }

    /// Begins where spindle and Z were commanded last. Z joins the measured spindle smoothly, or at once: where that is halted,
    /// there is no time.
    pub(super) fn begin(&mut self, spindle: &State, z: State, at_once: bool) {
        let rest = RestMonitor::new(self.config.counts_per_rev, self.config.period_s);
        let apart = if at_once { Apart::Left(State::default()) } else { Apart::Sent(z) };
        let spindle_rev = spindle.position;
        self.under_way = Some(UnderWay { spindle_rev, apart, rest, runaway: Runaway::NONE, held_mm: None });
    }

    pub(super) fn is_under_way(&self) -> bool {
        self.under_way.is_some()
    }

    /// It is over: where the spindle was commanded to rest.
    pub(super) fn end(&mut self) -> Option<f64> {
        self.under_way.take().map(|under_way| under_way.spindle_rev)
    }

    /// One period of a stop, if one is under way: its commands, after the last that was sent to the spindle.
    pub(super) fn step(&mut self, sent: &State) -> Option<AxisCommands> {
        let Self { config, observer, calm, z_beside_mm, z_force_n, under_way } = self;
        let UnderWay { spindle_rev, apart, rest, runaway, held_mm } = under_way.as_mut()?;
        if let Some(position) = *held_mm {
            let z = State { position, ..State::default() };
            let spindle = State { position: *spindle_rev, ..State::default() };
            return Some(AxisCommands { spindle, z, z_force_n: *z_force_n, ..AxisCommands::default() });
        }
        let actual = observer.predict(config.horizon_s);
        let calm = calm.predict(config.horizon_s).velocity;
        // The calm one overshoots where a jam halts it.
        let slower = if calm.abs() < actual.velocity.abs() { calm } else { actual.velocity };
        let velocity = if calm * actual.velocity > 0.0 { slower } else { 0.0 };
        let spindle = if runaway.observe(actual.velocity, config.period_s) {
            config.brake_blindly(sent)
        } else {
            config.brake(sent, &State { velocity, ..actual })
        };
        *spindle_rev = spindle.position;
        let beside = actual.scaled(config.pitch_mm).shifted(*z_beside_mm);
        let left = match apart {
            Apart::Sent(z) => State {
                position: z.position + z.velocity * config.period_s - beside.position,
                velocity: z.velocity - beside.velocity,
                ..State::default()
            },
            Apart::Left(left) => config.joined(left),
        };
        *apart = Apart::Left(left);
        let z = State {
            position: beside.position + left.position,
            velocity: beside.velocity + left.velocity,
            acceleration: beside.acceleration + left.acceleration,
            jerk: 0.0,
        };
        *held_mm = rest.is_at_rest().then_some(z.position);
        Some(AxisCommands { spindle, z, spindle_torque_nm: 0.0, z_force_n: *z_force_n })
    }
}

impl StopConfig {
    /// What a period leaves of the difference between Z and the measured spindle.
    fn joined(&self, left: &State) -> State {
        let rate = JOINING_POLES / self.period_s;
        let kept = exp(-JOINING_POLES);
        let position = kept * ((1.0 + JOINING_POLES) * left.position + left.velocity * self.period_s);
        let velocity = kept * ((1.0 - JOINING_POLES) * left.velocity - rate * JOINING_POLES * left.position);
        State { position, velocity, acceleration: -rate * (2.0 * velocity + rate * position), jerk: 0.0 }
    }

    /// The spindle's next command where its encoder is not to be followed: from what was sent last to rest.
    fn brake_blindly(&self, sent: &State) -> State {
        let sense = if sent.velocity < 0.0 { -1.0 } else { 1.0 };
        let braking = self.braking(sense * sent.velocity);
        let speed = (sense * sent.velocity - braking * self.period_s).max(0.0);
        let position = sent.position + 0.5 * (sent.velocity + sense * speed) * self.period_s;
        State { position, velocity: sense * speed, acceleration: -sense * braking, jerk: 0.0 }
    }

    /// The spindle's next command.
    fn brake(&self, sent: &State, actual: &State) -> State {
        let Self { position_gain_per_s, velocity_gain_per_s, period_s, .. } = *self;
        let sense = if actual.velocity < 0.0 { -1.0 } else { 1.0 };
        let (actual_speed, sent_speed) = (sense * actual.velocity, sense * sent.velocity);
        // Where the last command would be by then, if it went on as it did.
        let ahead_rev = sense * (sent.position - actual.position) + sent_speed * period_s;
        let braking = self.braking(actual_speed);
        // It never rises over the measured speed: such a command would drive what it follows.
        let free = (sent_speed - self.braking(sent_speed.max(0.0)) * period_s).max(0.0).min(actual_speed);
        let dragged = actual_speed - braking / velocity_gain_per_s - position_gain_per_s * ahead_rev;
        let speed = free.max(dragged);
        let position = sense * (sent.position + 0.5 * sense * (sent_speed + speed) * period_s);
        let leashed = position.min(sense * actual.position + LEASH_REV);
        State { position: sense * leashed, velocity: sense * speed, acceleration: -sense * braking, jerk: 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::{FollowedStop, LEASH_REV, StopConfig};
    use crate::control::machine::Machine;
    use crate::control::math::poly::State;
    use crate::control::sync::frame::AxisCommands;

    const PERIOD_S: f64 = 0.001;
    const PITCH_MM: f64 = 1.25;
    const BESIDE_MM: f64 = -0.07;
    const SPEED_REV_PER_S: f64 = 50.0;
    const FORCE_N: f64 = 120.0;
    /// 796 rev/s² by 40 and 200 1/s.
    const BEHIND_REV: f64 = 0.0995;

    fn config() -> StopConfig {
        StopConfig {
            motor: Machine::reference().motor().clone(),
            position_gain_per_s: 40.0,
            velocity_gain_per_s: 200.0,
            counts_per_rev: 16_384.0,
            pitch_mm: PITCH_MM,
            period_s: PERIOD_S,
            horizon_s: PERIOD_S,
        }
    }

    /// A spindle that slows as it does, whatever it is told; its stop, checked in each period. Z stays
    /// near it. Returns the periods until Z is held and the spindle's angle then.
    fn stop(sense: f64, at_once: bool, braking_rev_per_s2: impl Fn(u32) -> f64) -> (u32, f64) {
        let mut stop = FollowedStop::new(config());
        let (mut angle, mut speed, mut last_z) = (0.0, SPEED_REV_PER_S, State::default());
        for _ in 0..300 {
            angle += speed * PERIOD_S;
            stop.observe(sense * angle);
            let z = State { position: PITCH_MM * sense * (angle + speed * PERIOD_S) + BESIDE_MM, ..State::default() };
            stop.note(&AxisCommands { z, z_force_n: FORCE_N, ..AxisCommands::default() }, 0.0);
            last_z = z;
        }
        let mut sent =
            State { position: sense * (angle + 0.05), velocity: sense * SPEED_REV_PER_S, ..State::default() };
        assert!(!stop.is_under_way() && stop.step(&sent).is_none());
        stop.begin(&sent, State { velocity: PITCH_MM * sense * SPEED_REV_PER_S, ..last_z }, at_once);
        let mut held = None::<(u32, f64)>;
        for k in 0..5000 {
            let slower = (speed - braking_rev_per_s2(k) * PERIOD_S).max(0.0);
            angle += 0.5 * (speed + slower) * PERIOD_S;
            speed = slower;
            stop.observe(sense * angle);
            let actual = stop.observer.predict(PERIOD_S);
            let AxisCommands { spindle, z, spindle_torque_nm, z_force_n } = stop.step(&sent).expect("under way");
            let ahead = sense * (spindle.position - actual.position);
            assert!((-BEHIND_REV - 0.01..=LEASH_REV + 1e-3).contains(&ahead), "{k}: {ahead} {spindle:?} {actual:?}");
            assert!(
                spindle.acceleration * sense <= 0.4 * 796.0 && spindle.velocity * sense < SPEED_REV_PER_S + 5.0,
                "{k}: {spindle:?}"
            );
            assert_eq!(spindle_torque_nm, 0.0);
            assert!((z_force_n - FORCE_N).abs() < 1e-9);
            match held {
                // What is held stays, to the bit.
                Some((_, z_mm)) => {
                    assert_eq!((z.position, z.velocity, spindle.velocity), (z_mm, 0.0, 0.0));
                }
                None if stop.under_way.is_some_and(|under_way| under_way.held_mm.is_some()) => {
                    held = Some((k, z.position));
                }
                None => assert!((z.position - PITCH_MM * actual.position - BESIDE_MM).abs() < 1e-3, "{k}: {z:?}"),
            }
            sent = spindle;
        }
        let (k, z_mm) = held.expect("it comes to rest");
        assert!((z_mm - sense * PITCH_MM * angle - BESIDE_MM).abs() < 0.002, "Z is held where the spindle rests");
        assert_eq!(stop.end(), Some(sent.position));
        (k, sense * angle)
    }

    #[test]
    fn a_weak_brake_takes_its_time_and_z_goes_with_it() {
        for sense in [1.0, -1.0] {
            // A quarter of the motor's torque: 0.25 s, and the rest of both axes.
            let (k, _) = stop(sense, false, |_| 200.0);
            assert!((250..320).contains(&k), "{k}");
        }
    }

    #[test]
    fn a_coasting_spindle_is_followed_to_its_end() {
        let (k, angle) = stop(1.0, false, |_| 25.0);
        assert!((1980..2100).contains(&k), "{k}");
        assert!((angle - (15.0 + 50.0)).abs() < 0.1, "{angle}");
    }

    #[test]
    fn a_jam_is_followed_into_its_halt() {
        for braking in [5_000.0, 20_000.0, 60_000.0] {
            let (k, _) = stop(1.0, true, |_| braking);
            assert!(k < 80, "{braking}: {k}");
        }
        // It sticks, is torn loose, and sticks again.
        stop(-1.0, true, |k| if k.is_multiple_of(7) { 4000.0 } else { 0.0 });
    }

    /// The drive's loops ask for all of the torque, and for no more: a command that lags further would be run after.
    #[test]
    fn a_spindle_that_outruns_its_command_is_braked_by_the_loops_alone() {
        let config = config();
        let actual = State { position: 3.0, velocity: 40.0, ..State::default() };
        for lag_rev in [0.0, 0.05, BEHIND_REV, 0.2] {
            let position = actual.position - lag_rev - 10.0 * PERIOD_S;
            let sent = State { position, velocity: 10.0, ..State::default() };
            let command = config.brake(&sent, &actual);
            let asked = 200.0 * (actual.velocity - command.velocity + 40.0 * lag_rev);
            assert!((asked - 796.0).abs() < 1.0, "{lag_rev}: {asked} rev/s²");
        }
    }

    /// The drive goes where it is sent, by an encoder of its own; the one that is told counts 2 % more.
    #[test]
    fn spindle_that_its_own_encoder_pulls_on_comes_to_rest() {
        let mut stop = FollowedStop::new(config());
        let mut sent = State { velocity: SPEED_REV_PER_S, ..State::default() };
        for _ in 0..300 {
            sent.position += SPEED_REV_PER_S * PERIOD_S;
            stop.observe(1.02 * sent.position);
        }
        let z = State { position: PITCH_MM * sent.position, ..State::default() };
        stop.begin(&sent, z, false);
        let mut fastest: f64 = 0.0;
        for _ in 0..2000 {
            let Some(commands) = stop.step(&sent) else { panic!("a stop is under way") };
            sent = commands.spindle;
            fastest = fastest.max(sent.velocity);
            stop.observe(1.02 * sent.position);
        }
        assert!(fastest <= 1.3 * SPEED_REV_PER_S && sent.velocity == 0.0, "{fastest} {sent:?}");
    }
}
