/* Planning, outside the period: in a slower thread, or in the servo thread while nothing moves. */
#include "rigidtap_hal.h"

/* The machine's period and the thread's may differ by this share. */
#define PERIOD_SHARE 0.001

void want_plan(tap_t *t, int kind)
{
    t->plan_kind = kind;
    __atomic_store_n(&t->plan_state, PLAN_WANTED, __ATOMIC_RELEASE);
}

int is_planned(const tap_t *t) { return __atomic_load_n(&t->plan_state, __ATOMIC_ACQUIRE) == PLAN_MADE; }

int is_planning(const tap_t *t) { return __atomic_load_n(&t->plan_state, __ATOMIC_ACQUIRE) == PLAN_WANTED; }

/* Neither thread waits for the other: who does not get the state goes without it this time. */
int take_tap(tap_t *t) { return !__atomic_exchange_n(&t->tap_taken, 1, __ATOMIC_ACQUIRE); }

void give_tap(tap_t *t) { __atomic_store_n(&t->tap_taken, 0, __ATOMIC_RELEASE); }

/* The way out of a hole, from the record that was kept and where the axes stand. */
static rigidtap_status plan_restore(tap_t *t)
{
    rigidtap_feedback feedback;
    rigidtap_record record;
    uint32_t words[RECORD_WORDS];
    int n;
    for (n = 0; n < RECORD_WORDS; n++) words[n] = *t->saved[n];
    __builtin_memcpy(record.bytes, words, sizeof(record.bytes));
    read_drives(t, &feedback);
    return rigidtap_tap_plan_retract(t->tap, t->machine, &record, &feedback, 0.0, t->compensation, &t->fault);
}

static rigidtap_status plan_hole(tap_t *t)
{
    rigidtap_hole hole = {0};
    t->planned_r_mm = *t->z_command_in;
    hole.r_plane_mm = hole.return_mm = t->planned_r_mm;
    hole.bottom_mm = t->planned_r_mm - *t->depth;
    hole.pitch_mm = *t->pitch;
    hole.speed_rpm = *t->speed;
    hole.out_speed_rpm = *t->out_speed;
    hole.dwell_s = *t->dwell;
    hole.peck_mm = *t->peck;
    hole.chip_break_mm = *t->chip_break;
    hole.hand = *t->left_hand ? RIGIDTAP_HAND_LEFT : RIGIDTAP_HAND_RIGHT;
    hole.compensation = t->compensation;
    hole.identify = t->identify;
    hole.learn = t->learn;
    hole.has_start_angle = *t->has_start_angle;
    hole.start_angle_deg = *t->start_angle;
    if (t->plan_kind == PLAN_WATCH) {
        /* The shortest hole that any machine taps: with it planned the machine is measured wherever it moves. */
        hole.bottom_mm = t->planned_r_mm - 1.0;
        hole.pitch_mm = 1.0;
        hole.speed_rpm = 0.01 * t->data.spindle_max_rpm;
        hole.out_speed_rpm = hole.dwell_s = hole.peck_mm = hole.chip_break_mm = 0.0;
        hole.has_start_angle = 0;
    }
    t->planned_tolerance_um =
        t->tolerance > 0.0 ? t->tolerance : rigidtap_machine_tolerance_um(t->machine, hole.pitch_mm);
    return rigidtap_tap_plan(t->tap, t->machine, &hole, &t->fault);
}

static int checked(tap_t *t)
{
    double share = t->period_s / t->data.period_s;
    if (!(share > 1.0 - PERIOD_SHARE && share < 1.0 + PERIOD_SHARE)) {
        t->fault.found = t->data.period_s;
        t->fault.limit = t->period_s;
        rtapi_print_msg(RTAPI_MSG_ERR, "rigidtap.%d: control.period-s is not the thread's period of %ld ns\n", t->number,
                        (long)(1e9 * t->period_s + 0.5));
        return ALARM_PERIOD;
    }
    return RIGIDTAP_OK;
}

void plan(void *arg, long period)
{
    tap_t *t = arg;
    int status;
    (void)period;
    if (!is_planning(t) || !take_tap(t)) return;
    note_takes(t);
    status = checked(t);
    if (status == RIGIDTAP_OK) status = rigidtap_machine_init(t->machine, &t->data, &t->fault);
    if (status >= RIGIDTAP_MACHINE_OUT_OF_RANGE && status <= RIGIDTAP_MACHINE_CONTRADICTION)
        rtapi_print_msg(RTAPI_MSG_ERR, "rigidtap.%d: the machine's %s is not possible, status %d\n", t->number,
                        t->fault.key[0] ? t->fault.key : "data", status);
    if (status == RIGIDTAP_OK) status = t->plan_kind == PLAN_RESTORE ? plan_restore(t) : plan_hole(t);
    t->plan_status = status;
    give_tap(t);
    __atomic_store_n(&t->plan_state, PLAN_MADE, __ATOMIC_RELEASE);
}
