//! Random orders, random feedback and random time: whatever a host does and whatever it is told, what leaves the synchronizer
//! is finite, bounded and continuous, and an alarm stays.
//!
//! `cargo test --release --test control ten_million -- --ignored` takes ten million periods a strategy.

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use rigidtap::control::cycle::{CyclePlan, Retract, TapCycle};
use rigidtap::control::machine::{Law, Machine, Takes};
use rigidtap::control::math::poly::State;
use rigidtap::control::port::{AxisStatus, DriveState, Feedback};
use rigidtap::control::sync::{Adaptation, Alarm, Compensation, Mode, Settings, Stage, Step, Synchronizer};

use crate::echo::Echo;

const PERIOD_S: f64 = 0.001;
/// The reference machine, written out here and not asked of the code under test.
const Z_MM_PER_S: f64 = 500.0;
const Z_MM_PER_S2: f64 = 10_000.0;
const SPINDLE_REV_PER_S: f64 = 8000.0 / 60.0;
/// 20 N·m of 0.004 kg·m², and a quarter more, since friction helps to brake.
const SPINDLE_REV_PER_S2: f64 = 1.25 * 20.0 / (0.004 * std::f64::consts::TAU);
/// Gains of its drives.
const POSITION_GAIN_PER_S: f64 = 40.0;
const SPINDLE_VELOCITY_GAIN_PER_S: f64 = 200.0;
const Z_VELOCITY_GAIN_PER_S: f64 = 500.0;
/// More than the control ever feeds forward to overcome friction, and that of the spindle.
const FORCE_MM_PER_S2: f64 = 3000.0 / 0.6;
/// Of limits, by what sums of doubles are off.
const ROUNDING: f64 = 1.0 + 1e-6;
/// Supervision bridges so many periods by default.
const BRIDGE_PERIODS: f64 = 5.0;

/// The host's clock as it was told, and what the control makes of it.
#[derive(Default)]
struct Clock {
    host_s: f64,
    last_s: Option<f64>,
    /// It failed once: from then on the control goes by its own.
    failed: bool,
}

impl Clock {
    /// Seconds and periods that the control takes to have passed.
    fn read(&mut self, told_s: f64) -> (f64, f64) {
        let elapsed_s = self.last_s.map_or(PERIOD_S, |last_s| told_s - last_s);
        self.failed |= !(0.0..=(BRIDGE_PERIODS + 0.5) * PERIOD_S).contains(&elapsed_s);
        if self.failed {
            return (PERIOD_S, 1.0);
        }
        self.last_s = Some(told_s);
        let periods = if elapsed_s > 1.5 * PERIOD_S { (elapsed_s / PERIOD_S).round() } else { 1.0 };
        (if elapsed_s > 0.25 * PERIOD_S { elapsed_s } else { PERIOD_S }, periods)
    }
}

/// One axis' setpoints from period to period.
struct Watch {
    name: &'static str,
    speed: f64,
    acceleration: f64,
    /// Where its drive takes a position alone: the velocity loop's gain.
    lags_by: Option<f64>,
    /// Position, mean speed since the one before, and periods that were made up in between.
    last: Option<(f64, f64, f64)>,
}

impl Watch {
    /// How much a position reference moves in a period beside the commanded motion, at most: by the speed's change and by what
    /// the velocity loop's error changes by, over the position gain. That error is the effort's high-pass, over its gain.
    fn beside(&self) -> Option<f64> {
        let asked = self.acceleration + FORCE_MM_PER_S2;
        self.lags_by.map(|gain_per_s| (self.acceleration * PERIOD_S + 4.0 * asked / gain_per_s) / POSITION_GAIN_PER_S)
    }

    fn check(&mut self, state: &State, (elapsed_s, periods): (f64, f64), place: &str) {
        let beside = self.beside().unwrap_or_default();
        let Self { name, speed: limit, acceleration, last, .. } = self;
        let all = [state.position, state.velocity, state.acceleration, state.jerk];
        assert!(all.iter().all(|value| value.is_finite()), "{place}: {name} {state:?}");
        assert!(state.velocity.abs() <= *limit * ROUNDING, "{place}: {name} {state:?}");
        assert!(state.acceleration.abs() <= *acceleration * ROUNDING, "{place}: {name} {state:?}");
        let (before, mean_before, made_up) = last.unwrap_or((state.position, 0.0, 0.0));
        let mean = (state.position - before) / elapsed_s;
        let fastest = *limit + beside / PERIOD_S;
        assert!(mean.abs() <= fastest * ROUNDING, "{place}: {name} goes at {mean}");
        // Over periods that were made up only the mean is seen: the last of them may have been so much off it.
        let change = *acceleration * (elapsed_s + made_up * PERIOD_S) + 2.0 * beside / PERIOD_S;
        let found = (mean - mean_before).abs();
        assert!(
            found <= change * ROUNDING + 1e-6,
            "{place}: {name} changes its speed by {found}, {change} is the most"
        );
        *last = Some((state.position, mean, periods - 1.0));
    }
}

fn hole(random: &mut Pcg64) -> TapCycle {
    let pitch_mm = random.random_range(0.5..1.75);
    let depth_mm = random.random_range(3.0..30.0);
    let hole = TapCycle::right_hand(2.0, 2.0 - depth_mm, pitch_mm, random.random_range(1000.0..6600.0));
    let pecks = random.random_bool(0.2).then(|| (depth_mm / 3.0, Retract::ChipBreak { back_mm: 0.5 }));
    TapCycle {
        dwell_s: if random.random_bool(0.2) { 0.05 } else { 0.0 },
        peck_mm: pecks.map(|(peck_mm, _)| peck_mm),
        retract: pecks.map(|(_, retract)| retract),
        ..hole
    }
}

/// What a host's clock shows next.
fn tell_time(random: &mut Pcg64, clock: &mut Clock, wild: f64) -> f64 {
    clock.host_s += PERIOD_S * random.random_range(0.98..1.02);
    if random.random_bool(wild) {
        clock.host_s += PERIOD_S * f64::from(random.random_range(1..5_u32));
    }
    if random.random_bool(0.01 * wild) {
        return [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, -1.0, clock.host_s - 0.5, clock.host_s + 1.0, 1e300]
            [random.random_range(0..7)];
    }
    clock.host_s
}

/// What a reading is spoiled by for some periods.
#[derive(Default)]
struct Distortion {
    kind: u32,
    of_z: bool,
    left: u32,
}

impl Distortion {
    const KINDS: u32 = 14;

    fn begin(random: &mut Pcg64) -> Self {
        // A single period, a few, or until long after it was noticed.
        let most = [2, 8, 300][random.random_range(0..3)];
        let (kind, left) = (random.random_range(0..Self::KINDS), random.random_range(1..most));
        Self { kind, of_z: random.random_bool(0.5), left }
    }

    fn spoil(&mut self, random: &mut Pcg64, feedback: &mut Feedback, last: &Feedback) {
        self.left -= 1;
        let (counts, last_counts, status, effort) = if self.of_z {
            (&mut feedback.z_counts, last.z_counts, &mut feedback.z, &mut feedback.z_force_n)
        } else {
            (&mut feedback.spindle_counts, last.spindle_counts, &mut feedback.spindle, &mut feedback.spindle_torque_nm)
        };
        match self.kind {
            0 => *status = AxisStatus { sample_valid: false, ..*status },
            1 => *counts = last_counts,
            2 => *counts = counts.wrapping_add(random.random_range(-400..400)),
            3 => *counts = counts.wrapping_add(1_000_000),
            4 => *counts = random.random(),
            5 => *counts = counts.wrapping_neg(),
            6 => *counts = counts.wrapping_sub(1 << 24),
            7 => *effort = Some([f64::NAN, f64::INFINITY, -1e300, 1e9][random.random_range(0..4)]),
            8 => *effort = Some(random.random_range(-30.0..30.0)),
            9 => status.drive = Some(DriveState::NotReady),
            10 => status.saturated = Some(true),
            11 => feedback.z_motor_counts = Some(random.random()),
            12 => *feedback = *last,
            _ => *feedback = Feedback::default(),
        }
    }
}

/// One hole until it is done, or some time after it went wrong. Returns its periods.
fn run(seed: u64, mode: Mode, compensation: Compensation, takes: Takes, tried: &mut Tried) -> u32 {
    let mut random = Pcg64::seed_from_u64(seed);
    let machine = Machine::reference()
        .with(|spec| (spec.drive.spindle_takes, spec.drive.z_takes) = (takes, takes))
        .expect("valid");
    let lags = takes == Takes::Position;
    let cycle = hole(&mut random);
    let plan = CyclePlan::new(cycle, &machine, Law::TorqueCurve).expect("feasible");
    let settings = Settings { mode, compensation, ..Settings::default() };
    let (mut synchronizer, mut adaptation) = (Synchronizer::new(plan, settings, 0.0), Adaptation::new(&machine));
    // From a sound machine to one where nothing is right, and as many kinds of hosts.
    let wild = [0.0, 0.0005, 0.002, 0.1][random.random_range(0..4)];
    let busy = [0.0, 0.002, 0.02][random.random_range(0..3)];
    let late = [0.0, 0.001, 0.02][random.random_range(0..3)];
    let clearance_mm = 0.5 * cycle.pitch_mm;
    let mut echo = if lags {
        Echo::lagging(cycle.r_plane_mm, POSITION_GAIN_PER_S * PERIOD_S)
    } else {
        Echo::at_rest(cycle.r_plane_mm)
    };
    let mut clock = Clock::default();
    let watch = |name, speed, acceleration, gain_per_s: f64| Watch {
        name,
        speed,
        acceleration,
        lags_by: lags.then_some(gain_per_s),
        last: None,
    };
    let mut spindle = watch("spindle", SPINDLE_REV_PER_S, SPINDLE_REV_PER_S2, SPINDLE_VELOCITY_GAIN_PER_S);
    let mut z = watch("Z", Z_MM_PER_S, Z_MM_PER_S2, Z_VELOCITY_GAIN_PER_S);
    // A position reference leads by the speed over the gain, and by what gives acceleration and force.
    let lead_mm = z.lags_by.map_or(0.0, |gain_per_s| {
        (Z_MM_PER_S + 2.0 * (Z_MM_PER_S2 + FORCE_MM_PER_S2) / gain_per_s) / POSITION_GAIN_PER_S
    });
    let mut latched: Option<Alarm> = None;
    let (mut last, mut distortion) = (Feedback::default(), Distortion::default());
    let most = random.random_range(500..5000);
    for k in 0..most {
        let place = || format!("seed {seed}, {} {}, period {k}", mode.name(), compensation.name());
        let now_s = tell_time(&mut random, &mut clock, late);
        if random.random_bool(busy) {
            match random.random_range(0..4) {
                0 => synchronizer.stop(now_s),
                1 => {
                    let _ = synchronizer.retract(now_s);
                }
                2 => {
                    let _ = synchronizer.resume(now_s);
                }
                _ if synchronizer.acknowledge() => {
                    tried.acknowledged += u32::from(latched.is_some());
                    latched = None;
                }
                _ => {}
            }
        }
        let mut feedback = echo.read(&mut random);
        if distortion.left == 0 && random.random_bool(wild) {
            distortion = Distortion::begin(&mut random);
        }
        if distortion.left > 0 {
            distortion.spoil(&mut random, &mut feedback, &last);
        }
        last = feedback;
        let elapsed = clock.read(now_s);
        let step = synchronizer.step(now_s, &feedback, &mut adaptation);
        spindle.check(&step.spindle, elapsed, &place());
        z.check(&step.z, elapsed, &place());
        let Step { stage, alarm, .. } = step;
        let scalars = [step.spindle_torque_nm, step.z_force_n, step.correction_mm, step.error_mm, step.path_rate];
        assert!(scalars.iter().all(|value| value.is_finite()), "{}: {step:?}", place());
        let beyond_mm = clearance_mm + lead_mm + 1e-9;
        let range = cycle.bottom_mm - beyond_mm..=cycle.r_plane_mm + beyond_mm;
        assert!(range.contains(&step.z.position), "{}: {step:?}", place());
        // An alarm stays as it is until it is acknowledged, and no hole is done with it.
        let codes = [latched, alarm].map(|alarm| alarm.map(|alarm| alarm.code()));
        assert!(latched.is_none() || codes[0] == codes[1], "{}: {latched:?} {step:?}", place());
        assert!(alarm.is_none() || stage != Stage::Done, "{}: {step:?}", place());
        if let (None, Some(alarm)) = (latched, alarm) {
            tried.alarms[alarm.code() as usize - 101] += 1;
        }
        latched = alarm;
        if stage == Stage::Done {
            tried.done += 1;
            return k + 1;
        }
        echo.write(&step, elapsed.1 as u32);
    }
    most
}

/// What came up: a test that meets no alarm would prove nothing.
#[derive(Debug, Default)]
struct Tried {
    alarms: [u32; 12],
    acknowledged: u32,
    done: u32,
}

fn every_strategy(periods: u32, takes: Takes, compensations: &[Compensation], least_done: u32) {
    let (mut tried, mut seed) = (Tried::default(), 0);
    for mode in [Mode::Commanded, Mode::Following] {
        for &compensation in compensations {
            let mut left = periods;
            while left > 0 {
                left = left.saturating_sub(run(seed, mode, compensation, takes, &mut tried));
                seed += 1;
            }
        }
    }
    let came = |code: u32| tried.alarms[code as usize - 101] > 0;
    // All but a broken tap, and an axis that waits for seconds.
    assert!((101..=111).filter(|code| *code != 109).all(came), "{tried:?}");
    assert!(tried.done > least_done && tried.acknowledged > 100, "{tried:?}");
}

#[test]
fn nothing_that_it_is_told_makes_it_leap() {
    every_strategy(100_000, Takes::Torque, &Compensation::ALL, 20);
}

/// The bounds hold for the commanded motion; what a drive is sent that takes a position alone is that and no more than its
/// loops' inverse makes of it.
#[test]
fn nor_where_drives_take_positions_alone() {
    every_strategy(100_000, Takes::Position, &[Compensation::ModelBased], 5);
}

#[test]
#[ignore = "ten million periods a strategy take minutes"]
fn ten_million_periods_of_nonsense() {
    every_strategy(10_000_000, Takes::Torque, &Compensation::ALL, 20);
}
