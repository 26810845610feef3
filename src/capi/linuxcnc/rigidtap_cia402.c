/* rigidtap_cia402: between the numbers of rigidtap and the objects of a CiA 402 drive, as lcec's generic driver has them as pins.
 *
 *   loadrt rigidtap_cia402 count=2
 *
 * A unit is a revolution of the spindle or a millimetre of Z. 32-bit positions wrap; torque goes in thousandths of the rated one.
 * Functions: rigidtap-cia402.N.read after the bus is read, rigidtap-cia402.N.write before it is written.
 */
#include "hal.h"
#include "rtapi.h"
#include "rtapi_app.h"

MODULE_AUTHOR("The rigidtap authors");
MODULE_DESCRIPTION("Scales and unwraps the objects of a CiA 402 drive");
MODULE_LICENSE("GPL");

#define MOST 8
static int count = 1;
RTAPI_MP_INT(count, "axes, 1 to 8");

/* Bits 0 to 3, 5 and 6 of the statusword 0x6041 that say "operation enabled", and its bit 11, internal limit active. */
#define STATE_MASK 0x006Fu
#define OPERATION_ENABLED 0x0027u
#define INTERNAL_LIMIT_ACTIVE 0x0800u
#define MOST_INT32 2147483647.0
#define MOST_INT16 32767.0

typedef struct {
    /* the bus: 0x6064, 0x6077, 0x6041; 0x607A, 0x60B1, 0x60B2 */
    hal_s32_t *actual_position, *actual_torque, *target_position, *velocity_offset, *torque_offset;
    hal_u32_t *statusword;
    /* rigidtap */
    hal_float_t *position, *effort, *position_command, *velocity_command, *effort_command;
    hal_bit_t *ready, *saturated;
    hal_float_t increments, velocity_units, thousandths;
    int64_t unwrapped;
    int32_t last;
    int is_seen;
} axis_t;

static axis_t *axes[MOST];
static int component;

/* The nearest whole number within a type's range; 0 for what is no number. */
static int64_t rounded(double value, double most)
{
    if (!(value == value)) return 0;
    if (value > most) value = most;
    if (value < -most) value = -most;
    return (int64_t)(value < 0.0 ? value - 0.5 : value + 0.5);
}

static void read(void *arg, long period)
{
    axis_t *a = arg;
    int32_t raw = *a->actual_position;
    (void)period;
    /* The difference wraps as the counter does, and keeps its sign. */
    if (a->is_seen)
        a->unwrapped += (int32_t)((uint32_t)raw - (uint32_t)a->last);
    else
        a->unwrapped = raw;
    a->is_seen = 1;
    a->last = raw;
    *a->position = (double)a->unwrapped / a->increments;
    *a->effort = (double)*a->actual_torque / a->thousandths;
    *a->ready = (*a->statusword & STATE_MASK) == OPERATION_ENABLED;
    *a->saturated = (*a->statusword & INTERNAL_LIMIT_ACTIVE) != 0;
}

static void write(void *arg, long period)
{
    axis_t *a = arg;
    (void)period;
    /* The low 32 bits are the wrap. A double is exact to 2^53. */
    *a->target_position = (int32_t)(uint32_t)(uint64_t)rounded(*a->position_command * a->increments, 9.0e15);
    *a->velocity_offset = (int32_t)rounded(*a->velocity_command * a->velocity_units, MOST_INT32);
    *a->torque_offset = (int32_t)rounded(*a->effort_command * a->thousandths, MOST_INT16);
}

#define PIN(type, direction, field, name) \
    if (!failed) failed = hal_pin_##type##_newf(direction, &a->field, component, "rigidtap-cia402.%d." name, n)
#define PARAM(field, value, name)                                                                                      \
    do {                                                                                                               \
        a->field = value;                                                                                              \
        if (!failed) failed = hal_param_float_newf(HAL_RW, &a->field, component, "rigidtap-cia402.%d." name, n); \
    } while (0)

static int export_axis(axis_t *a, int n)
{
    char name[HAL_NAME_LEN + 1];
    int failed = 0;
    PIN(s32, HAL_IN, actual_position, "actual-position");
    PIN(s32, HAL_IN, actual_torque, "actual-torque");
    PIN(u32, HAL_IN, statusword, "statusword");
    PIN(s32, HAL_OUT, target_position, "target-position");
    PIN(s32, HAL_OUT, velocity_offset, "velocity-offset");
    PIN(s32, HAL_OUT, torque_offset, "torque-offset");
    PIN(float, HAL_OUT, position, "position");
    PIN(float, HAL_OUT, effort, "effort");
    PIN(bit, HAL_OUT, ready, "ready");
    PIN(bit, HAL_OUT, saturated, "saturated");
    PIN(float, HAL_IN, position_command, "position-command");
    PIN(float, HAL_IN, velocity_command, "velocity-command");
    PIN(float, HAL_IN, effort_command, "effort-command");
    PARAM(increments, 1.0, "increments-per-unit");
    PARAM(velocity_units, 1.0, "velocity-units-per-unit");
    PARAM(thousandths, 1.0, "thousandths-per-effort");
    rtapi_snprintf(name, sizeof(name), "rigidtap-cia402.%d.read", n);
    if (!failed) failed = hal_export_funct(name, read, a, 1, 0, component);
    rtapi_snprintf(name, sizeof(name), "rigidtap-cia402.%d.write", n);
    if (!failed) failed = hal_export_funct(name, write, a, 1, 0, component);
    return failed;
}

int rtapi_app_main(void)
{
    int n;
    if (count < 1 || count > MOST) {
        rtapi_print_msg(RTAPI_MSG_ERR, "rigidtap_cia402: count=%d, expected 1 to %d\n", count, MOST);
        return -1;
    }
    component = hal_init("rigidtap_cia402");
    if (component < 0) return component;
    for (n = 0; n < count; n++) {
        axes[n] = hal_malloc(sizeof(axis_t));
        if (axes[n]) __builtin_memset(axes[n], 0, sizeof(axis_t));
        if (!axes[n] || export_axis(axes[n], n)) {
            rtapi_print_msg(RTAPI_MSG_ERR, "rigidtap_cia402: no room in HAL memory for axis %d\n", n);
            hal_exit(component);
            return -1;
        }
    }
    return hal_ready(component);
}

void rtapi_app_exit(void)
{
    hal_exit(component);
}
