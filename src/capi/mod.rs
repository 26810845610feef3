//! The C interface: `rigidtap.h` beside this file says what each function does, and is the contract.
//!
//! All state is the caller's, of fixed size. Nothing allocates, locks or panics; a function that cannot do what it is asked
//! says so by its status and leaves what it was given as it was.
#![allow(unsafe_code, reason = "what a C host hands over are bare pointers")]

mod block;
mod data;
mod exchange;
mod learned;
mod machine;
mod machine_data;
mod power_loss;
#[cfg(feature = "std")]
pub mod sim;
mod storage;
mod stroke;
mod tap;
mod version;

pub use block::{
    rigidtap_block_acknowledge, rigidtap_block_counters, rigidtap_block_identified, rigidtap_block_plan,
    rigidtap_block_release, rigidtap_block_resume, rigidtap_block_retract, rigidtap_block_step, rigidtap_block_stop,
};
pub use data::{RigidtapFault, RigidtapHole, RigidtapStatus};
pub use exchange::{
    RigidtapAlarm, RigidtapAxes, RigidtapBlockRequest, RigidtapCommanded, RigidtapCounters, RigidtapFeedback,
    RigidtapIdentified, RigidtapResidual, RigidtapSetpoint, RigidtapState, reports, status,
};
pub use learned::{
    rigidtap_block_load_learned, rigidtap_block_save_learned, rigidtap_tap_load_learned, rigidtap_tap_save_learned,
};
pub use machine::{
    rigidtap_check_version, rigidtap_machine_init, rigidtap_machine_reference, rigidtap_machine_tolerance_um,
};
pub use machine_data::{RigidtapMachineData, RigidtapSpeedBand, RigidtapTorquePoint};
pub use power_loss::{RigidtapRecord, rigidtap_block_record, rigidtap_tap_plan_retract, rigidtap_tap_record};
pub use storage::{RigidtapBlock, RigidtapMachine, RigidtapStroke, RigidtapTap};
pub use stroke::{rigidtap_stroke_at, rigidtap_stroke_duration_s, rigidtap_stroke_peak_rpm, rigidtap_stroke_plan};
pub use tap::{
    rigidtap_tap_acknowledge, rigidtap_tap_counters, rigidtap_tap_discard_residual, rigidtap_tap_duration_s,
    rigidtap_tap_identified, rigidtap_tap_note_commanded, rigidtap_tap_observe, rigidtap_tap_plan,
    rigidtap_tap_release, rigidtap_tap_resume, rigidtap_tap_retract, rigidtap_tap_start, rigidtap_tap_step,
    rigidtap_tap_stop,
};
pub use version::API_VERSION;

/// Where no other panic handler is: what `.ci/no_std` shows never to be reached.
#[cfg(all(not(feature = "std"), not(test), panic = "abort"))]
#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    loop {}
}
