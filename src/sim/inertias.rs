//! Inertias on springs, the first spring with backlash, discretised exactly over one plant step.

use nalgebra::{Matrix6, SMatrix};

use super::gap::Gap;
use crate::control::model::two_mass::TwoMass;

/// Two inertias with their state, in SI units.
#[derive(Clone, Debug)]
pub(crate) struct Inertias {
    gap: Gap,
    /// One step by columns, which take the three states and the two efforts; rows yield deflection, motor speed, load
    /// speed and the motor's travel. By columns the processor does several rows at once.
    step: [[f64; 4]; 5],
    /// Twist (motor less load), motor speed, load speed.
    state: [f64; 3],
    motor_position: f64,
}

impl Inertias {
    /// At rest; `viscous` is the drag of motor and load on their surroundings.
    pub(crate) fn new(model: TwoMass, gap: Gap, viscous: [f64; 2], step_s: f64, position: f64) -> Self {
        // The motor's travel is a fourth state and the two inputs are two more that do not change: one exponential
        // of the whole gives all the step's matrices (Van Loan 1978).
        let mut continuous = Matrix6::<f64>::zeros();
        for (row, values) in model.state_matrix().into_iter().enumerate() {
            for (column, value) in values.into_iter().enumerate() {
                continuous[(row, column)] = value;
            }
        }
        for (row, values) in model.input_matrix().into_iter().enumerate() {
            for (column, value) in values.into_iter().enumerate() {
                continuous[(row, 4 + column)] = value;
            }
        }
        continuous[(1, 1)] -= viscous[0] / model.motor_inertia;
        continuous[(2, 2)] -= viscous[1] / model.load_inertia;
        continuous[(3, 1)] = 1.0;
        let step = (continuous * step_s).exp();
        Self {
            gap,
            step: [0, 1, 2, 4, 5].map(|column| std::array::from_fn(|row| step[(row, column)])),
            state: [0.0; 3],
            motor_position: position,
        }
    }

    /// Moves on by one step under efforts held over it.
    #[inline]
    pub(crate) fn step(&mut self, motor_effort: f64, load_effort: f64) {
        let [deflection, motor_speed, load_speed] = self.state;
        let slack = self.gap.given_back(deflection, motor_speed, load_speed);
        self.step_with(slack, motor_effort, load_effort);
    }

    /// The same where the gap is plain.
    #[inline(always)]
    pub(crate) fn step_plain(&mut self, motor_effort: f64, load_effort: f64) {
        self.step_with(self.gap.given_back_plain(self.state[0]), motor_effort, load_effort);
    }

    /// Inside the backlash the spring has no force: what the linear model would pull is given back as an input.
    #[inline(always)]
    fn step_with(&mut self, slack: f64, motor_effort: f64, load_effort: f64) {
        self.step_tight(motor_effort + slack, load_effort - slack);
    }

    /// The same where there is no backlash.
    #[inline(always)]
    pub(crate) fn step_tight(&mut self, motor_effort: f64, load_effort: f64) {
        let [deflection, motor_speed, load_speed] = self.state;
        let [by_deflection, by_motor, by_load, by_motor_effort, by_load_effort] = &self.step;
        let mut after = [0.0; 4];
        for row in 0..4 {
            after[row] = (by_deflection[row] * deflection + by_motor[row] * motor_speed + by_load[row] * load_speed)
                + (by_motor_effort[row] * motor_effort + by_load_effort[row] * load_effort);
        }
        let [deflection, motor_speed, load_speed, travel] = after;
        self.state = [deflection, motor_speed, load_speed];
        self.motor_position += travel;
    }

    /// The efforts against motor and load that would bring each to rest by the end of a step under these others.
    #[cold]
    pub(crate) fn stopping(&self, motor_effort: f64, load_effort: f64) -> [f64; 2] {
        let mut free = self.clone();
        free.step(motor_effort, load_effort);
        [free.state[1] / self.step[3][1], free.state[2] / self.step[4][2]]
    }

    pub(crate) fn gap(&mut self) -> &mut Gap {
        &mut self.gap
    }

    #[inline(always)]
    pub(crate) fn is_plain(&self) -> bool {
        self.gap.is_plain()
    }

    pub(crate) fn motor_position(&self) -> f64 {
        self.motor_position
    }

    pub(crate) fn load_position(&self) -> f64 {
        self.motor_position - self.state[0]
    }

    pub(crate) fn motor_speed(&self) -> f64 {
        self.state[1]
    }

    pub(crate) fn load_speed(&self) -> f64 {
        self.state[2]
    }
}

/// Three inertias: the load of [`Inertias`] in two parts, the outer one on a second spring without backlash.
#[derive(Clone, Debug)]
pub(crate) struct Chain {
    gap: Gap,
    /// One step by columns, which take the five states and the three efforts; rows yield both twists, the three speeds
    /// and the motor's travel. By columns the processor does several rows at once.
    step: [[f64; 6]; 8],
    /// Motor less load, load less tip, then the speeds of motor, load and tip.
    state: [f64; 5],
    motor_position: f64,
}

/// The outer part of a chain's load and its spring.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Tip {
    pub(crate) inertia: f64,
    pub(crate) stiffness: f64,
    pub(crate) damping: f64,
}

impl Chain {
    /// At rest; `model`'s load is what is left of it without the tip.
    pub(crate) fn new(model: TwoMass, tip: Tip, gap: Gap, viscous: [f64; 2], step_s: f64, position: f64) -> Self {
        let TwoMass { motor_inertia: jm, load_inertia: jl, stiffness: k, damping: d } = model;
        let Tip { inertia: jt, stiffness: k2, damping: d2 } = tip;
        let mut a = SMatrix::<f64, 9, 9>::zeros();
        // States: deflection, tip's deflection, motor's, load's, tip's speed, motor's travel; then the three efforts.
        for (row, column, value) in [
            (0, 2, 1.0),
            (0, 3, -1.0),
            (1, 3, 1.0),
            (1, 4, -1.0),
            (2, 0, -k / jm),
            (2, 2, -(d + viscous[0]) / jm),
            (2, 3, d / jm),
            (2, 6, 1.0 / jm),
            (3, 0, k / jl),
            (3, 1, -k2 / jl),
            (3, 2, d / jl),
            (3, 3, -(d + d2 + viscous[1]) / jl),
            (3, 4, d2 / jl),
            (3, 7, 1.0 / jl),
            (4, 1, k2 / jt),
            (4, 3, d2 / jt),
            (4, 4, -d2 / jt),
            (4, 8, 1.0 / jt),
            (5, 2, 1.0),
        ] {
            a[(row, column)] = value;
        }
        let step = (a * step_s).exp();
        let columns = [0, 1, 2, 3, 4, 6, 7, 8];
        Self {
            gap,
            step: columns.map(|column| std::array::from_fn(|row| step[(row, column)])),
            state: [0.0; 5],
            motor_position: position,
        }
    }

    /// Moves on by one step under efforts held over it.
    #[inline]
    pub(crate) fn step(&mut self, motor_effort: f64, load_effort: f64, tip_effort: f64) {
        let [t1, t2, v1, v2, v3] = self.state;
        let slack = self.gap.given_back(t1, v1, v2);
        let with = [t1, t2, v1, v2, v3, motor_effort + slack, load_effort - slack, tip_effort];
        let mut halves = [[0.0; 6]; 2];
        for (pair, factors) in self.step.chunks_exact(2).zip(with.chunks_exact(2)) {
            for half in 0..2 {
                for row in 0..6 {
                    halves[half][row] += pair[half][row] * factors[half];
                }
            }
        }
        let after: [f64; 6] = std::array::from_fn(|row| halves[0][row] + halves[1][row]);
        let [t1, t2, v1, v2, v3, travel] = after;
        self.state = [t1, t2, v1, v2, v3];
        self.motor_position += travel;
    }

    /// See [`Inertias::stopping`].
    #[cold]
    pub(crate) fn stopping(&self, motor_effort: f64, load_effort: f64, tip_effort: f64) -> [f64; 2] {
        let mut free = self.clone();
        free.step(motor_effort, load_effort, tip_effort);
        [free.state[2] / self.step[5][2], free.state[3] / self.step[6][3]]
    }

    pub(crate) fn gap(&mut self) -> &mut Gap {
        &mut self.gap
    }

    pub(crate) fn motor_position(&self) -> f64 {
        self.motor_position
    }

    pub(crate) fn load_position(&self) -> f64 {
        self.motor_position - self.state[0]
    }

    pub(crate) fn tip_position(&self) -> f64 {
        self.motor_position - self.state[0] - self.state[1]
    }

    pub(crate) fn motor_speed(&self) -> f64 {
        self.state[2]
    }

    pub(crate) fn load_speed(&self) -> f64 {
        self.state[3]
    }
}
