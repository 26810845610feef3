//! Two inertias on a spring with backlash, discretised exactly over one plant step.

use nalgebra::{Matrix3, Matrix6, SMatrix, Vector2, Vector3};

use crate::control::model::two_mass::TwoMass;

/// The pair with its state, in SI units.
#[derive(Clone, Debug)]
pub(crate) struct Inertias {
    model: TwoMass,
    /// Half the play between the two.
    half_backlash: f64,
    state_step: Matrix3<f64>,
    input_step: SMatrix<f64, 3, 2>,
    travel_by_state: Vector3<f64>,
    travel_by_input: Vector2<f64>,
    /// Twist (motor less load), motor speed, load speed.
    state: Vector3<f64>,
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
            state_step: step.fixed_view::<3, 3>(0, 0).into_owned(),
            input_step: step.fixed_view::<3, 2>(0, 4).into_owned(),
            travel_by_state: step.fixed_view::<1, 3>(3, 0).transpose(),
            travel_by_input: step.fixed_view::<1, 2>(3, 4).transpose(),
            state: Vector3::zeros(),
            motor_position: position,
        }
    }

    /// Moves on by one step under efforts held over it.
    pub(crate) fn step(&mut self, motor_effort: f64, load_effort: f64) {
        // Inside the play the spring has no force: what the linear model would pull is given back as an input.
        let slack = self.model.stiffness * self.state[0].clamp(-self.half_backlash, self.half_backlash);
        let input = Vector2::new(motor_effort + slack, load_effort - slack);
        self.motor_position += self.travel_by_state.dot(&self.state) + self.travel_by_input.dot(&input);
        self.state = self.state_step * self.state + self.input_step * input;
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
