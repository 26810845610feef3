/* Pins and parameters of an instance. */
#include "rigidtap_hal.h"

#include <stddef.h>

/* The machine file's keys as parameters, each with its number among the control's data: a point for each dot, a minus for each
 * underscore, and no `law.` before it, for which HAL has no room. `rigidtap machine --hal` writes them. */
#define MACHINE_KEYS(KEY)                                                      \
    KEY(period_s, "control.period-s")                                          \
    KEY(latency_periods, "drive.latency-periods")                              \
    KEY(spindle_max_rpm, "spindle.max-rpm")                                    \
    KEY(spindle_inertia_kg_m2, "spindle.inertia-kg-m2")                        \
    KEY(spindle_tool_inertia_kg_m2, "spindle.tool-inertia-kg-m2")              \
    KEY(spindle_coulomb_nm, "spindle.coulomb-nm")                              \
    KEY(spindle_viscous_nm_per_rpm, "spindle.viscous-nm-per-rpm")              \
    KEY(spindle_supply_sag_ratio, "spindle.supply-sag-ratio")                  \
    KEY(spindle_torque_lag_s, "spindle.torque-lag-s")                          \
    KEY(spindle_counts_per_rev, "spindle.encoder-counts-per-rev")              \
    KEY(motor_share, "motor-share")                                        \
    KEY(jerk_rpm_per_s2, "torque-curve-smooth.jerk-rpm-per-s2")            \
    KEY(s_curve_accel_rpm_per_s, "s-curve.accel-rpm-per-s")                \
    KEY(s_curve_jerk_rpm_per_s2, "s-curve.jerk-rpm-per-s2")                \
    KEY(linear_accel_rpm_per_s, "linear.accel-rpm-per-s")                  \
    KEY(trapezoid_accel_rpm_per_s, "trapezoid-jerk.accel-rpm-per-s")       \
    KEY(trapezoid_jerk_rpm_per_s2, "trapezoid-jerk.jerk-rpm-per-s2")       \
    KEY(trapezoid_snap_rpm_per_s3, "trapezoid-jerk.snap-rpm-per-s3")       \
    KEY(improved_accel_rpm_per_s, "improved-s-curve.accel-rpm-per-s")      \
    KEY(x_max_mm_per_s, "x.max-mm-per-s")                                      \
    KEY(x_max_mm_per_s2, "x.max-mm-per-s2")                                    \
    KEY(x_max_mm_per_s3, "x.max-mm-per-s3")                                    \
    KEY(y_max_mm_per_s, "y.max-mm-per-s")                                      \
    KEY(y_max_mm_per_s2, "y.max-mm-per-s2")                                    \
    KEY(y_max_mm_per_s3, "y.max-mm-per-s3")                                    \
    KEY(z_max_mm_per_s, "z.max-mm-per-s")                                      \
    KEY(z_max_mm_per_s2, "z.max-mm-per-s2")                                    \
    KEY(z_max_mm_per_s3, "z.max-mm-per-s3")                                    \
    KEY(z_counts_per_mm, "z.encoder-counts-per-mm")                            \
    KEY(z_motor_counts_per_mm, "z.motor-counts-per-mm")                        \
    KEY(z_mass_kg, "z.mass-kg")                                                \
    KEY(z_table_share, "z.table-share")                                        \
    KEY(z_resonance_hz, "z.resonance-hz")                                      \
    KEY(z_torque_lag_s, "z.torque-lag-s")                                      \
    KEY(z_force_limit_n, "z.force-limit-n")                                    \
    KEY(z_coulomb_n, "z.coulomb-n")                                            \
    KEY(z_static_ratio, "z.static-ratio")                                      \
    KEY(z_stribeck_mm_per_s, "z.stribeck-mm-per-s")                            \
    KEY(z_presliding_um, "z.presliding-um")                                    \
    KEY(z_friction_table_share, "z.friction-table-share")                      \
    KEY(z_backlash_um, "z.backlash-um")                                        \
    KEY(drive_period_s, "drive.period-s")                                      \
    KEY(spindle_position_gain_per_s, "drive.spindle-position-gain-per-s")      \
    KEY(spindle_velocity_gain_per_s, "drive.spindle-velocity-gain-per-s")      \
    KEY(spindle_integral_s, "drive.spindle-integral-s")                        \
    KEY(z_position_gain_per_s, "drive.z-position-gain-per-s")                  \
    KEY(z_velocity_gain_per_s, "drive.z-velocity-gain-per-s")                  \
    KEY(z_integral_s, "drive.z-integral-s")                                    \
    KEY(velocity_filter_s, "drive.velocity-filter-s")                          \
    KEY(encoder_latency_s, "drive.encoder-latency-s")                          \
    KEY(encoder_jitter_s, "drive.encoder-jitter-s")                            \
    KEY(tap_kc_n_per_mm2, "tap.kc-n-per-mm2")                                  \
    KEY(tap_tool_factor, "tap.tool-factor")                                    \
    KEY(tap_surface_below_r_mm, "tap.surface-below-r-mm")                      \
    KEY(tap_ramp_pitches, "tap.ramp-pitches")                                  \
    KEY(tap_out_torque_ratio, "tap.out-torque-ratio")                          \
    KEY(tap_axial_n, "tap.axial-n")                                            \
    KEY(supervision_bridge_periods, "supervision.bridge-periods")              \
    KEY(supervision_scale_ratio, "supervision.scale-ratio")                    \
    KEY(tap_major_mm, "tap.major-mm")                                          \
    KEY(tap_hole_mm, "tap.hole-mm")                                            \
    KEY(tap_bottom_clearance_mm, "tap.bottom-clearance-mm")                    \
    KEY(supervision_error_limit_um, "supervision.error-limit-um")              \
    KEY(supervision_spindle_limit_rev, "supervision.spindle-limit-rev")        \
    KEY(supervision_z_limit_um, "supervision.z-limit-um")

typedef struct {
    size_t offset;
    const char *name;
} machine_key;

#define KEY_ROW(field, name) {offsetof(rigidtap_machine_data, field), name},
static const machine_key machine_keys[] = {MACHINE_KEYS(KEY_ROW)};
#define KEY_COUNT (sizeof(machine_keys) / sizeof(machine_keys[0]))

/* None of the data's numbers is left out. */
typedef char every_number_has_its_key[KEY_COUNT * sizeof(double) == offsetof(rigidtap_machine_data, torque_curve) ? 1 : -1];

#define PIN(type, direction, field, name)                                                                           \
    if (!failed) failed = hal_pin_##type##_newf(direction, &t->field, component, "rigidtap.%d." name, t->number);
#define OWN_PLACE(type, direction, field, name) t->own.field = t->field;
#define PARAM(type, field, name) \
    if (!failed) failed = hal_param_##type##_newf(HAL_RW, &t->field, component, "rigidtap.%d." name, t->number);

static int export_number(tap_t *t, int component, double *number, const char *name)
{
    return hal_param_float_newf(HAL_RW, (hal_float_t *)number, component, "rigidtap.%d.%s", t->number, name);
}

static int export_choice(tap_t *t, int component, uint32_t *choice, const char *name)
{
    return hal_param_u32_newf(HAL_RW, (hal_u32_t *)choice, component, "rigidtap.%d.%s", t->number, name);
}

/* The machine is the reference until it is told. */
static int export_machine(tap_t *t, int component)
{
    int failed = rigidtap_machine_reference(&t->data) != RIGIDTAP_OK, n;
    char name[HAL_NAME_LEN + 1];
    for (n = 0; n < (int)KEY_COUNT && !failed; n++)
        failed = export_number(t, component, (double *)((char *)&t->data + machine_keys[n].offset), machine_keys[n].name);
    for (n = 0; n < RIGIDTAP_MAX_TORQUE_POINTS && !failed; n++) {
        rtapi_snprintf(name, sizeof(name), "spindle.torque-curve.%02d.rpm", n);
        failed = export_number(t, component, &t->data.torque_curve[n].speed_rpm, name);
        rtapi_snprintf(name, sizeof(name), "spindle.torque-curve.%02d.nm", n);
        if (!failed) failed = export_number(t, component, &t->data.torque_curve[n].torque_nm, name);
    }
    for (n = 0; n < RIGIDTAP_MAX_BANDS && !failed; n++) {
        rtapi_snprintf(name, sizeof(name), "torque-curve.%02d.to-rpm", n);
        failed = export_number(t, component, &t->data.bands[n].to_rpm, name);
        rtapi_snprintf(name, sizeof(name), "torque-curve.%02d.accel-s", n);
        if (!failed) failed = export_number(t, component, &t->data.bands[n].accel_s, name);
        rtapi_snprintf(name, sizeof(name), "torque-curve.%02d.decel-s", n);
        if (!failed) failed = export_number(t, component, &t->data.bands[n].decel_s, name);
    }
    if (!failed) failed = export_choice(t, component, &t->data.torque_points, "spindle.torque-curve.points");
    if (!failed) failed = export_choice(t, component, &t->data.band_count, "torque-curve.bands");
    if (!failed) failed = export_choice(t, component, &t->data.law, "law");
    if (!failed) failed = export_choice(t, component, &t->data.z_encoder_at_motor, "z.encoder-at-motor");
    return failed;
}

static int export_record(tap_t *t, int component)
{
    int failed = 0, word;
    for (word = 0; word < RECORD_WORDS && !failed; word++) {
        failed = hal_pin_u32_newf(HAL_OUT, &t->record[word], component, "rigidtap.%d.record-%02d", t->number, word);
        if (failed) break;
        failed = hal_pin_u32_newf(HAL_IN, &t->saved[word], component, "rigidtap.%d.saved-%02d", t->number, word);
    }
    PIN(bit, HAL_OUT, record_valid, "record-valid")
    PIN(bit, HAL_IN, saved_valid, "saved-valid")
    PIN(bit, HAL_IN, restore, "restore")
    PIN(bit, HAL_OUT, drives_enable, "drives-enable")
    return failed;
}

int export_instance(tap_t *t, int component)
{
    int failed = export_record(t, component);
    if (!failed) failed = export_machine(t, component);
    PIN(float, HAL_IN, start_angle, "start-angle")
    PIN(bit, HAL_IN, has_start_angle, "has-start-angle")
    PIN(float, HAL_IN, z_command_in, "z-command-in")
    PIN(float, HAL_OUT, z_feedback_out, "z-feedback-out")
    PIN(float, HAL_IN, spindle_command_in, "spindle-command-in")
    PIN(bit, HAL_IN, enable, "enable")
    PIN(bit, HAL_IN, in_position, "in-position")
    PIN(float, HAL_IN, z_feedback_in, "z-feedback-in")
    PIN(float, HAL_OUT, z_command_out, "z-command-out")
    PIN(float, HAL_IN, spindle_position, "spindle-position")
    PIN(float, HAL_IN, spindle_speed, "spindle-speed")
    PIN(float, HAL_OUT, spindle_command_out, "spindle-command-out")
    PIN(float, HAL_IN, pitch, "pitch")
    PIN(float, HAL_IN, depth, "depth")
    PIN(float, HAL_IN, speed, "speed")
    PIN(float, HAL_IN, out_speed, "out-speed")
    PIN(float, HAL_IN, dwell, "dwell")
    PIN(float, HAL_IN, peck, "peck")
    PIN(float, HAL_IN, chip_break, "chip-break")
    PIN(bit, HAL_IN, left_hand, "left-hand")
    PIN(bit, HAL_IN, start, "start")
    PIN(bit, HAL_IN, abort, "abort")
    PIN(bit, HAL_IN, hold, "hold")
    PIN(bit, HAL_IN, retract, "retract")
    PIN(bit, HAL_IN, acknowledge, "acknowledge")
    OPTIONAL_PINS(PIN)
    PIN(bit, HAL_OUT, busy, "busy")
    PIN(bit, HAL_OUT, finished, "finished")
    PIN(bit, HAL_OUT, holding, "holding")
    PIN(bit, HAL_OUT, alarmed, "alarmed")
    PIN(bit, HAL_OUT, synchronous, "synchronous")
    PIN(s32, HAL_OUT, state, "state")
    PIN(s32, HAL_OUT, alarm, "alarm")
    PIN(s32, HAL_OUT, verdict, "verdict")
    PIN(u32, HAL_OUT, holes, "holes")
    PIN(float, HAL_OUT, fault_found, "fault-found")
    PIN(float, HAL_OUT, fault_limit, "fault-limit")
    PIN(float, HAL_OUT, z_true, "z-true")
    PIN(float, HAL_OUT, error_um, "error-um")
    PIN(float, HAL_OUT, error_min_um, "error-min-um")
    PIN(float, HAL_OUT, error_max_um, "error-max-um")
    PIN(float, HAL_OUT, error_peak_um, "error-peak-um")
    PIN(float, HAL_OUT, tolerance_um, "error-tolerance-um")
    PIN(float, HAL_OUT, depth_reached, "depth-reached")
    PIN(float, HAL_OUT, peak_rpm, "peak-rpm")
    PIN(float, HAL_OUT, cycle_time, "cycle-time")
    PARAM(float, tolerance, "tolerance.error-um")
    PARAM(u32, compensation, "compensation")
    PARAM(bit, identify, "identify")
    PARAM(bit, learn, "learn")
    PARAM(bit, nominal_time, "nominal-time")
    if (failed) return failed;
    OPTIONAL_PINS(OWN_PLACE)
    *t->spindle_valid = *t->z_valid = *t->spindle_ready = *t->z_ready = 1;
    t->compensation = RIGIDTAP_COMPENSATION_NONE;
    t->identify = t->learn = 1;
    return 0;
}
