//! `torque-curve`: the segmented approximation of the motor's torque curve (torque-curve paper, section II).
//!
//! Any number of speed bands, each with its own acceleration and deceleration. Where the stroke is too short for the
//! commanded speed, the peak is calculated back from the distance in closed form.

use arrayvec::ArrayVec;

use super::error::{ProfileError, check_positive};
use super::segments::Profile;
use super::stroke_request::StrokeRequest;
use crate::control::math::{list::copied, sqrt};

/// Most bands of a torque-curve law.
pub const MAX_BANDS: usize = 16;

/// One speed band, from the top of the band below it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpeedBand {
    /// Top V_i.
    pub to_rev_per_s: f64,
    /// A_iac, positive.
    pub accel_rev_per_s2: f64,
    /// A_ide, a magnitude: errata of eq. 4.
    pub decel_rev_per_s2: f64,
}

/// The law: bands in rising order, with the speeds that a stroke starts and ends with.
#[derive(Debug, PartialEq)]
pub struct TorqueCurveLaw {
    /// Start speed Vs.
    pub start_rev_per_s: f64,
    /// End speed Ve.
    pub end_rev_per_s: f64,
    /// The bands. A start or end speed above a band's top skips that band.
    pub bands: ArrayVec<SpeedBand, MAX_BANDS>,
}

impl Clone for TorqueCurveLaw {
    fn clone(&self) -> Self {
        Self { bands: copied(&self.bands), ..*self }
    }
}

/// One flank's piece inside one band.
#[derive(Clone, Copy)]
struct Piece {
    low: f64,
    rise: f64,
    rate: f64,
}

impl Piece {
    /// V_i² − V_{i−1}² over 2·A, eq. 5.
    fn distance(&self) -> f64 {
        self.rise * (2.0 * self.low + self.rise) / (2.0 * self.rate)
    }

    /// (V_i − V_{i−1})/A: errata of eq. 6.
    fn duration_s(&self) -> f64 {
        self.rise / self.rate
    }
}

/// A speed as a rise above one that is known exactly. Where a fast stroke peaks just inside a slow band, the sum alone
/// would round the rise, and with it the distance, by more than the numerical contract allows.
#[derive(Clone, Copy)]
struct Speed {
    base: f64,
    rise: f64,
}

impl Speed {
    fn exactly(base: f64) -> Self {
        Self { base, rise: 0.0 }
    }

    fn value(&self) -> f64 {
        self.base + self.rise
    }
}

#[derive(Clone, Copy)]
enum Flank {
    Up,
    Down,
}

impl TorqueCurveLaw {
    /// The law of these bands that starts and ends at rest.
    ///
    /// # Errors
    /// [`ProfileError::TooManySegments`] for more than [`MAX_BANDS`].
    pub fn from_rest(bands: &[SpeedBand]) -> Result<Self, ProfileError> {
        let bands = ArrayVec::try_from(bands).map_err(|_| ProfileError::TooManySegments)?;
        Ok(Self { start_rev_per_s: 0.0, end_rev_per_s: 0.0, bands })
    }

    /// Greatest speed the bands reach; a commanded speed above it is clamped to it.
    #[must_use]
    pub fn top_rev_per_s(&self) -> f64 {
        self.bands.last().map_or(0.0, |band| band.to_rev_per_s)
    }

    /// The stroke over a distance, with its peak at the commanded speed, at the top band's, or where the distance allows.
    ///
    /// # Errors
    /// [`ProfileError::Invalid`] for anything not positive and finite; [`ProfileError::EndsAboveCommand`];
    /// [`ProfileError::TooShort`] where not even start speed → end speed fits.
    ///
    /// ```
    /// use rigidtap::control::{machine::Machine, profile::StrokeRequest};
    /// let law = Machine::reference().torque_curve().clone();
    /// // Long enough for S7000? 25 rev are not: the peak is back-calculated (eq. 11).
    /// let stroke = law.plan(StrokeRequest { distance: 25.0, command: 7000.0 / 60.0 }).unwrap();
    /// assert!(stroke.peak_velocity() * 60.0 < 7000.0);
    /// assert!((stroke.segments().last().unwrap().end().position - 25.0).abs() < 1e-9);
    /// ```
    pub fn plan(&self, stroke: StrokeRequest) -> Result<Profile, ProfileError> {
        self.check()?;
        stroke.check()?;
        let command = stroke.command.min(self.top_rev_per_s());
        let ends = self.start_rev_per_s.max(self.end_rev_per_s);
        if ends > command {
            return Err(ProfileError::EndsAboveCommand { speed: ends, command });
        }
        let needed = self.flanks_distance(Speed::exactly(ends));
        if needed > stroke.distance {
            return Err(ProfileError::TooShort { distance: stroke.distance, needed });
        }
        let (peak, cruise) = self.peak(stroke.distance - needed, ends, command);
        Profile::built(self.start_rev_per_s, |profile| {
            for piece in self.pieces(Flank::Up, self.start_rev_per_s, peak) {
                profile.push(piece.duration_s(), piece.rate, 0.0, 0.0)?;
            }
            profile.push(cruise / peak.value(), 0.0, 0.0, 0.0)?;
            for piece in self.pieces(Flank::Down, self.end_rev_per_s, peak).rev() {
                profile.push(piece.duration_s(), -piece.rate, 0.0, 0.0)?;
            }
            profile.finish(stroke.distance, self.end_rev_per_s)
        })
    }

    /// The change from one speed to another, over whatever distance it takes: M03, M05, a new S.
    ///
    /// # Errors
    /// [`ProfileError::Invalid`] for a speed below zero, or for bands that are not positive.
    pub fn change_speed(&self, from: f64, to: f64) -> Result<Profile, ProfileError> {
        self.check()?;
        for speed in [from, to] {
            if !(speed >= 0.0 && speed.is_finite()) {
                return Err(ProfileError::Invalid { value: speed });
            }
        }
        Profile::built(from, |profile| {
            if to >= from {
                for piece in self.pieces(Flank::Up, from, Speed::exactly(to)) {
                    profile.push(piece.duration_s(), piece.rate, 0.0, 0.0)?;
                }
            } else {
                for piece in self.pieces(Flank::Down, to, Speed::exactly(from)).rev() {
                    profile.push(piece.duration_s(), -piece.rate, 0.0, 0.0)?;
                }
            }
            profile.finish_here(to.min(self.top_rev_per_s().max(from)))
        })
    }

    fn check(&self) -> Result<(), ProfileError> {
        let mut below = 0.0;
        for band in &self.bands {
            check_positive(band.to_rev_per_s - below)?;
            check_positive(band.accel_rev_per_s2)?;
            check_positive(band.decel_rev_per_s2)?;
            below = band.to_rev_per_s;
        }
        for speed in [self.start_rev_per_s, self.end_rev_per_s] {
            if !(speed >= 0.0 && speed.is_finite()) {
                return Err(ProfileError::Invalid { value: speed });
            }
        }
        check_positive(self.top_rev_per_s())
    }

    /// The pieces of one flank between two speeds, upwards.
    fn pieces(&self, flank: Flank, from: f64, to: Speed) -> impl DoubleEndedIterator<Item = Piece> {
        let bands = self.bands.as_slice();
        (0..bands.len()).filter_map(move |index| {
            let band = bands.get(index)?;
            let below = index.checked_sub(1).and_then(|below| bands.get(below)).map_or(0.0, |band| band.to_rev_per_s);
            let rate = match flank {
                Flank::Up => band.accel_rev_per_s2,
                Flank::Down => band.decel_rev_per_s2,
            };
            let low = from.max(below);
            let rise = if band.to_rev_per_s <= to.base {
                band.to_rev_per_s - low
            } else if below <= to.base {
                (to.base - low) + to.rise
            } else {
                0.0
            };
            (rise > 0.0).then_some(Piece { low, rise, rate })
        })
    }

    /// Distance of both flanks that meet at a peak, without cruise.
    fn flanks_distance(&self, peak: Speed) -> f64 {
        let up: f64 = self.pieces(Flank::Up, self.start_rev_per_s, peak).map(|piece| piece.distance()).sum();
        let down: f64 = self.pieces(Flank::Down, self.end_rev_per_s, peak).map(|piece| piece.distance()).sum();
        up + down
    }

    /// Peak speed and cruise distance, where `rest` is left after both flanks have met at speed `ends`.
    ///
    /// Eq. 11 as errata.md corrects it, for the peak in any band: Vm² = V² + 2·(Aac·Ade)/(Aac + Ade)·rest.
    fn peak(&self, mut rest: f64, ends: f64, command: f64) -> (Speed, f64) {
        let mut reached = ends;
        for band in &self.bands {
            let top = band.to_rev_per_s.min(command);
            if top <= reached {
                continue;
            }
            let (up, down) = (band.accel_rev_per_s2, band.decel_rev_per_s2);
            let harmonic = up * down / (up + down);
            let needed = (top - reached) * (top + reached) / (2.0 * harmonic);
            if needed > rest {
                let gained = 2.0 * harmonic * rest;
                let rise = gained / (reached + sqrt(reached * reached + gained));
                return (Speed { base: reached, rise: rise.min(top - reached) }, 0.0);
            }
            rest -= needed;
            reached = top;
        }
        (Speed::exactly(reached), rest)
    }
}
