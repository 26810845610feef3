//! A host whose drives speak CiA 402: integers that wrap at 32 bits, torque in thousandths of the motor's rated torque.
//!
//! What stands in `Host` is what a kernel over EtherCAT writes; `Drive` is the other end of the wire, before the simulated
//! machine. Objects as the guide's page on embedding has them.

use rigidtap::capi::{
    RigidtapFeedback, RigidtapHole, RigidtapMachine, RigidtapMachineData, RigidtapSetpoint, RigidtapState,
    RigidtapStatus, RigidtapTap, reports, rigidtap_machine_init, rigidtap_machine_reference, rigidtap_tap_plan,
    rigidtap_tap_start, rigidtap_tap_step, status,
};
use rigidtap::control::cycle::TapCycle;
use rigidtap::control::machine::Machine;
use rigidtap::control::math::poly::State;
use rigidtap::control::port::{AxisStatus, DriveState, Port, Setpoint};
use rigidtap::sim::{Plant, PlantOptions};

use super::full::{DONE, FULL, SYNCHRONOUS};
use super::zeroed;

/// State of the statusword 0x6041, bits 0 to 3, 5 and 6: operation enabled.
const STATE_MASK: u16 = 0x006F;
const OPERATION_ENABLED: u16 = 0x0027;
/// Its bit 11.
const INTERNAL_LIMIT_ACTIVE: u16 = 0x0800;
/// Velocity unit of 0x60B1 as a drive has it by default: 0.0001 rpm of the motor.
const VELOCITY_UNITS_PER_RPM: f64 = 10_000.0;

/// What the host sends each period.
#[derive(Clone, Copy, Debug, Default)]
struct Outputs {
    /// 0x607A.
    target_position: i32,
    /// 0x60B1.
    velocity_offset: i32,
    /// 0x60B2, thousandths of 0x6076.
    torque_offset: i16,
}

/// What it reads.
#[derive(Clone, Copy, Debug)]
struct Inputs {
    /// 0x6064.
    position: i32,
    /// 0x6077, thousandths of 0x6076.
    torque: i16,
    /// 0x6041.
    statusword: u16,
}

/// One axis as it is scaled: a unit is a revolution of the spindle or a millimetre of Z.
#[derive(Clone, Copy, Debug)]
struct Scaling {
    increments_per_unit: f64,
    motor_rev_per_unit: f64,
    /// 0x6076, mN·m.
    rated_torque_mnm: u32,
    /// Motor torque of one N·m of the spindle or one N of Z.
    nm_per_effort: f64,
    /// Effort that accelerates by one unit/s².
    effort_per_acceleration: f64,
}

impl Scaling {
    fn thousandths_per_effort(&self) -> f64 {
        self.nm_per_effort * 1000.0 / (f64::from(self.rated_torque_mnm) / 1000.0)
    }
}

/// The host's side of an axis.
struct Host {
    scaling: Scaling,
    last_raw: i32,
    /// Unwrapped.
    increments: i64,
}

impl Host {
    fn new(scaling: Scaling, raw: i32) -> Self {
        Self { scaling, last_raw: raw, increments: i64::from(raw) }
    }

    fn read(&mut self, inputs: &Inputs) -> i64 {
        self.increments += i64::from(inputs.position.wrapping_sub(self.last_raw));
        self.last_raw = inputs.position;
        self.increments
    }

    /// The acceleration goes with the torque: CiA 402 has no offset for it.
    fn write(&self, state: RigidtapState, effort: f64) -> Outputs {
        let scaling = &self.scaling;
        let effort = effort + scaling.effort_per_acceleration * state.acceleration;
        let rpm = state.velocity * scaling.motor_rev_per_unit * 60.0;
        Outputs {
            // Truncation to the low 32 bits is the wrap.
            target_position: (state.position * scaling.increments_per_unit).round() as i64 as i32,
            velocity_offset: (rpm * VELOCITY_UNITS_PER_RPM).round() as i32,
            torque_offset: (effort * scaling.thousandths_per_effort()).round() as i16,
        }
    }
}

/// The drive's side.
struct Drive {
    scaling: Scaling,
    last_target: i32,
    target: i64,
    /// Increments at the machine's zero.
    offset: i64,
}

impl Drive {
    fn new(scaling: Scaling, offset: i64, rest: f64) -> Self {
        let target = offset + (rest * scaling.increments_per_unit).round() as i64;
        Self { scaling, last_target: target as i32, target, offset }
    }

    fn inputs(&self, increments: i64, effort: Option<f64>, axis: AxisStatus) -> Inputs {
        let ready = if axis.drive == Some(DriveState::Ready) { OPERATION_ENABLED } else { 0 };
        let limit = if axis.saturated == Some(true) { INTERNAL_LIMIT_ACTIVE } else { 0 };
        Inputs {
            position: (increments + self.offset) as i32,
            torque: (effort.expect("reported") * self.scaling.thousandths_per_effort()).round() as i16,
            statusword: ready | limit,
        }
    }

    fn command(&mut self, outputs: &Outputs) -> (State, f64) {
        self.target += i64::from(outputs.target_position.wrapping_sub(self.last_target));
        self.last_target = outputs.target_position;
        let scaling = &self.scaling;
        let rpm = f64::from(outputs.velocity_offset) / VELOCITY_UNITS_PER_RPM;
        let state = State {
            position: (self.target - self.offset) as f64 / scaling.increments_per_unit,
            velocity: rpm / 60.0 / scaling.motor_rev_per_unit,
            ..State::default()
        };
        (state, f64::from(outputs.torque_offset) / scaling.thousandths_per_effort())
    }
}

/// A direct-drive spindle of 2^20 increments a turn, whose motor is rated a third of its greatest torque.
fn spindle(machine: &Machine) -> Scaling {
    Scaling {
        increments_per_unit: 1_048_576.0,
        motor_rev_per_unit: 1.0,
        rated_torque_mnm: 6_700,
        nm_per_effort: 1.0,
        effort_per_acceleration: machine.spec().spindle.inertia_kg_m2 * std::f64::consts::TAU,
    }
}

/// Z on a screw of 16 mm, its scale's 0.1 µm the drive's position unit.
fn z(machine: &Machine) -> Scaling {
    const LEAD_MM: f64 = 16.0;
    Scaling {
        increments_per_unit: 10_000.0,
        motor_rev_per_unit: 1.0 / LEAD_MM,
        rated_torque_mnm: 7_500,
        nm_per_effort: LEAD_MM / 1000.0 / std::f64::consts::TAU,
        effort_per_acceleration: machine.spec().z_axis.mass_kg / 1000.0,
    }
}

/// What the control is told of both drives' integers.
fn feedback(hosts: &mut [Host; 2], inputs: [Inputs; 2]) -> RigidtapFeedback {
    let [spindle, z] = hosts;
    let [of_spindle, of_z] = &inputs;
    let effort = |host: &Host, inputs: &Inputs| f64::from(inputs.torque) / host.scaling.thousandths_per_effort();
    let bit = |is_on: bool, bit: u32| if is_on { bit } else { 0 };
    let ready = |inputs: &Inputs| inputs.statusword & STATE_MASK == OPERATION_ENABLED;
    let limited = |inputs: &Inputs| inputs.statusword & INTERNAL_LIMIT_ACTIVE != 0;
    RigidtapFeedback {
        spindle_counts: spindle.read(of_spindle),
        z_counts: z.read(of_z),
        z_motor_counts: 0,
        spindle_torque_nm: effort(spindle, of_spindle),
        z_force_n: effort(z, of_z),
        reported: reports::SPINDLE_TORQUE
            | reports::Z_FORCE
            | reports::SPINDLE_SATURATED
            | reports::Z_SATURATED
            | reports::SPINDLE_DRIVE
            | reports::Z_DRIVE,
        status: bit(!ready(of_spindle), status::SPINDLE_NOT_READY)
            | bit(!ready(of_z), status::Z_NOT_READY)
            | bit(limited(of_spindle), status::SPINDLE_SATURATED)
            | bit(limited(of_z), status::Z_SATURATED),
    }
}

fn machine() -> (Box<RigidtapMachine>, Machine) {
    let (mut machine, mut data): (Box<RigidtapMachine>, Box<RigidtapMachineData>) = (zeroed(), zeroed());
    let none = std::ptr::null_mut();
    // SAFETY: every pointer is of a live value of its own.
    unsafe {
        assert_eq!(rigidtap_machine_reference(&raw mut *data), RigidtapStatus::Ok);
        // The drive's increments are the encoder's counts.
        data.spindle_counts_per_rev = 1_048_576.0;
        assert_eq!(rigidtap_machine_init(&raw mut *machine, &raw const *data, none), RigidtapStatus::Ok);
    }
    (machine, Machine::reference())
}

/// Both counters wrap in the hole: the spindle's at its start, Z's half way down.
#[test]
fn integers_that_wrap_and_torque_in_thousandths_hold_the_thread() {
    const DEPTH_MM: f64 = 25.0;
    let (machine, reference) = machine();
    let mut tap: Box<RigidtapTap> = zeroed();
    let mut hole: Box<RigidtapHole> = zeroed();
    let scaling = [spindle(&reference), z(&reference)];
    // Where the drives' counters stand with spindle and Z at zero: just below the top, and half a hole above the bottom.
    let offsets = [i64::from(i32::MAX) - 1000, i64::from(i32::MIN) + 125_000];
    let [spindle_zero, z_zero] = [0, 1].map(|n| offsets[n] as f64 / scaling[n].increments_per_unit);
    let mut drives = [0, 1].map(|n| Drive::new(scaling[n], offsets[n], 0.0));
    let mut hosts = [0, 1].map(|n| Host::new(scaling[n], offsets[n] as i32));
    let mut plant = Plant::new(&reference, &PlantOptions::default());
    (hole.r_plane_mm, hole.bottom_mm, hole.return_mm) = (z_zero, z_zero - DEPTH_MM, z_zero);
    (hole.pitch_mm, hole.speed_rpm, hole.compensation) = (1.0, 7000.0, FULL);
    (hole.identify, hole.learn) = (1, 1);
    let (none, mut setpoint, mut period) = (std::ptr::null_mut(), RigidtapSetpoint::default(), 0);
    let mut wraps = [0; 2];
    setpoint.spindle.position = spindle_zero;
    for number in 0..4 {
        // SAFETY: every pointer is of a live value of its own.
        unsafe {
            let planned = rigidtap_tap_plan(&raw mut *tap, &raw const *machine, &raw const *hole, none);
            assert_eq!(planned, RigidtapStatus::Ok);
            let rest = (setpoint.spindle.position * scaling[0].increments_per_unit).round() as i64;
            let started = rigidtap_tap_start(&raw mut *tap, f64::from(period) * 0.001, rest, 0.0, none);
            assert_eq!(started, RigidtapStatus::Ok);
        }
        plant.begin_hole(&TapCycle::right_hand(0.0, -DEPTH_MM, 1.0, 7000.0));
        let (mut zero, mut band_um, mut deepest_mm) = (None, (0.0_f64, 0.0_f64), 0.0_f64);
        loop {
            let now_s = f64::from(period) * 0.001;
            let read = plant.read(now_s);
            let counts = [read.spindle_counts * 64, read.z_counts];
            let efforts = [(read.spindle_torque_nm, read.spindle), (read.z_force_n, read.z)];
            let inputs = [0, 1].map(|n| drives[n].inputs(counts[n], efforts[n].0, efforts[n].1));
            let before = hosts.each_ref().map(|host| host.last_raw);
            let given = feedback(&mut hosts, inputs);
            for n in 0..2 {
                wraps[n] +=
                    u32::from((before[n] < 0) != (inputs[n].position < 0) && before[n].unsigned_abs() > 1 << 30);
            }
            // SAFETY: likewise.
            let stepped = unsafe { rigidtap_tap_step(&raw mut *tap, now_s, &raw const given, &raw mut setpoint, none) };
            assert_eq!((stepped, setpoint.alarm.code), (RigidtapStatus::Ok, 0), "hole {number}, period {period}");
            if setpoint.stage == DONE {
                break;
            }
            let truth = plant.truth().expect("simulated");
            if setpoint.stage == SYNCHRONOUS {
                let (spindle_rev, z_mm) = *zero.get_or_insert((truth.spindle_rev, truth.z_mm));
                let error_um = 1000.0 * ((z_mm - truth.z_mm) - (truth.spindle_rev - spindle_rev));
                band_um = (band_um.0.min(error_um), band_um.1.max(error_um));
                deepest_mm = deepest_mm.min(truth.z_mm);
            }
            let (spindle, spindle_nm) =
                drives[0].command(&hosts[0].write(setpoint.spindle, setpoint.spindle_torque_nm));
            let (z, force_n) = drives[1].command(&hosts[1].write(setpoint.z, setpoint.z_force_n));
            plant.write(
                now_s,
                &Setpoint { spindle, z, spindle_torque_nm: spindle_nm, z_force_n: force_n, ..Setpoint::default() },
            );
            period += 1;
            assert!(period < 40_000, "hole {number} does not end");
        }
        let (width_um, too_deep_um) = (band_um.1 - band_um.0, 1000.0 * (-DEPTH_MM - deepest_mm));
        assert!(width_um <= 5.0 && too_deep_um <= 2.0, "hole {number}: {width_um} µm, {too_deep_um} µm too deep");
    }
    assert!(wraps[0] >= 4 && wraps[1] >= 8, "{wraps:?}");
}
