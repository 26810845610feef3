/* A CNC kernel's loop in C99: taps two holes, M6 at 3000 rpm, on axes that follow their setpoints.
 *
 * cargo rustc --release --lib --no-default-features --features capi --crate-type staticlib \
 *     --config 'profile.release.panic="abort"'
 * cc -std=c99 -Isrc/capi src/guide/examples/host.c target/release/librigidtap.a -Wl,--gc-sections -lm -o host && ./host
 */
#include "rigidtap.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define PERIOD_S 0.001

/* States are large, and no kernel has them on its stack. */
static rigidtap_machine machine;
static rigidtap_tap tap;

/* The drives: in place of these three functions stand reading encoders and writing setpoints. */
static rigidtap_setpoint commanded;
static double spindle_counts_per_rev, z_counts_per_mm;

static void wait_for_period(void) {}

static void read_encoders(rigidtap_feedback *feedback)
{
    memset(feedback, 0, sizeof *feedback); /* nothing is reported beyond the two encoders */
    feedback->spindle_counts = (int64_t)floor(commanded.spindle.position * spindle_counts_per_rev + 0.5);
    feedback->z_counts = (int64_t)floor(commanded.z.position * z_counts_per_mm + 0.5);
}

static void write_setpoint(const rigidtap_setpoint *setpoint) { commanded = *setpoint; }

static int refused(const char *what, rigidtap_status status, const rigidtap_fault *fault)
{
    printf("%s: status %d, %s found %g, limit %g\n", what, (int)status, fault->key, fault->found, fault->limit);
    return 1;
}

int main(void)
{
    rigidtap_machine_data data;
    rigidtap_hole hole;
    rigidtap_fault fault;
    rigidtap_status status;
    double now_s = 0.0;
    int number;

    if (RIGIDTAP_CHECK() != RIGIDTAP_OK) return 2; /* header and library are of different versions */
    rigidtap_machine_reference(&data);
    data.spindle_max_rpm = 6000.0; /* what differs from the reference */
    data.torque_curve[data.torque_points - 1].speed_rpm = 6000.0;
    status = rigidtap_machine_init(&machine, &data, &fault);
    if (status != RIGIDTAP_OK) return refused("machine", status, &fault);
    spindle_counts_per_rev = data.spindle_counts_per_rev;
    z_counts_per_mm = data.z_counts_per_mm;
    commanded.z.position = 2.0; /* Z stands on the R plane */

    for (number = 1; number <= 2; number++) {
        rigidtap_feedback feedback;
        rigidtap_setpoint setpoint;
        double greatest_mm = 0.0;

        memset(&hole, 0, sizeof hole);
        hole.r_plane_mm = 2.0;
        hole.bottom_mm = -12.0;
        hole.return_mm = 2.0;
        hole.pitch_mm = 1.0;
        hole.speed_rpm = 3000.0;
        hole.compensation = RIGIDTAP_COMPENSATION_PAPER;
        /* Outside the period: a hole that the machine cannot tap is refused before anything moves. */
        status = rigidtap_tap_plan(&tap, &machine, &hole, &fault);
        if (status != RIGIDTAP_OK) return refused("hole", status, &fault);

        read_encoders(&feedback);
        status = rigidtap_tap_start(&tap, now_s, feedback.spindle_counts, 0.0, &fault);
        if (status != RIGIDTAP_OK) return refused("start", status, &fault);
        do {
            wait_for_period();
            read_encoders(&feedback);
            status = rigidtap_tap_step(&tap, now_s, &feedback, &setpoint, &fault);
            if (status != RIGIDTAP_OK) return refused("step", status, &fault);
            write_setpoint(&setpoint);
            if (fabs(setpoint.error_mm) > greatest_mm) greatest_mm = fabs(setpoint.error_mm);
            if (setpoint.stage == RIGIDTAP_HELD) {
                /* The axes rest. An operator would look first; then the tap is turned out as far as it can be. */
                printf("hole %d: alarm A%u\n", number, (unsigned)setpoint.alarm.code);
                if (rigidtap_tap_acknowledge(&tap) != RIGIDTAP_OK || rigidtap_tap_retract(&tap, now_s) != RIGIDTAP_OK) {
                    return 3;
                }
            }
            now_s += PERIOD_S;
        } while (setpoint.stage != RIGIDTAP_DONE);
        printf("hole %d: %.3f s, error %.1f um at most\n", number, rigidtap_tap_duration_s(&tap), 1000.0 * greatest_mm);
    }
    return 0;
}
