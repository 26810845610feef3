//! The numbers of the header's enumerators never change within a version of the interface: hosts compile them in.

use rigidtap::capi::{API_VERSION, RigidtapStatus, reports, status};
use rigidtap::control::machine::Law;
use rigidtap::control::sync::{Alarm, Axis, Compensation, LEARNED_BYTES};

const HEADER: &str = include_str!("../../src/capi/rigidtap.h");

/// Every `RIGIDTAP_NAME = NUMBER` of the header, in its order.
fn enumerators() -> Vec<(&'static str, u32)> {
    let code = HEADER.lines().map(|line| line.split("/*").next().unwrap_or(""));
    let pairs = code.flat_map(|line| line.split([',', '{', '}'])).filter_map(|part| {
        let (name, number) = part.split_once('=')?;
        Some((name.trim().strip_prefix("RIGIDTAP_")?, number.trim().parse().ok()?))
    });
    pairs.collect()
}

/// Version 3. A new enumerator gets a new number; one that changes is a new version.
const PINNED: &str = "OK 0 NULL 1 NOT_INITIALISED 2 VERSION 3 MACHINE_OUT_OF_RANGE 10 MACHINE_TORQUE_CURVE 11 \
    MACHINE_CONTRADICTION 12 UNKNOWN_CHOICE 20 NO_STROKE 21 INVALID 22 SPINDLE_TOO_FAST 23 PITCH_TOO_FAST 24 \
    PITCH_TOO_SHARP 25 NO_PROFILE 26 TOO_MANY_PECKS 27 NOT_IN_TURN 30 NOT_STOPPED 31 ALARM_LATCHED 32 HOLE_FAILED 33 \
    RECORD_DAMAGED 50 RECORD_VERSION 51 RECORD_MACHINE 52 SAMPLE_INVALID 53 NOT_IN_HOLE 54 OFF_HELIX 55 NO_ROOM 56 \
    LAW_TORQUE_CURVE 0 LAW_S_CURVE 1 LAW_LINEAR 2 LAW_TRAPEZOID_JERK 3 LAW_IMPROVED_S_CURVE 4 LAW_TORQUE_LIMIT 5 LAW_TORQUE_CURVE_SMOOTH 6 HAND_RIGHT 0 \
    HAND_LEFT 1 TAKES_TORQUE 0 TAKES_VELOCITY 1 TAKES_POSITION 2 TAKES_SPEED 3 COMPENSATION_NONE 0 COMPENSATION_PAPER 1 COMPENSATION_FULL 2 POSITIONING 0 SETTLING 1 SYNCHRONOUS 2 \
    BRAKING 3 HOLDING 4 RETRACTING 5 DONE 6 HELD 7 SYNCHRONOUS_STOP 8 MODEL_STOP 9 Z_LOST 10 \
    STROKE_NONE 0 STROKE_IN 1 STROKE_DWELL 2 STROKE_OUT 3 AXIS_NONE 0 \
    AXIS_SPINDLE 1 AXIS_Z 2 ALARM_NONE 0 ALARM_SAMPLE_LOST 101 ALARM_COUNT_JUMP 102 \
    ALARM_ENCODER_FROZEN 103 ALARM_TRAVEL_MISMATCH 104 ALARM_SPINDLE_FOLLOWING 105 ALARM_Z_FOLLOWING 106 \
    ALARM_SYNCHRONISATION_ERROR 107 ALARM_JAM 108 ALARM_TAP_BROKEN 109 ALARM_EFFORT_IMPLAUSIBLE 110 ALARM_CLOCK 111 \
    ALARM_NOT_IN_POSITION 112 REPORTS_Z_MOTOR 1 REPORTS_SPINDLE_TORQUE 2 \
    REPORTS_Z_FORCE 4 REPORTS_SPINDLE_SATURATED 8 REPORTS_Z_SATURATED 16 REPORTS_SPINDLE_DRIVE 32 REPORTS_Z_DRIVE 64 \
    SPINDLE_INVALID 1 Z_INVALID 2 SPINDLE_SATURATED 4 Z_SATURATED 8 SPINDLE_NOT_READY 16 Z_NOT_READY 32";

#[test]
fn enumerators_keep_their_numbers() {
    let found: Vec<_> = enumerators().iter().map(|(name, number)| format!("{name} {number}")).collect();
    assert_eq!(found.join(" "), PINNED.split_whitespace().collect::<Vec<_>>().join(" "));
    assert!(HEADER.contains(&format!("#define RIGIDTAP_API_VERSION {API_VERSION}u")));
    assert!(HEADER.contains(&format!("#define RIGIDTAP_LEARNED_BYTES {LEARNED_BYTES}u")));
}

#[test]
fn header_and_library_mean_the_same_numbers() {
    let number = |name: &str| {
        let found = enumerators().into_iter().find(|(other, _)| *other == name);
        found.unwrap_or_else(|| panic!("the header has no RIGIDTAP_{name}")).1
    };
    for (name, status) in [
        ("OK", RigidtapStatus::Ok),
        ("NULL", RigidtapStatus::Null),
        ("MACHINE_OUT_OF_RANGE", RigidtapStatus::MachineOutOfRange),
        ("UNKNOWN_CHOICE", RigidtapStatus::UnknownChoice),
        ("TOO_MANY_PECKS", RigidtapStatus::TooManyPecks),
        ("NOT_IN_TURN", RigidtapStatus::NotInTurn),
        ("NOT_STOPPED", RigidtapStatus::NotStopped),
        ("ALARM_LATCHED", RigidtapStatus::AlarmLatched),
        ("HOLE_FAILED", RigidtapStatus::HoleFailed),
        ("RECORD_DAMAGED", RigidtapStatus::RecordDamaged),
        ("RECORD_VERSION", RigidtapStatus::RecordVersion),
        ("RECORD_MACHINE", RigidtapStatus::RecordMachine),
        ("SAMPLE_INVALID", RigidtapStatus::SampleInvalid),
        ("NOT_IN_HOLE", RigidtapStatus::NotInHole),
        ("OFF_HELIX", RigidtapStatus::OffHelix),
        ("NO_ROOM", RigidtapStatus::NoRoom),
    ] {
        assert_eq!(number(name), status as u32, "{name}");
    }
    for (index, law) in Law::ALL.iter().enumerate() {
        let name = format!("LAW_{}", law.name().to_uppercase().replace('-', "_"));
        assert_eq!(number(&name), index as u32, "{name}");
    }
    for (index, compensation) in Compensation::ALL.iter().enumerate() {
        assert_eq!(number(&format!("COMPENSATION_{}", compensation.name().to_uppercase())), index as u32);
    }
    let axis = Axis::Spindle;
    for (name, alarm) in [
        ("SAMPLE_LOST", Alarm::SampleLost { axis, periods: 6, limit: 5 }),
        ("COUNT_JUMP", Alarm::CountJump { axis, travel: 1.0, limit: 0.1 }),
        ("ENCODER_FROZEN", Alarm::EncoderFrozen { axis, periods: 3, expected_counts: 9.0 }),
        ("TRAVEL_MISMATCH", Alarm::TravelMismatch { axis, deviation: 1.0, limit: 0.1 }),
        ("SPINDLE_FOLLOWING", Alarm::SpindleFollowing { error_rev: 1.0, limit_rev: 0.1 }),
        ("SPINDLE_FOLLOWING", Alarm::DriveNotReady { axis, periods: 3 }),
        ("Z_FOLLOWING", Alarm::ZFollowing { error_mm: 1.0, limit_mm: 0.1 }),
        ("Z_FOLLOWING", Alarm::DriveNotReady { axis: Axis::Z, periods: 3 }),
        ("SYNCHRONISATION_ERROR", Alarm::SynchronisationError { error_um: 90.0, limit_um: 50.0 }),
        ("JAM", Alarm::Jam { lag_rpm: 900.0, limit_rpm: 100.0 }),
        ("TAP_BROKEN", Alarm::TapBroken { torque_nm: 0.1, limit_nm: 0.5 }),
        ("EFFORT_IMPLAUSIBLE", Alarm::EffortImplausible { axis, effort: 99.0, limit: 30.0 }),
        ("CLOCK", Alarm::Clock { elapsed_s: -1.0, limit_s: 0.0055 }),
        ("NOT_IN_POSITION", Alarm::NotInPosition { waited_s: 3.0, spindle_rev: 0.0, z_mm: 0.0 }),
    ] {
        assert_eq!(number(&format!("ALARM_{name}")), alarm.code(), "{name}");
    }
    assert_eq!(number("REPORTS_Z_DRIVE"), reports::Z_DRIVE);
    assert_eq!(number("REPORTS_SPINDLE_SATURATED"), reports::SPINDLE_SATURATED);
    assert_eq!(number("Z_NOT_READY"), status::Z_NOT_READY);
    assert_eq!(number("SPINDLE_SATURATED"), status::SPINDLE_SATURATED);
}
