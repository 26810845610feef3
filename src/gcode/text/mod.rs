//! A program's text: lines, places in them, numbers as written.

pub(crate) mod number;
mod source;
mod span;

pub(crate) use number::{Decimal, Number};
pub use source::Text;
pub(crate) use span::{Cursor, Place};
pub use span::{Line, MAX_BLOCK_BYTES, Span, lines};
