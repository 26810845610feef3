//! What a tapping block asks for, and whether it can be done.

use crate::control::cycle::{CycleError, CyclePlan, Positioning, TapCycle};
use crate::control::machine::{Law, Machine};

/// What a block asks for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BlockRequest {
    /// The first hole.
    pub hole: TapCycle,
    /// Where X, Y and Z stand at rest.
    pub start_mm: [f64; 3],
    /// Holes in all; each further one lies `step_mm` from the one before.
    pub holes: u32,
    /// X and Y from hole to hole.
    pub step_mm: [f64; 2],
}

impl BlockRequest {
    /// Over a hole at a height.
    pub(super) fn over_mm(&self, hole: u32, z_mm: f64) -> [f64; 3] {
        let Self { hole: first, step_mm: [x_mm, y_mm], .. } = self;
        let count = f64::from(hole);
        [first.x_mm + count * x_mm, first.y_mm + count * y_mm, z_mm]
    }
}

/// The plan of a block's holes, where every move between them is feasible, too.
pub(super) fn feasible(request: &BlockRequest, machine: &Machine, law: Law) -> Result<CyclePlan, CycleError> {
    if request.holes == 0 {
        return Err(CycleError::Invalid { value: 0.0 });
    }
    let plan = CyclePlan::new(request.hole, machine, law)?;
    // All moves there are: to the first hole, down, up, and to the next, which are all alike.
    let TapCycle { r_plane_mm, return_mm, .. } = request.hole;
    let [_, _, start_z_mm] = request.start_mm;
    let [first, second] = [request.over_mm(0, start_z_mm), request.over_mm(1, return_mm)];
    let [r_mm, up_mm] = [request.over_mm(0, r_plane_mm), request.over_mm(0, return_mm)];
    for (from_mm, to_mm) in [(request.start_mm, first), (first, r_mm), (r_mm, up_mm), (up_mm, second)] {
        Positioning::plan(machine, from_mm, to_mm, |top| top).map_err(CycleError::Law)?;
    }
    Ok(plan)
}
