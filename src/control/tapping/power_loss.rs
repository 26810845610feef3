//! What is left of a hole when the power fails, and the way out of it.
//!
//! From a hole's first synchronous period to its end [`Tapping`](super::Tapping) has a [`PowerLossRecord`], which the host writes
//! where it outlives the power. With absolute encoders of spindle and Z it tells, after the restart, where the tap's helix is. A
//! [`RestoredHole`] is planned from it and from what the encoders read then, or refused where angle and Z are not on that helix.

use core::fmt;

use crate::control::bytes::{Reader, Writer, sum};
use crate::control::cycle::{CycleError, CyclePlan, Hand, InterruptionError, TapCycle};
use crate::control::machine::{Law, Machine};
use crate::control::port::Feedback;
use crate::control::sync::{HelixZero, Scale, Standing};
use crate::control::units::um_from_mm;

/// The first bytes of a record.
const MARK: [u8; 4] = *b"RTPL";
/// Bytes before the sum.
const BODY: usize = PowerLossRecord::BYTES - size_of::<u32>();
/// A Z that is no further in stands on the R plane: the tap is out of the hole.
const OUT_MM: f64 = 0.05;

/// A hole's helix and extent: all that leads a tap out of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PowerLossRecord {
    /// Counts of both absolute encoders on the helix, on the R plane.
    pub zero: HelixZero,
    /// Pitch.
    pub pitch_mm: f64,
    /// Hand of the thread.
    pub hand: Hand,
    /// Where the tap is out of the hole.
    pub r_plane_mm: f64,
    /// The hole's bottom.
    pub bottom_mm: f64,
    /// Spindle speed of the stroke out.
    pub out_speed_rpm: f64,
    /// [`Machine::fingerprint`] of the machine that began the hole.
    pub machine: u64,
}

impl PowerLossRecord {
    /// Bytes of a record.
    pub const BYTES: usize = 64;
    /// Version of their layout.
    pub const VERSION: u8 = 1;

    pub(super) fn of(plan: &CyclePlan, zero: HelixZero) -> Self {
        let TapCycle { pitch_mm, hand, r_plane_mm, bottom_mm, out_speed_rpm, .. } = *plan.cycle();
        let machine = plan.machine().fingerprint();
        Self { zero, pitch_mm, hand, r_plane_mm, bottom_mm, out_speed_rpm, machine }
    }

    /// For a host whose Z counts in a hole from elsewhere than its absolute encoder: that one has so many counts more.
    #[must_use]
    pub fn with_z_offset(&self, counts: i64) -> Self {
        let z_counts = self.zero.z_counts.wrapping_add(counts);
        Self { zero: HelixZero { z_counts, ..self.zero }, ..*self }
    }

    /// As bytes, low ones first: mark, version, hand (0 right, 1 left), two zeros; counts of spindle and Z; pitch, R plane and
    /// bottom; the machine's fingerprint; the speed out as a single; CRC-32 (ISO-HDLC) of all before it.
    ///
    /// ```
    /// use rigidtap::control::cycle::Hand;
    /// use rigidtap::control::sync::HelixZero;
    /// use rigidtap::control::tapping::{PowerLossRecord, RestoreError};
    /// let zero = HelixZero { spindle_counts: -4096, z_counts: 20_000 };
    /// let record = PowerLossRecord {
    ///     zero, pitch_mm: 1.25, hand: Hand::Left, r_plane_mm: 2.0, bottom_mm: -18.0, out_speed_rpm: 3000.0, machine: 7,
    /// };
    /// let mut bytes = record.to_bytes();
    /// assert_eq!(PowerLossRecord::from_bytes(&bytes), Ok(record));
    /// bytes[20] ^= 1;
    /// assert!(matches!(PowerLossRecord::from_bytes(&bytes), Err(RestoreError::Damaged { .. })));
    /// ```
    #[must_use]
    pub fn to_bytes(&self) -> [u8; Self::BYTES] {
        let hand = match self.hand {
            Hand::Right => 0,
            Hand::Left => 1,
        };
        let parts: [&[u8]; 9] = [
            &MARK,
            &[Self::VERSION, hand, 0, 0],
            &self.zero.spindle_counts.to_le_bytes(),
            &self.zero.z_counts.to_le_bytes(),
            &self.pitch_mm.to_le_bytes(),
            &self.r_plane_mm.to_le_bytes(),
            &self.bottom_mm.to_le_bytes(),
            &self.machine.to_le_bytes(),
            &(self.out_speed_rpm as f32).to_le_bytes(),
        ];
        let mut bytes = [0; Self::BYTES];
        let mut writer = Writer::new(&mut bytes);
        parts.into_iter().for_each(|part| writer.put(part));
        writer.end();
        bytes
    }

    /// From bytes as [`PowerLossRecord::to_bytes`] makes them.
    ///
    /// # Errors
    /// [`RestoreError::Damaged`], [`RestoreError::OtherVersion`] and [`RestoreError::Invalid`].
    pub fn from_bytes(bytes: &[u8; Self::BYTES]) -> Result<Self, RestoreError> {
        let mut reader = Reader::new(bytes);
        let [mark @ .., version, hand, _, _] = reader.take::<8>();
        let [spindle_counts, z_counts] = [reader.take(), reader.take()].map(i64::from_le_bytes);
        let [pitch_mm, r_plane_mm, bottom_mm] = [reader.f64(), reader.f64(), reader.f64()];
        let machine = u64::from_le_bytes(reader.take());
        let out_speed_rpm = f64::from(f32::from_le_bytes(reader.take()));
        let found = u32::from_le_bytes(reader.take());
        let expected = sum(bytes.get(..BODY).unwrap_or_default());
        if found != expected || mark != MARK {
            return Err(RestoreError::Damaged { found, expected });
        }
        if version != Self::VERSION {
            return Err(RestoreError::OtherVersion { found: version, expected: Self::VERSION });
        }
        for value in [pitch_mm, out_speed_rpm] {
            if !(value > 0.0 && value.is_finite()) {
                return Err(RestoreError::Invalid { value });
            }
        }
        let hand = match hand {
            0 => Hand::Right,
            1 => Hand::Left,
            other => return Err(RestoreError::Invalid { value: f64::from(other) }),
        };
        let zero = HelixZero { spindle_counts, z_counts };
        Ok(Self { zero, pitch_mm, hand, r_plane_mm, bottom_mm, out_speed_rpm, machine })
    }
}

/// A hole in which the tap stood when the power came back, with the way out planned.
#[derive(Clone, Debug, PartialEq)]
pub struct RestoredHole {
    pub(crate) plan: CyclePlan,
    pub(crate) standing: Standing,
}

impl RestoredHole {
    /// Plans the way out from a record and from what the encoders read now, both axes at rest, at the speed of the stroke out or at
    /// one of the host's own. Outside the period, as every plan.
    ///
    /// # Errors
    /// [`RestoreError`], and nothing moves.
    ///
    /// ```
    /// use rigidtap::control::{cycle::Hand, machine::{Law, Machine}, port::Feedback, sync::HelixZero};
    /// use rigidtap::control::tapping::{PowerLossRecord, RestoreError, RestoredHole};
    /// let machine = Machine::reference();
    /// let record = PowerLossRecord {
    ///     zero: HelixZero { spindle_counts: 1000, z_counts: 0 }, pitch_mm: 1.0, hand: Hand::Right, r_plane_mm: 0.0,
    ///     bottom_mm: -10.0, out_speed_rpm: 1000.0, machine: machine.fingerprint(),
    /// };
    /// // 5 mm in, five turns on; the spindle's encoder counts from the turn it is in.
    /// let feedback = Feedback { spindle_counts: 1000, z_counts: -50_000, ..Feedback::default() };
    /// let hole = RestoredHole::plan(&record, &machine, Law::TorqueCurve, None, &feedback).unwrap();
    /// assert_eq!((hole.standing().depth_mm, hole.standing().spindle_rev), (5.0, 5.0));
    /// // A tenth of a turn off it is 100 µm beside the thread.
    /// let turned = Feedback { spindle_counts: 1000 + 1638, ..feedback };
    /// let refused = RestoredHole::plan(&record, &machine, Law::TorqueCurve, None, &turned).unwrap_err();
    /// assert!(matches!(refused, RestoreError::OffHelix { offset_um, .. } if (offset_um + 100.0).abs() < 0.1));
    /// ```
    pub fn plan(
        record: &PowerLossRecord,
        machine: &Machine,
        law: Law,
        speed_rpm: Option<f64>,
        feedback: &Feedback,
    ) -> Result<Self, RestoreError> {
        let (found, expected) = (record.machine, machine.fingerprint());
        if found != expected {
            return Err(RestoreError::OtherMachine { found, expected });
        }
        if !(feedback.spindle.sample_valid && feedback.z.sample_valid) {
            return Err(RestoreError::SampleInvalid);
        }
        let PowerLossRecord { zero, pitch_mm, hand, r_plane_mm, bottom_mm, out_speed_rpm, .. } = *record;
        let standing = zero.standing(machine, hand, pitch_mm, feedback);
        if standing.depth_mm < OUT_MM {
            return Err(RestoreError::NotInHole { depth_mm: standing.depth_mm });
        }
        let (offset_um, limit_um) = (um_from_mm(standing.offset_mm), machine.supervision(pitch_mm).error_um);
        if offset_um.abs() > limit_um {
            return Err(RestoreError::OffHelix { offset_um, limit_um });
        }
        // The helix begins where Z's zero is, and a tap that coasted below the bottom has to come up from there.
        let start_mm = Scale::of(machine).z_mm(zero.z_counts);
        let lowest_mm = start_mm - (r_plane_mm - bottom_mm).max(standing.depth_mm);
        let cycle = TapCycle::right_hand(start_mm, lowest_mm, pitch_mm, speed_rpm.unwrap_or(out_speed_rpm));
        let plan = CyclePlan::new(TapCycle { hand, ..cycle }, machine, law).map_err(RestoreError::Cycle)?;
        let mut out = plan.clone();
        out.hold_at(0.0, standing.spindle_rev);
        out.retract(0.0).map_err(|error| match error {
            InterruptionError::Stroke(error) => RestoreError::Cycle(error),
            // Held as it is, there is no other.
            _ => RestoreError::NotInHole { depth_mm: standing.depth_mm },
        })?;
        Ok(Self { plan, standing })
    }

    /// Where the tap stands in it.
    #[must_use]
    pub fn standing(&self) -> Standing {
        self.standing
    }
}

/// Why a tap is not led out of the hole in which the power left it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum RestoreError {
    /// The record's sum is not that of its bytes.
    Damaged {
        /// The record's.
        found: u32,
        /// That of its bytes.
        expected: u32,
    },
    /// The record is of another version of this library.
    OtherVersion {
        /// The record's.
        found: u8,
        /// This one's.
        expected: u8,
    },
    /// A number of the record cannot be.
    Invalid {
        /// The number.
        value: f64,
    },
    /// The record is of a machine with other data.
    OtherMachine {
        /// The record's [`Machine::fingerprint`].
        found: u64,
        /// This machine's.
        expected: u64,
    },
    /// A sample of spindle or Z is not valid.
    SampleInvalid,
    /// Z stands on the R plane or above: the tap is out of the hole.
    NotInHole {
        /// How deep Z stands below R.
        depth_mm: f64,
    },
    /// Angle and Z are not on the hole's helix: led out, the tap would break or spoil the thread.
    OffHelix {
        /// By how much Z leads the helix.
        offset_um: f64,
        /// Most that is retracted: the limit of e(k).
        limit_um: f64,
    },
    /// There is no stroke out.
    Cycle(CycleError),
}

impl fmt::Display for RestoreError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Damaged { found, expected } => {
                write!(f, "the record is damaged: its sum is {found:08x}, and that of its bytes {expected:08x}")
            }
            Self::OtherVersion { found, expected } => {
                write!(f, "the record is of version {found}, and this one reads {expected}")
            }
            Self::Invalid { value } => write!(f, "the record has {value} where that cannot be"),
            Self::OtherMachine { found, expected } => {
                write!(f, "the record is of a machine with other data: {found:016x}, and this one is {expected:016x}")
            }
            Self::SampleInvalid => f.write_str("a sample of spindle or Z is not valid"),
            Self::NotInHole { depth_mm } => {
                let side = if depth_mm < 0.0 { "above" } else { "below" };
                write!(f, "the tap is not in the hole: Z stands {:.3} mm {side} R", depth_mm.abs())
            }
            Self::OffHelix { offset_um, limit_um } => {
                write!(f, "spindle and Z are {offset_um:.1} µm off the hole's helix, and {limit_um:.1} µm are the most")
            }
            Self::Cycle(error) => write!(f, "there is no stroke out: {error}"),
        }
    }
}

impl core::error::Error for RestoreError {}
