//! What a host calls: hole after hole ([`Tapping`]), or a whole block with the moves between its holes ([`Block`]).
//!
//! Both go through the same sequence. On the approach each period is observed, so that the machine is measured while it moves. The
//! spindle is braked to rest, spindle and Z come into position, the strokes run, Z is handed over without a bump, and what was
//! measured and learned goes on to the next hole.

mod block;
mod block_request;
mod hole;
mod power_loss;
mod start_error;

pub use block::{Block, BlockStage, BlockStep};
pub use block_request::BlockRequest;
pub use hole::{Counters, Tapping};
pub use power_loss::{PowerLossRecord, RestoreError, RestoredHole};
pub use start_error::StartError;
