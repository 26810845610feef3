//! What of the identification outlives a restart of the host, as plain numbers.

use super::screw::ScrewFit;
use crate::control::sync::identification::Identification;
use crate::control::sync::plant_model::{IdentifiedLatency, PitchError};

/// Share of their weight that what was measured before a restart keeps.
const KEPT_OVER_RESTART: f64 = 0.5;
/// How many numbers outlive a restart.
pub(in crate::control::sync) const IDENTIFICATION_NUMBERS: usize = 107;

impl Identification {
    /// The fits of friction, inertia and screw, what was found of latency and pitch error, and which tap cut.
    pub(super) fn kept(&mut self) -> impl Iterator<Item = &mut f64> {
        let IdentifiedLatency { spindle_s, z_s } = &mut self.latency_before;
        let PitchError { lead_mm, sin_mm, cos_mm } = &mut self.pitch_before;
        let fits = self.friction.kept().chain(self.spindle.kept()).chain(self.screw.kept());
        fits.chain([spindle_s, z_s, lead_mm, sin_mm, cos_mm]).chain(self.tap.numbers_mut())
    }

    /// The numbers that outlive a restart.
    pub(in crate::control::sync) fn numbers(&self) -> [f64; IDENTIFICATION_NUMBERS] {
        let [of_spindle, of_z] = self.trackings();
        let latency_before = IdentifiedLatency { spindle_s: of_spindle.latency_s, z_s: of_z.latency_s };
        let screw = self.screw.summed(&self.known(self.forces(&of_z)));
        let mut kept = Self { screw, latency_before, pitch_before: self.pitch_error, ..self.clone() };
        let mut numbers = [0.0; IDENTIFICATION_NUMBERS];
        numbers.iter_mut().zip(kept.kept()).for_each(|(number, kept)| *number = *kept);
        numbers
    }

    /// Goes on from such numbers: a machine that has stood is not quite as it was.
    pub(in crate::control::sync) fn restore(&mut self, numbers: &[f64; IDENTIFICATION_NUMBERS]) {
        self.screw = ScrewFit::default();
        self.kept().zip(numbers).for_each(|(kept, number)| *kept = *number);
        self.friction.decay(KEPT_OVER_RESTART);
        self.spindle.decay(KEPT_OVER_RESTART);
        self.pitch_error = self.pitch_before;
        self.screw.note_restored(KEPT_OVER_RESTART);
        self.note_gap();
    }
}
