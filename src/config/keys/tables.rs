//! The tables of the machine file, in the order in which they are written.

/// One table of the file.
#[derive(Debug)]
pub(in crate::config) struct Table {
    /// The header without its brackets.
    pub(in crate::config) path: &'static str,
    /// What it holds.
    pub(in crate::config) about: &'static str,
}

const fn table(path: &'static str, about: &'static str) -> Table {
    Table { path, about }
}

/// The tables in the order in which they are written.
pub(in crate::config) static TABLES: &[Table] = &[
    table("control", "The interpolation that commands both axes."),
    table("spindle", "The spindle: motor, shaft, tool and encoder."),
    table("x", "Limits of X."),
    table("y", "Limits of Y."),
    table("z", "Limits, mechanics, friction and encoders of Z."),
    table("drive", "The drives' loops, and what the encoders deliver to them."),
    table(
        "sync",
        "The synchronizer's gains under compensation = full, by the rules of `rigidtap tune --gains`. A file without them\n\
         keeps those of the reference machine.",
    ),
    table("supervision", "Limits of the alarms; one that is left out follows from this file's other tables."),
    table(
        "actual",
        "How the real machine differs from this file. Only the simulated plant reads it: never the planner, the\n\
         synchronizer or tune, which may measure it.",
    ),
    table(
        "spread",
        "How machines of this kind differ: for each key of [actual] the least and the greatest value, [low, high]. A\n\
         sweep draws each evenly between them, independent of the others; [1, 1] keeps a factor as this file says.\n\
         What some machines have is { any = [low, high], ratio = 0.05 }, a choice { one_of = [10, 16] }.",
    ),
    table(
        "spread.hard",
        "The same for what real machines have beside that and [actual] leaves out by default: `sweep --hard` draws\n\
         these, too.",
    ),
    table("law", "Time laws of the synchronous stroke. What is left out follows from the motor at motor_share."),
    table("law.torque_curve", "The segmented approximation of the motor's torque curve."),
    table("law.s_curve", "The conventional S-curve, one acceleration at all speeds."),
    table("law.linear", "The papers' baseline: one acceleration, no jerk limit."),
    table("law.torque_curve_smooth", "The motor's torque curve at motor_share, with bounded jerk."),
    table("law.trapezoid_jerk", "Fifteen phases: jerk, too, rises and falls steadily."),
    table(
        "law.improved_s_curve",
        "Ten phases: no constant acceleration, the cusp rounded; the jerk follows from the change of speed.",
    ),
    table("gcode", "How programs are read."),
    table("tap", "Tap and work piece: the torque that cutting takes."),
    table("tolerance", "What the verdict is judged by."),
];

pub(in crate::config) fn find_table(path: &str) -> Option<&'static Table> {
    TABLES.iter().find(|table| table.path == path)
}
