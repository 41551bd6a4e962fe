/* FMI 2.0, co-simulation and model exchange. */
#include "headers/fmi2Functions.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "model.h"

typedef struct {
    model *model;
    char *name;
    fmi2CallbackFunctions callbacks;
    int stale;
} instance;

static fmi2Status tell(const instance *i, fmi2Status status, const char *message)
{
    if (i->callbacks.logger)
        i->callbacks.logger(i->callbacks.componentEnvironment, i->name, status,
            status == fmi2OK ? "logAll" : "logStatusError", "%s", message);
    return status;
}

static int digit(char c)
{
    if (c >= '0' && c <= '9')
        return c - '0';
    return c >= 'a' && c <= 'f' ? c - 'a' + 10 : c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

/* The path of a file URI; room for it and for what is added. */
static char *path_of(const char *uri, const char *added)
{
    static const char *const heads[] = {"file://localhost", "file://", "file:"};
    for (int k = 0; k < 3; k++) {
        if (strncmp(uri, heads[k], strlen(heads[k])) == 0) {
            uri += strlen(heads[k]);
            break;
        }
    }
#ifdef _WIN32
    /* The slash before a drive is the URI's: file:///C:/Users. */
    if (uri[0] == '/' && uri[1] != '\0' && uri[2] == ':')
        uri++;
#endif
    char *path = malloc(strlen(uri) + strlen(added) + 2);
    size_t n = 0;
    if (!path)
        return NULL;
    for (; *uri; uri++) {
        if (*uri == '%' && digit(uri[1]) >= 0 && digit(uri[2]) >= 0) {
            path[n++] = (char)(16*digit(uri[1]) + digit(uri[2]));
            uri += 2;
        } else {
            path[n++] = *uri;
        }
    }
    while (n > 1 && path[n - 1] == '/')
        n--;
    path[n] = '\0';
    strcat(strcat(path, "/"), added);
    return path;
}

const char *fmi2GetTypesPlatform(void)
{
    return fmi2TypesPlatform;
}

const char *fmi2GetVersion(void)
{
    return fmi2Version;
}

fmi2Status fmi2SetDebugLogging(fmi2Component c, fmi2Boolean on, size_t n, const fmi2String names[])
{
    (void)c, (void)on, (void)n, (void)names;
    return fmi2OK;
}

fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String guid, fmi2String location,
    const fmi2CallbackFunctions *functions, fmi2Boolean visible, fmi2Boolean logging)
{
    char why[512] = "out of memory";
    (void)type, (void)visible, (void)logging;
    instance *i = calloc(1, sizeof *i);
    if (!i || !name || !guid || !location)
        return free(i), NULL;
    if (functions)
        i->callbacks = *functions;
    i->name = malloc(strlen(name) + 1);
    if (i->name)
        strcpy(i->name, name);
    char *path = path_of(location, "model.txt");
    if (path && i->name)
        i->model = model_read(path, why, sizeof why);
    free(path);
    if (i->model && strcmp(i->model->token, guid) == 0) {
        i->stale = 1;
        return i;
    }
    tell(i, fmi2Error, i->model ? "the GUID is that of another model" : why);
    fmi2FreeInstance(i);
    return NULL;
}

void fmi2FreeInstance(fmi2Component c)
{
    instance *i = c;
    if (!i)
        return;
    model_free(i->model);
    free(i->name);
    free(i);
}

fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean has_tolerance, fmi2Real tolerance,
    fmi2Real start, fmi2Boolean has_stop, fmi2Real stop)
{
    (void)has_tolerance, (void)tolerance, (void)has_stop, (void)stop;
    ((instance *)c)->model->value[TIME] = start;
    return fmi2OK;
}

fmi2Status fmi2EnterInitializationMode(fmi2Component c)
{
    (void)c;
    return fmi2OK;
}

fmi2Status fmi2ExitInitializationMode(fmi2Component c)
{
    instance *i = c;
    const char *why = model_refusal(i->model);
    i->stale = 1;
    return why ? tell(i, fmi2Error, why) : fmi2OK;
}

fmi2Status fmi2Terminate(fmi2Component c)
{
    (void)c;
    return fmi2OK;
}

fmi2Status fmi2Reset(fmi2Component c)
{
    instance *i = c;
    model_reset(i->model);
    i->stale = 1;
    return fmi2OK;
}

static void refresh(instance *i)
{
    if (i->stale)
        model_rates(i->model, model_longest(i->model));
    i->stale = 0;
}

fmi2Status fmi2GetReal(fmi2Component c, const fmi2ValueReference vr[], size_t n, fmi2Real value[])
{
    instance *i = c;
    for (size_t k = 0; k < n; k++) {
        if (vr[k] >= i->model->variables)
            return tell(i, fmi2Error, "there is no such value reference");
        if (model_follows(i->model, vr[k]))
            refresh(i);
        value[k] = i->model->value[vr[k]];
    }
    return fmi2OK;
}

fmi2Status fmi2SetReal(fmi2Component c, const fmi2ValueReference vr[], size_t n,
    const fmi2Real value[])
{
    instance *i = c;
    for (size_t k = 0; k < n; k++) {
        i->stale = 1;
        if (!model_set(i->model, vr[k], value[k]))
            return tell(i, fmi2Error, "no such variable can be set");
    }
    return fmi2OK;
}

/* There are variables of the type Real only. */
#define NONE(kind, type) \
    fmi2Status fmi2Get##kind(fmi2Component c, const fmi2ValueReference vr[], size_t n, \
        type value[]) \
    { \
        (void)vr, (void)value; \
        return n == 0 ? fmi2OK : tell(c, fmi2Error, "every variable is of the type Real"); \
    } \
    fmi2Status fmi2Set##kind(fmi2Component c, const fmi2ValueReference vr[], size_t n, \
        const type value[]) \
    { \
        (void)vr, (void)value; \
        return n == 0 ? fmi2OK : tell(c, fmi2Error, "every variable is of the type Real"); \
    }

NONE(Integer, fmi2Integer)
NONE(Boolean, fmi2Boolean)
NONE(String, fmi2String)

static size_t state_size(const instance *i)
{
    return i->model->variables*sizeof(double);
}

fmi2Status fmi2GetFMUstate(fmi2Component c, fmi2FMUstate *state)
{
    instance *i = c;
    if (!*state)
        *state = malloc(state_size(i));
    if (!*state)
        return tell(i, fmi2Error, "out of memory");
    memcpy(*state, i->model->value, state_size(i));
    return fmi2OK;
}

fmi2Status fmi2SetFMUstate(fmi2Component c, fmi2FMUstate state)
{
    instance *i = c;
    model_restore(i->model, state);
    i->stale = 1;
    return fmi2OK;
}

fmi2Status fmi2FreeFMUstate(fmi2Component c, fmi2FMUstate *state)
{
    (void)c;
    free(*state);
    *state = NULL;
    return fmi2OK;
}

fmi2Status fmi2SerializedFMUstateSize(fmi2Component c, fmi2FMUstate state, size_t *size)
{
    (void)state;
    *size = state_size(c);
    return fmi2OK;
}

fmi2Status fmi2SerializeFMUstate(fmi2Component c, fmi2FMUstate state, fmi2Byte bytes[], size_t size)
{
    if (size < state_size(c))
        return tell(c, fmi2Error, "no room for the state");
    memcpy(bytes, state, state_size(c));
    return fmi2OK;
}

fmi2Status fmi2DeSerializeFMUstate(fmi2Component c, const fmi2Byte bytes[], size_t size,
    fmi2FMUstate *state)
{
    if (size != state_size(c))
        return tell(c, fmi2Error, "these are the bytes of another model's state");
    if (!*state)
        *state = malloc(size);
    if (!*state)
        return tell(c, fmi2Error, "out of memory");
    memcpy(*state, bytes, size);
    return fmi2OK;
}

fmi2Status fmi2GetDirectionalDerivative(fmi2Component c, const fmi2ValueReference unknown[],
    size_t unknowns, const fmi2ValueReference known[], size_t knowns, const fmi2Real seed[],
    fmi2Real out[])
{
    (void)unknown, (void)unknowns, (void)known, (void)knowns, (void)seed, (void)out;
    return tell(c, fmi2Error, "directional derivatives are not provided");
}

/* Model exchange. */

fmi2Status fmi2EnterEventMode(fmi2Component c)
{
    (void)c;
    return fmi2OK;
}

fmi2Status fmi2NewDiscreteStates(fmi2Component c, fmi2EventInfo *info)
{
    (void)c;
    memset(info, 0, sizeof *info);
    return fmi2OK;
}

fmi2Status fmi2EnterContinuousTimeMode(fmi2Component c)
{
    (void)c;
    return fmi2OK;
}

fmi2Status fmi2CompletedIntegratorStep(fmi2Component c, fmi2Boolean final, fmi2Boolean *enter,
    fmi2Boolean *terminate)
{
    (void)c, (void)final;
    *enter = *terminate = fmi2False;
    return fmi2OK;
}

fmi2Status fmi2SetTime(fmi2Component c, fmi2Real time)
{
    ((instance *)c)->model->value[TIME] = time;
    return fmi2OK;
}

fmi2Status fmi2SetContinuousStates(fmi2Component c, const fmi2Real x[], size_t n)
{
    instance *i = c;
    if (n != i->model->states)
        return tell(i, fmi2Error, "that is not the number of states");
    for (size_t k = 0; k < n; k++)
        i->model->value[STATE + i->model->moving[k]] = x[k];
    i->stale = 1;
    return fmi2OK;
}

fmi2Status fmi2GetDerivatives(fmi2Component c, fmi2Real out[], size_t n)
{
    instance *i = c;
    if (n != i->model->states)
        return tell(i, fmi2Error, "that is not the number of states");
    refresh(i);
    for (size_t k = 0; k < n; k++)
        out[k] = i->model->value[RATE + i->model->moving[k]];
    return fmi2OK;
}

fmi2Status fmi2GetEventIndicators(fmi2Component c, fmi2Real out[], size_t n)
{
    (void)out;
    return n == 0 ? fmi2OK : tell(c, fmi2Error, "there are no event indicators");
}

fmi2Status fmi2GetContinuousStates(fmi2Component c, fmi2Real x[], size_t n)
{
    const instance *i = c;
    if (n != i->model->states)
        return tell(i, fmi2Error, "that is not the number of states");
    for (size_t k = 0; k < n; k++)
        x[k] = i->model->value[STATE + i->model->moving[k]];
    return fmi2OK;
}

fmi2Status fmi2GetNominalsOfContinuousStates(fmi2Component c, fmi2Real out[], size_t n)
{
    (void)c;
    for (size_t k = 0; k < n; k++)
        out[k] = 1.0;
    return fmi2OK;
}

/* Co-simulation. */

fmi2Status fmi2SetRealInputDerivatives(fmi2Component c, const fmi2ValueReference vr[], size_t n,
    const fmi2Integer order[], const fmi2Real value[])
{
    (void)vr, (void)order, (void)value;
    return n == 0 ? fmi2OK : tell(c, fmi2Error, "inputs are held over a step");
}

fmi2Status fmi2GetRealOutputDerivatives(fmi2Component c, const fmi2ValueReference vr[], size_t n,
    const fmi2Integer order[], fmi2Real value[])
{
    (void)vr, (void)order, (void)value;
    return n == 0 ? fmi2OK : tell(c, fmi2Error, "rates are variables of their own");
}

fmi2Status fmi2DoStep(fmi2Component c, fmi2Real at, fmi2Real length, fmi2Boolean final)
{
    instance *i = c;
    (void)final;
    i->model->value[TIME] = at;
    const char *why = model_step(i->model, length);
    i->stale = 1;
    return why ? tell(i, fmi2Error, why) : fmi2OK;
}

fmi2Status fmi2CancelStep(fmi2Component c)
{
    return tell(c, fmi2Error, "steps are finished when they return");
}

#define STATUS(kind, type) \
    fmi2Status fmi2Get##kind##Status(fmi2Component c, const fmi2StatusKind s, type *value) \
    { \
        (void)c, (void)s, (void)value; \
        return fmi2Discard; \
    }

STATUS(, fmi2Status)
STATUS(Integer, fmi2Integer)
STATUS(Boolean, fmi2Boolean)
STATUS(String, fmi2String)

fmi2Status fmi2GetRealStatus(fmi2Component c, const fmi2StatusKind s, fmi2Real *value)
{
    if (s != fmi2LastSuccessfulTime)
        return fmi2Discard;
    *value = ((instance *)c)->model->value[TIME];
    return fmi2OK;
}
