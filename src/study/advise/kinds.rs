//! The holes of programs in kinds: alike in everything but their place.

use crate::control::cycle::TapCycle;
use crate::gcode::{Command, CommandKind};

/// Holes that are tapped alike.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HoleKind {
    /// Program of the first of them, from 0.
    pub program: usize,
    /// Its line.
    pub line: u32,
    /// How many there are in all programs.
    pub count: usize,
    /// The first of them, as programmed.
    pub hole: TapCycle,
}

/// Every kind of hole, in the order of its first; Z counts by the depth alone.
pub(super) fn kinds(programs: &[Vec<Command>]) -> Vec<HoleKind> {
    let mut kinds: Vec<HoleKind> = Vec::new();
    for (program, commands) in programs.iter().enumerate() {
        for command in commands {
            let CommandKind::Tap(hole) = command.kind else { continue };
            match kinds.iter_mut().find(|kind| same(&kind.hole, &hole)) {
                Some(kind) => kind.count += 1,
                None => kinds.push(HoleKind { program, line: command.line, count: 1, hole }),
            }
        }
    }
    kinds
}

/// Whether two holes are tapped alike: their place in X, Y and Z aside.
pub(super) fn same(left: &TapCycle, right: &TapCycle) -> bool {
    // Depths are differences of coordinates.
    let close = |left: f64, right: f64| (left - right).abs() <= 1e-9 * left.abs().max(right.abs());
    let at = TapCycle { r_plane_mm: left.r_plane_mm, bottom_mm: left.bottom_mm, return_mm: left.return_mm, ..*right };
    close(left.depth_mm(), right.depth_mm()) && left.is_alike(&at)
}

/// A hole at another speed; the way out keeps its ratio to the way in.
pub(super) fn at_speed(hole: &TapCycle, speed_rpm: f64) -> TapCycle {
    let out_ratio = hole.out_speed_rpm / hole.speed_rpm;
    TapCycle { speed_rpm, out_speed_rpm: speed_rpm * out_ratio, ..*hole }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gcode::{Dialect, Options, interpret};

    #[test]
    fn holes_at_other_heights_are_of_one_kind() {
        let text = b"G90 M03 S1000 G81 X0 Y0 R3 Z-2 F1000\nX5\nR2 Z-3 X9\nZ-4\nG80 M30";
        let commands = interpret(text, &Dialect::PAPER, Options::default()).commands;
        let found = kinds(&[commands.clone(), commands]);
        let counts: Vec<_> = found.iter().map(|kind| (kind.line, kind.count)).collect();
        assert_eq!(counts, [(1, 6), (4, 2)]);
        assert_eq!(at_speed(&found[0].hole, 500.0).out_speed_rpm, 500.0);
    }
}
