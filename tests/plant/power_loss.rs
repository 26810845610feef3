//! Power cut at sixteen moments of a hole: what its record then leads out of it.

use std::fmt::Write;
use std::path::Path;

use rigidtap::control::cycle::{CyclePlan, Hand, Interrupted, TapCycle};
use rigidtap::control::machine::{Law, Machine};
use rigidtap::control::math::poly::State;
use rigidtap::control::port::{Feedback, Port, Setpoint, Truth};
use rigidtap::control::sync::{Compensation, Settings, Stage, synchronisation_error_mm};
use rigidtap::control::tapping::{PowerLossRecord, RestoreError, RestoredHole, Tapping};
use rigidtap::control::units::um_from_mm;
use rigidtap::sim::{Plant, PlantOptions};

const PERIOD_S: f64 = 0.001;
const PITCH_MM: f64 = 1.0;
const MOMENTS: u32 = 16;
const SPEEDS_RPM: [f64; 3] = [1000.0, 3000.0, 7000.0];
/// Within it of the thread the tap has to come out.
const THREAD_UM: f64 = 20.0;
/// What a restart takes: the control is made anew, its axes held.
const RESTART_PERIODS: u32 = 50;
/// A spindle that coasts from 7000 rpm takes seconds.
const LONGEST_PERIODS: u32 = 30_000;
/// The spindle's encoder is a single-turn one: after the restart it counts from the turn it is in.
const COUNTS_PER_REV: i64 = 16_384;

/// What fails.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Cut {
    /// The mains: drives and host live on the DC link until both axes stand.
    Mains,
    /// Everything at once: both axes coast.
    All,
}

/// A machine and its host through a power cut.
struct Shop {
    machine: Machine,
    hole: TapCycle,
    settings: Settings,
    plant: Plant,
    k: u32,
    /// True positions in the hole's first synchronous period.
    zero: Option<Truth>,
    /// Least and greatest true e(k) since then, µm, while a control has the axes.
    band_um: [f64; 2],
    /// Synchronous periods so far.
    synchronous: u32,
}

impl Shop {
    fn new(speed_rpm: f64, compensation: Compensation, hand: Hand) -> Self {
        let machine = Machine::reference();
        let hole = TapCycle { hand, ..TapCycle::right_hand(0.0, -20.0, PITCH_MM, speed_rpm) };
        let mut plant = Plant::new(&machine, &PlantOptions::default());
        plant.begin_hole(&hole);
        let settings = Settings { compensation, ..Settings::default() };
        Self { machine, hole, settings, plant, k: 0, zero: None, band_um: [0.0; 2], synchronous: 0 }
    }

    fn now_s(&self) -> f64 {
        f64::from(self.k) * PERIOD_S
    }

    /// True e(k), counted from the hole's first synchronous period.
    fn error_um(&mut self) -> f64 {
        let truth = self.plant.truth().expect("a simulation knows");
        let zero = *self.zero.get_or_insert(truth);
        let turned = self.hole.hand.sign() * (truth.spindle_rev - zero.spindle_rev);
        um_from_mm(synchronisation_error_mm(zero.z_mm - truth.z_mm, PITCH_MM, turned))
    }

    /// One period of a control whose spindle count is less by some turns; its stage.
    fn period(&mut self, tapping: &mut Tapping, turns: i64) -> Stage {
        let now_s = self.now_s();
        let read = self.plant.read(now_s);
        let told = Feedback { spindle_counts: read.spindle_counts - turns * COUNTS_PER_REV, ..read };
        let step = tapping.step(now_s, &told).expect("under way");
        assert_eq!(step.alarm, None, "period {}", self.k);
        if matches!(step.stage, Stage::Synchronous(..)) {
            let error_um = self.error_um();
            self.band_um = [self.band_um[0].min(error_um), self.band_um[1].max(error_um)];
            self.synchronous += 1;
        }
        let setpoint = step.setpoint(State::default(), State::default());
        self.plant.write(now_s, &Setpoint { spindle: setpoint.spindle.shifted(turns as f64), ..setpoint });
        self.k += 1;
        step.stage
    }

    /// Taps until so many synchronous periods have passed; none where the hole has ended before.
    fn tap(&mut self, periods: u32) -> Option<Tapping> {
        let mut tapping = Tapping::new(&self.machine);
        let plan = CyclePlan::new(self.hole, &self.machine, Law::TorqueCurve).expect("feasible");
        tapping.start(plan, self.settings, 0.0, 0.0, 0.0).expect("at rest");
        while self.synchronous <= periods {
            if self.period(&mut tapping, 0) == Stage::Done {
                return None;
            }
        }
        Some(tapping)
    }

    /// Both axes come to rest, and the control ends.
    fn cut(&mut self, cut: Cut, mut tapping: Tapping) {
        match cut {
            Cut::Mains => {
                tapping.stop(self.now_s());
                // Setpoints act a few periods late: what is held stands soon.
                let mut held = 0;
                while held < 20 {
                    let stage = self.period(&mut tapping, 0);
                    held += u32::from(matches!(stage, Stage::Synchronous(_, Some(Interrupted::Holding))));
                }
                self.plant.set_power(false);
            }
            Cut::All => {
                self.plant.set_power(false);
                let (mut before, mut rests) = ([0; 2], 0);
                for _ in 0..LONGEST_PERIODS {
                    let read = self.plant.read(self.now_s());
                    let now = [read.spindle_counts, read.z_counts];
                    rests = if (0..2).all(|axis| (now[axis] - before[axis]).abs() <= 1) { rests + 1 } else { 0 };
                    before = now;
                    if rests > 50 {
                        break;
                    }
                    self.plant.write(self.now_s(), &Setpoint::default());
                    self.k += 1;
                }
                assert!(rests > 50, "the axes do not come to rest");
            }
        }
    }

    /// After the restart the tap is led out of the hole, or that is refused.
    fn restart(&mut self, record: &[u8; PowerLossRecord::BYTES]) -> Result<(), RestoreError> {
        self.plant.set_power(true);
        let mut tapping = Tapping::new(&self.machine);
        let read = self.plant.read(self.now_s());
        let turns = read.spindle_counts.div_euclid(COUNTS_PER_REV);
        let told = Feedback { spindle_counts: read.spindle_counts - turns * COUNTS_PER_REV, ..read };
        let record = PowerLossRecord::from_bytes(record)?;
        let hole = RestoredHole::plan(&record, &self.machine, Law::TorqueCurve, None, &told)?;
        tapping.restore(hole, self.settings, self.now_s()).expect("no hole is under way");
        for _ in 0..RESTART_PERIODS {
            let stage = self.period(&mut tapping, turns);
            assert!(matches!(stage, Stage::Synchronous(_, Some(Interrupted::Holding))), "{stage:?}");
        }
        assert!(tapping.resume(self.now_s()).is_err(), "what was cut off is not gone on with");
        tapping.retract(self.now_s()).expect("held");
        while self.period(&mut tapping, turns) != Stage::Done {}
        assert!(self.plant.truth().is_some_and(|truth| truth.z_mm.abs() < 0.1), "it is out");
        Ok(())
    }
}

/// What came of one cut.
struct Outcome {
    /// When, as synchronous periods.
    at: u32,
    /// Where the true tip came to rest.
    rest_mm: f64,
    /// True e(k) of the whole hole, the way out among it, a magnitude.
    error_um: f64,
    /// The same of where the tap stood when the power came back, in the turn of the helix that is nearest.
    stood_um: f64,
    refused: Option<RestoreError>,
}

/// One cut, in the middle of one of sixteen parts of the hole; right-hand and left-hand threads in turn.
fn through(cut: Cut, speed_rpm: f64, compensation: Compensation, part: u32) -> Outcome {
    let hand = if part.is_multiple_of(2) { Hand::Right } else { Hand::Left };
    let mut whole = Shop::new(speed_rpm, compensation, hand);
    assert!(whole.tap(u32::MAX - 1).is_none());
    let at = (2 * part + 1) * whole.synchronous / (2 * MOMENTS);
    let mut shop = Shop::new(speed_rpm, compensation, hand);
    let tapping = shop.tap(at).expect("the hole is not over");
    let record = tapping.power_loss_record().expect("in the hole").to_bytes();
    shop.cut(cut, tapping);
    let rest_mm = shop.plant.truth().expect("a simulation knows").z_mm;
    let stood_um = shop.error_um();
    let stood_um = stood_um - um_from_mm(PITCH_MM) * (stood_um / um_from_mm(PITCH_MM)).round();
    let refused = shop.restart(&record).err();
    let [low_um, high_um] = shop.band_um;
    Outcome { at, rest_mm, error_um: high_um.max(-low_um), stood_um, refused }
}

fn cuts(cut: Cut, compensation: Compensation, name: &str, rows: &mut Vec<Outcome>) -> String {
    let mut text = String::new();
    for speed_rpm in SPEEDS_RPM {
        for part in 0..MOMENTS {
            let found = through(cut, speed_rpm, compensation, part);
            let Outcome { at, rest_mm, error_um, stood_um, refused } = &found;
            let end = match refused {
                None => "retracted".to_owned(),
                Some(error) => error.to_string(),
            };
            // What a coasting axis does to the thread is no error of the way out.
            let error = if cut == Cut::Mains { format!("{error_um:6.1}") } else { "     -".into() };
            writeln!(text, "{name:<6} {speed_rpm:>4} {at:>6} {rest_mm:>9.3} {stood_um:>8.1} {error} {end}").unwrap();
            rows.push(found);
        }
    }
    text
}

/// Holds the readable table, too: `BLESS=1` writes it anew.
fn golden(name: &str, text: &str) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/plant").join(name);
    if std::env::var_os("BLESS").is_some() {
        std::fs::write(&path, text).unwrap();
    }
    let kept = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(kept == text, "{} differs; now:\n{text}", path.display());
}

const HEADING: &str = "\
One M6 hole of 20 mm, torque curve, power cut at 16 moments: when (periods of the hole), where the tip then rests (R is 0),
how far beside its helix (the nearest turn), greatest true |e| of the whole hole with the way out, and what came of it.

comp      S   cut at   rest mm  beside µm  |e| µm
";

#[test]
fn mains_fail_and_the_tap_comes_out_on_its_thread() {
    let (mut text, mut rows) = (HEADING.to_owned(), Vec::new());
    for compensation in [Compensation::Uncompensated, Compensation::ModelBased] {
        text += &cuts(Cut::Mains, compensation, compensation.name(), &mut rows);
    }
    for found in &rows {
        assert!(found.error_um < THREAD_UM, "{:.1} µm, cut in period {}", found.error_um, found.at);
        // A stop that ends on R leaves nothing to retract.
        let is_out = |error: &RestoreError| matches!(error, RestoreError::NotInHole { depth_mm } if *depth_mm < 0.05);
        assert!(found.refused.as_ref().is_none_or(is_out), "{:?}", found.refused);
    }
    golden("power_loss_mains.txt", &text);
}

#[test]
fn all_is_dead_and_the_tap_comes_out_or_is_refused_with_the_offset() {
    let (mut text, mut rows) = (HEADING.to_owned(), Vec::new());
    text += &cuts(Cut::All, Compensation::ModelBased, "full", &mut rows);
    let limit_um = Machine::reference().supervision(PITCH_MM).error_um;
    // Encoder at the motor, true tool: what lies between them, and a count.
    let blind_um = 8.0;
    for found in &rows {
        match found.refused {
            None => assert!(found.stood_um.abs() < limit_um + blind_um, "{}", found.stood_um),
            Some(RestoreError::OffHelix { offset_um, limit_um: told_um }) => {
                assert!(told_um == limit_um && (offset_um - found.stood_um).abs() < blind_um, "{offset_um}");
            }
            Some(RestoreError::NotInHole { depth_mm }) => assert!((depth_mm + found.rest_mm).abs() < 0.02),
            Some(other) => panic!("{other}"),
        }
    }
    let refused = rows.iter().filter(|found| found.refused.is_some()).count();
    assert!(refused > 0 && refused < rows.len(), "{refused} of {}", rows.len());
    golden("power_loss_dead.txt", &text);
}

/// At the bottom both axes rest for a moment: cut off there, they stay on the helix.
#[test]
fn dead_in_the_dwell_the_tap_comes_out() {
    let mut shop = Shop::new(3000.0, Compensation::ModelBased, Hand::Right);
    shop.hole.dwell_s = 1.0;
    let tapping = shop.tap(900).expect("in its dwell");
    let record = tapping.power_loss_record().expect("in the hole").to_bytes();
    shop.cut(Cut::All, tapping);
    shop.restart(&record).expect("on its helix");
    let [low_um, high_um] = shop.band_um;
    assert!(high_um < THREAD_UM && low_um > -THREAD_UM, "{low_um} {high_um}");
}

#[test]
fn a_record_of_another_machine_or_none_moves_nothing() {
    let mut shop = Shop::new(3000.0, Compensation::ModelBased, Hand::Right);
    let tapping = shop.tap(200).expect("in the hole");
    let record = tapping.power_loss_record().expect("in the hole").to_bytes();
    shop.cut(Cut::Mains, tapping);
    let mut damaged = record;
    damaged[30] ^= 0x10;
    assert!(matches!(shop.restart(&damaged), Err(RestoreError::Damaged { .. })));
    shop.machine = shop.machine.with(|spec| spec.z_axis.encoder_counts_per_mm *= 2.0).expect("a scale");
    assert!(matches!(shop.restart(&record), Err(RestoreError::OtherMachine { .. })));
    let tapping = Tapping::new(&shop.machine);
    assert_eq!(tapping.power_loss_record(), None);
}
