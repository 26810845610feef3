//! A program's text: lines, places in them, numbers as written.

mod appended;
pub(crate) mod number;
mod source;
mod span;

pub use appended::Subprograms;
pub(crate) use appended::Wanted;
pub(crate) use number::{Decimal, Number};
pub use source::Text;
pub(crate) use span::{Cursor, Place};
pub use span::{Line, MAX_BLOCK_BYTES, Span, lines};
