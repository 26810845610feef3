//! A thread lost by millimetres is one hole to its end, and fails.

use rigidtap::run::Verdict;
use rigidtap::run::analysis::Judgement;

use super::*;

/// The paper's depth. Under a law of one acceleration the spindle falls revolutions behind and comes home after Z.
const TWO_DEEP: &[u8] = b"G90 M03 S7000\nG0 X0 Y0 Z10\nG81 R5 Z-20 F7000\nX7\nG80 M30\n";

#[test]
fn it_is_whole_and_fails() {
    let machine = machine(1e-3);
    for law in [Law::SCurve, Law::Linear, Law::TrapezoidJerk] {
        let simulated = simulated_in(&machine, TWO_DEEP, &Dialect::PAPER, law);
        let (samples, _) = received(&machine, &frames(&simulated.readings, 1e-3, 32));
        let found = monitored(settings(&machine), samples);
        assert_eq!((found.holes.len(), found.alarms), (2, 2), "{law:?}");
        let (compared, worst_um) = worst_difference_um(&simulated, &found);
        assert!(worst_um <= count_um(&machine) * 1.000_001, "{law:?}: {worst_um} µm");
        let all = simulated.errors.iter().flatten().count();
        assert!(compared as f64 > 0.99 * all as f64, "{law:?}: {compared} of {all} periods");
        for (due, hole) in simulated.holes.iter().zip(&found.holes) {
            assert!(due.error_um.peak_to_peak() > 10_000.0, "{law:?}: {:?}", due.error_um);
            // The spindle swings on after the plan's end, and is judged until it rests or Z leaves.
            assert!(hole.error_um.min() <= due.error_um.min() && hole.error_um.max() >= due.error_um.max(), "{law:?}");
            assert_eq!(hole.judgement(), Judgement::Judged(Verdict::Fail), "{law:?}");
            assert!(!hole.broken && hole.gaps == 0, "{law:?}");
            // Neither an offset nor a backlash explains this, and nothing is said of them.
            assert_eq!((hole.in_out_offset, hole.estimates), (None, None), "{law:?}");
        }
    }
}
