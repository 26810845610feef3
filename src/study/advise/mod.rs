//! What to set: the fastest speeds and law whose worst hole on many drawn machines stays under a margin of what the thread and
//! the depth allow.
//!
//! One hole of each kind is tapped on each machine. Settings are searched on few machines, and what is advised is shown on
//! `runs` others: a speed that was picked because some machines bore it would flatter itself on the same machines.

mod bench;
mod kinds;
mod limit;
mod search;
mod trial;

use std::num::{NonZeroU32, NonZeroUsize};

pub use kinds::HoleKind;
pub use limit::Limit;
pub use trial::Trial;

use bench::Bench;
use kinds::{at_speed, same};
use limit::{machine_rpm, planned_s, rounded_down};
use search::{Found, SEARCHED, Tried};
use trial::Setting;

use super::parallel::cores;
use super::simulation::Simulation;
use super::timeline::timeline;
use crate::control::cycle::TapCycle;
use crate::control::machine::{Law, Machine};
use crate::gcode::{Command, CommandKind, SpindleCommand};
use crate::laws::retuned;
use crate::sim::Spread;

/// What is asked.
#[derive(Clone, Debug, PartialEq)]
pub struct AdviseSettings {
    /// Machines that the advice is shown on.
    pub runs: NonZeroU32,
    /// Greatest share of tolerance and clearance that a hole may use.
    pub margin: f64,
    /// Laws to choose from.
    pub laws: Vec<Law>,
    /// Utilisations of the motor to choose from, for the laws that have one.
    pub shares: Vec<f64>,
    /// What the machines are drawn from; none for machines that differ in what is random alone.
    pub spread: Option<Spread>,
    /// Seed of the draws.
    pub seed: u64,
    /// Law that the programs run under now, at their own speeds.
    pub present: Law,
    /// Number of threads; none for one on each core. The advice does not depend on it.
    pub jobs: Option<NonZeroUsize>,
}

/// What is advised for one kind of hole.
#[derive(Clone, Debug, PartialEq)]
pub struct KindAdvice {
    /// The holes.
    pub kind: HoleKind,
    /// At the advised speed, on the machines that the advice is shown on.
    pub trial: Trial,
    /// As it runs now, on the machines of the search; none where that law has no plan for it.
    pub present: Option<Trial>,
    /// What keeps it from being faster.
    pub limit: Limit,
    /// Other speeds under the same law, on the machines of the search, slower first.
    pub others: Vec<Trial>,
}

/// A setting that was looked at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Alternative {
    /// Law.
    pub law: Law,
    /// Utilisation of the motor; none where the law has none.
    pub share: Option<f64>,
    /// Time of all holes of a part where it holds, on the machines of the search.
    pub holes_s: Option<f64>,
}

/// The advice.
#[derive(Clone, Debug, PartialEq)]
pub struct Advice {
    /// Law to set.
    pub law: Law,
    /// Utilisation of the motor to set; none where the law has none.
    pub share: Option<f64>,
    /// The machine with that law.
    pub machine: Machine,
    /// Kind by kind.
    pub kinds: Vec<KindAdvice>,
    /// Time of a part, that is of all programs once, as advised, without what holes wait for the axes to stand.
    pub part_s: f64,
    /// The same as it runs now; none where the present law has no plan.
    pub present_s: Option<f64>,
    /// What 20 % more torque would take off a part, with the same utilisation; none where it has no plan.
    pub more_torque_s: Option<f64>,
    /// Settings that were looked at, the fastest promise first.
    pub alternatives: Vec<Alternative>,
}

/// Why there is no advice.
#[derive(Clone, Debug, PartialEq)]
pub enum AdviseError {
    /// The programs tap no hole.
    NoHole,
    /// A move between the holes has no plan on this machine.
    NoPlan,
    /// Nothing holds: the kind that fails under the setting that came nearest, with its slowest trial where there is a plan.
    NothingHolds(Box<(HoleKind, Option<Trial>)>),
}

/// Fresh machines are drawn after the search's: a number beyond any that it takes.
const SHOWN_FROM: u32 = 1_000_001;
/// An advice that fails on fresh machines is slowed by this, and shown again on others, so many times at most.
const SLOWED: f64 = 0.93;
const MOST_SLOWED: u32 = 8;
/// Shares of the advised speed that are shown beside it.
const SHOWN_SPEEDS: [f64; 3] = [0.5, 0.75, 1.15];
/// So many more times torque for "what if".
const MORE_TORQUE: f64 = 1.2;

/// Advises for the programs' own holes on the machine that `base` has. `go_on` is asked after each machine; where it says
/// no, all is given up and there is none.
///
/// # Errors
/// [`AdviseError`].
pub fn advise(
    programs: &[Vec<Command>],
    base: &Simulation,
    settings: &AdviseSettings,
    go_on: &(dyn Fn() -> bool + Sync),
) -> Result<Option<Advice>, AdviseError> {
    let kinds = kinds::kinds(programs);
    if kinds.is_empty() {
        return Err(AdviseError::NoHole);
    }
    let threads = settings.jobs.unwrap_or_else(cores);
    let bench = Bench { base, spread: settings.spread, seed: settings.seed, threads, margin: settings.margin, go_on };
    let mut promised: Vec<(Setting, f64)> = candidates(&base.machine, settings)
        .into_iter()
        .filter_map(|setting| bench.promise_s(&setting, &kinds).map(|promise_s| (setting, promise_s)))
        .collect();
    promised.sort_by(|left, right| left.1.total_cmp(&right.1));

    let mut nearest: Option<(usize, Option<Trial>)> = None;
    let mut held: Vec<(usize, Setting, Vec<Found>, f64)> = Vec::new();
    let mut alternatives = Vec::new();
    for (setting, _) in promised {
        let best_s = held.last().map_or(f64::INFINITY, |(.., best_s)| *best_s);
        let Some(tried) = bench.try_setting(&setting, &kinds, best_s) else { return Ok(None) };
        let mut alternative = Alternative { law: setting.law, share: setting.share, holes_s: None };
        match tried {
            Tried::Holds(found, holes_s) => {
                alternative.holes_s = Some(holes_s);
                held.push((alternatives.len(), setting, found, holes_s));
            }
            Tried::Fails(kind, trial) => {
                let used = |trial: &Option<Trial>| trial.map_or(f64::INFINITY, |trial| trial.used);
                if nearest.as_ref().is_none_or(|(_, known)| used(&trial) < used(known)) {
                    nearest = Some((kind, trial));
                }
            }
            // It is not among what was looked at: nothing is known of it but that it is slower.
            Tried::Slower => continue,
        }
        alternatives.push(alternative);
    }
    // The last one that held is the fastest; where fresh machines do not bear it, the one before may do.
    while let Some((index, setting, found, _)) = held.pop() {
        let Some(shown) = bench.shown(&setting, &kinds, &found, settings.runs) else { return Ok(None) };
        match shown {
            Ok(shown) => return bench.told(programs, &kinds, setting, &shown, settings, alternatives),
            Err(()) => alternatives[index].holes_s = None,
        }
    }
    let (kind, trial) = nearest.unwrap_or((0, None));
    Err(AdviseError::NothingHolds(Box::new((kinds[kind], trial))))
}

/// Machines that an advice runs, about: for whoever shows how far it is.
#[must_use]
pub fn advise_steps(programs: &[Vec<Command>], settings: &AdviseSettings) -> usize {
    /// Trials of a kind in the search and beside the advice.
    const TRIALS: u32 = 14;
    kinds::kinds(programs).len() * (settings.runs.get() + TRIALS * SEARCHED) as usize
}

/// Every setting that may be chosen.
fn candidates(machine: &Machine, settings: &AdviseSettings) -> Vec<Setting> {
    let mut found = Vec::new();
    for &law in &settings.laws {
        if law.follows_motor_share() {
            for &share in &settings.shares {
                let machine = retuned(machine, share).ok();
                found.extend(machine.map(|machine| Setting { law, share: Some(share), machine }));
            }
        } else {
            found.push(Setting { law, share: None, machine: machine.clone() });
        }
    }
    found
}

impl Bench<'_> {
    /// The speeds on fresh machines, slowed until each holds; an error where a kind never does, none where it was given up.
    fn shown(
        &self,
        setting: &Setting,
        kinds: &[HoleKind],
        found: &[Found],
        runs: NonZeroU32,
    ) -> Option<Result<Vec<Found>, ()>> {
        let mut shown = Vec::new();
        for (kind, found) in kinds.iter().zip(found) {
            let (mut speed_rpm, mut failed) = (found.trial.speed_rpm, found.failed);
            let mut from = SHOWN_FROM;
            let mut held = None;
            for _ in 0..MOST_SLOWED {
                let trial = self.trial(setting, &at_speed(&kind.hole, speed_rpm), from..from + runs.get(), true)?;
                from += runs.get();
                if trial.holds() {
                    held = Some(trial);
                    break;
                }
                failed = Some(trial);
                speed_rpm = rounded_down(SLOWED * speed_rpm);
            }
            let Some(trial) = held else { return Some(Err(())) };
            shown.push(Found { trial, failed });
        }
        Some(Ok(shown))
    }

    /// All that is told of the setting that was found; none where it was given up.
    fn told(
        &self,
        programs: &[Vec<Command>],
        kinds: &[HoleKind],
        setting: Setting,
        found: &[Found],
        settings: &AdviseSettings,
        alternatives: Vec<Alternative>,
    ) -> Result<Option<Advice>, AdviseError> {
        let present = Setting { law: settings.present, share: None, machine: self.base.machine.clone() };
        let searched = |setting: &Setting, hole: &TapCycle| self.trial(setting, hole, 1..SEARCHED + 1, false);
        let mut told = Vec::new();
        for (kind, found) in kinds.iter().zip(found) {
            let advised = at_speed(&kind.hole, found.trial.speed_rpm);
            let most = machine_rpm(&setting.machine, &kind.hole);
            let mut others = Vec::new();
            for share in SHOWN_SPEEDS {
                let speed_rpm = rounded_down(share * found.trial.speed_rpm).min(most);
                if speed_rpm != found.trial.speed_rpm {
                    others.extend(searched(&setting, &at_speed(&kind.hole, speed_rpm)));
                }
            }
            let failed = found.failed.map(|failed| (failed.speed_rpm, failed.worst_run, failed.by_depth));
            told.push(KindAdvice {
                kind: *kind,
                trial: found.trial,
                present: searched(&present, &kind.hole),
                limit: self.limit(&setting, &advised, failed),
                others,
            });
        }
        if !(self.go_on)() {
            return Ok(None);
        }
        let advised_speed = |hole: &TapCycle| {
            let advice = told.iter().find(|advice| same(&advice.kind.hole, hole));
            advice.map_or(*hole, |advice| at_speed(hole, advice.trial.speed_rpm))
        };
        let measured = |setting: &Setting, of: &dyn Fn(&KindAdvice) -> Option<(Trial, TapCycle)>| -> f64 {
            let each = told.iter().filter_map(|advice| {
                let (trial, hole) = of(advice)?;
                Some(advice.kind.count as f64 * (trial.hole_s - planned_s(setting, &hole)?))
            });
            each.sum()
        };
        let planned = self.part_s(programs, &setting, &advised_speed).ok_or(AdviseError::NoPlan)?;
        let slowed = measured(&setting, &|advice| Some((advice.trial, advised_speed(&advice.kind.hole))));
        let own_speed = |hole: &TapCycle| *hole;
        let present_s = self.part_s(programs, &present, &own_speed);
        let present_slowed = measured(&present, &|advice| Some((advice.present?, advice.kind.hole)));
        let stronger = stronger(&setting);
        let more_torque = stronger.and_then(|stronger| self.part_s(programs, &stronger, &advised_speed));
        Ok(Some(Advice {
            law: setting.law,
            share: setting.share,
            part_s: planned + slowed,
            present_s: present_s.map(|planned_s| planned_s + present_slowed),
            more_torque_s: more_torque.map(|stronger_s| planned - stronger_s),
            machine: setting.machine,
            kinds: told,
            alternatives,
        }))
    }

    /// Planned time of all programs with other speeds; none where there is no plan.
    fn part_s(
        &self,
        programs: &[Vec<Command>],
        setting: &Setting,
        speed: &dyn Fn(&TapCycle) -> TapCycle,
    ) -> Option<f64> {
        let changed = |command: &Command| match command.kind {
            CommandKind::Tap(hole) => Command { kind: CommandKind::Tap(speed(&hole)), ..*command },
            // S of the holes stands in these words, too; what is advised is no faster than the spindle.
            CommandKind::Spindle(SpindleCommand::On { hand, speed_rpm }) => {
                let speed_rpm = speed_rpm.min(setting.machine.spec().spindle.max_rpm);
                Command { kind: CommandKind::Spindle(SpindleCommand::On { hand, speed_rpm }), ..*command }
            }
            _ => *command,
        };
        let run = &self.base.settings;
        let each = programs.iter().map(|commands| {
            let commands = commands.iter().map(changed);
            timeline(commands, &setting.machine, setting.law, run.overrides, run.run.start_mm, &mut |_| {}).ok()
        });
        each.sum()
    }
}

/// The same setting on a machine with more torque.
fn stronger(setting: &Setting) -> Option<Setting> {
    let machine = setting.machine.with(|spec| {
        spec.spindle.torque_curve.iter_mut().for_each(|point| point.torque_nm *= MORE_TORQUE);
    });
    let machine = machine.ok()?;
    let machine = retuned(&machine, setting.share.unwrap_or(machine.spec().law.motor_share)).ok()?;
    Some(Setting { machine, ..setting.clone() })
}
