//! Words and the other tokens of a block.

use super::variables::Variable;
use crate::gcode::text::{Number, Place};

/// A letter and its number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Word {
    /// Upper case.
    pub(crate) letter: u8,
    pub(crate) number: Number,
    pub(crate) place: Place,
    /// IC( ) and AC( ): a distance or a position, whatever G90 and G91 say.
    pub(crate) is_distance: Option<bool>,
}

/// What a block is made of; comments and blanks are gone.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Token {
    Word(Word),
    /// `N` with a number of any size, which nobody needs.
    LineNumber(Place),
    /// `%`.
    Percent(Place),
    /// `/`, which is no comment.
    Slash(Place),
    /// A name of several letters with what stands in parentheses after it: CYCLE84( ).
    Call {
        name: Place,
        parameters: Option<Place>,
    },
    /// `#1 = value`.
    Assignment {
        variable: Variable,
        value: Option<f64>,
        place: Place,
    },
    /// A word whose value is a vacant variable: it is as if it were not there.
    Vacant(Place),
}

impl Token {
    /// The same with its place.
    pub(super) fn at(self, here: Place) -> Self {
        match self {
            Self::Word(word) => Self::Word(Word { place: here, ..word }),
            Self::Assignment { variable, value, .. } => Self::Assignment { variable, value, place: here },
            other => other,
        }
    }
}

/// What a line holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Content {
    /// Blanks and comments.
    Nothing,
    /// A block that the block delete switch skips.
    Deleted,
    /// `%` alone.
    Percent(Place),
    /// Words; some perhaps unreadable.
    Words,
}
