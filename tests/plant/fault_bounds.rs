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
    let lost = f64::INFINITY;
    match row.fault {
        Fault::Axis(_, AxisFault::Invalid | AxisFault::Repeated) | Fault::FrameInvalid | Fault::FrameRepeated => {
            of(&[0], 0, row.healthy_um + BRIDGED_UM)
        }
        Fault::SetpointLost | Fault::TapBroken => of(&[0], 0, OBEYED_UM),
        Fault::Axis(_, AxisFault::Frozen) => of(&[0, 103], 20, OBEYED_UM),
        Fault::Axis(Axis::Spindle, AxisFault::EncoderFrozen) => of(&[0, 103, 104, 105], 20, OBEYED_UM),
        Fault::Axis(Axis::Z, AxisFault::EncoderFrozen) => of(&[0, 103, 106], 20, lost),
        Fault::Axis(_, AxisFault::Jump | AxisFault::Wrap) => of(&[102], 1, OBEYED_UM),
        Fault::Axis(_, AxisFault::Reversed | AxisFault::Scaled) => of(&[0, 104, 107], ANY, OBEYED_UM),
        Fault::Axis(Axis::Spindle, AxisFault::Trip) => of(&[105], 3, FOLLOWED_UM),
        Fault::Axis(Axis::Z, AxisFault::Trip) => of(&[106], 3, lost),
        Fault::Axis(Axis::Spindle, AxisFault::Coast) => of(&[0, 105, 107, 108], ANY, FOLLOWED_UM),
        Fault::Axis(Axis::Z, AxisFault::Coast) => of(&[106, 107], ANY, lost),
        Fault::Axis(Axis::Spindle, AxisFault::Weak) => of(&[0, 105, 107], ANY, FOLLOWED_UM),
        Fault::Axis(Axis::Z, AxisFault::Weak) => of(&[0, 106, 107], ANY, lost),
        Fault::Axis(_, AxisFault::EffortNan | AxisFault::EffortHuge) => of(&[110], 3, OBEYED_UM),
        Fault::ZCaught => of(&[0, 106, 107], ANY, lost),
        Fault::ZPushed => of(&[0, 106, 107], ANY, lost),
        Fault::TapJam => of(&[0, 108], 10, FOLLOWED_UM),
        Fault::ClockNan | Fault::ClockFalls => of(&[111], 1, OBEYED_UM),
    }
}

/// Why rows are beyond their bounds.
pub(crate) const REASONS: [&str; 1] = ["-"];

/// The reason of a row, from 1.
pub(crate) fn exception(_row: &Row) -> Option<usize> {
    None
}
