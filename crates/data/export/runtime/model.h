/* A manoeuvring model as a list of operations, read from a file of its resources.
 *
 * Variables stand in one array: time, states, their rates, the ordered rudder, what else the model
 * takes from outside, its parameters, and the longest step. A value reference is a place in it. */
#ifndef SISTERSHIP_MODEL_H
#define SISTERSHIP_MODEL_H

#include <stddef.h>
#include <stdint.h>

enum { TIME = 0, STATE = 1, RATE = 10, ORDER = 19, OUTSIDE = 20, STATES = 9 };
enum { U, V, R, P, PHI, PSI, X, Y, DELTA };
/* Figures of the steering gear: its limit, its rate, its time constant, half of its dead band. */
enum { LIMIT, SPEED, LAG, BAND, FIGURES };

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
    /* The operations in two parts: those that follow from parameters alone, then the rest. */
    size_t *order;
    size_t settled;
    /* Whether a parameter was set since the first part was calculated. */
    int unsettled;
    /* The first variable that is a parameter. */
    int32_t parameters;
    int32_t force[4], mass[16], added[4], kinematic[4];
    /* How far outside of what trials covered: where it is calculated, and its variable; or -1. */
    int32_t distance[2];
    int32_t has_gear, has_roll, has_mobility;
    /* Places of the figures of the steering gear among the variables; -1 without one. */
    int32_t gear[FIGURES];
    double mobility[16];
    double most_speed, most_yaw, most_roll;
} model;

/* Reads a model from a path in UTF-8; 0 with the reason in `why` where it cannot. */
model *model_read(const char *path, char *why, size_t room);
void model_free(model *m);
/* Every variable as it was read. */
void model_reset(model *m);
/* The rates of the states where they are; step_s is what a gear without time constant needs. */
void model_rates(model *m, double step_s);
/* Whether a variable follows from others. */
int model_follows(const model *m, size_t variable);
/* Sets a variable; 0 where it follows from others, or there is none. */
int model_set(model *m, size_t variable, double value);
/* Every variable as in a copy of them. */
void model_restore(model *m, const double *values);
/* Whether parameters, states and inputs give accelerations: 0, or what is wrong with them. */
const char *model_refusal(model *m);
/* One step of a length, in steps no longer than the longest; 0, or why the model stopped. */
const char *model_step(model *m, double length_s);
/* The longest step, s. */
double model_longest(const model *m);

#endif
