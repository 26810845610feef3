//! Every dialect by its name.

use super::definition::Dialect;

/// Dialects that are known and not read, with the reason.
const OUT_OF_SCOPE: &[(&str, &str)] = &[(
    "heidenhain",
    "heidenhain is out of scope: its conversational programs are no G-code; post-process for an ISO control",
)];

impl Dialect {
    /// Every dialect.
    pub const ALL: &[Self] =
        &[Self::PAPER, Self::FANUC, Self::LINUXCNC, Self::HAAS, Self::SIEMENS, Self::BROTHER, Self::MITSUBISHI];

    /// The dialect of this name.
    #[must_use]
    pub fn by_name(name: &str) -> Option<Self> {
        Self::ALL.iter().find(|dialect| dialect.name == name).copied()
    }

    /// Why a control that people ask for is not among [`Dialect::ALL`].
    ///
    /// ```
    /// use rigidtap::gcode::Dialect;
    /// assert!(Dialect::out_of_scope("heidenhain").unwrap().contains("out of scope"));
    /// ```
    #[must_use]
    pub fn out_of_scope(name: &str) -> Option<&'static str> {
        OUT_OF_SCOPE.iter().find(|(known, _)| *known == name).map(|(_, reason)| *reason)
    }
}

impl Default for Dialect {
    fn default() -> Self {
        Self::PAPER
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn g_codes_are_in_rising_order() {
        for dialect in Dialect::ALL {
            for codes in [dialect.g_codes, dialect.more_g_codes] {
                assert!(codes.is_sorted_by(|a, b| a.0 < b.0), "{}", dialect.name);
            }
        }
    }
}
