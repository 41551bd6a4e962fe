/* FMI 3.0, co-simulation and model exchange. */
#include "headers/fmi3Functions.h"

#include <stdlib.h>
#include <string.h>

#include "model.h"

typedef struct {
    model *model;
    fmi3InstanceEnvironment environment;
    fmi3LogMessageCallback log;
    int stale;
} instance;

static fmi3Status tell(const instance *i, fmi3Status status, const char *message)
{
    if (i && i->log)
        i->log(i->environment, status, "logStatusError", message);
    return status;
}

static instance *made(fmi3String token, fmi3String folder, fmi3InstanceEnvironment environment,
    fmi3LogMessageCallback log)
{
    char why[512] = "out of memory";
    instance *i = calloc(1, sizeof *i);
    if (!i || !token || !folder)
        return free(i), NULL;
    i->environment = environment;
    i->log = log;
    i->stale = 1;
    char *path = malloc(strlen(folder) + sizeof "/model.txt");
    if (path) {
        strcpy(path, folder);
        const size_t n = strlen(path);
        strcat(path, n > 0 && (path[n - 1] == '/' || path[n - 1] == '\\') ? "" : "/");
        strcat(path, "model.txt");
        i->model = model_read(path, why, sizeof why);
    }
    free(path);
    if (i->model && strcmp(i->model->token, token) == 0)
        return i;
    tell(i, fmi3Error, i->model ? "the token is that of another model" : why);
    fmi3FreeInstance(i);
    return NULL;
}

const char *fmi3GetVersion(void)
{
    return fmi3Version;
}

fmi3Status fmi3SetDebugLogging(fmi3Instance c, fmi3Boolean on, size_t n, const fmi3String names[])
{
    (void)c, (void)on, (void)n, (void)names;
    return fmi3OK;
}

fmi3Instance fmi3InstantiateModelExchange(fmi3String name, fmi3String token, fmi3String folder,
    fmi3Boolean visible, fmi3Boolean logging, fmi3InstanceEnvironment environment,
    fmi3LogMessageCallback log)
{
    (void)name, (void)visible, (void)logging;
    return made(token, folder, environment, log);
}

fmi3Instance fmi3InstantiateCoSimulation(fmi3String name, fmi3String token, fmi3String folder,
    fmi3Boolean visible, fmi3Boolean logging, fmi3Boolean events, fmi3Boolean early,
    const fmi3ValueReference required[], size_t n, fmi3InstanceEnvironment environment,
    fmi3LogMessageCallback log, fmi3IntermediateUpdateCallback update)
{
    (void)name, (void)visible, (void)logging, (void)events, (void)early, (void)required, (void)n;
    (void)update;
    return made(token, folder, environment, log);
}

fmi3Instance fmi3InstantiateScheduledExecution(fmi3String name, fmi3String token,
    fmi3String folder, fmi3Boolean visible, fmi3Boolean logging,
    fmi3InstanceEnvironment environment, fmi3LogMessageCallback log,
    fmi3ClockUpdateCallback update, fmi3LockPreemptionCallback lock,
    fmi3UnlockPreemptionCallback unlock)
{
    (void)name, (void)token, (void)folder, (void)visible, (void)logging, (void)update;
    (void)lock, (void)unlock;
    if (log)
        log(environment, fmi3Error, "logStatusError", "scheduled execution is not provided");
    return NULL;
}

void fmi3FreeInstance(fmi3Instance c)
{
    instance *i = c;
    if (!i)
        return;
    model_free(i->model);
    free(i);
}

fmi3Status fmi3EnterInitializationMode(fmi3Instance c, fmi3Boolean has_tolerance,
    fmi3Float64 tolerance, fmi3Float64 start, fmi3Boolean has_stop, fmi3Float64 stop)
{
    (void)has_tolerance, (void)tolerance, (void)has_stop, (void)stop;
    ((instance *)c)->model->value[TIME] = start;
    return fmi3OK;
}

fmi3Status fmi3ExitInitializationMode(fmi3Instance c)
{
    instance *i = c;
    const char *why = model_refusal(i->model);
    i->stale = 1;
    return why ? tell(i, fmi3Error, why) : fmi3OK;
}

fmi3Status fmi3Reset(fmi3Instance c)
{
    instance *i = c;
    model_reset(i->model);
    i->stale = 1;
    return fmi3OK;
}

/* Changes of mode that change nothing. */
#define MODE(name) \
    fmi3Status name(fmi3Instance c) \
    { \
        (void)c; \
        return fmi3OK; \
    }

MODE(fmi3EnterEventMode)
MODE(fmi3Terminate)
MODE(fmi3EnterContinuousTimeMode)
MODE(fmi3EnterStepMode)
MODE(fmi3EvaluateDiscreteStates)
MODE(fmi3EnterConfigurationMode)
MODE(fmi3ExitConfigurationMode)

static void refresh(instance *i)
{
    if (i->stale)
        model_rates(i->model, model_longest(i->model));
    i->stale = 0;
}

fmi3Status fmi3GetFloat64(fmi3Instance c, const fmi3ValueReference vr[], size_t n,
    fmi3Float64 value[], size_t values)
{
    instance *i = c;
    if (values != n)
        return tell(i, fmi3Error, "every variable is a scalar");
    for (size_t k = 0; k < n; k++) {
        if (vr[k] >= i->model->variables)
            return tell(i, fmi3Error, "there is no such value reference");
        if (model_follows(i->model, vr[k]))
            refresh(i);
        value[k] = i->model->value[vr[k]];
    }
    return fmi3OK;
}

fmi3Status fmi3SetFloat64(fmi3Instance c, const fmi3ValueReference vr[], size_t n,
    const fmi3Float64 value[], size_t values)
{
    instance *i = c;
    if (values != n)
        return tell(i, fmi3Error, "every variable is a scalar");
    for (size_t k = 0; k < n; k++) {
        i->stale = 1;
        if (!model_set(i->model, vr[k], value[k]))
            return tell(i, fmi3Error, "no such variable can be set");
    }
    return fmi3OK;
}

/* There are variables of the type Float64 only. */
#define NONE(kind) \
    fmi3Status fmi3Get##kind(fmi3Instance c, const fmi3ValueReference vr[], size_t n, \
        fmi3##kind value[], size_t values) \
    { \
        (void)vr, (void)value, (void)values; \
        return n == 0 ? fmi3OK : tell(c, fmi3Error, "every variable is of the type Float64"); \
    } \
    fmi3Status fmi3Set##kind(fmi3Instance c, const fmi3ValueReference vr[], size_t n, \
        const fmi3##kind value[], size_t values) \
    { \
        (void)vr, (void)value, (void)values; \
        return n == 0 ? fmi3OK : tell(c, fmi3Error, "every variable is of the type Float64"); \
    }

NONE(Float32)
NONE(Int8)
NONE(UInt8)
NONE(Int16)
NONE(UInt16)
NONE(Int32)
NONE(UInt32)
NONE(Int64)
NONE(UInt64)
NONE(Boolean)
NONE(String)

fmi3Status fmi3GetBinary(fmi3Instance c, const fmi3ValueReference vr[], size_t n, size_t sizes[],
    fmi3Binary value[], size_t values)
{
    (void)vr, (void)sizes, (void)value, (void)values;
    return n == 0 ? fmi3OK : tell(c, fmi3Error, "every variable is of the type Float64");
}

fmi3Status fmi3SetBinary(fmi3Instance c, const fmi3ValueReference vr[], size_t n,
    const size_t sizes[], const fmi3Binary value[], size_t values)
{
    (void)vr, (void)sizes, (void)value, (void)values;
    return n == 0 ? fmi3OK : tell(c, fmi3Error, "every variable is of the type Float64");
}

fmi3Status fmi3GetClock(fmi3Instance c, const fmi3ValueReference vr[], size_t n, fmi3Clock value[])
{
    (void)vr, (void)value;
    return n == 0 ? fmi3OK : tell(c, fmi3Error, "there are no clocks");
}

fmi3Status fmi3SetClock(fmi3Instance c, const fmi3ValueReference vr[], size_t n,
    const fmi3Clock value[])
{
    (void)vr, (void)value;
    return n == 0 ? fmi3OK : tell(c, fmi3Error, "there are no clocks");
}

fmi3Status fmi3GetNumberOfVariableDependencies(fmi3Instance c, fmi3ValueReference vr, size_t *n)
{
    (void)vr, (void)n;
    return tell(c, fmi3Error, "dependencies are not provided");
}

fmi3Status fmi3GetVariableDependencies(fmi3Instance c, fmi3ValueReference dependent,
    size_t elements[], fmi3ValueReference independents[], size_t of[], fmi3DependencyKind kinds[],
    size_t n)
{
    (void)dependent, (void)elements, (void)independents, (void)of, (void)kinds, (void)n;
    return tell(c, fmi3Error, "dependencies are not provided");
}

static size_t state_size(const instance *i)
{
    return i->model->variables*sizeof(double);
}

fmi3Status fmi3GetFMUState(fmi3Instance c, fmi3FMUState *state)
{
    instance *i = c;
    if (!*state)
        *state = malloc(state_size(i));
    if (!*state)
        return tell(i, fmi3Error, "out of memory");
    memcpy(*state, i->model->value, state_size(i));
    return fmi3OK;
}

fmi3Status fmi3SetFMUState(fmi3Instance c, fmi3FMUState state)
{
    instance *i = c;
    model_restore(i->model, state);
    i->stale = 1;
    return fmi3OK;
}

fmi3Status fmi3FreeFMUState(fmi3Instance c, fmi3FMUState *state)
{
    (void)c;
    free(*state);
    *state = NULL;
    return fmi3OK;
}

fmi3Status fmi3SerializedFMUStateSize(fmi3Instance c, fmi3FMUState state, size_t *size)
{
    (void)state;
    *size = state_size(c);
    return fmi3OK;
}

fmi3Status fmi3SerializeFMUState(fmi3Instance c, fmi3FMUState state, fmi3Byte bytes[], size_t size)
{
    if (size < state_size(c))
        return tell(c, fmi3Error, "no room for the state");
    memcpy(bytes, state, state_size(c));
    return fmi3OK;
}

fmi3Status fmi3DeserializeFMUState(fmi3Instance c, const fmi3Byte bytes[], size_t size,
    fmi3FMUState *state)
{
    if (size != state_size(c))
        return tell(c, fmi3Error, "these are the bytes of another model's state");
    if (!*state)
        *state = malloc(size);
    if (!*state)
        return tell(c, fmi3Error, "out of memory");
    memcpy(*state, bytes, size);
    return fmi3OK;
}

#define DERIVATIVE(name) \
    fmi3Status name(fmi3Instance c, const fmi3ValueReference unknown[], size_t unknowns, \
        const fmi3ValueReference known[], size_t knowns, const fmi3Float64 seed[], size_t seeds, \
        fmi3Float64 out[], size_t outs) \
    { \
        (void)unknown, (void)unknowns, (void)known, (void)knowns, (void)seed, (void)seeds; \
        (void)out, (void)outs; \
        return tell(c, fmi3Error, "directional derivatives are not provided"); \
    }

DERIVATIVE(fmi3GetDirectionalDerivative)
DERIVATIVE(fmi3GetAdjointDerivative)

fmi3Status fmi3GetIntervalDecimal(fmi3Instance c, const fmi3ValueReference vr[], size_t n,
    fmi3Float64 interval[], fmi3IntervalQualifier qualifier[])
{
    (void)vr, (void)n, (void)interval, (void)qualifier;
    return tell(c, fmi3Error, "there are no clocks");
}

fmi3Status fmi3GetIntervalFraction(fmi3Instance c, const fmi3ValueReference vr[], size_t n,
    fmi3UInt64 counter[], fmi3UInt64 resolution[], fmi3IntervalQualifier qualifier[])
{
    (void)vr, (void)n, (void)counter, (void)resolution, (void)qualifier;
    return tell(c, fmi3Error, "there are no clocks");
}

fmi3Status fmi3GetShiftDecimal(fmi3Instance c, const fmi3ValueReference vr[], size_t n,
    fmi3Float64 shift[])
{
    (void)vr, (void)n, (void)shift;
    return tell(c, fmi3Error, "there are no clocks");
}

fmi3Status fmi3GetShiftFraction(fmi3Instance c, const fmi3ValueReference vr[], size_t n,
    fmi3UInt64 counter[], fmi3UInt64 resolution[])
{
    (void)vr, (void)n, (void)counter, (void)resolution;
    return tell(c, fmi3Error, "there are no clocks");
}

fmi3Status fmi3SetIntervalDecimal(fmi3Instance c, const fmi3ValueReference vr[], size_t n,
    const fmi3Float64 interval[])
{
    (void)vr, (void)n, (void)interval;
    return tell(c, fmi3Error, "there are no clocks");
}

fmi3Status fmi3SetIntervalFraction(fmi3Instance c, const fmi3ValueReference vr[], size_t n,
    const fmi3UInt64 counter[], const fmi3UInt64 resolution[])
{
    (void)vr, (void)n, (void)counter, (void)resolution;
    return tell(c, fmi3Error, "there are no clocks");
}

fmi3Status fmi3SetShiftDecimal(fmi3Instance c, const fmi3ValueReference vr[], size_t n,
    const fmi3Float64 shift[])
{
    (void)vr, (void)n, (void)shift;
    return tell(c, fmi3Error, "there are no clocks");
}

fmi3Status fmi3SetShiftFraction(fmi3Instance c, const fmi3ValueReference vr[], size_t n,
    const fmi3UInt64 counter[], const fmi3UInt64 resolution[])
{
    (void)vr, (void)n, (void)counter, (void)resolution;
    return tell(c, fmi3Error, "there are no clocks");
}

fmi3Status fmi3ActivateModelPartition(fmi3Instance c, fmi3ValueReference clock, fmi3Float64 time)
{
    (void)clock, (void)time;
    return tell(c, fmi3Error, "there are no clocks");
}

fmi3Status fmi3UpdateDiscreteStates(fmi3Instance c, fmi3Boolean *again, fmi3Boolean *terminate,
    fmi3Boolean *nominals, fmi3Boolean *values, fmi3Boolean *has_next, fmi3Float64 *next)
{
    (void)c;
    *again = *terminate = *nominals = *values = *has_next = fmi3False;
    *next = 0.0;
    return fmi3OK;
}

/* Model exchange. */

fmi3Status fmi3CompletedIntegratorStep(fmi3Instance c, fmi3Boolean final, fmi3Boolean *enter,
    fmi3Boolean *terminate)
{
    (void)c, (void)final;
    *enter = *terminate = fmi3False;
    return fmi3OK;
}

fmi3Status fmi3SetTime(fmi3Instance c, fmi3Float64 time)
{
    ((instance *)c)->model->value[TIME] = time;
    return fmi3OK;
}

fmi3Status fmi3SetContinuousStates(fmi3Instance c, const fmi3Float64 x[], size_t n)
{
    instance *i = c;
    if (n != i->model->states)
        return tell(i, fmi3Error, "that is not the number of states");
    for (size_t k = 0; k < n; k++)
        i->model->value[STATE + i->model->moving[k]] = x[k];
    i->stale = 1;
    return fmi3OK;
}

fmi3Status fmi3GetContinuousStateDerivatives(fmi3Instance c, fmi3Float64 out[], size_t n)
{
    instance *i = c;
    if (n != i->model->states)
        return tell(i, fmi3Error, "that is not the number of states");
    refresh(i);
    for (size_t k = 0; k < n; k++)
        out[k] = i->model->value[RATE + i->model->moving[k]];
    return fmi3OK;
}

fmi3Status fmi3GetContinuousStates(fmi3Instance c, fmi3Float64 x[], size_t n)
{
    const instance *i = c;
    if (n != i->model->states)
        return tell(i, fmi3Error, "that is not the number of states");
    for (size_t k = 0; k < n; k++)
        x[k] = i->model->value[STATE + i->model->moving[k]];
    return fmi3OK;
}

fmi3Status fmi3GetNominalsOfContinuousStates(fmi3Instance c, fmi3Float64 out[], size_t n)
{
    (void)c;
    for (size_t k = 0; k < n; k++)
        out[k] = 1.0;
    return fmi3OK;
}

fmi3Status fmi3GetEventIndicators(fmi3Instance c, fmi3Float64 out[], size_t n)
{
    (void)out;
    return n == 0 ? fmi3OK : tell(c, fmi3Error, "there are no event indicators");
}

fmi3Status fmi3GetNumberOfEventIndicators(fmi3Instance c, size_t *n)
{
    (void)c;
    *n = 0;
    return fmi3OK;
}

fmi3Status fmi3GetNumberOfContinuousStates(fmi3Instance c, size_t *n)
{
    *n = ((instance *)c)->model->states;
    return fmi3OK;
}

/* Co-simulation. */

fmi3Status fmi3GetOutputDerivatives(fmi3Instance c, const fmi3ValueReference vr[], size_t n,
    const fmi3Int32 orders[], fmi3Float64 value[], size_t values)
{
    (void)vr, (void)orders, (void)value, (void)values;
    return n == 0 ? fmi3OK : tell(c, fmi3Error, "rates are variables of their own");
}

fmi3Status fmi3DoStep(fmi3Instance c, fmi3Float64 at, fmi3Float64 length, fmi3Boolean final,
    fmi3Boolean *events, fmi3Boolean *terminate, fmi3Boolean *early, fmi3Float64 *last)
{
    instance *i = c;
    (void)final;
    *events = *terminate = *early = fmi3False;
    i->model->value[TIME] = at;
    const char *why = model_step(i->model, length);
    i->stale = 1;
    *last = i->model->value[TIME];
    return why ? tell(i, fmi3Error, why) : fmi3OK;
}
