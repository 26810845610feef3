//! Letters of words in messages.

use std::fmt;

/// A letter as text.
pub(super) struct Letter(pub(super) u8);

impl fmt::Display for Letter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", char::from(self.0))
    }
}
