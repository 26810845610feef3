/* rigidtap: a HAL component that taps rigidly between motion and the drives of spindle and Z.
 *
 * While idle, both commands pass through. Once started with Z at rest on R it takes both over, brings the spindle to rest,
 * taps the whole cycle, and hands Z back where it took it; meanwhile motion is shown a Z that rests at R.
 *
 * Functions: rigidtap.N.update, in the servo thread after motion-controller and before the drives; rigidtap.N.plan, in a
 * slower thread or in the same one: it plans the hole, which takes longer than a short period.
 */
#include "rigidtap_hal.h"
#include "rtapi_app.h"

MODULE_AUTHOR("The rigidtap authors");
MODULE_DESCRIPTION("True rigid tapping: spindle and Z on one command");
MODULE_LICENSE("GPL");

static int count = 1;
RTAPI_MP_INT(count, "spindles that tap, 1 to 4");

/* Motion says "in position" for a period more when a new move begins. */
#define PERIODS_AT_REST 2

static rigidtap_machine machines[MOST];
static rigidtap_tap control[MOST];
static tap_t *taps[MOST];
static int component;

static void finish(tap_t *t, int alarm)
{
    *t->alarm = alarm;
    *t->fault_found = t->fault.found;
    *t->fault_limit = t->fault.limit;
    if (alarm) t->is_latched = 1;
    if (*t->state >= SETTLING) {
        note_end(t);
        t->hands_over = 1;
        /* Of a hole that was broken off the record stays: the tap is still in it. */
        if (t->setpoint.stage == RIGIDTAP_DONE) *t->record_valid = 0;
    }
    if (*t->state < SETTLING || t->setpoint.stage != RIGIDTAP_DONE) {
        /* A plan in the making is of a hole that is not begun. */
        if (take_tap(t)) {
            rigidtap_tap_release(t->tap);
            give_tap(t);
        }
    }
    /* Motion was off, and is shown where Z is. */
    if (t->is_restored) t->is_off = 1;
    t->is_restored = 0;
    *t->state = FINISHED;
}

static void arm(tap_t *t)
{
    clear_report(t);
    t->ordered_alarm = 0;
    __builtin_memset(&t->setpoint, 0, sizeof(t->setpoint));
    *t->state = ARMED;
    want_plan(t, t->is_restored ? PLAN_RESTORE : PLAN_HOLE);
}

static void begin(tap_t *t, int status)
{
    t->shift_rev = 0.0;
    t->is_on_model = 0;
    t->began_s = t->now_s;
    t->position_before = *t->spindle_position;
    if (status == RIGIDTAP_OK)
        *t->state = SETTLING;
    else
        finish(t, status);
}

/* Takes spindle and Z over once there is a plan and Z rests on R. */
static void take_over(tap_t *t)
{
    double rpm = *t->spindle_speed;
    if (!*t->start) {
        finish(t, ALARM_ABORTED);
        return;
    }
    if (!is_planned(t)) return;
    if (t->plan_status != RIGIDTAP_OK) {
        finish(t, t->plan_status);
        return;
    }
    if (t->periods_at_rest < 1) return;
    if (!near(*t->z_command_in, t->planned_r_mm)) {
        /* It was planned on the way to R. */
        want_plan(t, PLAN_HOLE);
        return;
    }
    if (t->periods_at_rest < PERIODS_AT_REST || t->residual_rev != 0.0) return;
    t->r_plane_mm = *t->z_command_in;
    t->target_rev = *t->spindle_position;
    if (is_positioned(t)) {
        t->target_rev = t->commanded.spindle.position;
        rpm = RPM_PER_REV_PER_S * t->commanded.spindle.velocity;
    }
    /* The setpoint of this period acts at its end: the spindle starts to brake at its beginning. */
    begin(t, rigidtap_tap_start(t->tap, t->now_s - t->period_s, counts_of(t->target_rev, t->data.spindle_counts_per_rev),
                                rpm, &t->fault));
}

/* Takes over spindle and Z of a machine that is off, in the hole in which the power left the tap. */
static void take_over_restored(tap_t *t)
{
    int status = t->plan_status;
    if (!is_planned(t)) return;
    /* Z counts from where its encoder does. */
    t->r_plane_mm = 0.0;
    t->target_rev = *t->spindle_position;
    *t->z_command_out = *t->z_feedback_in;
    if (status == RIGIDTAP_OK) status = rigidtap_tap_start(t->tap, t->now_s, 0, 0.0, &t->fault);
    begin(t, status);
}

static void obey(tap_t *t)
{
    int moves = !t->is_restored && !near(*t->z_command_in, t->r_plane_mm);
    /* Motion that is switched on meanwhile would move Z. */
    int aborts = *t->abort || moves || (t->is_restored ? *t->enable : !*t->start);
    if (aborts && !t->was_aborted) {
        rigidtap_tap_stop(t->tap, t->now_s);
        if (!t->ordered_alarm) t->ordered_alarm = moves ? ALARM_Z_MOVES : ALARM_ABORTED;
    }
    if (*t->hold && !t->was_held && !t->ordered_alarm) rigidtap_tap_stop(t->tap, t->now_s);
    if (!*t->hold && t->was_held && !t->ordered_alarm) rigidtap_tap_resume(t->tap, t->now_s);
    if (*t->retract && !t->was_retract && rigidtap_tap_retract(t->tap, t->now_s) == RIGIDTAP_OK && !t->ordered_alarm &&
        !t->is_restored)
        t->ordered_alarm = ALARM_ABORTED;
    t->was_aborted = aborts;
    t->was_held = *t->hold;
    t->was_retract = *t->retract;
}

static void tap_on(tap_t *t)
{
    static const int state_of[] = {IDLE,     SETTLING, TAPPING, BRAKING, HOLDING, RETRACTING,
                                   FINISHED, HOLDING,  BRAKING, BRAKING, BRAKING};
    rigidtap_feedback feedback;
    int status;
    obey(t);
    read_drives(t, &feedback);
    status = rigidtap_tap_step(t->tap, t->now_s, &feedback, &t->setpoint, &t->fault);
    if (status != RIGIDTAP_OK) {
        finish(t, status);
        return;
    }
    if (t->setpoint.alarm.code != RIGIDTAP_ALARM_NONE && *t->alarm != (int)t->setpoint.alarm.code) {
        /* The control brakes both axes and holds them; the hole ends with this alarm, however it is left. */
        t->fault.found = *t->fault_found = t->setpoint.alarm.value;
        t->fault.limit = *t->fault_limit = t->setpoint.alarm.limit;
        t->ordered_alarm = *t->alarm = (int)t->setpoint.alarm.code;
        t->is_latched = 1;
    }
    *t->state = state_of[t->setpoint.stage];
    note_period(t);
    keep_record(t);
    follow_setpoint(t);
    t->offset_mm = t->is_restored ? 0.0 : *t->z_command_out - *t->z_command_in;
    if (*t->state == FINISHED) finish(t, t->ordered_alarm);
}

/* Rising acknowledge: an alarm is forgotten, in a hole once both axes rest. */
static void acknowledge(tap_t *t)
{
    int rises = *t->acknowledge && !t->was_acknowledge;
    t->was_acknowledge = *t->acknowledge;
    if (!rises || !t->is_latched) return;
    if (*t->state >= SETTLING && *t->state < FINISHED) {
        if (rigidtap_tap_acknowledge(t->tap) != RIGIDTAP_OK) return;
        /* A hole that waited for its start is not begun after an alarm. */
        if (near(t->setpoint.z.position, t->r_plane_mm)) rigidtap_tap_stop(t->tap, t->now_s);
        /* The control goes on from where its model stands, whatever an encoder that jumped or stood says: so does the loop. */
        if (t->is_on_model) t->shift_rev = *t->spindle_position - t->target_rev;
        t->is_on_model = 0;
    }
    t->is_latched = 0;
    *t->alarm = 0;
    *t->fault_found = *t->fault_limit = 0.0;
}

/* Time of the servo thread's clock; of a clock that is connected; or of the thread's periods, for a simulated machine. */
static void tick(tap_t *t, long period)
{
    long long ns = rtapi_get_time();
    t->period_s = period * 1e-9;
    t->now_s += t->nominal_time || !t->last_ns ? t->period_s : (double)(ns - t->last_ns) * 1e-9;
    if (IS_CONNECTED(t, clock)) t->now_s = *t->clock;
    t->last_ns = ns;
    if (*t->in_position && near(*t->z_command_in, t->z_command_before[0]))
        t->periods_at_rest++;
    else
        t->periods_at_rest = 0;
}

/* Orders that begin something. */
static void take_orders(tap_t *t)
{
    /* A plan of an order that was withdrawn may still be in the making: wait for it. */
    int planning = is_planning(t);
    if (*t->state == FINISHED && !*t->start && !*t->restore) *t->state = IDLE;
    acknowledge(t);
    if (*t->start && !t->was_started && (t->is_latched || *t->state >= SETTLING)) {
        /* Nothing is planned in a hole, nor before an alarm is acknowledged. */
        if (!*t->alarm) *t->alarm = RIGIDTAP_NOT_IN_TURN;
        t->is_latched = 1;
        if (*t->state == IDLE) *t->state = FINISHED;
        planning = 0;
    } else if (*t->state == IDLE && *t->start && !t->was_started && *t->enable) {
        if (!planning) arm(t);
    } else {
        planning = 0;
    }
    t->was_started = *t->start && !planning;
    if (*t->restore && !t->was_restore && *t->state == IDLE && !*t->enable && *t->saved_valid && !t->is_latched &&
        !is_planning(t)) {
        t->is_restored = 1;
        arm(t);
    }
    t->was_restore = *t->restore;
    if (*t->enable && !t->was_enabled && *t->state == IDLE && !is_planning(t)) want_plan(t, PLAN_WATCH);
    t->was_enabled = *t->enable;
}

static void update(void *arg, long period)
{
    tap_t *t = arg;
    tick(t, period);
    /* A drive without power follows nothing: what motion is shown is the truth again. */
    if (!*t->enable && !t->is_restored && *t->state >= ARMED && *t->state < FINISHED) {
        t->is_off = *t->state >= SETTLING;
        finish(t, ALARM_DISABLED);
    }
    take_orders(t);
    if (*t->state == ARMED) {
        t->was_aborted = t->was_held = 0;
        t->was_retract = *t->retract;
        if (t->is_restored)
            take_over_restored(t);
        else
            take_over(t);
    }
    /* What the drives were told in the period before is what their feedback answers to. */
    *t->z_true = *t->z_feedback_in;
    if (*t->state >= SETTLING && *t->state < FINISHED) {
        *t->z_feedback_out = *t->z_feedback_in - t->offset_mm;
        tap_on(t);
    } else {
        if (t->is_off) t->offset_mm = 0.0;
        *t->z_feedback_out = *t->z_feedback_in - t->offset_mm;
        pass(t);
    }
    t->z_command_before[1] = t->z_command_before[0];
    t->z_command_before[0] = *t->z_command_in;
    if (t->periods_seen < 2) t->periods_seen++;
    *t->busy = *t->state != IDLE && *t->state != FINISHED;
    *t->drives_enable = *t->enable || (t->is_restored && *t->state >= SETTLING);
    /* A hole that an alarm ended is over for the program, though the tap is still held. */
    *t->finished = *t->state == FINISHED || (*t->state == HOLDING && *t->alarm != 0);
    *t->holding = *t->state == HOLDING;
    *t->alarmed = *t->alarm != 0;
    *t->synchronous = *t->state >= TAPPING && *t->state < FINISHED;
}

int rtapi_app_main(void)
{
    char name[HAL_NAME_LEN + 1];
    int n;
    if (RIGIDTAP_CHECK() != RIGIDTAP_OK) {
        rtapi_print_msg(RTAPI_MSG_ERR, "rigidtap: header and library are of different versions\n");
        return -1;
    }
    if (count < 1 || count > MOST) {
        rtapi_print_msg(RTAPI_MSG_ERR, "rigidtap: count=%d, expected 1 to %d\n", count, MOST);
        return -1;
    }
    component = hal_init("rigidtap");
    if (component < 0) return component;
    for (n = 0; n < count; n++) {
        taps[n] = hal_malloc(sizeof(tap_t));
        if (!taps[n]) goto fail;
        __builtin_memset(taps[n], 0, sizeof(tap_t));
        taps[n]->number = n;
        taps[n]->machine = &machines[n];
        taps[n]->tap = &control[n];
        if (export_instance(taps[n], component)) goto fail;
        rtapi_snprintf(name, sizeof(name), "rigidtap.%d.update", n);
        if (hal_export_funct(name, update, taps[n], 1, 0, component)) goto fail;
        rtapi_snprintf(name, sizeof(name), "rigidtap.%d.plan", n);
        if (hal_export_funct(name, plan, taps[n], 1, 0, component)) goto fail;
    }
    return hal_ready(component);
fail:
    rtapi_print_msg(RTAPI_MSG_ERR, "rigidtap: no room in HAL memory for spindle %d\n", n);
    hal_exit(component);
    return -1;
}

void rtapi_app_exit(void)
{
    hal_exit(component);
}
