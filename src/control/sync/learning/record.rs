//! What was learned as bytes that outlive the power.

use super::correction::{LIMIT_UM, Learned, POINTS, nm};
use super::ilc::{KINDS, Learning};
use super::kind::HoleKind;
use super::learned_error::LearnedError;
use crate::control::bytes::{Reader, Writer, sum};
use crate::control::cycle::{Hand, Retract, TapCycle};
use crate::control::sync::identification::restart::IDENTIFICATION_NUMBERS;
use crate::control::units::mm_from_um;

/// What of the identification outlives a restart.
type Numbers = [f64; IDENTIFICATION_NUMBERS];

/// The first bytes of a record.
const MARK: [u8; 4] = *b"RTLN";
/// Version of their layout.
const VERSION: u8 = 2;
/// Mark, version, number of kinds, how many numbers of the identification there are, machine.
const HEAD_BYTES: usize = 16;
/// Before the points of a kind.
const KIND_BYTES: usize = 112;
const SUM_BYTES: usize = 4;
/// Most bytes of a record: every kind full of points.
pub const LEARNED_BYTES: usize =
    HEAD_BYTES + 8 * IDENTIFICATION_NUMBERS + KINDS * (KIND_BYTES + 2 * POINTS) + SUM_BYTES;

/// Bits of a kind's choices.
const LEFT_HAND: u8 = 1;
const PECKS: u8 = 2;
const CHIP_BREAK: u8 = 4;
const FULL_RETRACT: u8 = 8;
const START_ANGLE: u8 = 16;

impl Learning {
    /// Writes what was learned, the kind used last first, and returns how many bytes it is.
    ///
    /// Low bytes first: mark `RTLN`, version, number of kinds, how many numbers of the identification there are (2 bytes), the
    /// machine's motion fingerprint; these numbers as doubles; each kind; CRC-32 (ISO-HDLC) of all before it. A kind: pitch, depth, speed in, speed out, dwell, peck, chip break, start angle, R plane,
    /// duration, distance of points as doubles; fingerprint of the tap (8 bytes), tool number and number of holes (4 each), what
    /// holes are mostly off by as a single, number of points (2), choices, a zero; its points in nm, 2 bytes each.
    pub(in crate::control::sync) fn save(
        &self,
        machine: u64,
        numbers: &Numbers,
        bytes: &mut [u8],
    ) -> Result<usize, LearnedError> {
        let mut order: [usize; KINDS] = core::array::from_fn(|slot| slot);
        order.sort_unstable_by_key(|slot| core::cmp::Reverse(self.used.get(*slot).copied()));
        let taught = || {
            let learned = order.iter().filter_map(|slot| self.kinds.get(*slot)?.as_ref());
            learned.filter(|learned| learned.holes > 0)
        };
        let found = bytes.len();
        let mut writer = Writer::new(bytes);
        writer.put(&MARK);
        writer.put(&[VERSION, taught().count() as u8]);
        writer.put(&(IDENTIFICATION_NUMBERS as u16).to_le_bytes());
        writer.put(&machine.to_le_bytes());
        numbers.iter().for_each(|number| writer.f64(*number));
        for learned in taught() {
            write(learned, &mut writer);
        }
        let needed = writer.end();
        if needed > found { Err(LearnedError::TooShort { found, needed }) } else { Ok(needed) }
    }

    /// Takes over what was learned before; what this one knows is forgotten. Returns the identification's numbers.
    pub(in crate::control::sync) fn load(&mut self, machine: u64, bytes: &[u8]) -> Result<Numbers, LearnedError> {
        let mut reader = Reader::new(bytes);
        let [mark @ .., version, count, low, high] = reader.take::<8>();
        if mark != MARK {
            return Err(LearnedError::NoRecord);
        }
        if version != VERSION {
            return Err(LearnedError::OtherVersion { found: version, expected: VERSION });
        }
        let needed = HEAD_BYTES + SUM_BYTES;
        let found = bytes.len();
        let Some((body, found_sum)) = bytes.split_last_chunk::<SUM_BYTES>().filter(|_| found >= needed) else {
            return Err(LearnedError::TooShort { found, needed });
        };
        let (found_sum, expected_sum) = (u32::from_le_bytes(*found_sum), sum(body));
        if found_sum != expected_sum {
            return Err(LearnedError::Damaged { found: found_sum, expected: expected_sum });
        }
        let found_machine = u64::from_le_bytes(reader.take());
        if found_machine != machine {
            return Err(LearnedError::OtherMachine { found: found_machine, expected: machine });
        }
        if usize::from(count) > KINDS {
            return Err(LearnedError::Invalid { value: f64::from(count) });
        }
        let numbers_found = u16::from_le_bytes([low, high]);
        if usize::from(numbers_found) != IDENTIFICATION_NUMBERS {
            return Err(LearnedError::Invalid { value: f64::from(numbers_found) });
        }
        let mut numbers = [0.0; IDENTIFICATION_NUMBERS];
        for number in &mut numbers {
            *number = finite(reader.f64())?;
        }
        let kinds = body.get(HEAD_BYTES + 8 * IDENTIFICATION_NUMBERS..).unwrap_or_default();
        // Twice, so that a record that cannot be changes nothing.
        let mut checked = Reader::new(kinds);
        for _ in 0..count {
            read(&mut checked)?;
        }
        if checked.left() > 0 {
            return Err(LearnedError::Invalid { value: checked.left() as f64 });
        }
        let mut reader = Reader::new(kinds);
        self.holes = u32::from(count);
        for (order, (place, used)) in (0..).zip(self.kinds.iter_mut().zip(&mut self.used)) {
            *place = if order < u32::from(count) { Some(read(&mut reader)?) } else { None };
            *used = u32::from(count).saturating_sub(order);
        }
        Ok(numbers)
    }
}

fn write(learned: &Learned, writer: &mut Writer<'_>) {
    let HoleKind { shape, r_plane_mm, duration_s, tap } = &learned.kind;
    let back_mm = match shape.retract {
        Some(Retract::ChipBreak { back_mm }) => Some(back_mm),
        Some(Retract::Full) | None => None,
    };
    let numbers = [
        shape.pitch_mm,
        -shape.bottom_mm,
        shape.speed_rpm,
        shape.out_speed_rpm,
        shape.dwell_s,
        shape.peck_mm.unwrap_or(0.0),
        back_mm.unwrap_or(0.0),
        shape.start_angle_rev.unwrap_or(0.0),
        *r_plane_mm,
        *duration_s,
        learned.point_s,
    ];
    numbers.into_iter().for_each(|number| writer.f64(number));
    writer.put(&tap.to_le_bytes());
    writer.put(&shape.tool.to_le_bytes());
    writer.put(&learned.holes.to_le_bytes());
    writer.put(&learned.usual_mm.to_le_bytes());
    let last = learned.correction_nm.last();
    // What the last point has stays on behind the path.
    let tail = learned.correction_nm.iter().rev().take_while(|nm| Some(*nm) == last).count();
    let points = (POINTS - tail + 1).min(POINTS);
    writer.put(&(points as u16).to_le_bytes());
    let choice = |is: bool, bit: u8| if is { bit } else { 0 };
    let choices = choice(shape.hand == Hand::Left, LEFT_HAND)
        | choice(shape.peck_mm.is_some(), PECKS)
        | choice(back_mm.is_some(), CHIP_BREAK)
        | choice(shape.retract == Some(Retract::Full), FULL_RETRACT)
        | choice(shape.start_angle_rev.is_some(), START_ANGLE);
    writer.put(&[choices, 0]);
    learned.correction_nm.iter().take(points).for_each(|nm| writer.put(&nm.to_le_bytes()));
}

fn finite(value: f64) -> Result<f64, LearnedError> {
    if value.is_finite() { Ok(value) } else { Err(LearnedError::Invalid { value }) }
}

fn read(reader: &mut Reader<'_>) -> Result<Learned, LearnedError> {
    let left = reader.left();
    if left < KIND_BYTES {
        return Err(LearnedError::TooShort { found: left, needed: KIND_BYTES });
    }
    let mut numbers = [0.0; 11];
    for number in &mut numbers {
        *number = finite(reader.f64())?;
    }
    let [
        pitch_mm,
        depth_mm,
        speed_rpm,
        out_speed_rpm,
        dwell_s,
        peck_mm,
        back_mm,
        angle_rev,
        r_plane_mm,
        duration_s,
        point_s,
    ] = numbers;
    for value in [pitch_mm, depth_mm, speed_rpm, out_speed_rpm, duration_s, point_s] {
        if !(value > 0.0) {
            return Err(LearnedError::Invalid { value });
        }
    }
    let tap = u64::from_le_bytes(reader.take());
    let [tool, holes] = [reader.take(), reader.take()].map(u32::from_le_bytes);
    let usual_mm = f32::from_le_bytes(reader.take());
    let points = usize::from(u16::from_le_bytes(reader.take()));
    let [choices, _] = reader.take();
    if !(usual_mm >= 0.0 && usual_mm.is_finite()) {
        return Err(LearnedError::Invalid { value: f64::from(usual_mm) });
    }
    if !(1..=POINTS).contains(&points) {
        return Err(LearnedError::Invalid { value: points as f64 });
    }
    if reader.left() < 2 * points {
        return Err(LearnedError::TooShort { found: reader.left(), needed: 2 * points });
    }
    let is = |bit: u8| choices & bit != 0;
    let chip_break = is(CHIP_BREAK).then_some(Retract::ChipBreak { back_mm });
    let shape = TapCycle {
        out_speed_rpm,
        hand: if is(LEFT_HAND) { Hand::Left } else { Hand::Right },
        start_angle_rev: is(START_ANGLE).then_some(angle_rev),
        dwell_s,
        peck_mm: is(PECKS).then_some(peck_mm),
        retract: chip_break.or(is(FULL_RETRACT).then_some(Retract::Full)),
        tool,
        ..TapCycle::right_hand(0.0, -depth_mm, pitch_mm, speed_rpm)
    };
    let mut learned = Learned::new(HoleKind { shape, r_plane_mm, duration_s, tap }, point_s);
    (learned.holes, learned.usual_mm) = (holes, usual_mm);
    let (mut last, most) = (0, nm(mm_from_um(LIMIT_UM)));
    for (index, place) in learned.correction_nm.iter_mut().enumerate() {
        if index < points {
            last = i16::from_le_bytes(reader.take());
            if last.unsigned_abs() > most.unsigned_abs() {
                return Err(LearnedError::Invalid { value: f64::from(last) });
            }
        }
        *place = last;
    }
    Ok(learned)
}
