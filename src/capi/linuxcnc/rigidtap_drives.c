/* What the drives report and what they are told: in a hole by the control, between holes by motion. */
#include "rigidtap_hal.h"

/* Z is given back no faster, where a correction has left it beside R. */
#define GIVE_BACK_MM_PER_S 5.0
/* The spindle's reference is where it rests to this. */
#define SETTLED_REV 0.0005
/* Motion that is shown where Z is commands it there to this, whatever noise its encoder has. */
#define KNOWN_MM 0.1

int near(double a_mm, double b_mm) { return a_mm - b_mm <= MOVED_MM && b_mm - a_mm <= MOVED_MM; }

/* Within the limits; what is no number becomes the lower one. */
static double clamped(double value, double low, double high)
{
    if (!(value > low)) return low;
    return value < high ? value : high;
}

/* A command in rpm, within max-rpm; zero where it is no number. */
double spindle_limited(const tap_t *t, double rpm)
{
    return rpm == rpm ? clamped(rpm, -t->data.spindle_max_rpm, t->data.spindle_max_rpm) : 0.0;
}

/* A command of Z, no further from the last one than Z's speed allows; the last one where it is no number. */
static double z_limited(const tap_t *t, double z_mm)
{
    double most_mm = t->data.z_max_mm_per_s * t->period_s + MOVED_MM, last_mm = *t->z_command_out;
    return z_mm == z_mm ? clamped(z_mm, last_mm - most_mm, last_mm + most_mm) : last_mm;
}

int64_t counts_of(double position, double per_unit)
{
    double counts = position * per_unit;
    return (int64_t)(counts < 0.0 ? counts - 0.5 : counts + 0.5);
}

/* The spindle's drive has a position loop: the component tells it where to be, turning or at rest. */
int is_positioned(const tap_t *t) { return IS_CONNECTED(t, spindle_target); }

/* What of a setpoint the drives take, by what is connected. Around a drive that takes a speed the component itself closes the
 * position loop, with all of the speed that is wanted next; under full it is a frequency converter's, which Z follows. */
void note_takes(tap_t *t)
{
    t->data.spindle_takes = !is_positioned(t) ? (t->compensation == RIGIDTAP_COMPENSATION_FULL ? RIGIDTAP_TAKES_SPEED
                                                                                              : RIGIDTAP_TAKES_TORQUE)
                            : IS_CONNECTED(t, spindle_effort)   ? RIGIDTAP_TAKES_TORQUE
                            : IS_CONNECTED(t, spindle_velocity) ? RIGIDTAP_TAKES_VELOCITY
                                                                : RIGIDTAP_TAKES_POSITION;
    t->data.z_takes = IS_CONNECTED(t, z_effort)     ? RIGIDTAP_TAKES_TORQUE
                      : IS_CONNECTED(t, z_velocity) ? RIGIDTAP_TAKES_VELOCITY
                                                    : RIGIDTAP_TAKES_POSITION;
}

void read_drives(const tap_t *t, rigidtap_feedback *feedback)
{
    __builtin_memset(feedback, 0, sizeof(*feedback));
    feedback->spindle_counts = counts_of(*t->spindle_position, t->data.spindle_counts_per_rev);
    feedback->z_counts = counts_of(*t->z_feedback_in, t->data.z_counts_per_mm);
    feedback->z_motor_counts = counts_of(*t->z_motor, t->data.z_motor_counts_per_mm);
    feedback->spindle_torque_nm = *t->spindle_torque;
    feedback->z_force_n = *t->z_force;
    feedback->reported = RIGIDTAP_REPORTS_SPINDLE_DRIVE | RIGIDTAP_REPORTS_Z_DRIVE |
                         (IS_CONNECTED(t, z_motor) ? RIGIDTAP_REPORTS_Z_MOTOR : 0) |
                         (IS_CONNECTED(t, spindle_torque) ? RIGIDTAP_REPORTS_SPINDLE_TORQUE : 0) |
                         (IS_CONNECTED(t, z_force) ? RIGIDTAP_REPORTS_Z_FORCE : 0) |
                         (IS_CONNECTED(t, spindle_saturated) ? RIGIDTAP_REPORTS_SPINDLE_SATURATED : 0) |
                         (IS_CONNECTED(t, z_saturated) ? RIGIDTAP_REPORTS_Z_SATURATED : 0);
    feedback->status = (*t->spindle_valid ? 0 : RIGIDTAP_SPINDLE_INVALID) | (*t->z_valid ? 0 : RIGIDTAP_Z_INVALID) |
                       (*t->spindle_ready ? 0 : RIGIDTAP_SPINDLE_NOT_READY) | (*t->z_ready ? 0 : RIGIDTAP_Z_NOT_READY) |
                       (*t->spindle_saturated ? RIGIDTAP_SPINDLE_SATURATED : 0) |
                       (*t->z_saturated ? RIGIDTAP_Z_SATURATED : 0);
}

/* All that a drive may take of `commanded`; which of it is connected is the machine's matter. */
void write_drives(tap_t *t)
{
    const rigidtap_commanded *c = &t->commanded;
    *t->z_command_out = z_limited(t, c->z.position);
    *t->z_velocity = c->z.velocity;
    *t->z_effort = t->data.z_mass_kg * c->z.acceleration / MM_PER_M + c->z_force_n;
    *t->spindle_target = c->spindle.position + t->shift_rev;
    *t->spindle_velocity = spindle_limited(t, RPM_PER_REV_PER_S * c->spindle.velocity);
    *t->spindle_effort =
        t->data.spindle_inertia_kg_m2 * RAD_PER_REV * c->spindle.acceleration + c->spindle_torque_nm;
}

/* The motor's torque at a speed: power is linear in speed between points. */
static double torque_nm(const rigidtap_machine_data *data, double rpm)
{
    const rigidtap_torque_point *low = data->torque_curve, *high = low;
    uint32_t n;
    double share, power;
    for (n = 1; n < data->torque_points && n < RIGIDTAP_MAX_TORQUE_POINTS; n++) {
        low = high;
        high = &data->torque_curve[n];
        if (rpm < high->speed_rpm) break;
    }
    if (!(rpm > 1.0) || !(high->speed_rpm > low->speed_rpm)) return data->torque_curve[0].torque_nm;
    share = clamped((rpm - low->speed_rpm) / (high->speed_rpm - low->speed_rpm), 0.0, 1.0);
    power = (1.0 - share) * low->speed_rpm * low->torque_nm + share * high->speed_rpm * high->torque_nm;
    return power / (rpm < high->speed_rpm ? rpm : high->speed_rpm);
}

/* A spindle with a position loop turns as motion wants, as fast as its motor's share lets it speed up. The acceleration is the mean
 * of the periods before and after, so that what a drive makes of it between is neither early nor late. */
static void turn(tap_t *t, double rpm)
{
    rigidtap_state *spindle = &t->commanded.spindle;
    double before = spindle->velocity, now = t->next_speed, speed = now < 0.0 ? -now : now;
    double most = t->data.motor_share * torque_nm(&t->data, RPM_PER_REV_PER_S * speed) /
                  (t->data.spindle_inertia_kg_m2 * RAD_PER_REV) * t->period_s;
    t->next_speed = now + clamped(rpm / RPM_PER_REV_PER_S - now, -most, most);
    spindle->velocity = now;
    spindle->position += 0.5 * (before + now) * t->period_s;
    spindle->acceleration = (t->next_speed - before) / (2.0 * t->period_s);
}

/* A reference that was shaped for the drive's loops stands beside where the spindle rests after a hole. That decays as the drive's
 * integrator takes it over, and the spindle turns again once it has. */
static double settled_rpm(tap_t *t, double rpm)
{
    rigidtap_state *spindle = &t->commanded.spindle;
    double kept = 1.0 - t->period_s / t->data.spindle_integral_s;
    if (t->hands_over && t->data.spindle_takes != RIGIDTAP_TAKES_TORQUE) {
        t->residual_rev = spindle->position - *t->spindle_position;
        spindle->velocity = t->next_speed = 0.0;
    }
    if (t->residual_rev == 0.0) return rpm;
    spindle->position -= t->residual_rev;
    t->residual_rev *= clamped(kept, 0.0, 1.0);
    if (t->residual_rev < SETTLED_REV && t->residual_rev > -SETTLED_REV) t->residual_rev = 0.0;
    spindle->position += t->residual_rev;
    return 0.0;
}

/* Motion's command of Z a period ago, with the speed and acceleration that the commands before and after it say. */
static void move(tap_t *t)
{
    rigidtap_state *z = &t->commanded.z;
    double after = *t->z_command_in, now = t->z_command_before[0], before = t->z_command_before[1];
    if (t->periods_seen < 2) now = before = after;
    z->position = now;
    z->velocity = (after - before) / (2.0 * t->period_s);
    z->acceleration = (after - 2.0 * now + before) / (t->period_s * t->period_s);
    if (!(z->velocity == z->velocity && z->acceleration == z->acceleration)) z->velocity = z->acceleration = 0.0;
}

/* Shows the control this period between holes; what the last hole left beside Z's setpoints. */
static rigidtap_residual observed(tap_t *t)
{
    rigidtap_residual residual = {{0.0, 0.0, 0.0}, 0.0};
    rigidtap_feedback feedback;
    read_drives(t, &feedback);
    if (t->compensation == RIGIDTAP_COMPENSATION_FULL) {
        (void)rigidtap_tap_observe(t->tap, t->now_s, &feedback, &residual);
    } else {
        (void)rigidtap_tap_observe(t->tap, t->now_s, &feedback, 0);
    }
    return residual;
}

/* Commands of motion pass; what is left beside R is given back slowly. */
void pass(tap_t *t)
{
    double most_mm = GIVE_BACK_MM_PER_S * t->period_s;
    double rpm = t->is_latched ? 0.0 : spindle_limited(t, *t->spindle_command_in);
    rigidtap_commanded *c = &t->commanded;
    rigidtap_residual residual = {{0.0, 0.0, 0.0}, 0.0};
    int has_tap = take_tap(t);
    c->spindle_torque_nm = c->z_force_n = 0.0;
    if (t->hands_over) t->next_speed = c->spindle.velocity;
    if (is_positioned(t) && *t->enable) {
        c->spindle.position += t->shift_rev;
        turn(t, settled_rpm(t, rpm));
    } else {
        /* A drive without power goes nowhere, and one without a position loop says itself where it is. */
        c->spindle.position = *t->spindle_position;
        c->spindle.velocity = c->spindle.acceleration = t->next_speed = 0.0;
    }
    t->shift_rev = 0.0;
    if (has_tap) residual = observed(t);
    if (t->hands_over) {
        t->left_over_mm = *t->z_command_out - *t->z_command_in - residual.z.position;
        t->residual_mm = residual.z.position;
    }
    t->hands_over = 0;
    if (!*t->enable) {
        /* A drive without power goes nowhere: it will hold Z where it then is. */
        t->is_off = 1;
        t->left_over_mm = t->residual_mm = 0.0;
        *t->z_command_out = *t->z_feedback_in;
    } else if (t->is_off) {
        /* Motion, shown where Z is, has its command there; else Z is held. */
        t->left_over_mm = *t->z_command_out - *t->z_command_in;
        t->is_off = !(t->left_over_mm < KNOWN_MM && t->left_over_mm > -KNOWN_MM);
        if (t->is_off) t->left_over_mm = 0.0;
    }
    if (t->is_off) {
        c->z.position = *t->z_command_out;
        c->z.velocity = c->z.acceleration = 0.0;
    } else {
        /* What is left and was not taken along, since a period went unseen, is given back, too. */
        t->left_over_mm += t->residual_mm != 0.0 && residual.z.position == 0.0 ? t->residual_mm : 0.0;
        t->residual_mm = residual.z.position;
        t->left_over_mm -= clamped(t->left_over_mm, -most_mm, most_mm);
        move(t);
        c->z.position += t->left_over_mm + residual.z.position;
        c->z.velocity += residual.z.velocity;
        c->z_force_n = residual.z_force_n;
    }
    t->offset_mm = t->left_over_mm + t->residual_mm;
    write_drives(t);
    *t->spindle_command_out = rpm;
    if (has_tap) {
        (void)rigidtap_tap_note_commanded(t->tap, c);
        give_tap(t);
    }
}

/* The setpoint of a hole's period. */
void follow_setpoint(tap_t *t)
{
    const rigidtap_setpoint *s = &t->setpoint;
    double before_rev = t->target_rev, feedforward, rpm;
    t->target_rev = s->spindle.position;
    t->commanded.spindle = s->spindle;
    t->commanded.z = s->z;
    t->commanded.spindle_torque_nm = s->spindle_torque_nm;
    t->commanded.z_force_n = s->z_force_n;
    /* A drive with a speed alone: that which gets there in one period; what the spindle is behind is caught up with the gain. */
    feedforward = (t->target_rev - before_rev) / t->period_s;
    rpm = RPM_PER_REV_PER_S *
          (feedforward +
           t->data.spindle_position_gain_per_s * (before_rev + t->shift_rev - *t->spindle_position));
    if (t->data.spindle_takes == RIGIDTAP_TAKES_SPEED) rpm = RPM_PER_REV_PER_S * s->spindle.velocity;
    /* An encoder that is not believed closes no loop: the spindle goes by the plan, and then stands. */
    if (s->stage == RIGIDTAP_MODEL_STOP) {
        t->is_on_model = 1;
        rpm = RPM_PER_REV_PER_S * feedforward;
    }
    if (s->stage == RIGIDTAP_HELD) rpm = 0.0;
    *t->spindle_command_out = spindle_limited(t, rpm);
    write_drives(t);
}
