//! Faults at run time in words.

use crate::control::sync::Alarm;
use crate::control::units::um_from_mm;
use crate::run::Fault;

/// A fault with its period and its values.
#[must_use]
pub(super) fn sentence(fault: &Fault) -> String {
    let Fault { k, time_s, hole, saturated_periods, alarm } = fault;
    let cause = if *saturated_periods > 0 {
        format!(
            "; the spindle's drive stood at its torque limit in {saturated_periods} of {k} periods: its law asks more than \
             this motor has (--share retunes the bands of torque-curve)"
        )
    } else {
        String::new()
    };
    match alarm {
        Alarm::NotInPosition { waited_s, spindle_rev, z_mm } => format!(
            "hole {hole}, period {k} ({time_s:.3} s): after {waited_s:.1} s the axes were still not at rest at R: \
             spindle off by {spindle_rev:.4} rev, Z by {:.1} µm{cause}",
            um_from_mm(*z_mm)
        ),
        alarm => format!("hole {hole}, period {k} ({time_s:.3} s): {alarm}{cause}"),
    }
}
