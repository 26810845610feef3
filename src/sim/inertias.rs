//! Two inertias on a spring with backlash, discretised exactly over one plant step.

use nalgebra::Matrix6;

use crate::control::model::two_mass::TwoMass;

/// The pair with its state, in SI units.
#[derive(Clone, Debug)]
pub(crate) struct Inertias {
    model: TwoMass,
    /// Half the play between the two.
    half_backlash: f64,
    /// One step: rows yield twist, motor speed, load speed and the motor's travel; columns take the three states and the
    /// two efforts.
    step: [[f64; 5]; 4],
    /// Twist (motor less load), motor speed, load speed.
    state: [f64; 3],
    motor_position: f64,
}

impl Inertias {
    pub(crate) fn new(model: TwoMass, backlash: f64, step_s: f64, position: f64) -> Self {
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
        continuous[(3, 1)] = 1.0;
        let step = (continuous * step_s).exp();
        Self {
            model,
            half_backlash: backlash / 2.0,
            step: std::array::from_fn(|row| [0, 1, 2, 4, 5].map(|column| step[(row, column)])),
            state: [0.0; 3],
            motor_position: position,
        }
    }

    /// Moves on by one step under efforts held over it.
    pub(crate) fn step(&mut self, motor_effort: f64, load_effort: f64) {
        // Inside the play the spring has no force: what the linear model would pull is given back as an input.
        let [twist, motor_speed, load_speed] = self.state;
        let slack = self.model.stiffness * twist.max(-self.half_backlash).min(self.half_backlash);
        let (motor_effort, load_effort) = (motor_effort + slack, load_effort - slack);
        let after = |[by_twist, by_motor, by_load, by_motor_effort, by_load_effort]: [f64; 5]| {
            (by_twist * twist + by_motor * motor_speed + by_load * load_speed)
                + (by_motor_effort * motor_effort + by_load_effort * load_effort)
        };
        let [twist, motor_speed, load_speed, travel] = self.step.map(after);
        self.state = [twist, motor_speed, load_speed];
        self.motor_position += travel;
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
