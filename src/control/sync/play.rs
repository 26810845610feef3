//! The play of Z's screw: on which side of it Z's motor stands, and when it crosses.
//!
//! The screw's force says on which side the motor has to push. Where that force is next to nothing, friction braking the
//! table just as fast as the path does, it says little: a change of the side then waits, and the table may float to the
//! other side by itself. So a crossing starts from where motor and scale show that the motor stands.

use crate::control::math::{filter_share, poly::State, sign};

use super::history::History;

/// The screw's force is known this well, as a share of the table's friction: within it the motor stands between the sides
/// of its play, so that being wrong costs half of it, and no small change throws it across.
const SURE_SHARE: f64 = 0.15;
/// By how much of that the force has to turn round before the motor follows: between, it stays. Of light tables with much
/// play (`[spread]` at friction 0.5–0.9 and 3–5 µm), less lets more of them rattle, and so does more.
const HOLD: f64 = 0.3;
/// A side that changes slower than this rests: the motor stands where it was sent.
const RESTING_PER_S: f64 = 20.0;
/// Halves of a crossing at rest after which motor and scale show where the motor stands: drive and encoders are through, too.
const SHOWN_LEADS: u32 = 6;
/// Time over which that is averaged: long against the encoders' noise, short against floating across.
const SHOWN_S: f64 = 0.004;
/// An error while no side is decided is chance by so much of it, where the play is at least so wide. Learned from wholly, the
/// chance of one hole throws the table in the next; from not at all, what does repeat stays.
const CHANCE: f64 = 0.7;
const CHANCE_PLAY_MM: f64 = 0.002;

/// Sides are −1…1, 1 where the motor pushes into the hole.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Play {
    period_s: f64,
    width_mm: f64,
    /// Side that the screw's force asks for.
    wanted: f64,
    /// Side on which the motor stands once it has done what it was sent to do.
    standing: f64,
    resting_periods: u32,
    /// What the motor was sent: differs from where it stands by what the table did by itself.
    sent: History,
    decided: History,
}

impl Play {
    /// None yet; a crossing takes a time.
    pub(super) fn new(period_s: f64, crossing_s: f64) -> Self {
        Self {
            period_s,
            width_mm: 0.0,
            wanted: 0.0,
            standing: 0.0,
            resting_periods: 0,
            sent: History::smoothed(period_s, crossing_s),
            decided: History::smoothed(period_s, crossing_s),
        }
    }

    /// A hole begins, with the motor on a side.
    pub(super) fn begin(&mut self, width_mm: f64, side: f64) {
        self.width_mm = width_mm;
        (self.wanted, self.standing, self.resting_periods) = (side, side, 0);
        self.sent.fill(side);
        self.decided.fill(1.0);
    }

    /// A crossing has its middle so long after it is asked for.
    pub(super) fn lead_s(&self) -> f64 {
        self.sent.half_width_s()
    }

    /// The same in periods.
    pub(super) fn lead_periods(&self) -> u32 {
        self.sent.half_width_periods()
    }

    /// One period: what the screw will carry, over a table's friction of so much.
    pub(super) fn load(&mut self, screw_n: f64, table_friction_n: f64) {
        let wanted = if screw_n == 0.0 {
            self.wanted
        } else {
            let sides = screw_n / (SURE_SHARE * table_friction_n);
            self.wanted.max(sides - HOLD).min(sides + HOLD).clamp(-1.0, 1.0)
        };
        let change = wanted - self.wanted;
        let end = sign(change);
        // By as much of the way to its end as the wanted side moves of its own.
        let moved = if change == 0.0 { 0.0 } else { change / (end - self.wanted) * (end - self.standing) };
        self.wanted = wanted;
        self.standing += moved;
        self.sent.push(self.sent.newest() + moved);
        self.decided.push(wanted.abs());
        self.resting_periods =
            if change.abs() > RESTING_PER_S * self.period_s { 0 } else { self.resting_periods.saturating_add(1) };
    }

    /// One period: how far the motor leads the table beyond the screw's stretch, as motor and scale show it.
    pub(super) fn show(&mut self, lead_mm: f64) {
        if self.resting_periods < SHOWN_LEADS * self.lead_periods() || !(self.width_mm > 0.0) {
            return;
        }
        let shown = (2.0 * lead_mm / self.width_mm).clamp(-1.0, 1.0);
        self.standing += filter_share(self.period_s, SHOWN_S) * (shown - self.standing);
    }

    /// How far the motor was sent ahead of the table, so long before what is asked for now.
    pub(super) fn sent_mm(&self, ago_s: f64) -> State {
        self.sent.at(ago_s).scaled(0.5 * self.width_mm)
    }

    /// Share of an error that the next hole will show again, at a time before what is asked for now.
    pub(super) fn repeats(&self, ago_s: f64) -> f64 {
        let undecided = 1.0 - self.decided.at(ago_s).position.min(1.0);
        1.0 - CHANCE * undecided * (self.width_mm / CHANCE_PLAY_MM).min(1.0)
    }

    #[cfg(test)]
    pub(super) fn standing(&self) -> f64 {
        self.standing
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PERIOD_S: f64 = 0.001;
    const CROSSING_S: f64 = 0.004;
    const WIDTH_MM: f64 = 0.004;
    const FRICTION_N: f64 = 100.0;
    const SURE_N: f64 = SURE_SHARE * FRICTION_N;

    fn begun(side: f64) -> Play {
        let mut play = Play::new(PERIOD_S, CROSSING_S);
        play.begin(WIDTH_MM, side);
        play
    }

    fn loaded(play: &mut Play, periods: usize, screw_n: f64) {
        (0..periods).for_each(|_| play.load(screw_n, FRICTION_N));
    }

    fn sent_mm(play: &Play) -> f64 {
        play.sent_mm(play.lead_s()).position
    }

    #[test]
    fn motor_crosses_where_the_force_turns_round() {
        let mut play = begun(1.0);
        loaded(&mut play, 20, 50.0);
        assert!((sent_mm(&play) - 0.5 * WIDTH_MM).abs() < 1e-12);
        loaded(&mut play, 20, -50.0);
        assert!((sent_mm(&play) + 0.5 * WIDTH_MM).abs() < 1e-12);
    }

    #[test]
    fn little_force_says_little() {
        let mut play = begun(1.0);
        // It stays within the hold of what the force says.
        for (sides, expected) in [(0.8, 1.0), (0.5, 0.8), (0.6, 0.8), (-0.1, 0.2), (0.4, 0.2), (-1.5, -1.0)] {
            loaded(&mut play, 1, sides * SURE_N);
            assert!((play.standing() - expected).abs() < 1e-12, "{sides}: {}", play.standing());
        }
        loaded(&mut play, 1, 0.0);
        assert_eq!(play.standing(), -1.0, "no force says nothing");
        let mut frictionless = begun(1.0);
        frictionless.load(-1.0, 0.0);
        assert_eq!(frictionless.standing(), -1.0);
    }

    /// The table has floated across by itself: the motor is where it will have to push, and is not sent.
    #[test]
    fn crossing_starts_from_where_the_motor_is_shown_to_stand() {
        for (shown, moved) in [(-1.0, 2.0), (0.0, 1.0), (0.5, 0.5), (1.0, 0.0), (3.0, 0.0)] {
            let mut play = begun(-1.0);
            for _ in 0..100 {
                loaded(&mut play, 1, -50.0);
                play.show(0.5 * WIDTH_MM * shown);
            }
            let before_mm = sent_mm(&play);
            loaded(&mut play, 5, 0.2 * SURE_N);
            loaded(&mut play, 20, 50.0);
            let way_mm = sent_mm(&play) - before_mm;
            assert!((way_mm - 0.5 * WIDTH_MM * moved).abs() < 1e-9, "{shown}: {way_mm}");
        }
    }

    #[test]
    fn what_is_shown_during_a_crossing_does_not_count() {
        for (period_s, crossing_s, resting_s) in
            [(0.001, 0.004, 0.012), (0.000_25, 0.004, 0.012), (0.001, 0.016, 0.048)]
        {
            let mut play = Play::new(period_s, crossing_s);
            play.begin(WIDTH_MM, -1.0);
            let crossed = (0..1000).take_while(|_| {
                loaded(&mut play, 1, 50.0);
                play.show(-0.5 * WIDTH_MM);
                play.standing() == 1.0
            });
            let counted_s = crossed.count() as f64 * period_s;
            assert!((counted_s - resting_s).abs() < 1e-9, "{period_s} {crossing_s}: {counted_s}");
        }
    }

    #[test]
    fn errors_repeat_where_a_side_is_decided_or_there_is_no_play() {
        let mut play = begun(1.0);
        let repeats = |play: &Play| play.repeats(play.lead_s());
        loaded(&mut play, 20, 50.0);
        assert!((repeats(&play) - 1.0).abs() < 1e-12);
        loaded(&mut play, 20, -HOLD * SURE_N);
        assert!((repeats(&play) - (1.0 - CHANCE)).abs() < 1e-12);
        play.width_mm = 0.0;
        assert_eq!(repeats(&play), 1.0);
    }
}
