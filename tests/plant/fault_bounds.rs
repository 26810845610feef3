//! What each fault may come to: its alarms, the periods to them, and the error that is left in the thread.

use rigidtap::control::sync::Compensation;
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

/// Why a row is beyond its bounds: what physics leaves of |e|, and from [`OPEN`] on what supervision does not do yet.
pub(crate) const REASONS: [&str; 9] = [
    "The drive itself has lost its encoder and drives its axis away, whatever it is told.",
    "Z is lost: its drive or its table does not obey, and what the spindle turns until it rests is what is left.",
    "A jam halts the spindle in milliseconds: two samples show it, and Z's own 100 Hz mode lags.",
    "Open: a weak motor is taken for a jam, or seen too late for the thread.",
    "Open: off its scale, it looks like a drive that disobeys; the stop follows the wrong angle and never rests.",
    "Open: stopped at one moment near the bottom, the hole does not come to be held.",
    "Open: the integral correction hides Z's wrong scale from e(k), and A104 does not look at Z's travel.",
    "As (3). Open: where the spindle turns round, a jam takes longer than 10 ms to show.",
    "Open: a slow drive that coasts is taken for a wrong encoder; uncorrected, more than 100 µm are left at S7000.",
];
/// The first reason that waives more than |e|.
pub(crate) const OPEN: usize = 4;

/// The reason of a row, from 1.
pub(crate) fn exception(row: &Row) -> Option<usize> {
    let fast = row.hole.speed_rpm > 3000.0;
    let compensation = row.hole.compensation;
    let uncompensated = compensation == Compensation::Uncompensated;
    match row.fault {
        Fault::Axis(_, AxisFault::EncoderFrozen) => Some(1),
        Fault::Axis(_, AxisFault::EffortNan | AxisFault::EffortHuge) if fast && uncompensated => Some(6),
        Fault::Axis(Axis::Z, AxisFault::Reversed | AxisFault::Trip | AxisFault::Coast) if fast => Some(6),
        Fault::Axis(Axis::Z, AxisFault::Trip | AxisFault::Coast | AxisFault::Weak) => Some(2),
        Fault::Axis(Axis::Z, AxisFault::Scaled) if compensation == Compensation::Integral => Some(7),
        Fault::Axis(Axis::Spindle, AxisFault::Scaled) => Some(5),
        Fault::Axis(Axis::Spindle, AxisFault::Weak) => Some(4),
        Fault::Axis(Axis::Spindle, AxisFault::Coast) => Some(9),
        Fault::ZCaught | Fault::ZPushed => Some(2),
        Fault::TapJam => Some(8),
        _ => None,
    }
}
