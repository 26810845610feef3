//! What Z's motor has to do beyond its share of the acceleration: friction, lost motion, the screw's stretch.

use crate::control::machine::{Machine, SyncSpec};
use crate::control::math::poly::State;
use crate::control::model::friction::Stribeck;
use crate::control::model::two_mass::TwoMass;
use crate::control::units::{mm_from_m, mm_from_um};

use super::identify::Identified;

/// A force at rest beyond this ratio of the greatest friction known is something else.
const HELD_RATIO: f64 = 2.5;

/// Z's mechanics as the machine file says, in mm and N.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ZModel {
    pub(super) mass_kg: f64,
    motor_share: f64,
    /// Stretch of the screw per acceleration of the table: m₂/k.
    stretch_s2: f64,
    /// Of a friction of 1.
    contact: Stribeck,
}

impl ZModel {
    pub(super) fn new(machine: &Machine) -> Self {
        let spec = &machine.spec().z_axis;
        let screw = TwoMass::of_z(spec);
        Self {
            mass_kg: spec.mass_kg,
            motor_share: 1.0 - spec.table_share,
            stretch_s2: screw.load_inertia / screw.stiffness,
            contact: Stribeck {
                coulomb: 1.0,
                static_ratio: spec.static_ratio,
                stribeck_speed: spec.stribeck_mm_per_s,
                presliding: mm_from_um(spec.presliding_um),
            },
        }
    }

    /// Motor less table at constant speed, one direction less the other: backlash and the friction's twist.
    pub(super) fn nominal_lost_motion_mm(machine: &Machine) -> f64 {
        let spec = &machine.spec().z_axis;
        let table_n = spec.coulomb_n * spec.friction_table_share;
        mm_from_um(spec.backlash_um) + mm_from_m(2.0 * table_n / TwoMass::of_z(spec).stiffness)
    }

    /// Backlash's share of that.
    fn play_share(machine: &Machine) -> f64 {
        let lost_mm = Self::nominal_lost_motion_mm(machine);
        if lost_mm > 0.0 { mm_from_um(machine.spec().z_axis.backlash_um) / lost_mm } else { 0.0 }
    }

    /// Stretch of the screw in mm under an acceleration of the table.
    pub(super) fn stretch_mm(&self, acceleration_mm_per_s2: f64) -> f64 {
        self.stretch_s2 * acceleration_mm_per_s2
    }
}

/// A step that starts and ends with neither speed nor acceleration: 6u⁵ − 15u⁴ + 10u³.
#[derive(Clone, Copy, Debug, PartialEq)]
struct SoftStep {
    from: f64,
    to: f64,
    start_s: f64,
    duration_s: f64,
}

impl SoftStep {
    fn at(&self, t_s: f64) -> State {
        let u = ((t_s - self.start_s) / self.duration_s).clamp(0.0, 1.0);
        let rest = 1.0 - u;
        let rate = (self.to - self.from) / self.duration_s;
        State {
            position: self.from + (self.to - self.from) * u * u * u * (10.0 - 15.0 * u + 6.0 * u * u),
            velocity: rate * 30.0 * u * u * rest * rest,
            acceleration: rate / self.duration_s * 60.0 * u * rest * (1.0 - 2.0 * u),
            jerk: 0.0,
        }
    }
}

/// What the motor's command needs beyond the table's motion, positive into the hole.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct ZExtra {
    /// Motor's speed beyond the table's.
    pub(super) motor_velocity_mm_per_s: f64,
    /// Acceleration of the whole mass that the motor's own extra acceleration is worth.
    pub(super) acceleration_mm_per_s2: f64,
    /// Friction to overcome, beyond what holds Z at the hole's start.
    pub(super) friction_n: f64,
}

/// Friction and lost motion along a hole, with where they stand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ZFeedforward {
    pub(super) model: ZModel,
    sync: SyncSpec,
    period_s: f64,
    friction_n: f64,
    lost_motion_mm: f64,
    /// Backlash's share of the lost motion, by the file.
    play_share: f64,
    /// Pre-sliding state, −1…1.
    contact_state: f64,
    /// Friction at the hole's start: the drive's integral holds it already.
    held_n: f64,
    /// Direction that Z last moved in, 1 into the hole.
    direction: f64,
    /// Side of the play that the motor pushes on, −1…1.
    side: SoftStep,
}

impl ZFeedforward {
    pub(super) fn new(machine: &Machine) -> Self {
        let sync = machine.spec().sync;
        let model = ZModel::new(machine);
        Self {
            model,
            sync,
            period_s: machine.spec().control.period_s,
            friction_n: machine.spec().z_axis.coulomb_n,
            lost_motion_mm: ZModel::nominal_lost_motion_mm(machine),
            play_share: ZModel::play_share(machine),
            contact_state: 0.0,
            held_n: 0.0,
            direction: 0.0,
            side: SoftStep { from: 0.0, to: 0.0, start_s: 0.0, duration_s: sync.lost_motion_s },
        }
    }

    /// A hole begins: Z rests, and its drive's integral holds what friction is left. All into the hole; `side` is where
    /// in the lost motion the motor stands, −1…1, where that is known.
    pub(super) fn begin(&mut self, identified: &Identified, held_n: f64, side: Option<f64>) {
        self.friction_n = identified.z_friction_n;
        self.lost_motion_mm = identified.z_lost_motion_mm;
        let greatest_n = self.friction_n * self.model.contact.level(0.0);
        self.contact_state = if greatest_n > 0.0 { (held_n / greatest_n).clamp(-1.0, 1.0) } else { 0.0 };
        // All of it is handed over, more than the greatest friction known too: here it is greater, then.
        self.held_n = held_n.max(-HELD_RATIO * greatest_n).min(HELD_RATIO * greatest_n);
        // Not shown yet: the play lies wholly on one side, the friction's twist is as great as what is held.
        let play = if self.contact_state == 0.0 { 0.0 } else { 1f64.copysign(self.contact_state) };
        let guess = self.play_share * play + (1.0 - self.play_share) * self.contact_state;
        let side = side.unwrap_or(guess).clamp(-1.0, 1.0);
        self.direction = 1f64.copysign(side);
        self.side = SoftStep { from: side, to: side, start_s: 0.0, ..self.side };
    }

    /// Whether Z's motor stands on the side of the lost motion that pushes into the hole.
    pub(super) fn pushes_inwards(&self) -> bool {
        self.direction > 0.0
    }

    fn friction(&self, velocity: f64) -> f64 {
        self.friction_n * self.model.contact.level(velocity) * self.contact_state
    }

    /// One period of a hole, at an instant of its plan. `ahead` is Z's state when a force commanded now will act, `soon`
    /// the velocity that decides on which side the motor has to push, `seen` the table's state as old as the velocity
    /// that the loop will see.
    pub(super) fn step(&mut self, now_s: f64, lags: ZLags, ahead: &State, soon: f64, seen: &State) -> ZExtra {
        self.contact_state = self.model.contact.preslide(self.contact_state, ahead.velocity, self.period_s);
        if soon != 0.0 && (soon * self.direction <= 0.0 || (self.side.to - self.direction).abs() > 1e-3) {
            self.direction = 1f64.copysign(soon);
            let from = self.side.at(now_s).position;
            self.side = SoftStep { from, to: self.direction, start_s: now_s, ..self.side };
        }
        let half_mm = self.lost_motion_mm / 2.0;
        let late = self.side.at(now_s - lags.velocity_s);
        let early = self.side.at(now_s + lags.force_s);
        ZExtra {
            motor_velocity_mm_per_s: half_mm * late.velocity + self.model.stretch_s2 * seen.jerk,
            acceleration_mm_per_s2: half_mm * early.acceleration * self.model.motor_share,
            friction_n: self.friction(ahead.velocity) - self.held_n,
        }
    }
}

/// How late Z's loops see and act.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ZLags {
    /// From a commanded force to the force.
    pub(super) force_s: f64,
    /// From a speed to its reading in the velocity loop.
    pub(super) velocity_s: f64,
}
