//! Work offsets and the machine's zero.
//!
//! Positions of commands count from the zero that every work offset has until the program writes one. The machine's
//! zero, which is its reference point too, is where it stood at the start.

/// How many work offsets there are: G54 to G59.3, and 99 numbered ones (G54.1 P, G154 P).
pub(crate) const OFFSETS: usize = 108;

/// Zeros of the work offsets.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Frame {
    pub(crate) zeros_mm: [[f64; 3]; OFFSETS],
    pub(crate) machine_mm: [f64; 3],
    /// Of all offsets (G52, G92).
    pub(crate) shift_mm: [f64; 3],
    /// G68.
    pub(crate) rotation: Option<Rotation>,
    /// G68 or G69 stands before, and no position of X and Y since: what one axis, or a distance, counts from is open.
    pub(crate) turned_anew: bool,
}

/// A turn of X and Y about a centre (G68).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Rotation {
    /// Where the centre lies, as commands count.
    pub(crate) centre_mm: [f64; 2],
    pub(crate) sin: f64,
    pub(crate) cos: f64,
}

impl Rotation {
    /// Where a programmed position comes to lie.
    pub(crate) fn turned([x_mm, y_mm]: [f64; 2], rotation: Option<Self>) -> [f64; 2] {
        let Some(Self { centre_mm: [cx_mm, cy_mm], sin, cos }) = rotation else { return [x_mm, y_mm] };
        let (dx_mm, dy_mm) = (x_mm - cx_mm, y_mm - cy_mm);
        [cx_mm + cos * dx_mm - sin * dy_mm, cy_mm + sin * dx_mm + cos * dy_mm]
    }

    /// The way back.
    pub(crate) fn turned_back(position_mm: [f64; 2], rotation: Option<Self>) -> [f64; 2] {
        Self::turned(position_mm, rotation.map(|rotation| Self { sin: -rotation.sin, ..rotation }))
    }
}

impl Frame {
    pub(crate) const fn new(machine_mm: [f64; 3]) -> Self {
        Self { zeros_mm: [[0.0; 3]; OFFSETS], machine_mm, shift_mm: [0.0; 3], rotation: None, turned_anew: false }
    }

    pub(crate) fn zeros(&self, offset: u8) -> [f64; 3] {
        self.zeros_mm.get(usize::from(offset).wrapping_sub(1)).copied().unwrap_or_default()
    }

    pub(crate) fn zero_mm(&self, offset: u8, axis: usize) -> f64 {
        self.zeros(offset).get(axis).copied().unwrap_or_default()
    }

    pub(crate) fn same(&self, one: u8, other: u8) -> bool {
        self.zeros(one) == self.zeros(other)
    }

    pub(crate) fn machine_mm(&self, axis: usize) -> f64 {
        self.machine_mm.get(axis).copied().unwrap_or_default()
    }
}
