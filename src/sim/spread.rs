//! How machines of one kind differ: ranges of [`Actual`], from which a sweep draws.

use rand::{Rng, RngExt};

use super::Actual;

/// `[spread]`: least and greatest value of each number of [`Actual`]. Field names are the file's keys.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spread {
    /// Factor on the spindle's inertia.
    pub inertia: [f64; 2],
    /// Factor on the torque–speed curve.
    pub torque_limit: [f64; 2],
    /// Factor on torque per current.
    pub torque_constant: [f64; 2],
    /// Factor on friction.
    pub friction: [f64; 2],
    /// Factor on the spindle's torsional resonance.
    pub spindle_resonance: [f64; 2],
    /// Factor on Z's axial resonance.
    pub z_resonance: [f64; 2],
    /// Factor on the tapping torque.
    pub cutting_torque: [f64; 2],
    /// Factor on the encoders' interpolation errors and jitter.
    pub encoder_error: [f64; 2],
    /// Z's backlash.
    pub backlash_um: [f64; 2],
    /// Age of an encoder reading.
    pub encoder_latency_s: [f64; 2],
}

impl Default for Spread {
    /// What machines of one make and age differ by.
    fn default() -> Self {
        Self {
            inertia: [0.8, 1.2],
            torque_limit: [0.85, 1.0],
            torque_constant: [0.85, 1.0],
            friction: [0.5, 2.0],
            spindle_resonance: [0.8, 1.2],
            z_resonance: [0.8, 1.2],
            cutting_torque: [0.0, 2.0],
            encoder_error: [0.0, 2.0],
            backlash_um: [0.0, 5.0],
            encoder_latency_s: [10e-6, 100e-6],
        }
    }
}

impl Spread {
    /// One machine: every value uniform in its range and independent of the others.
    ///
    /// ```
    /// use rand::SeedableRng;
    /// use rigidtap::sim::Spread;
    /// let spread = Spread { friction: [2.0, 2.0], ..Spread::default() };
    /// let actual = spread.draw(&mut rand_pcg::Pcg64Mcg::seed_from_u64(1));
    /// assert_eq!(actual.friction, 2.0);
    /// assert!((0.8..=1.2).contains(&actual.inertia));
    /// ```
    pub fn draw(&self, random: &mut impl Rng) -> Actual {
        // Each draw takes one number of the generator, a range of no width too: the others stay as they were.
        let mut within = |[low, high]: [f64; 2]| (low + (high - low) * random.random::<f64>()).min(high);
        Actual {
            inertia: within(self.inertia),
            torque_limit: within(self.torque_limit),
            torque_constant: within(self.torque_constant),
            friction: within(self.friction),
            spindle_resonance: within(self.spindle_resonance),
            z_resonance: within(self.z_resonance),
            cutting_torque: within(self.cutting_torque),
            encoder_error: within(self.encoder_error),
            backlash_um: Some(within(self.backlash_um)),
            encoder_latency_s: Some(within(self.encoder_latency_s)),
        }
    }
}
