//! What the fuzzer of `tests/fuzz/` reached, through the same checks without a fuzzer: its kept corpus, and every finding
//! in `tests/fuzz/found/` (`slow_*`: an endless loop whose every round finds errors).

use std::fs;
use std::path::{Path, PathBuf};

use super::exercise;

/// The fuzzer is a package of its own, which a published crate does not hold.
fn fuzzer() -> Option<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fuzz");
    folder.join("Cargo.toml").exists().then_some(folder)
}

#[allow(clippy::print_stdout, reason = "the last one printed is the one that failed")]
fn replay(fuzzer: &Path, folder: &str) -> usize {
    let folder = fuzzer.join(folder);
    let mut count = 0;
    for entry in fs::read_dir(folder).expect("folder") {
        let path = entry.expect("entry").path();
        if path.ends_with(".gitattributes") {
            continue;
        }
        println!("{}", path.display());
        exercise::exercise(&fs::read(path).expect("input"));
        count += 1;
    }
    count
}

#[test]
fn the_corpus_keeps_every_promise() {
    if let Some(fuzzer) = fuzzer() {
        assert!(replay(&fuzzer, "corpus") > 100);
    }
}

#[test]
fn what_was_found_stays_mended() {
    if let Some(fuzzer) = fuzzer() {
        assert!(replay(&fuzzer, "found") > 0);
    }
}
