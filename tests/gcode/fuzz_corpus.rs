//! What the fuzzer of `tests/fuzz/` reached, through the same checks without a fuzzer: its kept corpus, and every finding
//! in `tests/fuzz/found/` (`slow_*`: an endless loop whose every round finds errors).

#[path = "../fuzz/exercise.rs"]
mod exercise;

use std::fs;
use std::path::Path;

#[allow(clippy::print_stdout, reason = "the last one printed is the one that failed")]
fn replay(folder: &str) -> usize {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fuzz").join(folder);
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
    assert!(replay("corpus") > 100);
}

#[test]
fn what_was_found_stays_mended() {
    assert!(replay("found") > 0);
}
