/* rigidtap: a HAL component that taps rigidly between motion and the drives of spindle and Z.
 *
 * While idle, both commands pass through. Once started with Z at rest on R it takes both over, brings the spindle to rest,
 * taps the whole cycle, and hands Z back where it took it; meanwhile motion is shown a Z that rests at R.
 *
 * Functions: rigidtap.N.update, in the servo thread after motion-controller and before the drives; rigidtap.N.plan, in a
 * slower thread or in the same one: it plans the hole, which takes longer than a short period.
 */
#include "rtapi.h"
#include "rtapi_app.h"
#include "hal.h"
#include "rigidtap.h"

MODULE_AUTHOR("The rigidtap authors");
MODULE_DESCRIPTION("True rigid tapping: spindle and Z on one command");
MODULE_LICENSE("GPL");

#define MOST 4
static int count = 1;
RTAPI_MP_INT(count, "spindles that tap, 1 to 4");

/* Pin `state`. From 2 on the component has spindle and Z. */
enum { IDLE = 0, ARMED = 1, SETTLING = 2, TAPPING = 3, BRAKING = 4, HOLDING = 5, RETRACTING = 6, FINISHED = 7 };

/* Pin `alarm`: a RIGIDTAP_... status below 100, a RIGIDTAP_ALARM_... of the control from 101 on, or one of these. */
enum { ALARM_ABORTED = 201, ALARM_DISABLED = 202, ALARM_Z_MOVES = 203 };

/* A plan wanted and a plan made, between two threads. */
enum { PLAN_NONE = 0, PLAN_WANTED = 1, PLAN_MADE = 2 };

/* A record as HAL pins. */
#define RECORD_WORDS 16

/* Z is given back no faster, where a correction has left it beside R. */
#define GIVE_BACK_MM_PER_S 5.0
#define UM_PER_MM 1000.0
/* Motion says "in position" for a period more when a new move begins. */
#define PERIODS_AT_REST 2
/* Below any encoder's count. */
#define MOVED_MM 1e-6

typedef struct {
    /* from motion, and to it */
    hal_float_t *z_command_in, *z_feedback_out, *spindle_command_in;
    hal_bit_t *enable, *in_position;
    /* from the drives, and to them */
    hal_float_t *z_feedback_in, *z_command_out, *spindle_position, *spindle_speed, *spindle_command_out, *spindle_target;
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
    /* what the drives say of themselves */
    hal_bit_t *spindle_valid, *z_valid, *spindle_ready, *z_ready;
    /* the report */
    hal_bit_t *busy, *finished, *holding, *alarmed;
    hal_s32_t *state, *alarm;
    hal_float_t *fault_found, *fault_limit, *z_true;
    hal_float_t *error_um, *error_min_um, *error_max_um, *error_peak_um, *depth_reached;
    /* the machine */
    hal_float_t max_rpm, rated_rpm, accel, share, jerk, spindle_counts, z_counts, z_max_velocity, z_max_acceleration;
    hal_float_t latency, spindle_gain, error_limit_um;
    hal_u32_t law, compensation;

    rigidtap_machine machine;
    rigidtap_tap tap;
    rigidtap_setpoint setpoint;
    rigidtap_fault fault;
    int plan_state, plan_status;
    double period_s, now_s;
    double r_plane_mm, target_rev, left_over_mm, z_command_before;
    int periods_at_rest, was_started, was_aborted, was_held, was_retract, is_off, ordered_alarm;
    /* An alarm that nobody has acknowledged: the spindle is commanded to stand. */
    int is_latched, was_acknowledge;
    /* The tap is led out of a hole in which the power left it, the machine off. */
    int is_restored, was_restore;
    /* The alarm was of samples that are not believed; and what the spindle's encoder is off since. */
    int is_on_model;
    double shift_rev;
} tap_t;

static tap_t *taps[MOST];
static int component;

static int near(double a_mm, double b_mm)
{
    return a_mm - b_mm <= MOVED_MM && b_mm - a_mm <= MOVED_MM;
}

/* Within the limits; what is no number becomes the lower one. */
static double clamped(double value, double low, double high)
{
    if (!(value > low)) return low;
    return value < high ? value : high;
}

/* A command in rpm, within max-rpm; zero where it is no number. */
static double spindle_limited(const tap_t *t, double rpm)
{
    return rpm == rpm ? clamped(rpm, -t->max_rpm, t->max_rpm) : 0.0;
}

/* A command of Z, no further from the last one than Z's speed allows; the last one where it is no number. */
static double z_limited(const tap_t *t, double z_mm)
{
    double most_mm = t->z_max_velocity * t->period_s + MOVED_MM;
    return z_mm == z_mm ? clamped(z_mm, *t->z_command_out - most_mm, *t->z_command_out + most_mm) : *t->z_command_out;
}

static int64_t counts_of(double position, double per_unit)
{
    double counts = position * per_unit;
    return (int64_t)(counts < 0.0 ? counts - 0.5 : counts + 0.5);
}

/* Two equal torques up to the rated speed, constant power above it. Of torque and inertia only the quotient matters. */
static void machine_data(const tap_t *t, rigidtap_machine_data *data)
{
    const double rev_per_min = 60.0, rad_per_rev = 6.283185307179586;
    double torque_nm;
    rigidtap_machine_reference(data);
    data->period_s = t->period_s;
    data->latency_periods = t->latency;
    data->spindle_max_rpm = t->max_rpm;
    data->spindle_coulomb_nm = 0.0;
    data->spindle_viscous_nm_per_rpm = 0.0;
    data->spindle_counts_per_rev = t->spindle_counts;
    data->drive_period_s = t->period_s / 8.0;
    torque_nm = t->accel / rev_per_min * rad_per_rev * data->spindle_inertia_kg_m2;
    data->torque_points = t->rated_rpm < t->max_rpm ? 3 : 2;
    data->torque_curve[0].speed_rpm = 0.0;
    data->torque_curve[0].torque_nm = torque_nm;
    data->torque_curve[1].speed_rpm = data->torque_points == 3 ? t->rated_rpm : t->max_rpm;
    data->torque_curve[1].torque_nm = torque_nm;
    data->torque_curve[2].speed_rpm = t->max_rpm;
    data->torque_curve[2].torque_nm = torque_nm * t->rated_rpm / t->max_rpm;
    data->motor_share = t->share;
    data->law = t->law;
    data->jerk_rpm_per_s2 = t->jerk;
    data->z_max_mm_per_s = t->z_max_velocity;
    data->z_max_mm_per_s2 = t->z_max_acceleration;
    data->z_counts_per_mm = t->z_counts;
    data->spindle_position_gain_per_s = t->spindle_gain;
    data->supervision_error_limit_um = t->error_limit_um;
}

/* The way out of a hole, from the record that was kept and where the axes stand. */
static rigidtap_status plan_restore(tap_t *t)
{
    rigidtap_feedback feedback = {0};
    rigidtap_record record;
    uint32_t words[RECORD_WORDS];
    int n;
    for (n = 0; n < RECORD_WORDS; n++) words[n] = *t->saved[n];
    __builtin_memcpy(record.bytes, words, sizeof(record.bytes));
    feedback.spindle_counts = counts_of(*t->spindle_position, t->spindle_counts);
    feedback.z_counts = counts_of(*t->z_feedback_in, t->z_counts);
    feedback.status = (*t->spindle_valid ? 0 : RIGIDTAP_SPINDLE_INVALID) | (*t->z_valid ? 0 : RIGIDTAP_Z_INVALID);
    return rigidtap_tap_plan_retract(&t->tap, &t->machine, &record, &feedback, 0.0, t->compensation, &t->fault);
}

static void plan(void *arg, long period)
{
    tap_t *t = arg;
    rigidtap_machine_data data;
    rigidtap_hole hole = {0};
    (void)period;
    if (__atomic_load_n(&t->plan_state, __ATOMIC_ACQUIRE) != PLAN_WANTED) return;
    machine_data(t, &data);
    t->plan_status = rigidtap_machine_init(&t->machine, &data, &t->fault);
    if (t->plan_status == RIGIDTAP_OK && t->compensation > RIGIDTAP_COMPENSATION_PAPER) {
        rtapi_print_msg(RTAPI_MSG_ERR,
                        "rigidtap: compensation=%u, expected 0 (none) or 1 (paper): full (2) hands torque and force to "
                        "the drives, and there are no pins for them\n",
                        (unsigned)t->compensation);
        t->fault.found = t->compensation;
        t->fault.limit = RIGIDTAP_COMPENSATION_PAPER;
        t->plan_status = RIGIDTAP_UNKNOWN_CHOICE;
    }
    if (t->plan_status == RIGIDTAP_OK && t->is_restored) {
        t->plan_status = plan_restore(t);
    } else if (t->plan_status == RIGIDTAP_OK) {
        /* Z counts from R: where that is shows when Z gets there. */
        hole.bottom_mm = -*t->depth;
        hole.pitch_mm = *t->pitch;
        hole.speed_rpm = *t->speed;
        hole.out_speed_rpm = *t->out_speed;
        hole.dwell_s = *t->dwell;
        hole.peck_mm = *t->peck;
        hole.chip_break_mm = *t->chip_break;
        hole.hand = *t->left_hand ? RIGIDTAP_HAND_LEFT : RIGIDTAP_HAND_RIGHT;
        hole.compensation = t->compensation;
        hole.has_start_angle = *t->has_start_angle;
        hole.start_angle_deg = *t->start_angle;
        t->plan_status = rigidtap_tap_plan(&t->tap, &t->machine, &hole, &t->fault);
    }
    __atomic_store_n(&t->plan_state, PLAN_MADE, __ATOMIC_RELEASE);
}

static void finish(tap_t *t, int alarm)
{
    *t->alarm = alarm;
    *t->fault_found = t->fault.found;
    *t->fault_limit = t->fault.limit;
    if (alarm) t->is_latched = 1;
    rigidtap_tap_release(&t->tap);
    if (*t->state >= SETTLING) t->left_over_mm = *t->z_command_out - *t->z_command_in;
    /* Of a hole that was broken off the record stays: the tap is still in it. */
    if (*t->state >= SETTLING && t->setpoint.stage == RIGIDTAP_DONE) *t->record_valid = 0;
    /* Motion was off, and is shown where Z is. */
    if (t->is_restored) t->is_off = 1;
    t->is_restored = 0;
    *t->state = FINISHED;
}

static void arm(tap_t *t)
{
    *t->alarm = 0;
    *t->fault_found = *t->fault_limit = 0.0;
    *t->error_um = *t->error_min_um = *t->error_max_um = *t->error_peak_um = *t->depth_reached = 0.0;
    t->ordered_alarm = 0;
    *t->state = ARMED;
    __atomic_store_n(&t->plan_state, PLAN_WANTED, __ATOMIC_RELEASE);
}

/* Takes spindle and Z over once there is a plan and Z rests on R. */
static void take_over(tap_t *t)
{
    int status;
    if (!*t->start) {
        finish(t, ALARM_ABORTED);
        return;
    }
    if (__atomic_load_n(&t->plan_state, __ATOMIC_ACQUIRE) != PLAN_MADE) return;
    if (t->plan_status != RIGIDTAP_OK) {
        finish(t, t->plan_status);
        return;
    }
    if (t->periods_at_rest < PERIODS_AT_REST) return;
    t->r_plane_mm = *t->z_command_in;
    t->target_rev = *t->spindle_position;
    t->shift_rev = 0.0;
    t->is_on_model = 0;
    /* The setpoint of this period acts at its end: the spindle starts to brake at its beginning. */
    status = rigidtap_tap_start(&t->tap, t->now_s - t->period_s, counts_of(t->target_rev, t->spindle_counts),
                                *t->spindle_speed, &t->fault);
    if (status == RIGIDTAP_OK)
        *t->state = SETTLING;
    else
        finish(t, status);
}

/* Takes over spindle and Z of a machine that is off, in the hole in which the power left the tap. */
static void take_over_restored(tap_t *t)
{
    int status;
    if (__atomic_load_n(&t->plan_state, __ATOMIC_ACQUIRE) != PLAN_MADE) return;
    status = t->plan_status;
    /* Z counts from where its encoder does. */
    t->r_plane_mm = 0.0;
    t->target_rev = *t->spindle_position;
    t->shift_rev = 0.0;
    t->is_on_model = 0;
    *t->z_command_out = *t->z_feedback_in;
    if (status == RIGIDTAP_OK) status = rigidtap_tap_start(&t->tap, t->now_s, 0, 0.0, &t->fault);
    if (status == RIGIDTAP_OK)
        *t->state = SETTLING;
    else
        finish(t, status);
}

static void obey(tap_t *t)
{
    int moves = !t->is_restored && !near(*t->z_command_in, t->r_plane_mm);
    /* Motion that is switched on meanwhile would move Z. */
    int aborts = *t->abort || moves || (t->is_restored ? *t->enable : !*t->start);
    if (aborts && !t->was_aborted) {
        rigidtap_tap_stop(&t->tap, t->now_s);
        if (!t->ordered_alarm) t->ordered_alarm = moves ? ALARM_Z_MOVES : ALARM_ABORTED;
    }
    if (*t->hold && !t->was_held && !t->ordered_alarm) rigidtap_tap_stop(&t->tap, t->now_s);
    if (!*t->hold && t->was_held && !t->ordered_alarm) rigidtap_tap_resume(&t->tap, t->now_s);
    if (*t->retract && !t->was_retract && rigidtap_tap_retract(&t->tap, t->now_s) == RIGIDTAP_OK && !t->ordered_alarm &&
        !t->is_restored)
        t->ordered_alarm = ALARM_ABORTED;
    t->was_aborted = aborts;
    t->was_held = *t->hold;
    t->was_retract = *t->retract;
}

static void note_error(tap_t *t)
{
    double error_um = t->setpoint.error_mm * UM_PER_MM, depth_mm = t->r_plane_mm - *t->z_feedback_in;
    *t->error_um = error_um;
    if (error_um < *t->error_min_um) *t->error_min_um = error_um;
    if (error_um > *t->error_max_um) *t->error_max_um = error_um;
    *t->error_peak_um = *t->error_max_um - *t->error_min_um;
    if (depth_mm > *t->depth_reached) *t->depth_reached = depth_mm;
}

/* The record of the hole under way, for a part of user space to keep. */
static void keep_record(tap_t *t)
{
    rigidtap_record record;
    uint32_t words[RECORD_WORDS];
    int n;
    *t->record_valid = rigidtap_tap_record(&t->tap, counts_of(t->r_plane_mm, t->z_counts), &record) == RIGIDTAP_OK;
    if (!*t->record_valid) return;
    __builtin_memcpy(words, record.bytes, sizeof(words));
    for (n = 0; n < RECORD_WORDS; n++) *t->record[n] = words[n];
}

static void tap_on(tap_t *t)
{
    static const int state_of[] = {IDLE,     SETTLING, TAPPING, BRAKING, HOLDING, RETRACTING,
                                   FINISHED, HOLDING,  BRAKING, BRAKING, BRAKING};
    rigidtap_feedback feedback = {0};
    double target_before_rev = t->target_rev, feedforward, rpm;
    int status;
    obey(t);
    feedback.spindle_counts = counts_of(*t->spindle_position, t->spindle_counts);
    feedback.z_counts = counts_of(*t->z_feedback_in - t->r_plane_mm, t->z_counts);
    feedback.reported = RIGIDTAP_REPORTS_SPINDLE_DRIVE | RIGIDTAP_REPORTS_Z_DRIVE;
    feedback.status = (*t->spindle_valid ? 0 : RIGIDTAP_SPINDLE_INVALID) | (*t->z_valid ? 0 : RIGIDTAP_Z_INVALID) |
                      (*t->spindle_ready ? 0 : RIGIDTAP_SPINDLE_NOT_READY) | (*t->z_ready ? 0 : RIGIDTAP_Z_NOT_READY);
    status = rigidtap_tap_step(&t->tap, t->now_s, &feedback, &t->setpoint, &t->fault);
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
    t->target_rev = t->setpoint.spindle.position;
    *t->state = state_of[t->setpoint.stage];
    if (*t->state >= TAPPING && *t->state <= RETRACTING) note_error(t);
    keep_record(t);
    /* The speed that gets there in one period; what the spindle is behind is caught up with the position gain. */
    feedforward = (t->target_rev - target_before_rev) / t->period_s;
    rpm = 60.0 * (feedforward + t->spindle_gain * (target_before_rev + t->shift_rev - *t->spindle_position));
    /* An encoder that is not believed closes no loop: the spindle goes by the plan, and then stands. */
    if (t->setpoint.stage == RIGIDTAP_MODEL_STOP) {
        t->is_on_model = 1;
        rpm = 60.0 * feedforward;
    }
    if (t->setpoint.stage == RIGIDTAP_HELD) rpm = 0.0;
    *t->spindle_command_out = spindle_limited(t, rpm);
    *t->z_command_out = z_limited(t, t->r_plane_mm + t->setpoint.z.position);
    if (*t->state == FINISHED) finish(t, t->ordered_alarm);
}

/* Commands of motion pass; what is left beside R is given back slowly. */
static void pass(tap_t *t)
{
    double most_mm = GIVE_BACK_MM_PER_S * t->period_s;
    double spindle_rpm = t->is_latched ? 0.0 : spindle_limited(t, *t->spindle_command_in);
    if (t->is_off) {
        /* A drive without power goes nowhere; motion, shown where Z is, moves its command there. */
        t->is_off = !near(*t->z_command_in, *t->z_command_out);
        *t->spindle_command_out = spindle_rpm;
        return;
    }
    if (t->left_over_mm > most_mm)
        t->left_over_mm -= most_mm;
    else if (t->left_over_mm < -most_mm)
        t->left_over_mm += most_mm;
    else
        t->left_over_mm = 0.0;
    *t->z_command_out = z_limited(t, *t->z_command_in + t->left_over_mm);
    *t->spindle_command_out = spindle_rpm;
    *t->spindle_target = *t->spindle_position;
}

/* Rising acknowledge: an alarm is forgotten, in a hole once both axes rest. */
static void acknowledge(tap_t *t)
{
    int rises = *t->acknowledge && !t->was_acknowledge;
    t->was_acknowledge = *t->acknowledge;
    if (!rises || !t->is_latched) return;
    if (*t->state >= SETTLING && *t->state < FINISHED) {
        if (rigidtap_tap_acknowledge(&t->tap) != RIGIDTAP_OK) return;
        /* A hole that waited for its start is not begun after an alarm. */
        if (near(t->setpoint.z.position, 0.0)) rigidtap_tap_stop(&t->tap, t->now_s);
        /* The control goes on from where its model stands, whatever an encoder that jumped or stood says: so does the loop. */
        if (t->is_on_model) t->shift_rev = *t->spindle_position - t->target_rev;
        t->is_on_model = 0;
    }
    t->is_latched = 0;
    *t->alarm = 0;
    *t->fault_found = *t->fault_limit = 0.0;
}

static void update(void *arg, long period)
{
    tap_t *t = arg;
    double offset_mm;
    int planning = 0;
    t->period_s = period * 1e-9;
    t->now_s += t->period_s;
    /* A drive without power follows nothing: what motion is shown is the truth again. */
    if (!*t->enable && !t->is_restored && *t->state >= ARMED && *t->state < FINISHED) {
        t->is_off = *t->state >= SETTLING;
        finish(t, ALARM_DISABLED);
    }
    if (*t->state == FINISHED && !*t->start && !*t->restore) *t->state = IDLE;
    acknowledge(t);
    if (*t->start && !t->was_started && (t->is_latched || *t->state >= SETTLING)) {
        /* Nothing is planned in a hole, nor before an alarm is acknowledged. */
        if (!*t->alarm) *t->alarm = RIGIDTAP_NOT_IN_TURN;
        t->is_latched = 1;
        if (*t->state == IDLE) *t->state = FINISHED;
    } else if (*t->state == IDLE && *t->start && !t->was_started && *t->enable) {
        /* A plan of an order that was withdrawn may still be in the making: wait for it. */
        planning = __atomic_load_n(&t->plan_state, __ATOMIC_ACQUIRE) == PLAN_WANTED;
        if (!planning) arm(t);
    }
    t->was_started = *t->start && !planning;
    if (*t->restore && !t->was_restore && *t->state == IDLE && !*t->enable && *t->saved_valid && !t->is_latched &&
        __atomic_load_n(&t->plan_state, __ATOMIC_ACQUIRE) != PLAN_WANTED) {
        t->is_restored = 1;
        arm(t);
    }
    t->was_restore = *t->restore;
    if (*t->in_position && near(*t->z_command_in, t->z_command_before))
        t->periods_at_rest++;
    else
        t->periods_at_rest = 0;
    t->z_command_before = *t->z_command_in;
    if (*t->state == ARMED) {
        t->was_aborted = t->was_held = 0;
        t->was_retract = *t->retract;
        if (t->is_restored)
            take_over_restored(t);
        else
            take_over(t);
    }
    /* What the drives were told in the period before is what their feedback answers to. */
    offset_mm = *t->z_command_out - *t->z_command_in;
    *t->z_true = *t->z_feedback_in;
    if (*t->state >= SETTLING && *t->state < FINISHED) {
        *t->z_feedback_out = *t->z_feedback_in - (t->is_restored ? 0.0 : offset_mm);
        tap_on(t);
        *t->spindle_target = t->target_rev + t->shift_rev;
    } else {
        if (t->is_off) t->left_over_mm = 0.0;
        *t->z_feedback_out = *t->z_feedback_in - t->left_over_mm;
        pass(t);
    }
    *t->busy = *t->state != IDLE && *t->state != FINISHED;
    *t->drives_enable = *t->enable || (t->is_restored && *t->state >= SETTLING);
    /* A hole that an alarm ended is over for the program, though the tap is still held. */
    *t->finished = *t->state == FINISHED || (*t->state == HOLDING && *t->alarm != 0);
    *t->holding = *t->state == HOLDING;
    *t->alarmed = *t->alarm != 0;
}

#define PIN(type, direction, field, name) \
    if (!failed) failed = hal_pin_##type##_newf(direction, &t->field, component, "rigidtap.%d." name, n)
#define PARAM(type, field, value, name)                                                                  \
    do {                                                                                                 \
        t->field = value;                                                                                \
        if (!failed) failed = hal_param_##type##_newf(HAL_RW, &t->field, component, "rigidtap.%d." name, n); \
    } while (0)

static int export_pins(tap_t *t, int n)
{
    int failed = 0, word;
    for (word = 0; word < RECORD_WORDS && !failed; word++) {
        failed = hal_pin_u32_newf(HAL_OUT, &t->record[word], component, "rigidtap.%d.record-%02d", n, word);
        if (!failed) failed = hal_pin_u32_newf(HAL_IN, &t->saved[word], component, "rigidtap.%d.saved-%02d", n, word);
    }
    PIN(bit, HAL_OUT, record_valid, "record-valid");
    PIN(bit, HAL_IN, saved_valid, "saved-valid");
    PIN(bit, HAL_IN, restore, "restore");
    PIN(bit, HAL_OUT, drives_enable, "drives-enable");
    PIN(float, HAL_IN, start_angle, "start-angle");
    PIN(bit, HAL_IN, has_start_angle, "has-start-angle");
    PIN(float, HAL_IN, z_command_in, "z-command-in");
    PIN(float, HAL_OUT, z_feedback_out, "z-feedback-out");
    PIN(float, HAL_IN, spindle_command_in, "spindle-command-in");
    PIN(bit, HAL_IN, enable, "enable");
    PIN(bit, HAL_IN, in_position, "in-position");
    PIN(float, HAL_IN, z_feedback_in, "z-feedback-in");
    PIN(float, HAL_OUT, z_command_out, "z-command-out");
    PIN(float, HAL_IN, spindle_position, "spindle-position");
    PIN(float, HAL_IN, spindle_speed, "spindle-speed");
    PIN(float, HAL_OUT, spindle_command_out, "spindle-command-out");
    PIN(float, HAL_OUT, spindle_target, "spindle-target");
    PIN(float, HAL_IN, pitch, "pitch");
    PIN(float, HAL_IN, depth, "depth");
    PIN(float, HAL_IN, speed, "speed");
    PIN(float, HAL_IN, out_speed, "out-speed");
    PIN(float, HAL_IN, dwell, "dwell");
    PIN(float, HAL_IN, peck, "peck");
    PIN(float, HAL_IN, chip_break, "chip-break");
    PIN(bit, HAL_IN, left_hand, "left-hand");
    PIN(bit, HAL_IN, start, "start");
    PIN(bit, HAL_IN, abort, "abort");
    PIN(bit, HAL_IN, hold, "hold");
    PIN(bit, HAL_IN, retract, "retract");
    PIN(bit, HAL_IN, acknowledge, "acknowledge");
    PIN(bit, HAL_IN, spindle_valid, "spindle-sample-valid");
    PIN(bit, HAL_IN, z_valid, "z-sample-valid");
    PIN(bit, HAL_IN, spindle_ready, "spindle-drive-ready");
    PIN(bit, HAL_IN, z_ready, "z-drive-ready");
    if (!failed) *t->spindle_valid = *t->z_valid = *t->spindle_ready = *t->z_ready = 1;
    PIN(bit, HAL_OUT, busy, "busy");
    PIN(bit, HAL_OUT, finished, "finished");
    PIN(bit, HAL_OUT, holding, "holding");
    PIN(bit, HAL_OUT, alarmed, "alarmed");
    PIN(s32, HAL_OUT, state, "state");
    PIN(s32, HAL_OUT, alarm, "alarm");
    PIN(float, HAL_OUT, fault_found, "fault-found");
    PIN(float, HAL_OUT, fault_limit, "fault-limit");
    PIN(float, HAL_OUT, z_true, "z-true");
    PIN(float, HAL_OUT, error_um, "error-um");
    PIN(float, HAL_OUT, error_min_um, "error-min-um");
    PIN(float, HAL_OUT, error_max_um, "error-max-um");
    PIN(float, HAL_OUT, error_peak_um, "error-peak-um");
    PIN(float, HAL_OUT, depth_reached, "depth-reached");
    PARAM(float, max_rpm, 8000.0, "max-rpm");
    PARAM(float, rated_rpm, 3000.0, "rated-rpm");
    PARAM(float, accel, 47746.483, "accel-rpm-per-s");
    PARAM(float, share, 0.8, "share");
    PARAM(float, jerk, 6.4e6, "jerk-rpm-per-s2");
    PARAM(u32, law, RIGIDTAP_LAW_TORQUE_LIMIT, "law");
    PARAM(u32, compensation, RIGIDTAP_COMPENSATION_NONE, "compensation");
    PARAM(float, spindle_counts, 16384.0, "spindle-counts-per-rev");
    PARAM(float, z_counts, 10000.0, "z-counts-per-mm");
    PARAM(float, z_max_velocity, 500.0, "z-max-velocity");
    PARAM(float, z_max_acceleration, 5000.0, "z-max-acceleration");
    PARAM(float, latency, 1.0, "latency-periods");
    PARAM(float, spindle_gain, 20.0, "spindle-gain");
    PARAM(float, error_limit_um, 0.0, "error-limit-um");
    return failed;
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
        taps[n] = hal_malloc(sizeof(tap_t) + 15);
        if (!taps[n]) goto fail;
        /* hal_malloc aligns to 8 bytes, the states want 16. */
        taps[n] = (tap_t *)(((uintptr_t)taps[n] + 15) & ~(uintptr_t)15);
        __builtin_memset(taps[n], 0, sizeof(tap_t));
        if (export_pins(taps[n], n)) goto fail;
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
