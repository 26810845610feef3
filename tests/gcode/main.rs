//! G-code in, commands or diagnostics out: goldens, LinuxCNC's `rs274`, refusals by the machine, what a fuzzer found.
#![cfg(feature = "std")]

mod exercise;
mod fuzz_corpus;
mod kinds;
mod programs;
mod refusals;
mod rs274;
mod subprograms;
