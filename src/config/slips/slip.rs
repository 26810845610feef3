//! A slip in words.

/// A value that is possible and yet improbable.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Slip {
    /// The machine file's key.
    pub key: &'static str,
    /// Element of the list at that key, from 0.
    pub index: Option<usize>,
    /// What is improbable about it.
    pub odd: String,
    /// What was probably meant, or what to look at.
    pub likely: String,
}

impl Slip {
    pub(super) fn new(key: &'static str, odd: String, likely: String) -> Self {
        Self { key, index: None, odd, likely }
    }
}
