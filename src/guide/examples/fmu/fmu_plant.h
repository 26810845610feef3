/* What an FMU of FMI 2.0 and 3.0 has to have beside the machine's own equations: memory, variables by number, and the
 * functions' names. The numbers are those of modelDescription2.xml and modelDescription3.xml beside this file. */
#ifndef FMU_PLANT_H
#define FMU_PLANT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#if defined(_WIN32)
#define FMU_EXPORT __declspec(dllexport)
#else
#define FMU_EXPORT __attribute__((visibility("default")))
#endif

/* Inputs, numbers 0 to 5. */
typedef struct {
    double spindle_rev, spindle_rev_per_s, spindle_rev_per_s2, z_mm, z_mm_per_s, z_mm_per_s2;
} setpoint;

/* Outputs, numbers 10 to 13. */
typedef struct {
    int64_t spindle_counts, z_counts;
    double true_spindle_rev, true_z_mm;
} feedback;

/* Parameters, numbers 20 and 21. */
typedef struct {
    double z_start_mm, seed;
} parameters;

/* The number of a real variable as its place; null of what there is none. */
static double *fmu_real(setpoint *set, feedback *told, parameters *p, uint32_t number) {
    double *const inputs[] = {&set->spindle_rev, &set->spindle_rev_per_s, &set->spindle_rev_per_s2,
                              &set->z_mm,        &set->z_mm_per_s,        &set->z_mm_per_s2};
    if (number < 6) return inputs[number];
    switch (number) {
    case 12: return &told->true_spindle_rev;
    case 13: return &told->true_z_mm;
    case 20: return &p->z_start_mm;
    case 21: return &p->seed;
    default: return NULL;
    }
}

static int64_t *fmu_count(feedback *told, uint32_t number) {
    return number == 10 ? &told->spindle_counts : number == 11 ? &told->z_counts : NULL;
}

enum { FMU_OK = 0, FMU_ERROR = 3 };

#define FMU_UNUSED(x) ((void)(x))
#define FMU_NOTHING(name, ...)                                                                                              \
    FMU_EXPORT int name(__VA_ARGS__);                                                                                       \
    FMU_EXPORT int name(__VA_ARGS__) { return FMU_ERROR; }

#define FMU_ABSENT(name)                                                                                                    \
    FMU_EXPORT int name(void);                                                                                              \
    FMU_EXPORT int name(void) { return FMU_ERROR; }

/* FMU_PLANT(type, start, step, tell) defines all functions around those three. */
#define FMU_PLANT(type, start, step, tell)                                                                                  \
    typedef struct {                                                                                                        \
        type machine;                                                                                                       \
        setpoint set;                                                                                                       \
        feedback told;                                                                                                      \
        parameters p;                                                                                                       \
    } fmu;                                                                                                                  \
    static int fmu_begin(fmu *m) {                                                                                          \
        m->set.z_mm = m->p.z_start_mm;                                                                                      \
        if (start(&m->machine, &m->p)) return FMU_ERROR;                                                                    \
        tell(&m->machine, &m->told);                                                                                        \
        return FMU_OK;                                                                                                      \
    }                                                                                                                       \
    static int fmu_go_on(fmu *m, double step_s) {                                                                           \
        if (step(&m->machine, &m->set, step_s)) return FMU_ERROR;                                                           \
        tell(&m->machine, &m->told);                                                                                        \
        return FMU_OK;                                                                                                      \
    }                                                                                                                       \
    static int fmu_get(fmu *m, const uint32_t *number, size_t count, double *value) {                                       \
        for (size_t i = 0; i < count; i++) {                                                                                \
            const double *real = fmu_real(&m->set, &m->told, &m->p, number[i]);                                             \
            const int64_t *whole = fmu_count(&m->told, number[i]);                                                          \
            if (!real && !whole) return FMU_ERROR;                                                                          \
            value[i] = real ? *real : (double)*whole;                                                                       \
        }                                                                                                                   \
        return FMU_OK;                                                                                                      \
    }                                                                                                                       \
    static int fmu_set(fmu *m, const uint32_t *number, size_t count, const double *value) {                                 \
        for (size_t i = 0; i < count; i++) {                                                                                \
            double *real = fmu_real(&m->set, &m->told, &m->p, number[i]);                                                   \
            if (!real) return FMU_ERROR;                                                                                    \
            *real = value[i];                                                                                               \
        }                                                                                                                   \
        return FMU_OK;                                                                                                      \
    }                                                                                                                       \
    /* FMI 2.0 */                                                                                                           \
    FMU_EXPORT const char *fmi2GetTypesPlatform(void) { return "default"; }                                                 \
    FMU_EXPORT const char *fmi2GetVersion(void) { return "2.0"; }                                                           \
    FMU_EXPORT void *fmi2Instantiate(const char *n, int t, const char *g, const char *r, const void *c, int v, int l) {     \
        FMU_UNUSED(n), FMU_UNUSED(t), FMU_UNUSED(g), FMU_UNUSED(r), FMU_UNUSED(c), FMU_UNUSED(v), FMU_UNUSED(l);            \
        return calloc(1, sizeof(fmu));                                                                                      \
    }                                                                                                                       \
    FMU_EXPORT void fmi2FreeInstance(void *m) { free(m); }                                                                  \
    FMU_EXPORT int fmi2SetDebugLogging(void *m, int on, size_t n, const char *const *c) {                                   \
        FMU_UNUSED(m), FMU_UNUSED(on), FMU_UNUSED(n), FMU_UNUSED(c);                                                        \
        return FMU_OK;                                                                                                      \
    }                                                                                                                       \
    FMU_EXPORT int fmi2SetupExperiment(void *m, int td, double t, double from, int sd, double to) {                         \
        FMU_UNUSED(m), FMU_UNUSED(td), FMU_UNUSED(t), FMU_UNUSED(from), FMU_UNUSED(sd), FMU_UNUSED(to);                     \
        return FMU_OK;                                                                                                      \
    }                                                                                                                       \
    FMU_EXPORT int fmi2EnterInitializationMode(void *m) { return fmu_begin(m); }                                            \
    FMU_EXPORT int fmi2ExitInitializationMode(void *m) { return fmu_begin(m); }                                             \
    FMU_EXPORT int fmi2Terminate(void *m) { FMU_UNUSED(m); return FMU_OK; }                                                 \
    FMU_EXPORT int fmi2Reset(void *m) { *(fmu *)m = (fmu){0}; return FMU_OK; }                                              \
    FMU_EXPORT int fmi2GetReal(void *m, const uint32_t *v, size_t n, double *x) { return fmu_get(m, v, n, x); }             \
    FMU_EXPORT int fmi2SetReal(void *m, const uint32_t *v, size_t n, const double *x) { return fmu_set(m, v, n, x); }       \
    FMU_EXPORT int fmi2DoStep(void *m, double t, double h, int no) {                                                        \
        FMU_UNUSED(t), FMU_UNUSED(no);                                                                                      \
        return fmu_go_on(m, h);                                                                                             \
    }                                                                                                                       \
    FMU_NOTHING(fmi2GetInteger, void *m, const uint32_t *v, size_t n, int *x)                                               \
    FMU_NOTHING(fmi2GetBoolean, void *m, const uint32_t *v, size_t n, int *x)                                               \
    FMU_NOTHING(fmi2GetString, void *m, const uint32_t *v, size_t n, const char **x)                                        \
    FMU_NOTHING(fmi2SetInteger, void *m, const uint32_t *v, size_t n, const int *x)                                         \
    FMU_NOTHING(fmi2SetBoolean, void *m, const uint32_t *v, size_t n, const int *x)                                         \
    FMU_NOTHING(fmi2SetString, void *m, const uint32_t *v, size_t n, const char *const *x)                                  \
    FMU_NOTHING(fmi2GetFMUstate, void *m, void **s)                                                                         \
    FMU_NOTHING(fmi2SetFMUstate, void *m, void *s)                                                                          \
    FMU_NOTHING(fmi2FreeFMUstate, void *m, void **s)                                                                        \
    FMU_NOTHING(fmi2SerializedFMUstateSize, void *m, void *s, size_t *n)                                                    \
    FMU_NOTHING(fmi2SerializeFMUstate, void *m, void *s, char *b, size_t n)                                                 \
    FMU_NOTHING(fmi2DeSerializeFMUstate, void *m, const char *b, size_t n, void **s)                                        \
    FMU_NOTHING(fmi2GetDirectionalDerivative, void *m, const uint32_t *u, size_t nu, const uint32_t *v, size_t nv,          \
                const double *du, double *dv)                                                                               \
    FMU_NOTHING(fmi2SetRealInputDerivatives, void *m, const uint32_t *v, size_t n, const int *o, const double *x)           \
    FMU_NOTHING(fmi2GetRealOutputDerivatives, void *m, const uint32_t *v, size_t n, const int *o, double *x)                \
    FMU_NOTHING(fmi2CancelStep, void *m)                                                                                    \
    FMU_NOTHING(fmi2GetStatus, void *m, int k, int *x)                                                                      \
    FMU_NOTHING(fmi2GetRealStatus, void *m, int k, double *x)                                                               \
    FMU_NOTHING(fmi2GetIntegerStatus, void *m, int k, int *x)                                                               \
    FMU_NOTHING(fmi2GetBooleanStatus, void *m, int k, int *x)                                                               \
    FMU_NOTHING(fmi2GetStringStatus, void *m, int k, const char **x)                                                        \
    /* FMI 3.0 */                                                                                                           \
    FMU_EXPORT const char *fmi3GetVersion(void) { return "3.0"; }                                                           \
    FMU_EXPORT void *fmi3InstantiateCoSimulation(const char *n, const char *g, const char *r, bool v, bool l, bool e,       \
                                                 bool early, const uint32_t *u, size_t nu, void *env, void *log,            \
                                                 void *up) {                                                                \
        FMU_UNUSED(n), FMU_UNUSED(g), FMU_UNUSED(r), FMU_UNUSED(v), FMU_UNUSED(l), FMU_UNUSED(e), FMU_UNUSED(early);        \
        FMU_UNUSED(u), FMU_UNUSED(nu), FMU_UNUSED(env), FMU_UNUSED(log), FMU_UNUSED(up);                                    \
        return calloc(1, sizeof(fmu));                                                                                      \
    }                                                                                                                       \
    FMU_EXPORT void fmi3FreeInstance(void *m) { free(m); }                                                                  \
    FMU_EXPORT int fmi3SetDebugLogging(void *m, bool on, size_t n, const char *const *c) {                                  \
        FMU_UNUSED(m), FMU_UNUSED(on), FMU_UNUSED(n), FMU_UNUSED(c);                                                        \
        return FMU_OK;                                                                                                      \
    }                                                                                                                       \
    FMU_EXPORT int fmi3EnterInitializationMode(void *m, bool td, double t, double from, bool sd, double to) {               \
        FMU_UNUSED(td), FMU_UNUSED(t), FMU_UNUSED(from), FMU_UNUSED(sd), FMU_UNUSED(to);                                    \
        return fmu_begin(m);                                                                                                \
    }                                                                                                                       \
    FMU_EXPORT int fmi3ExitInitializationMode(void *m) { return fmu_begin(m); }                                             \
    FMU_EXPORT int fmi3Terminate(void *m) { FMU_UNUSED(m); return FMU_OK; }                                                 \
    FMU_EXPORT int fmi3Reset(void *m) { *(fmu *)m = (fmu){0}; return FMU_OK; }                                              \
    FMU_EXPORT int fmi3GetFloat64(void *m, const uint32_t *v, size_t n, double *x, size_t nx) {                             \
        return nx < n ? FMU_ERROR : fmu_get(m, v, n, x);                                                                    \
    }                                                                                                                       \
    FMU_EXPORT int fmi3SetFloat64(void *m, const uint32_t *v, size_t n, const double *x, size_t nx) {                       \
        return nx < n ? FMU_ERROR : fmu_set(m, v, n, x);                                                                    \
    }                                                                                                                       \
    FMU_EXPORT int fmi3GetInt64(void *m, const uint32_t *v, size_t n, int64_t *x, size_t nx) {                              \
        for (size_t i = 0; i < n && i < nx; i++) {                                                                          \
            const int64_t *whole = fmu_count(&((fmu *)m)->told, v[i]);                                                      \
            if (!whole) return FMU_ERROR;                                                                                   \
            x[i] = *whole;                                                                                                  \
        }                                                                                                                   \
        return FMU_OK;                                                                                                      \
    }                                                                                                                       \
    FMU_EXPORT int fmi3DoStep(void *m, double t, double h, bool no, bool *event, bool *terminate, bool *early,              \
                              double *last) {                                                                               \
        FMU_UNUSED(no);                                                                                                     \
        *event = *terminate = *early = false;                                                                               \
        *last = t + h;                                                                                                      \
        return fmu_go_on(m, h);                                                                                             \
    }                                                                                                                       \
    /* Functions that have to be there, and that nobody calls on a plant such as this one. */                               \
    FMU_ABSENT(fmi3ActivateModelPartition) FMU_ABSENT(fmi3CompletedIntegratorStep)                                          \
    FMU_ABSENT(fmi3DeserializeFMUState) FMU_ABSENT(fmi3EnterConfigurationMode)                                              \
    FMU_ABSENT(fmi3EnterContinuousTimeMode) FMU_ABSENT(fmi3EnterEventMode) FMU_ABSENT(fmi3EnterStepMode)                    \
    FMU_ABSENT(fmi3EvaluateDiscreteStates) FMU_ABSENT(fmi3ExitConfigurationMode) FMU_ABSENT(fmi3FreeFMUState)               \
    FMU_ABSENT(fmi3GetAdjointDerivative) FMU_ABSENT(fmi3GetBinary) FMU_ABSENT(fmi3GetBoolean)                               \
    FMU_ABSENT(fmi3GetClock) FMU_ABSENT(fmi3GetContinuousStateDerivatives) FMU_ABSENT(fmi3GetContinuousStates)              \
    FMU_ABSENT(fmi3GetDirectionalDerivative) FMU_ABSENT(fmi3GetEventIndicators) FMU_ABSENT(fmi3GetFMUState)                 \
    FMU_ABSENT(fmi3GetFloat32) FMU_ABSENT(fmi3GetInt16) FMU_ABSENT(fmi3GetInt32) FMU_ABSENT(fmi3GetInt8)                    \
    FMU_ABSENT(fmi3GetIntervalDecimal) FMU_ABSENT(fmi3GetIntervalFraction)                                                  \
    FMU_ABSENT(fmi3GetNominalsOfContinuousStates) FMU_ABSENT(fmi3GetNumberOfContinuousStates)                               \
    FMU_ABSENT(fmi3GetNumberOfEventIndicators) FMU_ABSENT(fmi3GetNumberOfVariableDependencies)                              \
    FMU_ABSENT(fmi3GetOutputDerivatives) FMU_ABSENT(fmi3GetShiftDecimal) FMU_ABSENT(fmi3GetShiftFraction)                   \
    FMU_ABSENT(fmi3GetString) FMU_ABSENT(fmi3GetUInt16) FMU_ABSENT(fmi3GetUInt32) FMU_ABSENT(fmi3GetUInt64)                 \
    FMU_ABSENT(fmi3GetUInt8) FMU_ABSENT(fmi3GetVariableDependencies) FMU_ABSENT(fmi3InstantiateModelExchange)               \
    FMU_ABSENT(fmi3InstantiateScheduledExecution) FMU_ABSENT(fmi3SerializeFMUState)                                         \
    FMU_ABSENT(fmi3SerializedFMUStateSize) FMU_ABSENT(fmi3SetBinary) FMU_ABSENT(fmi3SetBoolean)                             \
    FMU_ABSENT(fmi3SetClock) FMU_ABSENT(fmi3SetContinuousStates) FMU_ABSENT(fmi3SetFMUState)                                \
    FMU_ABSENT(fmi3SetFloat32) FMU_ABSENT(fmi3SetInt16) FMU_ABSENT(fmi3SetInt32) FMU_ABSENT(fmi3SetInt64)                   \
    FMU_ABSENT(fmi3SetInt8) FMU_ABSENT(fmi3SetIntervalDecimal) FMU_ABSENT(fmi3SetIntervalFraction)                          \
    FMU_ABSENT(fmi3SetShiftDecimal) FMU_ABSENT(fmi3SetShiftFraction) FMU_ABSENT(fmi3SetString)                              \
    FMU_ABSENT(fmi3SetTime) FMU_ABSENT(fmi3SetUInt16) FMU_ABSENT(fmi3SetUInt32) FMU_ABSENT(fmi3SetUInt64)                   \
    FMU_ABSENT(fmi3SetUInt8) FMU_ABSENT(fmi3UpdateDiscreteStates)

#endif
