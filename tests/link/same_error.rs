use super::*;

fn over_the_line(period_s: f64, program: &[u8], bits: u8) {
    let machine = machine(period_s);
    let simulated = simulated(&machine, program);
    let (samples, counters) = received(&machine, &frames(&simulated.readings, period_s, bits));
    assert_eq!(counters, Counters { accepted: simulated.readings.len() as u64, ..Counters::default() });
    // A counter tells where it stands only up to whole turns of its own.
    let turn = (1_u64 << bits) as f64;
    let turns = ((simulated.readings[0].z_counts as f64 - samples[0].z_counts) / turn).round();
    for (sample, reading) in samples.iter().zip(&simulated.readings) {
        assert_eq!(sample.spindle_counts, reading.spindle_counts as f64);
        assert_eq!(sample.z_counts + turns * turn, reading.z_counts as f64);
    }
    let found = monitored(settings(&machine), samples);
    assert_eq!(found.rows.len(), simulated.readings.len(), "every sample is a row");
    assert!(found.rows.windows(2).all(|pair| pair[1].sample.k == pair[0].sample.k + 1), "in order");
    assert_same_error(&machine, &simulated, &found);
}

#[test]
fn s7000_at_1_khz() {
    over_the_line(1e-3, ONE_HOLE, 32);
}

#[test]
fn s7000_at_10_khz() {
    over_the_line(1e-4, ONE_HOLE, 32);
}

#[test]
fn counters_of_20_bits_wrap() {
    over_the_line(1e-3, ONE_HOLE, 20);
}

#[test]
fn two_left_hand_holes() {
    over_the_line(1e-3, TWO_LEFT, 40);
}

#[test]
fn a_dwell_at_the_bottom_belongs_to_the_hole() {
    over_the_line(1e-3, b"G90 M03 S2000\nG0 X0 Y0 Z10\nG81 R3 Z-5 P500 F2000\nX7 P0\nG80 M30\n", 32);
}
