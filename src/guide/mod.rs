//! The guide: pages about what the program and the library do, beside the documentation of each item.
//!
//! | page | tells |
//! |---|---|
//! | [`commissioning`] | from a program to a machine that taps it, step by step |
//! | [`embedding`] | the control in a kernel of one's own: Rust, C, LinuxCNC |
//! | [`power_loss`] | the tap comes out after a power cut: record, restart, retract |
//! | [`results`] | what the simulator shows, law by law and effect by effect, with the commands that show it |
//! | [`many_machines`] | sweeps in parts, on a cluster, and the worst machine on purpose |
//! | [`numerical_contract`] | tolerances, valid ranges, definitions, speed |
//! | [`plant`] | the simulated machine |
//! | [`supervision`] | faults: what is seen, how it stops, what is left of the thread |
//! | [`fmi`] | other people's plants: co-simulation FMUs |
//! | [`dialects`] | which G-code is understood |
//! | [`file_formats`] | machine file, JSON, trace, recordings |
//! | [`changelog`] | what changed, and what to write instead |

#[doc = include_str!("changelog.md")]
pub mod changelog {}
#[doc = include_str!("commissioning.md")]
pub mod commissioning {}
#[doc = include_str!("dialects.md")]
pub mod dialects {}
#[doc = include_str!("embedding.md")]
pub mod embedding {}
#[doc = include_str!("file_formats.md")]
pub mod file_formats {}
#[doc = include_str!("fmi.md")]
pub mod fmi {}
#[doc = include_str!("many_machines.md")]
pub mod many_machines {}
#[doc = include_str!("numerical_contract.md")]
pub mod numerical_contract {}
#[doc = include_str!("plant.md")]
pub mod plant {}
#[doc = include_str!("power_loss.md")]
pub mod power_loss {}
#[doc = include_str!("results.md")]
pub mod results {}
#[doc = include_str!("supervision.md")]
pub mod supervision {}
