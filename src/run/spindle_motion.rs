//! The spindle between holes: run-up, constant speed, run-down.

use crate::control::machine::Machine;
use crate::control::math::poly::State;
use crate::control::profile::Profile;
use crate::control::units::rev_per_s_from_rpm;
use crate::gcode::SpindleCommand;

/// A change of speed under way.
#[derive(Clone, Debug)]
struct Change {
    profile: Profile,
    since_s: f64,
    from_rev: f64,
    sign: f64,
}

/// The spindle's command between holes: changes of speed one after the other, then constant speed.
#[derive(Clone, Debug)]
pub(crate) struct SpindleMotion {
    changes: std::collections::VecDeque<Change>,
    /// After the last change: when, where and how fast.
    final_s: f64,
    final_rev: f64,
    final_rev_per_s: f64,
}

impl SpindleMotion {
    pub(crate) fn at_rest(rev: f64) -> Self {
        Self { changes: Default::default(), final_s: 0.0, final_rev: rev, final_rev_per_s: 0.0 }
    }

    /// Changes to a new speed, through rest where the direction turns. Both ends of each change are checked speeds.
    pub(crate) fn command(&mut self, now_s: f64, command: SpindleCommand, machine: &Machine) {
        let state = self.at(now_s);
        let target = match command {
            SpindleCommand::Off => 0.0,
            SpindleCommand::On { hand, speed_rpm } => hand.sign() * rev_per_s_from_rpm(speed_rpm),
        };
        self.changes.clear();
        (self.final_s, self.final_rev, self.final_rev_per_s) = (now_s, state.position, state.velocity);
        if state.velocity * target < 0.0 {
            self.append(0.0, machine);
        }
        self.append(target, machine);
    }

    fn append(&mut self, target: f64, machine: &Machine) {
        let from = self.final_rev_per_s;
        let sign = if from == 0.0 { 1f64.copysign(target) } else { 1f64.copysign(from) };
        // Speeds above the law's bands stay where they are: the machine's check warned of such bands.
        let Ok(profile) = machine.torque_curve().change_speed(from.abs(), target.abs()) else { return };
        let change = Change { since_s: self.final_s, from_rev: self.final_rev, sign, profile };
        self.final_s += change.profile.duration_s();
        self.final_rev += sign * change.profile.distance();
        self.final_rev_per_s = sign * change.profile.end().velocity;
        self.changes.push_back(change);
    }

    /// When the commanded speed is reached.
    pub(crate) fn settled_s(&self) -> f64 {
        self.final_s
    }

    /// True once the commanded speed is reached.
    pub(crate) fn at_speed(&self, now_s: f64) -> bool {
        now_s >= self.final_s
    }

    pub(crate) fn at(&self, now_s: f64) -> State {
        let under_way = self.changes.iter().find(|change| now_s < change.since_s + change.profile.duration_s());
        match under_way {
            Some(change) => {
                let state = change.profile.at(now_s - change.since_s);
                state.scaled(change.sign).shifted(change.from_rev)
            }
            None => State {
                position: self.final_rev + self.final_rev_per_s * (now_s - self.final_s),
                velocity: self.final_rev_per_s,
                ..State::default()
            },
        }
    }
}
