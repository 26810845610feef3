//! Independent jobs on many threads, results in the jobs' order: the same on any number of threads.

use std::collections::BTreeMap;
use std::num::NonZeroUsize;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use crossbeam::channel;

/// As many threads as there are cores.
pub(super) fn cores() -> NonZeroUsize {
    std::thread::available_parallelism().unwrap_or(NonZeroUsize::MIN)
}

/// Does jobs 0 to `count` − 1. Each thread has a state of its own, which may carry buffers but nothing that a result
/// depends on. `go_on` is asked after each job; once it says no, no further job is begun and there is no result.
pub(super) fn in_order<S, R: Send>(
    threads: NonZeroUsize,
    count: usize,
    state: &(dyn Fn() -> S + Sync),
    job: &(dyn Fn(&mut S, usize) -> R + Sync),
    go_on: &(dyn Fn() -> bool + Sync),
) -> Option<Vec<R>> {
    let mut results = Vec::new();
    let all = each_in_order(threads, count, state, job, go_on, &mut |result| {
        results.push(result);
        true
    });
    all.then_some(results)
}

/// The same, each result handed to `take` as soon as all before it are there; whether all were. Only results that came
/// before their turn are held. Where `take` says no, it is as if `go_on` had.
pub(super) fn each_in_order<S, R: Send>(
    threads: NonZeroUsize,
    count: usize,
    state: &(dyn Fn() -> S + Sync),
    job: &(dyn Fn(&mut S, usize) -> R + Sync),
    go_on: &(dyn Fn() -> bool + Sync),
    take: &mut dyn FnMut(R) -> bool,
) -> bool {
    let (next, stopped) = (AtomicUsize::new(0), AtomicBool::new(false));
    // A thread that is far ahead waits here, so that what is held stays small.
    let (finish, finished) = channel::bounded(threads.get());
    let mut taken = 0;
    std::thread::scope(|scope| {
        for _ in 0..threads.get().min(count) {
            let (finish, next, stopped) = (finish.clone(), &next, &stopped);
            scope.spawn(move || {
                let mut state = state();
                while !stopped.load(Ordering::Relaxed) {
                    let index = next.fetch_add(1, Ordering::Relaxed);
                    if index >= count {
                        return;
                    }
                    let result = job(&mut state, index);
                    // The receiver outlives every thread.
                    let _ = finish.send((index, result));
                    if !go_on() {
                        stopped.store(true, Ordering::Relaxed);
                    }
                }
            });
        }
        drop(finish);
        let mut early = BTreeMap::new();
        for (index, result) in &finished {
            early.insert(index, result);
            while let Some(result) = early.remove(&taken) {
                if !take(result) {
                    stopped.store(true, Ordering::Relaxed);
                }
                taken += 1;
            }
        }
    });
    taken == count && !stopped.into_inner()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicUsize, Ordering};

    #[test]
    fn results_come_in_the_jobs_order_on_any_number_of_threads() {
        for threads in [1, 2, 7, 40] {
            let threads = NonZeroUsize::new(threads).unwrap();
            let found = in_order(threads, 33, &|| (), &|(), index| index * index, &|| true);
            assert_eq!(found, Some((0..33).map(|index| index * index).collect()));
        }
        assert_eq!(in_order(NonZeroUsize::MIN, 0, &|| (), &|(), index| index, &|| true), Some(Vec::new()));
    }

    #[test]
    fn a_stop_ends_it_soon_and_without_result() {
        let begun = AtomicUsize::new(0);
        let job = |(): &mut (), _: usize| begun.fetch_add(1, Ordering::Relaxed);
        let found = in_order(NonZeroUsize::new(3).unwrap(), 1_000_000, &|| (), &job, &|| false);
        assert_eq!(found, None);
        assert!(begun.into_inner() <= 3);
    }
}
