//! The dry cycle: a program in air that shows what tuning wants to know of a machine.

use std::fmt::Write;

use crate::control::machine::Machine;
use crate::control::units::um_from_mm;

/// Speeds of the ladder reach this many times below and above the file's Stribeck speed, so that one that is off by a few
/// times lies well inside.
const LADDER_REACH: f64 = 20.0;
const LADDER_STEPS: i32 = 12;
/// The ladder is climbed at places that differ in friction.
const PLACES_MM: [f64; 3] = [75.0, 45.0, 15.0];
/// Time of one move of the ladder, and its least length in pre-sliding travels.
const MOVE_S: f64 = 0.4;
const LEAST_PRESLIDINGS: f64 = 40.0;
/// Top of the long strokes: a whole number of turns of every usual screw lead, over which its ripple averages out.
const LONG_MM: f64 = 80.0;
const LONG_STROKES: u32 = 3;
/// Pitch and depth of the tapping strokes in air, and how many.
const PITCH_MM: f64 = 1.0;
const DEPTH_MM: f64 = 25.0;
const HOLES: u32 = 4;
/// Share of Z's greatest speed that the cycle uses.
const Z_SHARE: f64 = 0.8;

/// The program for a machine: G-code of the paper's dialect that needs Z free from 0 to 80 mm, and air instead of a work
/// piece.
///
/// Slow strokes at rising speeds show friction over speed and how it builds up after a reversal; long ones its mean over
/// the screw; tapping strokes at the greatest speed the spindle's inertia and Z's lost motion.
///
/// ```
/// use rigidtap::control::machine::Machine;
/// use rigidtap::gcode::{Dialect, Options, interpret};
/// let program = rigidtap::study::dry_cycle(&Machine::reference());
/// assert!(!interpret(program.as_bytes(), &Dialect::PAPER, Options::default()).diagnostics.has_errors());
/// ```
#[must_use]
pub fn dry_cycle(machine: &Machine) -> String {
    let (moves, rpm) = moves(machine);
    let mut text = format!("%\nG90 G94\n{moves}M03 S{rpm}\nG0 Z{:.1}\n", DEPTH_MM + 5.0);
    // Writing to a String cannot fail.
    let _ = writeln!(text, "G81 X0 Y0 R{DEPTH_MM:.1} Z0.0 F{:.1}", rpm * PITCH_MM);
    for _ in 1..HOLES {
        let _ = writeln!(text, "X0 Y0");
    }
    text + "G80\nM30\n%\n"
}

/// The same for LinuxCNC with the component's G84.2: each move ends where it is told.
///
/// ```
/// let program = rigidtap::study::dry_cycle_for_linuxcnc(&rigidtap::control::machine::Machine::reference());
/// assert_eq!(program.matches("G84.2 R25.0 Z0.0 F").count(), 4);
/// ```
#[must_use]
pub fn dry_cycle_for_linuxcnc(machine: &Machine) -> String {
    let (moves, rpm) = moves(machine);
    let mut text = format!("G21 G61 G90 G94 G17 G99\n{moves}S{rpm}\nG0 Z{:.1}\n", DEPTH_MM + 5.0);
    for _ in 0..HOLES {
        // Writing to a String cannot fail.
        let _ = writeln!(text, "G84.2 R{DEPTH_MM:.1} Z0.0 F{:.1}", rpm * PITCH_MM);
    }
    text + "M2\n"
}

/// The moves before the holes, and the holes' speed.
fn moves(machine: &Machine) -> (String, f64) {
    let (z, limits) = (&machine.spec().z_axis, &machine.spec().z);
    let fastest_mm_per_s = Z_SHARE * limits.max_mm_per_s;
    let ladder = (-LADDER_STEPS / 2..=LADDER_STEPS / 2).map(|step| {
        let reach = LADDER_REACH.powf(2.0 * f64::from(step) / f64::from(LADDER_STEPS));
        (reach * z.stribeck_mm_per_s).min(fastest_mm_per_s)
    });
    let least_mm = LEAST_PRESLIDINGS * z.presliding_um / um_from_mm(1.0);
    let long_mm_per_s = (LADDER_REACH * z.stribeck_mm_per_s).min(fastest_mm_per_s);
    let rpm = machine.spec().spindle.max_rpm.min(fastest_mm_per_s * 60.0 / PITCH_MM).floor();
    let feed = |mm_per_s: f64| mm_per_s * 60.0;
    let mut text = format!("G0 X0 Y0 Z{LONG_MM:.1}\n");
    // Writing to a String cannot fail.
    for _ in 0..LONG_STROKES {
        let _ = writeln!(text, "G1 Z0.0 F{:.3}\nG1 Z{LONG_MM:.1}", feed(long_mm_per_s));
    }
    for place_mm in PLACES_MM {
        let _ = writeln!(text, "G0 Z{place_mm:.1}");
        for mm_per_s in ladder.clone() {
            let bottom_mm = place_mm - (mm_per_s * MOVE_S).max(least_mm);
            let _ = writeln!(text, "G1 Z{bottom_mm:.4} F{:.3}\nG1 Z{place_mm:.1}", feed(mm_per_s));
        }
    }
    (text, rpm)
}
