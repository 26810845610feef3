//! Where labels and subprograms stand, found in one pass when the first jump asks.

use std::collections::HashMap;

use super::Cursor;
use super::statement::{Keyword, line_number, o_word, program_number};
use crate::gcode::span::lines;

/// Places that statements name.
#[derive(Debug, Default)]
pub(super) struct Index {
    labels: HashMap<u32, Vec<Cursor>>,
    programs: Vec<(u32, Cursor)>,
    subs: HashMap<Vec<u8>, Cursor>,
}

impl Index {
    pub(super) fn of(source: &[u8]) -> Self {
        let mut index = Self::default();
        for line in lines(source) {
            let here = Cursor { offset: line.offset, number: line.number };
            if let Some(number) = line_number(line.text) {
                index.labels.entry(number).or_default().push(here);
            } else if let Some(number) = program_number(line.text) {
                index.programs.push((number, here));
            }
            if let Some((label, Keyword::Sub, _)) = o_word(line.text) {
                index.subs.entry(label).or_insert(here);
            }
        }
        index
    }

    /// The block of this number in the program around a place: behind the place first.
    pub(super) fn label(&self, number: f64, from: usize) -> Option<Cursor> {
        let whole = number.fract() == 0.0 && (1.0..=1e9).contains(&number);
        let found = self.labels.get(&(whole.then_some(number)? as u32))?;
        let start = self.programs.iter().rev().find(|(_, at)| at.offset <= from).map_or(0, |(_, at)| at.offset);
        let end = self.programs.iter().find(|(_, at)| at.offset > from).map_or(usize::MAX, |(_, at)| at.offset);
        let inside = || found.iter().filter(|at| (start..end).contains(&at.offset)).copied();
        inside().find(|at| at.offset > from).or_else(|| inside().next())
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
