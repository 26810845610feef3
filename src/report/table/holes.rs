//! A program's holes in groups, with what F and S come to, and what the tap needs.

use super::columns::{Columns, number, text};
use super::layout::{Layout, Page};
use super::words::counted;
use crate::control::cycle::{Hand, Retract, TapCycle};
use crate::control::machine::Machine;
use crate::control::model::cutting::tapping_torque_nm;
use crate::control::thread::StandardPitch;
use crate::control::units::MM_PER_INCH;
use crate::gcode::{Command, CommandKind};

/// Most groups that are shown: beyond them nobody reads.
const MOST_GROUPS: usize = 200;

/// Holes in groups: those that follow each other and are tapped alike. In memory that does not grow with the program.
#[derive(Clone, Debug, Default)]
pub struct HoleGroups {
    /// Line, number of holes, first hole.
    groups: Vec<(u32, usize, TapCycle)>,
    /// The last hole of a group that is not shown.
    beyond: Option<TapCycle>,
    groups_beyond: usize,
    holes: usize,
}

impl HoleGroups {
    /// Adds the hole that a command makes, if it makes one.
    pub fn add(&mut self, command: &Command) {
        let CommandKind::Tap(hole) = command.kind else { return };
        self.holes += 1;
        let before = self.beyond.or_else(|| self.groups.last().map(|(_, _, first)| *first));
        if before.is_some_and(|before| before.is_alike(&hole)) {
            if let (None, Some((_, count, _))) = (self.beyond, self.groups.last_mut()) {
                *count += 1;
            }
        } else if self.groups.len() < MOST_GROUPS {
            self.groups.push((command.line, 1, hole));
        } else {
            self.beyond = Some(hole);
            self.groups_beyond += 1;
        }
    }

    /// How many holes there are in all.
    #[must_use]
    pub const fn holes(&self) -> usize {
        self.holes
    }
}

/// One line for each group: pitch beside the F and S that make it. What no hole has is a column only where there is room.
#[must_use]
pub fn holes(layout: Layout, machine: &Machine, found: &HoleGroups) -> String {
    let HoleGroups { groups, groups_beyond, .. } = found;
    if groups.is_empty() {
        return String::new();
    }
    let rank = |of: fn(&TapCycle) -> bool| if groups.iter().any(|(_, _, hole)| of(hole)) { 1 } else { 9 };
    let mut table = Columns::new(&[
        number("line", 0),
        number("holes", 0),
        text("thread", 0),
        text("hand", rank(|hole| hole.hand != Hand::Right)),
        number("pitch mm", 0),
        number("per inch", 5),
        number("S rpm", 0),
        number("S out rpm", rank(|hole| hole.out_speed_rpm != hole.speed_rpm)),
        number("F mm/min", 2),
        number("depth mm", 0),
        number("dwell s", rank(|hole| hole.dwell_s > 0.0)),
        text("peck", rank(|hole| hole.peck_mm.is_some())),
        number("drill mm", 9),
        number("error limit µm", 9),
        number("torque N·m", 9),
    ]);
    let tap = &machine.spec().tap;
    for &(line, count, hole) in groups {
        let size = machine.tap_size(hole.pitch_mm);
        table.row(vec![
            line.to_string(),
            count.to_string(),
            StandardPitch::of(hole.pitch_mm).map_or("no standard pitch", |standard| standard.name).into(),
            if hole.hand == Hand::Right { "right" } else { "left" }.into(),
            format!("{:.4}", hole.pitch_mm),
            format!("{:.2}", MM_PER_INCH / hole.pitch_mm),
            format!("{:.0}", hole.speed_rpm),
            format!("{:.0}", hole.out_speed_rpm),
            format!("{:.1}", hole.pitch_mm * hole.speed_rpm),
            format!("{:.3}", hole.depth_mm()),
            format!("{:.3}", hole.dwell_s),
            match (hole.peck_mm, hole.retract) {
                (Some(peck_mm), Some(Retract::Full)) => format!("{peck_mm:.3} mm, full retract"),
                (Some(peck_mm), _) => format!("{peck_mm:.3} mm, chip break"),
                (None, _) => "none".into(),
            },
            size.map_or_else(String::new, |(_, hole_mm)| format!("{hole_mm:.2}")),
            machine.sync_tolerance_um(hole.pitch_mm).map_or_else(String::new, |um| format!("{um:.0}")),
            size.map_or_else(String::new, |(major_mm, hole_mm)| {
                format!("{:.2}", tapping_torque_nm(major_mm, hole_mm, tap.kc_n_per_mm2, tap.tool_factor))
            }),
        ]);
    }
    let mut page = Page::new(layout);
    page.blank().table(&table);
    if *groups_beyond > 0 {
        let holes = found.holes - groups.iter().map(|(_, count, _)| count).sum::<usize>();
        page.say(format!("and {} in {}", counted(holes, "more hole"), counted(*groups_beyond, "more group")));
    }
    page.finish()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gcode::Span;

    #[test]
    fn many_groups_are_counted() {
        let mut groups = HoleGroups::default();
        for hole in 0..1000 {
            let kind = CommandKind::Tap(TapCycle::right_hand(2.0, -5.0 - f64::from(hole / 2), 1.0, 1000.0));
            groups.add(&Command { kind, line: hole, column: 1, span: Span::default() });
        }
        let text = holes(Layout::new(200, false), &Machine::reference(), &groups);
        assert_eq!((groups.holes(), text.lines().count()), (1000, 3 + MOST_GROUPS + 1));
        assert!(text.ends_with("and 600 more holes in 300 more groups\n"), "{text}");
    }
}
