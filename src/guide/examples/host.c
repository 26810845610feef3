/* A CNC kernel's loop in C99: taps M6, 25 mm deep, at four speeds. Drives, encoders and work piece are the simulated machine's.
 *
 * cargo rustc --release --lib --no-default-features --features capi,std --crate-type staticlib
 * cc -std=c99 -Isrc/capi -Isrc/capi/sim src/guide/examples/host.c target/release/librigidtap.a -lm -lpthread -ldl -o host && ./host
 *
 * What a kernel takes over is `tap_hole`: it needs nothing of libc but memset, and rigidtap.h's library alone.
 */
#include "rigidtap_sim.h"

#include <stdio.h>
#include <string.h>

#define PERIOD_S 0.001
#define R_PLANE_MM 2.0
#define BOTTOM_MM (-23.0)
#define PITCH_MM 1.0

/* States are large, and no kernel has them on its stack. */
static rigidtap_machine machine;
static rigidtap_tap tap;

/* Drives and encoders: in place of these stand the bus's. */
static rigidtap_sim *sim;
static double now_s;

static void read_drives(rigidtap_feedback *feedback) { rigidtap_sim_read(sim, feedback); }

/* A bus of CiA 402 drives sends acceleration as torque: inertia times acceleration, and spindle_torque_nm. */
static void write_drives(const rigidtap_commanded *commanded)
{
    rigidtap_sim_write(sim, commanded);
    now_s += PERIOD_S;
}

/* How a hole ended. */
typedef struct hole_report {
    rigidtap_status status; /* not RIGIDTAP_OK: refused, and nothing has moved */
    rigidtap_fault fault;
    rigidtap_alarm alarm;
    double duration_s;
    double error_um; /* e(k), peak to peak */
} hole_report;

/* Where spindle and Z were commanded to be last. */
static rigidtap_commanded commanded;

/* Between holes: the axes go on as the kernel moves them, here they rest; what the last hole left of Z decays. */
static void rest(int periods)
{
    rigidtap_commanded target = commanded;
    target.spindle.velocity = target.spindle.acceleration = 0.0;
    target.z.position = R_PLANE_MM;
    target.z.velocity = target.z.acceleration = 0.0;
    target.spindle_torque_nm = target.z_force_n = 0.0;
    for (; periods > 0; periods--) {
        rigidtap_feedback feedback;
        rigidtap_residual residual;
        memset(&residual, 0, sizeof residual);
        read_drives(&feedback);
        (void)rigidtap_tap_observe(&tap, now_s, &feedback, &residual); /* not before the first hole is planned */
        commanded = target;
        commanded.z.position += residual.z.position;
        commanded.z.velocity += residual.z.velocity;
        commanded.z_force_n += residual.z_force_n;
        (void)rigidtap_tap_note_commanded(&tap, &commanded);
        write_drives(&commanded);
    }
}

/* One hole, from Z at rest on R to Z at rest on R. */
static void tap_hole(const rigidtap_hole *hole, double counts_per_rev, hole_report *report)
{
    double least_mm = 0.0, greatest_mm = 0.0, begin_s;
    int64_t spindle_counts;
    memset(report, 0, sizeof *report);
    /* Outside the period: a hole that the machine cannot tap is refused before anything moves. */
    report->status = rigidtap_tap_plan(&tap, &machine, hole, &report->fault);
    if (report->status != RIGIDTAP_OK) return;
    spindle_counts = (int64_t)(commanded.spindle.position * counts_per_rev + (commanded.spindle.position < 0 ? -0.5 : 0.5));
    report->status = rigidtap_tap_start(&tap, now_s, spindle_counts, 0.0, &report->fault);
    if (report->status != RIGIDTAP_OK) return;
    begin_s = now_s;
    for (;;) {
        rigidtap_feedback feedback;
        rigidtap_setpoint setpoint;
        read_drives(&feedback);
        report->status = rigidtap_tap_step(&tap, now_s, &feedback, &setpoint, &report->fault);
        if (report->status != RIGIDTAP_OK) return;
        if (setpoint.stage == RIGIDTAP_DONE) break;
        if (setpoint.alarm.code != RIGIDTAP_ALARM_NONE) report->alarm = setpoint.alarm;
        /* The axes rest in the thread. An operator would look first; then the tap is turned out. */
        if (setpoint.stage == RIGIDTAP_HELD && rigidtap_tap_acknowledge(&tap) == RIGIDTAP_OK)
            report->status = rigidtap_tap_retract(&tap, now_s);
        if (setpoint.error_mm < least_mm) least_mm = setpoint.error_mm;
        if (setpoint.error_mm > greatest_mm) greatest_mm = setpoint.error_mm;
        commanded.spindle = setpoint.spindle;
        commanded.z = setpoint.z;
        commanded.spindle_torque_nm = setpoint.spindle_torque_nm;
        commanded.z_force_n = setpoint.z_force_n;
        write_drives(&commanded);
    }
    report->duration_s = now_s - begin_s;
    report->error_um = 1000.0 * (greatest_mm - least_mm);
}

int main(int count, char **words)
{
    static const double speeds_rpm[] = {1000.0, 3000.0, 5000.0, 7000.0};
    rigidtap_sim_options options;
    rigidtap_machine_data data;
    rigidtap_hole hole;
    rigidtap_fault fault;
    char message[512];
    int number;

    if (RIGIDTAP_CHECK() != RIGIDTAP_OK || RIGIDTAP_SIM_CHECK() != RIGIDTAP_OK) return 2; /* not this header's library */
    memset(&options, 0, sizeof options);
    options.machine_file = count > 1 ? words[1] : NULL;
    options.z_start_mm = R_PLANE_MM;
    options.seed = 1;
    sim = rigidtap_sim_new(&options, message, sizeof message);
    if (!sim) {
        printf("%s\n", message);
        return 1;
    }
    rigidtap_sim_machine_data(sim, &data); /* of a real machine: rigidtap_machine_reference, and what differs */
    if (rigidtap_machine_init(&machine, &data, &fault) != RIGIDTAP_OK) {
        printf("%s: found %g, limit %g\n", fault.key, fault.found, fault.limit);
        return 1;
    }
    commanded.z.position = R_PLANE_MM;
    memset(&hole, 0, sizeof hole);
    hole.r_plane_mm = hole.return_mm = R_PLANE_MM;
    hole.bottom_mm = BOTTOM_MM;
    hole.pitch_mm = PITCH_MM;
    hole.compensation = RIGIDTAP_COMPENSATION_FULL;
    hole.identify = hole.learn = 1;
    for (number = 0; number < 4; number++) {
        hole_report report;
        hole.speed_rpm = speeds_rpm[number];
        rigidtap_sim_begin_hole(sim, &hole);
        rest(200);
        tap_hole(&hole, data.spindle_counts_per_rev, &report);
        if (report.status != RIGIDTAP_OK) {
            printf("S%g: status %d, found %g, limit %g\n", hole.speed_rpm, (int)report.status, report.fault.found,
                   report.fault.limit);
            return 1;
        }
        printf("S%g: %.3f s, e(k) %.2f um, alarm %u\n", hole.speed_rpm, report.duration_s, report.error_um,
               (unsigned)report.alarm.code);
    }
    rigidtap_sim_free(sim);
    return 0;
}
