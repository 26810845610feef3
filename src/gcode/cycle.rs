//! The canned cycle: what its blocks store, and the holes they make.

use crate::control::cycle::{Hand, TapCycle};

use super::block::Value;
use super::command::CommandKind;
use super::dialect::{G81, GCode, GGroup};
use super::messages::{DiagnosticKind, FeedUse};
use super::modal::{FeedMode, ReturnTo};
use super::output::Output;
use super::span::Place;
use super::state::State;

/// Most repeats of one block, the largest a Fanuc control takes. It also bounds what few bytes can ask for.
const MAX_REPEATS: u32 = 9999;

const MS_PER_S: f64 = 1000.0;

/// A level as it was programmed: kept so, since R may be programmed anew without Z.
#[derive(Clone, Copy, Debug)]
enum Level {
    /// G90.
    At(f64),
    /// G91: distance from the initial level (R), from the R plane (Z).
    From(f64),
}

impl Level {
    fn resolve_mm(self, reference_mm: f64) -> f64 {
        match self {
            Self::At(position_mm) => position_mm,
            Self::From(distance_mm) => reference_mm + distance_mm,
        }
    }
}

/// Data of the cycle in force, from G81 to G80, G0 or G1.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cycle {
    /// Z where the cycle began; holes do not change it.
    initial_mm: f64,
    r: Option<Level>,
    bottom: Option<Level>,
    bottom_place: Option<Place>,
    dwell_s: f64,
    /// A mistake was reported; what follows from it is not, until the next G81.
    broken: bool,
    /// F, S and pitch of the hole before.
    before: Option<(f64, f64, f64)>,
}

impl Cycle {
    pub(crate) const fn new(initial_mm: f64) -> Self {
        Self { initial_mm, r: None, bottom: None, bottom_place: None, dwell_s: 0.0, broken: false, before: None }
    }
}

/// What every repeat of a block shares.
#[derive(Clone, Copy, Debug)]
struct Levels {
    r_plane_mm: f64,
    bottom_mm: f64,
    return_mm: f64,
}

/// How the tap turns.
#[derive(Clone, Copy, Debug)]
struct Thread {
    hand: Hand,
    speed_rpm: f64,
    pitch_mm: f64,
}

impl Thread {
    const fn tap(self, x_mm: f64, y_mm: f64, levels: Levels, dwell_s: f64) -> CommandKind {
        CommandKind::Tap(TapCycle {
            x_mm,
            y_mm,
            r_plane_mm: levels.r_plane_mm,
            bottom_mm: levels.bottom_mm,
            return_mm: levels.return_mm,
            pitch_mm: self.pitch_mm,
            speed_rpm: self.speed_rpm,
            out_speed_rpm: self.speed_rpm,
            hand: self.hand,
            dwell_s,
            peck_mm: None,
            retract: None,
        })
    }
}

impl State {
    /// A block under G81, after its modes, F and S are in force.
    ///
    /// 1. R, Z and P are stored; G91 counts R from the initial level and Z from the R plane.
    /// 2. A block with G81, X, Y or Z makes holes; any other only stores.
    /// 3. K or L repeats: under G91 each repeat steps on by X and Y. K0 only stores, and moves nothing.
    /// 4. The return level is R under G99, under G98 the initial level or R if that is higher.
    pub(crate) fn cycle_block(&mut self, mut cycle: Cycle, output: &mut Output<'_, '_>) -> Cycle {
        let named = self.block.g(GGroup::Cycle).filter(|code| code.meaning == GCode::Cycle81);
        let anchor = named.map_or(self.block.place, |code| code.place);
        let makes_holes = named.is_some() || [b'X', b'Y', b'Z'].iter().any(|&letter| self.block.has(letter));
        if named.is_some() {
            cycle.broken = false;
        }
        self.store_cycle_words(&mut cycle, output);
        if !makes_holes {
            return cycle;
        }
        let (x, y) = (self.take_length_mm(b'X', output), self.take_length_mm(b'Y', output));
        let Some(repeats) = self.take_repeats(output) else {
            cycle.broken = true;
            return cycle;
        };
        if repeats == 0 || cycle.broken {
            return cycle;
        }
        if repeats > 1 && !(self.modal.incremental && (x.unwrap_or(0.0) != 0.0 || y.unwrap_or(0.0) != 0.0)) {
            output.report(DiagnosticKind::SameHoleAgain { times: repeats }, anchor);
        }
        let [start_x_mm, start_y_mm, _] = self.position_mm;
        let step = |start_mm: f64, word_mm: Option<f64>, index: u32| match word_mm {
            // From the start, not from the hole before: rounding must not add up.
            Some(distance_mm) if self.modal.incremental => start_mm + f64::from(index) * distance_mm,
            word_mm => self.modal.target_mm(start_mm, word_mm),
        };
        let holes = (1..=repeats).map(|index| [step(start_x_mm, x, index), step(start_y_mm, y, index)]);
        // Both are asked for before the first one that is missing ends it.
        let levels = self.levels(&cycle, anchor, output);
        let made = match self.dialect.g81 {
            G81::Tap => self.thread(&mut cycle, anchor, output).zip(levels).map(|(thread, levels)| {
                let dwell_s = cycle.dwell_s;
                holes.for_each(|[x_mm, y_mm]| output.emit(thread.tap(x_mm, y_mm, levels, dwell_s)));
                levels
            }),
            G81::Drill => self.feed_mm_per_s(anchor, output).zip(levels).map(|(feed_mm_per_s, levels)| {
                self.drill(holes, feed_mm_per_s, levels, output);
                levels
            }),
        };
        match made {
            Some(levels) => {
                self.position_mm = [step(start_x_mm, x, repeats), step(start_y_mm, y, repeats), levels.return_mm];
            }
            None => cycle.broken = true,
        }
        cycle
    }

    fn store_cycle_words(&mut self, cycle: &mut Cycle, output: &mut Output<'_, '_>) {
        let level = if self.modal.incremental { Level::From } else { Level::At };
        if let Some(r_mm) = self.take_length_mm(b'R', output) {
            cycle.r = Some(level(r_mm));
        }
        // None if Z is of an earlier block.
        cycle.bottom_place = self.block.place_of(b'Z');
        if let Some(z_mm) = self.take_length_mm(b'Z', output) {
            cycle.bottom = Some(level(z_mm));
        }
        // A drilling G81 has no dwell: P stays untaken there, and is diagnosed.
        if self.dialect.g81 == G81::Tap
            && let Some(Value { number, place }) = self.block.take(b'P')
        {
            if number.has_point {
                output.report(DiagnosticKind::DwellWithPoint { value: number.value }, place);
            } else if number.value < 0.0 {
                output.report(DiagnosticKind::DwellNegative { ms: number.value }, place);
            } else {
                cycle.dwell_s = number.value / MS_PER_S;
            }
        }
    }

    /// K or L, 1 if there is neither; none after a mistake.
    fn take_repeats(&mut self, output: &mut Output<'_, '_>) -> Option<u32> {
        let value = match (self.block.take(b'K'), self.block.take(b'L')) {
            (None, None) => return Some(1),
            (Some(_), Some(value)) => {
                output.report(DiagnosticKind::TwoRepeatWords, value.place);
                return None;
            }
            (Some(value), None) | (None, Some(value)) => value,
        };
        let repeats = value.number.value;
        if repeats < 0.0 || repeats.fract() != 0.0 {
            output.report(DiagnosticKind::BadRepeats { repeats }, value.place);
            None
        } else if repeats > f64::from(MAX_REPEATS) {
            output.report(DiagnosticKind::TooManyRepeats { repeats, limit: MAX_REPEATS }, value.place);
            None
        } else {
            Some(repeats as u32)
        }
    }

    /// The cycle's levels; none after a mistake.
    fn levels(&self, cycle: &Cycle, anchor: Place, output: &mut Output<'_, '_>) -> Option<Levels> {
        let r = output.require(cycle.r, DiagnosticKind::CycleWordMissing { letter: b'R' }, anchor);
        let bottom = output.require(cycle.bottom, DiagnosticKind::CycleWordMissing { letter: b'Z' }, anchor);
        let r_plane_mm = r?.resolve_mm(cycle.initial_mm);
        let bottom_mm = bottom?.resolve_mm(r_plane_mm);
        if bottom_mm >= r_plane_mm {
            let incremental = self.modal.incremental;
            let place = cycle.bottom_place.unwrap_or(anchor);
            output.report(DiagnosticKind::BottomNotBelowR { bottom_mm, r_plane_mm, incremental }, place);
            return None;
        }
        let return_mm = match self.modal.return_to {
            ReturnTo::Initial => cycle.initial_mm.max(r_plane_mm),
            ReturnTo::R => r_plane_mm,
        };
        Some(Levels { r_plane_mm, bottom_mm, return_mm })
    }

    /// What S, F and M03 or M04 make of it; none after a mistake.
    fn thread(&self, cycle: &mut Cycle, anchor: Place, output: &mut Output<'_, '_>) -> Option<Thread> {
        let needed_for = match self.modal.feed_mode {
            FeedMode::PerMinute => FeedUse::PitchFromSpeed,
            FeedMode::PerRevolution => FeedUse::Pitch,
        };
        // All three are asked for before the first one that is missing ends it.
        let hand = output.require(self.modal.hand, DiagnosticKind::TapWithoutSpindle, anchor);
        let speed_rpm = output.require(self.modal.turning_rpm(), DiagnosticKind::TapWithoutSpeed, anchor);
        let feed_mm = output.require(self.modal.feed_mm, DiagnosticKind::FeedMissing { needed_for }, anchor);
        let (hand, speed_rpm, feed_mm) = (hand?, speed_rpm?, feed_mm?);
        let pitch_mm = match self.modal.feed_mode {
            FeedMode::PerMinute => feed_mm / speed_rpm,
            FeedMode::PerRevolution => feed_mm,
        };
        if let Some((feed_before_mm, _, from_mm)) = cycle.before.filter(|before| before.1 != speed_rpm)
            && feed_before_mm == feed_mm
            && pitch_mm != from_mm
        {
            output.report(DiagnosticKind::PitchChanged { from_mm, to_mm: pitch_mm }, anchor);
        }
        cycle.before = Some((feed_mm, speed_rpm, pitch_mm));
        Some(Thread { hand, speed_rpm, pitch_mm })
    }

    /// Drills the holes, as RS274 has it:
    ///
    /// 1. if Z is below R, rapid to R; rapid in X and Y at that height
    /// 2. rapid to R
    /// 3. feed to the bottom
    /// 4. rapid to the return level
    fn drill(
        &self,
        holes: impl Iterator<Item = [f64; 2]>,
        feed_mm_per_s: f64,
        levels: Levels,
        output: &mut Output<'_, '_>,
    ) {
        let mut from = self.position_mm;
        for [x_mm, y_mm] in holes {
            let height_mm = from[2].max(levels.r_plane_mm);
            if height_mm > from[2] {
                output.emit(CommandKind::Rapid { to_mm: [from[0], from[1], height_mm] });
            }
            output.emit(CommandKind::Rapid { to_mm: [x_mm, y_mm, height_mm] });
            output.emit(CommandKind::Rapid { to_mm: [x_mm, y_mm, levels.r_plane_mm] });
            output.emit(CommandKind::Feed { to_mm: [x_mm, y_mm, levels.bottom_mm], feed_mm_per_s });
            from = [x_mm, y_mm, levels.return_mm];
            output.emit(CommandKind::Rapid { to_mm: from });
        }
    }
}
