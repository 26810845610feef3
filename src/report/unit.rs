//! e(k) in the spindle's units.

use crate::control::machine::Machine;
use crate::control::sync::spindle_rev_from_error_um;
use crate::control::units::DEG_PER_REV;

/// Spindle degrees, and encoder pulses, that one µm of axial error amounts to.
#[must_use]
pub(super) fn deg_and_pulses_per_um(pitch_mm: f64, machine: &Machine) -> (f64, f64) {
    let rev_per_um = spindle_rev_from_error_um(1.0, pitch_mm);
    (rev_per_um * DEG_PER_REV, rev_per_um * machine.spec().spindle.encoder_counts_per_rev)
}
