//! Where labels and subprograms stand, found in one pass when the first jump asks.
//!
//! Of all that a program can ask for this alone grows with it: by 24 bytes for each block with a number where there is a
//! GOTO, and by a little more for each program and subprogram.

use std::collections::HashMap;
use std::io::{Read, Seek};

use crate::gcode::blocks::{Keyword, line_number, o_word, program_number};
use crate::gcode::text::{Cursor, Line, Text};

/// Places that statements name.
#[derive(Debug, Default)]
pub(super) struct Index {
    /// By their numbers, then by their places.
    labels: Vec<(u32, Cursor)>,
    programs: Vec<(u32, Cursor)>,
    subs: HashMap<Vec<u8>, Cursor>,
}

impl Index {
    /// With labels only where something asks for them.
    pub(super) fn of<R: Read + Seek>(text: &mut Text<R>, with_labels: bool) -> Self {
        let mut index = Self::default();
        index.read(text, None, with_labels);
        for (start, number) in text.parts() {
            index.add(text, start, number);
        }
        index.sort();
        index
    }

    /// Adds the file of a subprogram that begins here, of this number where it does not say one itself.
    pub(super) fn add<R: Read + Seek>(&mut self, text: &mut Text<R>, start: Cursor, number: Option<u32>) {
        self.read(text, Some(start), true);
        self.sort();
        if let Some(number) = number.filter(|number| self.program(*number).is_none()) {
            self.programs.push((number, start));
        }
    }

    fn sort(&mut self) {
        self.labels.sort_unstable_by_key(|&(number, at)| (number, at.offset));
    }

    /// The program's own text, or the file that begins here.
    fn read<R: Read + Seek>(&mut self, text: &mut Text<R>, from: Option<Cursor>, with_labels: bool) {
        let index = self;
        let mut begun = false;
        let look = |line: Line<'_>| {
            // No control reads what stands behind the closing percent sign.
            let percent = line.text.trim_ascii_start().starts_with(b"%");
            if percent && begun {
                return false;
            }
            begun |= !matches!(line.text.trim_ascii_start().first(), None | Some(b'(' | b';'));
            let here = line.start();
            if let Some(number) = line_number(line.text) {
                index.labels.extend(with_labels.then_some((number, here)));
            } else if let Some(number) = program_number(line.text) {
                index.programs.push((number, here));
            }
            if let Some((label, Keyword::Sub, _)) = o_word(line.text) {
                index.subs.entry(label).or_insert(here);
            }
            true
        };
        match from {
            None => text.for_each(look),
            Some(start) => text.for_each_from(start, look),
        }
    }

    /// The block of this number in the program around a place: behind the place first.
    pub(super) fn label(&self, number: f64, from: usize) -> Option<Cursor> {
        let whole = number.fract() == 0.0 && (1.0..=1e9).contains(&number);
        let number = whole.then_some(number)? as u32;
        let start = self.programs.iter().rev().find(|(_, at)| at.offset <= from).map_or(0, |(_, at)| at.offset);
        let end = self.programs.iter().find(|(_, at)| at.offset > from).map_or(usize::MAX, |(_, at)| at.offset);
        let first_from = |offset: usize| {
            let index = self.labels.partition_point(|&(known, at)| (known, at.offset) < (number, offset));
            let found = self.labels.get(index).filter(|&&(known, at)| known == number && at.offset < end);
            found.map(|&(_, at)| at)
        };
        first_from(from + 1).or_else(|| first_from(start))
    }

    /// The program of this number.
    pub(super) fn program(&self, number: u32) -> Option<Cursor> {
        self.programs.iter().find(|(known, _)| *known == number).map(|(_, at)| *at)
    }

    /// The line that begins an O-word subprogram.
    pub(super) fn sub(&self, label: &[u8]) -> Option<Cursor> {
        self.subs.get(label).copied()
    }
}
