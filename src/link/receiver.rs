//! From bytes to samples. Nothing that arrives can stop it, and every fault is counted.

use super::frame::{END, Frame, MAX_ENCODED, Status};
use super::sample::{Gap, Sample, Scale};
use crate::control::machine::Machine;
use crate::control::port::CountUnwrapper;
use crate::control::units::rev_per_s_from_rpm;

/// A frame this long behind its due time is late: it is used, and counted.
const LATE_S: f64 = 0.002;
/// Two crystals part by less: what a frame's lateness is measured from may grow this fast.
const DRIFT: f64 = 2e-4;
/// A sequence this far back is no stray frame: the board has started anew.
const RESTART_BEHIND: u32 = 1000;
const US_PER_S: f64 = 1e6;

/// What went over the line.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counters {
    /// Frames that became samples.
    pub accepted: u64,
    /// Numbers that never arrived, whatever became of them.
    pub lost: u64,
    /// Pieces between two ends that are no frame: flipped bits, or noise.
    pub corrupted: u64,
    /// Frames that had arrived before.
    pub repeated: u64,
    /// Frames that arrived after one of higher number; not used.
    pub out_of_order: u64,
    /// Frames that arrived more than 2 ms after their due time; used.
    pub late: u64,
    /// Frames in which the board reports a faulty encoder; not used.
    pub faulty: u64,
    /// Times that the board started anew.
    pub restarts: u64,
    /// Times that the cable came back.
    pub reconnects: u64,
    /// Samples that the analysis was too slow for.
    pub overrun: u64,
}

impl Counters {
    /// True where every reading of the board arrived once, in order and sound.
    #[must_use]
    pub fn is_clean(&self) -> bool {
        *self == Self { accepted: self.accepted, late: self.late, restarts: self.restarts, ..Self::default() }
    }
}

/// The frame accepted last.
#[derive(Clone, Copy, Debug)]
struct Last {
    sequence: u32,
    spindle_bits: u8,
    z_bits: u8,
}

/// Positions and time of a board since it started.
#[derive(Clone, Copy, Debug)]
struct Origin {
    spindle: Axis,
    z: Axis,
    clock: Axis,
    /// Least transport time seen, by a clock of arbitrary zero.
    transport_s: Option<f64>,
}

/// A counter unwrapped from its first reading on.
#[derive(Clone, Copy, Debug)]
struct Axis {
    first: i64,
    unwrapper: CountUnwrapper,
}

impl Axis {
    fn new(bits: u8, first: i64) -> Option<Self> {
        Some(Self { first, unwrapper: CountUnwrapper::new(u32::from(bits))? })
    }

    fn read(&mut self, raw: u64) -> i64 {
        self.first.wrapping_add(self.unwrapper.unwrap_count(raw))
    }
}

/// The fastest that the encoders can count: what tells a wrap from a way that nobody saw.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fastest {
    /// Spindle.
    pub spindle_counts_per_s: f64,
    /// Z.
    pub z_counts_per_s: f64,
}

impl Fastest {
    /// The machine's top speeds, with a tenth to spare.
    #[must_use]
    pub fn of(machine: &Machine) -> Self {
        const SPARE: f64 = 1.1;
        let (spec, scale) = (machine.spec(), Scale::of(machine));
        Self {
            spindle_counts_per_s: SPARE * rev_per_s_from_rpm(spec.spindle.max_rpm) * scale.counts_per_rev,
            z_counts_per_s: SPARE * spec.z.max_mm_per_s * scale.counts_per_mm,
        }
    }

    /// True where neither counter can have gone half its range in this time.
    fn is_unique(&self, last: &Last, seconds: f64) -> bool {
        let within = |counts_per_s: f64, bits: u8| counts_per_s * seconds < f64::from(bits - 1).exp2();
        within(self.spindle_counts_per_s, last.spindle_bits) && within(self.z_counts_per_s, last.z_bits)
    }
}

/// Takes bytes as they come.
///
/// ```
/// use rigidtap::link::frame::{Count, Frame, MAX_ENCODED, Status};
/// use rigidtap::link::receiver::{Fastest, Receiver};
/// let mut receiver = Receiver::new(Fastest { spindle_counts_per_s: 2e6, z_counts_per_s: 5e6 });
/// let mut found = Vec::new();
/// for sequence in [0, 1, 3] {
///     let count = Count::new(32, i64::from(sequence) * 10).unwrap();
///     let frame = Frame { status: Status(0), sequence, time_us: sequence * 1000, spindle: count, z: count };
///     let mut line = [0; MAX_ENCODED];
///     let length = frame.encode(&mut line);
///     receiver.receive(&line[..length], 0.0, &mut |sample| found.push(sample.spindle_counts));
/// }
/// assert_eq!(found, [0.0, 10.0, 30.0]);
/// assert_eq!((receiver.counters().accepted, receiver.counters().lost), (3, 1));
/// ```
#[derive(Clone, Debug)]
pub struct Receiver {
    fastest: Fastest,
    piece: [u8; MAX_ENCODED],
    length: usize,
    last: Option<Last>,
    origin: Option<Origin>,
    k: u64,
    time_s: f64,
    clock_s: f64,
    gap: Gap,
    counters: Counters,
    /// A piece that began before this receiver listened is no fault.
    in_step: bool,
}

impl Receiver {
    /// A receiver that has seen nothing.
    #[must_use]
    pub fn new(fastest: Fastest) -> Self {
        Self {
            fastest,
            piece: [0; MAX_ENCODED],
            length: 0,
            last: None,
            origin: None,
            k: 0,
            time_s: 0.0,
            clock_s: 0.0,
            gap: Gap::None,
            counters: Counters::default(),
            in_step: false,
        }
    }

    /// What went over the line so far.
    #[must_use]
    pub fn counters(&self) -> Counters {
        self.counters
    }

    /// The cable came back: what is left of the piece before it is dropped.
    pub fn reconnected(&mut self) {
        self.counters.reconnects += 1;
        self.length = 0;
        self.in_step = false;
        self.gap = self.gap.max(Gap::Readings);
    }

    /// A sample of this receiver found no room further on.
    pub fn overrun(&mut self) {
        self.counters.overrun += 1;
        self.gap = self.gap.max(Gap::Readings);
    }

    /// Takes bytes that arrived at `arrived_s` of any clock that does not go back.
    pub fn receive(&mut self, bytes: &[u8], arrived_s: f64, sink: &mut impl FnMut(Sample)) {
        for byte in bytes {
            if *byte != END {
                // Beyond its room a piece only grows, so that it is refused by its length.
                if let Some(place) = self.piece.get_mut(self.length) {
                    *place = *byte;
                }
                self.length = self.length.saturating_add(1);
                continue;
            }
            let length = core::mem::take(&mut self.length);
            let in_step = core::mem::replace(&mut self.in_step, true);
            let frame = self.piece.get(..length).map(Frame::decode);
            match frame {
                Some(Ok(frame)) => sink_some(self.accept(&frame, arrived_s), sink),
                // An empty piece is an idle line's or a careful sender's.
                _ if length == 0 || !in_step => {}
                _ => self.counters.corrupted += 1,
            }
        }
    }

    fn accept(&mut self, frame: &Frame, arrived_s: f64) -> Option<Sample> {
        let widths = (frame.spindle.bits(), frame.z.bits());
        let ahead = match self.last {
            None => {
                self.start(frame)?;
                0
            }
            Some(last) => {
                let ahead = frame.sequence.wrapping_sub(last.sequence);
                let behind = last.sequence.wrapping_sub(frame.sequence);
                let anew = frame.status.has(Status::START) && ahead != 0;
                if ahead == 0 {
                    self.counters.repeated += 1;
                    return None;
                }
                if anew
                    || widths != (last.spindle_bits, last.z_bits)
                    || (RESTART_BEHIND..=u32::MAX / 2).contains(&behind)
                {
                    self.counters.restarts += 1;
                    self.gap = Gap::Origin;
                    self.start(frame)?;
                    1
                } else if behind < RESTART_BEHIND {
                    self.counters.out_of_order += 1;
                    return None;
                } else {
                    self.counters.lost += u64::from(ahead - 1);
                    ahead
                }
            }
        };
        self.last = Some(Last { sequence: frame.sequence, spindle_bits: widths.0, z_bits: widths.1 });
        self.k += u64::from(ahead);
        if ahead > 1 || frame.status.has(Status::MISSED) {
            self.gap = self.gap.max(Gap::Readings);
        }
        let origin = self.origin.as_mut()?;
        let (spindle, z) = (origin.spindle.read(frame.spindle.raw()), origin.z.read(frame.z.raw()));
        let before_s = self.time_s;
        self.time_s = self.clock_s + origin.clock.read(u64::from(frame.time_us)) as f64 / US_PER_S;
        if self.last.is_some_and(|last| !self.fastest.is_unique(&last, self.time_s - before_s)) {
            self.gap = Gap::Origin;
        }
        let transport_s = arrived_s - self.time_s;
        let least_s = origin.transport_s.get_or_insert(transport_s);
        *least_s = (*least_s + DRIFT * (self.time_s - before_s).max(0.0)).min(transport_s);
        if transport_s - *least_s > LATE_S {
            self.counters.late += 1;
        }
        if frame.status.has(Status(Status::SPINDLE_FAULT.0 | Status::Z_FAULT.0)) {
            self.counters.faulty += 1;
            // A faulty encoder may have lost its place.
            self.gap = Gap::Origin;
            return None;
        }
        self.counters.accepted += 1;
        Some(Sample {
            k: self.k,
            time_s: self.time_s,
            spindle_counts: spindle as f64,
            z_counts: z as f64,
            gap: core::mem::take(&mut self.gap),
        })
    }

    /// Counts from this frame on; none for widths that no frame has.
    fn start(&mut self, frame: &Frame) -> Option<()> {
        // Time goes on from where it was: a restarted board's clock says nothing of the time between.
        self.clock_s = self.time_s;
        self.origin = Some(Origin {
            spindle: Axis::new(frame.spindle.bits(), frame.spindle.signed())?,
            z: Axis::new(frame.z.bits(), frame.z.signed())?,
            clock: Axis::new(32, 0)?,
            transport_s: None,
        });
        Some(())
    }
}

fn sink_some(sample: Option<Sample>, sink: &mut impl FnMut(Sample)) {
    if let Some(sample) = sample {
        sink(sample);
    }
}
