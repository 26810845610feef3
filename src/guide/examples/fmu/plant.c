/* A machine for rigidtap --plant: copy it, and put your own equations in plant_start and plant_step. Everything that FMI 2.0
 * and 3.0 ask for beside that is in fmu_plant.h. ./build makes plant2.fmu and plant3.fmu. */
#include "fmu_plant.h"

#include <math.h>

#define COUNTS_PER_REV 16384.0 /* as spindle.encoder_counts_per_rev in the machine file */
#define COUNTS_PER_MM 10000.0  /* as z.encoder_counts_per_mm */
#define TICK_S 25e-6           /* step of the equations */

/* A spindle and a Z axis whose drives follow position and velocity. */
typedef struct { double position, velocity, velocity_gain, lag_s; } axis;
typedef struct { axis spindle, z; } plant;

static void tick(axis *a, double set, double set_velocity) {
    double wanted = set_velocity + a->velocity_gain * (set - a->position);
    a->velocity += TICK_S / a->lag_s * (wanted - a->velocity);
    a->position += TICK_S * a->velocity;
}

/* At rest. Parameters are in p: z_start_mm, seed. */
static int plant_start(plant *m, const parameters *p) {
    m->spindle = (axis){0.0, 0.0, 100.0, 0.002};
    m->z = (axis){p->z_start_mm, 0.0, 100.0, 0.002};
    return 0;
}

/* One step of the control's period. A setpoint is where the axis has to be at the step's beginning; it moves on with the
 * setpoint's velocity and acceleration meanwhile. Not 0 is a failure. */
static int plant_step(plant *m, const setpoint *set, double step_s) {
    for (int k = 0, ticks = (int)lround(step_s / TICK_S); k < ticks; k++) {
        double t = k * TICK_S, half = 0.5 * t * t;
        tick(&m->spindle, set->spindle_rev + t * set->spindle_rev_per_s + half * set->spindle_rev_per_s2,
             set->spindle_rev_per_s + t * set->spindle_rev_per_s2);
        tick(&m->z, set->z_mm + t * set->z_mm_per_s + half * set->z_mm_per_s2,
             set->z_mm_per_s + t * set->z_mm_per_s2);
    }
    return 0;
}

/* What the control is told, and where the axes truly are. */
static void plant_tell(const plant *m, feedback *f) {
    f->spindle_counts = (int64_t)floor(m->spindle.position * COUNTS_PER_REV);
    f->z_counts = (int64_t)floor(m->z.position * COUNTS_PER_MM);
    f->true_spindle_rev = m->spindle.position;
    f->true_z_mm = m->z.position;
}

FMU_PLANT(plant, plant_start, plant_step, plant_tell)
