//! The spindle as its encoder shows it: filtered, and predicted to the instant that Z acts. Its deviation from the plan,
//! where there is one, its angle itself where Z follows that alone.

use crate::control::machine::DriveSpec;
use crate::control::math::{exp, poly::State};

/// Steps of a prediction: its horizon is a few periods, the velocity loop's time constant some more.
const STEPS: u32 = 4;

/// A drive's loops as they answer a deviation.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Loops {
    position_gain_per_s: f64,
    velocity_gain_per_s: f64,
    integral_s: f64,
}

/// A motion with its rate, and the accelerations that change it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Motion {
    position: f64,
    velocity: f64,
    /// What the drive's integral gives.
    integral: f64,
    /// What nothing explains: wrong inertia, cutting, friction. Taken to stay as it is.
    disturbance: f64,
}

/// A filter of fading memory around the spindle's own motion: three equal poles in the position, its rate and the
/// disturbance, with the drive's closed loop as the model. While the drive is saturated its loops are cut off, and plain
/// integrators remain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Tracker {
    /// None where the spindle's angle itself is followed.
    loops: Option<Loops>,
    period_s: f64,
    /// Corrections of position, velocity and disturbance by what the model missed: the critically damped filter of third
    /// order (Brookner, Tracking and Kalman Filtering Made Easy, 1998).
    gains: [f64; 3],
    motion: Motion,
    saturated: bool,
}

impl Tracker {
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
            motion: Motion::default(),
            saturated: false,
        }
    }

    /// For the deviation from the plan under a drive; `inertia_ratio` is the real inertia per torque over the drive's.
    pub(super) fn of_deviation(drive: &DriveSpec, period_s: f64, rad_per_s: f64, inertia_ratio: f64) -> Self {
        let loops = Loops {
            position_gain_per_s: drive.spindle_position_gain_per_s,
            velocity_gain_per_s: drive.spindle_velocity_gain_per_s / inertia_ratio,
            integral_s: drive.spindle_integral_s,
        };
        Self { loops: Some(loops), ..Self::of_angle(period_s, rad_per_s) }
    }

    /// Takes in a measurement, one period after the last.
    pub(super) fn update(&mut self, measured_rev: f64, saturated: bool) {
        self.saturated = saturated;
        let before = self.after(self.motion, self.period_s);
        let missed = measured_rev - before.position;
        let [position, velocity, disturbance] = self.gains;
        self.motion = Motion {
            position: before.position + position * missed,
            velocity: before.velocity + velocity * missed,
            disturbance: before.disturbance + disturbance * missed,
            ..before
        };
    }

    /// Position and velocity some time after the last measurement.
    pub(super) fn predict(&self, horizon_s: f64) -> State {
        let step_s = horizon_s / f64::from(STEPS);
        let ahead = (0..STEPS).fold(self.motion, |motion, _| self.after(motion, step_s));
        State { position: ahead.position, velocity: ahead.velocity, ..State::default() }
    }

    /// The motion after a step.
    fn after(&self, from: Motion, step_s: f64) -> Motion {
        match &self.loops {
            Some(loops) if !self.saturated => loops.after(from, step_s),
            _ => Motion {
                position: from.position + step_s * (from.velocity + 0.5 * step_s * from.disturbance),
                velocity: from.velocity + step_s * from.disturbance,
                ..from
            },
        }
    }
}

impl Loops {
    /// The motion after a step; the velocity loop implicitly, since it is stiff.
    fn after(&self, from: Motion, step_s: f64) -> Motion {
        let kv = self.velocity_gain_per_s;
        let driven = from.disturbance - kv * self.position_gain_per_s * from.position - from.integral;
        let velocity = (from.velocity + step_s * driven) / (1.0 + step_s * kv);
        let mean_velocity = 0.5 * (from.velocity + velocity);
        let position = from.position + step_s * mean_velocity;
        let error = mean_velocity + self.position_gain_per_s * 0.5 * (from.position + position);
        Motion { position, velocity, integral: from.integral + kv / self.integral_s * step_s * error, ..from }
    }
}

#[cfg(test)]
mod tests {
    use super::Tracker;
    use crate::control::machine::Machine;

    const PERIOD_S: f64 = 0.001;

    #[test]
    fn constant_acceleration_is_predicted_exactly() {
        let mut tracker = Tracker::of_angle(PERIOD_S, 500.0);
        let angle = |t: f64| 3.0 * t + 0.5 * 400.0 * t * t;
        for k in 0..200 {
            tracker.update(angle(f64::from(k) * PERIOD_S), false);
        }
        let ahead = tracker.predict(0.0017);
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
        let worst = |mut tracker: Tracker| {
            let mut worst: f64 = 0.0;
            // The first ten periods show the disturbance.
            for k in 0..95 {
                tracker.update(truth[k * 1000], false);
                if k >= 10 {
                    worst = worst.max((tracker.predict(0.002).position - truth[k * 1000 + 2000]).abs());
                }
            }
            worst
        };
        let with = worst(Tracker::of_deviation(&drive, PERIOD_S, 500.0, 1.0));
        let without = worst(Tracker::of_angle(PERIOD_S, 500.0));
        assert!(with < 0.7 * without, "{with} {without}");
    }
}
