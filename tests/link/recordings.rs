//! Files: halsampler's, foreign ones, and what is wrong with them.

use rigidtap::control::thread::StandardThread;
use rigidtap::link::map::Map;
use rigidtap::link::plausibility::Limits;
use rigidtap::link::recording::{Context, Format, Recording, RecordingError, RecordingErrorKind, RecordingFile};
use rigidtap::run::Verdict;
use rigidtap::run::analysis::{Judgement, PitchFinder};

use super::*;

fn context() -> Context {
    let machine = machine(1e-3);
    Context { scale: Scale::of(&machine), period_s: 1e-3, limits: Limits::of(&machine) }
}

/// A recording with its samples.
struct Read {
    recording: Recording,
    samples: Vec<Sample>,
}

impl std::ops::Deref for Read {
    type Target = Recording;

    fn deref(&self) -> &Recording {
        &self.recording
    }
}

fn read_bytes(bytes: &[u8], map: Option<&Map>) -> Result<Read, RecordingError> {
    let (context, mut samples) = (context(), Vec::new());
    let mut file = RecordingFile::new(std::io::Cursor::new(bytes), map, &context)?;
    let recording = file.read(&mut |sample| samples.push(sample))?;
    assert_eq!(recording.readings as usize, samples.len());
    Ok(Read { recording, samples })
}

fn read(text: &str, map: Option<&str>) -> Result<Read, (RecordingErrorKind, usize, usize)> {
    let map: Option<Map> = map.map(|map| map.parse().unwrap());
    read_bytes(text.as_bytes(), map.as_ref()).map_err(|error| (error.kind, error.line, error.column))
}

fn judged(recording: &Read) -> Monitored {
    let tolerance_um = Some(StandardThread::by_pitch(1.0).unwrap().sync_tolerance_um());
    let settings = AnalysisSettings { scale: recording.scale, pitch_mm: 1.0, tolerance_um };
    monitored(settings, recording.samples.iter().copied())
}

/// LinuxCNC's G33.1 as measured: the spindle turns at speed, Z waits for its index, is `late` servo periods behind it
/// on the way in and out, and follows it through its reversal at 50 000 rpm/s. Pitch 1, one line a servo period.
fn g33_1(speed_rpm: f64, depth_mm: f64, late: f64) -> String {
    const PERIOD_S: f64 = 1e-3;
    let (speed, acceleration) = (speed_rpm / 60.0, 50_000.0 / 60.0);
    let index_s = 0.1;
    let turn_s = index_s + depth_mm / speed;
    let ramp_s = 2.0 * speed / acceleration;
    // Revolutions since the index.
    let spindle_rev = |now_s: f64| {
        let until_turn = speed * (now_s.min(turn_s) - index_s);
        let ramp = (now_s - turn_s).clamp(0.0, ramp_s);
        until_turn + speed * ramp - acceleration * ramp * ramp / 2.0 - speed * (now_s - turn_s - ramp_s).max(0.0)
    };
    // Z takes 60 ms to have the spindle's speed and to catch up, then it is only late.
    let z_mm = |now_s: f64| {
        let way = spindle_rev(now_s - late * PERIOD_S).max(0.0);
        let share = ((now_s - index_s) / 0.06).clamp(0.0, 1.0);
        way * share * share * (3.0 - 2.0 * share)
    };
    let mut text = String::new();
    for number in 0..3000 {
        let now_s = f64::from(number) * PERIOD_S;
        // Before the index the count is one of anything.
        let shown_rev = spindle_rev(now_s) + if now_s < index_s { 1234.56 } else { 0.0 };
        let z = if now_s < index_s || (now_s > turn_s && spindle_rev(now_s - late * PERIOD_S) < 0.0) {
            0.0
        } else {
            z_mm(now_s)
        };
        text += &format!("{number} {shown_rev:.6} {:.6}\n", 5.0 - z);
        if now_s > turn_s && spindle_rev(now_s) < -5.0 {
            break;
        }
    }
    text
}

/// Half of the offset's periods lie in each stroke. Measured: 0.069, 0.200, 0.334, 0.467 mm.
#[test]
fn g33_1_has_its_four_servo_periods_between_in_and_out() {
    for (speed_rpm, offset_um) in [(1000.0, 69.0), (3000.0, 200.0), (5000.0, 334.0), (7000.0, 467.0)] {
        let recording = read(&g33_1(speed_rpm, 25.0, 2.0), None).unwrap();
        assert_eq!((recording.format, recording.gaps, recording.corrupt), (Format::Halsampler, 0, 0));
        let mut finder = PitchFinder::new(recording.scale);
        recording.samples.iter().for_each(|sample| finder.push(sample));
        assert_eq!(finder.pitch_mm(), Some(1.0));
        let found = judged(&recording);
        assert_eq!((found.holes.len(), found.alarms), (1, 1), "S{speed_rpm}");
        let hole = &found.holes[0];
        let offset = hole.in_out_offset.unwrap();
        assert!((offset.offset_um - offset_um).abs() < 3.0, "S{speed_rpm}: {offset:?}");
        assert!((offset.periods - 4.0).abs() < 0.02, "S{speed_rpm}: {offset:?}");
        assert!(hole.lead_in.running_start);
        // A little of the lead-in's end is judged, too.
        assert!(
            (hole.error_um.peak_to_peak() - offset_um).abs() < 0.15 * offset_um,
            "S{speed_rpm}: {:?}",
            hole.error_um
        );
        assert_eq!(hole.judgement(), Judgement::Judged(Verdict::Fail));
        assert!((hole.estimates.unwrap().z_lag_s - 0.002).abs() < 1e-4, "{:?}", hole.estimates);
        let text = rigidtap::report::monitor::table(
            rigidtap::report::table::Layout::new(200, false),
            "g33.1",
            rigidtap::report::monitor::Source::Recording(&recording),
            &found.holes,
        );
        assert!(
            text.contains("in/out offset")
                && text.contains("4.00 servo periods of travel")
                && text.contains("Z is 2.00 servo periods behind the spindle both ways"),
            "{text}"
        );
    }
}

/// A mapped file of a simulated hole in other units and a counter that wraps.
fn foreign(simulated: &Simulated, skip: impl Fn(usize) -> bool) -> String {
    let mut text = "t;angle;enc\n".to_owned();
    for (k, reading) in simulated.readings.iter().enumerate().filter(|(k, _)| !skip(*k)) {
        let angle = reading.spindle_counts as f64 / 16_384.0 * 360.0;
        text += &format!("{};{};{}\n", k, format!("{angle:.6}").replace('.', ","), reading.z_counts.rem_euclid(65_536));
    }
    text
}

const FOREIGN: &str = "time=t[ms],spindle=angle[deg],z=enc[counts16/10000]";

#[test]
fn a_foreign_file_gives_the_same_error() {
    let machine = machine(1e-3);
    let simulated = simulated(&machine, ONE_HOLE);
    let recording = read(&foreign(&simulated, |_| false), Some(FOREIGN)).unwrap();
    assert_eq!((recording.gaps, recording.missing), (0, 0));
    assert_same_error(&machine, &simulated, &judged(&recording));
}

#[test]
fn a_gap_in_a_hole_is_no_pass_and_one_beside_it_is_no_matter() {
    let simulated = simulated(&machine(1e-3), ONE_HOLE);
    let first = simulated.errors.iter().position(Option::is_some).unwrap();
    let inside = read(&foreign(&simulated, |k| (first + 100..first + 110).contains(&k)), Some(FOREIGN)).unwrap();
    assert_eq!((inside.gaps, inside.missing), (1, 10));
    let hole = &judged(&inside).holes[0];
    assert_eq!((hole.judgement(), hole.missing), (Judgement::Gap, 10));
    let outside = read(&foreign(&simulated, |k| (10..20).contains(&k)), Some(FOREIGN)).unwrap();
    assert_eq!(judged(&outside).holes[0].judgement().name(), "ok");
}

#[test]
fn a_recording_that_ends_in_a_hole_is_no_pass() {
    let simulated = simulated(&machine(1e-3), ONE_HOLE);
    let last = simulated.errors.iter().rposition(Option::is_some).unwrap();
    let recording = read(&foreign(&simulated, |k| k > last - 200), Some(FOREIGN)).unwrap();
    let found = judged(&recording);
    assert!(found.holes[0].broken && found.holes[0].judgement() == Judgement::Gap);
}

#[test]
fn what_is_wrong_has_its_place() {
    use RecordingErrorKind::{Empty, NoHeading, NotANumber, ShortRow, UnknownFormat};
    let named = "spindle=a[rev],z=b[mm]";
    for (text, map, due) in [
        ("", None, (Empty, 1, 1)),
        ("\n\n", None, (Empty, 1, 1)),
        ("a,b\n", Some(named), (Empty, 1, 1)),
        ("x,y\n1,2\n", None, (UnknownFormat, 1, 1)),
        ("1,2\n", None, (UnknownFormat, 1, 1)),
        ("a,c\n1,2\n", Some(named), (NoHeading("b".into()), 1, 1)),
        ("a,b\n1,2\n1\n", Some(named), (ShortRow(2), 3, 2)),
        ("a,b\n1,2\n1,zwei\n", Some(named), (NotANumber("zwei".into()), 3, 3)),
        ("0.5 1.5\n0.6 x\n", None, (NotANumber("x".into()), 2, 5)),
    ] {
        assert_eq!(read(text, map).map(|_| ()), Err(due), "{text:?}");
    }
    // Numbered columns need no headings, and bear some.
    for text in ["1,2\n1.01,2.1\n", "a,b\n1,2\n1.01,2.1\n"] {
        assert_eq!(read(text, Some("spindle=#1[rev],z=#2[mm]")).unwrap().samples.len(), 2);
    }
    // An empty field is a missing reading, a repeated time a repeated row, an overrun of halsampler a gap.
    let odd = read("t,a,b\n0,1,1\n1,,1\n1,1,1\n1,1,1\n2,1,1\n", Some("time=t[ms],spindle=a[rev],z=b[mm]")).unwrap();
    assert_eq!((odd.samples.len(), odd.repeated, odd.gaps), (3, 1, 1));
    assert_eq!(read("0 0.1 5\noverrun\n9 0.1 5\n", None).unwrap().gaps, 1);
}

proptest::proptest! {
    #[test]
    fn any_bytes_are_read_or_refused(bytes: Vec<u8>, numbers in "[0-9., ;\n-]{0,200}") {
        let map = "time=#1[s],spindle=#2[counts16/100],z=#3[mm]".parse().unwrap();
        for bytes in [&bytes[..], numbers.as_bytes()] {
            for map in [None, Some(&map)] {
                if let Ok(recording) = read_bytes(bytes, map) {
                    judged(&recording);
                }
            }
        }
    }

    #[test]
    fn any_map_is_read_or_refused(text: String) {
        let _ = text.parse::<Map>();
    }
}

/// A line is read once, field by field. Looked for from its beginning for each field, this one would take hours.
#[test]
fn a_table_may_be_as_wide_as_it_likes() {
    const COLUMNS: usize = 200_000;
    let head: Vec<_> = (0..COLUMNS).map(|column| format!("c{column}")).collect();
    let mut text = head.join(",") + "\n";
    for row in 0..20 {
        text += &format!("{row},5.0,");
        text += &"0.25,".repeat(COLUMNS - 4);
        text += &format!("{},7\n", f64::from(row) * 1e-3);
    }
    let last = COLUMNS - 2;
    for map in [
        format!("time=c0[ms],spindle=c{last}[rev],z=c1[mm]"),
        format!("time=#1[ms],spindle=#{}[rev],z=#2[mm]", last + 1),
    ] {
        let found = read(&text, Some(&map)).unwrap();
        assert_eq!((found.samples.len(), found.corrupt, found.gaps), (20, 0, 0));
        assert!((found.samples[19].spindle_counts / found.scale.counts_per_rev - 0.019).abs() < 1e-9);
    }
    // The place of a fault is found there, too.
    let wrong = text.replacen("0.019,7", "x,7", 1);
    let (_, line, column) = read(&wrong, Some(&format!("spindle=c{last}[rev],z=c1[mm]"))).err().unwrap();
    assert_eq!((line, column), (21, 3 + 4 + 5 * (COLUMNS - 4) + 1));
}
