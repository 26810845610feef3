//! Inverse prefilter of a drive's position loop: the reference with which the drive sees no error while its axis moves as
//! planned (zero-phase tracking after Tomizuka 1987, for a loop whose encoders read late).

use crate::control::math::exp;

/// A position loop with velocity feedforward compares its references with encoder readings of different age: the position is
/// late by the encoder's latency, the velocity by its filter as well, and Z's velocity is the motor's, not the load's. With
/// p̂ and v̂ as they will read when the axis moves as planned, the loops see no error where p_ref' + Kp·p_ref = v̂ + Kp·p̂.
/// Written for w = p_ref − p̂ this is w' + Kp·w = v̂ − p̂', a first-order lag that is solved exactly over a period.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::control::sync) struct PositionLoopInverse {
    position_gain_per_s: f64,
    decay: f64,
    /// w of the last period.
    offset: f64,
    last_difference: f64,
}

impl PositionLoopInverse {
    /// Goes on from an offset of the reference that an earlier command left.
    pub(in crate::control::sync) fn new(position_gain_per_s: f64, period_s: f64, offset: f64) -> Self {
        Self { position_gain_per_s, decay: exp(-position_gain_per_s * period_s), offset, last_difference: 0.0 }
    }

    /// Position and velocity reference, for the position that the encoder will read, its rate of change, and the velocity
    /// that the velocity loop will read.
    pub(in crate::control::sync) fn command(&mut self, position: f64, rate: f64, read_velocity: f64) -> (f64, f64) {
        let difference = read_velocity - rate;
        let mean = 0.5 * (difference + self.last_difference);
        self.last_difference = difference;
        self.offset = self.decay * self.offset + (1.0 - self.decay) / self.position_gain_per_s * mean;
        (position + self.offset, read_velocity - self.position_gain_per_s * self.offset)
    }
}

#[cfg(test)]
mod tests {
    use super::PositionLoopInverse;

    /// At rest the offset decays, and its velocity reference is what the position loop makes of it.
    #[test]
    fn an_offset_decays_unseen_by_the_loop() {
        let mut reference = PositionLoopInverse::new(40.0, 0.001, 0.005);
        let (position, velocity) = (0..25).map(|_| reference.command(0.0, 0.0, 0.0)).last().unwrap();
        assert!((position - 0.005 * (-1.0_f64).exp()).abs() < 1e-12);
        assert!((velocity + 40.0 * position).abs() < 1e-12);
    }

    /// A loop in fine steps: the axis follows its reference perfectly with a delay of the velocity reading.
    #[test]
    fn loop_error_vanishes() {
        let (gain, period_s, late_s) = (40.0, 0.001, 0.0003);
        let mut reference = PositionLoopInverse::new(gain, period_s, 0.0);
        let wanted = |t: f64| 1.0 - (20.0 * t).cos();
        let speed = |t: f64| 20.0 * (20.0 * t).sin();
        let mut greatest: f64 = 0.0;
        for k in 0..500 {
            let t = f64::from(k) * period_s;
            let (position, velocity) = reference.command(wanted(t), speed(t), speed(t - late_s));
            let error = velocity + gain * (position - wanted(t)) - speed(t - late_s);
            greatest = greatest.max(error.abs());
        }
        assert!(greatest < 1e-9, "{greatest}");
        // Without it the loop would see the velocity's delay.
        assert!((speed(0.25) - speed(0.25 - late_s)).abs() > 0.01);
    }
}
