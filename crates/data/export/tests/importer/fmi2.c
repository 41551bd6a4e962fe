/* Sails an FMU of FMI 2.0 under a rudder order, as an importer would, and prints its states:
 * LIBRARY FOLDER RUDDER_DEG DURATION_S STEP_S TOKEN EXCHANGE [REFERENCE VALUE]... */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "headers/fmi2TypesPlatform.h"

#include "headers/fmi2FunctionTypes.h"

#include "dynamic.h"

static void logged(void *environment, const char *name, fmi2Status status, const char *category,
    const char *message, ...)
{
    va_list given;
    (void)environment, (void)category;
    fprintf(stderr, "%s: %d ", name, status);
    va_start(given, message);
    vfprintf(stderr, message, given);
    va_end(given);
    fprintf(stderr, "\n");
}

#define MUST(call) if ((call) != fmi2OK) return 4

int main(int argc, char **argv)
{
    if (argc < 8)
        return 5;
    void *library = loaded(argv[1]);
    if (!library)
        return 6;
    FIND(fmi2Instantiate);
    FIND(fmi2SetupExperiment);
    FIND(fmi2EnterInitializationMode);
    FIND(fmi2ExitInitializationMode);
    FIND(fmi2GetReal);
    FIND(fmi2SetReal);
    FIND(fmi2DoStep);
    FIND(fmi2GetContinuousStates);
    FIND(fmi2SetContinuousStates);
    FIND(fmi2GetDerivatives);
    FIND(fmi2FreeInstance);
    char uri[4096];
    snprintf(uri, sizeof uri, "file://%s/resources", argv[2]);
    const double order = atof(argv[3])*3.14159265358979323846/180.0;
    const double step = atof(argv[5]);
    const long steps = lround(atof(argv[4])/step);
    const int exchange = atoi(argv[7]);
    fmi2CallbackFunctions callbacks = {logged, calloc, free, NULL, NULL};
    fmi2Component c = fmi2Instantiate_("ship", exchange ? fmi2ModelExchange : fmi2CoSimulation,
        argv[6], uri, &callbacks, fmi2False, fmi2False);
    if (!c)
        return 7;
    if (fmi2Instantiate_("ship", fmi2CoSimulation, "another", uri, &callbacks, 0, 0))
        return 8;
    const fmi2ValueReference rudder[] = {19}, states[] = {1, 2, 3, 4, 5, 6, 7, 8, 9};
    MUST(fmi2SetupExperiment_(c, fmi2False, 0.0, 0.0, fmi2False, 0.0));
    MUST(fmi2EnterInitializationMode_(c));
    MUST(fmi2SetReal_(c, rudder, 1, &order));
    for (int k = 8; k + 1 < argc; k += 2) {
        const fmi2ValueReference reference = (fmi2ValueReference)atoi(argv[k]);
        const double value = atof(argv[k + 1]);
        MUST(fmi2SetReal_(c, &reference, 1, &value));
    }
    MUST(fmi2ExitInitializationMode_(c));
    size_t n = 9;
    double x[9], k[4][9], at[9];
    while (exchange && n > 0 && fmi2GetContinuousStates_(c, x, n) != fmi2OK)
        n--;
    printf("t\n");
    for (long i = 0; i <= steps; i++) {
        double now[9];
        MUST(fmi2GetReal_(c, states, 9, now));
        printf("%.17g", (double)i*step);
        for (int s = 0; s < 9; s++)
            printf(",%.17g", now[s]);
        printf("\n");
        if (!exchange) {
            MUST(fmi2DoStep_(c, (double)i*step, step, fmi2True));
            continue;
        }
        static const double share[] = {0.5, 0.5, 1.0};
        MUST(fmi2GetContinuousStates_(c, x, n));
        for (int stage = 0; stage < 4; stage++) {
            MUST(fmi2GetDerivatives_(c, k[stage], n));
            for (size_t s = 0; stage < 3 && s < n; s++)
                at[s] = x[s] + share[stage]*step*k[stage][s];
            if (stage < 3)
                MUST(fmi2SetContinuousStates_(c, at, n));
        }
        for (size_t s = 0; s < n; s++)
            x[s] += step/6.0*(k[0][s] + 2.0*(k[1][s] + k[2][s]) + k[3][s]);
        MUST(fmi2SetContinuousStates_(c, x, n));
    }
    fmi2FreeInstance_(c);
    return 0;
}
