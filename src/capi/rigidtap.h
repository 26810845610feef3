/* Rigid tapping for a CNC kernel in C or C++: spindle and Z held together through a hole.
 *
 * Build:  cargo rustc --release --lib --no-default-features --features capi --crate-type staticlib \
 *             --config 'profile.release.panic="abort"'
 * and link target/release/librigidtap.a with -Wl,--gc-sections. It needs nothing but memcpy, memmove, memset and memcmp.
 *
 * All state is the caller's, of fixed size; nothing allocates, locks or waits. A pointer is valid and aligned, or null
 * (RIGIDTAP_NULL); `fault` may be null. A function that does not return RIGIDTAP_OK leaves what it was given as it was.
 * One state is used from one thread at a time; different states are independent.
 *
 * Units: mm, rev, s; rpm for speeds of the spindle. Z falls into the hole; the spindle is positive as M03 turns.
 *
 * Order: rigidtap_check_version; rigidtap_machine_reference, change what differs, rigidtap_machine_init; for each hole
 * rigidtap_tap_plan (outside the period), rigidtap_tap_observe and rigidtap_tap_note_commanded each period
 * of the approach, rigidtap_tap_start,
 * rigidtap_tap_step each period until RIGIDTAP_DONE, and rigidtap_tap_observe again. A host that does not observe goes on from
 * Z's last setpoint; the machine is then measured in the holes alone.
 *
 * ABI: the layout of every struct and the number of every enumerator stay within one RIGIDTAP_API_VERSION; rigidtap_check_version
 * compares them. A library of another version does not read a state of this one. Rust 1.95 or newer builds it.
 *
 * MIT OR Apache-2.0
 */
#ifndef RIGIDTAP_H
#define RIGIDTAP_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define RIGIDTAP_API_VERSION 3u

/* How a call ended. */
typedef int32_t rigidtap_status;
enum {
    RIGIDTAP_OK = 0,
    RIGIDTAP_NULL = 1,                   /* a pointer is null */
    RIGIDTAP_NOT_INITIALISED = 2,        /* the state was never initialised, or by another version */
    RIGIDTAP_VERSION = 3,                /* header and library are of different versions */
    RIGIDTAP_MACHINE_OUT_OF_RANGE = 10,  /* fault: key, found, limit */
    RIGIDTAP_MACHINE_TORQUE_CURVE = 11,  /* from 0 rpm, rising, two equal torques first, reaching the greatest speed */
    RIGIDTAP_MACHINE_CONTRADICTION = 12, /* fault: key, found, limit */
    RIGIDTAP_UNKNOWN_CHOICE = 20,        /* a number names no law, hand or compensation */
    RIGIDTAP_NO_STROKE = 21,             /* the bottom (found) is not below the R plane (limit) */
    RIGIDTAP_INVALID = 22,               /* found has to be positive and finite */
    RIGIDTAP_SPINDLE_TOO_FAST = 23,      /* rpm */
    RIGIDTAP_PITCH_TOO_FAST = 24,        /* mm/s that Z would need, and its limit */
    RIGIDTAP_PITCH_TOO_SHARP = 25,       /* mm/s2 that Z would need, and its limit */
    RIGIDTAP_NO_PROFILE = 26,            /* the law has no profile for a stroke */
    RIGIDTAP_TOO_MANY_PECKS = 27,        /* found, limit */
    RIGIDTAP_NOT_IN_TURN = 30,           /* not planned, not started, started already, or a hole is under way */
    RIGIDTAP_NOT_STOPPED = 31,           /* retract and resume want a stopped hole */
    RIGIDTAP_ALARM_LATCHED = 32,         /* acknowledge first; of acknowledge itself: the axes still move */
    RIGIDTAP_HOLE_FAILED = 33,           /* an alarm ended the hole: it can only be retracted */
    RIGIDTAP_RECORD_DAMAGED = 50,        /* the record's sum, and that of its bytes */
    RIGIDTAP_RECORD_VERSION = 51,        /* the record's, and this library's */
    RIGIDTAP_RECORD_MACHINE = 52,        /* the record is of a machine with other data */
    RIGIDTAP_SAMPLE_INVALID = 53,        /* of spindle or Z, after the restart */
    RIGIDTAP_NOT_IN_HOLE = 54,           /* mm that Z stands below R: the tap is out */
    RIGIDTAP_OFF_HELIX = 55,             /* um by which Z leads the hole's helix, and the most that is retracted */
    RIGIDTAP_NO_ROOM = 56                /* bytes that there are, and bytes that it takes */
};

/* The numbers of a refusal; all zero with RIGIDTAP_OK. */
typedef struct rigidtap_fault {
    double found;
    double limit;
    char key[64]; /* the machine file's key, "spindle.max_rpm"; empty where the machine is not at fault */
} rigidtap_fault;

/* Time laws of a stroke. */
enum {
    RIGIDTAP_LAW_TORQUE_CURVE = 0, /* the data's speed bands */
    RIGIDTAP_LAW_S_CURVE = 1,
    RIGIDTAP_LAW_LINEAR = 2,
    RIGIDTAP_LAW_TRAPEZOID_JERK = 3,
    RIGIDTAP_LAW_IMPROVED_S_CURVE = 4,
    RIGIDTAP_LAW_TORQUE_LIMIT = 5,       /* all that the torque curve, its share and friction allow: the default */
    RIGIDTAP_LAW_TORQUE_CURVE_SMOOTH = 6 /* the same with bounded jerk, jerk_rpm_per_s2 */
};

enum { RIGIDTAP_HAND_RIGHT = 0, RIGIDTAP_HAND_LEFT = 1 };

/* What of a setpoint a drive takes: spindle_takes and z_takes of the data. */
enum {
    RIGIDTAP_TAKES_TORQUE = 0,   /* position, velocity, acceleration as torque of the data's inertia or force of its mass, and
                                  * spindle_torque_nm or z_force_n on top of that */
    RIGIDTAP_TAKES_VELOCITY = 1, /* position, and the velocity as feedforward: CiA 402's velocity offset */
    RIGIDTAP_TAKES_POSITION = 2, /* position alone: step/dir, CSP without offsets */
    RIGIDTAP_TAKES_SPEED = 3     /* speed alone, without a position loop: a frequency converter; of the spindle only */
};

/* How e(k) is kept small. FULL commands both axes by the machine as it is known. A drive that takes less than all of a setpoint
 * is sent what its own loops make the same of; the commanded motion is what is bounded, and a position may lead it by speed over
 * gain. What the drives report in rigidtap_feedback makes it better, and is asked for by `identify`. */
enum {
    RIGIDTAP_COMPENSATION_NONE = 0,
    RIGIDTAP_COMPENSATION_PAPER = 1, /* each period Z is corrected by a share of e(k) */
    RIGIDTAP_COMPENSATION_FULL = 2
};

/* Where in the hole a period lies. */
enum {
    RIGIDTAP_POSITIONING = 0, /* of a block: X, Y and Z on their way */
    RIGIDTAP_SETTLING = 1,    /* spindle and Z come into position at R, before or after the hole */
    RIGIDTAP_SYNCHRONOUS = 2, /* on its strokes */
    RIGIDTAP_BRAKING = 3,     /* stopped: spindle and Z brake together */
    RIGIDTAP_HOLDING = 4,     /* stopped: at rest in the thread */
    RIGIDTAP_RETRACTING = 5,  /* on the way back to R */
    RIGIDTAP_DONE = 6,        /* Z is free, the spindle at rest */
    RIGIDTAP_HELD = 7,        /* an alarm is latched, both axes rest: held until it is acknowledged, then HOLDING in a hole */
    RIGIDTAP_SYNCHRONOUS_STOP = 8, /* an alarm: the spindle brakes with what torque there is, Z goes with it */
    RIGIDTAP_MODEL_STOP = 9,       /* an alarm: an encoder or the clock is not trusted, both axes brake on the plan */
    RIGIDTAP_Z_LOST = 10           /* an alarm: Z does not follow, the spindle brakes as hard as it can */
};

enum { RIGIDTAP_STROKE_NONE = 0, RIGIDTAP_STROKE_IN = 1, RIGIDTAP_STROKE_DWELL = 2, RIGIDTAP_STROKE_OUT = 3 };

enum { RIGIDTAP_AXIS_NONE = 0, RIGIDTAP_AXIS_SPINDLE = 1, RIGIDTAP_AXIS_Z = 2 };

/* Alarms: `rigidtap check --explain A112` tells one. */
enum {
    RIGIDTAP_ALARM_NONE = 0,
    RIGIDTAP_ALARM_SAMPLE_LOST = 101,            /* periods without a sample, and the most that are bridged */
    RIGIDTAP_ALARM_COUNT_JUMP = 102,             /* travel in one period, and the most there can be; rev or mm */
    RIGIDTAP_ALARM_ENCODER_FROZEN = 103,         /* counts expected of an encoder that stood still */
    RIGIDTAP_ALARM_TRAVEL_MISMATCH = 104,        /* an encoder counts backwards or off its scale; rev or mm */
    RIGIDTAP_ALARM_SPINDLE_FOLLOWING = 105,      /* rev; or its drive is not ready, periods */
    RIGIDTAP_ALARM_Z_FOLLOWING = 106,            /* mm; or its drive is not ready, periods */
    RIGIDTAP_ALARM_SYNCHRONISATION_ERROR = 107,  /* e(k), um */
    RIGIDTAP_ALARM_JAM = 108,                    /* rpm by which the spindle lags */
    RIGIDTAP_ALARM_TAP_BROKEN = 109,             /* N m */
    RIGIDTAP_ALARM_EFFORT_IMPLAUSIBLE = 110,     /* N m or N */
    RIGIDTAP_ALARM_CLOCK = 111,                  /* s from one period to the next */
    RIGIDTAP_ALARM_NOT_IN_POSITION = 112         /* s waited at the start or the end of a hole */
};

typedef struct rigidtap_torque_point {
    double speed_rpm;
    double torque_nm; /* power is linear in speed between points */
} rigidtap_torque_point;

#define RIGIDTAP_MAX_TORQUE_POINTS 16

typedef struct rigidtap_speed_band {
    double to_rpm;
    double accel_s; /* time in which the whole band is crossed */
    double decel_s;
} rigidtap_speed_band;

#define RIGIDTAP_MAX_BANDS 16

/* The machine, as far as the control has to know it: the machine file's keys, each with its unit. The reference's values stand
 * where nothing better is known; `rigidtap tune --identify` measures those of Z's friction, screw and backlash. */
typedef struct rigidtap_machine_data {
    double period_s;        /* interpolation period, 1e-5 to 0.1 */
    double latency_periods; /* by which a setpoint acts late, the same on spindle and Z */
    double spindle_max_rpm;
    double spindle_inertia_kg_m2;      /* total */
    double spindle_tool_inertia_kg_m2; /* the tool's side of it */
    double spindle_coulomb_nm;
    double spindle_viscous_nm_per_rpm;
    double spindle_supply_sag_ratio; /* of the power limit, at full power */
    double spindle_torque_lag_s;     /* from commanded torque to torque */
    double spindle_counts_per_rev;
    double motor_share;     /* torque utilisation of strokes and stops, 0.01 to 1 */
    double jerk_rpm_per_s2; /* of RIGIDTAP_LAW_TORQUE_CURVE_SMOOTH */
    double s_curve_accel_rpm_per_s;
    double s_curve_jerk_rpm_per_s2;
    double linear_accel_rpm_per_s;
    double trapezoid_accel_rpm_per_s;
    double trapezoid_jerk_rpm_per_s2;
    double trapezoid_snap_rpm_per_s3;
    double improved_accel_rpm_per_s;
    double x_max_mm_per_s;
    double x_max_mm_per_s2;
    double x_max_mm_per_s3;
    double y_max_mm_per_s;
    double y_max_mm_per_s2;
    double y_max_mm_per_s3;
    double z_max_mm_per_s;
    double z_max_mm_per_s2;
    double z_max_mm_per_s3;
    double z_counts_per_mm;
    double z_motor_counts_per_mm;
    double z_mass_kg;      /* moving mass, and the rotating parts' equivalent */
    double z_table_share;  /* of it beyond the screw */
    double z_resonance_hz; /* of the table, the motor held */
    double z_torque_lag_s; /* from commanded force to force */
    double z_force_limit_n;
    double z_coulomb_n;         /* sliding friction */
    double z_static_ratio;      /* breakaway over sliding friction */
    double z_stribeck_mm_per_s; /* speed over which it falls to it */
    double z_presliding_um;     /* travel over which friction builds up */
    double z_friction_table_share;
    double z_backlash_um;
    double drive_period_s; /* of the drives' loops, a whole part of period_s */
    double spindle_position_gain_per_s;
    double spindle_velocity_gain_per_s; /* per inertia */
    double spindle_integral_s;
    double z_position_gain_per_s;
    double z_velocity_gain_per_s; /* per mass */
    double z_integral_s;
    double velocity_filter_s; /* of both drives */
    double encoder_latency_s; /* of both encoders */
    double encoder_jitter_s;
    double tap_kc_n_per_mm2; /* specific cutting force; 0 where nothing is cut */
    double tap_tool_factor;
    double tap_surface_below_r_mm;
    double tap_ramp_pitches; /* chamfer */
    double tap_out_torque_ratio;
    /* Axial force of the engaged tap along its travel, N, positive where it draws itself in; 0: not known. Holes measure it. */
    double tap_axial_n;
    double supervision_bridge_periods; /* without a sample, which the model bridges; a whole number, 1 to 50 */
    double supervision_scale_ratio;    /* by which an encoder's scale may be off */
    double tap_major_mm; /* 0: M-coarse of the hole's pitch */
    double tap_hole_mm;  /* likewise */
    double tap_bottom_clearance_mm;       /* how far Z may go below the bottom; 0: half a pitch */
    double supervision_error_limit_um;    /* greatest |e(k)|; 0: the thread's tolerance */
    double supervision_spindle_limit_rev; /* greatest tracking error; 0: that which asks for all of the torque */
    double supervision_z_limit_um;        /* likewise of Z */
    rigidtap_torque_point torque_curve[RIGIDTAP_MAX_TORQUE_POINTS];
    rigidtap_speed_band bands[RIGIDTAP_MAX_BANDS]; /* of RIGIDTAP_LAW_TORQUE_CURVE */
    uint32_t torque_points;
    uint32_t band_count;
    uint32_t law;                /* RIGIDTAP_LAW_... */
    uint32_t z_encoder_at_motor; /* not 0: no scale at the table */
    uint32_t spindle_takes;      /* RIGIDTAP_TAKES_... */
    uint32_t z_takes;            /* likewise, but no speed alone */
} rigidtap_machine_data;

/* One hole in machine coordinates. Zero everything first: then what is left out is not asked for. */
typedef struct rigidtap_hole {
    double x_mm;
    double y_mm;
    double r_plane_mm; /* where the synchronous strokes start and end */
    double bottom_mm;  /* below the R plane */
    double return_mm;  /* where Z goes after the hole */
    double pitch_mm;   /* positive */
    double speed_rpm;  /* positive */
    double out_speed_rpm; /* 0: as in */
    double dwell_s;       /* at the bottom */
    double peck_mm;       /* depth of one peck; 0: one stroke */
    double chip_break_mm; /* how far each peck goes back; 0: to the R plane */
    double start_angle_deg; /* where has_start_angle: spindle's angle at rest on R, from its encoder's zero, as M03 turns */
    uint32_t hand;         /* RIGIDTAP_HAND_... */
    uint32_t compensation; /* RIGIDTAP_COMPENSATION_... */
    uint32_t identify;     /* not 0: FULL takes what the machine has shown of itself in place of its data */
    uint32_t learn;        /* not 0: FULL learns over holes of the same kind */
    uint32_t has_start_angle; /* not 0: from start_angle_deg; 0: from where the spindle comes to rest */
    uint32_t tool;            /* tool number; learning keeps holes of different tools apart */
} rigidtap_hole;

/* Bits of `reported`: which fields a drive reports. The others are not looked at: absent is never 0. */
enum {
    RIGIDTAP_REPORTS_Z_MOTOR = 1,
    RIGIDTAP_REPORTS_SPINDLE_TORQUE = 2,
    RIGIDTAP_REPORTS_Z_FORCE = 4,
    RIGIDTAP_REPORTS_SPINDLE_SATURATED = 8, /* that bit of `status` */
    RIGIDTAP_REPORTS_Z_SATURATED = 16,
    RIGIDTAP_REPORTS_SPINDLE_DRIVE = 32, /* whether its drive is ready */
    RIGIDTAP_REPORTS_Z_DRIVE = 64
};

/* Bits of `status`. */
enum {
    RIGIDTAP_SPINDLE_INVALID = 1, /* its sample is old, or did not arrive whole */
    RIGIDTAP_Z_INVALID = 2,
    RIGIDTAP_SPINDLE_SATURATED = 4, /* its drive stood at its limit in the period */
    RIGIDTAP_Z_SATURATED = 8,
    RIGIDTAP_SPINDLE_NOT_READY = 16, /* its drive is off or tripped */
    RIGIDTAP_Z_NOT_READY = 32
};

/* What the encoders read at the start of a period, signed and unwrapped. */
typedef struct rigidtap_feedback {
    int64_t spindle_counts;
    int64_t z_counts;
    int64_t z_motor_counts;
    double spindle_torque_nm; /* the drive's mean over the last period */
    double z_force_n;         /* likewise, upwards */
    uint32_t reported;        /* RIGIDTAP_REPORTS_... */
    uint32_t status;          /* 0: both samples valid, drives ready, no limit */
} rigidtap_feedback;

typedef struct rigidtap_state {
    double position;     /* rev or mm */
    double velocity;     /* per s */
    double acceleration; /* per s2 */
} rigidtap_state;

/* What a host commands between holes, as rigidtap_setpoint has it in them. */
typedef struct rigidtap_commanded {
    rigidtap_state spindle;
    rigidtap_state z;
    double spindle_torque_nm; /* beyond the acceleration's; 0 where the drive takes none */
    double z_force_n;
} rigidtap_commanded;

/* A latched alarm. */
typedef struct rigidtap_alarm {
    double value; /* what was measured */
    double limit; /* what it broke */
    uint32_t code; /* RIGIDTAP_ALARM_..., 0 for none */
    uint32_t axis; /* RIGIDTAP_AXIS_... */
} rigidtap_alarm;

/* What a period yields: always a setpoint; an alarm stands beside it. */
typedef struct rigidtap_setpoint {
    rigidtap_state spindle;
    rigidtap_state z;
    double spindle_torque_nm; /* feedforward beyond the acceleration's; 0 unless RIGIDTAP_COMPENSATION_FULL */
    double z_force_n;         /* likewise, upwards */
    double error_mm; /* e(k) = Z travel - pitch x spindle travel of this period's feedback; 0 while settling */
    double correction_mm; /* in force on Z, positive into the hole */
    double path_rate; /* seconds of the plan per second: 1, less where time scaling slows it */
    rigidtap_alarm alarm;
    uint32_t stage;  /* RIGIDTAP_SETTLING ... RIGIDTAP_Z_LOST */
    uint32_t stroke; /* RIGIDTAP_STROKE_... */
} rigidtap_setpoint;

/* What the last hole left beside Z's setpoints, to be added to them until the next hole starts. */
typedef struct rigidtap_residual {
    rigidtap_state z;
    double z_force_n;
} rigidtap_residual;

/* What is known of the machine: as measured, else as the data say. */
typedef struct rigidtap_identified {
    double spindle_inertia_ratio; /* over the data's */
    double spindle_torque_limit_ratio;
    double spindle_drag_nm; /* beyond the data's friction */
    double z_friction_n;         /* Coulomb */
    double z_viscous_n_s_per_mm; /* beside it */
    double z_weight_n; /* that nothing balances */
    double z_lost_motion_um;
    double z_compliance_ratio; /* of the screw, over the data's */
    double z_deflection_middle_um;
    double spindle_latency_s; /* from a setpoint's period until its drive has it in force */
    double z_latency_s;
    double spindle_position_gain_per_s; /* of a drive that takes positions alone; else the data's */
    double spindle_velocity_gain_per_s;
    double z_position_gain_per_s;
    double z_velocity_gain_per_s;
    uint32_t z_middle_known; /* 0 until Z moved both ways, with z_motor_counts reported */
    uint32_t reserved;
} rigidtap_identified;

typedef struct rigidtap_counters {
    uint64_t periods;
    uint64_t invalid_samples; /* periods with one */
    uint64_t gaps;            /* periods of more than 1.5 period_s */
    uint64_t saturated_periods;
} rigidtap_counters;

/* A whole tapping block: from where the axes stand to each hole, down to R, the hole, up to its return level. */
typedef struct rigidtap_block_request {
    rigidtap_hole hole; /* the first one */
    double start_x_mm;  /* where the axes stand at rest */
    double start_y_mm;
    double start_z_mm;
    double step_x_mm; /* from hole to hole */
    double step_y_mm;
    double spindle_rpm;     /* signed: goes on until the first hole, and rests from then on */
    int64_t spindle_counts; /* now */
    uint32_t holes;         /* 1 or more */
    uint32_t reserved;      /* 0 */
} rigidtap_block_request;

/* What a period of a block yields. */
typedef struct rigidtap_axes {
    rigidtap_state spindle;
    rigidtap_state x;
    rigidtap_state y;
    rigidtap_state z;
    double spindle_torque_nm; /* as in rigidtap_setpoint */
    double z_force_n;
    double error_mm;
    double correction_mm;
    double path_rate;
    rigidtap_alarm alarm;
    uint32_t stage; /* RIGIDTAP_POSITIONING ... RIGIDTAP_Z_LOST */
    uint32_t stroke;
    uint32_t hole; /* from 0 */
    uint32_t reserved;
} rigidtap_axes;

/* What leads a tap out of a hole after a power cut: write the bytes as they are. */
typedef struct rigidtap_record { uint8_t bytes[64]; } rigidtap_record;

/* Most bytes of what holes taught: rigidtap_tap_save_learned. */
#define RIGIDTAP_LEARNED_BYTES 18156u

/* State, opaque. Copy it only while no function is called on it. */
#ifdef __GNUC__
#define RIGIDTAP_ALIGNED __attribute__((aligned(16)))
#else
#define RIGIDTAP_ALIGNED /* the host aligns the states to 16 bytes */
#endif
typedef struct rigidtap_machine { uint64_t words[1026]; } RIGIDTAP_ALIGNED rigidtap_machine;
typedef struct rigidtap_stroke { uint64_t words[514]; } RIGIDTAP_ALIGNED rigidtap_stroke;
typedef struct rigidtap_tap { uint64_t words[12290]; } RIGIDTAP_ALIGNED rigidtap_tap;
typedef struct rigidtap_block { uint64_t words[14338]; } RIGIDTAP_ALIGNED rigidtap_block;

/* RIGIDTAP_OK, or RIGIDTAP_VERSION where this header is not the library's. */
rigidtap_status rigidtap_check_version(uint32_t version, size_t machine_bytes, size_t stroke_bytes, size_t tap_bytes,
                                       size_t block_bytes, size_t data_bytes);
#define RIGIDTAP_CHECK()                                                                                         \
    rigidtap_check_version(RIGIDTAP_API_VERSION, sizeof(rigidtap_machine), sizeof(rigidtap_stroke),              \
                           sizeof(rigidtap_tap), sizeof(rigidtap_block),                                         \
                           sizeof(rigidtap_machine_data) + sizeof(rigidtap_block_request) +                      \
                               sizeof(rigidtap_feedback) + sizeof(rigidtap_setpoint) + sizeof(rigidtap_axes) +       \
                               sizeof(rigidtap_residual) + sizeof(rigidtap_identified) + sizeof(rigidtap_counters) + \
                               sizeof(rigidtap_commanded))

/* Fills in the reference machine: 20 N m, 8000 rpm, 1 ms, share 0.8. */
rigidtap_status rigidtap_machine_reference(rigidtap_machine_data *data);

/* Checks the data, once for all. RIGIDTAP_MACHINE_..., RIGIDTAP_UNKNOWN_CHOICE. */
rigidtap_status rigidtap_machine_init(rigidtap_machine *machine, const rigidtap_machine_data *data, rigidtap_fault *fault);

/* Greatest band of e(k) that a thread of this pitch bears, um, by ISO 965 or ASME B1.1; NaN for a pitch of no standard. */
double rigidtap_machine_tolerance_um(const rigidtap_machine *machine, double pitch_mm);

/* A stroke of the spindle from rest to rest. RIGIDTAP_INVALID, RIGIDTAP_SPINDLE_TOO_FAST, RIGIDTAP_NO_PROFILE. */
rigidtap_status rigidtap_stroke_plan(rigidtap_stroke *stroke, const rigidtap_machine *machine, double distance_rev,
                                     double speed_rpm, rigidtap_fault *fault);
double rigidtap_stroke_duration_s(const rigidtap_stroke *stroke); /* NaN where nothing is planned */
double rigidtap_stroke_peak_rpm(const rigidtap_stroke *stroke);   /* NaN where nothing is planned */
rigidtap_status rigidtap_stroke_at(const rigidtap_stroke *stroke, double t_s, rigidtap_state *state);

/* Plans a hole: feasible, or refused before anything moves. Takes microseconds per stroke: call it outside the period. In
 * a hole RIGIDTAP_NOT_IN_TURN, whatever the machine. What a state has measured and learned of the same machine data goes on to the
 * next hole planned in it; zero the state to forget. */
rigidtap_status rigidtap_tap_plan(rigidtap_tap *tap, const rigidtap_machine *machine, const rigidtap_hole *hole,
                                  rigidtap_fault *fault);

/* Time from the first to the last synchronous period; infinite while stopped, NaN where nothing is planned. */
double rigidtap_tap_duration_s(const rigidtap_tap *tap);

/* One period between holes, once a hole is planned: the machine is measured on its approach. `residual` may be null: then
 * nothing is left of the last hole. RIGIDTAP_NOT_IN_TURN in a hole. */
rigidtap_status rigidtap_tap_observe(rigidtap_tap *tap, double now_s, const rigidtap_feedback *feedback,
                                     rigidtap_residual *residual);

/* What was commanded for the period that rigidtap_tap_observe showed last, residual included. It says, beside the encoders, how
 * late setpoints act; a host that does not tell it leaves that to the machine data. RIGIDTAP_NOT_IN_TURN in a hole. */
rigidtap_status rigidtap_tap_note_commanded(rigidtap_tap *tap, const rigidtap_commanded *commanded);

/* Nothing of the last hole is left beside Z's setpoints: Z was moved without it, or its drive was off. */
rigidtap_status rigidtap_tap_discard_residual(rigidtap_tap *tap);

/* Starts a planned hole: Z at rest on the R plane, the spindle at whatever signed speed it turns. It is braked along the
 * torque curve, and the hole starts where it rests. RIGIDTAP_INVALID for a number that is not finite, RIGIDTAP_SPINDLE_TOO_FAST
 * for a speed more than 5 % beyond the machine's. */
rigidtap_status rigidtap_tap_start(rigidtap_tap *tap, double now_s, int64_t spindle_counts, double spindle_rpm,
                                   rigidtap_fault *fault);

/* One period: feedback of now_s in, setpoint for now_s out; now_s never falls. An alarm is a field of the setpoint, never a
 * status: with RIGIDTAP_OK there is always a setpoint to follow. */
rigidtap_status rigidtap_tap_step(rigidtap_tap *tap, double now_s, const rigidtap_feedback *feedback,
                                  rigidtap_setpoint *setpoint, rigidtap_fault *fault);

/* Controlled stop: spindle and Z brake together along the torque curve and are held, neither below the bottom nor above R.
 * Then retract brings the tap back to R in synchronism, or resume lets the hole go on; each waits for rest. */
rigidtap_status rigidtap_tap_stop(rigidtap_tap *tap, double now_s);
rigidtap_status rigidtap_tap_retract(rigidtap_tap *tap, double now_s);
rigidtap_status rigidtap_tap_resume(rigidtap_tap *tap, double now_s);

/* Forgets a latched alarm once both axes rest (RIGIDTAP_HELD); RIGIDTAP_ALARM_LATCHED while they move, and in retract and resume
 * until it is called. A hole that an alarm ended can then be retracted, not resumed (RIGIDTAP_HOLE_FAILED); one that waited to be
 * in position waits anew. */
rigidtap_status rigidtap_tap_acknowledge(rigidtap_tap *tap);

/* Gives up the hole under way: both axes are the host's from now on, at rest or not. What was measured stays. */
rigidtap_status rigidtap_tap_release(rigidtap_tap *tap);

rigidtap_status rigidtap_tap_identified(const rigidtap_tap *tap, rigidtap_identified *identified);
rigidtap_status rigidtap_tap_counters(const rigidtap_tap *tap, rigidtap_counters *counters);

/* Power loss. From a hole's first synchronous period to its end there is a record, which the host keeps where it outlives the
 * power; else RIGIDTAP_NOT_IN_TURN. It takes absolute encoders: the spindle's within one turn, since Z tells which turn it is.
 * z_offset_counts: what Z's absolute encoder has beside the counts of the hole's feedback, 0 where they are the same. */
rigidtap_status rigidtap_tap_record(const rigidtap_tap *tap, int64_t z_offset_counts, rigidtap_record *record);
rigidtap_status rigidtap_block_record(const rigidtap_block *block, int64_t z_offset_counts, rigidtap_record *record);

/* After the restart, both axes at rest and held: plans the way out by the record and what the encoders read, at a speed, or at
 * that of the stroke out (0). Refused with numbers where angle and Z are not on the hole's helix (RIGIDTAP_OFF_HELIX, and
 * RIGIDTAP_RECORD_DAMAGED to RIGIDTAP_NOT_IN_HOLE). Then rigidtap_tap_start, whose spindle does not count, and rigidtap_tap_step:
 * RIGIDTAP_HOLDING until rigidtap_tap_retract. It is not resumed (RIGIDTAP_HOLE_FAILED). */
rigidtap_status rigidtap_tap_plan_retract(rigidtap_tap *tap, const rigidtap_machine *machine, const rigidtap_record *record,
                                          const rigidtap_feedback *feedback, double speed_rpm, uint32_t compensation,
                                          rigidtap_fault *fault);

/* What holes taught (`learn` under compensation full), kept over a restart: between holes save writes it to the caller's bytes,
 * RIGIDTAP_LEARNED_BYTES are enough, and tells how many it wrote; the host writes these to a file of its own outside the period.
 * After a restart load takes them into a state in which a hole or block is planned, in place of what it knows. The bytes have a
 * version and a sum, and are of one machine: RIGIDTAP_RECORD_DAMAGED, RIGIDTAP_RECORD_VERSION, RIGIDTAP_RECORD_MACHINE (drives,
 * spindle, Z or [sync] have other data), RIGIDTAP_INVALID, RIGIDTAP_NO_ROOM, and nothing has changed. In a hole
 * RIGIDTAP_NOT_IN_TURN. Takes a millisecond: call it outside the period. */
rigidtap_status rigidtap_tap_save_learned(const rigidtap_tap *tap, uint8_t *bytes, uint64_t size, uint64_t *written,
                                          rigidtap_fault *fault);
rigidtap_status rigidtap_tap_load_learned(rigidtap_tap *tap, const uint8_t *bytes, uint64_t size, rigidtap_fault *fault);
rigidtap_status rigidtap_block_save_learned(const rigidtap_block *block, uint8_t *bytes, uint64_t size, uint64_t *written,
                                            rigidtap_fault *fault);
rigidtap_status rigidtap_block_load_learned(rigidtap_block *block, const uint8_t *bytes, uint64_t size,
                                            rigidtap_fault *fault);

/* A whole block, likewise: planned outside the period, then stepped each period until RIGIDTAP_DONE, and while Z rests there:
 * under compensation full some force decays. Between holes a stop lets the axes end their move; retract then ends the block on
 * the return level. A plan is refused as rigidtap_tap_start refuses, and in a hole with RIGIDTAP_NOT_IN_TURN. A block planned in the state of an earlier one of the same machine data goes on with what that one measured
 * and learned. */
rigidtap_status rigidtap_block_plan(rigidtap_block *block, const rigidtap_machine *machine,
                                    const rigidtap_block_request *request, rigidtap_fault *fault);
rigidtap_status rigidtap_block_step(rigidtap_block *block, double now_s, const rigidtap_feedback *feedback,
                                    rigidtap_axes *axes, rigidtap_fault *fault);
rigidtap_status rigidtap_block_stop(rigidtap_block *block, double now_s);
rigidtap_status rigidtap_block_retract(rigidtap_block *block, double now_s);
rigidtap_status rigidtap_block_resume(rigidtap_block *block, double now_s);
rigidtap_status rigidtap_block_acknowledge(rigidtap_block *block);
rigidtap_status rigidtap_block_release(rigidtap_block *block);
rigidtap_status rigidtap_block_identified(const rigidtap_block *block, rigidtap_identified *identified);
rigidtap_status rigidtap_block_counters(const rigidtap_block *block, rigidtap_counters *counters);

#ifdef __cplusplus
}
#endif

#endif
