//! What a machine came to, in a few bytes: what was drawn is drawn again from its number.

use super::settings::SweepSettings;
use super::swept_machine::{HoleErrors, SweptMachine};
use crate::run::Verdict;
use crate::sim::Actual;

const HOLE_BYTES: usize = 6 * 8;
/// First hole, alarm, verdicts and flags.
const ONE_HOLE: usize = HOLE_BYTES + 8;
/// And the last hole with the growth, where there are several.
const SEVERAL_HOLES: usize = ONE_HOLE + HOLE_BYTES + 8;

/// Bytes of a record; all of one sweep are as long.
pub(super) fn record_bytes(settings: &SweepSettings) -> usize {
    if settings.holes.get() > 1 { SEVERAL_HOLES } else { ONE_HOLE }
}

/// Appends a machine's record: numbers as they are in memory, the low byte first.
pub(super) fn encode(machine: &SweptMachine, settings: &SweepSettings, bytes: &mut Vec<u8>) {
    let SweptMachine { first, last, worst_growth_ratio, saturated, unstable, alarm, .. } = machine;
    let numbers = |hole: &HoleErrors| {
        let HoleErrors { error_um, true_error_um, worst_um, bottom_overshoot_um, stroke_over_bound, strokes_s, .. } =
            *hole;
        [error_um, true_error_um, worst_um, bottom_overshoot_um, stroke_over_bound, strokes_s]
    };
    bytes.extend(numbers(first).iter().flat_map(|number| number.to_le_bytes()));
    bytes.extend(alarm.unwrap_or(0).to_le_bytes());
    let verdict = |hole: &HoleErrors| hole.verdict as u8;
    bytes.extend([verdict(first), verdict(last), u8::from(*saturated), u8::from(*unstable)]);
    if settings.holes.get() > 1 {
        bytes.extend(numbers(last).iter().flat_map(|number| number.to_le_bytes()));
        bytes.extend(worst_growth_ratio.unwrap_or(f64::NAN).to_le_bytes());
    }
}

/// What [`encode`] wrote; none of bytes that it never writes.
pub(super) fn decode(
    bytes: &[u8],
    settings: &SweepSettings,
    run: u32,
    seed: u64,
    actual: Actual,
) -> Option<SweptMachine> {
    let several = settings.holes.get() > 1;
    let number = |at: usize| Some(f64::from_le_bytes(bytes.get(at..at + 8)?.try_into().ok()?));
    let verdict = |code: u8| [Verdict::Ok, Verdict::Warning, Verdict::Fail].get(usize::from(code)).copied();
    let flag = |code: u8| [false, true].get(usize::from(code)).copied();
    let hole = |at: usize, code: u8| {
        Some(HoleErrors {
            error_um: number(at)?,
            true_error_um: number(at + 8)?,
            worst_um: number(at + 16)?,
            bottom_overshoot_um: number(at + 24)?,
            stroke_over_bound: number(at + 32)?,
            strokes_s: number(at + 40)?,
            verdict: verdict(code)?,
        })
    };
    let (alarm, codes) = bytes.get(HOLE_BYTES..ONE_HOLE)?.split_first_chunk::<4>()?;
    let &[first_verdict, last_verdict, saturated, unstable] = codes else { return None };
    let first = hole(0, first_verdict)?;
    Some(SweptMachine {
        run,
        seed,
        actual,
        first,
        last: if several { hole(ONE_HOLE, last_verdict)? } else { first },
        worst_growth_ratio: if several { Some(number(ONE_HOLE + HOLE_BYTES)?) } else { None },
        saturated: flag(saturated)?,
        unstable: flag(unstable)?,
        alarm: Some(u32::from_le_bytes(*alarm)).filter(|code| *code != 0),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::num::NonZeroU32;

    #[test]
    fn what_is_written_is_read() {
        for holes in [1, 3] {
            let settings = SweepSettings {
                runs: NonZeroU32::MIN,
                seed: 1,
                holes: NonZeroU32::new(holes).unwrap(),
                spread: None,
                hard: None,
                jobs: None,
            };
            let number = f64::from;
            let hole = |at: u32, verdict| HoleErrors {
                error_um: number(at),
                true_error_um: number(at + 1),
                worst_um: number(at + 2),
                bottom_overshoot_um: number(at + 3),
                stroke_over_bound: number(at + 4),
                strokes_s: f64::INFINITY,
                verdict,
            };
            let first = hole(7, Verdict::Warning);
            let machine = SweptMachine {
                run: 5,
                seed: 6,
                actual: Actual::default(),
                first,
                last: if holes > 1 { hole(20, Verdict::Fail) } else { first },
                worst_growth_ratio: (holes > 1).then_some(1.5),
                saturated: true,
                unstable: false,
                alarm: Some(108),
            };
            let mut bytes = Vec::new();
            encode(&machine, &settings, &mut bytes);
            assert_eq!(bytes.len(), record_bytes(&settings));
            assert_eq!(decode(&bytes, &settings, 5, 6, Actual::default()), Some(machine));
            // A verdict that there is none of, and a record cut short.
            bytes[HOLE_BYTES + 4] = 3;
            assert_eq!(decode(&bytes, &settings, 5, 6, Actual::default()), None);
            bytes[HOLE_BYTES + 4] = 0;
            assert_eq!(decode(&bytes[..bytes.len() - 1], &settings, 5, 6, Actual::default()), None);
        }
    }
}
