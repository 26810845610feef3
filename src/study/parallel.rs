//! Independent jobs on many threads, results in the jobs' order: the same on any number of threads.

use std::num::NonZeroUsize;

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
    // No more jobs wait than threads may take up at once: after a stop none of them is begun.
    let (give, take) = channel::bounded(threads.get());
    let (finish, finished) = channel::unbounded();
    let mut results: Vec<(usize, R)> = std::thread::scope(|scope| {
        for _ in 0..threads.get().min(count) {
            let (take, finish) = (take.clone(), finish.clone());
            scope.spawn(move || {
                let mut state = state();
                for index in take {
                    let result = job(&mut state, index);
                    // The receiver outlives every thread.
                    let _ = finish.send((index, result));
                    if !go_on() {
                        return;
                    }
                }
            });
        }
        drop((take, finish));
        // An error means that every thread has stopped.
        let _ = (0..count).try_for_each(|index| give.send(index));
        drop(give);
        finished.iter().collect()
    });
    results.sort_unstable_by_key(|(index, _)| *index);
    (results.len() == count).then(|| results.into_iter().map(|(_, result)| result).collect())
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
