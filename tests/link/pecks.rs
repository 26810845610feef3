//! Pecks: one hole, however often the spindle turns round in it.

use rigidtap::control::cycle::Retract;

use super::*;

/// Z has come to rest before each hole: what creeps there nobody can tell from the hole's first period.
const PECKED: &[u8] = b"G0 X0 Y0 Z5.\nG4 P1000\nM29 S3000\nG84 X0. Y0. Z-20. R5. Q10. F3000.\nG80\n\
    G0 X7.\nG4 P1000\nM29 S3000\nG84 X7. Y0. Z-20. R5. Q10. F3000.\nG80\nM30\n";

fn pecked(retract: Retract, law: Law) {
    let machine = machine(1e-3);
    let mut dialect = Dialect::by_name("fanuc").unwrap();
    dialect.cycle.peck = Some(retract);
    let simulated = simulated_in(&machine, PECKED, &dialect, law);
    let (samples, _) = received(&machine, &frames(&simulated.readings, 1e-3, 32));
    let found = monitored(settings(&machine), samples);
    assert_same_error(&machine, &simulated, &found);
    assert_eq!(found.holes.len(), 2);
    for (due, hole) in simulated.holes.iter().zip(&found.holes) {
        let kinds: Vec<_> = hole.strokes.iter().map(|stroke| stroke.kind).collect();
        assert_eq!(kinds, due.strokes.iter().map(|stroke| stroke.kind).collect::<Vec<_>>(), "{law:?}");
        assert!((hole.reversal.depth_mm - 25.0).abs() < 0.05, "{law:?}: {:?}", hole.reversal);
        assert!(!hole.broken && hole.gaps == 0);
    }
    // A command acts some periods after it was given, so that a turn is seen a little later than planned.
    let strokes = found.rows.iter().filter_map(|row| row.kind.zip(simulated.kinds[row.sample.k as usize]));
    let other = strokes.filter(|(found, due)| found != due).count();
    let turns: usize = found.holes.iter().map(|hole| hole.strokes.len() - 1).sum();
    assert!(other <= 10 * turns, "{law:?}: {other} periods in the other stroke, {turns} turns");
}

#[test]
fn full_retracts_are_one_hole_under_every_law() {
    Law::ALL.into_iter().for_each(|law| pecked(Retract::Full, law));
}

#[test]
fn chip_breaks_are_one_hole_under_every_law() {
    Law::ALL.into_iter().for_each(|law| pecked(Retract::ChipBreak { back_mm: 0.2 }, law));
}
