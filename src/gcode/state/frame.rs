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
}

impl Frame {
    pub(crate) const fn new(machine_mm: [f64; 3]) -> Self {
        Self { zeros_mm: [[0.0; 3]; OFFSETS], machine_mm, shift_mm: [0.0; 3] }
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
