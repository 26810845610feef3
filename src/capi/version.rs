//! Version of the interface.

/// `RIGIDTAP_API_VERSION` of the header.
pub const API_VERSION: u32 = 3;
