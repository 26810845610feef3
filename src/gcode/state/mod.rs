//! What stays in force from block to block: data alone. What changes it is in `actions`.

mod cycle;
mod frame;
mod modal;
mod stroke;
mod whole;

pub(crate) use cycle::{Cycle, Level};
pub(crate) use frame::Rotation;
pub(crate) use modal::{FeedMode, LengthUnit, ReturnTo, ToolLength};
pub(crate) use stroke::{ModalHole, StrokeIn, StrokeKind};
pub(crate) use whole::{Motion, State};
