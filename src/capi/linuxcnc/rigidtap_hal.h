/* What the files of the component share: an instance with its pins, and what each file does for the others. */
#ifndef RIGIDTAP_HAL_H
#define RIGIDTAP_HAL_H

#include "hal.h"
#include "rigidtap.h"
#include "rtapi.h"

#define MOST 4

/* Pin `state`. From 2 on the component has spindle and Z. */
enum { IDLE = 0, ARMED = 1, SETTLING = 2, TAPPING = 3, BRAKING = 4, HOLDING = 5, RETRACTING = 6, FINISHED = 7 };

/* Pin `alarm`: a RIGIDTAP_... status below 100, a RIGIDTAP_ALARM_... of the control from 101 on, or one of these. */
enum { ALARM_ABORTED = 201, ALARM_DISABLED = 202, ALARM_Z_MOVES = 203, ALARM_PERIOD = 204 };

/* Pin `verdict` of the last hole. */
enum { VERDICT_OK = 0, VERDICT_WARNING = 1, VERDICT_FAIL = 2 };

/* A plan wanted and a plan made, between two threads. */
enum { PLAN_NONE = 0, PLAN_WANTED = 1, PLAN_MADE = 2 };

/* What is planned: nothing but a machine to be watched, a hole, or the way out of one. */
enum { PLAN_WATCH = 0, PLAN_HOLE = 1, PLAN_RESTORE = 2 };

/* A record as HAL pins. */
#define RECORD_WORDS 16

#define UM_PER_MM 1000.0
#define MM_PER_M 1000.0
#define RPM_PER_REV_PER_S 60.0
#define RAD_PER_REV 6.283185307179586
/* Below any encoder's count. */
#define MOVED_MM 1e-6

/* Pins that may be left unconnected, each with what it tells where it is connected. */
#define OPTIONAL_PINS(PIN)                                            \
    PIN(float, HAL_OUT, spindle_target, "spindle-target")             \
    PIN(float, HAL_OUT, spindle_velocity, "spindle-velocity-offset")  \
    PIN(float, HAL_OUT, spindle_effort, "spindle-torque-offset")      \
    PIN(float, HAL_OUT, z_velocity, "z-velocity-offset")              \
    PIN(float, HAL_OUT, z_effort, "z-force-offset")                   \
    PIN(float, HAL_IN, clock, "clock")                                \
    PIN(float, HAL_IN, spindle_torque, "spindle-torque")              \
    PIN(float, HAL_IN, z_force, "z-force")                            \
    PIN(float, HAL_IN, z_motor, "z-motor-position")                   \
    PIN(bit, HAL_IN, spindle_saturated, "spindle-saturated")          \
    PIN(bit, HAL_IN, z_saturated, "z-saturated")                      \
    PIN(bit, HAL_IN, spindle_valid, "spindle-sample-valid")           \
    PIN(bit, HAL_IN, z_valid, "z-sample-valid")                       \
    PIN(bit, HAL_IN, spindle_ready, "spindle-drive-ready")            \
    PIN(bit, HAL_IN, z_ready, "z-drive-ready")

#define PIN_FIELD(type, direction, field, name) hal_##type##_t *field;

typedef struct {
    /* from motion, and to it */
    hal_float_t *z_command_in, *z_feedback_out, *spindle_command_in;
    hal_bit_t *enable, *in_position;
    /* from the drives, and to them */
    hal_float_t *z_feedback_in, *z_command_out, *spindle_position, *spindle_speed, *spindle_command_out;
    OPTIONAL_PINS(PIN_FIELD)
    /* Where each optional pin points while no signal is connected: hal.h says that it is a place of its own. */
    struct { OPTIONAL_PINS(PIN_FIELD) } own;
    /* the hole */
    hal_float_t *pitch, *depth, *speed, *out_speed, *dwell, *peck, *chip_break;
    hal_bit_t *left_hand;
    /* the order */
    hal_bit_t *start, *abort, *hold, *retract, *acknowledge;
    /* the record of the hole under way, and the one that outlived a power cut */
    hal_u32_t *record[RECORD_WORDS], *saved[RECORD_WORDS];
    hal_bit_t *record_valid, *saved_valid, *restore, *drives_enable;
    hal_float_t *start_angle;
    hal_bit_t *has_start_angle;
    /* the report */
    hal_bit_t *busy, *finished, *holding, *alarmed, *synchronous;
    hal_s32_t *state, *alarm, *verdict;
    hal_u32_t *holes;
    hal_float_t *fault_found, *fault_limit, *z_true;
    hal_float_t *error_um, *error_min_um, *error_max_um, *error_peak_um, *depth_reached;
    hal_float_t *tolerance_um, *peak_rpm, *cycle_time;
    /* what is set */
    hal_float_t tolerance;
    hal_u32_t compensation;
    hal_bit_t identify, learn, nominal_time;
    /* The machine: its numbers are parameters themselves. */
    rigidtap_machine_data data;

    /* States of the control, beside HAL's memory. */
    rigidtap_machine *machine;
    rigidtap_tap *tap;
    rigidtap_setpoint setpoint;
    rigidtap_commanded commanded;
    rigidtap_fault fault;
    int number;
    int plan_state, plan_kind, plan_status;
    /* Whose turn it is with `tap`: the planning thread's or the servo thread's. */
    int tap_taken;
    double planned_r_mm, planned_tolerance_um;
    double period_s, now_s, began_s;
    long long last_ns;
    double r_plane_mm, target_rev, left_over_mm, residual_mm;
    /* Of the spindle's reference, beside where it rests after a hole. */
    double residual_rev;
    /* Speed that the spindle is told in the next period, rev/s. */
    double next_speed;
    /* By how much Z is told something else than motion says. */
    double offset_mm;
    double z_command_before[2], position_before;
    int periods_at_rest, periods_seen, was_started, was_aborted, was_held, was_retract, is_off, ordered_alarm;
    /* A hole has ended, and what it leaves of Z is to be given back. */
    int was_enabled, hands_over;
    /* An alarm that nobody has acknowledged: the spindle is commanded to stand. */
    int is_latched, was_acknowledge;
    /* The tap is led out of a hole in which the power left it, the machine off. */
    int is_restored, was_restore;
    /* The alarm was of samples that are not believed; and what the spindle's encoder is off since. */
    int is_on_model;
    double shift_rev;
} tap_t;

#define IS_CONNECTED(t, pin) ((t)->pin != (t)->own.pin)

/* rigidtap_pins.c */
int export_instance(tap_t *t, int component);

/* rigidtap_plan.c */
void plan(void *arg, long period);
void want_plan(tap_t *t, int kind);
int is_planned(const tap_t *t);
int is_planning(const tap_t *t);
int take_tap(tap_t *t);
void give_tap(tap_t *t);

/* rigidtap_drives.c */
void read_drives(const tap_t *t, rigidtap_feedback *feedback);
void write_drives(tap_t *t);
void pass(tap_t *t);
void follow_setpoint(tap_t *t);
int is_positioned(const tap_t *t);
int near(double a_mm, double b_mm);
int64_t counts_of(double position, double per_unit);
void note_takes(tap_t *t);
double spindle_limited(const tap_t *t, double rpm);

/* rigidtap_report.c */
void clear_report(tap_t *t);
void note_period(tap_t *t);
void note_end(tap_t *t);
void keep_record(tap_t *t);

#endif
