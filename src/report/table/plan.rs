//! `plan` for people: one stroke, or a program's timeline.

use super::columns::{Columns, number, text};
use super::layout::{Layout, Page};
use crate::control::cycle::Hand;
use crate::control::machine::Law;
use crate::control::profile::Profile;
use crate::control::units::rpm_from_rev_per_s;
use crate::gcode::SpindleCommand;
use crate::study::{TimelineEntry, TimelineKind};

/// One stroke's plan, segment by segment. `minimum_s` is what 100 % of the motor could do without friction.
#[must_use]
pub fn stroke_plan(layout: Layout, law: Law, command_rpm: f64, profile: &Profile, minimum_s: f64) -> String {
    let mut table = Columns::new(&[
        number("segment", 0),
        number("start s", 0),
        number("time s", 0),
        number("from rev", 1),
        number("from rpm", 0),
        number("to rpm", 0),
        number("rpm/s", 0),
    ]);
    for (index, segment) in profile.segments().iter().enumerate() {
        table.row(vec![
            (index + 1).to_string(),
            format!("{:.4}", segment.start_s),
            format!("{:.4}", segment.duration_s),
            format!("{:.3}", segment.start.position),
            format!("{:.0}", rpm_from_rev_per_s(segment.start.velocity)),
            format!("{:.0}", rpm_from_rev_per_s(segment.end().velocity)),
            format!("{:.0}", rpm_from_rev_per_s(segment.start.acceleration)),
        ]);
    }
    let peak_rpm = rpm_from_rev_per_s(profile.peak_velocity());
    let short = if peak_rpm < command_rpm - 0.5 {
        format!(", {command_rpm:.0} rpm commanded and not reached")
    } else {
        String::new()
    };
    Page::new(layout)
        .say(format!(
            "{law}: {distance} rev in {time:.4} s, peak {peak_rpm:.0} rpm{short}",
            law = law.name(),
            distance = profile.distance(),
            time = profile.duration_s(),
        ))
        .say(format!(
            "time over minimum {:.3}: {minimum_s:.4} s with 100 % of the motor, frictionless",
            profile.duration_s() / minimum_s
        ))
        .blank()
        .table(&table)
        .finish()
}

/// Most steps under one heading: what is longer comes as several tables, so that it need not be in memory whole.
const STEPS_OF_A_PAGE: usize = 1000;

/// A program's timeline as planned, page by page.
pub struct TimelinePages {
    layout: Layout,
    page: Columns,
    steps: usize,
}

impl TimelinePages {
    /// No step yet.
    #[must_use]
    pub fn new(layout: Layout) -> Self {
        Self { layout, page: Self::empty(), steps: 0 }
    }

    fn empty() -> Columns {
        Columns::new(&[
            number("line", 2),
            text("step", 0),
            number("hole", 1),
            number("rpm", 0),
            number("start s", 0),
            number("time s", 0),
            number("X mm", 0),
            number("Y mm", 0),
            number("Z mm", 0),
        ])
    }

    /// Adds a step; a page that is full.
    pub fn add(&mut self, entry: &TimelineEntry) -> Option<String> {
        self.page.row(timeline_row(entry));
        self.steps += 1;
        self.steps.is_multiple_of(STEPS_OF_A_PAGE).then(|| {
            let full = std::mem::replace(&mut self.page, Self::empty());
            Page::new(self.layout).table(&full).finish()
        })
    }

    /// The last page, and how long the program takes.
    #[must_use]
    pub fn finish(self, total_s: f64) -> String {
        let mut page = Page::new(self.layout);
        if self.steps == 0 || !self.steps.is_multiple_of(STEPS_OF_A_PAGE) {
            page.table(&self.page);
        }
        page.say(format!("{total_s:.3} s as planned; each R plane adds its in-position check, 10 ms or more")).finish()
    }
}

fn timeline_row(entry: &TimelineEntry) -> Vec<String> {
    let (hole, rpm) = match entry.what {
        TimelineKind::Spindle(SpindleCommand::On { hand: Hand::Right, speed_rpm }) => (None, Some(speed_rpm)),
        TimelineKind::Spindle(SpindleCommand::On { hand: Hand::Left, speed_rpm }) => (None, Some(-speed_rpm)),
        TimelineKind::Stroke { hole, peak_rpm, .. } => (Some(hole), (peak_rpm > 0.0).then_some(peak_rpm)),
        _ => (None, None),
    };
    let [x, y, z] = entry.to_mm.map(|mm| format!("{mm:.3}"));
    vec![
        entry.line.to_string(),
        entry.what.name().into(),
        hole.map_or_else(String::new, |hole| hole.to_string()),
        rpm.map_or_else(String::new, |rpm| format!("{rpm:.0}")),
        format!("{:.4}", entry.start_s),
        format!("{:.4}", entry.duration_s),
        x,
        y,
        z,
    ]
}
