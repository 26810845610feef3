//! Every fault that can be injected, by what it does to what the host reads and to the machine.

use rigidtap::control::cycle::TapCycle;
use rigidtap::control::machine::Machine;
use rigidtap::control::math::poly::State;
use rigidtap::control::port::{DriveState, Feedback, Port, Setpoint, Truth};
use rigidtap::sim::{Axis, AxisFault, Fault, Injection, Plant, PlantOptions};

const AT_S: f64 = 0.3;
const AT: usize = 300;
const SPEED: f64 = 25.0;

struct Seen {
    read: Vec<Feedback>,
    truth: Vec<Truth>,
    plant: Plant,
}

/// Half a second of a thread from R at 0 downwards at 25 rev/s, with what was read and true in each period.
fn run(faults: &[Injection]) -> Seen {
    let faults = std::array::from_fn(|index| faults.get(index).copied());
    let mut plant = Plant::new(&Machine::reference(), &PlantOptions { faults, ..PlantOptions::default() });
    plant.begin_hole(&TapCycle::right_hand(0.0, -25.0, 1.0, 1500.0));
    let (mut read, mut truth) = (Vec::new(), Vec::new());
    for period in 0..600_u32 {
        let now_s = f64::from(period) * 0.001;
        read.push(plant.read(now_s));
        truth.push(plant.truth().expect("a simulation knows"));
        let ramp = State { acceleration: SPEED / 0.1, ..State::default() };
        let spindle = if now_s < 0.1 {
            ramp.after(now_s, 0.0)
        } else {
            State { acceleration: 0.0, ..ramp.after(0.1, 0.0) }.after(now_s - 0.1, 0.0)
        };
        let z = State {
            position: -spindle.position,
            velocity: -spindle.velocity,
            acceleration: -spindle.acceleration,
            jerk: 0.0,
        };
        plant.write(now_s, &Setpoint { spindle, z, ..Setpoint::default() });
    }
    Seen { read, truth, plant }
}

fn one(fault: Fault) -> Seen {
    run(&[Injection::new(fault, AT_S)])
}

fn axis(axis: Axis, fault: AxisFault) -> Seen {
    one(Fault::Axis(axis, fault))
}

fn count(read: &Feedback, axis: Axis) -> i64 {
    if axis == Axis::Spindle { read.spindle_counts } else { read.z_counts }
}

fn counts(seen: &Seen, axis: Axis) -> Vec<i64> {
    seen.read.iter().map(|read| count(read, axis)).collect()
}

const AXES: [Axis; 2] = [Axis::Spindle, Axis::Z];

#[test]
fn until_it_happens_nothing_differs() {
    let healthy = run(&[]);
    for fault in Fault::all() {
        let seen = one(fault);
        assert!(seen.read[..AT] == healthy.read[..AT] && seen.truth[..AT] == healthy.truth[..AT], "{fault}");
        let differs = seen.read[AT..] != healthy.read[AT..] || seen.truth[AT..] != healthy.truth[AT..];
        // A limit is felt only by who comes to it, and the clock only by who asks for it.
        let hidden = fault.is_of_the_clock() || matches!(fault, Fault::Axis(_, AxisFault::Weak));
        assert!(differs || hidden, "{fault} is not felt");
    }
}

/// What lies in the host's reading alone moves nothing: the drives keep their own encoders.
#[test]
fn faults_of_the_reading_leave_the_machine_alone() {
    let healthy = run(&[]);
    let of_reading = [
        AxisFault::Invalid,
        AxisFault::Repeated,
        AxisFault::Frozen,
        AxisFault::Jump,
        AxisFault::Wrap,
        AxisFault::Reversed,
        AxisFault::Scaled,
        AxisFault::EffortNan,
        AxisFault::EffortHuge,
    ];
    for fault in of_reading {
        for which in AXES {
            assert!(axis(which, fault).truth == healthy.truth, "{which:?} {fault:?}");
        }
    }
    assert!(one(Fault::FrameInvalid).truth == healthy.truth && one(Fault::FrameRepeated).truth == healthy.truth);
}

#[test]
fn a_lost_sample_keeps_the_last_count_for_three_periods() {
    let healthy = run(&[]);
    for which in AXES {
        let (invalid, repeated) = (axis(which, AxisFault::Invalid), axis(which, AxisFault::Repeated));
        let held = counts(&healthy, which)[AT - 1];
        for seen in [&invalid, &repeated] {
            assert_eq!(counts(seen, which)[AT..AT + 3], [held; 3]);
            assert_eq!(counts(seen, which)[AT + 3..], counts(&healthy, which)[AT + 3..]);
        }
        let valid = |seen: &Seen, at: usize| if which == Axis::Spindle { seen.read[at].spindle } else { seen.read[at].z }.sample_valid;
        assert!(!valid(&invalid, AT) && valid(&invalid, AT + 3) && valid(&repeated, AT));
    }
    let long: Injection = "frame-invalid@0.3+0.02".parse().unwrap();
    let seen = run(&[long]);
    let lost = seen.read.iter().filter(|read| !read.spindle.sample_valid && !read.z.sample_valid).count();
    assert_eq!(lost, 20);
    let seen = one(Fault::FrameRepeated);
    assert!(
        seen.read[AT..AT + 3].iter().all(|read| *read == seen.read[AT - 1]) && seen.read[AT + 3] != seen.read[AT - 1]
    );
}

#[test]
fn counts_jump_wrap_freeze_turn_round_or_are_too_large() {
    let healthy = run(&[]);
    for which in AXES {
        let good = counts(&healthy, which);
        let of = |fault| counts(&axis(which, fault), which);
        assert!(of(AxisFault::Jump)[AT..].iter().zip(&good[AT..]).all(|(found, good)| found - good == 1_000_000));
        assert!(of(AxisFault::Wrap)[AT..].iter().zip(&good[AT..]).all(|(found, good)| good - found == 1 << 24));
        assert!(of(AxisFault::Frozen)[AT..].iter().all(|found| *found == good[AT - 1]));
        let mirrored = of(AxisFault::Reversed);
        assert!(mirrored[AT..].iter().zip(&good[AT..]).all(|(found, read)| found - good[AT] == good[AT] - read));
        let scaled = of(AxisFault::Scaled);
        let ratio = (scaled[599] - good[AT]) as f64 / (good[599] - good[AT]) as f64;
        assert!((ratio - 1.02).abs() < 1e-3, "{ratio}");
    }
}

/// The loops themselves lose their eyes: the drive runs after a position that does not come.
#[test]
fn a_frozen_encoder_blinds_its_drive() {
    let healthy = run(&[]);
    for which in AXES {
        let seen = axis(which, AxisFault::EncoderFrozen);
        let still = counts(&seen, which);
        assert!(still[AT + 1..].iter().all(|found| (found - still[AT + 1]).abs() <= 1), "{which:?}");
        let at = |truth: &Truth| if which == Axis::Spindle { truth.spindle_rev } else { -truth.z_mm };
        let ahead = at(&seen.truth[AT + 200]) - at(&healthy.truth[AT + 200]);
        assert!(ahead > 0.5, "{which:?}: {ahead} ahead");
    }
}

#[test]
fn a_drive_that_is_off_lets_its_axis_coast() {
    for (fault, state) in [(AxisFault::Trip, Some(DriveState::NotReady)), (AxisFault::Coast, None)] {
        let seen = axis(Axis::Spindle, fault);
        assert_eq!(seen.read[AT + 5].spindle.drive, state);
        assert!(seen.truth[AT + 20..].iter().all(|truth| truth.spindle_torque_nm.abs() < 1e-6));
        // Friction and the cut alone brake it: slowly.
        let (rpm, later) = (seen.truth[AT].spindle_rpm, seen.truth[AT + 100].spindle_rpm);
        assert!(later < rpm - 10.0 && later > 0.0, "{rpm} then {later} rpm");
        let seen = axis(Axis::Z, fault);
        assert_eq!(seen.read[AT + 5].z.drive, state);
        // 300 N on 600 kg stop 25 mm/s in 50 ms.
        assert!(seen.truth[AT + 20..].iter().all(|truth| truth.z_force_n.abs() < 1e-6));
        let speed = (seen.truth[AT + 100].z_mm - seen.truth[AT + 90].z_mm) / 0.01;
        assert!(speed.abs() < 1.0, "{speed} mm/s");
    }
}

/// Full torque asked for all the time: half of it comes.
#[test]
fn a_weak_motor_gives_half_its_torque() {
    let torque_nm = |faults: [Option<Injection>; 4]| {
        let mut plant = Plant::new(&Machine::reference(), &PlantOptions { faults, ..PlantOptions::default() });
        for period in 0..60_u32 {
            let now_s = f64::from(period) * 0.001;
            let spindle = State { acceleration: 5000.0, ..State::default() }.after(now_s, 0.0);
            plant.read(now_s);
            plant.write(now_s, &Setpoint { spindle, ..Setpoint::default() });
        }
        plant.truth().unwrap().spindle_torque_nm
    };
    let weak = Injection::new(Fault::Axis(Axis::Spindle, AxisFault::Weak), 0.02);
    let (healthy_nm, weak_nm) = (torque_nm([None; 4]), torque_nm([Some(weak), None, None, None]));
    assert!((healthy_nm - 20.0).abs() < 0.3 && (weak_nm - 10.0).abs() < 0.3, "{healthy_nm} and {weak_nm} N·m");
}

#[test]
fn what_holds_or_pushes_z_moves_it_off_its_command() {
    let healthy = run(&[]);
    let caught = one(Fault::ZCaught);
    let moved = caught.truth[AT].z_mm - caught.truth[599].z_mm;
    assert!(moved < 2.0, "{moved} mm in spite of 20 kN");
    let pushed = one(Fault::ZPushed);
    let off_um = |at: usize| 1000.0 * (healthy.truth[at].z_mm - pushed.truth[at].z_mm);
    assert!(off_um(AT + 20) > 30.0, "{} µm deeper", off_um(AT + 20));
    assert!(off_um(599).abs() < 10.0, "{} µm long after", off_um(599));
    let weak = axis(Axis::Z, AxisFault::Weak);
    // 5 % of 8829 N still carry 300 N of friction, but not a push beside it.
    let both = run(&[
        Injection::new(Fault::Axis(Axis::Z, AxisFault::Weak), AT_S),
        Injection { fault: Fault::ZPushed, at_s: AT_S, duration_s: Some(0.02) },
    ]);
    assert!((weak.truth[599].z_mm - healthy.truth[599].z_mm).abs() < 0.1);
    assert!(healthy.truth[AT + 20].z_mm - both.truth[AT + 20].z_mm > 0.3);
}

#[test]
fn a_tap_that_jams_stops_the_spindle_and_a_broken_one_frees_it() {
    let jam = one(Fault::TapJam);
    assert!(jam.truth[AT].spindle_rpm > 1400.0);
    assert!(jam.truth[450..].iter().all(|truth| truth.spindle_rpm.abs() < 60.0), "it turns on");
    assert!(jam.read[450].spindle.saturated == Some(true));
    let (broken, healthy) = (one(Fault::TapBroken), run(&[]));
    let mean = |seen: &Seen| seen.truth[450..].iter().map(|truth| truth.spindle_torque_nm).sum::<f64>() / 150.0;
    let saved = mean(&healthy) - mean(&broken);
    assert!((saved / 0.525 - 1.0).abs() < 0.1, "{saved} N·m less");
}

/// Both drives carry the last setpoint on: at constant speed nothing is lost, and the reading stays fresh.
#[test]
fn lost_setpoints_are_carried_on_by_both_drives() {
    let (seen, healthy) = (one(Fault::SetpointLost), run(&[]));
    for (found, good) in seen.truth[AT..].iter().zip(&healthy.truth[AT..]) {
        assert!((found.z_mm - good.z_mm).abs() < 1e-3 && (found.spindle_rev - good.spindle_rev).abs() < 1e-3);
    }
    // They go on accelerating where the command no longer does: 250 rev/s² for 10 ms.
    let long = Injection { fault: Fault::SetpointLost, at_s: 0.09, duration_s: Some(0.02) };
    let seen = run(&[long]);
    let off_um = |at: usize| 1000.0 * (healthy.truth[at].z_mm - seen.truth[at].z_mm);
    let most_um = (90..130).map(off_um).fold(0.0, f64::max);
    assert!(most_um > 5.0 && off_um(400).abs() < 2.0, "{most_um} and {} µm", off_um(400));
}

#[test]
fn efforts_are_senseless_for_three_periods() {
    let nan = axis(Axis::Spindle, AxisFault::EffortNan);
    let is_nan = |at: usize| nan.read[at].spindle_torque_nm.is_some_and(f64::is_nan);
    assert!(is_nan(AT) && is_nan(AT + 2) && !is_nan(AT + 3));
    let huge = axis(Axis::Z, AxisFault::EffortHuge);
    assert_eq!(huge.read[AT].z_force_n, Some(88_290.0));
    assert!(huge.read[AT + 3].z_force_n.unwrap().abs() < 8829.0);
}

#[test]
fn a_clock_gives_no_number_or_falls() {
    let mut nan = one(Fault::ClockNan).plant;
    assert!(nan.clock_s(0.6).is_nan());
    let mut falls = one(Fault::ClockFalls).plant;
    let (first, second) = (falls.clock_s(0.6), falls.clock_s(0.601));
    assert!(second < first && first < 0.6, "{first} then {second}");
    let mut healthy = run(&[]).plant;
    assert_eq!(healthy.clock_s(0.6), 0.6);
}

#[test]
fn names_are_one_each_and_read_back() {
    let names: Vec<_> = Fault::all().map(|fault| fault.to_string()).collect();
    let set: std::collections::BTreeSet<_> = names.iter().collect();
    assert_eq!(set.len(), names.len());
    for (fault, name) in Fault::all().zip(&names) {
        assert_eq!(format!("{name}@0.25").parse::<Injection>(), Ok(Injection::new(fault, 0.25)));
    }
    for wrong in ["z-jump", "z-jump@", "z-jump@-1", "z-jump@1+x", "z-jump@nan", "nothing@1"] {
        assert!(wrong.parse::<Injection>().unwrap_err().contains("expected"), "{wrong}");
    }
}
