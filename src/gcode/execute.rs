//! One block: the order in which its words act on the state.

use crate::control::cycle::Hand;
use crate::control::units::MS_PER_S;

use super::block::Value;
use super::command::{CommandKind, SpindleCommand};
use super::cycle::Cycle;
use super::dialect::{DecimalPoint, DwellUnit, G81, GCode, GGroup, MCode, MGroup};
use super::flow::Flow;
use super::messages::{DiagnosticKind, FeedUse};
use super::modal::{FeedMode, LengthUnit, ReturnTo};
use super::output::Output;
use super::span::Place;
use super::state::{Movement, State};
use super::strokes::StrokeKind;

impl State {
    /// The words of a block act in this order, whatever theirs is:
    ///
    /// 1. units, feed mode, G90/G91, G98/G99, work offset
    /// 2. F, S
    /// 3. M03, M04, M05, M29; what changes nothing
    /// 4. a pause, a written offset, the way home
    /// 5. the motion, the stroke or the canned cycle; a hole called by name
    /// 6. M98, M99, M02, M30; variables are written
    ///
    /// What no step acted on is an error.
    pub(crate) fn execute(&mut self, output: &mut Output<'_, '_>) -> Flow {
        self.set_modes(output);
        self.set_feed(output);
        self.set_spindle(output);
        self.set_idle(output);
        let flow = self.next_program(output);
        let one_shot = self.block.g(GGroup::OneShot);
        match one_shot.map(|code| code.meaning) {
            Some(GCode::Dwell) => self.dwell(output),
            Some(GCode::WriteOffset) => self.write_offset(output),
            Some(_) => self.go_home(output),
            None => {}
        }
        self.move_axes(one_shot.is_some(), output);
        while let Some((letter, place)) = self.block.take_leftover() {
            // In a damaged block the code that would have acted on it may be the one not understood.
            output.report_if_whole(DiagnosticKind::UnusedWord { letter }, place);
        }
        for (variable, value, place) in self.block.assignments.drain(..) {
            if let Err(kind) = self.variables.write(variable, value) {
                output.report(kind, place);
            }
        }
        flow
    }

    /// M98 with P, the program, and L, how often; on a Fanuc P may hold both, P30001. M99.
    fn next_program(&mut self, output: &mut Output<'_, '_>) -> Flow {
        let Some(code) = self.block.m(MGroup::Flow) else { return Flow::Next };
        if code.meaning == MCode::Return {
            return Flow::Return;
        }
        let Some(Value { number, place }) = self.block.take(b'P') else {
            output.report_if_whole(DiagnosticKind::CallWithoutProgram { name: code.name }, code.place);
            return Flow::Next;
        };
        let repeats = self.block.take(b'L').map_or(1.0, |value| value.number.value);
        let value = number.value.max(0.0) as u32;
        let (times, program) = if value > 9999 { (value / 10_000, value % 10_000) } else { (1, value) };
        Flow::Call { program, repeats: times.saturating_mul(repeats.clamp(0.0, 1e9) as u32), place }
    }

    /// The program's end.
    pub(crate) fn end(&mut self, output: &mut Output<'_, '_>) {
        self.forget_stroke_in(output);
        output.emit(CommandKind::End);
    }

    fn set_modes(&mut self, output: &mut Output<'_, '_>) {
        if !self.block.has_g() {
            return;
        }
        for group in [GGroup::Units, GGroup::FeedMode, GGroup::Distance, GGroup::Return, GGroup::WorkOffset] {
            let Some(code) = self.block.g(group) else { continue };
            match code.meaning {
                GCode::Inch => self.modal.unit = LengthUnit::Inch,
                GCode::Millimetre => self.modal.unit = LengthUnit::Millimetre,
                GCode::FeedPerMinute => self.set_feed_mode(FeedMode::PerMinute),
                GCode::FeedPerRevolution => self.set_feed_mode(FeedMode::PerRevolution),
                GCode::Absolute => self.modal.incremental = false,
                GCode::Incremental => self.modal.incremental = true,
                GCode::ReturnInitial => self.modal.return_to = ReturnTo::Initial,
                GCode::ReturnR => self.modal.return_to = ReturnTo::R,
                GCode::WorkOffset(number) => {
                    if self.modal.work_offset != number && self.frame.same(self.modal.work_offset, number) {
                        output.report(DiagnosticKind::SameWorkOffset { name: code.name }, code.place);
                    }
                    self.modal.work_offset = number;
                }
                // G17, G40, G43, G49, G64, G97 say what always holds here; the rest moves, later.
                _ => {}
            }
        }
    }

    /// A speed is no pitch: F must be said anew when its meaning changes.
    fn set_feed_mode(&mut self, mode: FeedMode) {
        if self.modal.feed_mode != mode {
            self.modal.feed_mode = mode;
            self.modal.feed_mm = None;
        }
    }

    fn set_feed(&mut self, output: &mut Output<'_, '_>) {
        // F of a pause in seconds (SINUMERIK) is no feed.
        if self.dialect.syntax.calls && self.block.g(GGroup::OneShot).is_some() {
            return;
        }
        let Some(Value { number, place }) = self.block.take(b'F') else { return };
        // Only mm/min has the same increment, 1, with and without a point.
        let ambiguous = self.dialect.decimal_point == DecimalPoint::Fanuc
            && !number.has_point
            && (self.modal.feed_mode, self.modal.unit) != (FeedMode::PerMinute, LengthUnit::Millimetre);
        if ambiguous {
            output.report(DiagnosticKind::FeedNeedsPoint, place);
        } else if number.value <= 0.0 {
            output.report(DiagnosticKind::FeedNotPositive { feed: number.value }, place);
        }
        // Also a wrong F is taken: it was given, and reported.
        self.modal.feed_mm = Some(number.value * self.modal.unit.mm());
    }

    fn set_spindle(&mut self, output: &mut Output<'_, '_>) {
        let speed = self.block.take(b'S');
        if let Some(Value { number, place }) = speed {
            if number.value < 0.0 {
                output.report(DiagnosticKind::SpeedNegative { rpm: number.value }, place);
            }
            self.modal.speed_rpm = Some(number.value.abs());
        }
        let code = self.block.m(MGroup::Spindle);
        match code.map(|code| code.meaning) {
            Some(MCode::SpindleRight) => self.modal.hand = Some(Hand::Right),
            Some(MCode::SpindleLeft) => self.modal.hand = Some(Hand::Left),
            Some(_) => self.modal.hand = None,
            None => {}
        }
        let spindle = match (self.modal.hand, self.modal.turning_rpm()) {
            (Some(hand), Some(speed_rpm)) => SpindleCommand::On { hand, speed_rpm },
            _ => SpindleCommand::Off,
        };
        // For the next hole the spindle stands anyway, and S is but the speed of its strokes.
        if code.is_some() || (speed.is_some() && self.modal.hand.is_some() && !self.taps()) {
            self.turn(spindle, output);
        }
        if let (Some(code), Some(_), SpindleCommand::Off) = (code, self.modal.hand, spindle) {
            output.report_if_whole(DiagnosticKind::SpindleWithoutSpeed { name: code.name }, code.place);
        }
    }

    /// Whether the block belongs to a tapping cycle, or readies for one.
    fn taps(&self) -> bool {
        let motion = self.block.g(GGroup::Motion).is_some();
        let taps = |meaning| match meaning {
            GCode::Cycle81 => self.dialect.g81 == G81::Tap,
            meaning => meaning.is_hole_cycle(),
        };
        let cycle = match (self.block.g(GGroup::Cycle), self.movement) {
            (Some(code), _) => taps(code.meaning),
            (None, Movement::Cycle(cycle)) => !motion && taps(cycle.meaning()),
            _ => false,
        };
        cycle || self.block.m(MGroup::Rigid).is_some()
    }

    fn turn(&mut self, spindle: SpindleCommand, output: &mut Output<'_, '_>) {
        self.turning = spindle;
        output.emit(CommandKind::Spindle(spindle));
    }

    /// Before a cut the spindle takes the speed that S gave a tapping cycle.
    pub(crate) fn turn_for_cut(&mut self, output: &mut Output<'_, '_>) {
        if let (Some(hand), Some(speed_rpm)) = (self.modal.hand, self.modal.turning_rpm()) {
            let wanted = SpindleCommand::On { hand, speed_rpm };
            if self.turning != wanted {
                self.turn(wanted, output);
            }
        }
    }

    /// M29, and what is known and changes nothing.
    fn set_idle(&mut self, output: &mut Output<'_, '_>) {
        if self.block.has_m() {
            self.set_idle_codes(output);
        }
        // The number of the program that begins here: whoever calls it finds it by its text.
        self.block.take(b'O');
        // How far a corner may be cut, and how far a line may be off.
        if self.block.g(GGroup::Path).is_some() {
            let _ = (self.block.take(b'P'), self.block.take(b'Q'));
        }
        for letter in [b'T', b'H', b'D'] {
            self.take_idle(letter, output);
        }
    }

    fn set_idle_codes(&mut self, output: &mut Output<'_, '_>) {
        self.modal.rigid |= self.block.m(MGroup::Rigid).is_some();
        for group in [MGroup::Stop, MGroup::Tool, MGroup::Coolant, MGroup::Orient, MGroup::Panel] {
            let idle = self.block.m(group).filter(|code| matches!(code.meaning, MCode::Idle(_)));
            if let Some(code) = idle
                && self.first_of_code(code.name)
            {
                output.report(DiagnosticKind::IdleCode { name: code.name }, code.place);
            }
        }
    }

    /// G4: P by the dialect, X in seconds on a Fanuc, F in seconds on a SINUMERIK.
    fn dwell(&mut self, output: &mut Output<'_, '_>) {
        let anchor = self.block.place;
        let other = if self.dialect.syntax.calls { b'F' } else { b'X' };
        let (value, unit) = match (self.block.take(b'P'), self.dialect.dwell) {
            (Some(value), Some(unit)) => (value, unit),
            _ => match self.block.take(other) {
                Some(value) if other == b'F' || self.dialect.dwell == Some(DwellUnit::Milliseconds) => {
                    (value, DwellUnit::Seconds)
                }
                _ => return output.report_if_whole(DiagnosticKind::DwellMissing { letter: b'P' }, anchor),
            },
        };
        if let Some(dwell_s) = dwell_s(value, unit, output) {
            output.emit(CommandKind::Dwell { dwell_s });
        }
    }

    fn move_axes(&mut self, done: bool, output: &mut Output<'_, '_>) {
        let motion = self.block.g(GGroup::Motion).map(|code| code.meaning);
        let cycle = self.block.g(GGroup::Cycle);
        if motion.is_some() || cycle.is_some_and(|code| code.meaning == GCode::CancelCycle) {
            self.modal.rigid = self.block.m(MGroup::Rigid).is_some();
        }
        match (motion, cycle) {
            (Some(GCode::Rapid), _) => self.movement = Movement::Rapid,
            (Some(GCode::TapStroke), _) => self.movement = Movement::Stroke(StrokeKind::Pair),
            (Some(GCode::StrokeIn), _) => self.movement = Movement::Stroke(StrokeKind::In),
            (Some(GCode::StrokeOut), _) => self.movement = Movement::Stroke(StrokeKind::Out),
            (Some(_), _) => self.movement = Movement::Feed,
            (None, Some(code)) if code.meaning == GCode::CancelCycle => self.movement = Movement::None,
            (None, Some(code)) => match &mut self.movement {
                // Within a cycle another keeps what is stored, and the initial level.
                Movement::Cycle(cycle) => cycle.rename(code),
                movement => *movement = Movement::Cycle(Cycle::new(self.position_mm[2], code)),
            },
            (None, None) => {}
        }
        if done {
            return;
        }
        match self.movement {
            Movement::Cycle(mut cycle) => {
                self.cycle_block(&mut cycle, output);
                self.movement = Movement::Cycle(cycle);
            }
            Movement::Stroke(kind) => self.stroke(kind, output),
            _ => self.straight(output),
        }
        self.called_hole(output);
    }

    /// G0, G1.
    fn straight(&mut self, output: &mut Output<'_, '_>) {
        let places = [b'X', b'Y', b'Z'].map(|letter| self.block.place_of(letter));
        let words = self.take_axes(output);
        let machine = self.block.g(GGroup::Frame);
        let Some(anchor) = places.into_iter().flatten().next() else { return };
        self.forget_stroke_in(output);
        if let Some(code) = machine
            && self.modal.incremental
        {
            output.report(DiagnosticKind::MachineFrameIncremental { name: code.name }, code.place);
        }
        let mut to_mm = self.position_mm;
        for (axis, (to, word_mm)) in to_mm.iter_mut().zip(words).enumerate() {
            *to = match word_mm {
                Some(position_mm) if machine.is_some() => self.frame.machine_mm(axis) + position_mm,
                word_mm => self.target_mm(axis, *to, word_mm),
            };
        }
        match self.movement {
            Movement::Rapid => output.emit(CommandKind::Rapid { to_mm }),
            Movement::Feed => {
                if let Some(feed_mm_per_s) = self.feed_mm_per_s(anchor, output) {
                    self.turn_for_cut(output);
                    output.emit(CommandKind::Feed { to_mm, feed_mm_per_s });
                }
            }
            Movement::None => {
                output.report_if_whole(DiagnosticKind::NoMotionMode, anchor);
                // Said once; the next code that moves ends it.
                self.movement = Movement::Unknown;
            }
            Movement::Unknown | Movement::Stroke(_) | Movement::Cycle(_) => {}
        }
        self.position_mm = to_mm;
    }

    /// The pitch that F makes of the speed in force; none after a mistake.
    pub(crate) fn pitch_mm(&self, speed_rpm: Option<f64>, anchor: Place, output: &mut Output<'_, '_>) -> Option<f64> {
        let needed_for = match self.modal.feed_mode {
            FeedMode::PerMinute => FeedUse::PitchFromSpeed,
            FeedMode::PerRevolution => FeedUse::Pitch,
        };
        let feed_mm = output.require(self.modal.feed_mm, DiagnosticKind::FeedMissing { needed_for }, anchor)?;
        match self.modal.feed_mode {
            FeedMode::PerMinute => speed_rpm.map(|speed_rpm| feed_mm / speed_rpm),
            FeedMode::PerRevolution => Some(feed_mm),
        }
    }
}

/// Seconds of a dwell; none after a mistake.
pub(crate) fn dwell_s(value: Value, unit: DwellUnit, output: &mut Output<'_, '_>) -> Option<f64> {
    let Value { number, place } = value;
    let whole_ms = unit == DwellUnit::Milliseconds;
    if whole_ms && number.has_point && !number.computed {
        output.report(DiagnosticKind::DwellWithPoint { value: number.value }, place);
        return None;
    }
    if number.value < 0.0 {
        output.report(DiagnosticKind::DwellNegative { value: number.value }, place);
        return None;
    }
    let milliseconds = whole_ms || (unit == DwellUnit::SecondsWithPoint && !number.has_point);
    Some(if milliseconds { number.value / MS_PER_S } else { number.value })
}
