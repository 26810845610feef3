/* simulated_spindle: a spindle for configurations without one. Its speed follows the command as fast as a slew limit, or a
 * motor's torque curve, lets it; its encoder has an index. */
#include "rtapi.h"
#include "rtapi_app.h"
#include "hal.h"
#include <math.h>

MODULE_AUTHOR("The rigidtap authors");
MODULE_DESCRIPTION("Simulated spindle with a slew limit or a torque curve, and an encoder with index");
MODULE_LICENSE("GPL");

/* Parts of a period in which the limit is taken as constant. */
#define PARTS 20

typedef struct {
    hal_float_t *command, *speed, *speed_rps, *position, *revs;
    hal_bit_t *index_enable, *at_speed;
    hal_float_t accel, rated_rpm, share;
    double index_rev;
} spindle_t;

static spindle_t *spindle;
static int component;

/* Constant up to the rated speed, then constant power. */
static double limit_rpm_per_s(double speed_rpm)
{
    double speed = fabs(speed_rpm), limit = spindle->share * spindle->accel;
    return speed > spindle->rated_rpm ? limit * spindle->rated_rpm / speed : limit;
}

static void update(void *arg, long period)
{
    double period_s = period * 1e-9, speed = *spindle->speed, before = *spindle->position;
    int part;
    (void)arg;
    for (part = 0; part < PARTS; part++) {
        double most = limit_rpm_per_s(speed) * period_s / PARTS, wanted = *spindle->command - speed;
        speed += wanted > most ? most : wanted < -most ? -most : wanted;
    }
    *spindle->speed = speed;
    *spindle->speed_rps = speed / 60.0;
    *spindle->position = before + speed / 60.0 * period_s;
    if (*spindle->index_enable && floor(*spindle->position) != floor(before)) {
        spindle->index_rev = speed > 0.0 ? floor(*spindle->position) : floor(before);
        *spindle->index_enable = 0;
    }
    *spindle->revs = *spindle->position - spindle->index_rev;
    *spindle->at_speed = fabs(*spindle->command - speed) <= 0.005 * fabs(*spindle->command) + 0.1;
}

#define PIN(type, direction, field, name) \
    if (!failed) failed = hal_pin_##type##_newf(direction, &spindle->field, component, "simulated-spindle." name)
#define PARAM(field, value, name)                                                                            \
    do {                                                                                                     \
        spindle->field = value;                                                                              \
        if (!failed) failed = hal_param_float_newf(HAL_RW, &spindle->field, component, "simulated-spindle." name); \
    } while (0)

int rtapi_app_main(void)
{
    int failed = 0;
    component = hal_init("simulated_spindle");
    if (component < 0) return component;
    spindle = hal_malloc(sizeof(spindle_t));
    failed = !spindle;
    PIN(float, HAL_IN, command, "command");
    PIN(float, HAL_OUT, speed, "speed");
    PIN(float, HAL_OUT, speed_rps, "speed-rps");
    PIN(float, HAL_OUT, position, "position");
    PIN(float, HAL_OUT, revs, "revs");
    PIN(bit, HAL_IO, index_enable, "index-enable");
    PIN(bit, HAL_OUT, at_speed, "at-speed");
    if (!failed) {
        PARAM(accel, 47746.483, "accel-rpm-per-s");
        PARAM(rated_rpm, 3000.0, "rated-rpm");
        PARAM(share, 0.8, "share");
    }
    if (!failed) failed = hal_export_funct("simulated-spindle.update", update, 0, 1, 0, component);
    if (failed) {
        rtapi_print_msg(RTAPI_MSG_ERR, "simulated_spindle: no room in HAL memory\n");
        hal_exit(component);
        return -1;
    }
    return hal_ready(component);
}

void rtapi_app_exit(void)
{
    hal_exit(component);
}
