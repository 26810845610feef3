//! Work offsets, the machine's zero, and the blocks that move or write them.
//!
//! Positions of commands count from the zero that every work offset has until the program writes one. The machine's
//! zero, which is its reference point too, is where it stood at the start.

use super::block::Value;
use super::command::CommandKind;
use super::messages::DiagnosticKind;
use super::output::Output;
use super::state::State;

/// How many work offsets there are: G54 … G59.3.
const OFFSETS: usize = 9;
const AXES: [u8; 3] = *b"XYZ";

/// Zeros of the work offsets.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Frame {
    zeros_mm: [[f64; 3]; OFFSETS],
    machine_mm: [f64; 3],
}

impl Frame {
    pub(crate) const fn new(machine_mm: [f64; 3]) -> Self {
        Self { zeros_mm: [[0.0; 3]; OFFSETS], machine_mm }
    }

    fn zeros(&self, offset: u8) -> [f64; 3] {
        self.zeros_mm.get(usize::from(offset).wrapping_sub(1)).copied().unwrap_or_default()
    }

    pub(crate) fn zero_mm(&self, offset: u8, axis: usize) -> f64 {
        self.zeros(offset).get(axis).copied().unwrap_or_default()
    }

    pub(crate) fn same(&self, one: u8, other: u8) -> bool {
        self.zeros(one) == self.zeros(other)
    }

    pub(crate) fn machine_mm(&self, axis: usize) -> f64 {
        self.machine_mm.get(axis).copied().unwrap_or_default()
    }
}

impl State {
    /// G10: the zero of a work offset.
    ///
    /// 1. L2 P n: X, Y, Z are its place from the machine's zero; under G91 how far it moves (not in RS274)
    /// 2. L20 P n, in RS274 alone: X, Y, Z are what the present position shall be called
    /// 3. L1, L10, L11: tool lengths, which change nothing
    pub(crate) fn write_offset(&mut self, output: &mut Output<'_, '_>) {
        let anchor = self.block.place;
        let kind = self.block.take(b'L');
        let Some(Value { number, place }) = kind else {
            output.report_if_whole(DiagnosticKind::BadOffset { letter: b'L', value: 0.0 }, anchor);
            self.take_axes(output);
            return;
        };
        let ngc = self.dialect.name == "linuxcnc";
        let kind = number.value;
        if [1.0, 10.0, 11.0].contains(&kind) {
            if self.first_of_code(super::dialect::CodeName { letter: b'G', tenths: 100 }) {
                output.report(DiagnosticKind::IdleWord { letter: b'L' }, place);
            }
            let _ = (self.block.take(b'P'), self.block.take(b'R'));
            self.take_axes(output);
            return;
        }
        if kind != 2.0 && !(ngc && kind == 20.0) {
            output.report(DiagnosticKind::BadOffset { letter: b'L', value: kind }, place);
            let _ = (self.block.take(b'P'), self.block.take(b'R'));
            self.take_axes(output);
            return;
        }
        let written = self.block.take(b'P');
        let axes = self.take_axes(output);
        let number = written.map_or(-1.0, |value| value.number.value);
        let known = number.fract() == 0.0 && (if ngc { 0.0..=9.0 } else { 1.0..=6.0 }).contains(&number);
        if !known {
            let place = written.map_or(anchor, |value| value.place);
            output.report_if_whole(DiagnosticKind::BadOffset { letter: b'P', value: number.max(0.0) }, place);
            return;
        }
        let offset = if number == 0.0 { self.modal.work_offset } else { number as u8 };
        for (axis, word_mm) in axes.into_iter().enumerate() {
            let Some(word_mm) = word_mm else { continue };
            let before_mm = self.frame.zero_mm(offset, axis);
            let here_mm = self.position_mm.get(axis).copied().unwrap_or_default();
            let zero_mm = match kind == 20.0 {
                true => here_mm - word_mm,
                false if self.modal.incremental && !ngc => before_mm + word_mm,
                false => self.frame.machine_mm(axis) + word_mm,
            };
            let zeros = self.frame.zeros_mm.get_mut(usize::from(offset).wrapping_sub(1));
            if let Some(slot) = zeros.and_then(|zeros| zeros.get_mut(axis)) {
                *slot = zero_mm;
            }
        }
    }

    /// G28: by rapids over the point named to the reference point, those axes alone; all where none is named.
    pub(crate) fn go_home(&mut self, output: &mut Output<'_, '_>) {
        let axes = self.take_axes(output);
        let none = axes.iter().all(Option::is_none);
        let mut over_mm = self.position_mm;
        let mut home_mm = self.position_mm;
        for (axis, word_mm) in axes.into_iter().enumerate() {
            let (Some(over), Some(home)) = (over_mm.get_mut(axis), home_mm.get_mut(axis)) else { continue };
            *over = self.target_mm(axis, *over, word_mm);
            *home = if word_mm.is_some() || none { self.frame.machine_mm(axis) } else { *over };
        }
        for to_mm in [over_mm, home_mm] {
            if to_mm != self.position_mm {
                output.emit(CommandKind::Rapid { to_mm });
                self.position_mm = to_mm;
            }
        }
    }

    /// X, Y, Z of the block, in mm.
    pub(crate) fn take_axes(&mut self, output: &mut Output<'_, '_>) -> [Option<f64>; 3] {
        AXES.map(|letter| self.take_length_mm(letter, output))
    }
}
