//! What a hole took to cut, by the spindle's effort, against earlier holes of its kind: a tap that broke cuts next to nothing.
//!
//! A stroke begins and ends at rest, so that over the whole of it what accelerates the spindle comes to nothing, whatever the
//! inertia. What is left is friction and cut; friction is the same out of the hole, the other way round, and the cut far less.
//! So the mean torque of the strokes in and that of the strokes out, both in the thread's sense, add up to the cut alone.

use crate::control::cycle::{StrokeKind, TapCycle};
use crate::control::machine::Machine;

/// Kinds of holes that are kept apart.
const KINDS: usize = 4;
/// Holes of a kind before one is judged.
const EARLIER: u32 = 2;
/// Memory of a kind's mean, in holes.
const MOST_HOLES: u32 = 10;
/// A tap that takes less than this share of what earlier holes took is broken.
const BROKEN_SHARE: f64 = 0.3;
/// A cut below this share of the motor's torque is lost in what the drive's report is off by.
const LEAST_SHARE: f64 = 0.005;
/// Most periods that a reported torque is later than its plan.
const MOST_DELAY: usize = 24;

/// What makes holes alike.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Kind {
    pitch_mm: f64,
    depth_mm: f64,
    speed_rpm: f64,
    out_speed_rpm: f64,
    tool: u32,
}

/// Earlier holes of a kind: how many, and their mean.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Earlier {
    kind: Kind,
    holes: u32,
    mean_nm: f64,
}

/// Sum of torques, and of how many periods.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Sum {
    torque_nm: f64,
    periods: u32,
}

impl Sum {
    fn mean_nm(&self) -> Option<f64> {
        (self.periods > 0).then(|| self.torque_nm / f64::from(self.periods))
    }
}

/// A cut that a whole tap does not do with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct TooLittle {
    pub(super) torque_nm: f64,
    /// The least that a whole tap takes.
    pub(super) limit_nm: f64,
}

/// The hole under way and those before it.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct CuttingTorque {
    least_nm: f64,
    delay_periods: usize,
    earlier: [Option<Earlier>; KINDS],
    oldest: usize,
    kind: Option<Kind>,
    strokes_in: Sum,
    strokes_out: Sum,
    /// The strokes of the last periods, newest first.
    planned: [Option<StrokeKind>; MOST_DELAY],
}

impl CuttingTorque {
    pub(super) fn new(machine: &Machine) -> Self {
        let rated_nm = machine.motor().curve.torque_nm(0.0);
        // A period's mean, interpolated to the setpoint, and the current loop.
        let delay_periods = machine.spec().drive.latency_periods.max(0.0) as usize + 1;
        Self {
            least_nm: LEAST_SHARE * rated_nm,
            delay_periods: delay_periods.min(MOST_DELAY - 1),
            earlier: [None; KINDS],
            oldest: 0,
            kind: None,
            strokes_in: Sum::default(),
            strokes_out: Sum::default(),
            planned: [None; MOST_DELAY],
        }
    }

    /// A hole begins.
    pub(super) fn begin(&mut self, cycle: &TapCycle) {
        self.kind = Some(Kind {
            pitch_mm: cycle.pitch_mm,
            depth_mm: cycle.depth_mm(),
            speed_rpm: cycle.speed_rpm,
            out_speed_rpm: cycle.out_speed_rpm,
            tool: cycle.tool,
        });
        (self.strokes_in, self.strokes_out) = (Sum::default(), Sum::default());
        self.planned = [None; MOST_DELAY];
    }

    /// A synchronous period of a stroke, with the spindle's torque as its drive reports it, positive into the thread.
    pub(super) fn observe(&mut self, planned: StrokeKind, torque_nm: Option<f64>) {
        self.planned.rotate_right(1);
        if let Some(newest) = self.planned.first_mut() {
            *newest = Some(planned);
        }
        let of = self.planned.get(self.delay_periods).copied().flatten();
        let (Some(kind), Some(torque_nm)) = (of, torque_nm) else { return };
        let sum = match kind {
            StrokeKind::In => &mut self.strokes_in,
            StrokeKind::Out => &mut self.strokes_out,
            StrokeKind::Dwell => return,
        };
        sum.torque_nm += torque_nm;
        sum.periods = sum.periods.saturating_add(1);
    }

    /// The hole is done: what it took where its tap cut next to nothing.
    pub(super) fn finish(&mut self) -> Option<TooLittle> {
        let kind = self.kind.take()?;
        let torque_nm = self.strokes_in.mean_nm()? + self.strokes_out.mean_nm()?;
        let known = self.earlier.iter_mut().flatten().find(|earlier| earlier.kind == kind);
        let Some(earlier) = known else {
            let slot = self.earlier.get_mut(self.oldest)?;
            *slot = Some(Earlier { kind, holes: 1, mean_nm: torque_nm });
            self.oldest = (self.oldest + 1) % KINDS;
            return None;
        };
        let limit_nm = BROKEN_SHARE * earlier.mean_nm;
        if earlier.holes >= EARLIER && earlier.mean_nm > self.least_nm && torque_nm < limit_nm {
            return Some(TooLittle { torque_nm, limit_nm });
        }
        earlier.holes = (earlier.holes + 1).min(MOST_HOLES);
        earlier.mean_nm += (torque_nm - earlier.mean_nm) / f64::from(earlier.holes);
        None
    }
}

#[cfg(test)]
mod tests {
    use super::{CuttingTorque, TooLittle};
    use crate::control::cycle::{StrokeKind, TapCycle};
    use crate::control::machine::Machine;

    const FRICTION_NM: f64 = 0.6;
    /// As late as the reference machine's drive reports.
    const DELAY: i32 = 2;

    /// One hole whose tap takes a torque on the way in and a third of it out, its spindle accelerated and braked by 16 N·m.
    fn hole(cutting: &mut CuttingTorque, cycle: &TapCycle, cut_nm: f64) -> Option<TooLittle> {
        cutting.begin(cycle);
        let kind = |k: i32| if k < 200 { StrokeKind::In } else { StrokeKind::Out };
        for k in 0..404 {
            let acted = k - DELAY;
            let torque_nm = match acted {
                0..200 => FRICTION_NM + cut_nm + if acted < 100 { 16.0 } else { -16.0 },
                200..400 => -FRICTION_NM - cut_nm / 3.0 + if acted < 300 { -16.0 } else { 16.0 },
                _ => 0.0,
            };
            cutting.observe(kind(k), Some(torque_nm));
        }
        cutting.finish()
    }

    fn cycle(speed_rpm: f64) -> TapCycle {
        TapCycle::right_hand(2.0, -20.0, 1.0, speed_rpm)
    }

    #[test]
    fn the_third_hole_of_a_kind_is_the_first_that_is_judged() {
        let mut cutting = CuttingTorque::new(&Machine::reference());
        let found: Vec<_> = [0.5, 0.5, 0.2, 0.0].map(|cut_nm| hole(&mut cutting, &cycle(3000.0), cut_nm)).into();
        let [None, None, None, Some(TooLittle { torque_nm, limit_nm })] = found[..] else { panic!("{found:?}") };
        assert!(torque_nm.abs() < 0.02 && (limit_nm - 0.3 * 0.4 * 2.0 / 3.0).abs() < 0.02, "{torque_nm} {limit_nm}");
        // It is not taken for what a hole of its kind takes.
        assert!(hole(&mut cutting, &cycle(3000.0), 0.0).is_some() && hole(&mut cutting, &cycle(3000.0), 0.5).is_none());
    }

    #[test]
    fn air_and_other_kinds_of_holes_raise_nothing() {
        let mut cutting = CuttingTorque::new(&Machine::reference());
        assert!((0..20).all(|_| hole(&mut cutting, &cycle(3000.0), 0.0).is_none()), "air takes nothing");
        assert!((0..3).all(|_| hole(&mut cutting, &cycle(1000.0), 2.0).is_none()));
        assert_eq!(hole(&mut cutting, &cycle(2000.0), 0.0), None, "the first of its kind");
        // A drive that reports nothing.
        for _ in 0..4 {
            cutting.begin(&cycle(1000.0));
            cutting.observe(StrokeKind::In, None);
            assert_eq!(cutting.finish(), None);
        }
    }
}
