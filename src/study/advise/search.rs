//! The fastest setting that holds: settings in the order of the time that they promise, speeds by bisection.

use super::bench::Bench;
use super::kinds::{HoleKind, at_speed};
use super::limit::{planned_s, rounded_down, step_rpm, useful_rpm};
use super::trial::{Setting, Trial};

/// Machines of the search: those that a setting is advised for are others, and more.
pub(super) const SEARCHED: u32 = 32;
/// Bisection ends at this share of the speed.
const FINE: f64 = 0.03;
/// Slowest speed that is tried, as a share of the fastest: slower nobody taps.
const SLOWEST: f64 = 0.15;
/// From a speed that fails the next one down, as a share of it, until one holds.
const DOWN: f64 = 0.75;
/// A setting that promises less gain than this over the best one is not tried.
const LEAST_GAIN: f64 = 0.002;

/// A kind's speed under some setting, and the next one that failed.
#[derive(Clone, Copy, Debug)]
pub(super) struct Found {
    pub(super) trial: Trial,
    pub(super) failed: Option<Trial>,
}

/// What a setting came to.
#[derive(Clone, Debug)]
pub(super) enum Tried {
    /// It holds, every kind at its speed; time of all holes.
    Holds(Vec<Found>, f64),
    /// No speed holds for a kind; the slowest trial of it.
    Fails(usize, Option<Trial>),
    /// It promises no more than the best one gives.
    Slower,
}

impl Bench<'_> {
    /// Time that all holes take at best under a setting; none where a kind has no plan.
    pub(super) fn promise_s(&self, setting: &Setting, kinds: &[HoleKind]) -> Option<f64> {
        let each = kinds.iter().map(|kind| {
            let speed = useful_rpm(setting, &kind.hole)?;
            Some(kind.count as f64 * planned_s(setting, &at_speed(&kind.hole, speed))?)
        });
        each.sum()
    }

    /// Tries a setting against the best one so far; none where it was given up.
    pub(super) fn try_setting(&self, setting: &Setting, kinds: &[HoleKind], best_s: f64) -> Option<Tried> {
        let Some(mut promised_s) = self.promise_s(setting, kinds) else { return Some(Tried::Fails(0, None)) };
        let mut found = Vec::new();
        for (index, kind) in kinds.iter().enumerate() {
            if promised_s > (1.0 - LEAST_GAIN) * best_s {
                return Some(Tried::Slower);
            }
            let Some(top) = useful_rpm(setting, &kind.hole) else { return Some(Tried::Fails(index, None)) };
            let fastest_s = planned_s(setting, &at_speed(&kind.hole, top)).unwrap_or(f64::INFINITY);
            // A speed at which this kind alone takes what is left to gain is of no use.
            let most_s = fastest_s + ((1.0 - LEAST_GAIN) * best_s - promised_s) / kind.count as f64;
            let Some(speed) = self.fastest(setting, kind, top, most_s)? else { return Some(Tried::Slower) };
            if !speed.trial.holds() {
                return Some(Tried::Fails(index, Some(speed.trial)));
            }
            promised_s += kind.count as f64 * (speed.trial.hole_s - fastest_s);
            found.push(speed);
        }
        let better = promised_s < (1.0 - LEAST_GAIN) * best_s;
        Some(if better { Tried::Holds(found, promised_s) } else { Tried::Slower })
    }

    /// The fastest speed of a kind that holds, up to `top`; where none does, the slowest trial; none inside where what holds
    /// takes more than `most_s`. None outside where it was given up.
    fn fastest(&self, setting: &Setting, kind: &HoleKind, top: f64, most_s: f64) -> Option<Option<Found>> {
        let tried = |speed: f64| self.trial(setting, &at_speed(&kind.hole, speed), 1..SEARCHED + 1, true);
        let planned = |speed: f64| planned_s(setting, &at_speed(&kind.hole, speed)).unwrap_or(f64::INFINITY);
        let mut failed = None;
        let mut trial = tried(top)?;
        while !trial.holds() {
            failed = Some(trial);
            let slower = rounded_down(DOWN * trial.speed_rpm);
            if slower < SLOWEST * top || slower >= trial.speed_rpm {
                return Some(Some(Found { trial, failed }));
            }
            if planned(slower) > most_s && planned(rounded_down(f64::midpoint(slower, trial.speed_rpm))) > most_s {
                return Some(None);
            }
            trial = tried(slower)?;
        }
        let apart = |low: f64, high: f64| high - low > (FINE * high).max(1.5 * step_rpm(high));
        while let Some(above) = failed.filter(|above: &Trial| apart(trial.speed_rpm, above.speed_rpm)) {
            let middle = tried(rounded_down(f64::midpoint(trial.speed_rpm, above.speed_rpm)))?;
            if middle.holds() { trial = middle } else { failed = Some(middle) }
        }
        Some(Some(Found { trial, failed }))
    }
}
