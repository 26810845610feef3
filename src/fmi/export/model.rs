//! What every model of ours can.

/// A model that is stepped.
pub(super) trait Model {
    /// Sets a variable by its number; whether there is such a one.
    fn set(&mut self, number: u32, value: f64) -> bool;
    /// A variable's value.
    fn get(&self, number: u32) -> Option<f64>;
    /// At rest, once parameters and first inputs are set.
    fn begin(&mut self) -> Result<(), String>;
    /// One step from the inputs that are set to the outputs.
    fn step(&mut self, step_s: f64) -> Result<(), String>;
}

/// A model of fixed period takes that step and no other.
pub(super) fn check_step(step_s: f64, period_s: f64) -> Result<(), String> {
    if (step_s - period_s).abs() <= 1e-9 * period_s {
        Ok(())
    } else {
        Err(format!("a step of {step_s} s, expected the machine's period of {period_s} s"))
    }
}
