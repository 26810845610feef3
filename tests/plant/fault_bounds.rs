//! What each fault may come to: its alarms, the periods to them, and the error that is left in the thread.

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
        Fault::Axis(Axis::Spindle, AxisFault::EncoderFrozen) => of(&[0, 103, 104, 105], 20, OBEYED_UM),
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

/// Why more is left in the thread than the bound says.
pub(crate) const REASONS: [&str; 4] = [
    "The drive itself has lost its encoder and drives its axis away, whatever it is told.",
    "Z is lost: its drive or its table does not obey, and what the spindle turns until it rests is what is left.",
    "A jam halts the spindle in milliseconds: two samples show it, and Z's own 100 Hz brake no sooner.",
    "Half the torque, and no less speed: the spindle falls behind before e(k) is over its limit, and Z follows after.",
];

/// The reason of a row, from 1.
pub(crate) fn exception(row: &Row) -> Option<usize> {
    match row.fault {
        Fault::Axis(_, AxisFault::EncoderFrozen) => Some(1),
        Fault::Axis(Axis::Z, AxisFault::Trip | AxisFault::Coast | AxisFault::Weak) => Some(2),
        Fault::ZCaught | Fault::ZPushed => Some(2),
        Fault::TapJam => Some(3),
        Fault::Axis(Axis::Spindle, AxisFault::Weak) => Some(4),
        _ => None,
    }
}
