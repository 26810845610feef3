//! Spindle and Z held together through one hole: feedback in, setpoint out, each period.
//!
//! [`Compensation::None`] sends the plan to both axes and [`Compensation::Paper`] corrects Z by e(k).
//! [`Compensation::Full`] takes the machine as it is known into both commands, so that as little as can be is left to
//! correct. A hole is tapped from where Z stands once it rests at R, within two µm: friction holds it there, and what it crept
//! back would be error of the hole. Each period, in this order:
//!
//! 1. *Governor*: how fast the plan's time runs. A motor that gives less than its file says takes the same path in more
//!    time, accelerations fall with its square.
//! 2. *Spindle*: torque feedforward of friction, expected cutting and the inertia that was found, unlagged; the drive's
//!    reference so late that its loops see no error while the spindle follows.
//! 3. *Z*: commanded to where the spindle will be when Z acts, by its mechanics backwards from the table to the motor: friction
//!    of both by their pre-sliding states, the screw's stretch by the force it carries, and the way through its play where
//!    that force turns round, from where motor and scale show it to stand. Friction seen on the way in is what the reversal is
//!    commanded with.
//! 4. *Deviation*: what the measured spindle differs from its plan, filtered by the drive's own model, predicted to the
//!    instant that Z acts, and added to Z.
//! 5. *Learning*: what earlier holes of the same kind left at this point of the path, taken off; of what floats in the play, less.
//!
//! What the machine shows of itself, in the program's approach, in a dry cycle and in every hole, is gathered in
//! [`Adaptation`], which outlives the hole.

mod adaptation;
mod block;
mod compensator;
mod error;
mod governor;
mod history;
mod identify;
mod learning;
mod means;
mod path;
mod play;
mod reference;
mod screw_fit;
mod settings;
mod settling;
mod spindle_feedforward;
mod step;
mod synchronizer;
mod tapping;
mod tracker;
mod z_feedforward;
mod z_model;

pub use adaptation::{Adaptation, Lingering};
pub use block::{Block, BlockRequest, BlockStage, BlockStep};
pub use error::{ErrorBand, spindle_rev_from_error_um, synchronisation_error_mm};
pub use identify::Identified;
pub use settings::{Compensation, Mode, Settings};
pub use settling::Alarm;
pub use step::{Stage, Step};
pub use synchronizer::Synchronizer;
pub use tapping::Tapping;
