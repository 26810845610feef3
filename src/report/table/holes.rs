//! A program's holes in groups, with what F and S come to.

use super::columns::Columns;
use crate::control::cycle::{Hand, Retract, TapCycle};
use crate::control::thread::StandardPitch;
use crate::control::units::MM_PER_INCH;
use crate::gcode::{Command, CommandKind};

/// One line for each group of holes that follow each other and are tapped alike: pitch beside the F and S that make it.
#[must_use]
pub fn holes(commands: &[Command]) -> String {
    let mut groups: Vec<(u32, usize, TapCycle)> = Vec::new();
    for command in commands {
        let CommandKind::Tap(hole) = command.kind else { continue };
        match groups.last_mut() {
            Some((_, count, first)) if first.is_alike(&hole) => *count += 1,
            _ => groups.push((command.line, 1, hole)),
        }
    }
    if groups.is_empty() {
        return String::new();
    }
    let mut table = Columns::new(
        &[
            "thread",
            "hand",
            "peck",
            "line",
            "holes",
            "pitch mm",
            "per inch",
            "S rpm",
            "S out rpm",
            "F mm/min",
            "depth mm",
            "dwell s",
        ],
        3,
    );
    for (line, count, hole) in groups {
        table.row(vec![
            StandardPitch::of(hole.pitch_mm).map_or("no standard pitch", |standard| standard.name).into(),
            if hole.hand == Hand::Right { "right" } else { "left" }.into(),
            match (hole.peck_mm, hole.retract) {
                (Some(peck_mm), Some(Retract::Full)) => format!("{peck_mm:.3} mm, full retract"),
                (Some(peck_mm), _) => format!("{peck_mm:.3} mm, chip break"),
                (None, _) => "none".into(),
            },
            line.to_string(),
            count.to_string(),
            format!("{:.4}", hole.pitch_mm),
            format!("{:.2}", MM_PER_INCH / hole.pitch_mm),
            format!("{:.0}", hole.speed_rpm),
            format!("{:.0}", hole.out_speed_rpm),
            format!("{:.1}", hole.pitch_mm * hole.speed_rpm),
            format!("{:.3}", hole.depth_mm()),
            format!("{:.3}", hole.dwell_s),
        ]);
    }
    table.to_string()
}
