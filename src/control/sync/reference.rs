//! What to command so that a drive sees no error while its axis does what is wanted.

use crate::control::math::exp;

/// A position loop with velocity feedforward compares its reference with what its encoders say, and those speak late and
/// not alike: position by the encoder's age, velocity by the filter too, for Z of the motor instead of the table. With
/// p̂ and v̂ as they will read when the axis moves as wanted, the loops are still where p_ref' + Kp·p_ref = v̂ + Kp·p̂.
/// Written for w = p_ref − p̂, that is w' + Kp·w = v̂ − p̂': a first-order lag, held exactly over a period.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Reference {
    position_gain_per_s: f64,
    decay: f64,
    lead: f64,
    last_difference: f64,
}

impl Reference {
    pub(super) fn new(position_gain_per_s: f64, period_s: f64) -> Self {
        Self { position_gain_per_s, decay: exp(-position_gain_per_s * period_s), lead: 0.0, last_difference: 0.0 }
    }

    /// Goes on from a lead that is left of an earlier command.
    pub(super) fn begin(&mut self, lead: f64) {
        self.lead = lead;
    }

    /// Position and velocity to command, for the position that the encoder will read, its rate of change, and the
    /// velocity that the loop will see.
    pub(super) fn command(&mut self, position: f64, rate: f64, seen_velocity: f64) -> (f64, f64) {
        let difference = seen_velocity - rate;
        let mean = 0.5 * (difference + self.last_difference);
        self.last_difference = difference;
        self.lead = self.decay * self.lead + (1.0 - self.decay) / self.position_gain_per_s * mean;
        (position + self.lead, seen_velocity - self.position_gain_per_s * self.lead)
    }
}

#[cfg(test)]
mod tests {
    use super::Reference;

    /// At rest the lead that is left falls, and its velocity is what the loop makes of it.
    #[test]
    fn what_is_left_is_not_felt() {
        let mut reference = Reference::new(40.0, 0.001);
        reference.begin(0.005);
        let (position, velocity) = (0..25).map(|_| reference.command(0.0, 0.0, 0.0)).last().unwrap();
        assert!((position - 0.005 * (-1.0_f64).exp()).abs() < 1e-12);
        assert!((velocity + 40.0 * position).abs() < 1e-12);
    }

    /// A loop in fine steps: the axis follows its reference perfectly with a delay of the velocity reading.
    #[test]
    fn loop_error_vanishes() {
        let (gain, period_s, late_s) = (40.0, 0.001, 0.0003);
        let mut reference = Reference::new(gain, period_s);
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
