//! What the spring between motor and load is not linear in: backlash, and an error of the travel that it transmits.

use crate::control::model::two_mass::TwoMass;

/// The spring's end: where it has no force, and by how much the load's place of rest is off the motor's.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Gap {
    stiffness: f64,
    damping: f64,
    half_backlash: f64,
    /// Share of the damping that is gone inside the backlash.
    lost_damping: f64,
    /// Where the load rests beyond the motor; 0 of a perfect screw.
    error: f64,
    /// How that changes with the motor's travel, and with time.
    error_slope: f64,
    error_rate: f64,
    /// Neither an error nor damping that decays: backlash alone.
    is_plain: bool,
}

impl Gap {
    /// Of a spring with this backlash.
    pub(crate) fn new(model: &TwoMass, backlash: f64) -> Self {
        Self {
            stiffness: model.stiffness,
            damping: model.damping,
            half_backlash: backlash / 2.0,
            lost_damping: 0.0,
            error: 0.0,
            error_slope: 0.0,
            error_rate: 0.0,
            is_plain: true,
        }
    }

    /// The same with only this share of the damping inside the backlash.
    pub(crate) fn with_damping(self, share: f64) -> Self {
        Self { lost_damping: 1.0 - share, is_plain: share == 1.0, ..self }
    }

    /// From here on the load rests `error` beyond the motor.
    pub(crate) fn set_error(&mut self, error: f64, slope: f64, rate: f64) {
        (self.error, self.error_slope, self.error_rate, self.is_plain) = (error, slope, rate, false);
    }

    /// Moves the error on with the motor, by one plant step.
    #[inline]
    pub(crate) fn carry_error(&mut self, motor_travel: f64, step_s: f64) {
        self.error += self.error_slope * motor_travel + self.error_rate * step_s;
    }

    /// Whether there is neither an error nor damping that fades.
    #[inline(always)]
    pub(crate) fn is_plain(&self) -> bool {
        self.is_plain
    }

    /// The same as [`Gap::given_back`] of a gap that is plain.
    #[inline(always)]
    pub(crate) fn given_back_plain(&self, deflection: f64) -> f64 {
        self.stiffness * deflection.max(-self.half_backlash).min(self.half_backlash)
    }

    /// The effort on the motor, and against the load, by which the true spring differs from a linear one.
    #[inline(always)]
    pub(crate) fn given_back(&self, deflection: f64, motor_speed: f64, load_speed: f64) -> f64 {
        if self.is_plain {
            return self.given_back_plain(deflection);
        }
        self.given_back_of_all(deflection, motor_speed, load_speed)
    }

    #[inline(never)]
    fn given_back_of_all(&self, deflection: f64, motor_speed: f64, load_speed: f64) -> f64 {
        let stretch = deflection + self.error;
        let error_speed = self.error_slope * motor_speed + self.error_rate;
        let free = stretch.max(-self.half_backlash).min(self.half_backlash);
        let damped = if stretch.abs() < self.half_backlash {
            self.lost_damping * self.damping * (motor_speed - load_speed + error_speed)
        } else {
            0.0
        };
        self.stiffness * (free - self.error) - self.damping * error_speed + damped
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MODEL: TwoMass = TwoMass { motor_inertia: 400.0, load_inertia: 200.0, stiffness: 8e7, damping: 1e4 };

    /// What is left between motor and load: the linear spring and damper less what is given back.
    fn force(gap: &Gap, deflection: f64, motor_speed: f64, load_speed: f64) -> f64 {
        MODEL.stiffness * deflection + MODEL.damping * (motor_speed - load_speed)
            - gap.given_back(deflection, motor_speed, load_speed)
    }

    #[test]
    fn inside_the_backlash_damping_decays_with_stiffness() {
        for (share, left) in [(1.0, 100.0), (0.3, 30.0), (0.0, 0.0)] {
            let gap = Gap::new(&MODEL, 2e-6).with_damping(share);
            assert!((force(&gap, 0.5e-6, 0.03, 0.02) - left).abs() < 1e-9, "{share}");
            // On the flank spring and damper are whole.
            let on_flank = MODEL.stiffness * 0.5e-6 + 100.0;
            assert!((force(&gap, 1.5e-6, 0.03, 0.02) - on_flank).abs() < 1e-9, "{share}");
        }
    }

    #[test]
    fn an_error_of_the_screw_moves_the_place_of_rest() {
        let mut gap = Gap::new(&MODEL, 0.0);
        gap.set_error(3e-6, 2e-3, 0.0);
        assert!(force(&gap, -3e-6, 0.0, 0.0).abs() < 1e-9);
        // Where the error grows with the travel, a load at rest to it moves faster than the motor.
        assert!(force(&gap, -3e-6, 0.05, 0.05 * 1.002).abs() < 1e-9);
        gap.carry_error(1e-3, 25e-6);
        assert!(force(&gap, -5e-6, 0.0, 0.0).abs() < 1e-6);
    }
}
