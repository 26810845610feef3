//! Crank to slide, the coupling of a servo press.

use core::f64::consts::TAU;

use crate::control::math::{cos, floor, poly::State, sin, sqrt};

/// Crank angle in rev, 0 at top dead centre, to the slide's height in mm above bottom dead centre.
///
/// h(θ) = 2R − [R·(1 − cos θ) − L·(1 − √(1 − λ²·sin² θ))], λ = R/L: exact, where the servo-press paper's eq. 1 to 3
/// approximate, and with the rod's sign as errata.md corrects it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SliderCrank {
    crank_mm: f64,
    rod_mm: f64,
}

/// Height and its derivatives by the crank angle in radians.
struct Height {
    mm: f64,
    first: f64,
    second: f64,
    third: f64,
}

impl SliderCrank {
    /// The mechanism of crank radius R and rod length L; none unless 0 < R < L < ∞.
    #[must_use]
    pub fn new(crank_mm: f64, rod_mm: f64) -> Option<Self> {
        (crank_mm > 0.0 && rod_mm > crank_mm && rod_mm.is_finite()).then_some(Self { crank_mm, rod_mm })
    }

    /// Slide height above bottom dead centre at a crank angle.
    ///
    /// ```
    /// use rigidtap::control::coupling::SliderCrank;
    /// let press = SliderCrank::new(450.0, 1200.0).unwrap();
    /// assert!((press.height_mm(66.0 / 360.0) - 705.6).abs() < 0.05); // the paper prints 705.7
    /// assert_eq!(press.height_mm(0.0), 900.0);
    /// ```
    #[must_use]
    pub fn height_mm(&self, crank_rev: f64) -> f64 {
        self.height(crank_rev).mm
    }

    /// The slide's height, speed, acceleration and jerk for the crank's, by the chain rule.
    ///
    /// ```
    /// use rigidtap::control::{coupling::SliderCrank, math::poly::State};
    /// let crank = State { position: 131.5 / 360.0, velocity: 6.7 / 60.0, ..State::default() };
    /// let slide = SliderCrank::new(450.0, 1200.0).unwrap().follow(&crank);
    /// assert!((slide.velocity + 297.7).abs() < 0.05); // downwards
    /// ```
    #[must_use]
    pub fn follow(&self, crank: &State) -> State {
        let height = self.height(crank.position);
        let (w, a, j) = (TAU * crank.velocity, TAU * crank.acceleration, TAU * crank.jerk);
        State {
            position: height.mm,
            velocity: height.first * w,
            acceleration: height.second * w * w + height.first * a,
            jerk: height.third * w * w * w + 3.0 * height.second * w * a + height.first * j,
        }
    }

    fn height(&self, crank_rev: f64) -> Height {
        let Self { crank_mm: r, rod_mm: l } = *self;
        let angle = TAU * (crank_rev - floor(crank_rev));
        let (s, c) = (sin(angle), cos(angle));
        let squared = (r / l) * (r / l);
        // w = √g, the cosine of the rod's angle: w·w' = g'/2, differentiated on.
        let w = sqrt(1.0 - squared * s * s);
        let (sin_2, cos_2) = (2.0 * s * c, c * c - s * s);
        let w1 = -squared * sin_2 / (2.0 * w);
        let w2 = (-2.0 * squared * cos_2 - 2.0 * w1 * w1) / (2.0 * w);
        let w3 = (4.0 * squared * sin_2 - 6.0 * w1 * w2) / (2.0 * w);
        Height {
            mm: r * (1.0 + c) + l * (1.0 - w),
            first: -r * s - l * w1,
            second: -r * c - l * w2,
            third: r * s - l * w3,
        }
    }
}
