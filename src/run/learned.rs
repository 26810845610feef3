//! What holes taught, as a host keeps it over a restart.

use crate::control::machine::Machine;
use crate::control::port::Port;
use crate::control::sync::{Adaptation, LEARNED_BYTES, LearnedError};

use super::executor::Executor;

/// What holes taught, as bytes that are known to be of this machine; none at first.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Learned {
    bytes: Vec<u8>,
}

impl Learned {
    /// Takes bytes as they were kept.
    ///
    /// # Errors
    /// [`LearnedError`]: they are something else, damaged, or of another machine.
    ///
    /// ```
    /// use rigidtap::control::{machine::Machine, sync::LearnedError};
    /// use rigidtap::run::Learned;
    /// assert_eq!(Learned::of(b"{}".to_vec(), &Machine::reference()), Err(LearnedError::NoRecord));
    /// ```
    pub fn of(bytes: Vec<u8>, machine: &Machine) -> Result<Self, LearnedError> {
        Adaptation::new(machine).load_learned(&bytes)?;
        Ok(Self { bytes })
    }

    /// The bytes to be kept; none where no hole was tapped.
    #[must_use]
    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }
}

impl<P: Port> Executor<'_, P> {
    /// The machine begins with what is known.
    pub fn teach(&mut self, learned: &Learned) {
        if !learned.bytes.is_empty() {
            // Of this machine, as was checked, and no hole is under way.
            let _ = self.tapping.load_learned(&learned.bytes);
        }
    }

    /// What the machine knows now. A hole that a fault ended has taught nothing; its axes are given up.
    pub fn learned(&mut self) -> Learned {
        self.tapping.release();
        let mut bytes = vec![0; LEARNED_BYTES];
        // There is room, and no hole is under way.
        let size = self.tapping.save_learned(&mut bytes).unwrap_or(0);
        bytes.truncate(size);
        Learned { bytes }
    }
}
