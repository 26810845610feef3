//! Encoders: a signal with its age and interpolation error, and the whole counts that the control reads.

use rand::{Rng, RngExt};

use super::wave::sin_turns;

/// One encoder.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Encoder {
    pub(crate) counts_per_unit: f64,
    /// Age of a reading.
    pub(crate) latency_s: f64,
    /// Greatest deviation of the latching instant.
    pub(crate) jitter_s: f64,
    /// Amplitude of the interpolation error, in counts.
    pub(crate) interpolation_counts: f64,
    /// Counts of one signal period, over which that error repeats.
    pub(crate) period_counts: f64,
    /// An error once in each unit of travel; none of a scale.
    pub(crate) eccentricity: Option<Eccentricity>,
    /// Where the encoder stands since it no longer moves: a fault.
    pub(crate) frozen: Option<f64>,
}

/// A disc that does not turn about its own centre.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Eccentricity {
    /// In units of travel.
    pub(crate) amplitude: f64,
    pub(crate) phase_turns: f64,
}

impl Encoder {
    /// What a drive sees: finer than counts, but as old and with the same error.
    pub(crate) fn signal(&self, position: f64, velocity: f64) -> f64 {
        self.seen(position - velocity * self.latency_s)
    }

    /// What the control reads: whole counts, latched at an instant that jitters and that the host is late for by
    /// `host_late_s`.
    pub(crate) fn counts(&self, position: f64, velocity: f64, host_late_s: f64, random: &mut impl Rng) -> i64 {
        let jitter_s = if self.jitter_s > 0.0 { random.random_range(-self.jitter_s..=self.jitter_s) } else { 0.0 };
        let seen = position - velocity * (self.latency_s + jitter_s - host_late_s);
        (self.seen(seen) * self.counts_per_unit).round() as i64
    }

    fn seen(&self, position: f64) -> f64 {
        if let Some(frozen) = self.frozen {
            return frozen;
        }
        let seen = position + self.interpolation_error(position);
        match self.eccentricity {
            Some(Eccentricity { amplitude, phase_turns }) => seen + amplitude * sin_turns(position + phase_turns),
            None => seen,
        }
    }

    fn interpolation_error(&self, position: f64) -> f64 {
        if self.interpolation_counts == 0.0 {
            return 0.0;
        }
        self.interpolation_counts / self.counts_per_unit
            * sin_turns(position * self.counts_per_unit / self.period_counts)
    }
}
