//! Faults at work on what the host reads.

use super::fault::{Axis, AxisFault, Fault, Injection};
use crate::control::port::{AxisStatus, DriveState, Feedback};

/// Most faults of one run.
pub const MOST_FAULTS: usize = 4;
/// By how much a count jumps.
const JUMP: i64 = 1_000_000;
/// Range of a counter of 24 bits.
const WRAP: i64 = 1 << 24;
/// How far a wrong scale is off.
const SCALE_ERROR: f64 = 0.02;
/// How often a senseless effort is what the drive has.
const HUGE: f64 = 10.0;

/// The faults of a run, with what they hold on to.
#[derive(Clone, Debug)]
pub(super) struct Injector {
    injections: [Option<Injection>; MOST_FAULTS],
    /// No fault will ever be.
    is_idle: bool,
    period_s: f64,
    /// Machine's time at the start of the period.
    time_s: f64,
    /// What the host read last.
    last: Feedback,
    /// Counts where a fault of direction or scale began, spindle and Z.
    onset: [Option<i64>; 2],
    /// Host's clock where it began to fall.
    clock_onset_s: Option<f64>,
}

impl Injector {
    pub(super) fn new(injections: [Option<Injection>; MOST_FAULTS], period_s: f64) -> Self {
        Self {
            injections,
            is_idle: injections.iter().all(Option::is_none),
            period_s,
            time_s: 0.0,
            last: Feedback::default(),
            onset: [None; 2],
            clock_onset_s: None,
        }
    }

    pub(super) fn set_time(&mut self, time_s: f64) {
        self.time_s = time_s;
    }

    /// Whether no fault will ever be.
    pub(super) fn is_idle(&self) -> bool {
        self.is_idle
    }

    pub(super) fn is_on(&self, fault: Fault) -> bool {
        !self.is_idle && self.active().any(|found| found == fault)
    }

    pub(super) fn is_axis_on(&self, axis: Axis, fault: AxisFault) -> bool {
        self.is_on(Fault::Axis(axis, fault))
    }

    fn active(&self) -> impl Iterator<Item = Fault> {
        let on = |injection: &&Injection| injection.is_on(self.time_s, self.period_s);
        self.injections.iter().flatten().filter(on).map(|injection| injection.fault)
    }

    /// What the host's clock shows where it should show `now_s`.
    pub(super) fn clock_s(&mut self, now_s: f64) -> f64 {
        if self.is_on(Fault::ClockNan) {
            f64::NAN
        } else if self.is_on(Fault::ClockFalls) {
            let onset_s = *self.clock_onset_s.get_or_insert(now_s);
            2.0 * onset_s - now_s - self.period_s
        } else {
            now_s
        }
    }

    /// What comes to the host of what was measured; `most` is the greatest effort of spindle and Z.
    pub(super) fn distort(&mut self, measured: Feedback, most: [f64; 2]) -> Feedback {
        let mut read = measured;
        let (faults, time_s, period_s) = (self.injections, self.time_s, self.period_s);
        for injection in faults.iter().flatten().filter(|found| found.is_on(time_s, period_s)) {
            match injection.fault {
                Fault::Axis(axis, fault) => self.distort_axis(&mut read, axis, fault, most),
                Fault::FrameInvalid => {
                    self.distort_axis(&mut read, Axis::Spindle, AxisFault::Invalid, most);
                    self.distort_axis(&mut read, Axis::Z, AxisFault::Invalid, most);
                }
                Fault::FrameRepeated => read = self.last,
                _ => {}
            }
        }
        self.last = read;
        read
    }

    fn distort_axis(&mut self, read: &mut Feedback, axis: Axis, fault: AxisFault, most: [f64; 2]) {
        let last = self.last;
        let index = axis as usize;
        let (count, last_count, status, effort) = match axis {
            Axis::Spindle => {
                (&mut read.spindle_counts, last.spindle_counts, &mut read.spindle, &mut read.spindle_torque_nm)
            }
            Axis::Z => (&mut read.z_counts, last.z_counts, &mut read.z, &mut read.z_force_n),
        };
        match fault {
            AxisFault::Invalid => (*count, status.sample_valid) = (last_count, false),
            AxisFault::Repeated | AxisFault::Frozen => *count = last_count,
            AxisFault::Jump => *count += JUMP,
            AxisFault::Wrap => *count -= WRAP,
            AxisFault::Reversed => {
                let onset = *self.onset[index].get_or_insert(*count);
                *count = 2 * onset - *count;
            }
            AxisFault::Scaled => {
                let onset = *self.onset[index].get_or_insert(*count);
                *count += (SCALE_ERROR * (*count - onset) as f64).round() as i64;
            }
            AxisFault::Trip => status.drive = Some(DriveState::NotReady),
            AxisFault::Coast => *status = AxisStatus { drive: None, ..*status },
            AxisFault::EffortNan => *effort = Some(f64::NAN),
            AxisFault::EffortHuge => *effort = Some(HUGE * most[index]),
            AxisFault::EncoderFrozen | AxisFault::Weak => {}
        }
    }
}
