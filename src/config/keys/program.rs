//! `[gcode]`, `[tap]`, `[tolerance]`

use super::key::{Key, Slot};
use crate::config::gcode_options::Peck;
use crate::gcode::{AUTO, DecimalPoint, Dialect, G81};

#[rustfmt::skip]
pub(super) const KEYS: &[Key] = &[
    Key {
        path: "gcode.dialect", unit: "", meaning: "how words and cycles are read",
        reason: "the programs of the torque-curve paper",
        slot: Slot::Word {
            known: &[
                Dialect::PAPER.name, Dialect::FANUC.name, Dialect::LINUXCNC.name, Dialect::HAAS.name, Dialect::SIEMENS.name,
                Dialect::BROTHER.name, Dialect::MITSUBISHI.name, AUTO,
            ],
            get: |d| &d.gcode.dialect,
            set: |d, word| word.clone_into(&mut d.gcode.dialect),
        },
    },
    Key {
        path: "gcode.g81", unit: "", meaning: "\"tap\" or \"drill\": the cycle that G81 calls; \"dialect\": as that has it",
        reason: "the paper's controls tap by G81, all others drill",
        slot: Slot::Word {
            known: &["dialect", "tap", "drill"],
            get: |d| match d.gcode.g81 {
                None => "dialect",
                Some(G81::Tap) => "tap",
                Some(G81::Drill) => "drill",
            },
            set: |d, word| {
                d.gcode.g81 = match word {
                    "tap" => Some(G81::Tap),
                    "drill" => Some(G81::Drill),
                    _ => None,
                };
            },
        },
    },
    Key {
        path: "gcode.decimal_point", unit: "",
        meaning: "\"calculator\": X10 is 10 mm; \"fanuc\": X10 is 10 µm, X10. is 10 mm; \"dialect\": as that has it",
        reason: "the paper's programs write X7 for 7 mm, a Fanuc counts µm",
        slot: Slot::Word {
            known: &["dialect", "calculator", "fanuc"],
            get: |d| match d.gcode.decimal_point {
                None => "dialect",
                Some(DecimalPoint::Calculator) => "calculator",
                Some(DecimalPoint::Fanuc) => "fanuc",
            },
            set: |d, word| {
                d.gcode.decimal_point = match word {
                    "calculator" => Some(DecimalPoint::Calculator),
                    "fanuc" => Some(DecimalPoint::Fanuc),
                    _ => None,
                };
            },
        },
    },
    Key {
        path: "gcode.power_on_inch", unit: "", meaning: "lengths are in inches until G20, G21, G70 or G71 says otherwise",
        reason: "controls are delivered in mm; a shop in inches sets a parameter",
        slot: Slot::Switch(|d| &mut d.gcode.power_on_inch),
    },
    Key {
        path: "gcode.start_angle_deg", unit: "°",
        meaning: "angle at which the spindle rests on the R plane before each hole that says none itself: holes are tapped again on their helix",
        reason: "wherever it comes to rest",
        slot: Slot::Optional { at: |d| &mut d.gcode.start_angle_deg, example: 0.0 },
    },
    Key {
        path: "gcode.peck", unit: "", meaning: "\"chip-break\" or \"full\": what a peck Q does at its end",
        reason: "a Fanuc's parameter 5200 bit 5 (PCP) is 0 as delivered",
        slot: Slot::Word {
            known: &["chip-break", "full"],
            get: |d| match d.gcode.peck {
                Peck::ChipBreak => "chip-break",
                Peck::Full => "full",
            },
            set: |d, word| d.gcode.peck = if word == "full" { Peck::Full } else { Peck::ChipBreak },
        },
    },
    Key::number("gcode.peck_back_mm", "mm", "how far a chip-breaking peck turns back; a Fanuc's parameter 5213",
        "CYCLE84's own value where VRT is 0", |d| &mut d.gcode.peck_back_mm),
    Key {
        path: "tap.pitch_mm", unit: "mm", meaning: "pitch of the tap in the spindle: a hole of another one is refused",
        reason: "any: the program's",
        slot: Slot::Optional { at: |d| &mut d.spec.tap.pitch_mm, example: 1.0 },
    },
    Key {
        path: "tap.major_mm", unit: "mm", meaning: "major diameter D; set hole_mm too",
        reason: "the metric coarse or UNC size of the program's pitch",
        slot: Slot::Optional { at: |d| &mut d.spec.tap.major_mm, example: 6.0 },
    },
    Key {
        path: "tap.hole_mm", unit: "mm", meaning: "tap-drill diameter Do; set major_mm too",
        reason: "the usual tap drill of that size",
        slot: Slot::Optional { at: |d| &mut d.spec.tap.hole_mm, example: 5.0 },
    },
    Key::number("tap.kc_n_per_mm2", "N/mm²", "specific cutting force; 0 cuts air; Ck45 3900, stainless 4200, 40 HRC 5500, GG25 2900, CuZn40 2300",
        "AlSi8Cu3: 7000 rpm with M6 is real in aluminium alone", |d| &mut d.spec.tap.kc_n_per_mm2),
    Key::number("tap.tool_factor", "", "factor K of the tap's form; steel 1.15",
        "spiral flute in aluminium", |d| &mut d.spec.tap.tool_factor),
    Key::number("tap.surface_below_r_mm", "mm", "the work piece's surface below the R plane",
        "room to reach speed before the cut", |d| &mut d.spec.tap.surface_below_r_mm),
    Key::number("tap.ramp_pitches", "pitches", "travel over which the torque rises: the tap's chamfer",
        "plug chamfer, form B or C", |d| &mut d.spec.tap.ramp_pitches),
    Key::number("tap.chip_noise_ratio", "", "amplitude of the chip noise, share of the torque",
        "chips form and break", |d| &mut d.spec.tap.chip_noise_ratio),
    Key::number("tap.out_torque_ratio", "", "torque on the way out, share of that on the way in",
        "friction in the cut thread", |d| &mut d.spec.tap.out_torque_ratio),
    Key::number("tap.axial_n", "N", "axial force of the engaged tap along its travel: positive where it draws itself in",
        "a tap that cuts its own lead; later holes measure it", |d| &mut d.spec.tap.axial_n),
    Key {
        path: "tap.bottom_clearance_mm", unit: "mm", meaning: "how far below the programmed bottom the tip may go",
        reason: "half the program's pitch",
        slot: Slot::Optional { at: |d| &mut d.spec.tap.bottom_clearance_mm, example: 0.5 },
    },
    Key {
        path: "tolerance.error_um", unit: "µm", meaning: "greatest peak-to-peak e(k); required beyond the usual threads",
        reason: "what a class ISO 2 tap leaves of 6H at the program's pitch: M3 35, M6 53, M12 69",
        slot: Slot::Optional { at: |d| &mut d.spec.tolerance.error_um, example: 53.0 },
    },
];
