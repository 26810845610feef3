/* What is reported of a hole: e(k) while it is tapped, the verdict at its end, and the record that outlives a power cut. */
#include "rigidtap_hal.h"

/* Up to this share of a limit a hole is good, up to all of it a warning. */
#define GOOD_SHARE 0.5
/* Z may go below the bottom by this share of the pitch, where the machine's data say nothing else. */
#define CLEARANCE_PITCHES 0.5

void clear_report(tap_t *t)
{
    *t->alarm = 0;
    *t->fault_found = *t->fault_limit = 0.0;
    *t->error_um = *t->error_min_um = *t->error_max_um = *t->error_peak_um = *t->depth_reached = 0.0;
    *t->peak_rpm = *t->cycle_time = 0.0;
    *t->verdict = VERDICT_OK;
}

/* One period with spindle and Z. */
void note_period(tap_t *t)
{
    double error_um = t->setpoint.error_mm * UM_PER_MM, depth_mm = t->r_plane_mm - *t->z_feedback_in;
    double rpm = RPM_PER_REV_PER_S * (*t->spindle_position - t->position_before) / t->period_s;
    t->position_before = *t->spindle_position;
    *t->cycle_time = t->now_s - t->began_s;
    if (*t->state < TAPPING || *t->state > RETRACTING) return;
    *t->error_um = error_um;
    if (error_um < *t->error_min_um) *t->error_min_um = error_um;
    if (error_um > *t->error_max_um) *t->error_max_um = error_um;
    *t->error_peak_um = *t->error_max_um - *t->error_min_um;
    if (depth_mm > *t->depth_reached) *t->depth_reached = depth_mm;
    if (rpm < 0.0) rpm = -rpm;
    if (rpm > *t->peak_rpm) *t->peak_rpm = rpm;
}

/* A hole is over: its error and its depth against what they may be, whichever is worse. */
void note_end(tap_t *t)
{
    double clearance_mm = t->data.tap_bottom_clearance_mm > 0.0 ? t->data.tap_bottom_clearance_mm
                                                                : CLEARANCE_PITCHES * *t->pitch;
    double share = (*t->depth_reached - *t->depth) / clearance_mm;
    *t->tolerance_um = t->planned_tolerance_um;
    if (*t->error_peak_um > share * *t->tolerance_um) share = *t->error_peak_um / *t->tolerance_um;
    *t->verdict = *t->alarm || share > 1.0 ? VERDICT_FAIL : share > GOOD_SHARE ? VERDICT_WARNING : VERDICT_OK;
    ++*t->holes;
}

/* The record of the hole under way, for a part of user space to keep. */
void keep_record(tap_t *t)
{
    rigidtap_record record;
    uint32_t words[RECORD_WORDS];
    int n;
    *t->record_valid = rigidtap_tap_record(t->tap, 0, &record) == RIGIDTAP_OK;
    if (!*t->record_valid) return;
    __builtin_memcpy(words, record.bytes, sizeof(words));
    for (n = 0; n < RECORD_WORDS; n++) *t->record[n] = words[n];
}
