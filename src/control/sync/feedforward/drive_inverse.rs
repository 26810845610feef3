//! What is sent to a drive that takes less of a setpoint than all of it, so that its own loops make of it what they are not told.
//!
//! A position loop (Kp) around a velocity loop with integral part (Kv, Ti) gives the acceleration
//! Kv·e + Kv/Ti·∫e, e = v_ff + Kp·(p_ref − p) − v, beside what it is told of acceleration and force. To give u = a + f/m unasked
//! it has to see e = w, w = Ti·s/(Ti·s + 1)·u/Kv: what its integrator has not taken over yet. So its reference is the
//! commanded motion (p, v) and
//!
//! - of a drive that takes a position alone p + (v + w)/Kp;
//! - of one that takes a velocity, too, p + o and v + o' with o' + Kp·o = w: position and velocity stay those of one motion,
//!   since a drive that interpolates between setpoints goes by both;
//! - of one that takes a speed alone v + w, half a period early, since it holds it until the next.
//!
//! It is the inverse of a control loop in front of it (Tomizuka 1987, without its unstable zeros: these loops have none). All of
//! it is linear, and a high-pass of first order answers with twice its input at most: what is sent is bounded as the commanded
//! motion is, and stands beside it by (v + 2·u/Kv)/Kp at most.

use crate::control::machine::Takes;
use crate::control::math::{exp, poly::State};
use crate::control::model::closed_loop::ClosedLoop;
use crate::control::model::washout::Washout;

/// One drive's inverse with its state, in units of the axis, machine coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::control::sync) struct DriveInverse {
    takes: Takes,
    loops: ClosedLoop,
    period_s: f64,
    effort_per_acceleration: f64,
    /// What a period leaves of an offset of the position reference.
    offset_kept: f64,
    /// Of the acceleration that the drive is to give.
    washout: Washout,
    /// w and o of the last period.
    error: f64,
    offset: f64,
}

impl DriveInverse {
    /// For a drive that takes so much, and an axis at rest; `effort_per_acceleration` is what accelerates it by one unit/s².
    pub(in crate::control::sync) fn new(
        takes: Takes,
        loops: ClosedLoop,
        effort_per_acceleration: f64,
        period_s: f64,
    ) -> Self {
        Self {
            takes,
            loops,
            period_s,
            effort_per_acceleration,
            offset_kept: exp(-loops.position_gain_per_s * period_s),
            washout: Washout::new(loops.integral_s, period_s),
            error: 0.0,
            offset: 0.0,
        }
    }

    /// Goes on from a reference that stands so far beside its target at rest.
    pub(in crate::control::sync) fn rest_beside(&mut self, offset: f64) {
        if self.takes == Takes::Position {
            self.error = self.loops.position_gain_per_s * offset;
            self.washout.rest(0.0, self.loops.velocity_gain_per_s * self.error);
        }
    }

    /// The drive's gains are others than were thought, and its axis rests.
    pub(in crate::control::sync) fn take_loops(&mut self, loops: ClosedLoop) {
        self.loops = loops;
        self.offset_kept = exp(-loops.position_gain_per_s * self.period_s);
    }

    /// One period: the setpoint for a commanded motion, and an effort beyond its acceleration's. What the drive does not take of it
    /// stays as it was commanded, but the effort, which is 0 then.
    pub(in crate::control::sync) fn setpoint(&mut self, command: &State, effort: f64) -> (State, f64) {
        if self.takes == Takes::Torque {
            return (*command, effort);
        }
        let error_before = self.error;
        let ClosedLoop { position_gain_per_s, velocity_gain_per_s, .. } = self.loops;
        let asked = command.acceleration + effort / self.effort_per_acceleration;
        self.error = self.washout.step(asked) / velocity_gain_per_s;
        let setpoint = match self.takes {
            Takes::Position => command.shifted((command.velocity + self.error) / position_gain_per_s),
            Takes::Velocity => {
                let mean = 0.5 * (self.error + error_before);
                self.offset = self.offset_kept * self.offset + (1.0 - self.offset_kept) / position_gain_per_s * mean;
                let velocity = command.velocity + self.error - position_gain_per_s * self.offset;
                State { velocity, ..command.shifted(self.offset) }
            }
            Takes::Speed | Takes::Torque => {
                let half_s = 0.5 * self.period_s;
                let rate = command.acceleration + (self.error - error_before) / self.period_s;
                State { velocity: command.velocity + self.error + half_s * rate, ..*command }
            }
        };
        (setpoint, 0.0)
    }

    /// How far a position reference stands beside the commanded position at most, for a motion and an effort within limits: a
    /// high-pass of first order answers with twice its input at most.
    #[cfg(test)]
    pub(in crate::control::sync) fn most_beside(&self, speed: f64, acceleration: f64, effort: f64) -> f64 {
        let ClosedLoop { position_gain_per_s, velocity_gain_per_s, .. } = self.loops;
        let error = 2.0 * (acceleration + effort / self.effort_per_acceleration) / velocity_gain_per_s;
        match self.takes {
            Takes::Position => (speed + error) / position_gain_per_s,
            Takes::Velocity => error / position_gain_per_s,
            Takes::Speed | Takes::Torque => 0.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::DriveInverse;
    use crate::control::machine::Takes;
    use crate::control::math::poly::State;
    use crate::control::model::cascade::{Cascade, CascadeGains, Measured};
    use crate::control::model::closed_loop::ClosedLoop;

    const PERIOD_S: f64 = 0.001;
    const TICK_S: f64 = 0.000_05;
    const TICKS: u32 = 20;
    const LOOPS: ClosedLoop = ClosedLoop { position_gain_per_s: 40.0, velocity_gain_per_s: 500.0, integral_s: 0.01 };
    /// N per mm/s² of 600 kg.
    const KG_M_PER_MM: f64 = 0.6;

    fn inverse(takes: Takes) -> DriveInverse {
        DriveInverse::new(takes, LOOPS, KG_M_PER_MM, PERIOD_S)
    }

    /// 30 mm to and fro, from rest, 0.1 s and back.
    fn motion(t_s: f64) -> State {
        let rad_per_s = 20.0 * core::f64::consts::PI;
        let (sin, cos) = (rad_per_s * t_s).sin_cos();
        State {
            position: 15.0 * (1.0 - cos),
            velocity: 15.0 * rad_per_s * sin,
            acceleration: 15.0 * rad_per_s * rad_per_s * cos,
            jerk: 0.0,
        }
    }

    /// What a rigid axis under such a drive is off the commanded motion at most, mm, against a force that its drive has to find. It
    /// is commanded from rest: the acceleration of the first period comes as a ramp.
    fn off_mm(takes: Takes, force_n: f64) -> f64 {
        let mut inverse = inverse(takes);
        let gains = CascadeGains {
            period_s: TICK_S,
            position_gain_per_s: LOOPS.position_gain_per_s,
            velocity_gain_per_s: LOOPS.velocity_gain_per_s,
            integral_s: LOOPS.integral_s,
            velocity_filter_s: 0.0,
            effort_per_acceleration: KG_M_PER_MM,
        };
        let mut drive = Cascade::new(gains, 0.0);
        let (mut position, mut velocity) = (0.0, 0.0);
        let ramp = |t_s: f64| force_n * (t_s / 0.02).clamp(0.0, 1.0);
        let sent = |inverse: &mut DriveInverse, t_s: f64| inverse.setpoint(&motion(t_s), ramp(t_s));
        let (mut from, mut greatest) = (sent(&mut inverse, 0.0), 0.0_f64);
        for k in 0..200 {
            let start_s = f64::from(k) * PERIOD_S;
            let to = sent(&mut inverse, start_s + PERIOD_S);
            for tick in 0..TICKS {
                let u = f64::from(tick) / f64::from(TICKS);
                let between = |of: fn(&State) -> f64| of(&from.0) + u * (of(&to.0) - of(&from.0));
                let position_between = between(|state| state.position);
                let taken = match takes {
                    Takes::Torque => State {
                        velocity: between(|state| state.velocity),
                        acceleration: between(|state| state.acceleration),
                        ..motion(start_s + u * PERIOD_S)
                    },
                    Takes::Velocity => State {
                        position: position_between,
                        velocity: between(|state| state.velocity),
                        ..State::default()
                    },
                    _ => State { position: position_between, ..State::default() },
                };
                let force_fed_n = if takes == Takes::Torque { from.1 + u * (to.1 - from.1) } else { 0.0 };
                let measured = Measured { position, motor_position: position };
                let effort_n = drive.step(&taken, force_fed_n, measured, 1e9).effort;
                let acceleration = (effort_n - ramp(start_s + u * PERIOD_S)) / KG_M_PER_MM;
                position += TICK_S * velocity + 0.5 * TICK_S * TICK_S * acceleration;
                velocity += TICK_S * acceleration;
            }
            greatest = greatest.max((position - motion(start_s + PERIOD_S).position).abs());
            from = to;
        }
        greatest
    }

    /// 59 m/s² and 3000 N, all of it given by the drive's own loops. Without the inverse it would be 24 mm off.
    #[test]
    fn loops_give_what_they_are_not_told() {
        let told_mm = off_mm(Takes::Torque, 3000.0);
        for takes in [Takes::Position, Takes::Velocity] {
            let found_mm = off_mm(takes, 3000.0);
            assert!(found_mm < told_mm + 0.02, "{takes:?}: {found_mm} against {told_mm} mm");
        }
    }

    #[test]
    fn what_takes_all_is_sent_all() {
        let mut inverse = inverse(Takes::Torque);
        assert_eq!(inverse.setpoint(&motion(0.03), 77.0), (motion(0.03), 77.0));
    }

    /// Any motion within limits, and one that goes from one limit to the other as its integrator is worst off.
    #[test]
    fn references_are_bounded_as_the_motion_is() {
        for takes in [Takes::Position, Takes::Velocity] {
            let most = inverse(takes).most_beside(500.0, 10_000.0, 3000.0);
            for half_period in [1, 3, 10, 100] {
                let mut inverse = inverse(takes);
                let mut greatest: f64 = 0.0;
                for k in 0..1000 {
                    let side = if (k / half_period) % 2 == 0 { 1.0 } else { -1.0 };
                    let command = State { velocity: side * 500.0, acceleration: side * 10_000.0, ..State::default() };
                    let (sent, effort) = inverse.setpoint(&command, side * 3000.0);
                    assert_eq!(effort, 0.0);
                    greatest = greatest.max(sent.position.abs());
                }
                assert!(greatest <= most, "{takes:?} {half_period}: {greatest} of {most}");
                assert!(takes == Takes::Velocity || greatest > 0.8 * most, "{half_period}: {greatest} of {most}");
            }
        }
    }

    /// An integrator that has not taken over yet goes on doing so.
    #[test]
    fn a_reference_beside_its_target_decays_with_the_integral_time() {
        let mut inverse = inverse(Takes::Position);
        inverse.rest_beside(0.02);
        let left_mm = (0..10).map(|_| inverse.setpoint(&State::default(), 0.0).0.position).last().unwrap();
        assert!((left_mm - 0.02 * (-1.0_f64).exp()).abs() < 1e-9, "{left_mm}");
    }
}
