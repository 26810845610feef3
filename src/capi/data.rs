//! How calls end, and what asks for them: statuses, refusals, the hole.

use crate::control::cycle::{CycleError, InterruptionError};
use crate::control::machine::{Law, MachineError, MachineFault};
use crate::control::profile::ProfileError;
use crate::control::sync::{Compensation, LearnedError};
use crate::control::tapping::{RestoreError, StartError};

/// How a call ended: `rigidtap_status` of the header.
#[repr(i32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RigidtapStatus {
    /// Done.
    Ok = 0,
    /// A pointer is null.
    Null = 1,
    /// The state was never initialised, or by another version.
    NotInitialised = 2,
    /// Header and library are of different versions, or a size is not what the library has.
    Version = 3,
    /// A number of the machine's data is out of range; `fault.key` says which.
    MachineOutOfRange = 10,
    /// The torque curve is none.
    MachineTorqueCurve = 11,
    /// Two of the machine's data contradict each other.
    MachineContradiction = 12,
    /// A number names no law, hand, retract or compensation.
    UnknownChoice = 20,
    /// The bottom is not below the R plane.
    NoStroke = 21,
    /// A number that has to be positive and finite is not.
    Invalid = 22,
    /// Speed beyond the spindle's.
    SpindleTooFast = 23,
    /// Pitch × speed beyond Z's speed.
    PitchTooFast = 24,
    /// Pitch × acceleration beyond Z's acceleration.
    PitchTooSharp = 25,
    /// The law has no profile for a stroke.
    NoProfile = 26,
    /// Too many pecks.
    TooManyPecks = 27,
    /// The hole has not been started, or one is under way.
    NotInTurn = 30,
    /// The hole has not been stopped.
    NotStopped = 31,
    /// An alarm is latched, and has to be acknowledged first; or the axes do not rest yet.
    AlarmLatched = 32,
    /// An alarm ended the hole: it can only be retracted.
    HoleFailed = 33,
    /// The record's sum is not that of its bytes.
    RecordDamaged = 50,
    /// The record is of another version.
    RecordVersion = 51,
    /// The record is of a machine with other data.
    RecordMachine = 52,
    /// A sample of spindle or Z is not valid.
    SampleInvalid = 53,
    /// The tap is out of the hole.
    NotInHole = 54,
    /// Spindle and Z are not on the hole's helix.
    OffHelix = 55,
    /// The caller's buffer is too small.
    NoRoom = 56,
}

/// The numbers of a refusal: `rigidtap_fault` of the header.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct RigidtapFault {
    /// What was found.
    pub found: f64,
    /// The limit that it broke; the lower one where it is below.
    pub limit: f64,
    /// Machine file's key, zero-terminated; empty where the machine is not at fault.
    pub key: [u8; 64],
}

impl RigidtapFault {
    pub(super) const NONE: Self = Self { found: 0.0, limit: 0.0, key: [0; 64] };

    fn of(found: f64, limit: f64) -> Self {
        Self { found, limit, ..Self::NONE }
    }
}

/// `rigidtap_hole` of the header.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
#[allow(missing_docs, reason = "the header says it")]
pub struct RigidtapHole {
    pub x_mm: f64,
    pub y_mm: f64,
    pub r_plane_mm: f64,
    pub bottom_mm: f64,
    pub return_mm: f64,
    pub pitch_mm: f64,
    pub speed_rpm: f64,
    pub out_speed_rpm: f64,
    pub dwell_s: f64,
    pub peck_mm: f64,
    pub chip_break_mm: f64,
    pub start_angle_deg: f64,
    pub hand: u32,
    pub compensation: u32,
    pub identify: u32,
    pub learn: u32,
    pub has_start_angle: u32,
    pub tool: u32,
}

pub(super) fn law_of(number: u32) -> Result<Law, RigidtapStatus> {
    Law::ALL.get(number as usize).copied().ok_or(RigidtapStatus::UnknownChoice)
}

pub(super) fn compensation_of(number: u32) -> Result<Compensation, RigidtapStatus> {
    Compensation::ALL.get(number as usize).copied().ok_or(RigidtapStatus::UnknownChoice)
}

/// A refusal as the interface tells it.
pub(super) type Refusal = (RigidtapStatus, RigidtapFault);

impl From<RigidtapStatus> for Refusal {
    fn from(status: RigidtapStatus) -> Self {
        (status, RigidtapFault::NONE)
    }
}

impl From<MachineError> for Refusal {
    fn from(error: MachineError) -> Self {
        let (status, found, limit) = match error.fault {
            MachineFault::OutOfRange { value, low, high } => {
                (RigidtapStatus::MachineOutOfRange, value, if value > high { high } else { low })
            }
            MachineFault::TorqueCurve(_) => (RigidtapStatus::MachineTorqueCurve, 0.0, 0.0),
            MachineFault::TorqueCurveEnd { last_rpm, max_rpm } => {
                (RigidtapStatus::MachineTorqueCurve, last_rpm, max_rpm)
            }
            MachineFault::EncoderTooCoarse { count_um, limit_um } => {
                (RigidtapStatus::MachineContradiction, count_um, limit_um)
            }
            MachineFault::PeriodsDisagree { drive_s, interpolation_s } => {
                (RigidtapStatus::MachineContradiction, drive_s, interpolation_s)
            }
            _ => (RigidtapStatus::MachineContradiction, 0.0, 0.0),
        };
        let mut fault = RigidtapFault::of(found, limit);
        // The last byte stays zero.
        let room = fault.key.len() - 1;
        for (to, from) in fault.key.iter_mut().take(room).zip(error.key.bytes()) {
            *to = from;
        }
        (status, fault)
    }
}

impl From<ProfileError> for Refusal {
    fn from(error: ProfileError) -> Self {
        match error {
            ProfileError::Invalid { value } => (RigidtapStatus::Invalid, RigidtapFault::of(value, 0.0)),
            ProfileError::TooShort { distance, needed } => {
                (RigidtapStatus::NoProfile, RigidtapFault::of(distance, needed))
            }
            ProfileError::EndsAboveCommand { speed, command } => {
                (RigidtapStatus::NoProfile, RigidtapFault::of(speed, command))
            }
            ProfileError::TooManySegments => RigidtapStatus::NoProfile.into(),
        }
    }
}

impl From<CycleError> for Refusal {
    fn from(error: CycleError) -> Self {
        let (status, found, limit) = match error {
            CycleError::NoStroke { r_plane_mm, bottom_mm } => (RigidtapStatus::NoStroke, bottom_mm, r_plane_mm),
            CycleError::Invalid { value } => (RigidtapStatus::Invalid, value, 0.0),
            CycleError::SpindleTooFast { needed_rpm, limit_rpm } => {
                (RigidtapStatus::SpindleTooFast, needed_rpm, limit_rpm)
            }
            CycleError::PitchTooFast { needed_mm_per_s, limit_mm_per_s } => {
                (RigidtapStatus::PitchTooFast, needed_mm_per_s, limit_mm_per_s)
            }
            CycleError::PitchTooSharp { needed_mm_per_s2, limit_mm_per_s2 } => {
                (RigidtapStatus::PitchTooSharp, needed_mm_per_s2, limit_mm_per_s2)
            }
            CycleError::Law(error) => return error.into(),
            CycleError::TooManyPecks { needed, limit } => (RigidtapStatus::TooManyPecks, needed, limit as f64),
        };
        (status, RigidtapFault::of(found, limit))
    }
}

impl From<InterruptionError> for RigidtapStatus {
    fn from(error: InterruptionError) -> Self {
        match error {
            InterruptionError::NotStopped => Self::NotStopped,
            InterruptionError::AlarmLatched => Self::AlarmLatched,
            InterruptionError::HoleFailed => Self::HoleFailed,
            InterruptionError::Stroke(error) => Refusal::from(error).0,
        }
    }
}

impl From<RestoreError> for Refusal {
    fn from(error: RestoreError) -> Self {
        let (status, found, limit) = match error {
            RestoreError::Damaged { found, expected } => {
                (RigidtapStatus::RecordDamaged, f64::from(found), f64::from(expected))
            }
            RestoreError::OtherVersion { found, expected } => {
                (RigidtapStatus::RecordVersion, f64::from(found), f64::from(expected))
            }
            RestoreError::Invalid { value } => (RigidtapStatus::Invalid, value, 0.0),
            // Two hashes, of which no number says anything.
            RestoreError::OtherMachine { .. } => (RigidtapStatus::RecordMachine, 0.0, 0.0),
            RestoreError::SampleInvalid => (RigidtapStatus::SampleInvalid, 0.0, 0.0),
            RestoreError::NotInHole { depth_mm } => (RigidtapStatus::NotInHole, depth_mm, 0.0),
            RestoreError::OffHelix { offset_um, limit_um } => (RigidtapStatus::OffHelix, offset_um, limit_um),
            RestoreError::Cycle(error) => return error.into(),
        };
        (status, RigidtapFault::of(found, limit))
    }
}

impl From<LearnedError> for Refusal {
    fn from(error: LearnedError) -> Self {
        let (status, found, limit) = match error {
            LearnedError::NoRecord => (RigidtapStatus::RecordDamaged, 0.0, 0.0),
            LearnedError::TooShort { found, needed } => (RigidtapStatus::NoRoom, found as f64, needed as f64),
            LearnedError::Damaged { found, expected } => {
                (RigidtapStatus::RecordDamaged, f64::from(found), f64::from(expected))
            }
            LearnedError::OtherVersion { found, expected } => {
                (RigidtapStatus::RecordVersion, f64::from(found), f64::from(expected))
            }
            // Two hashes, of which no number says anything.
            LearnedError::OtherMachine { .. } => (RigidtapStatus::RecordMachine, 0.0, 0.0),
            LearnedError::Invalid { value } => (RigidtapStatus::Invalid, value, 0.0),
            LearnedError::UnderWay => (RigidtapStatus::NotInTurn, 0.0, 0.0),
        };
        (status, RigidtapFault::of(found, limit))
    }
}

impl From<StartError> for Refusal {
    fn from(error: StartError) -> Self {
        match error {
            StartError::UnderWay => RigidtapStatus::NotInTurn.into(),
            StartError::Cycle(error) => error.into(),
        }
    }
}

/// Tells the caller how a call ended, and the numbers where it asked for them.
pub(super) fn answer(result: Result<(), Refusal>, fault: Option<&mut RigidtapFault>) -> RigidtapStatus {
    let (status, numbers) = match result {
        Ok(()) => (RigidtapStatus::Ok, RigidtapFault::NONE),
        Err(refusal) => refusal,
    };
    if let Some(fault) = fault {
        *fault = numbers;
    }
    status
}
