//! What each alarm means, why it comes, what the control does, and what a user can do.

/// The text of a code; none for a number that no alarm has.
pub(super) const fn of(code: u32) -> Option<&'static str> {
    Some(match code {
        101 => SAMPLE_LOST,
        102 => COUNT_JUMP,
        103 => ENCODER_FROZEN,
        104 => TRAVEL_MISMATCH,
        105 => SPINDLE_FOLLOWING,
        106 => Z_FOLLOWING,
        107 => SYNCHRONISATION_ERROR,
        108 => JAM,
        109 => TAP_BROKEN,
        110 => EFFORT,
        111 => CLOCK,
        112 => NOT_IN_POSITION,
        _ => return None,
    })
}

const SAMPLE_LOST: &str = "A101: sample lost\n\n\
    An encoder's sample was marked as invalid, or the same frame came again, for longer than [supervision] bridge_periods.\n\
    Up to there a model of the axis stands in, and nothing is lost.\n\n\
    What the control does: spindle and Z brake together on the plan, Z follows the planned spindle.\n\n\
    Why it comes: a bus that drops frames, a loose connector, an encoder's own alarm bit.\n\n\
    What to do: look at the bus' error counters and the encoder's cable. Acknowledge at rest, and retract.\n";

const COUNT_JUMP: &str = "A102: count jump\n\n\
    An encoder's count moved further in one period than torque and inertia, or force and mass, can move its axis. The count\n\
    that jumped is never used.\n\n\
    What the control does: spindle and Z brake together on the plan.\n\n\
    Why it comes: a counter that wraps and is not unwrapped, an index that resets it, a bit flipped on the way.\n\n\
    What to do: unwrap counters to 64 bits (CountUnwrapper does it), switch off the index reset. Acknowledge at rest; the\n\
    axis is then taken to stand where the plan stopped it.\n";

const ENCODER_FROZEN: &str = "A103: encoder frozen\n\n\
    An encoder counted nothing in at least three periods in which its axis was commanded to move eight counts or more,\n\
    beyond what friction and backlash may hold.\n\n\
    What the control does: spindle and Z brake together on the plan.\n\n\
    Why it comes: an unplugged encoder, a driver that does not update its sample, a coupling that slips.\n\n\
    What to do: turn the axis by hand and watch the count. Where the drive has lost the encoder, too, it drives its axis away\n\
    with all it has, whatever it is told: a host takes its enable away at this alarm.\n";

const TRAVEL_MISMATCH: &str = "A104: direction or scale\n\n\
    An encoder counts the other way round, or its travel is off: in a whole revolution by more than [supervision] scale_ratio\n\
    and the axis' limit of its tracking error; of the spindle by more than its drive explains, which would push, were the\n\
    spindle where the encoder says; of Z by what a correction hides, once that passes the limit of e(k).\n\n\
    What the control does: spindle and Z brake together on the plan. The encoder is not followed any more.\n\n\
    Why it comes: counts per revolution or per mm in the machine file that are not the encoder's, A and B swapped, a belt or\n\
    gear between encoder and spindle.\n\n\
    What to do: turn the spindle by one revolution, move Z by 10 mm, and compare the counts with the machine file.\n";

const SPINDLE_FOLLOWING: &str = "A105: spindle tracking error, or its drive not ready\n\n\
    The spindle was further from its command than [supervision] spindle_limit_rev, or its drive reported not ready, for three\n\
    periods; or the drive gives nothing where it is told to push, or another torque than its axis' error asks for.\n\n\
    What the control does: synchronous stop. The spindle brakes with what torque there is, and Z follows the measured spindle.\n\n\
    Why it comes: a drive that tripped, a motor weaker than its torque curve in the machine file.\n\n\
    What to do: read the drive's own fault. Where the motor is weak, lower the torque utilisation (--share) or the speed.\n\
    Acknowledge at rest, and retract.\n";

const Z_FOLLOWING: &str = "A106: Z following error, or its drive not ready\n\n\
    Z was further from its command than [supervision] z_limit_um, or its drive reported not ready, for three periods.\n\n\
    What the control does: Z is lost, so the spindle brakes at once and as hard as it can.\n\n\
    Why it comes: a drive that tripped, a table that touches something, a brake that closed.\n\n\
    What to do: the thread and perhaps the tap are damaged. Look before anything moves; free the tap by hand where Z's drive\n\
    stays off.\n";

const SYNCHRONISATION_ERROR: &str = "A107: synchronisation error\n\n\
    e(k) passed [supervision] error_limit_um, by default the thread's tolerance.\n\n\
    What the control does: synchronous stop. Both axes brake, Z with the spindle.\n\n\
    Why it comes: friction, backlash or a latency that the machine file does not tell; something pushed an axis; without\n\
    compensation also a motor that is too weak.\n\n\
    What to do: acknowledge at rest, retract, and gauge the thread. A dry cycle shows the control what the file lacks.\n";

const JAM: &str = "A108: tap jammed\n\n\
    The spindle fell behind its command faster than its motor alone explains, or its torque stood at the limit while its\n\
    speed fell.\n\n\
    What the control does: synchronous stop, and both axes are held.\n\n\
    Why it comes: chips wedge the tap, the core hole is too small or too shallow, the tap is blunt.\n\n\
    What to do: acknowledge, and retract: the tap turns back with the thread. Then look at tap and hole.\n";

const TAP_BROKEN: &str = "A109: tap broken\n\n\
    On the way in the cutting torque stayed under 0.3 of what earlier holes of the same kind took. It is a warning on the\n\
    hole; a block and a program stop after it. Two holes of a kind are tapped before one is judged, by the torque that\n\
    the drive reports: of the strokes in, less that of the strokes out.\n\n\
    Why it comes: the tap broke or is gone, the core hole is missing or bored too large.\n\n\
    What to do: look at the tap.\n";

const EFFORT: &str = "A110: implausible torque or force\n\n\
    A drive reported an effort that is no number, or more than it can give, three times in a row. Single ones are dropped and\n\
    counted.\n\n\
    What the control does: synchronous stop.\n\n\
    Why it comes: a wrong scale (per mille of rated torque, N·cm), a field of the bus that is not mapped.\n\n\
    What to do: compare the drive's own display with what the host reports.\n";

const CLOCK: &str = "A111: clock\n\n\
    The time that the host passes in fell, is no number, or left out more periods than [supervision] bridge_periods.\n\n\
    What the control does: spindle and Z brake together on the plan, on the control's own time.\n\n\
    Why it comes: a host that was held up for long, a clock that was set, a time in ms where s are asked.\n\n\
    What to do: pass in a monotonic clock, in seconds.\n";

const NOT_IN_POSITION: &str = "A112: not in position\n\n\
    Before a hole, spindle and Z have to stand within 0.001 rev and 2 um of where they are to rest, for 10 ms; after it the\n\
    spindle within 0.01 rev and Z within 50 um. Within 3 s they did not.\n\n\
    Why it comes: a drive is off, an axis is held by friction that its drive does not overcome, the spindle lost its command\n\
    in the hole and still turns, or an encoder's scale is not what the machine file says.\n\n\
    What to do: look which axis it is and how far it is off. Where the spindle was at its torque limit, lower the torque\n\
    utilisation (--share) or the speed. Both axes are held until the alarm is acknowledged.\n";
