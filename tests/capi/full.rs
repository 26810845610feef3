//! Compensation `full` through the C interface, on simulated drives that take torque and force.

use rigidtap::capi::{
    RigidtapAxes, RigidtapBlock, RigidtapBlockRequest, RigidtapFeedback, RigidtapHole, RigidtapMachine,
    RigidtapMachineData, RigidtapSetpoint, RigidtapState, RigidtapStatus, RigidtapTap, reports, rigidtap_block_plan,
    rigidtap_block_step, rigidtap_machine_init, rigidtap_machine_reference, rigidtap_tap_load_learned,
    rigidtap_tap_plan, rigidtap_tap_save_learned, rigidtap_tap_start, rigidtap_tap_step, status,
};
use rigidtap::control::cycle::TapCycle;
use rigidtap::control::machine::Machine;
use rigidtap::control::math::poly::State;
use rigidtap::control::port::{Feedback, Port, Setpoint};
use rigidtap::control::sync::LEARNED_BYTES;
use rigidtap::sim::{Plant, PlantOptions};

use super::zeroed;

const NONE: u32 = 0;
pub(super) const FULL: u32 = 2;
pub(super) const SYNCHRONOUS: u32 = 2;
pub(super) const DONE: u32 = 6;
pub(super) const COUNTS_PER_REV: f64 = 16_384.0;
pub(super) const COUNTS_PER_MM: f64 = 10_000.0;

/// What the drives report beyond the two encoders.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Told {
    Everything,
    Nothing,
    /// Torque and force, but not where Z's motor is.
    Efforts,
}

fn machine() -> Box<RigidtapMachine> {
    let (mut machine, mut data): (Box<RigidtapMachine>, Box<RigidtapMachineData>) = (zeroed(), zeroed());
    // SAFETY: every pointer is of a live value of its own.
    unsafe {
        assert_eq!(rigidtap_machine_reference(&raw mut *data), RigidtapStatus::Ok);
        assert_eq!(
            rigidtap_machine_init(&raw mut *machine, &raw const *data, std::ptr::null_mut()),
            RigidtapStatus::Ok
        );
    }
    machine
}

fn hole(compensation: u32, learn: u32) -> RigidtapHole {
    let mut hole: Box<RigidtapHole> = zeroed();
    (hole.r_plane_mm, hole.bottom_mm, hole.return_mm) = (2.0, -20.0, 10.0);
    (hole.pitch_mm, hole.speed_rpm) = (1.0, 5000.0);
    (hole.compensation, hole.identify, hole.learn) = (compensation, 1, learn);
    *hole
}

/// A drive makes torque of the acceleration, and takes the feedforward beside it.
pub(super) fn state(state: RigidtapState) -> State {
    State { position: state.position, velocity: state.velocity, acceleration: state.acceleration, ..State::default() }
}

pub(super) fn feedback(read: &Feedback, told: Told) -> RigidtapFeedback {
    let efforts = reports::SPINDLE_TORQUE | reports::Z_FORCE;
    let reported = match told {
        Told::Everything => reports::Z_MOTOR | efforts,
        Told::Nothing => 0,
        Told::Efforts => efforts,
    };
    RigidtapFeedback {
        spindle_counts: read.spindle_counts,
        z_counts: read.z_counts,
        z_motor_counts: read.z_motor_counts.unwrap_or(0),
        spindle_torque_nm: read.spindle_torque_nm.unwrap_or(0.0),
        z_force_n: read.z_force_n.unwrap_or(0.0),
        reported: reported | reports::SPINDLE_SATURATED,
        status: if read.torque_saturated() { status::SPINDLE_SATURATED } else { 0 },
    }
}

/// e(k) from the counts alone: the least and the greatest of a hole, from its first synchronous period on.
#[derive(Clone, Copy, Debug)]
struct Band {
    zero: Feedback,
    min_um: f64,
    max_um: f64,
}

impl Band {
    fn add(band: &mut Option<Self>, read: &Feedback) {
        let band = band.get_or_insert(Self { zero: *read, min_um: 0.0, max_um: 0.0 });
        let z_mm = (band.zero.z_counts - read.z_counts) as f64 / COUNTS_PER_MM;
        let error_um = (z_mm - (read.spindle_counts - band.zero.spindle_counts) as f64 / COUNTS_PER_REV) * 1000.0;
        (band.min_um, band.max_um) = (band.min_um.min(error_um), band.max_um.max(error_um));
    }

    fn width_um(&self) -> f64 {
        self.max_um - self.min_um
    }
}

fn plant(z_start_mm: f64) -> Plant {
    Plant::new(&Machine::reference(), &PlantOptions { z_start_mm, ..PlantOptions::default() })
}

/// The widths of e(k) of a block's holes.
fn block(holes: u32, compensation: u32, learn: u32, told: Told) -> Vec<f64> {
    let machine = machine();
    let (mut block, mut request): (Box<RigidtapBlock>, Box<RigidtapBlockRequest>) = (zeroed(), zeroed());
    (request.hole, request.holes, request.start_z_mm) = (hole(compensation, learn), holes, 30.0);
    (request.step_x_mm, request.spindle_rpm) = (8.0, 1000.0);
    let none = std::ptr::null_mut();
    // SAFETY: every pointer is of a live value of its own.
    let planned = unsafe { rigidtap_block_plan(&raw mut *block, &raw const *machine, &raw const *request, none) };
    assert_eq!(planned, RigidtapStatus::Ok);
    let mut plant = plant(30.0);
    let mut bands = vec![None; holes as usize];
    let mut axes = RigidtapAxes::default();
    let mut was = (0, DONE);
    for period in 0..30_000 {
        let now_s = f64::from(period) * 0.001;
        let read = plant.read(now_s);
        let given = feedback(&read, told);
        // SAFETY: likewise.
        let status = unsafe { rigidtap_block_step(&raw mut *block, now_s, &raw const given, &raw mut axes, none) };
        assert_eq!(status, RigidtapStatus::Ok, "{period}");
        if axes.stage == DONE {
            return bands.iter().flatten().map(Band::width_um).collect();
        }
        if axes.stage == SYNCHRONOUS {
            if was != (axes.hole, SYNCHRONOUS) {
                plant.begin_hole(&TapCycle::right_hand(2.0, -20.0, 1.0, 5000.0));
            }
            Band::add(&mut bands[axes.hole as usize], &read);
        }
        was = (axes.hole, axes.stage);
        let setpoint = Setpoint {
            spindle: state(axes.spindle),
            z: state(axes.z),
            spindle_torque_nm: axes.spindle_torque_nm,
            z_force_n: axes.z_force_n,
            ..Setpoint::default()
        };
        plant.write(now_s, &setpoint);
    }
    panic!("the block does not end")
}

/// One hole after the other in the same state, each from rest where the last ended; the widths of their e(k).
fn taps(holes: u32, learn: u32) -> Vec<f64> {
    let mut tap: Box<RigidtapTap> = zeroed();
    taps_in(&mut tap, holes, learn)
}

/// The same in a state of the caller's.
fn taps_in(tap: &mut RigidtapTap, holes: u32, learn: u32) -> Vec<f64> {
    let machine = machine();
    let hole = hole(FULL, learn);
    let none = std::ptr::null_mut();
    let mut plant = plant(2.0);
    let mut setpoint = RigidtapSetpoint::default();
    let mut period = 0;
    let mut one = || {
        let mut band = None;
        // SAFETY: every pointer is of a live value of its own.
        unsafe {
            let planned = rigidtap_tap_plan(&raw mut *tap, &raw const *machine, &raw const hole, none);
            assert_eq!(planned, RigidtapStatus::Ok);
            // Where the spindle was told to rest, as the host knows it.
            let rest = (setpoint.spindle.position * COUNTS_PER_REV).round() as i64;
            let started = rigidtap_tap_start(&raw mut *tap, f64::from(period) * 0.001, rest, 0.0, none);
            assert_eq!(started, RigidtapStatus::Ok);
        }
        plant.begin_hole(&TapCycle::right_hand(2.0, -20.0, 1.0, 5000.0));
        for _ in 0..10_000 {
            let now_s = f64::from(period) * 0.001;
            let read = plant.read(now_s);
            let given = feedback(&read, Told::Everything);
            // SAFETY: likewise.
            let status = unsafe { rigidtap_tap_step(&raw mut *tap, now_s, &raw const given, &raw mut setpoint, none) };
            assert_eq!(status, RigidtapStatus::Ok);
            if setpoint.stage == DONE {
                return band.as_ref().map_or(f64::NAN, Band::width_um);
            }
            if setpoint.stage == SYNCHRONOUS {
                Band::add(&mut band, &read);
            }
            plant.write(
                now_s,
                &Setpoint {
                    spindle: state(setpoint.spindle),
                    z: state(setpoint.z),
                    spindle_torque_nm: setpoint.spindle_torque_nm,
                    z_force_n: setpoint.z_force_n,
                    ..Setpoint::default()
                },
            );
            period += 1;
        }
        panic!("the hole does not end")
    };
    (0..holes).map(|_| one()).collect()
}

fn mean(widths: &[f64]) -> f64 {
    widths.iter().sum::<f64>() / widths.len() as f64
}

#[test]
fn a_block_is_held_however_little_the_drives_tell() {
    let [none, nothing, efforts, everything] =
        [(NONE, Told::Everything), (FULL, Told::Nothing), (FULL, Told::Efforts), (FULL, Told::Everything)].map(
            |(compensation, told)| {
                let widths = block(3, compensation, 0, told);
                assert_eq!(widths.len(), 3, "{compensation} {told:?}");
                mean(&widths)
            },
        );
    assert!(nothing < 0.7 * none, "{nothing} µm, without {none}");
    // An encoder that is not told is not taken for one that stands still.
    assert!(efforts < 1.02 * nothing && everything < 1.02 * nothing, "{everything} {efforts} {nothing} µm");
}

#[test]
fn what_holes_teach_goes_on_to_the_next() {
    for (name, learned, plain) in [
        ("block", block(12, FULL, 1, Told::Everything), block(12, FULL, 0, Told::Everything)),
        ("taps in one state", taps(12, 1), taps(12, 0)),
    ] {
        assert_eq!((learned.len(), plain.len()), (12, 12), "{name}");
        assert!(learned[0] == plain[0], "{name}: the first hole has nothing to go by");
        assert!(mean(&learned[8..]) < 0.85 * mean(&plain[8..]), "{name}: {learned:?} {plain:?}");
    }
}

/// The state of a tap as bytes, and back into one that was never tapped with.
#[test]
fn what_holes_taught_outlives_a_restart() {
    let (machine, planned) = (machine(), hole(FULL, 1));
    let none = std::ptr::null_mut();
    let mut bytes = vec![0_u8; LEARNED_BYTES];
    let mut written = 0;
    let fresh = || {
        let mut tap: Box<RigidtapTap> = zeroed();
        // SAFETY: every pointer is of a live value of its own.
        let status = unsafe { rigidtap_tap_plan(&raw mut *tap, &raw const *machine, &raw const planned, none) };
        assert_eq!(status, RigidtapStatus::Ok);
        tap
    };
    let (mut tap, mut restarted): (Box<RigidtapTap>, _) = (zeroed(), fresh());
    taps_in(&mut tap, 3, 1);
    // SAFETY: likewise, and both lengths are those of the bytes.
    unsafe {
        let size = bytes.len() as u64;
        let saved = rigidtap_tap_save_learned(&raw const *tap, bytes.as_mut_ptr(), size, &raw mut written, none);
        assert_eq!((saved, written > 2000 && written < size), (RigidtapStatus::Ok, true), "{written}");
        let small = rigidtap_tap_save_learned(&raw const *tap, bytes.as_mut_ptr(), 100, &raw mut written, none);
        assert_eq!(small, RigidtapStatus::NoRoom);
        let saved = rigidtap_tap_save_learned(&raw const *tap, bytes.as_mut_ptr(), size, &raw mut written, none);
        assert_eq!(saved, RigidtapStatus::Ok);
        let load = |tap: &mut RigidtapTap, bytes: &[u8]| {
            rigidtap_tap_load_learned(&raw mut *tap, bytes.as_ptr(), bytes.len() as u64, none)
        };
        let kept = &bytes[..written as usize];
        assert_eq!(load(&mut restarted, kept), RigidtapStatus::Ok);
        let (mut again, mut size_again) = (vec![0_u8; LEARNED_BYTES], 0);
        let saved =
            rigidtap_tap_save_learned(&raw const *restarted, again.as_mut_ptr(), size, &raw mut size_again, none);
        assert_eq!((saved, size_again), (RigidtapStatus::Ok, written));
        let mut damaged = kept.to_vec();
        damaged[100] ^= 1;
        assert_eq!(load(&mut restarted, &damaged), RigidtapStatus::RecordDamaged);
        let (mut unplanned, null): (Box<RigidtapTap>, _) = (zeroed(), std::ptr::null());
        assert_eq!(load(&mut unplanned, kept), RigidtapStatus::NotInTurn);
        assert_eq!(rigidtap_tap_load_learned(&raw mut *restarted, null, 10, none), RigidtapStatus::Null);
    }
}
