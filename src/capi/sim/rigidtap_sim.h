/* The simulated machine of rigidtap for hosts in C or C++: spindle and Z with drives, friction, backlash, resonances, encoders
 * and a work piece, in place of a real one.
 *
 * Build:  cargo rustc --release --lib --no-default-features --features capi,std --crate-type staticlib
 * That library has the control of rigidtap.h, too: a program links this one alone, with -lm -lpthread -ldl.
 *
 * rigidtap_sim_new and rigidtap_sim_free use the heap and read a file; a period uses neither, takes 15 to 40 us for a servo
 * period of 1 ms, and may be called in real time. A machine is used from one thread at a time. Pointers are valid, or null
 * (RIGIDTAP_NULL).
 *
 * Order: rigidtap_sim_new; each period rigidtap_sim_read, the control, rigidtap_sim_write, as real drives and encoders are
 * read and written; rigidtap_sim_begin_hole before each hole; rigidtap_sim_free.
 *
 * MIT OR Apache-2.0
 */
#ifndef RIGIDTAP_SIM_H
#define RIGIDTAP_SIM_H

#include "rigidtap.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct rigidtap_sim_options {
    const char *machine_file; /* zero-terminated; null: the reference machine */
    double z_start_mm;        /* where Z stands */
    uint64_t seed;            /* of everything random: the same seed gives the same bits */
    uint32_t takes_given;     /* not 0: what the drives take is here, and not in the machine file */
    uint32_t spindle_takes;   /* RIGIDTAP_TAKES_... */
    uint32_t z_takes;
    uint32_t ideal; /* not 0: no effect at all */
} rigidtap_sim_options;

/* What no encoder tells. */
typedef struct rigidtap_sim_truth_data {
    double spindle_rev;       /* of the tool */
    double z_mm;              /* of the tool's tip */
    double spindle_rpm;       /* of the motor */
    double spindle_torque_nm; /* that it gives */
    double z_force_n;         /* of Z's drive, upwards */
} rigidtap_sim_truth_data;

typedef struct rigidtap_sim rigidtap_sim;

/* RIGIDTAP_OK, or RIGIDTAP_VERSION where this header is not the library's. */
rigidtap_status rigidtap_sim_check_version(uint32_t version, size_t bytes);
#define RIGIDTAP_SIM_CHECK()                                                                                       \
    rigidtap_sim_check_version(RIGIDTAP_API_VERSION,                                                               \
                               sizeof(rigidtap_sim_options) + sizeof(rigidtap_sim_truth_data) +                    \
                                   sizeof(rigidtap_feedback) + sizeof(rigidtap_commanded) + sizeof(rigidtap_hole) + \
                                   sizeof(rigidtap_machine_data))

/* A machine at rest, or null: then `message` says why, zero-terminated, with the machine file's line and column. */
rigidtap_sim *rigidtap_sim_new(const rigidtap_sim_options *options, char *message, size_t message_bytes);
void rigidtap_sim_free(rigidtap_sim *sim);

/* What encoders and drives report at the start of a period. */
rigidtap_status rigidtap_sim_read(rigidtap_sim *sim, rigidtap_feedback *feedback);

/* The setpoint for the end of the period, of which each drive takes what it takes; the machine moves on by one period of its
 * file. The acceleration is torque of the file's inertia and force of its mass: a host that adds these to spindle_torque_nm and
 * z_force_n, as CiA 402's torque offset has them, leaves it 0. */
rigidtap_status rigidtap_sim_write(rigidtap_sim *sim, const rigidtap_commanded *setpoint);

/* What the host's clock shows at the start of the period, s: later than its count of periods where the machine file's [actual] has
 * it miss some. */
double rigidtap_sim_clock_s(rigidtap_sim *sim);

rigidtap_status rigidtap_sim_truth(const rigidtap_sim *sim, rigidtap_sim_truth_data *truth);

/* A new hole under the tap: R plane, bottom, pitch and hand are looked at. The work piece's surface lies the file's
 * tap.surface_below_r_mm below R. RIGIDTAP_INVALID, RIGIDTAP_UNKNOWN_CHOICE. */
rigidtap_status rigidtap_sim_begin_hole(rigidtap_sim *sim, const rigidtap_hole *hole);

/* 0: the drives lose their power, and the axes coast; else they have it back and hold the axes where they are. */
rigidtap_status rigidtap_sim_set_power(rigidtap_sim *sim, uint32_t is_on);

/* The machine file as the control is told it, without its [actual]. */
rigidtap_status rigidtap_sim_machine_data(const rigidtap_sim *sim, rigidtap_machine_data *data);

#ifdef __cplusplus
}
#endif

#endif
