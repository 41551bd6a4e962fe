/* Sails an FMU of FMI 3.0 under a rudder order, as an importer would, and prints its states:
 * LIBRARY FOLDER RUDDER_DEG DURATION_S STEP_S TOKEN EXCHANGE [REFERENCE VALUE]... */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "headers/fmi3PlatformTypes.h"

#include "headers/fmi3FunctionTypes.h"

#include "dynamic.h"

static void logged(fmi3InstanceEnvironment environment, fmi3Status status, fmi3String category,
    fmi3String message)
{
    (void)environment, (void)category;
    fprintf(stderr, "%d %s\n", status, message);
}

#define MUST(call) if ((call) != fmi3OK) return 4

int main(int argc, char **argv)
{
    if (argc < 8)
        return 5;
    void *library = loaded(argv[1]);
    if (!library)
        return 6;
    FIND(fmi3InstantiateCoSimulation);
    FIND(fmi3InstantiateModelExchange);
    FIND(fmi3EnterInitializationMode);
    FIND(fmi3ExitInitializationMode);
    FIND(fmi3GetFloat64);
    FIND(fmi3SetFloat64);
    FIND(fmi3DoStep);
    FIND(fmi3GetContinuousStates);
    FIND(fmi3SetContinuousStates);
    FIND(fmi3GetContinuousStateDerivatives);
    FIND(fmi3FreeInstance);
    char path[4096];
    snprintf(path, sizeof path, "%s/resources/", argv[2]);
    const double order = atof(argv[3])*3.14159265358979323846/180.0;
    const double step = atof(argv[5]);
    const long steps = lround(atof(argv[4])/step);
    const int exchange = atoi(argv[7]);
    fmi3Instance c = exchange
        ? fmi3InstantiateModelExchange_("ship", argv[6], path, fmi3False, fmi3False, NULL, logged)
        : fmi3InstantiateCoSimulation_("ship", argv[6], path, fmi3False, fmi3False, fmi3False,
            fmi3False, NULL, 0, NULL, logged, NULL);
    if (!c)
        return 7;
    if (fmi3InstantiateModelExchange_("ship", "another", path, 0, 0, NULL, logged))
        return 8;
    const fmi3ValueReference rudder[] = {19}, states[] = {1, 2, 3, 4, 5, 6, 7, 8, 9};
    MUST(fmi3EnterInitializationMode_(c, fmi3False, 0.0, 0.0, fmi3False, 0.0));
    MUST(fmi3SetFloat64_(c, rudder, 1, &order, 1));
    for (int k = 8; k + 1 < argc; k += 2) {
        const fmi3ValueReference reference = (fmi3ValueReference)atoi(argv[k]);
        const double value = atof(argv[k + 1]);
        MUST(fmi3SetFloat64_(c, &reference, 1, &value, 1));
    }
    MUST(fmi3ExitInitializationMode_(c));
    size_t n = 9;
    double x[9], k[4][9], at[9];
    while (exchange && n > 0 && fmi3GetContinuousStates_(c, x, n) != fmi3OK)
        n--;
    printf("t\n");
    for (long i = 0; i <= steps; i++) {
        double now[9];
        MUST(fmi3GetFloat64_(c, states, 9, now, 9));
        printf("%.17g", (double)i*step);
        for (int s = 0; s < 9; s++)
            printf(",%.17g", now[s]);
        printf("\n");
        if (!exchange) {
            fmi3Boolean events, terminate, early;
            double last;
            MUST(fmi3DoStep_(c, (double)i*step, step, fmi3True, &events, &terminate, &early, &last));
            continue;
        }
        static const double share[] = {0.5, 0.5, 1.0};
        MUST(fmi3GetContinuousStates_(c, x, n));
        for (int stage = 0; stage < 4; stage++) {
            MUST(fmi3GetContinuousStateDerivatives_(c, k[stage], n));
            for (size_t s = 0; stage < 3 && s < n; s++)
                at[s] = x[s] + share[stage]*step*k[stage][s];
            if (stage < 3)
                MUST(fmi3SetContinuousStates_(c, at, n));
        }
        for (size_t s = 0; s < n; s++)
            x[s] += step/6.0*(k[0][s] + 2.0*(k[1][s] + k[2][s]) + k[3][s]);
        MUST(fmi3SetContinuousStates_(c, x, n));
    }
    fmi3FreeInstance_(c);
    return 0;
}
