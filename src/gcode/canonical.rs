//! Canonical text: one line for each command, so that interpreters can be held against each other.

use std::fmt;

use crate::control::cycle::{Hand, Retract};
use crate::control::units::{deg_from_rev, mm_per_min_from_mm_per_s};
use crate::gcode::command::{Command, CommandKind, SpindleCommand};
use crate::gcode::text::Decimal;

/// The command as one line of canonical text: lengths in mm, speeds in rpm and mm/min, at most six decimals.
///
/// ```
/// use rigidtap::gcode::{CommandKind, Command, Span, canonical};
/// let kind = CommandKind::Rapid { to_mm: [0.0, 7.5, 10.0] };
/// let command = Command { kind, line: 4, column: 1, span: Span::default() };
/// assert_eq!(canonical(&command), "4 rapid x=0 y=7.5 z=10");
/// ```
#[must_use]
pub fn canonical(command: &Command) -> String {
    command.to_string()
}

impl fmt::Display for Command {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} ", self.line)?;
        match self.kind {
            CommandKind::Rapid { to_mm } => write!(f, "rapid {}", Point(to_mm)),
            CommandKind::Feed { to_mm, feed_mm_per_s } => {
                write!(f, "feed {} f={}", Point(to_mm), Decimal(mm_per_min_from_mm_per_s(feed_mm_per_s)))
            }
            CommandKind::Dwell { dwell_s } => write!(f, "dwell s={}", Decimal(dwell_s)),
            CommandKind::Spindle(SpindleCommand::Off) => f.write_str("spindle off"),
            CommandKind::Spindle(SpindleCommand::On { hand, speed_rpm }) => {
                write!(f, "spindle {} s={}", hand_name(hand), Decimal(speed_rpm))
            }
            CommandKind::Tap(hole) => {
                write!(f, "tap x={} y={}", Decimal(hole.x_mm), Decimal(hole.y_mm))?;
                write!(f, " r={} bottom={}", Decimal(hole.r_plane_mm), Decimal(hole.bottom_mm))?;
                write!(f, " return={} pitch={}", Decimal(hole.return_mm), Decimal(hole.pitch_mm))?;
                write!(f, " s={} out={}", Decimal(hole.speed_rpm), Decimal(hole.out_speed_rpm))?;
                write!(f, " hand={} dwell={}", hand_name(hole.hand), Decimal(hole.dwell_s))?;
                if let Some(angle_rev) = hole.start_angle_rev {
                    write!(f, " start={}", Decimal(deg_from_rev(angle_rev)))?;
                }
                if let Some(peck_mm) = hole.peck_mm {
                    write!(f, " peck={}", Decimal(peck_mm))?;
                }
                match hole.retract {
                    None => Ok(()),
                    Some(Retract::ChipBreak { back_mm }) => write!(f, " retract=chip-break back={}", Decimal(back_mm)),
                    Some(Retract::Full) => f.write_str(" retract=full"),
                }
            }
            CommandKind::End => f.write_str("end"),
        }
    }
}

struct Point([f64; 3]);

impl fmt::Display for Point {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [x, y, z] = self.0.map(Decimal);
        write!(f, "x={x} y={y} z={z}")
    }
}

const fn hand_name(hand: Hand) -> &'static str {
    match hand {
        Hand::Right => "right",
        Hand::Left => "left",
    }
}
