//! Lexer, interpreter and planner on any bytes, guided by coverage:
//!
//! ```sh
//! cargo install cargo-fuzz
//! mkdir grown
//! cargo +nightly fuzz run --fuzz-dir tests/fuzz front_end grown tests/fuzz/corpus -- \
//!     -dict=tests/fuzz/words.dict -max_len=4096 -timeout=10 -rss_limit_mb=1024 -malloc_limit_mb=512
//! ```
//!
//! `cargo test --test gcode fuzz_corpus` runs the kept corpus through the same checks without a fuzzer.
#![no_main]

#[path = "../../gcode/exercise.rs"]
mod exercise;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| exercise::exercise(bytes));
