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
 * rigidtap_tap_plan (outside the period), rigidtap_tap_start, rigidtap_tap_step each period until RIGIDTAP_DONE. From there Z
 * goes on from its last setpoint; under compensation full that still has some force, which is to fade and not to be dropped.
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

#define RIGIDTAP_API_VERSION 2u

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
    RIGIDTAP_NOT_IN_TURN = 30,           /* not planned, not started, or started already */
    RIGIDTAP_NOT_STOPPED = 31,           /* retract and resume want a stopped hole */
    RIGIDTAP_NOT_IN_POSITION = 40        /* alarm: spindle (found, rev) or Z (limit, mm) off its rest; hold the last setpoint */
};

/* The numbers of a refusal; all zero with RIGIDTAP_OK. */
typedef struct rigidtap_fault {
    double found;
    double limit;
    char key[64]; /* the machine file's key, "spindle.max_rpm"; empty where the machine is not at fault */
} rigidtap_fault;

/* Time laws of a stroke. */
enum {
    RIGIDTAP_LAW_TORQUE_CURVE = 0, /* the reference machine's speed bands, whatever the motor: for comparison */
    RIGIDTAP_LAW_S_CURVE = 1,
    RIGIDTAP_LAW_LINEAR = 2,
    RIGIDTAP_LAW_TRAPEZOID_JERK = 3,
    RIGIDTAP_LAW_IMPROVED_S_CURVE = 4,
    RIGIDTAP_LAW_TORQUE_LIMIT = 5,       /* all that the torque curve, its share and friction allow: the default */
    RIGIDTAP_LAW_TORQUE_CURVE_SMOOTH = 6 /* the same with bounded jerk, jerk_rpm_per_s2 */
};

enum { RIGIDTAP_HAND_RIGHT = 0, RIGIDTAP_HAND_LEFT = 1 };

/* How e(k) is kept small. FULL commands both axes by the machine as it is known, and needs of the drives of spindle and Z:
 * position, velocity and acceleration of each setpoint, the last as torque of the data's inertia and force of its mass;
 * spindle_torque_nm and z_force_n on top of that; and the data of the machine that are marked so. What the drives report in
 * rigidtap_feedback makes it better, and is asked for by `identify`. Drives that take no torque and force: NONE or PAPER. */
enum {
    RIGIDTAP_COMPENSATION_NONE = 0,
    RIGIDTAP_COMPENSATION_PAPER = 1, /* each period Z is corrected by a share of e(k) */
    RIGIDTAP_COMPENSATION_FULL = 2
};

/* Where in the hole a period lies. */
enum {
    RIGIDTAP_POSITIONING = 0, /* of a block: X, Y and Z on their way */
    RIGIDTAP_SETTLING = 1,    /* spindle and Z come to rest at R, before or after the hole */
    RIGIDTAP_SYNCHRONOUS = 2, /* on its legs */
    RIGIDTAP_BRAKING = 3,     /* stopped: spindle and Z brake together */
    RIGIDTAP_HOLDING = 4,     /* stopped: at rest in the thread */
    RIGIDTAP_RETRACTING = 5,  /* on the way back to R */
    RIGIDTAP_DONE = 6         /* Z is free, the spindle at rest */
};

enum { RIGIDTAP_LEG_NONE = 0, RIGIDTAP_LEG_IN = 1, RIGIDTAP_LEG_DWELL = 2, RIGIDTAP_LEG_OUT = 3 };

typedef struct rigidtap_torque_point {
    double speed_rpm;
    double torque_nm; /* power is linear in speed between points */
} rigidtap_torque_point;

#define RIGIDTAP_MAX_TORQUE_POINTS 16

/* The machine, as far as the control has to know it: the machine file's keys. */
typedef struct rigidtap_machine_data {
    double period_s;        /* interpolation period, 1e-5 to 0.1 */
    double latency_periods; /* by which a setpoint acts late, the same on spindle and Z */
    double spindle_max_rpm;
    double spindle_inertia_kg_m2;
    double spindle_coulomb_nm;
    double spindle_viscous_nm_per_rpm;
    double spindle_counts_per_rev;
    rigidtap_torque_point torque_curve[RIGIDTAP_MAX_TORQUE_POINTS];
    uint32_t torque_points;
    uint32_t law;           /* RIGIDTAP_LAW_... */
    double motor_share;     /* of the motor's torque that strokes and stops use, 0.01 to 1 */
    double jerk_rpm_per_s2; /* of RIGIDTAP_LAW_TORQUE_CURVE_SMOOTH */
    double z_max_mm_per_s;
    double z_max_mm_per_s2;
    double z_max_mm_per_s3;
    double z_counts_per_mm;
    double xy_max_mm_per_s;
    double xy_max_mm_per_s2;
    double xy_max_mm_per_s3;
    /* Of RIGIDTAP_COMPENSATION_FULL alone; else leave the reference's. */
    double spindle_torque_lag_s; /* from commanded torque to torque */
    double spindle_position_gain_per_s;
    double z_mass_kg;      /* moving mass, and the rotating parts' equivalent */
    double z_resonance_hz; /* of the table, the motor held */
    double z_torque_lag_s; /* from commanded force to force */
    double z_coulomb_n;    /* sliding friction */
    double z_backlash_um;
    double z_motor_counts_per_mm;
    double z_position_gain_per_s;
    double z_velocity_gain_per_s; /* per z_mass_kg */
    double velocity_filter_s;     /* of both drives */
    double encoder_latency_s;     /* of both encoders */
    double tap_kc_n_per_mm2;      /* specific cutting force; 0 where nothing is cut */
    double tap_surface_below_r_mm;
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
    uint32_t hand;         /* RIGIDTAP_HAND_... */
    uint32_t compensation; /* RIGIDTAP_COMPENSATION_... */
    uint32_t identify;     /* not 0: FULL takes what the machine has shown of itself in place of its data */
    uint32_t learn;        /* not 0: FULL learns over holes of the same kind */
} rigidtap_hole;

/* What the encoders read at the start of a period, signed and unwrapped. */
typedef struct rigidtap_feedback {
    int64_t spindle_counts;
    int64_t z_counts;
    int64_t z_motor_counts;    /* 0 where the drive does not tell */
    double spindle_torque_nm;  /* the drive's mean over the last period; 0 where it does not tell */
    double z_force_n;          /* likewise, upwards */
    uint32_t torque_saturated; /* not 0: the spindle's drive stood at its limit in the period */
    uint32_t reserved;         /* 0 */
} rigidtap_feedback;

typedef struct rigidtap_state {
    double position;     /* rev or mm */
    double velocity;     /* per s */
    double acceleration; /* per s2 */
} rigidtap_state;

/* What a period yields. */
typedef struct rigidtap_setpoint {
    rigidtap_state spindle;
    rigidtap_state z;
    double spindle_torque_nm; /* feedforward beyond the acceleration's; 0 unless RIGIDTAP_COMPENSATION_FULL */
    double z_force_n;         /* likewise, upwards */
    double error_mm; /* e(k) = Z travel - pitch x spindle travel of this period's feedback; 0 while settling */
    double correction_mm; /* in force on Z, positive into the hole */
    uint32_t stage;       /* RIGIDTAP_SETTLING ... RIGIDTAP_DONE */
    uint32_t leg;         /* RIGIDTAP_LEG_... */
} rigidtap_setpoint;

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
    uint32_t stage; /* RIGIDTAP_POSITIONING ... RIGIDTAP_DONE */
    uint32_t leg;
    uint32_t hole; /* from 0 */
    uint32_t reserved;
} rigidtap_axes;

/* State, opaque. Copy it only while no function is called on it. */
#ifdef __GNUC__
#define RIGIDTAP_ALIGNED __attribute__((aligned(16)))
#else
#define RIGIDTAP_ALIGNED /* the host aligns the states to 16 bytes */
#endif
typedef struct rigidtap_machine { uint64_t words[1026]; } RIGIDTAP_ALIGNED rigidtap_machine;
typedef struct rigidtap_stroke { uint64_t words[514]; } RIGIDTAP_ALIGNED rigidtap_stroke;
typedef struct rigidtap_tap { uint64_t words[6402]; } RIGIDTAP_ALIGNED rigidtap_tap;
typedef struct rigidtap_block { uint64_t words[10242]; } RIGIDTAP_ALIGNED rigidtap_block;

/* RIGIDTAP_OK, or RIGIDTAP_VERSION where this header is not the library's. */
rigidtap_status rigidtap_check_version(uint32_t version, size_t machine_bytes, size_t stroke_bytes, size_t tap_bytes,
                                       size_t block_bytes, size_t data_bytes);
#define RIGIDTAP_CHECK()                                                                                         \
    rigidtap_check_version(RIGIDTAP_API_VERSION, sizeof(rigidtap_machine), sizeof(rigidtap_stroke),              \
                           sizeof(rigidtap_tap), sizeof(rigidtap_block),                                         \
                           sizeof(rigidtap_machine_data) + sizeof(rigidtap_block_request) +                      \
                               sizeof(rigidtap_feedback) + sizeof(rigidtap_setpoint) + sizeof(rigidtap_axes))

/* Fills in the reference machine: 20 N m, 8000 rpm, 1 ms, share 0.8. */
rigidtap_status rigidtap_machine_reference(rigidtap_machine_data *data);

/* Checks the data, once for all. RIGIDTAP_MACHINE_..., RIGIDTAP_UNKNOWN_CHOICE. */
rigidtap_status rigidtap_machine_init(rigidtap_machine *machine, const rigidtap_machine_data *data, rigidtap_fault *fault);

/* A stroke of the spindle from rest to rest. RIGIDTAP_INVALID, RIGIDTAP_NO_PROFILE. */
rigidtap_status rigidtap_stroke_plan(rigidtap_stroke *stroke, const rigidtap_machine *machine, double distance_rev,
                                     double speed_rpm, rigidtap_fault *fault);
double rigidtap_stroke_duration_s(const rigidtap_stroke *stroke); /* NaN where nothing is planned */
double rigidtap_stroke_peak_rpm(const rigidtap_stroke *stroke);   /* NaN where nothing is planned */
rigidtap_status rigidtap_stroke_at(const rigidtap_stroke *stroke, double t_s, rigidtap_state *state);

/* Plans a hole: feasible, or refused before anything moves. Takes microseconds per stroke: call it outside the period. What
 * a state has seen and learned of the same machine data goes on to the next hole planned in it; zero the state to forget. */
rigidtap_status rigidtap_tap_plan(rigidtap_tap *tap, const rigidtap_machine *machine, const rigidtap_hole *hole,
                                  rigidtap_fault *fault);

/* Time from the first to the last synchronous period; infinite while stopped, NaN where nothing is planned. */
double rigidtap_tap_duration_s(const rigidtap_tap *tap);

/* Starts a planned hole: Z at rest on the R plane, the spindle at whatever signed speed it turns. It is braked along the
 * torque curve, and the hole starts where it rests. */
rigidtap_status rigidtap_tap_start(rigidtap_tap *tap, double now_s, int64_t spindle_counts, double spindle_rpm,
                                   rigidtap_fault *fault);

/* One period: feedback of now_s in, setpoint for now_s out; now_s never falls. On an alarm hold the last setpoint. */
rigidtap_status rigidtap_tap_step(rigidtap_tap *tap, double now_s, const rigidtap_feedback *feedback,
                                  rigidtap_setpoint *setpoint, rigidtap_fault *fault);

/* Controlled stop: spindle and Z brake together along the torque curve and are held, neither below the bottom nor above R.
 * Then retract brings the tap back to R in synchronism, or resume lets the hole go on; each waits for rest. */
rigidtap_status rigidtap_tap_stop(rigidtap_tap *tap, double now_s);
rigidtap_status rigidtap_tap_retract(rigidtap_tap *tap, double now_s);
rigidtap_status rigidtap_tap_resume(rigidtap_tap *tap, double now_s);

/* A whole block, likewise: planned outside the period, then stepped each period until RIGIDTAP_DONE, and while Z rests there:
 * under compensation full some force fades. Between holes a stop lets
 * the axes end their way; retract then ends the block on the return level. */
rigidtap_status rigidtap_block_plan(rigidtap_block *block, const rigidtap_machine *machine,
                                    const rigidtap_block_request *request, rigidtap_fault *fault);
rigidtap_status rigidtap_block_step(rigidtap_block *block, double now_s, const rigidtap_feedback *feedback,
                                    rigidtap_axes *axes, rigidtap_fault *fault);
rigidtap_status rigidtap_block_stop(rigidtap_block *block, double now_s);
rigidtap_status rigidtap_block_retract(rigidtap_block *block, double now_s);
rigidtap_status rigidtap_block_resume(rigidtap_block *block, double now_s);

#ifdef __cplusplus
}
#endif

#endif
