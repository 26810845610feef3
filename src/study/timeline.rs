//! A program's timeline as planned: what happens when, and how long it takes. Nothing is simulated.

use std::borrow::Borrow;

use crate::control::cycle::{CyclePlan, StrokeKind};
use crate::control::machine::{Law, Machine};
use crate::gcode::program::{Action, Overrides, PlanError, Planner};
use crate::gcode::{Command, SpindleCommand};
use crate::run::SpindleMotion;

/// One step of the timeline.
#[derive(Clone, Debug, PartialEq)]
pub struct TimelineEntry {
    /// Line of the program, from 1.
    pub line: u32,
    /// When it starts.
    pub start_s: f64,
    /// How long it takes; 0 for what goes on beside the rest.
    pub duration_s: f64,
    /// Where X, Y, Z stand at its start.
    pub from_mm: [f64; 3],
    /// Where they stand at its end.
    pub to_mm: [f64; 3],
    /// Z at instants of the step: time from the program's start, and position in mm.
    pub z: Vec<(f64, f64)>,
    /// What it is.
    pub what: TimelineKind,
}

/// Instants at which a step's Z is sampled, beside its start.
const INSTANTS: u32 = 24;

/// What a step of the timeline is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TimelineKind {
    /// G0, or a cycle's positioning.
    Rapid,
    /// G1.
    Feed,
    /// G4.
    Dwell,
    /// The spindle starts to change its speed.
    Spindle(SpindleCommand),
    /// The spindle comes to rest for a hole, or to speed for a cut.
    SpindleWait,
    /// A stroke of a hole.
    Stroke {
        /// Hole, from 1.
        hole: u32,
        /// Which stroke.
        kind: StrokeKind,
        /// Pitch.
        pitch_mm: f64,
        /// Commanded speed.
        command_rpm: f64,
        /// Speed that is reached.
        peak_rpm: f64,
        /// Angle of the spindle on the R plane, rev; none where it comes to rest.
        start_angle_rev: Option<f64>,
    },
}

impl TimelineKind {
    /// Name in reports.
    #[must_use]
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Rapid => "rapid",
            Self::Feed => "feed",
            Self::Dwell => "wait",
            Self::Spindle(SpindleCommand::Off) => "spindle-off",
            Self::Spindle(SpindleCommand::On { .. }) => "spindle-on",
            Self::SpindleWait => "spindle-wait",
            Self::Stroke { kind, .. } => kind.name(),
        }
    }
}

/// Plans a program and lays it out in time, step by step; yields how long it takes. Settling at R, which depends on the
/// real machine, is not in it.
///
/// # Errors
/// [`PlanError`] of the first command that the machine cannot carry out.
pub fn timeline(
    commands: impl IntoIterator<Item: Borrow<Command>>,
    machine: &Machine,
    law: Law,
    overrides: Overrides,
    start_mm: [f64; 3],
    show: &mut dyn FnMut(TimelineEntry),
) -> Result<f64, PlanError> {
    let mut planner = Planner::new(machine, law, overrides, start_mm);
    let mut layout =
        Layout { machine, show, now_s: 0.0, at_mm: start_mm, holes: 0, spindle: SpindleMotion::at_rest(0.0) };
    for command in commands {
        let command = command.borrow();
        planner.plan(command, &mut |action| layout.add(command.line, &action))?;
    }
    Ok(layout.now_s)
}

struct Layout<'m> {
    machine: &'m Machine,
    show: &'m mut dyn FnMut(TimelineEntry),
    now_s: f64,
    at_mm: [f64; 3],
    holes: u32,
    spindle: SpindleMotion,
}

impl Layout<'_> {
    fn add(&mut self, line: u32, action: &Action) {
        match action {
            Action::Spindle(command) => {
                self.spindle.command(self.now_s, *command, self.machine);
                self.stand(line, 0.0, TimelineKind::Spindle(*command));
            }
            Action::Dwell(dwell_s) => self.stand(line, *dwell_s, TimelineKind::Dwell),
            Action::Move(found) => {
                if !found.rapid {
                    self.wait_for_spindle(line);
                }
                let what = if found.rapid { TimelineKind::Rapid } else { TimelineKind::Feed };
                self.push(line, found.profile.duration_s(), what, &|t_s| {
                    found.path.follow(&found.profile.at(t_s)).map(|axis| axis.position)
                });
            }
            Action::Tap(plan) => {
                self.holes += 1;
                self.spindle.command(self.now_s, SpindleCommand::Off, self.machine);
                self.wait_for_spindle(line);
                self.orient(line, plan);
                let [x_mm, y_mm, _] = self.at_mm;
                let cycle = plan.cycle();
                for stroke in plan.strokes() {
                    let command_rpm = match stroke.kind {
                        StrokeKind::In => cycle.speed_rpm,
                        StrokeKind::Dwell => 0.0,
                        StrokeKind::Out => cycle.out_speed_rpm,
                    };
                    let what = TimelineKind::Stroke {
                        hole: self.holes,
                        kind: stroke.kind,
                        pitch_mm: cycle.pitch_mm,
                        command_rpm,
                        peak_rpm: stroke.peak_rpm(),
                        start_angle_rev: cycle.start_angle_rev,
                    };
                    self.push(line, stroke.duration_s, what, &|t_s| {
                        let spindle = plan.at(stroke.start_s + t_s).spindle;
                        [x_mm, y_mm, cycle.r_plane_mm - plan.thread().follow(&spindle).position]
                    });
                }
            }
        }
    }

    fn wait_for_spindle(&mut self, line: u32) {
        let wait_s = self.spindle.settled_s() - self.now_s;
        if wait_s > 0.0 {
            self.stand(line, wait_s, TimelineKind::SpindleWait);
        }
    }

    /// The spindle turns to the hole's start angle.
    fn orient(&mut self, line: u32, plan: &CyclePlan) {
        // Whether there is such a turn was found out when the hole was planned.
        if let Ok(Some(turn)) = plan.orientation(self.spindle.at(self.now_s).position) {
            self.stand(line, turn.profile.duration_s(), TimelineKind::SpindleWait);
            self.spindle = SpindleMotion::at_rest(turn.to_rev);
        }
    }

    /// A step in which no axis moves.
    fn stand(&mut self, line: u32, duration_s: f64, what: TimelineKind) {
        let at_mm = self.at_mm;
        self.push(line, duration_s, what, &|_| at_mm);
    }

    fn push(&mut self, line: u32, duration_s: f64, what: TimelineKind, axes_at: &dyn Fn(f64) -> [f64; 3]) {
        let (start_s, from_mm, to_mm) = (self.now_s, self.at_mm, axes_at(duration_s));
        let instants = if from_mm == to_mm { 1 } else { INSTANTS };
        let z = (0..=instants).map(|instant| {
            let t_s = duration_s * f64::from(instant) / f64::from(instants);
            let [_, _, z_mm] = axes_at(t_s);
            (start_s + t_s, z_mm)
        });
        (self.show)(TimelineEntry { line, start_s, duration_s, from_mm, to_mm, z: z.collect(), what });
        self.now_s += duration_s;
        self.at_mm = to_mm;
    }
}
