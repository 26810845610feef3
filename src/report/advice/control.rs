//! What to type into a control: its parameters with their numbers, from manuals found in public text.
//!
//! What no such text says is left out, and the sheet says so: a wrong parameter costs a tap.

use crate::control::machine::Machine;
use crate::control::motor::Motor;
use crate::control::units::{MS_PER_S, rev_per_s_from_rpm, rpm_from_rev_per_s};
use crate::laws::{STROKES_REV, TuneTask};
use crate::study::Advice;

/// A control whose parameters are known in part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Control {
    /// FANUC Series 0i.
    Fanuc,
    /// Siemens SINUMERIK 840D.
    Siemens,
    /// Mitsubishi M700V.
    Mitsubishi,
    /// LinuxCNC with this project's component.
    LinuxCnc,
}

impl Control {
    /// Every control, in the order of documentation.
    pub const ALL: [Self; 4] = [Self::Fanuc, Self::Siemens, Self::Mitsubishi, Self::LinuxCnc];

    /// Name on the command line and in reports.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Fanuc => "fanuc",
            Self::Siemens => "siemens",
            Self::Mitsubishi => "mitsubishi",
            Self::LinuxCnc => "linuxcnc",
        }
    }
}

/// One parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct ControlParameter {
    /// Number, or the pin's name; none where no manual that was found tells it.
    pub number: Option<&'static str>,
    /// What it is.
    pub name: &'static str,
    /// Value, rounded.
    pub value: String,
    /// Unit; empty for shares.
    pub unit: &'static str,
    /// How it was rounded, and why so.
    pub rounding: &'static str,
    /// Manual and page.
    pub source: &'static str,
}

/// All that is known of a control.
#[derive(Clone, Debug, PartialEq)]
pub struct ControlSheet {
    /// The control.
    pub control: Control,
    /// Its parameters.
    pub parameters: Vec<ControlParameter>,
    /// What the sheet does not say, and what to look up.
    pub notes: Vec<&'static str>,
}

/// Zones of a Mitsubishi's tapping acceleration.
const ZONES: usize = 3;
const SLOWER: &str = "rounded up to whole ms, so that it never asks more than the motor";
const MITSUBISHI: &str =
    "MITSUBISHI CNC 700/70 Series Programming Manual (Machining Center), 13.1 Fixed Cycles, p. 262";
const FANUC: &str = "FANUC Series 0i/0i Mate-MODEL C Descriptions, B-64112EN/01, 13.2.2, p. 119";
const SIEMENS_KNEE: &str =
    "SINUMERIK 840D sl Function Manual Basic Functions, Acceleration (B2), 6FC5397-0BP10-2BA0, 2.18, p. 45";
const SIEMENS_SPINDLE: &str =
    "SINUMERIK 840D sl Function Manual Axes and Spindles, 06/2019, A5E47437747B AA, p. 754 and 780";
const SIEMENS_SPEED: &str = "SINUMERIK 840D sl Function Manual Axes and Spindles, 06/2019, A5E47437747B AA, p. 829";
const COMPONENT: &str = "src/capi/linuxcnc/README.md, Parameters";

/// The parameters of a control that come nearest to an advice.
#[must_use]
pub fn control_sheet(control: Control, advice: &Advice) -> ControlSheet {
    let share = advice.share.unwrap_or(advice.machine.spec().law.motor_share);
    let top_rpm = advice.kinds.iter().map(|kind| kind.trial.speed_rpm).fold(0.0, f64::max);
    let (parameters, notes) = match control {
        Control::Fanuc => fanuc(&advice.machine, share, top_rpm),
        Control::Siemens => siemens(&advice.machine, share, top_rpm),
        Control::Mitsubishi => mitsubishi(&advice.machine, share),
        Control::LinuxCnc => component(&advice.machine, advice, share),
    };
    ControlSheet { control, parameters, notes }
}

type Sheet = (Vec<ControlParameter>, Vec<&'static str>);

fn parameter(
    number: Option<&'static str>,
    name: &'static str,
    value: String,
    unit: &'static str,
    rounding: &'static str,
    source: &'static str,
) -> ControlParameter {
    ControlParameter { number, name, value, unit, rounding, source }
}

/// A time in whole ms, up: a longer time never asks more of the motor.
fn slower_ms(seconds: f64) -> String {
    format!("{:.0}", (seconds * MS_PER_S - 1e-6).ceil())
}

fn acceleration_rpm_per_s(motor: &Motor, rpm: f64, share: f64) -> f64 {
    rpm_from_rev_per_s(motor.acceleration_rev_per_s2(rev_per_s_from_rpm(rpm), share))
}

/// One acceleration up to the greatest speed, with a curved part at each end.
fn fanuc(machine: &Machine, share: f64, top_rpm: f64) -> Sheet {
    let linear_s = top_rpm / acceleration_rpm_per_s(machine.motor(), top_rpm, share);
    let law = &machine.spec().law.s_curve;
    let curved_s = law.accel_rpm_per_s / law.jerk_rpm_per_s2;
    let parameters = vec![
        parameter(
            None,
            "greatest speed in rigid tapping",
            format!("{top_rpm:.0}"),
            "rpm",
            "not rounded: the advice's own S",
            FANUC,
        ),
        parameter(
            None,
            "T1, time constant of linear acceleration up to that speed",
            slower_ms(linear_s),
            "ms",
            SLOWER,
            FANUC,
        ),
        parameter(
            None,
            "T2, time constant of the curved portion of the bell shape",
            slower_ms(curved_s),
            "ms",
            SLOWER,
            FANUC,
        ),
    ];
    let notes = vec![
        "No manual that was found tells the numbers of these parameters: look up \"rigid tapping\" in your control's parameter \
         manual.",
        "Of the optimum acceleration and deceleration by five points no manual was found: with this one acceleration, which the \
         motor has at the greatest speed, strokes take longer than the advice says.",
    ];
    (parameters, notes)
}

/// Constant up to the knee, then falling as 1/speed.
fn siemens(machine: &Machine, share: f64, top_rpm: f64) -> Sheet {
    let motor = machine.motor();
    let most = motor.acceleration_rev_per_s2(0.0, share);
    let knee_rpm = machine
        .spec()
        .spindle
        .torque_curve
        .iter()
        .take_while(|point| point.torque_nm >= 0.999 * motor.curve.torque_nm(0.0))
        .map(|point| point.speed_rpm)
        .fold(0.0, f64::max);
    let max_rpm = machine.spec().spindle.max_rpm;
    let at_top = motor.acceleration_rev_per_s2(rev_per_s_from_rpm(max_rpm), share);
    let down = |value: f64, scale: f64| (value * scale + 1e-9).floor() / scale;
    let parameters = vec![
        parameter(
            Some("MD35130"),
            "$MA_GEAR_STEP_MAX_VELO_LIMIT, greatest speed of the gear stage, at least",
            format!("{top_rpm:.0}"),
            "rpm",
            "not rounded: the advice's own S",
            SIEMENS_SPEED,
        ),
        parameter(
            Some("MD35210"),
            "$MA_GEAR_STEP_POSCTRL_ACCEL, acceleration under position control (MD35212 of the second data set for tapping)",
            format!("{}", down(most, 10.0)),
            "rev/s²",
            "rounded down to a tenth, so that it never asks more than the motor",
            SIEMENS_SPINDLE,
        ),
        parameter(
            Some("MD35220"),
            "$MA_ACCEL_REDUCTION_SPEED_POINT, where the reduction begins, share of the greatest speed",
            format!("{}", down(knee_rpm / max_rpm, 1000.0)),
            "",
            "rounded down to a thousandth, so that it begins earlier",
            SIEMENS_KNEE,
        ),
        parameter(
            Some("MD35230"),
            "$MA_ACCEL_REDUCTION_FACTOR, what is taken off at the greatest speed: 1 less a_red/a_max",
            format!("{}", 1.0 - down(at_top / most, 1000.0)),
            "",
            "rounded up to a thousandth, so that it never asks more than the motor",
            SIEMENS_KNEE,
        ),
    ];
    let notes = vec![
        "Set the kind of reduction to 1, hyperbolic: the manual that was found does not tell the number of that machine data.",
        "The manual gives the knee's formula for axes, by $MA_MAX_AX_VELO and $MA_MAX_AX_ACCEL; check on your control that the \
         spindle's own values take their place.",
    ];
    (parameters, notes)
}

/// Three zones, each with its own time.
fn mitsubishi(machine: &Machine, share: f64) -> Sheet {
    const NUMBERS: [(&str, &str, &str, &str); ZONES] = [
        ("#3013", "S1, tap rotation speed (gear 00; to #3016)", "#3017", "T1, tap time constant (gear 00; to #3020)"),
        ("#3037", "S2, changeover speed 2 (gear 00; to #3040)", "#3041", "T2, changeover time constant 2 (to #3044)"),
        ("#3005", "Smax, greatest speed (gear 00; to #3008)", "#3045", "T3, changeover time constant 3 (to #3048)"),
    ];
    let max_rpm = machine.spec().spindle.max_rpm;
    let task = TuneTask::new(machine.motor().clone(), max_rpm, share, &STROKES_REV);
    let bands = task.and_then(|task| task.best(ZONES)).map(|found| found.bands).unwrap_or_default();
    let mut below_rpm = 0.0;
    let mut parameters = Vec::new();
    for (band, (speed, speed_name, time, time_name)) in bands.iter().zip(NUMBERS) {
        let top = format!("{:.0}", band.to_rpm);
        parameters.push(parameter(Some(speed), speed_name, top, "rpm", "rounded to whole rpm", MITSUBISHI));
        let seconds = (band.to_rpm - below_rpm) / band.rate_rpm_per_s;
        parameters.push(parameter(Some(time), time_name, slower_ms(seconds), "ms", SLOWER, MITSUBISHI));
        below_rpm = band.to_rpm;
    }
    let notes = vec![
        "Each time is that of its own zone; the page draws T1 to T3 and does not say their unit: compare with the parameter screen.",
    ];
    (parameters, notes)
}

/// This project's component; LinuxCNC has no law for the spindle itself.
fn component(machine: &Machine, advice: &Advice, share: f64) -> Sheet {
    let motor = machine.motor();
    let at_rest = acceleration_rpm_per_s(motor, 0.0, 1.0);
    let rated = machine.spec().spindle.torque_curve.get(1).map_or(0.0, |point| point.speed_rpm);
    let max_rpm = machine.spec().spindle.max_rpm;
    let jerk = machine.spec().law.torque_curve_smooth.jerk_rpm_per_s2;
    let exact = "not rounded: the machine file's";
    let parameters = vec![
        parameter(
            Some("accel-rpm-per-s"),
            "at standstill, all torque",
            format!("{at_rest:.0}"),
            "rpm/s",
            "rounded to whole rpm/s",
            COMPONENT,
        ),
        parameter(
            Some("rated-rpm"),
            "up to which the torque is constant",
            format!("{rated:.0}"),
            "rpm",
            exact,
            COMPONENT,
        ),
        parameter(Some("max-rpm"), "greatest speed", format!("{max_rpm:.0}"), "rpm", exact, COMPONENT),
        parameter(
            Some("share"),
            "utilisation of the motor",
            format!("{share}"),
            "",
            "not rounded: the advice's own",
            COMPONENT,
        ),
        parameter(
            Some("law"),
            "as in rigidtap.h",
            advice.law.name().to_owned(),
            "",
            "not rounded: the advice's own",
            COMPONENT,
        ),
        parameter(Some("jerk-rpm-per-s2"), "of torque-curve-smooth", format!("{jerk:.0}"), "rpm/s²", exact, COMPONENT),
    ];
    let notes = vec![
        "LinuxCNC itself has no law for the spindle: these are pins of the rigidtap component.",
        "The component's compensation is none or paper: ask for advice with --compensation none to see what holds with it.",
    ];
    (parameters, notes)
}
