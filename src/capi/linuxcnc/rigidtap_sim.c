/* rigidtap_sim: a simulated machine in place of the drives and encoders of spindle and Z, in real time: friction, backlash,
 * resonances, encoders, drive loops, a work piece; what differs from the machine file is the file's [actual].
 *
 *   loadrt rigidtap_sim machine=FILE.toml seed=1
 *
 * Which of a setpoint a drive takes is what is connected: spindle-velocity-command alone, as a frequency converter; with
 * spindle-position-command a position drive; the velocity and torque pins beside it are feedforward. Z likewise.
 *
 * Function: rigidtap-sim.update, last in a servo thread whose period is the machine file's.
 */
#include "hal.h"
#include "rigidtap_sim.h"
#include "rtapi.h"
#include "rtapi_app.h"

#include <math.h>

MODULE_AUTHOR("The rigidtap authors");
MODULE_DESCRIPTION("Simulated machine: spindle and Z with drives, encoders and a work piece");
MODULE_LICENSE("GPL");

static char *machine = "";
RTAPI_MP_STRING(machine, "machine file; without it the reference machine");
static int seed = 1;
RTAPI_MP_INT(seed, "of everything random");

#define RPM_PER_REV_PER_S 60.0
#define UM_PER_MM 1000.0
/* The tool is clear of the work piece so far above it; there, at rest, the next hole is set up. */
#define CLEAR_MM 0.5
#define AT_REST_MM 1e-3

#define OPTIONAL_PINS(PIN)                                        \
    PIN(spindle_position_command, "spindle-position-command")     \
    PIN(spindle_velocity_command, "spindle-velocity-command")     \
    PIN(spindle_torque_command, "spindle-torque-command")         \
    PIN(z_position_command, "z-position-command")                 \
    PIN(z_velocity_command, "z-velocity-command")                 \
    PIN(z_force_command, "z-force-command")
#define FIELD(field, name) hal_float_t *field;

typedef struct {
    OPTIONAL_PINS(FIELD)
    /* Where each points while nothing is connected. */
    struct { OPTIONAL_PINS(FIELD) } own;
    hal_bit_t *enable;
    hal_float_t *pitch, *surface, *depth;
    hal_float_t *spindle_position, *spindle_speed, *spindle_speed_rps, *spindle_revs, *spindle_torque;
    hal_float_t *z_position, *z_motor_position, *z_force;
    hal_bit_t *spindle_index_enable, *spindle_at_speed, *spindle_saturated, *z_saturated;
    hal_bit_t *spindle_ready, *z_ready, *spindle_valid, *z_valid, *reports_effort;
    hal_float_t *spindle_true, *z_true, *error_peak_um, *deepest;
    hal_float_t *clock;
    hal_bit_t *judge;
    hal_u32_t *holes;
    rigidtap_machine_data data;
    rigidtap_sim *sim;
    double index_rev, z_before;
    double zero_rev, zero_mm, error_low_um, error_high_um;
    int was_enabled, was_below, was_judged, has_failed;
} sim_t;

static sim_t *s;
static int component;

#define IS_CONNECTED(field) (s->field != s->own.field)

static rigidtap_sim *made(uint32_t takes_given, uint32_t spindle_takes, uint32_t z_takes, char *message, size_t bytes)
{
    rigidtap_sim_options options;
    __builtin_memset(&options, 0, sizeof(options));
    options.machine_file = machine[0] ? machine : 0;
    options.seed = (uint64_t)seed;
    options.takes_given = takes_given;
    options.spindle_takes = spindle_takes;
    options.z_takes = z_takes;
    return rigidtap_sim_new(&options, message, bytes);
}

/* The machine is made in the first period, when everything is connected. */
static int is_made(double period_s)
{
    char message[512];
    uint32_t spindle = !IS_CONNECTED(spindle_position_command)  ? RIGIDTAP_TAKES_SPEED
                       : IS_CONNECTED(spindle_torque_command)   ? RIGIDTAP_TAKES_TORQUE
                       : IS_CONNECTED(spindle_velocity_command) ? RIGIDTAP_TAKES_VELOCITY
                                                                : RIGIDTAP_TAKES_POSITION;
    uint32_t z = IS_CONNECTED(z_force_command)      ? RIGIDTAP_TAKES_TORQUE
                 : IS_CONNECTED(z_velocity_command) ? RIGIDTAP_TAKES_VELOCITY
                                                    : RIGIDTAP_TAKES_POSITION;
    if (s->sim || s->has_failed) return s->sim != 0;
    s->sim = made(1, spindle, z, message, sizeof(message));
    if (!s->sim) {
        rtapi_print_msg(RTAPI_MSG_ERR, "rigidtap_sim: %s\n", message);
        s->has_failed = 1;
    } else if (rigidtap_sim_machine_data(s->sim, &s->data), fabs(s->data.period_s - period_s) > 1e-3 * period_s) {
        rtapi_print_msg(RTAPI_MSG_ERR, "rigidtap_sim: the thread's period is %ld ns, the machine file's %ld ns\n",
                        (long)(1e9 * period_s + 0.5), (long)(1e9 * s->data.period_s + 0.5));
        rigidtap_sim_free(s->sim);
        s->sim = 0;
        s->has_failed = 1;
    }
    return s->sim != 0;
}

/* The tool came out of a hole and rests above the work piece: another one is under it. */
static void change_hole(const rigidtap_sim_truth_data *truth)
{
    rigidtap_hole hole;
    int rests = fabs(truth->z_mm - s->z_before) < AT_REST_MM;
    s->z_before = truth->z_mm;
    if (truth->z_mm < *s->surface) s->was_below = 1;
    if (*s->holes > 0 && !(s->was_below && rests && truth->z_mm > *s->surface + CLEAR_MM)) return;
    __builtin_memset(&hole, 0, sizeof(hole));
    hole.r_plane_mm = *s->surface + s->data.tap_surface_below_r_mm;
    hole.bottom_mm = hole.r_plane_mm - *s->depth;
    hole.pitch_mm = *s->pitch;
    hole.speed_rpm = 1.0;
    if (rigidtap_sim_begin_hole(s->sim, &hole) != RIGIDTAP_OK) return;
    s->was_below = 0;
    ++*s->holes;
}

/* The true e(k) from where it was begun to be judged: Z's travel into the hole less the pitch of the spindle's, either hand. */
static void judge(const rigidtap_sim_truth_data *truth)
{
    double error_um, left_um, travel_mm, turned_mm;
    if (*s->judge && !s->was_judged) {
        s->zero_rev = truth->spindle_rev;
        s->zero_mm = *s->deepest = truth->z_mm;
        s->error_low_um = s->error_high_um = 0.0;
    }
    s->was_judged = *s->judge;
    if (!*s->judge) return;
    travel_mm = s->zero_mm - truth->z_mm;
    turned_mm = *s->pitch * (truth->spindle_rev - s->zero_rev);
    error_um = UM_PER_MM * (travel_mm - turned_mm);
    left_um = UM_PER_MM * (travel_mm + turned_mm);
    if (fabs(left_um) < fabs(error_um)) error_um = left_um;
    s->error_low_um = fmin(s->error_low_um, error_um);
    s->error_high_um = fmax(s->error_high_um, error_um);
    *s->error_peak_um = s->error_high_um - s->error_low_um;
    *s->deepest = fmin(*s->deepest, truth->z_mm);
}

static void report(double period_s)
{
    rigidtap_feedback feedback;
    rigidtap_sim_truth_data truth;
    double before = *s->spindle_position, speed, wanted = *s->spindle_velocity_command;
    *s->clock = rigidtap_sim_clock_s(s->sim);
    rigidtap_sim_read(s->sim, &feedback);
    rigidtap_sim_truth(s->sim, &truth);
    *s->spindle_position = (double)feedback.spindle_counts / s->data.spindle_counts_per_rev;
    *s->z_position = (double)feedback.z_counts / s->data.z_counts_per_mm;
    *s->z_motor_position = (double)feedback.z_motor_counts / s->data.z_motor_counts_per_mm;
    *s->reports_effort = (feedback.reported & RIGIDTAP_REPORTS_SPINDLE_TORQUE) != 0;
    *s->spindle_torque = feedback.spindle_torque_nm;
    *s->z_force = feedback.z_force_n;
    *s->spindle_saturated = (feedback.status & RIGIDTAP_SPINDLE_SATURATED) != 0;
    *s->z_saturated = (feedback.status & RIGIDTAP_Z_SATURATED) != 0;
    *s->spindle_valid = (feedback.status & RIGIDTAP_SPINDLE_INVALID) == 0;
    *s->z_valid = (feedback.status & RIGIDTAP_Z_INVALID) == 0;
    *s->spindle_ready = *s->enable && (feedback.status & RIGIDTAP_SPINDLE_NOT_READY) == 0;
    *s->z_ready = *s->enable && (feedback.status & RIGIDTAP_Z_NOT_READY) == 0;
    *s->spindle_true = truth.spindle_rev;
    *s->z_true = truth.z_mm;
    speed = (*s->spindle_position - before) / period_s;
    *s->spindle_speed_rps = speed;
    *s->spindle_speed = RPM_PER_REV_PER_S * speed;
    if (*s->spindle_index_enable && floor(*s->spindle_position) != floor(before)) {
        s->index_rev = speed > 0.0 ? floor(*s->spindle_position) : floor(before);
        *s->spindle_index_enable = 0;
    }
    *s->spindle_revs = *s->spindle_position - s->index_rev;
    *s->spindle_at_speed = fabs(wanted - truth.spindle_rpm) <= 0.01 * fabs(wanted) + 5.0;
    judge(&truth);
    change_hole(&truth);
}

static void update(void *arg, long period)
{
    double period_s = period * 1e-9;
    rigidtap_commanded commanded;
    (void)arg;
    if (!is_made(period_s)) return;
    if (*s->enable != s->was_enabled) rigidtap_sim_set_power(s->sim, *s->enable ? 1u : 0u);
    s->was_enabled = *s->enable;
    __builtin_memset(&commanded, 0, sizeof(commanded));
    commanded.spindle.position = *s->spindle_position_command;
    commanded.spindle.velocity = *s->spindle_velocity_command / RPM_PER_REV_PER_S;
    commanded.z.position = *s->z_position_command;
    commanded.z.velocity = *s->z_velocity_command;
    commanded.spindle_torque_nm = *s->spindle_torque_command;
    commanded.z_force_n = *s->z_force_command;
    rigidtap_sim_write(s->sim, &commanded);
    report(period_s);
}

#define PIN(type, direction, field, name) \
    if (!failed) failed = hal_pin_##type##_newf(direction, &s->field, component, "rigidtap-sim." name)
#define OPTIONAL(field, name) PIN(float, HAL_IN, field, name);
#define OWN_PLACE(field, name) s->own.field = s->field;

static int export_pins(void)
{
    int failed = 0;
    OPTIONAL_PINS(OPTIONAL)
    PIN(bit, HAL_IN, enable, "enable");
    PIN(float, HAL_IN, pitch, "pitch");
    PIN(float, HAL_IN, surface, "surface");
    PIN(float, HAL_IN, depth, "depth");
    PIN(float, HAL_OUT, spindle_position, "spindle-position");
    PIN(float, HAL_OUT, spindle_speed, "spindle-speed");
    PIN(float, HAL_OUT, spindle_speed_rps, "spindle-speed-rps");
    PIN(float, HAL_OUT, spindle_revs, "spindle-revs");
    PIN(bit, HAL_IO, spindle_index_enable, "spindle-index-enable");
    PIN(bit, HAL_OUT, spindle_at_speed, "spindle-at-speed");
    PIN(float, HAL_OUT, spindle_torque, "spindle-torque");
    PIN(bit, HAL_OUT, spindle_saturated, "spindle-saturated");
    PIN(bit, HAL_OUT, spindle_ready, "spindle-ready");
    PIN(bit, HAL_OUT, spindle_valid, "spindle-sample-valid");
    PIN(float, HAL_OUT, z_position, "z-position");
    PIN(float, HAL_OUT, z_motor_position, "z-motor-position");
    PIN(float, HAL_OUT, z_force, "z-force");
    PIN(bit, HAL_OUT, z_saturated, "z-saturated");
    PIN(bit, HAL_OUT, z_ready, "z-ready");
    PIN(bit, HAL_OUT, z_valid, "z-sample-valid");
    PIN(bit, HAL_OUT, reports_effort, "reports-effort");
    PIN(float, HAL_OUT, spindle_true, "spindle-true-position");
    PIN(float, HAL_OUT, z_true, "z-true-position");
    PIN(float, HAL_OUT, clock, "clock");
    PIN(bit, HAL_IN, judge, "judge");
    PIN(float, HAL_OUT, error_peak_um, "true-error-peak-um");
    PIN(float, HAL_OUT, deepest, "true-deepest");
    PIN(u32, HAL_OUT, holes, "holes");
    if (failed) return failed;
    OPTIONAL_PINS(OWN_PLACE)
    *s->enable = 1;
    s->was_enabled = 1;
    *s->pitch = 1.0;
    *s->depth = 25.0;
    return hal_export_funct("rigidtap-sim.update", update, 0, 1, 0, component);
}

int rtapi_app_main(void)
{
    char message[1024];
    rigidtap_sim *tried;
    if (RIGIDTAP_SIM_CHECK() != RIGIDTAP_OK) {
        rtapi_print_msg(RTAPI_MSG_ERR, "rigidtap_sim: header and library are of different versions\n");
        return -1;
    }
    /* A file that cannot be read is told now. */
    tried = made(0, 0, 0, message, sizeof(message));
    if (!tried) {
        rtapi_print_msg(RTAPI_MSG_ERR, "rigidtap_sim: %s\n", message);
        return -1;
    }
    rigidtap_sim_free(tried);
    component = hal_init("rigidtap_sim");
    if (component < 0) return component;
    s = hal_malloc(sizeof(*s));
    if (s) __builtin_memset(s, 0, sizeof(*s));
    if (!s || export_pins()) {
        rtapi_print_msg(RTAPI_MSG_ERR, "rigidtap_sim: no room in HAL memory\n");
        hal_exit(component);
        return -1;
    }
    return hal_ready(component);
}

void rtapi_app_exit(void)
{
    hal_exit(component);
    if (s) rigidtap_sim_free(s->sim);
}
