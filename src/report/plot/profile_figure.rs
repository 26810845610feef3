//! Time laws side by side: motion over time, and the torque they ask of the motor.

use crate::control::math::poly::State;
use crate::control::motor::Motor;
use crate::control::profile::Profile;
use crate::control::units::rpm_from_rev_per_s;

use super::axis::{Frame, Range};
use super::canvas::{Area, Canvas, picture};
use super::fault::{PlotError, check_drawable};
use super::style::{Align, FORBIDDEN, Font, INK, MARGIN_PX, WIDTH_PX, number, series, thousands};

/// Straight pieces that a curve is drawn with, over the whole stroke; every segment has its share, and its ends exactly.
const PIECES: f64 = 240.0;
/// Points that the motor's curve is drawn with.
const CURVE_POINTS: usize = 120;

const LEFT_PX: f64 = 70.0;
/// Where motion over time ends, and the torque plane with the legend begins.
const MIDDLE_PX: f64 = 545.0;
const PLANE_LEFT_PX: f64 = 612.0;
const TOP_PX: f64 = 66.0;
const PANEL_PX: f64 = 112.0;
const GAP_PX: f64 = 26.0;
const FOOT_PX: f64 = 44.0;
const ENTRY_PX: f64 = 36.0;

/// Draws spindle position, speed, acceleration and jerk over time, and the torque–speed plane with the motor's curve.
///
/// Profiles are of the spindle, in rev. The torque is what the inertia takes, a magnitude; above the motor's curve the
/// plane is shaded. A jump of the acceleration, whose jerk has no bound, is a line through the whole jerk panel.
///
/// # Errors
/// [`PlotError`]: no profile, or values that no axis can show.
///
/// ```
/// use rigidtap::control::{machine::{Law, Machine}, profile::StrokeRequest};
/// use rigidtap::report::plot::profile_figure;
/// let machine = Machine::reference();
/// let request = StrokeRequest { distance: 25.0, command: 50.0 };
/// let stroke = machine.stroke(Law::TorqueCurve, request).unwrap();
/// let svg = profile_figure("One stroke", &[("torque-curve", &stroke)], machine.motor()).unwrap();
/// assert!(svg.contains("torque-curve") && svg.contains("jerk"));
/// ```
pub fn profile_figure(title: &str, profiles: &[(&str, &Profile)], motor: &Motor) -> Result<String, PlotError> {
    let laws: Vec<Law<'_>> =
        profiles.iter().enumerate().map(|(index, (name, profile))| Law::sampled(index, name, profile, motor)).collect();
    if laws.iter().all(|law| law.samples.is_empty()) {
        return Err(PlotError::Nothing);
    }
    for law in &laws {
        check_drawable(law.samples.iter().flat_map(|sample| [sample.t_s].into_iter().chain(sample.values)))?;
        check_drawable(law.samples.iter().map(|sample| sample.torque_nm))?;
    }
    let legend_top = TOP_PX + 2.0 * PANEL_PX + GAP_PX + 70.0;
    let panels_bottom = TOP_PX + 4.0 * PANEL_PX + 3.0 * GAP_PX;
    let height_px = (panels_bottom + FOOT_PX).max(legend_top + ENTRY_PX * laws.len() as f64 + MARGIN_PX);
    let description = laws.iter().map(|law| format!("{}: {}. ", law.name, law.summary()));
    picture(title, description.collect::<String>().trim_end(), height_px, |canvas| {
        motion(canvas, &laws)?;
        plane(canvas, &laws, motor)?;
        for (index, law) in laws.iter().enumerate() {
            let y = legend_top + ENTRY_PX * index as f64;
            canvas.path(&[(PLANE_LEFT_PX, y), (PLANE_LEFT_PX + 20.0, y)], law.color(), 2.5)?;
            let room = WIDTH_PX - MARGIN_PX - PLANE_LEFT_PX - 28.0;
            canvas.text((PLANE_LEFT_PX + 28.0, y), &Font::HEADING.fit(law.name, room), Font::HEADING)?;
            canvas.text((PLANE_LEFT_PX + 28.0, y + 15.0), &law.summary(), Font::CAPTION)?;
        }
        Ok(())
    })
}

/// A law's state at one time, in the units of the axes before their powers of ten.
struct Sample {
    t_s: f64,
    /// Position in rev, speed in rpm, acceleration in rpm/s, jerk in rpm/s².
    values: [f64; 4],
    torque_nm: f64,
    /// Torque over what the motor has at that speed.
    share: f64,
}

struct Law<'a> {
    index: usize,
    name: &'a str,
    samples: Vec<Sample>,
    /// Times at which the acceleration jumps.
    jumps_s: Vec<f64>,
}

impl<'a> Law<'a> {
    fn sampled(index: usize, name: &'a str, profile: &Profile, motor: &Motor) -> Self {
        let sample = |t_s: f64, state: State| {
            let torque_nm = motor.torque_for_nm(state.acceleration).abs();
            let [rpm, rpm_per_s, rpm_per_s2] = [state.velocity, state.acceleration, state.jerk].map(rpm_from_rev_per_s);
            Sample {
                t_s,
                values: [state.position, rpm, rpm_per_s, rpm_per_s2],
                torque_nm,
                share: torque_nm / motor.curve.torque_nm(rpm),
            }
        };
        let mut samples = Vec::new();
        let mut jumps_s = Vec::new();
        let mut before = State::default();
        let greatest = profile.segments().iter().flat_map(|segment| [segment.start, segment.end()]);
        let greatest = greatest.map(|state| state.acceleration.abs()).fold(0.0, f64::max);
        let jumps = |a: f64, b: f64| (a - b).abs() > 1e-6 * greatest;
        for segment in profile.segments() {
            if jumps(before.acceleration, segment.start.acceleration) {
                jumps_s.push(segment.start_s);
            }
            let share = segment.duration_s / profile.duration_s();
            let pieces = (PIECES * share).ceil().clamp(2.0, PIECES);
            for step in 0..=pieces as usize {
                let into_s = segment.duration_s * (step as f64 / pieces);
                samples.push(sample(segment.start_s + into_s, segment.start.after(into_s, segment.snap)));
            }
            before = segment.end();
        }
        if jumps(before.acceleration, 0.0) {
            jumps_s.push(profile.duration_s());
        }
        if let (Some(first), Some(last)) = (profile.segments().first(), profile.segments().last()) {
            // From rest and to rest: the jumps at both ends are seen.
            let rest = |state: State| State { acceleration: 0.0, jerk: 0.0, ..state };
            samples.insert(0, sample(first.start_s, rest(first.start)));
            samples.push(sample(last.end_s(), rest(last.end())));
        }
        Self { index, name, samples, jumps_s }
    }

    fn color(&self) -> plotters::style::RGBColor {
        series(self.index)
    }

    /// Time, peak speed and greatest load of the motor.
    fn summary(&self) -> String {
        let duration_s = self.samples.last().map_or(0.0, |sample| sample.t_s);
        let peak_rpm = self.samples.iter().map(|sample| sample.values[1]).fold(0.0, f64::max);
        let share = self.samples.iter().map(|sample| sample.share).fold(0.0, f64::max);
        format!(
            "{} s, peak {} rpm, torque ≤ {} %",
            number(duration_s, 3),
            number(peak_rpm, 0),
            number(100.0 * share, 0)
        )
    }

    /// One quantity over time, divided by the axis's power of ten.
    fn over_time(&self, quantity: usize, power: f64) -> Vec<(f64, f64)> {
        self.samples.iter().filter_map(|sample| Some((sample.t_s, sample.values.get(quantity)? / power))).collect()
    }
}

fn motion(canvas: &mut Canvas<'_>, laws: &[Law<'_>]) -> Result<(), PlotError> {
    let times = laws.iter().flat_map(|law| &law.samples).map(|sample| sample.t_s);
    let x = Range::of(times.chain([0.0]))
        .map_or(Range { low: 0.0, high: 1.0 }, |range| Range { high: range.high * 1.02, ..range });
    let x = if x.high > 0.0 { x } else { Range { low: 0.0, high: 1.0 } };
    for (quantity, (name, unit)) in
        [("position", "rev"), ("speed", "rpm"), ("acceleration", "rpm/s"), ("jerk", "rpm/s²")].into_iter().enumerate()
    {
        let values = || laws.iter().flat_map(|law| &law.samples).filter_map(|sample| sample.values.get(quantity));
        let (power, prefix) = thousands(values().map(|value| value.abs()).fold(0.0, f64::max));
        let y = Range::of(values().map(|value| value / power).chain([0.0])).unwrap_or(Range { low: 0.0, high: 1.0 });
        let top = TOP_PX + quantity as f64 * (PANEL_PX + GAP_PX);
        let area = Area { left: LEFT_PX, top, right: MIDDLE_PX, bottom: top + PANEL_PX };
        let frame = Frame { area, x, y: y.padded(0.07) };
        let last = quantity == 3;
        frame.ground(canvas)?;
        frame.axes(canvas, last)?;
        frame.name_above(canvas, &format!("{name}, {prefix}{unit}"))?;
        for law in laws {
            if last {
                for jump_s in &law.jumps_s {
                    let x = frame.x_px(*jump_s);
                    canvas.path(&[(x, frame.area.top), (x, frame.area.bottom)], law.color(), 0.75)?;
                }
            }
            canvas.path(&frame.places(&law.over_time(quantity, power)), law.color(), 1.5)?;
        }
        if last {
            frame.name_x(canvas, "time, s")?;
            if laws.iter().any(|law| !law.jumps_s.is_empty()) {
                let at = (frame.area.right, frame.area.top - 9.0);
                canvas.text(at, "full line: acceleration jumps", Font::CAPTION.aligned(Align::Right))?;
            }
        }
    }
    Ok(())
}

fn plane(canvas: &mut Canvas<'_>, laws: &[Law<'_>], motor: &Motor) -> Result<(), PlotError> {
    let samples = || laws.iter().flat_map(|law| &law.samples);
    let top_rpm = motor.curve.points().last().map_or(0.0, |point| point.speed_rpm);
    let greatest_nm = motor.curve.points().iter().map(|point| point.torque_nm).fold(0.0, f64::max);
    let high_rpm = samples().map(|sample| sample.values[1]).fold(top_rpm, f64::max);
    let high_nm = samples().map(|sample| sample.torque_nm).fold(greatest_nm, f64::max);
    check_drawable([high_rpm, high_nm])?;
    let area = Area {
        left: PLANE_LEFT_PX,
        top: TOP_PX,
        right: WIDTH_PX - MARGIN_PX,
        bottom: TOP_PX + 2.0 * PANEL_PX + GAP_PX,
    };
    let frame = Frame { area, x: Range { low: 0.0, high: high_rpm }, y: Range { low: 0.0, high: 1.15 * high_nm } };
    let curve: Vec<(f64, f64)> = (0..=CURVE_POINTS)
        .map(|step| high_rpm * step as f64 / CURVE_POINTS as f64)
        .map(|rpm| (rpm, motor.curve.torque_nm(rpm)))
        .collect();
    frame.ground(canvas)?;
    let mut above = frame.places(&curve);
    above.extend([(area.right, area.top), (area.left, area.top)]);
    canvas.polygon(&above, FORBIDDEN)?;
    frame.axes(canvas, true)?;
    frame.name_above(canvas, "torque, N·m")?;
    frame.name_x(canvas, "speed, rpm")?;
    canvas.path(&frame.places(&curve), INK, 2.0)?;
    for law in laws {
        let asked: Vec<(f64, f64)> = law.samples.iter().map(|sample| (sample.values[1], sample.torque_nm)).collect();
        canvas.path(&frame.places(&asked), law.color(), 1.5)?;
    }
    let at = (area.right - 8.0, area.top + 12.0);
    canvas.text(at, "beyond the motor", Font::CAPTION.aligned(Align::Right))
}

#[cfg(test)]
mod tests {
    use super::super::well_formed::assert_well_formed;
    use super::*;
    use crate::control::machine::{Law as LawName, Machine};
    use crate::control::profile::StrokeRequest;
    use proptest::prelude::*;

    #[test]
    fn a_law_beyond_the_motor_says_so() {
        let machine = Machine::reference();
        let request = StrokeRequest { distance: 25.0, command: 7000.0 / 60.0 };
        let share = |law| {
            let profile = machine.stroke(law, request).unwrap();
            let law = Law::sampled(0, "law", &profile, machine.motor());
            law.samples.iter().map(|sample| sample.share).fold(0.0, f64::max)
        };
        assert!(share(LawName::SCurve) > 1.0 && share(LawName::TorqueCurve) <= 1.0);
    }

    #[test]
    fn jumps_of_acceleration_are_found() {
        let machine = Machine::reference();
        let request = StrokeRequest { distance: 25.0, command: 50.0 };
        let jumps = |law| Law::sampled(0, "", &machine.stroke(law, request).unwrap(), machine.motor()).jumps_s.len();
        assert_eq!([jumps(LawName::SCurve), jumps(LawName::Linear)], [0, 4]);
    }

    #[test]
    fn nothing_to_draw_is_refused() {
        let motor = Machine::reference().motor().clone();
        assert_eq!(profile_figure("", &[], &motor), Err(PlotError::Nothing));
        assert_eq!(profile_figure("", &[("rest", &Profile::default())], &motor), Err(PlotError::Nothing));
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(48))]
        #[test]
        fn any_strokes_give_a_picture_and_the_same_again(
            distance in 1e-3..1e4f64,
            command in 1e-3..1e4f64,
            count in 1..12usize,
            name in any::<String>(),
        ) {
            let machine = Machine::reference();
            let plan = |law| machine.stroke(law, StrokeRequest { distance, command });
            let profiles: Vec<Profile> = LawName::ALL.into_iter().cycle().take(count).filter_map(|law| plan(law).ok()).collect();
            prop_assume!(!profiles.is_empty());
            let named: Vec<(&str, &Profile)> = profiles.iter().map(|profile| (name.as_str(), profile)).collect();
            let svg = profile_figure(&name, &named, machine.motor()).unwrap();
            assert_well_formed(&svg);
            prop_assert!(svg.len() < 300_000);
            prop_assert_eq!(svg, profile_figure(&name, &named, machine.motor()).unwrap());
        }
    }
}
