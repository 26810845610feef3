//! Spindle and Z held together through one hole: feedback in, setpoint out, each period.
//!
//! ```text
//!   counts, N·m, N                                                         rev, mm, N·m, N
//!  ───────────────►┌─────────┐                                    ┌─────────┐───────────────►
//!     Feedback     │  frame  │                                    │  frame  │    Setpoint
//!                  └────┬────┘                                    └────▲────┘
//!      travel of spindle│[rev] and Z [mm], deflection [mm], efforts    │ commands into the hole
//!          ┌────────────┼───────────────┬───────────────┐              │ [rev, mm, N·m, N]
//!          ▼            ▼               ▼               ▼              │
//!     ┌─────────┐ ┌──────────┐ ┌────────────────┐ ┌───────────┐        │
//!     │  error  │ │ observer │ │ identification │ │in_position│        │
//!     └────┬────┘ └────┬─────┘ └───────┬────────┘ └─────┬─────┘        │
//!  e(k) [mm]│  tracking│error [rev]    ▼ inertia, N, mm │ start offset │
//!          │           │       ┌─────────────┐          │ [mm]         │
//!          │           │       │ plant_model │          ▼              │
//!          ▼           ▼       └──────┬──────┘    ┌──────────────┐     │
//!     ┌──────────┐ ┌───────┐          ▼           │ synchronizer │─────┘
//!     │ learning │►│       │   ┌─────────────┐    └──────▲───────┘
//!     └──────────┘ │       │◄──│ feedforward │           │ Command
//!   correction [mm]│ stra- │   └──────▲──────┘           │
//!                  │ tegy  │──────────┼──────────────────┘
//!     ┌──────────┐ │       │          │ planned motion [rev, rev/s, rev/s²]
//!     │trajectory│►│       │──────────┘
//!     └──────────┘ └───────┘      after the hole: hand_over, residual feedforward [mm, N]
//!     path rate [1]               run-time faults: supervision, Alarm; last: drives, what each drive is sent
//! ```
//!
//! The synchronizer runs this once a period: it measures (`frame`), compares (`error`), lets the strategy command both axes,
//! and waits for in position before and after. The `strategy` is chosen once a hole. `Direct` sends the plan to both axes.
//! `ModelBased`, the default, takes these steps each period:
//!
//! 1. *Time scaling* (`trajectory`): how fast the plan's time runs. A motor that gives less than its file says takes the same
//!    path in more time.
//! 2. *Spindle* (`feedforward`): torque of friction, expected cutting and identified inertia, unlagged; the drive's references
//!    so late that its loops see no error while the spindle follows.
//! 3. *Z* (`feedforward`): commanded to where the spindle will be when Z acts, by its mechanics backwards from the load to the
//!    motor: friction of both, the screw's wind-up, and the crossing of the backlash where the screw's force turns round.
//! 4. *Tracking error* (`observer`): measured less planned spindle, filtered by the drive's own model, predicted to the instant
//!    that Z acts, and added to Z.
//! 5. *Learning* (`learning`): what earlier holes of the same kind left at this point of the path, taken off.
//!
//! What is measured of the machine in the program's approach, in a dry cycle and in every hole is gathered in [`Adaptation`],
//! which outlives the hole. Who taps hole after hole uses [`tapping`](super::tapping).

mod adaptation;
mod cutting_torque;
mod drives;
mod error;
mod feedforward;
mod frame;
mod hand_over;
mod identification;
mod in_position;
mod learning;
mod observer;
mod plant_model;
mod step;
mod strategy;
mod supervision;
mod synchronizer;
mod trajectory;

pub use adaptation::Adaptation;
pub use error::{ErrorBand, spindle_rev_from_error_um, synchronisation_error_mm};
pub use frame::{HelixZero, Scale, Standing};
pub use hand_over::ResidualFeedforward;
pub use learning::{LEARNED_BYTES, LearnedError};
pub use plant_model::{
    AxialForce, Identified, IdentifiedDrives, IdentifiedLatency, IdentifiedSpindle, IdentifiedZ, PitchError,
};
pub use step::{Stage, Step};
pub use strategy::{Compensation, Mode, Settings};
pub use supervision::{Alarm, Axis};
pub use synchronizer::Synchronizer;
