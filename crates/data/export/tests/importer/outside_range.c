/* Sets speeds and revolutions of an FMU, of FMI 2.0 or 3.0, and prints an output at each. */
#include <stdio.h>
#include <stdlib.h>

#ifdef FMU2
#include "headers/fmi2TypesPlatform.h"

#include "headers/fmi2FunctionTypes.h"
#else
#include "headers/fmi3PlatformTypes.h"

#include "headers/fmi3FunctionTypes.h"
#endif

#include "dynamic.h"

/* Zero is the status of what went well in both versions. */
#define MUST(call) if ((call) != 0) return 4

int main(int argc, char **argv)
{
    if (argc < 9)
        return 5;
    void *library = loaded(argv[1]);
    if (!library)
        return 6;
    char path[4096];
#ifdef FMU2
    FIND(fmi2Instantiate);
    FIND(fmi2EnterInitializationMode);
    FIND(fmi2ExitInitializationMode);
    FIND(fmi2GetReal);
    FIND(fmi2SetReal);
    FIND(fmi2FreeInstance);
    fmi2CallbackFunctions callbacks = {NULL, calloc, free, NULL, NULL};
    snprintf(path, sizeof path, "file://%s/resources", argv[2]);
    fmi2Component c =
        fmi2Instantiate_("ship", fmi2CoSimulation, argv[3], path, &callbacks, 0, 0);
#define SET(vr, value) fmi2SetReal_(c, vr, 2, value)
#define GET(vr, value) fmi2GetReal_(c, vr, 1, value)
#define ENTER() fmi2EnterInitializationMode_(c)
#define EXIT() fmi2ExitInitializationMode_(c)
#define FREE() fmi2FreeInstance_(c)
#else
    FIND(fmi3InstantiateCoSimulation);
    FIND(fmi3EnterInitializationMode);
    FIND(fmi3ExitInitializationMode);
    FIND(fmi3GetFloat64);
    FIND(fmi3SetFloat64);
    FIND(fmi3FreeInstance);
    snprintf(path, sizeof path, "%s/resources/", argv[2]);
    fmi3Instance c = fmi3InstantiateCoSimulation_("ship", argv[3], path, 0, 0, 0, 0, NULL, 0, NULL,
        NULL, NULL);
#define SET(vr, value) fmi3SetFloat64_(c, vr, 2, value, 2)
#define GET(vr, value) fmi3GetFloat64_(c, vr, 1, value, 1)
#define ENTER() fmi3EnterInitializationMode_(c, 0, 0.0, 0.0, 0, 0.0)
#define EXIT() fmi3ExitInitializationMode_(c)
#define FREE() fmi3FreeInstance_(c)
#endif
    if (!c)
        return 7;
    const unsigned int given[] = {(unsigned int)atoi(argv[4]), (unsigned int)atoi(argv[5])};
    const unsigned int distance[] = {(unsigned int)atoi(argv[6])};
    MUST(ENTER());
    MUST(EXIT());
    for (int k = 7; k + 1 < argc; k += 2) {
        const double values[] = {atof(argv[k]), atof(argv[k + 1])};
        double out[] = {0.0, 0.0};
        MUST(SET(given, values));
        MUST(GET(distance, out));
        printf("%.17g\n", out[0]);
    }
    const double forbidden[] = {0.0, 0.0};
    const unsigned int both[] = {distance[0], distance[0]};
    if (SET(both, forbidden) == 0)
        return 8;
    FREE();
    return 0;
}
