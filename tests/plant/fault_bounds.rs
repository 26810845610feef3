//! What each fault may come to: its alarms, the periods to them, and the error that is left in the thread.

use rigidtap::control::machine::Machine;
use rigidtap::sim::{Axis, AxisFault, Fault};

use crate::fault_table::Row;

/// Bounds of a row.
pub(crate) struct Bounds {
    /// Alarms that are right; 0 where none may come, too.
    pub(crate) codes: &'static [u32],
    pub(crate) periods: u32,
    pub(crate) error_um: f64,
}

/// While both drives obey.
const OBEYED_UM: f64 = 50.0;
/// With a spindle that coasts, or a tap that jams.
const FOLLOWED_UM: f64 = 100.0;
/// What samples that are bridged may add to the hole's error.
const BRIDGED_UM: f64 = 6.0;
/// Nothing says within how many.
const ANY: u32 = u32::MAX;

pub(crate) fn bounds(row: &Row) -> Bounds {
    let of = |codes, periods, error_um| Bounds { codes, periods, error_um };
    match row.fault {
        Fault::Axis(_, AxisFault::Invalid | AxisFault::Repeated) | Fault::FrameInvalid | Fault::FrameRepeated => {
            of(&[0], 0, row.healthy_um + BRIDGED_UM)
        }
        Fault::SetpointLost | Fault::TapBroken => of(&[0], 0, OBEYED_UM),
        Fault::Axis(_, AxisFault::Frozen) => of(&[0, 103], 20, OBEYED_UM),
        Fault::Axis(Axis::Spindle, AxisFault::EncoderFrozen) => of(&[0, 103, 104, 105, 108], 20, OBEYED_UM),
        Fault::Axis(Axis::Z, AxisFault::EncoderFrozen) => of(&[0, 103, 106, 107], 20, OBEYED_UM),
        Fault::Axis(_, AxisFault::Jump | AxisFault::Wrap) => of(&[102], 1, OBEYED_UM),
        Fault::Axis(_, AxisFault::Reversed | AxisFault::Scaled) => of(&[0, 104, 107], ANY, OBEYED_UM),
        Fault::Axis(Axis::Spindle, AxisFault::Trip) => of(&[105], 3, FOLLOWED_UM),
        Fault::Axis(Axis::Z, AxisFault::Trip) => of(&[106], 3, OBEYED_UM),
        Fault::Axis(Axis::Spindle, AxisFault::Coast) => of(&[0, 105, 107, 108], ANY, FOLLOWED_UM),
        Fault::Axis(Axis::Z, AxisFault::Coast) => of(&[106, 107], ANY, OBEYED_UM),
        Fault::Axis(Axis::Spindle, AxisFault::Weak) => of(&[0, 105, 107], ANY, FOLLOWED_UM),
        Fault::Axis(Axis::Z, AxisFault::Weak) => of(&[0, 106, 107], ANY, OBEYED_UM),
        Fault::Axis(_, AxisFault::EffortNan | AxisFault::EffortHuge) => of(&[110], 3, OBEYED_UM),
        Fault::ZCaught | Fault::ZPushed => of(&[0, 106, 107], ANY, OBEYED_UM),
        Fault::TapJam => of(&[0, 108], 10, FOLLOWED_UM),
        Fault::ClockNan => of(&[111], 1, OBEYED_UM),
        // Its first period shows the last time again.
        Fault::ClockFalls => of(&[111], 2, OBEYED_UM),
    }
}

/// Why more is left of the thread than the bounds say: what physics leaves, each with its formula below.
pub(crate) const REASONS: [&str; 3] = [
    "The drive itself has lost its encoder and drives its axis away with all it has: a/2·t², t to the end.",
    "Z is lost: its drive or its table does not obey, and the spindle turns until it is braked: p·(v·τ + angle).",
    "A jam halts the spindle, and Z brakes once that is seen: p·v·τ + (p·v)²/2·(1/a_z - 1/a_jam).",
];

/// The reason of a row, from 1.
pub(crate) fn exception(row: &Row) -> Option<usize> {
    match row.fault {
        Fault::Axis(_, AxisFault::EncoderFrozen) => Some(1),
        Fault::Axis(Axis::Z, AxisFault::Trip | AxisFault::Coast | AxisFault::Weak) => Some(2),
        Fault::ZCaught | Fault::ZPushed => Some(2),
        Fault::TapJam => Some(3),
        _ => None,
    }
}

const PITCH_MM: f64 = 1.0;
/// Three periods until it is seen, one to the drive, one of Z's own lag.
const ANSWER_S: f64 = 0.005;
/// What Z may be off before anything is seen of it: the limit of e(k).
const UNSEEN_UM: f64 = 52.5;

/// What physics leaves of a row's |e|.
pub(crate) fn left_um(row: &Row) -> f64 {
    let machine = Machine::reference();
    let spec = machine.spec();
    let rev_per_s = row.hole.speed_rpm / 60.0;
    let um = |mm: f64| 1000.0 * mm;
    let stop = machine.torque_limit().brake(rev_per_s, f64::INFINITY).expect("the spindle can be braked");
    let full_rev_per_s2 = machine.motor().acceleration_rev_per_s2(0.0, 1.0);
    match exception(row) {
        Some(1) => {
            // Until the run ends, 0.1 s after the hole is held: from where it was to go, as it is driven away.
            let t_s = stop.duration_s() + 0.15;
            let driven_mm_per_s2 = match row.fault {
                Fault::Axis(Axis::Z, _) => 1000.0 * spec.z_axis.force_limit_n / spec.z_axis.mass_kg,
                _ => PITCH_MM * full_rev_per_s2,
            };
            um(0.5 * driven_mm_per_s2 * t_s * t_s + PITCH_MM * rev_per_s * t_s)
        }
        Some(2) => UNSEEN_UM + um(PITCH_MM * (rev_per_s * ANSWER_S + stop.distance())),
        Some(3) => {
            // 200 N·m hold the tap.
            let jam_mm_per_s2 = PITCH_MM * 200.0 / (std::f64::consts::TAU * spec.spindle.inertia_kg_m2);
            let speed = PITCH_MM * rev_per_s;
            let braked = 0.5 * speed * speed * (1.0 / spec.z.max_mm_per_s2 - 1.0 / jam_mm_per_s2);
            um(speed * ANSWER_S + braked).max(FOLLOWED_UM)
        }
        _ => 0.0,
    }
}
