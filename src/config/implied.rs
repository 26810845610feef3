//! Laws that a file leaves out: they follow from its motor.

use super::keys::{self, DERIVED, Draft, Slot};
use crate::control::machine::{LawSpec, MachineSpec};
use crate::laws::laws_of;

/// Gives the laws that the file leaves out their values.
pub(super) fn fill(draft: &mut Draft, given: &dyn Fn(&str) -> bool) {
    let Some(mut implied) = implied(draft) else { return };
    for key in DERIVED.iter().filter(|(key, _)| !given(key)).filter_map(|(key, _)| keys::find(key)) {
        match key.slot {
            Slot::Number(at) => *at(draft) = *at(&mut implied),
            Slot::Bands => draft.spec.law.torque_curve.bands = implied.spec.law.torque_curve.bands.clone(),
            _ => {}
        }
    }
}

/// The same file with all laws left out; none where no law follows, since the motor is none.
pub(super) fn implied(draft: &Draft) -> Option<Draft> {
    let law = laws(&draft.spec)?;
    Some(Draft { spec: MachineSpec { law, ..draft.spec.clone() }, ..draft.clone() })
}

/// The laws of a motor and springs: those of the papers where these are the reference machine's.
fn laws(spec: &MachineSpec) -> Option<LawSpec> {
    let reference = MachineSpec::reference();
    let (own, papers) = (&spec.spindle, &reference.spindle);
    let motor = own.torque_curve == papers.torque_curve
        && own.inertia_kg_m2 == papers.inertia_kg_m2
        && spec.law.motor_share == reference.law.motor_share;
    let springs = own.resonance_hz == papers.resonance_hz && spec.z_axis.resonance_hz == reference.z_axis.resonance_hz;
    let range = own.max_rpm == papers.max_rpm;
    let mut laws = LawSpec { motor_share: spec.law.motor_share, ..reference.law };
    if motor && springs && range {
        return Some(laws);
    }
    let derived = laws_of(spec).ok()?;
    // Of a motor that no machine has, laws are none either; its own keys are told.
    let mut sane = true;
    MachineSpec { law: derived.clone(), ..reference }.faults(&mut |fault| sane &= !fault.key.starts_with("law."));
    if !sane {
        return None;
    }
    if !(motor && range) {
        laws.torque_curve = derived.torque_curve;
    }
    if !motor {
        (laws.linear, laws.improved_s_curve) = (derived.linear, derived.improved_s_curve);
    }
    if !(motor && springs) {
        laws.s_curve = derived.s_curve;
        laws.torque_curve_smooth = derived.torque_curve_smooth;
        laws.trapezoid_jerk = derived.trapezoid_jerk;
    }
    Some(laws)
}
