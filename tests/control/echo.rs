//! A machine that does what it is told, a little later, with a little noise.

use rand::RngExt;
use rand_pcg::Pcg64;
use rigidtap::control::port::Feedback;
use rigidtap::control::sync::Step;

const COUNTS_PER_MM: f64 = 10_000.0;
const COUNTS_PER_REV: f64 = 16_384.0;
/// Share of what is left that an axis goes on in a period.
const SHARE: f64 = 0.9;

/// Spindle and Z.
pub(crate) struct Echo {
    /// Where they are, and where the setpoints that act now and next send them.
    at: [f64; 2],
    acting: [f64; 2],
    next: [f64; 2],
    share: f64,
}

impl Echo {
    pub(crate) fn at_rest(z_mm: f64) -> Self {
        let rest = [0.0, z_mm];
        Self { at: rest, acting: rest, next: rest, share: SHARE }
    }

    /// Drives that take positions alone: they lag by speed over gain.
    pub(crate) fn lagging(z_mm: f64, gain_per_period: f64) -> Self {
        Self { share: 1.0 - (-gain_per_period).exp(), ..Self::at_rest(z_mm) }
    }

    pub(crate) fn read(&self, random: &mut Pcg64) -> Feedback {
        let [spindle_rev, z_mm] = self.at;
        let mut count = |value: f64| value.round() as i64 + random.random_range(-1..=1);
        Feedback {
            spindle_counts: count(spindle_rev * COUNTS_PER_REV),
            z_counts: count(z_mm * COUNTS_PER_MM),
            ..Feedback::default()
        }
    }

    /// One period, and before it as many as the host left out: in them the drives carried the last setpoint on.
    pub(crate) fn write(&mut self, step: &Step, periods: u32) {
        for _ in 1..periods {
            let [carried, acting] = [self.next, self.acting];
            self.go_on([0, 1].map(|axis| 2.0 * carried[axis] - acting[axis]));
        }
        self.go_on([step.spindle.position, step.z.position]);
    }

    fn go_on(&mut self, newest: [f64; 2]) {
        for (at, acting) in self.at.iter_mut().zip(self.acting) {
            *at += self.share * (acting - *at);
        }
        (self.acting, self.next) = (self.next, newest);
    }
}
