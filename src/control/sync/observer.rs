//! The observer of the spindle: filters what its encoder measured, and predicts it to the instant that Z acts.
//!
//! It observes the tracking error, measured less planned, through the drive's closed loop, or the angle itself where Z
//! follows the spindle alone.

use crate::control::machine::DriveSpec;
use crate::control::math::{exp, poly::State};
use crate::control::model::closed_loop::{ClosedLoop, LoopState};

/// Steps of a prediction over a few periods: the velocity loop's time constant is a little longer.
const STEPS: u32 = 4;

/// A fading-memory observer with three equal poles in position, rate and disturbance. Its model is the drive's closed loop.
/// While the drive is saturated its loops are cut off, and plain integrators remain.
///
/// Gains are those of the critically damped filter of third order (Brookner, Tracking and Kalman Filtering Made Easy, 1998);
/// the disturbance state is that of a disturbance observer (Ohnishi 1987).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct SpindleObserver {
    /// None where the spindle's angle itself is followed.
    loops: Option<ClosedLoop>,
    period_s: f64,
    /// Corrections of position, velocity and disturbance by the innovation.
    gains: [f64; 3],
    motion: LoopState,
    saturated: bool,
}

impl SpindleObserver {
    /// For the angle itself, with poles at a rate.
    pub(super) fn of_angle(period_s: f64, rad_per_s: f64) -> Self {
        let pole = exp(-rad_per_s * period_s);
        let rest = 1.0 - pole;
        Self {
            loops: None,
            period_s,
            gains: [
                1.0 - pole * pole * pole,
                1.5 * rest * rest * (1.0 + pole) / period_s,
                rest * rest * rest / (period_s * period_s),
            ],
            motion: LoopState::default(),
            saturated: false,
        }
    }

    /// For the tracking error under a drive; `inertia_ratio` is the real inertia per torque over the drive's.
    pub(super) fn of_tracking_error(drive: &DriveSpec, period_s: f64, rad_per_s: f64, inertia_ratio: f64) -> Self {
        let nominal = ClosedLoop::of_spindle(drive);
        let loops = ClosedLoop { velocity_gain_per_s: nominal.velocity_gain_per_s / inertia_ratio, ..nominal };
        Self { loops: Some(loops), ..Self::of_angle(period_s, rad_per_s) }
    }

    /// At rest at an angle or error.
    pub(super) fn rest_at(&mut self, position: f64) {
        self.motion = LoopState { position, ..LoopState::default() };
    }

    /// Takes in a measurement, one period after the last.
    pub(super) fn update(&mut self, measured_rev: f64, saturated: bool) {
        self.saturated = saturated;
        let before = self.after(self.motion, self.period_s);
        let innovation = measured_rev - before.position;
        let [position, velocity, disturbance] = self.gains;
        self.motion = LoopState {
            position: before.position + position * innovation,
            velocity: before.velocity + velocity * innovation,
            disturbance: before.disturbance + disturbance * innovation,
            ..before
        };
    }

    /// The motion some time after the last measurement; its acceleration is what the model does not explain.
    pub(super) fn predict(&self, horizon_s: f64) -> State {
        let step_s = horizon_s / f64::from(STEPS);
        let ahead = (0..STEPS).fold(self.motion, |motion, _| self.after(motion, step_s));
        State { position: ahead.position, velocity: ahead.velocity, acceleration: ahead.disturbance, jerk: 0.0 }
    }

    /// The motion after a step.
    fn after(&self, from: LoopState, step_s: f64) -> LoopState {
        match &self.loops {
            Some(loops) if !self.saturated => loops.after(from, step_s),
            _ => LoopState {
                position: from.position + step_s * (from.velocity + 0.5 * step_s * from.disturbance),
                velocity: from.velocity + step_s * from.disturbance,
                ..from
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::SpindleObserver;
    use crate::control::machine::Machine;

    const PERIOD_S: f64 = 0.001;

    #[test]
    fn constant_acceleration_is_predicted_exactly() {
        let mut observer = SpindleObserver::of_angle(PERIOD_S, 500.0);
        let angle = |t: f64| 3.0 * t + 0.5 * 400.0 * t * t;
        for k in 0..200 {
            observer.update(angle(f64::from(k) * PERIOD_S), false);
        }
        let ahead = observer.predict(0.0017);
        assert!((ahead.position - angle(0.199 + 0.0017)).abs() < 1e-9, "{ahead:?}");
        assert!((ahead.velocity - (3.0 + 400.0 * (0.199 + 0.0017))).abs() < 1e-6, "{ahead:?}");
    }

    /// A disturbance that steps, through the drive's loops integrated finely.
    #[test]
    fn disturbance_through_the_loops_is_predicted_better_than_without_them() {
        let drive = Machine::reference().spec().drive;
        let (kp, kv, ti) =
            (drive.spindle_position_gain_per_s, drive.spindle_velocity_gain_per_s, drive.spindle_integral_s);
        let (mut position, mut velocity, mut integral) = (0.0, 0.0, 0.0);
        let fine_s = 1e-6;
        let mut truth = Vec::new();
        for _ in 0..100_000 {
            truth.push(position);
            let error = velocity + kp * position;
            velocity += fine_s * (100.0 - kv * error - integral);
            integral += fine_s * kv / ti * error;
            position += fine_s * velocity;
        }
        let worst = |mut observer: SpindleObserver| {
            let mut worst: f64 = 0.0;
            // Ten periods to converge.
            for k in 0..95 {
                observer.update(truth[k * 1000], false);
                if k >= 10 {
                    worst = worst.max((observer.predict(0.002).position - truth[k * 1000 + 2000]).abs());
                }
            }
            worst
        };
        let with = worst(SpindleObserver::of_tracking_error(&drive, PERIOD_S, 500.0, 1.0));
        let without = worst(SpindleObserver::of_angle(PERIOD_S, 500.0));
        assert!(with < 0.7 * without, "{with} {without}");
    }
}
