//! The synchronous stop of a spindle that does not follow its command: it brakes with what torque there is, and Z follows
//! where it really is.

use crate::control::math::poly::State;
use crate::control::motor::Motor;
use crate::control::sync::frame::AxisCommands;
use crate::control::sync::observer::SpindleObserver;

/// The command stays so near to the measured spindle that its drive brakes with all it has, and does not run after it later.
const LEASH_REV: f64 = 0.02;
/// At rest below this speed, for so many periods.
const REST_REV_PER_S: f64 = 0.05;
const REST_PERIODS: u32 = 10;

/// What a followed stop is made of.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct StopConfig {
    pub(super) motor: Motor,
    pub(super) pitch_mm: f64,
    pub(super) period_s: f64,
    /// From a sample of the spindle to the instant that Z acts on it.
    pub(super) horizon_s: f64,
}

/// A followed stop under way, positive into the hole.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct FollowedStop {
    spindle: State,
    /// Z's reference beside the spindle's travel, as it was before the fault.
    z_beside_mm: f64,
    z_force_n: f64,
    rest_periods: u32,
    /// Where Z is held once both rest: counts that flicker move nothing.
    held_mm: Option<f64>,
}

impl FollowedStop {
    /// Begins from the spindle's last command, with what Z's reference and force had beside it.
    pub(super) fn new(spindle: State, z_beside_mm: f64, z_force_n: f64) -> Self {
        Self { spindle, z_beside_mm, z_force_n, rest_periods: 0, held_mm: None }
    }

    /// Where the spindle is commanded to be.
    pub(super) fn spindle_rev(&self) -> f64 {
        self.spindle.position
    }

    /// One period.
    pub(super) fn step(&mut self, config: &StopConfig, observer: &SpindleObserver) -> AxisCommands {
        let StopConfig { motor, pitch_mm, period_s, horizon_s } = config;
        if let Some(position) = self.held_mm {
            let z = State { position, ..State::default() };
            let spindle = State { position: self.spindle.position, ..State::default() };
            return AxisCommands { spindle, z, z_force_n: self.z_force_n, ..AxisCommands::default() };
        }
        let actual = observer.predict(*horizon_s);
        let direction = if self.spindle.velocity < 0.0 { -1.0 } else { 1.0 };
        let braked = motor.acceleration_rev_per_s2(self.spindle.velocity.abs(), 1.0) * *period_s;
        // It never rises: a command that took over the measured speed would drive what it follows.
        let actual_speed = (direction * actual.velocity).max(0.0);
        let speed = (self.spindle.velocity.abs() - braked).max(0.0).min(actual_speed);
        let velocity = direction * speed;
        let free = self.spindle.position + 0.5 * (self.spindle.velocity + velocity) * *period_s;
        let position = free.max(actual.position - LEASH_REV).min(actual.position + LEASH_REV);
        let acceleration = (velocity - self.spindle.velocity) / *period_s;
        self.spindle = State { position, velocity, acceleration, jerk: 0.0 };
        let rests = velocity.abs() < REST_REV_PER_S && actual.velocity.abs() < REST_REV_PER_S;
        self.rest_periods = if rests { self.rest_periods.saturating_add(1) } else { 0 };
        let z = State {
            position: pitch_mm * actual.position + self.z_beside_mm,
            velocity: pitch_mm * actual.velocity,
            acceleration: pitch_mm * actual.acceleration,
            jerk: 0.0,
        };
        self.held_mm = (self.rest_periods >= REST_PERIODS).then_some(z.position);
        AxisCommands { spindle: self.spindle, z, spindle_torque_nm: 0.0, z_force_n: self.z_force_n }
    }
}

#[cfg(test)]
mod tests {
    use super::{FollowedStop, LEASH_REV, StopConfig};
    use crate::control::machine::Machine;
    use crate::control::math::poly::State;
    use crate::control::sync::observer::SpindleObserver;

    const PERIOD_S: f64 = 0.001;
    const PITCH_MM: f64 = 1.25;
    const BESIDE_MM: f64 = -0.07;
    const SPEED_REV_PER_S: f64 = 50.0;
    const FORCE_N: f64 = 120.0;

    /// A spindle that slows as it does, whatever it is told; its stop, checked in each period. Returns the periods until Z is
    /// held and the spindle's angle then.
    fn stop(sense: f64, braking_rev_per_s2: impl Fn(u32) -> f64) -> (u32, f64) {
        let config = StopConfig {
            motor: Machine::reference().motor().clone(),
            pitch_mm: PITCH_MM,
            period_s: PERIOD_S,
            horizon_s: PERIOD_S,
        };
        let mut observer = SpindleObserver::of_angle(PERIOD_S, 1000.0);
        let (mut angle, mut speed) = (0.0, SPEED_REV_PER_S);
        for _ in 0..100 {
            angle += speed * PERIOD_S;
            observer.update(sense * angle, false);
        }
        let command = State { position: sense * (angle + 0.05), velocity: sense * SPEED_REV_PER_S, ..State::default() };
        let mut stop = FollowedStop::new(command, BESIDE_MM, FORCE_N);
        let (mut last, mut held) = (command, None::<(u32, f64)>);
        for k in 0..5000 {
            let slower = (speed - braking_rev_per_s2(k) * PERIOD_S).max(0.0);
            angle += 0.5 * (speed + slower) * PERIOD_S;
            speed = slower;
            observer.update(sense * angle, false);
            let axes = stop.step(&config, &observer);
            let (spindle, actual) = (axes.spindle, observer.predict(PERIOD_S));
            assert!((spindle.position - actual.position).abs() <= LEASH_REV + 1e-12, "{k}: {spindle:?} {actual:?}");
            assert!(
                spindle.velocity.abs() <= last.velocity.abs() && spindle.velocity * sense >= 0.0,
                "{k}: {spindle:?}"
            );
            assert_eq!((axes.spindle_torque_nm, axes.z_force_n, stop.spindle_rev()), (0.0, FORCE_N, spindle.position));
            match held {
                // What is held stays, to the bit.
                Some((_, z_mm)) => {
                    assert_eq!((axes.z.position, axes.z.velocity, spindle.velocity), (z_mm, 0.0, 0.0));
                }
                None if axes.z.velocity == 0.0 && speed == 0.0 => held = Some((k, axes.z.position)),
                None => {
                    assert!((axes.z.position - PITCH_MM * actual.position - BESIDE_MM).abs() < 1e-12);
                    if speed == 0.0 && spindle.velocity == 0.0 && k > 3000 {
                        held = Some((k, axes.z.position));
                    }
                }
            }
            last = spindle;
        }
        let (k, z_mm) = held.expect("it comes to rest");
        assert!((z_mm - sense * PITCH_MM * angle - BESIDE_MM).abs() < 0.002, "Z is held where the spindle rests");
        (k, sense * angle)
    }

    #[test]
    fn a_weak_brake_takes_its_time_and_z_goes_with_it() {
        for sense in [1.0, -1.0] {
            // A quarter of the motor's torque: 0.25 s, and the rest of both axes.
            let (k, _) = stop(sense, |_| 200.0);
            assert!((250..320).contains(&k), "{k}");
        }
    }

    #[test]
    fn a_coasting_spindle_is_followed_to_its_end() {
        let (k, angle) = stop(1.0, |_| 25.0);
        assert!((2000..2100).contains(&k), "{k}");
        assert!((angle - (5.0 + 50.0)).abs() < 0.1, "{angle}");
    }

    #[test]
    fn a_jam_is_followed_into_its_halt() {
        for braking in [5_000.0, 20_000.0, 60_000.0] {
            let (k, _) = stop(1.0, |_| braking);
            assert!(k < 60, "{braking}: {k}");
        }
        // It sticks, is torn loose, and sticks again.
        stop(-1.0, |k| if k.is_multiple_of(7) { 4000.0 } else { 0.0 });
    }
}
