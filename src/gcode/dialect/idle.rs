//! G codes beside those of the family: what changes no hole, and shifts of the coordinates.
//!
//! FANUC: Operator's Manual B-64304EN and B-64304EN-2, lists of G codes (look-ahead G05, G05.1, G08; cancel codes G13.1,
//! G15, G50, G50.1, G67, G69; stored stroke check G22, G23; spindle speed check G25, G26; G52, G92, G54.1 P1 to P48).
//! Haas: Mill Operator's Manual 2017, list of G codes (G103, G107, G187 with P and E; G110 to G129 are G154 P1 to P20;
//! G154 P1 to P99; G174 and G184). LinuxCNC: G-Code Reference, held by `tests/rs274`.

use super::codes::{GCode, IdleWords};
use crate::control::cycle::Hand;

const fn idle(words: IdleWords) -> GCode {
    GCode::Idle { words }
}

#[rustfmt::skip]
pub(super) const FANUC: &[(u16, GCode)] = &[
    (50, idle(IdleWords::Pqr)), (51, idle(IdleWords::Pqr)), (80, idle(IdleWords::P)), (90, idle(IdleWords::None)), (110, idle(IdleWords::None)), (131, idle(IdleWords::None)),
    (150, GCode::Cartesian), (160, GCode::Polar), (220, idle(IdleWords::None)), (230, idle(IdleWords::None)), (250, idle(IdleWords::None)), (260, idle(IdleWords::None)), (401, idle(IdleWords::None)),
    (500, idle(IdleWords::None)), (501, idle(IdleWords::None)), (520, GCode::LocalShift), (541, GCode::ExtendedOffset), (620, GCode::PathMode),
    (630, GCode::PathMode), (670, idle(IdleWords::None)), (680, GCode::Rotate), (690, GCode::Unrotate), (805, idle(IdleWords::None)), (920, GCode::SetPosition),
    (1130, idle(IdleWords::None)),
];

#[rustfmt::skip]
pub(super) const HAAS: &[(u16, GCode)] = &[
    (90, idle(IdleWords::None)), (150, idle(IdleWords::None)), (500, idle(IdleWords::None)), (520, GCode::LocalShift),
    (680, GCode::Rotate), (690, GCode::Unrotate), (920, GCode::SetPosition), (970, GCode::SpeedInRpm),
    (1030, idle(IdleWords::P)),
    (1100, GCode::WorkOffset(10)), (1110, GCode::WorkOffset(11)), (1120, GCode::WorkOffset(12)),
    (1130, GCode::WorkOffset(13)), (1140, GCode::WorkOffset(14)), (1150, GCode::WorkOffset(15)),
    (1160, GCode::WorkOffset(16)), (1170, GCode::WorkOffset(17)), (1180, GCode::WorkOffset(18)),
    (1190, GCode::WorkOffset(19)), (1200, GCode::WorkOffset(20)), (1210, GCode::WorkOffset(21)),
    (1220, GCode::WorkOffset(22)), (1230, GCode::WorkOffset(23)), (1240, GCode::WorkOffset(24)),
    (1250, GCode::WorkOffset(25)), (1260, GCode::WorkOffset(26)), (1270, GCode::WorkOffset(27)),
    (1280, GCode::WorkOffset(28)), (1290, GCode::WorkOffset(29)),
    (1540, GCode::ExtendedOffset), (1740, GCode::TapFromHere { hand: Hand::Left }),
    (1840, GCode::TapFromHere { hand: Hand::Right }), (1870, idle(IdleWords::Pe)),
];

#[rustfmt::skip]
pub(super) const LINUXCNC: &[(u16, GCode)] = &[
    (80, idle(IdleWords::None)), (431, GCode::LengthByWords), (520, GCode::LocalShift), (911, idle(IdleWords::None)), (920, GCode::SetPosition), (921, GCode::CancelShift),
];
