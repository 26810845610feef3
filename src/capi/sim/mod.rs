//! The simulated machine for hosts in C: spindle and Z with every effect, in place of drives and encoders.
//!
//! `rigidtap_sim.h` beside this file is the contract. It needs std and is a library of its own, built with the features `capi`
//! and `std`. Making a machine and freeing it use the heap; a period of it does not.

mod exchange;
mod machine;

pub use exchange::{RigidtapSimOptions, RigidtapSimTruth};
pub use machine::{
    RigidtapSim, rigidtap_sim_begin_hole, rigidtap_sim_check_version, rigidtap_sim_clock_s, rigidtap_sim_free,
    rigidtap_sim_machine_data, rigidtap_sim_new, rigidtap_sim_read, rigidtap_sim_set_power, rigidtap_sim_truth,
    rigidtap_sim_write,
};
