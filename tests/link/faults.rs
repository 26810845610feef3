//! A bad line: what arrives is exact, every fault is counted, and no hole is judged wrongly.

use rand::{Rng, RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use rigidtap::run::Verdict;
use rigidtap::run::analysis::Judgement;

use super::*;

const RUNS: u64 = 1000;
const SHALLOW: &[u8] = b"G90 M03 S3000\nG0 X0 Y0 Z6\nG81 R5 Z1 F3000\nG80 M30\n";

/// 1 % of frames never sent, 1 % with a flipped bit, now and then the same again or 5 ms of nothing and then all at once.
#[test]
fn a_thousand_bad_lines() {
    let machine = machine(1e-3);
    let simulated = simulated(&machine, SHALLOW);
    let clean = frames(&simulated.readings, 1e-3, 32);
    let (mut judged, mut gaps) = (0, 0);
    for seed in 0..RUNS {
        let mut random = Pcg64Mcg::seed_from_u64(seed);
        let mut receiver = Receiver::new(Fastest::of(&machine));
        let (mut samples, mut dropped, mut flipped, mut repeated, mut stalls) = (Vec::new(), 0u64, 0u64, 0u64, 0u64);
        let mut stalled_until = 0;
        for (k, frame) in clean.iter().enumerate() {
            let mut frame = frame.clone();
            // The first and the last frame stay: what is lost before or after them nobody can know.
            let inner = k > 0 && k + 1 < clean.len();
            if inner && random.random_ratio(1, 100) {
                dropped += 1;
                continue;
            }
            if inner && random.random_ratio(1, 100) {
                // The end itself is left alone: its loss takes the next frame with it, which another test counts.
                let bit = random.random_range(0..(frame.len() - 1) * 8);
                frame[bit / 8] ^= 1 << (bit % 8);
                flipped += 1;
            } else if random.random_ratio(1, 300) {
                receiver.receive(&frame, arrival_s(k, stalled_until), &mut |sample| samples.push(sample));
                repeated += 1;
            }
            if k >= stalled_until && random.random_ratio(1, 200) {
                stalled_until = k + 5;
                stalls += 1;
            }
            receiver.receive(&frame, arrival_s(k, stalled_until), &mut |sample| samples.push(sample));
        }
        let counters = receiver.counters();
        assert_eq!((counters.lost, counters.repeated), (dropped + flipped, repeated), "seed {seed}");
        // A bit that makes an end of a byte splits its frame in two.
        assert!((flipped..=2 * flipped).contains(&counters.corrupted), "seed {seed}: {counters:?}");
        assert_eq!(counters.accepted, clean.len() as u64 - dropped - flipped, "seed {seed}");
        assert!(stalls == 0 || counters.late > 0 || dropped > 0, "seed {seed}: {counters:?}");
        for sample in &samples {
            let due = simulated.readings[sample.k as usize];
            assert_eq!(sample.spindle_counts, due.spindle_counts as f64, "seed {seed}");
            assert_eq!(sample.z_counts, due.z_counts as f64, "seed {seed}");
        }
        let found = monitored(settings(&machine), samples);
        assert_eq!((found.holes.len(), found.alarms), (1, 0), "seed {seed}");
        let hole = &found.holes[0];
        match hole.judgement() {
            Judgement::Gap => gaps += 1,
            Judgement::Judged(verdict) => {
                assert_eq!((verdict, hole.gaps), (simulated.holes[0].verdict(), 0), "seed {seed}");
                judged += 1;
            }
            Judgement::NoTolerance => panic!("M6 has one"),
        }
        assert!(hole.error_um.peak_to_peak() <= simulated.holes[0].error_um.peak_to_peak() + 0.2, "seed {seed}");
    }
    assert_eq!(judged + gaps, RUNS);
    assert!(gaps > RUNS / 2, "{gaps} holes with gaps");
}

/// Frames held back in a stall arrive together at its end.
fn arrival_s(k: usize, stalled_until: usize) -> f64 {
    k.max(stalled_until) as f64 * 1e-3
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
    let mut simulated = simulated(&machine, SHALLOW);
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
