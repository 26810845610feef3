//! `[supervision]`

use super::key::{Key, Slot};
use crate::control::machine::SupervisionSpec;

#[rustfmt::skip]
pub(super) const KEYS: &[Key] = &[
    Key::number("supervision.bridge_periods", "periods", "for so many the model stands in for samples that are missing",
        "A103 and e(k) see what goes on for longer; a whole number", |d| &mut d.spec.supervision.bridge_periods),
    Key {
        path: "supervision.error_limit_um", unit: "µm", meaning: "greatest |e(k)|: A107",
        reason: "the thread's tolerance, else 0.05 of the pitch",
        slot: Slot::Optional { at: |d| &mut d.spec.supervision.error_limit_um, example: 53.0 },
    },
    Key {
        path: "supervision.spindle_limit_rev", unit: "rev", meaning: "greatest tracking error of the spindle: A105",
        reason: "10 times what saturates its drive, and a period's travel",
        slot: Slot::Ruled { at: |d| &mut d.spec.supervision.spindle_limit_rev, rule: SupervisionSpec::spindle_rule_rev },
    },
    Key {
        path: "supervision.z_limit_um", unit: "µm", meaning: "greatest following error of Z: A106",
        reason: "what saturates its drive, and a period's travel",
        slot: Slot::Ruled { at: |d| &mut d.spec.supervision.z_limit_um, rule: SupervisionSpec::z_rule_um },
    },
    Key::number("supervision.scale_ratio", "", "greatest deviation of an encoder's scale in a revolution: A104",
        "coarser than any encoder, finer than one tooth of a belt's pulley", |d| &mut d.spec.supervision.scale_ratio),
];
