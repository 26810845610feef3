//! Tapping torque by thread, material and engaged depth.

/// What is tapped, with the constants that tap makers publish for it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Material {
    /// AlSi8Cu3, spiral-flute tap.
    #[default]
    AlSi,
    /// Ck45 steel, spiral-flute tap.
    Ck45,
    /// Austenitic stainless steel.
    Stainless,
    /// Steel hardened to 40 HRC.
    Hrc40,
    /// GG25 grey cast iron.
    Gg25,
    /// CuZn40 brass.
    CuZn40,
    /// Air: no torque at all.
    None,
}

impl Material {
    /// Every material, in the order of documentation.
    pub const ALL: [Self; 7] =
        [Self::AlSi, Self::Ck45, Self::Stainless, Self::Hrc40, Self::Gg25, Self::CuZn40, Self::None];

    /// Name on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::AlSi => "alsi",
            Self::Ck45 => "ck45",
            Self::Stainless => "stainless",
            Self::Hrc40 => "hrc40",
            Self::Gg25 => "gg25",
            Self::CuZn40 => "cuzn40",
            Self::None => "none",
        }
    }

    /// Specific cutting force kc in N/mm².
    #[must_use]
    pub const fn kc_n_per_mm2(self) -> f64 {
        match self {
            Self::AlSi => 1300.0,
            Self::Ck45 => 3900.0,
            Self::Stainless => 4200.0,
            Self::Hrc40 => 5500.0,
            Self::Gg25 => 2900.0,
            Self::CuZn40 => 2300.0,
            Self::None => 0.0,
        }
    }

    /// Greatest cutting speed of a usual coated tap in m/min, an upper bound by judgement: handbooks name 10 to 30 for
    /// Ck45, less for stainless and hardened steel, up to 60 for brass, and high-speed tapping of aluminium is done at more than 130 (M6 at 7000 rpm).
    #[must_use]
    pub const fn max_m_per_min(self) -> Option<f64> {
        match self {
            Self::AlSi => Some(150.0),
            Self::Ck45 | Self::Gg25 => Some(40.0),
            Self::Stainless => Some(20.0),
            Self::Hrc40 => Some(12.0),
            Self::CuZn40 => Some(100.0),
            Self::None => None,
        }
    }

    /// The material of a specific cutting force, if it is one of these.
    #[must_use]
    pub fn of_kc(kc_n_per_mm2: f64) -> Option<Self> {
        Self::ALL.into_iter().find(|material| material.kc_n_per_mm2() == kc_n_per_mm2)
    }

    /// Factor K of a spiral-flute tap in this material.
    #[must_use]
    pub const fn tool_factor(self) -> f64 {
        match self {
            Self::AlSi | Self::Gg25 | Self::CuZn40 => 1.05,
            Self::Ck45 | Self::Stainless | Self::Hrc40 => 1.15,
            Self::None => 1.0,
        }
    }
}

/// Torque in N·m with the whole chamfer engaged: T = tan θ·kc·K·(D − Do)²·(D + 2·Do)/24000, θ = 30° (tap makers' handbooks).
///
/// ```
/// use rigidtap::control::model::cutting::{Material, tapping_torque_nm};
/// let torque = |m: Material| tapping_torque_nm(6.0, 5.0, m.kc_n_per_mm2(), m.tool_factor());
/// assert!((torque(Material::Ck45) - 1.73).abs() < 0.005);
/// assert!((torque(Material::AlSi) - 0.525).abs() < 0.005);
/// ```
#[must_use]
pub fn tapping_torque_nm(major_mm: f64, hole_mm: f64, kc_n_per_mm2: f64, tool_factor: f64) -> f64 {
    const TAN_30: f64 = 0.577_350_269_189_625_8;
    let thread_mm = major_mm - hole_mm;
    TAN_30 * kc_n_per_mm2 * tool_factor * thread_mm * thread_mm * (major_mm + 2.0 * hole_mm) / 24_000.0
}

/// Share of the full torque at a depth below the surface: rises over the chamfer, then stays.
#[must_use]
pub fn engagement(depth_mm: f64, chamfer_mm: f64) -> f64 {
    if depth_mm <= 0.0 {
        0.0
    } else if depth_mm >= chamfer_mm {
        1.0
    } else {
        depth_mm / chamfer_mm
    }
}
