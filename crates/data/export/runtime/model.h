/* A manoeuvring model as a list of operations, read from a file of its resources.
 *
 * Variables stand in one array: time, states, their rates, the ordered rudder, what else the model
 * takes from outside, its coefficients, and the longest step. A value reference is a place in it. */
#ifndef SISTERSHIP_MODEL_H
#define SISTERSHIP_MODEL_H

#include <stddef.h>
#include <stdint.h>

enum { TIME = 0, STATE = 1, RATE = 10, ORDER = 19, OUTSIDE = 20, STATES = 9 };
enum { U, V, R, P, PHI, PSI, X, Y, DELTA };

typedef struct {
    int32_t code;
    int32_t operand[4];
    double constant;
} instruction;

typedef struct model {
    char token[80];
    size_t variables, instructions, terms, states;
    int32_t moving[STATES];
    double *value;
    double *start;
    double *result;
    instruction *program;
    int32_t *term;
    int32_t force[4], mass[16], added[4], kinematic[4];
    /* How far outside of what trials covered: where it is calculated, and its variable; or -1. */
    int32_t distance[2];
    int32_t has_gear, has_roll, has_mobility;
    double mobility[16];
    double limit_rad, rate_rad_s, time_constant_s, band_rad;
    double most_speed, most_yaw, most_roll;
} model;

/* Reads a model; 0 with the reason in `why` where it cannot. */
model *model_read(const char *path, char *why, size_t room);
void model_free(model *m);
/* Every variable as it was read. */
void model_reset(model *m);
/* The rates of the states where they are; step_s is what a gear without time constant needs. */
void model_rates(model *m, double step_s);
/* Whether a variable follows from others. */
int model_follows(const model *m, size_t variable);
/* One step of a length, in steps no longer than the longest; 0, or why the model stopped. */
const char *model_step(model *m, double length_s);
/* The longest step, s. */
double model_longest(const model *m);

#endif
