//! Faults at run time in words.

use crate::control::sync::Alarm;
use crate::control::units::um_from_mm;
use crate::run::{Fault, Lost, PowerLoss, PowerLossEnd};

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

/// What came of a power cut.
#[must_use]
pub(super) fn power_loss_sentence(loss: &PowerLoss) -> String {
    let cut = match loss.lost {
        Lost::Mains => "mains lost",
        Lost::All => "all power lost",
    };
    let at = match loss.hole {
        Some(hole) => format!("{cut} at {:.3} s, in hole {hole}", loss.time_s),
        None => format!("{cut} by {:.3} s, in no hole", loss.time_s),
    };
    let stood = loss.standing.map_or_else(String::new, |standing| {
        let offset_um = um_from_mm(standing.offset_mm);
        format!(": the tap stood {:.3} mm below R, {offset_um:.1} µm off the helix of its record", standing.depth_mm)
    });
    let end = match &loss.end {
        PowerLossEnd::NoHole => "nothing is left in a hole".to_owned(),
        PowerLossEnd::Retracted => "after the restart it was retracted in synchronism".to_owned(),
        PowerLossEnd::Refused(error) => format!("the retract is refused: {error}"),
        PowerLossEnd::Alarm(alarm) => format!("an alarm holds it: {alarm}"),
        PowerLossEnd::Coasting => "the axes did not come to rest".to_owned(),
    };
    format!("{at}{stood}; {end}")
}
