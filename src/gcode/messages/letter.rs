//! Letters of words in messages.

use std::fmt;

use crate::gcode::dialect::{COMMA_I, COMMA_J, COMMA_R, COMMA_S};

/// A letter as text.
pub(super) struct Letter(pub(super) u8);

impl fmt::Display for Letter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            COMMA_R => f.write_str(",R"),
            COMMA_S => f.write_str(",S"),
            COMMA_I => f.write_str(",I"),
            COMMA_J => f.write_str(",J"),
            letter => write!(f, "{}", char::from(letter)),
        }
    }
}
