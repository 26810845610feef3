/* A host in the common language of C99 and C++: taps a hole, stops a second one half-way and retracts it. */
#include "rigidtap.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static rigidtap_machine machine, other_machine;
static rigidtap_block_request asked;
static rigidtap_stroke stroke;
static rigidtap_tap tap;
static rigidtap_block block;

/* The greatest force feedforward of a run. */
static double greatest_force_n;

#define EXPECT(condition)                                                  \
    do {                                                                   \
        if (!(condition)) {                                                \
            printf("line %d: %s does not hold\n", __LINE__, #condition);   \
            return 1;                                                      \
        }                                                                  \
    } while (0)

/* Encoders that read what was commanded; stops at one period where it is not negative. */
static int run(int stop_at, double *deepest_mm, double *greatest_error_mm)
{
    rigidtap_feedback feedback;
    rigidtap_setpoint setpoint;
    rigidtap_fault fault;
    int k;
    memset(&feedback, 0, sizeof feedback);
    feedback.z_counts = 20000;
    *deepest_mm = 0.0;
    *greatest_error_mm = 0.0;
    greatest_force_n = 0.0;
    for (k = 0; k < 10000; k++) {
        double now_s = 0.001 * k;
        if (k == stop_at && rigidtap_tap_stop(&tap, now_s) != RIGIDTAP_OK) return -1;
        if (stop_at >= 0 && k == stop_at + 600 && rigidtap_tap_retract(&tap, now_s) != RIGIDTAP_OK) return -2;
        if (rigidtap_tap_step(&tap, now_s, &feedback, &setpoint, &fault) != RIGIDTAP_OK) return -3;
        if (stop_at >= 0 && k == stop_at + 599 && setpoint.stage != RIGIDTAP_HOLDING) return -4;
        if (setpoint.alarm.code != RIGIDTAP_ALARM_NONE) return -6;
        if (setpoint.stage == RIGIDTAP_DONE) return k;
        if (fabs(setpoint.z_force_n) > greatest_force_n) greatest_force_n = fabs(setpoint.z_force_n);
        if (setpoint.z.position < *deepest_mm) *deepest_mm = setpoint.z.position;
        if (fabs(setpoint.error_mm) > *greatest_error_mm) *greatest_error_mm = fabs(setpoint.error_mm);
        feedback.spindle_counts = (int64_t)floor(setpoint.spindle.position * 16384.0 + 0.5);
        feedback.z_counts = (int64_t)floor(setpoint.z.position * 10000.0 + 0.5);
    }
    return -5;
}

/* Three holes in a row; the second is stopped and goes on where it is told so, else it is retracted and ends the block. */
static int run_block(int resumes, rigidtap_axes *axes)
{
    rigidtap_feedback feedback;
    int k, stopped_at = -1, deepest_hole = -1;
    memset(&feedback, 0, sizeof feedback);
    feedback.z_counts = 100000;
    for (k = 0; k < 20000; k++) {
        double now_s = 0.001 * k, x_mm = axes->x.position;
        if (rigidtap_block_step(&block, now_s, &feedback, axes, NULL) != RIGIDTAP_OK) return -1;
        if (axes->stage == RIGIDTAP_DONE) return k;
        if (axes->stage != RIGIDTAP_POSITIONING && axes->x.position != x_mm) return -2;
        if (axes->z.position < 1.9 && axes->stage == RIGIDTAP_POSITIONING) return -3;
        if (axes->z.position < -7.9) deepest_hole = (int)axes->hole;
        if (axes->hole == 1 && axes->z.position < -0.5 && stopped_at < 0) {
            stopped_at = k;
            if (rigidtap_block_plan(&block, &other_machine, &asked, NULL) != RIGIDTAP_NOT_IN_TURN) return -8;
            if (rigidtap_block_stop(&block, now_s) != RIGIDTAP_OK) return -4;
        }
        if (stopped_at >= 0 && k == stopped_at + 500) {
            if (axes->stage != RIGIDTAP_HOLDING || deepest_hole != 0) return -5;
            if ((resumes ? rigidtap_block_resume : rigidtap_block_retract)(&block, now_s) != RIGIDTAP_OK) return -6;
        }
        feedback.spindle_counts = (int64_t)floor(axes->spindle.position * 16384.0 + 0.5);
        feedback.z_counts = (int64_t)floor(axes->z.position * 10000.0 + 0.5);
    }
    return -7;
}

/* In the stroke the spindle's counter jumps: both axes brake on the plan, are held, and the tap is retracted. */
static int run_with_jump(double *retracted_from_mm)
{
    rigidtap_feedback feedback;
    rigidtap_setpoint setpoint;
    int64_t jump = 0;
    int k, jumped_at = -1, held_at = -1;
    memset(&feedback, 0, sizeof feedback);
    feedback.z_counts = 20000;
    *retracted_from_mm = 0.0;
    for (k = 0; k < 10000; k++) {
        double now_s = 0.001 * k;
        if (rigidtap_tap_step(&tap, now_s, &feedback, &setpoint, NULL) != RIGIDTAP_OK) return -1;
        if (jumped_at < 0 && setpoint.z.position < -5.0) {
            jumped_at = k + 1;
            jump = 1000000;
        } else if (k == jumped_at) {
            if (setpoint.alarm.code != RIGIDTAP_ALARM_COUNT_JUMP || setpoint.alarm.axis != RIGIDTAP_AXIS_SPINDLE) return -2;
            if (!(setpoint.alarm.value > setpoint.alarm.limit) || setpoint.stage != RIGIDTAP_MODEL_STOP) return -3;
            if (rigidtap_tap_acknowledge(&tap) != RIGIDTAP_ALARM_LATCHED) return -4;
            if (rigidtap_tap_retract(&tap, now_s) != RIGIDTAP_ALARM_LATCHED) return -5;
        } else if (jumped_at >= 0 && held_at < 0 && setpoint.stage == RIGIDTAP_HELD) {
            held_at = k;
            if (setpoint.alarm.code != RIGIDTAP_ALARM_COUNT_JUMP || setpoint.spindle.velocity != 0.0) return -7;
            *retracted_from_mm = setpoint.z.position;
            if (rigidtap_tap_acknowledge(&tap) != RIGIDTAP_OK) return -8;
        } else if (held_at >= 0 && k == held_at + 1) {
            if (setpoint.alarm.code != RIGIDTAP_ALARM_NONE || setpoint.stage != RIGIDTAP_HOLDING) return -9;
            if (rigidtap_tap_resume(&tap, now_s) != RIGIDTAP_HOLE_FAILED) return -10;
            if (rigidtap_tap_retract(&tap, now_s) != RIGIDTAP_OK) return -11;
        }
        if (setpoint.stage == RIGIDTAP_DONE) return held_at >= 0 ? k : -12;
        feedback.spindle_counts = jump + (int64_t)floor(setpoint.spindle.position * 16384.0 + 0.5);
        feedback.z_counts = (int64_t)floor(setpoint.z.position * 10000.0 + 0.5);
    }
    return -13;
}

/* The power goes in the stroke in; after the restart the spindle's encoder knows its angle alone. */
static int run_with_power_cut(double *restarted_at_mm)
{
    rigidtap_feedback feedback;
    rigidtap_setpoint setpoint;
    rigidtap_fault fault;
    rigidtap_record record, damaged;
    int64_t turns;
    int k;
    memset(&feedback, 0, sizeof feedback);
    feedback.z_counts = 20000;
    if (rigidtap_tap_record(&tap, 0, &record) != RIGIDTAP_NOT_IN_TURN) return -1;
    for (k = 0; k < 300; k++) {
        if (rigidtap_tap_step(&tap, 0.001 * k, &feedback, &setpoint, NULL) != RIGIDTAP_OK) return -2;
        feedback.spindle_counts = (int64_t)floor(setpoint.spindle.position * 16384.0 + 0.5);
        feedback.z_counts = (int64_t)floor(setpoint.z.position * 10000.0 + 0.5);
    }
    if (rigidtap_tap_record(&tap, 7, &record) != RIGIDTAP_OK) return -3;
    memset(&tap, 0, sizeof tap);
    turns = feedback.spindle_counts / 16384;
    feedback.spindle_counts -= 16384 * turns;
    feedback.z_counts += 7;
    if (turns < 5) return -4;

    damaged = record;
    damaged.bytes[9] ^= 4;
    if (rigidtap_tap_plan_retract(&tap, &machine, &damaged, &feedback, 0.0, 0, &fault) != RIGIDTAP_RECORD_DAMAGED) return -5;
    if (rigidtap_tap_plan_retract(&tap, &other_machine, &record, &feedback, 0.0, 0, &fault) != RIGIDTAP_RECORD_MACHINE) return -6;
    feedback.spindle_counts += 1638;
    if (rigidtap_tap_plan_retract(&tap, &machine, &record, &feedback, 0.0, 0, &fault) != RIGIDTAP_OFF_HELIX) return -7;
    if (fabs(fault.found + 100.0) > 1.0 || fault.limit < 40.0 || fault.limit > 60.0) return -8;
    feedback.spindle_counts -= 1638;
    feedback.status = RIGIDTAP_Z_INVALID;
    if (rigidtap_tap_plan_retract(&tap, &machine, &record, &feedback, 0.0, 0, &fault) != RIGIDTAP_SAMPLE_INVALID) return -9;
    feedback.status = 0;
    if (rigidtap_tap_plan_retract(&tap, &machine, &record, &feedback, 500.0, 0, &fault) != RIGIDTAP_OK) return -10;
    if (rigidtap_tap_start(&tap, 0.0, 0, 0.0, &fault) != RIGIDTAP_OK) return -11;
    *restarted_at_mm = feedback.z_counts / 10000.0;
    for (k = 0; k < 5000; k++) {
        double now_s = 0.001 * k;
        if (rigidtap_tap_step(&tap, now_s, &feedback, &setpoint, NULL) != RIGIDTAP_OK) return -12;
        if (setpoint.alarm.code != RIGIDTAP_ALARM_NONE) return -13;
        if (k < 20 && (setpoint.stage != RIGIDTAP_HOLDING || fabs(setpoint.z.position - *restarted_at_mm) > 0.002)) return -14;
        if (k == 20 && rigidtap_tap_resume(&tap, now_s) != RIGIDTAP_HOLE_FAILED) return -15;
        if (k == 20 && rigidtap_tap_retract(&tap, now_s) != RIGIDTAP_OK) return -16;
        if (setpoint.stage == RIGIDTAP_DONE) return fabs(setpoint.z.position - 2.0007) < 0.002 ? k : -17;
        if (fabs(setpoint.error_mm) > 0.002) return -18;
        feedback.spindle_counts = (int64_t)floor(setpoint.spindle.position * 16384.0 + 0.5);
        feedback.z_counts = (int64_t)floor(setpoint.z.position * 10000.0 + 0.5);
    }
    return -19;
}

int main(void)
{
    rigidtap_block_request request;
    rigidtap_axes axes;
    rigidtap_machine_data data;
    rigidtap_state state;
    rigidtap_hole hole;
    rigidtap_fault fault;
    rigidtap_feedback feedback;
    rigidtap_setpoint setpoint;
    rigidtap_residual residual;
    rigidtap_identified identified;
    rigidtap_counters counters;
    double deepest_mm, error_mm, duration_s;
    int k;

    EXPECT(RIGIDTAP_CHECK() == RIGIDTAP_OK);
    EXPECT(rigidtap_check_version(RIGIDTAP_API_VERSION + 1, 0, 0, 0, 0, 0) == RIGIDTAP_VERSION);
    EXPECT(rigidtap_machine_reference(NULL) == RIGIDTAP_NULL);
    EXPECT(rigidtap_stroke_plan(&stroke, &machine, 25.0, 3000.0, NULL) == RIGIDTAP_NOT_INITIALISED);
    EXPECT(rigidtap_machine_reference(&data) == RIGIDTAP_OK);
    data.spindle_max_rpm = -1.0;
    EXPECT(rigidtap_machine_init(&machine, &data, &fault) == RIGIDTAP_MACHINE_OUT_OF_RANGE);
    EXPECT(strcmp(fault.key, "spindle.max_rpm") == 0 && fault.found == -1.0 && fault.limit == 1.0);
    EXPECT(rigidtap_machine_reference(&data) == RIGIDTAP_OK);
    data.law = 7;
    EXPECT(rigidtap_machine_init(&machine, &data, NULL) == RIGIDTAP_UNKNOWN_CHOICE);
    data.law = RIGIDTAP_LAW_TORQUE_LIMIT;
    EXPECT(data.spindle_takes == RIGIDTAP_TAKES_TORQUE && data.z_takes == RIGIDTAP_TAKES_TORQUE);
    data.z_takes = RIGIDTAP_TAKES_SPEED;
    EXPECT(rigidtap_machine_init(&machine, &data, NULL) == RIGIDTAP_UNKNOWN_CHOICE);
    data.z_takes = RIGIDTAP_TAKES_POSITION;
    data.spindle_takes = RIGIDTAP_TAKES_SPEED;
    EXPECT(rigidtap_machine_init(&machine, &data, NULL) == RIGIDTAP_OK);
    data.spindle_takes = 4;
    EXPECT(rigidtap_machine_init(&machine, &data, NULL) == RIGIDTAP_UNKNOWN_CHOICE);
    data.spindle_takes = data.z_takes = RIGIDTAP_TAKES_TORQUE;
    EXPECT(rigidtap_machine_init(&machine, &data, &fault) == RIGIDTAP_OK);
    EXPECT(data.supervision_bridge_periods == 5.0 && data.supervision_error_limit_um == 0.0);
    data.supervision_z_limit_um = -1.0;
    EXPECT(rigidtap_machine_init(&other_machine, &data, &fault) == RIGIDTAP_MACHINE_OUT_OF_RANGE);
    EXPECT(strcmp(fault.key, "supervision.z_limit_um") == 0);
    data.supervision_z_limit_um = 500.0;
    EXPECT(rigidtap_machine_init(&other_machine, &data, &fault) == RIGIDTAP_OK);

    /* The bound of 25 rev at 80 % of the motor is 0.4196 s. */
    EXPECT(rigidtap_stroke_plan(&stroke, &machine, 25.0, 7000.0, &fault) == RIGIDTAP_OK);
    duration_s = rigidtap_stroke_duration_s(&stroke);
    EXPECT(duration_s > 0.4196 && duration_s < 0.43);
    EXPECT(rigidtap_stroke_peak_rpm(&stroke) > 6000.0 && rigidtap_stroke_peak_rpm(&stroke) < 6400.0);
    EXPECT(rigidtap_stroke_plan(&stroke, &machine, 25.0, 8001.0, &fault) == RIGIDTAP_SPINDLE_TOO_FAST);
    EXPECT(fault.found == 8001.0 && fault.limit == 8000.0);
    EXPECT(rigidtap_stroke_plan(&stroke, &machine, (double)NAN, 7000.0, &fault) == RIGIDTAP_INVALID);
    EXPECT(rigidtap_stroke_at(&stroke, duration_s, &state) == RIGIDTAP_OK);
    EXPECT(fabs(state.position - 25.0) < 1e-9 && state.velocity == 0.0);

    memset(&hole, 0, sizeof hole);
    hole.r_plane_mm = 2.0;
    hole.bottom_mm = -28.0;
    hole.pitch_mm = 1.0;
    hole.speed_rpm = 9000.0;
    EXPECT(rigidtap_tap_plan(&tap, &machine, &hole, &fault) == RIGIDTAP_SPINDLE_TOO_FAST);
    EXPECT(fault.found == 9000.0 && fault.limit == 8000.0);
    EXPECT(rigidtap_tap_stop(&tap, 0.0) == RIGIDTAP_NOT_IN_TURN);
    hole.speed_rpm = 5000.0;
    EXPECT(rigidtap_tap_plan(&tap, &machine, &hole, &fault) == RIGIDTAP_OK);
    duration_s = rigidtap_tap_duration_s(&tap);
    EXPECT(duration_s > 0.8 && duration_s < 1.1);
    EXPECT(rigidtap_tap_start(&tap, 0.0, 0, (double)NAN, &fault) == RIGIDTAP_INVALID && fault.found != fault.found);
    EXPECT(rigidtap_tap_start(&tap, 0.0, 0, -(double)INFINITY, &fault) == RIGIDTAP_INVALID);
    EXPECT(rigidtap_tap_start(&tap, (double)NAN, 0, 0.0, &fault) == RIGIDTAP_INVALID);
    EXPECT(rigidtap_tap_start(&tap, 0.0, 0, -9000.0, &fault) == RIGIDTAP_SPINDLE_TOO_FAST);
    EXPECT(fault.found == 9000.0 && fault.limit == 8000.0);
    EXPECT(rigidtap_tap_start(&tap, 0.0, 0, 0.0, &fault) == RIGIDTAP_OK);
    EXPECT(rigidtap_tap_start(&tap, 0.0, 0, 0.0, &fault) == RIGIDTAP_NOT_IN_TURN);
    EXPECT(rigidtap_tap_retract(&tap, 0.0) == RIGIDTAP_NOT_STOPPED);
    EXPECT(fabs(run(-1, &deepest_mm, &error_mm) * 0.001 - duration_s) < 0.02);
    EXPECT(fabs(deepest_mm + 28.0) < 0.005 && error_mm < 0.0003 && greatest_force_n == 0.0);

    /* The next hole: planned, approached, and then a spindle that does not rest: an alarm beside a setpoint, acknowledged. */
    EXPECT(rigidtap_tap_plan(&tap, &machine, &hole, &fault) == RIGIDTAP_OK);
    memset(&feedback, 0, sizeof feedback);
    feedback.z_counts = 20000;
    EXPECT(rigidtap_tap_observe(&tap, 10.0, &feedback, &residual) == RIGIDTAP_OK && residual.z_force_n == 0.0);
    EXPECT(rigidtap_tap_identified(&tap, &identified) == RIGIDTAP_OK);
    EXPECT(identified.spindle_inertia_ratio == 1.0 && identified.z_friction_n == data.z_coulomb_n);
    EXPECT(rigidtap_tap_start(&tap, 10.001, 0, 0.0, &fault) == RIGIDTAP_OK);
    EXPECT(rigidtap_tap_plan(&tap, &machine, &hole, &fault) == RIGIDTAP_NOT_IN_TURN);
    EXPECT(rigidtap_tap_plan(&tap, &other_machine, &hole, &fault) == RIGIDTAP_NOT_IN_TURN);
    EXPECT(rigidtap_tap_observe(&tap, 10.001, &feedback, NULL) == RIGIDTAP_NOT_IN_TURN);
    feedback.spindle_counts = 16384;
    for (k = 0; k < 3100; k++)
        EXPECT(rigidtap_tap_step(&tap, 10.001 + 0.001 * k, &feedback, &setpoint, &fault) == RIGIDTAP_OK);
    EXPECT(setpoint.alarm.code == RIGIDTAP_ALARM_NOT_IN_POSITION && setpoint.alarm.axis == RIGIDTAP_AXIS_SPINDLE);
    EXPECT(setpoint.stage == RIGIDTAP_HELD && setpoint.z.position == 2.0 && setpoint.spindle.position == 0.0);
    EXPECT(rigidtap_tap_acknowledge(&tap) == RIGIDTAP_OK);
    EXPECT(rigidtap_tap_step(&tap, 13.101, &feedback, &setpoint, &fault) == RIGIDTAP_OK);
    EXPECT(setpoint.alarm.code == RIGIDTAP_ALARM_NONE && setpoint.stage == RIGIDTAP_SETTLING);
    EXPECT(rigidtap_tap_counters(&tap, &counters) == RIGIDTAP_OK && counters.gaps == 1 && counters.periods > 3000);
    EXPECT(rigidtap_tap_release(&tap) == RIGIDTAP_OK);

    hole.compensation = 3;
    EXPECT(rigidtap_tap_plan(&tap, &machine, &hole, &fault) == RIGIDTAP_UNKNOWN_CHOICE);
    hole.compensation = RIGIDTAP_COMPENSATION_FULL;
    hole.identify = 1;
    hole.learn = 1;
    EXPECT(rigidtap_tap_plan(&tap, &machine, &hole, &fault) == RIGIDTAP_OK);
    EXPECT(rigidtap_tap_start(&tap, 0.0, 0, 0.0, &fault) == RIGIDTAP_OK);
    EXPECT(run(-1, &deepest_mm, &error_mm) > 500);
    /* The friction of the machine's data is overcome. */
    EXPECT(fabs(deepest_mm + 28.0) < 0.05 && greatest_force_n > 0.9 * data.z_coulomb_n);
    hole.compensation = RIGIDTAP_COMPENSATION_NONE;

    EXPECT(rigidtap_tap_plan(&tap, &machine, &hole, &fault) == RIGIDTAP_OK);
    EXPECT(rigidtap_tap_start(&tap, 0.0, 0, 5000.0, &fault) == RIGIDTAP_OK);
    EXPECT(run(400, &deepest_mm, &error_mm) > 1000);
    EXPECT(deepest_mm < -5.0 && deepest_mm > -28.0 && error_mm < 0.0003);

    EXPECT(rigidtap_tap_plan(&tap, &machine, &hole, &fault) == RIGIDTAP_OK);
    EXPECT(rigidtap_tap_start(&tap, 0.0, 0, 0.0, &fault) == RIGIDTAP_OK);
    EXPECT(run_with_jump(&deepest_mm) > 500 && deepest_mm < -5.0 && deepest_mm > -28.0);

    EXPECT(rigidtap_tap_plan(&tap, &machine, &hole, &fault) == RIGIDTAP_OK);
    EXPECT(rigidtap_tap_start(&tap, 0.0, 0, 0.0, &fault) == RIGIDTAP_OK);
    EXPECT(run_with_power_cut(&deepest_mm) > 500 && deepest_mm < -3.0 && deepest_mm > -28.0);

    /* A start angle: the spindle turns to it before the hole. */
    hole.has_start_angle = 1;
    hole.start_angle_deg = 90.0;
    EXPECT(rigidtap_tap_plan(&tap, &machine, &hole, &fault) == RIGIDTAP_OK);
    EXPECT(rigidtap_tap_start(&tap, 0.0, 0, 0.0, &fault) == RIGIDTAP_OK);
    memset(&feedback, 0, sizeof feedback);
    feedback.z_counts = 20000;
    for (k = 0; k < 200; k++) {
        EXPECT(rigidtap_tap_step(&tap, 0.001 * k, &feedback, &setpoint, &fault) == RIGIDTAP_OK);
        if (k > 0 && setpoint.stage == RIGIDTAP_SYNCHRONOUS) break;
        EXPECT(setpoint.stage == RIGIDTAP_SETTLING && setpoint.z.position == 2.0);
        feedback.spindle_counts = (int64_t)floor(setpoint.spindle.position * 16384.0 + 0.5);
    }
    EXPECT(setpoint.stage == RIGIDTAP_SYNCHRONOUS && feedback.spindle_counts == 4096);
    EXPECT(rigidtap_tap_release(&tap) == RIGIDTAP_OK);
    hole.has_start_angle = 0;

    memset(&request, 0, sizeof request);
    request.hole = hole;
    request.hole.bottom_mm = -8.0;
    request.hole.return_mm = 10.0;
    request.hole.x_mm = 5.0;
    request.start_z_mm = 10.0;
    request.step_x_mm = 7.0;
    request.spindle_rpm = 1000.0;
    EXPECT(rigidtap_block_plan(&block, &machine, &request, &fault) == RIGIDTAP_INVALID);
    request.holes = 3;
    request.spindle_rpm = (double)NAN;
    EXPECT(rigidtap_block_plan(&block, &machine, &request, &fault) == RIGIDTAP_INVALID);
    request.spindle_rpm = 9000.0;
    EXPECT(rigidtap_block_plan(&block, &machine, &request, &fault) == RIGIDTAP_SPINDLE_TOO_FAST && fault.limit == 8000.0);
    request.spindle_rpm = 1000.0;
    asked = request;
    memset(&axes, 0, sizeof axes);
    EXPECT(rigidtap_block_plan(&block, &machine, &request, &fault) == RIGIDTAP_OK);
    EXPECT(run_block(1, &axes) > 1000 && axes.hole == 2 && axes.x.position == 19.0 && axes.z.position == 10.0);
    memset(&axes, 0, sizeof axes);
    EXPECT(rigidtap_block_plan(&block, &machine, &request, &fault) == RIGIDTAP_OK);
    EXPECT(run_block(0, &axes) > 1000 && axes.hole == 1 && axes.x.position == 12.0 && axes.z.position == 10.0);
    printf("tapped\n");
    return 0;
}
