//! From commands to planned actions: each move with its time law, each hole with its strokes, in the order of the program.
//!
//! A planner takes one command at a time, so a program of any length needs no more memory than one hole.

use crate::control::coupling::Line;
use crate::control::cycle::{CycleError, CyclePlan, Positioning, TapCycle};
use crate::control::machine::{Law, Machine};
use crate::control::profile::Profile;
use crate::gcode::command::{Command, CommandKind, SpindleCommand};

pub use crate::gcode::planning_error::PlanError;

/// Something the machine does, planned.
#[derive(Clone, Debug, PartialEq)]
pub enum Action {
    /// A straight line of X, Y and Z.
    Move(Box<Move>),
    /// All axes stand for so many seconds; the spindle goes on.
    Dwell(f64),
    /// The spindle's speed starts to change; what follows does not wait for it, unless it cuts.
    Spindle(SpindleCommand),
    /// The spindle comes to rest and one hole is tapped, from R back to R.
    Tap(Box<CyclePlan>),
}

/// A straight line with its time law.
#[derive(Clone, Debug, PartialEq)]
pub struct Move {
    /// G0, or part of a cycle's positioning; else G1.
    pub rapid: bool,
    /// Path length to axes.
    pub path: Line<3>,
    /// Path length over time, mm.
    pub profile: Profile,
}

/// Longest program, 100 hours: beyond it a number is wrong by orders of magnitude.
const LONGEST_S: f64 = 360_000.0;

/// Overrides as factors. Inside a synchronous stroke both are ignored.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Overrides {
    /// On G0 and on a cycle's positioning, more than 0 up to 1.
    pub rapid: f64,
    /// On G1: the speed override K of the multi-axis paper; more than 0 up to 2.
    pub feed: f64,
}

impl Default for Overrides {
    fn default() -> Self {
        Self { rapid: 1.0, feed: 1.0 }
    }
}

/// A command that this machine cannot carry out, with its place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CommandError {
    /// The command.
    pub command: Command,
    /// Why not.
    pub error: PlanError,
}

/// Plans commands, and reports every one that this machine cannot carry out; nothing moves.
///
/// ```
/// use rigidtap::control::machine::{Law, Machine};
/// use rigidtap::gcode::program::{Checker, Overrides};
/// use rigidtap::gcode::{Dialect, Options, interpret};
/// let machine = Machine::reference();
/// let mut checker = Checker::new(&machine, Law::TorqueCurve, Overrides::default(), Options::default().start_mm);
/// let mut refused = Vec::new();
/// for command in interpret(b"M03 S90000\nM30", &Dialect::PAPER, Options::default()).commands {
///     checker.command(&command, &mut |rejected| refused.push(rejected.error.to_string()));
/// }
/// assert!(refused[0].contains("8000"), "{refused:?}");
/// ```
#[derive(Clone, Debug)]
pub struct Checker<'m> {
    planner: Planner<'m>,
    /// Every further command would be too long as well.
    too_long: bool,
}

impl<'m> Checker<'m> {
    /// For a machine that stands at `start_mm`.
    #[must_use]
    pub fn new(machine: &'m Machine, law: Law, overrides: Overrides, start_mm: [f64; 3]) -> Self {
        Self { planner: Planner::new(machine, law, overrides, start_mm), too_long: false }
    }

    /// The next command.
    pub fn command(&mut self, command: &Command, report: &mut dyn FnMut(CommandError)) {
        if self.too_long {
            return;
        }
        if let Err(error) = self.planner.plan(command, &mut |_| {}) {
            report(CommandError { command: *command, error });
            self.too_long = matches!(error, PlanError::TooLong { .. });
        }
    }
}

/// Plans commands in the order of the program.
#[derive(Clone, Debug)]
pub struct Planner<'m> {
    machine: &'m Machine,
    law: Law,
    overrides: Overrides,
    position_mm: [f64; 3],
    spindle: SpindleCommand,
    /// A hole left the spindle at rest although M03 or M04 is in force.
    spindle_rests: bool,
    /// Planned time so far, without the spindle's own.
    time_s: f64,
}

impl<'m> Planner<'m> {
    /// A planner for a machine that stands at `start_mm`.
    #[must_use]
    pub fn new(machine: &'m Machine, law: Law, overrides: Overrides, start_mm: [f64; 3]) -> Self {
        Self {
            machine,
            law,
            overrides,
            position_mm: start_mm,
            spindle: SpindleCommand::Off,
            spindle_rests: false,
            time_s: 0.0,
        }
    }

    /// Plans one command and hands over its actions in order.
    ///
    /// # Errors
    /// [`PlanError`]; the actions handed over for this command before it are void.
    pub fn plan(&mut self, command: &Command, act: &mut dyn FnMut(Action)) -> Result<(), PlanError> {
        let planned = self.plan_kind(&command.kind, act);
        if self.time_s > LONGEST_S {
            return Err(PlanError::TooLong { planned_s: self.time_s, limit_s: LONGEST_S });
        }
        planned
    }

    fn plan_kind(&mut self, kind: &CommandKind, act: &mut dyn FnMut(Action)) -> Result<(), PlanError> {
        match *kind {
            CommandKind::Rapid { to_mm } => self.line(to_mm, None, act),
            CommandKind::Feed { to_mm, feed_mm_per_s } => {
                // A hole leaves the spindle at rest; what cuts next finds it turning as M03 said.
                if std::mem::take(&mut self.spindle_rests) {
                    act(Action::Spindle(self.spindle));
                }
                self.line(to_mm, Some(feed_mm_per_s), act)
            }
            CommandKind::Dwell { dwell_s } => {
                self.time_s += dwell_s;
                act(Action::Dwell(dwell_s));
                Ok(())
            }
            CommandKind::Spindle(spindle) => {
                self.check_spindle(spindle)?;
                (self.spindle, self.spindle_rests) = (spindle, false);
                act(Action::Spindle(spindle));
                Ok(())
            }
            CommandKind::Tap(cycle) => self.tap(cycle, act),
            CommandKind::End => {
                act(Action::Spindle(SpindleCommand::Off));
                Ok(())
            }
        }
    }

    fn check_spindle(&self, spindle: SpindleCommand) -> Result<(), PlanError> {
        let limit_rpm = self.machine.spec().spindle.max_rpm;
        match spindle {
            SpindleCommand::On { speed_rpm: needed_rpm, .. } if needed_rpm > limit_rpm => {
                Err(PlanError::SpindleTooFast { needed_rpm, limit_rpm })
            }
            _ => Ok(()),
        }
    }

    /// Positioning over the hole, approach to R, the hole, return. Z rises to R first where it stands below it.
    fn tap(&mut self, cycle: TapCycle, act: &mut dyn FnMut(Action)) -> Result<(), PlanError> {
        let pitch_mm = cycle.pitch_mm;
        let (plan, _) = plan_hole(cycle, self.machine, self.law).map_err(PlanError::Cycle)?;
        // F/S is written with few digits.
        const SAME_RATIO: f64 = 1e-3;
        if let Some(tap_mm) = self.machine.spec().tap.pitch_mm
            && (pitch_mm / tap_mm - 1.0).abs() >= SAME_RATIO
        {
            return Err(PlanError::PitchOfAnotherTap { pitch_mm, tap_mm });
        }
        if self.machine.sync_tolerance_um(pitch_mm).is_none() {
            return Err(PlanError::NoTolerance { pitch_mm });
        }
        if self.machine.spec().tap.kc_n_per_mm2 > 0.0 && self.machine.tap_size(pitch_mm).is_none() {
            return Err(PlanError::NoTapSize { pitch_mm });
        }
        let [x_now_mm, y_now_mm, z_now_mm] = self.position_mm;
        let travel_mm = z_now_mm.max(cycle.r_plane_mm);
        self.line([x_now_mm, y_now_mm, travel_mm], None, act)?;
        self.line([cycle.x_mm, cycle.y_mm, travel_mm], None, act)?;
        self.line([cycle.x_mm, cycle.y_mm, cycle.r_plane_mm], None, act)?;
        self.time_s += plan.duration_s();
        act(Action::Tap(Box::new(plan)));
        self.spindle_rests = self.spindle != SpindleCommand::Off;
        self.line([cycle.x_mm, cycle.y_mm, cycle.return_mm], None, act)
    }

    fn line(&mut self, to_mm: [f64; 3], feed: Option<f64>, act: &mut dyn FnMut(Action)) -> Result<(), PlanError> {
        let found = straight(self.machine, self.position_mm, to_mm, feed, self.overrides)?;
        self.position_mm = to_mm;
        if let Some(line) = found {
            self.time_s += line.profile.duration_s();
            act(Action::Move(Box::new(line)));
        }
        Ok(())
    }
}

/// How often a law is slowed until Z can follow it: laws that follow the motor have friction to overcome, and peaks that
/// jerk limits do not fall as their acceleration does.
const SLOWINGS: usize = 8;
/// The law is slowed to this much less than Z can, so that rounding does not refuse it again.
const BELOW_LIMIT: f64 = 0.999;

/// Plans a hole. A law that is too sharp for Z at this pitch is slowed to what Z can follow; the factor stands beside the
/// plan then.
///
/// # Errors
/// [`CycleError`], as the law stands in the machine file.
pub fn plan_hole(cycle: TapCycle, machine: &Machine, law: Law) -> Result<(CyclePlan, Option<f64>), CycleError> {
    let mut found = CyclePlan::new(cycle, machine, law);
    let (as_filed, mut factor) = (found.as_ref().err().copied(), 1.0);
    for _ in 0..SLOWINGS {
        let Err(CycleError::PitchTooSharp { needed_mm_per_s2, limit_mm_per_s2 }) = found else { break };
        factor *= BELOW_LIMIT * limit_mm_per_s2 / needed_mm_per_s2;
        let Ok(slowed) = machine.with(|spec| spec.law.slow_down(factor)) else { break };
        found = CyclePlan::new(cycle, &slowed, law);
    }
    let slowed = Some(factor).filter(|_| as_filed.is_some());
    found.map(|plan| (plan, slowed)).map_err(|error| as_filed.unwrap_or(error))
}

/// A straight line at rapid speed, or at a feed in mm/s; none where the travel is zero. Each axis keeps its own limits
/// (multi-axis paper, section 3).
///
/// # Errors
/// [`PlanError::Line`].
pub fn straight(
    machine: &Machine,
    from_mm: [f64; 3],
    to_mm: [f64; 3],
    feed_mm_per_s: Option<f64>,
    overrides: Overrides,
) -> Result<Option<Move>, PlanError> {
    let command = |top: f64| match feed_mm_per_s {
        None => top * overrides.rapid,
        Some(feed) => top.min(feed * overrides.feed),
    };
    let line = Positioning::plan(machine, from_mm, to_mm, command).map_err(PlanError::Line)?;
    Ok(line.map(|Positioning { path, profile }| Move { rapid: feed_mm_per_s.is_none(), path, profile }))
}
