//! How machines of one kind differ: ranges of [`Actual`], from which a sweep draws.

use rand::Rng;

use super::actual::Actual;
use super::drawn::Drawn;

/// `[spread]`: what each of the first numbers of [`Actual`] is drawn from. Field names are the file's keys.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spread {
    /// Factor on the spindle's inertia.
    pub inertia: Drawn,
    /// Factor on the torque–speed curve.
    pub torque_limit: Drawn,
    /// Factor on torque per current.
    pub torque_constant: Drawn,
    /// Factor on friction.
    pub friction: Drawn,
    /// Factor on the spindle's torsional resonance.
    pub spindle_resonance: Drawn,
    /// Factor on Z's axial resonance.
    pub z_resonance: Drawn,
    /// Factor on the tapping torque.
    pub cutting_torque: Drawn,
    /// Factor on the encoders' interpolation errors and jitter.
    pub encoder_error: Drawn,
    /// Factor on Z's backlash.
    pub backlash: Drawn,
    /// Factor on the age of an encoder reading.
    pub encoder_latency: Drawn,
    /// Z's backlash in place of the factor.
    pub backlash_um: Option<Drawn>,
    /// Age of an encoder reading in place of the factor.
    pub encoder_latency_s: Option<Drawn>,
}

impl Default for Spread {
    /// What machines of one make and age differ by.
    fn default() -> Self {
        Self {
            inertia: Drawn::Within([0.8, 1.2]),
            torque_limit: Drawn::Within([0.85, 1.0]),
            torque_constant: Drawn::Within([0.85, 1.0]),
            friction: Drawn::Within([0.5, 2.0]),
            spindle_resonance: Drawn::Within([0.8, 1.2]),
            z_resonance: Drawn::Within([0.8, 1.2]),
            cutting_torque: Drawn::Within([0.0, 2.0]),
            encoder_error: Drawn::Within([0.0, 2.0]),
            backlash: Drawn::Within([0.0, 2.5]),
            encoder_latency: Drawn::Within([0.2, 2.0]),
            backlash_um: None,
            encoder_latency_s: None,
        }
    }
}

impl Spread {
    /// One machine: every value independent of the others. What only the hard spread has is as on the nominal machine.
    ///
    /// ```
    /// use rand::SeedableRng;
    /// use rigidtap::sim::Spread;
    /// let spread = Spread { friction: [2.0, 2.0].into(), ..Spread::default() };
    /// let actual = spread.draw(&mut rand_pcg::Pcg64Mcg::seed_from_u64(1));
    /// assert_eq!(actual.friction, 2.0);
    /// assert!((0.8..=1.2).contains(&actual.inertia));
    /// ```
    pub fn draw(&self, random: &mut impl Rng) -> Actual {
        self.draw_onto(&Actual::default(), random)
    }

    /// The same, with what is not drawn here as on another machine.
    pub fn draw_onto(&self, base: &Actual, random: &mut impl Rng) -> Actual {
        // A machine that has nothing of a factor is as its file says.
        let mut factor = |drawn: Drawn| drawn.draw(1.0, random);
        let mut actual = Actual {
            inertia: factor(self.inertia),
            torque_limit: factor(self.torque_limit),
            torque_constant: factor(self.torque_constant),
            friction: factor(self.friction),
            spindle_resonance: factor(self.spindle_resonance),
            z_resonance: factor(self.z_resonance),
            cutting_torque: factor(self.cutting_torque),
            encoder_error: factor(self.encoder_error),
            backlash: 1.0,
            encoder_latency: 1.0,
            backlash_um: None,
            encoder_latency_s: None,
            ..*base
        };
        match self.backlash_um {
            Some(drawn) => actual.backlash_um = Some(drawn.draw(0.0, random)),
            None => actual.backlash = self.backlash.draw(1.0, random),
        }
        match self.encoder_latency_s {
            Some(drawn) => actual.encoder_latency_s = Some(drawn.draw(0.0, random)),
            None => actual.encoder_latency = self.encoder_latency.draw(1.0, random),
        }
        actual
    }
}
