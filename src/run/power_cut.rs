//! When the power is lost, and of what: an order to a run.

use std::str::FromStr;

/// What loses its power.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lost {
    /// The mains: drives and host live on the DC link until both axes stand.
    Mains,
    /// Everything at once: both axes coast.
    All,
}

impl Lost {
    /// Name on the command line and in reports.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Mains => "mains",
            Self::All => "dead",
        }
    }
}

/// A power cut.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PowerCut {
    /// When, from the program's start.
    pub at_s: f64,
    /// What loses its power.
    pub lost: Lost,
}

impl FromStr for PowerCut {
    type Err = String;

    /// `SECONDS`, or `SECONDS,dead`.
    ///
    /// ```
    /// use rigidtap::run::{Lost, PowerCut};
    /// assert_eq!("0.35".parse(), Ok(PowerCut { at_s: 0.35, lost: Lost::Mains }));
    /// assert_eq!("0.35,dead".parse(), Ok(PowerCut { at_s: 0.35, lost: Lost::All }));
    /// assert!("soon".parse::<PowerCut>().is_err());
    /// ```
    fn from_str(text: &str) -> Result<Self, String> {
        let (seconds, word) = text.split_once(',').map_or((text, None), |(seconds, word)| (seconds, Some(word)));
        let at_s = seconds.parse::<f64>().ok().filter(|at_s| (0.0..=1e6).contains(at_s));
        let lost = [Lost::Mains, Lost::All].into_iter().find(|lost| lost.name() == word.unwrap_or(Lost::Mains.name()));
        let cut = at_s.zip(lost).map(|(at_s, lost)| Self { at_s, lost });
        cut.ok_or_else(|| "expected SECONDS or SECONDS,dead, such as 2.5 or 2.5,dead".to_owned())
    }
}
