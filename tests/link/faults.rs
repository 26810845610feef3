//! A bad line: what arrives is exact, every fault is counted, and no hole is judged wrongly.

use std::collections::BTreeMap;
use std::ops::Range;

use rand::{Rng, RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use rigidtap::run::Verdict;
use rigidtap::run::analysis::Judgement;

use super::*;

/// A frame in a stall waits for its end, so many periods after its beginning.
const STALL_PERIODS: usize = 5;

/// What one bad line did to its frames, by the bytes that went over it and not by what the receiver says.
struct BadLine {
    /// Bytes and the period of their arrival.
    chunks: Vec<(Vec<u8>, usize)>,
    /// Frames whose bytes arrived as they were sent, and how late each was, in periods.
    intact: BTreeMap<usize, usize>,
    /// The same frame again.
    repeated: u64,
    /// Pieces between two ends that are no frame.
    corrupted: u64,
}

/// Each fault hits this share of the frames: never sent, a bit flipped (any one, that of its end, too), sent twice,
/// 5 ms of nothing and then all at once.
fn bad_line(clean: &[Vec<u8>], share: f64, seed: u64) -> BadLine {
    let mut random = Pcg64Mcg::seed_from_u64(seed);
    let mut chunks = Vec::new();
    let mut stalled_until = 0;
    for (k, frame) in clean.iter().enumerate() {
        let mut frame = frame.clone();
        // What is lost before the first frame or after the last one nobody can know; the frame before the last one
        // could take that with its end.
        let inner = (1..clean.len() - 2).contains(&k);
        if inner && random.random_bool(share) {
            continue;
        }
        let flipped = inner && random.random_bool(share);
        if flipped {
            let bit = random.random_range(0..frame.len() * 8);
            frame[bit / 8] ^= 1 << (bit % 8);
        }
        if inner && k >= stalled_until && random.random_bool(share) {
            stalled_until = k + STALL_PERIODS;
        }
        let arrival = k.max(stalled_until);
        if !flipped && random.random_bool(share) {
            chunks.push((frame.clone(), arrival));
        }
        chunks.push((frame, arrival));
    }
    let (mut intact, mut repeated, mut corrupted, mut piece) = (BTreeMap::new(), 0, 0, Vec::new());
    let numbers: BTreeMap<&[u8], usize> = clean.iter().enumerate().map(|(k, frame)| (frame.as_slice(), k)).collect();
    for (bytes, arrival) in &chunks {
        for byte in bytes {
            piece.push(*byte);
            if *byte != 0 {
                continue;
            }
            match numbers.get(piece.as_slice()) {
                Some(k) if intact.contains_key(k) => repeated += 1,
                Some(k) => drop(intact.insert(*k, arrival - k)),
                None => corrupted += u64::from(piece.len() > 1),
            }
            piece.clear();
        }
    }
    BadLine { chunks, intact, repeated, corrupted }
}

/// Runs over bad lines: every fault is counted, every frame that arrived has its counts and its e(k), and no verdict is
/// false. How many holes stayed whole.
fn bad_lines(period_s: f64, share: f64, seeds: Range<u64>) -> u64 {
    let machine = machine(period_s);
    let simulated = simulated(&machine, ONE_HOLE);
    let clean = frames(&simulated.readings, period_s, 32);
    let due = &simulated.holes[0];
    assert_ne!(due.verdict(), Verdict::Fail);
    let last = simulated.errors.iter().rposition(Option::is_some).unwrap();
    let mut whole = 0;
    for seed in seeds {
        let line = bad_line(&clean, share, seed);
        let mut receiver = Receiver::new(Fastest::of(&machine));
        let mut samples = Vec::new();
        for (bytes, arrival) in &line.chunks {
            receiver.receive(bytes, *arrival as f64 * period_s, &mut |sample| samples.push(sample));
        }
        // Late is later than 2 ms.
        let late = line.intact.values().filter(|periods| **periods as f64 * period_s > 2.5e-3).count();
        let counters = Counters {
            accepted: line.intact.len() as u64,
            lost: (clean.len() - line.intact.len()) as u64,
            corrupted: line.corrupted,
            repeated: line.repeated,
            late: late as u64,
            ..Counters::default()
        };
        assert_eq!(receiver.counters(), counters, "seed {seed}");
        let arrived: Vec<_> = samples.iter().map(|sample| sample.k as usize).collect();
        assert_eq!(arrived, line.intact.keys().copied().collect::<Vec<_>>(), "seed {seed}");
        for sample in &samples {
            let due = simulated.readings[sample.k as usize];
            assert_eq!(sample.spindle_counts, due.spindle_counts as f64, "seed {seed}");
            assert_eq!(sample.z_counts, due.z_counts as f64, "seed {seed}");
        }
        let found = monitored(settings(&machine), samples);
        assert_eq!((found.holes.len(), found.alarms), (1, 0), "seed {seed}");
        let hole = &found.holes[0];
        let numbers: Vec<_> =
            found.rows.iter().filter(|row| row.error_um.is_some()).map(|row| row.sample.k as usize).collect();
        let span = numbers[0]..=numbers[numbers.len() - 1];
        let missing = span.clone().filter(|k| !line.intact.contains_key(k)).count();
        assert_eq!(hole.missing, missing as u64, "seed {seed}");
        let verdict = if missing > 0 { Judgement::Gap } else { Judgement::Judged(due.verdict()) };
        assert_eq!(hole.judgement(), verdict, "seed {seed}");
        whole += u64::from(missing == 0);
        // A smooth law's last milliseconds are rest already.
        let end = span.end() + (5e-3 / period_s) as usize;
        let (first, last) = (simulated.errors.iter().position(Option::is_some).unwrap(), last);
        assert!(
            *span.start() <= first + 5 && (end >= last || !line.intact.contains_key(&last)),
            "seed {seed}: {span:?}"
        );
        let worst_um = worst_difference_um(&simulated, &found).1;
        assert!(worst_um <= count_um(&machine) * 1.000_001, "seed {seed}: {worst_um} µm");
    }
    whole
}

#[test]
fn a_thousand_bad_lines() {
    // 1 % each: of the hole's 860 periods some are always missing.
    assert_eq!(bad_lines(1e-3, 0.01, 0..1000), 0);
}

#[test]
fn bad_lines_at_10_khz() {
    assert_eq!(bad_lines(1e-4, 0.01, 0..30), 0);
}

#[test]
fn a_line_that_is_seldom_bad_leaves_some_holes_their_verdict() {
    let whole = bad_lines(1e-3, 0.0005, 0..200);
    assert!((40..160).contains(&whole), "{whole} whole holes");
}

#[test]
fn any_garbage_between_frames() {
    let machine = machine(1e-3);
    let readings: Vec<_> = (0..2000).map(|k| Reading { spindle_counts: k * 300, z_counts: -k * 18 }).collect();
    let clean = frames(&readings, 1e-3, 24);
    let mut random = Pcg64Mcg::seed_from_u64(1);
    let mut line = Vec::new();
    for frame in &clean {
        if random.random_ratio(1, 5) {
            let mut garbage = vec![0; random.random_range(0..200)];
            random.fill_bytes(&mut garbage);
            // Garbage that ends with an end costs no frame.
            garbage.push(0);
            line.extend(garbage);
        }
        line.extend(frame);
    }
    let mut receiver = Receiver::new(Fastest::of(&machine));
    let mut samples = Vec::new();
    // Bytes arrive in pieces of any size.
    for piece in line.chunks(7) {
        receiver.receive(piece, 0.0, &mut |sample| samples.push(sample));
    }
    assert_eq!((samples.len(), receiver.counters().lost), (clean.len(), 0));
    assert!(receiver.counters().corrupted > 100);
}

#[test]
fn a_lost_end_takes_two_frames() {
    let machine = machine(1e-3);
    let readings: Vec<_> = (0..10).map(|k| Reading { spindle_counts: k, z_counts: k }).collect();
    let mut line = frames(&readings, 1e-3, 16);
    line[4].pop();
    let (samples, counters) = received(&machine, &line);
    assert_eq!((samples.len(), counters.lost, counters.corrupted), (8, 2, 1));
}

#[test]
fn frames_out_of_order_and_a_restarted_board() {
    let machine = machine(1e-3);
    let readings: Vec<_> = (0..3000).map(|k| Reading { spindle_counts: k, z_counts: k }).collect();
    let mut line = frames(&readings, 1e-3, 32);
    line.swap(10, 11);
    line.extend(frames(&readings, 1e-3, 32));
    let (samples, counters) = received(&machine, &line);
    assert_eq!((counters.out_of_order, counters.lost, counters.restarts), (1, 1, 1));
    assert_eq!(samples.len() as u64, counters.accepted);
    assert_eq!(counters.accepted, 5999);
}

#[test]
fn a_fail_is_one_with_gaps_too_and_alarms_once() {
    let machine = machine(1e-3);
    let mut simulated = simulated(&machine, ONE_HOLE);
    // Z slips by 0.2 mm half way down.
    let below = |(k, reading): (usize, &Reading)| simulated.errors[k].is_some() && reading.z_counts < 30_000;
    let slip = simulated.readings.iter().enumerate().position(below).unwrap();
    simulated.readings[slip..].iter_mut().for_each(|reading| reading.z_counts -= 2000);
    let mut line = frames(&simulated.readings, 1e-3, 32);
    line.remove(slip + 20);
    let (samples, counters) = received(&machine, &line);
    assert_eq!(counters.lost, 1);
    let found = monitored(settings(&machine), samples);
    assert_eq!(found.alarms, 1);
    assert_eq!(found.holes[0].judgement(), Judgement::Judged(Verdict::Fail));
    assert_eq!((found.holes[0].gaps, found.holes[0].missing), (1, 1));
}
