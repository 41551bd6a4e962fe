/* Reading, evaluation and integration of a model; knows nothing of FMI. */
#include "model.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#ifdef _WIN32
/* Without what windows draw: its names are those of operations here. */
#define NOUSER
#define WIN32_LEAN_AND_MEAN
#include <windows.h>
#endif

enum {
    CONSTANT, INPUT, NEGATE, ADD, SUBTRACT, MULTIPLY, DIVIDE, POWER,
    SIN, COS, TAN, ATAN, ATAN2, SQRT, ABS, EXP, LOG, TANH, MIN, MAX, SIGN,
    LESS, LESS_OR_EQUAL, GREATER, GREATER_OR_EQUAL, PRODUCTS
};

/* Doubles are written by their bits: what is read does not depend on the locale. */
static int number(FILE *file, double *out)
{
    uint64_t bits;
    if (fscanf(file, "%" SCNx64, &bits) != 1)
        return 0;
    memcpy(out, &bits, sizeof bits);
    return 1;
}

static int numbers(FILE *file, double *out, size_t count)
{
    for (size_t k = 0; k < count; k++)
        if (!number(file, out + k))
            return 0;
    return 1;
}

static int whole(FILE *file, int32_t *out, size_t count)
{
    for (size_t k = 0; k < count; k++)
        if (fscanf(file, "%" SCNd32, out + k) != 1)
            return 0;
    return 1;
}

static int sizes(FILE *file, model *m)
{
    int32_t of[5];
    if (fscanf(file, "sistership-fmu-3 %79s", m->token) != 1 || !whole(file, of, 5))
        return 0;
    for (int k = 0; k < 5; k++)
        if (of[k] < 0 || of[k] > 10000000)
            return 0;
    if (of[0] < OUTSIDE + 1 || of[3] > STATES || of[4] < OUTSIDE)
        return 0;
    m->variables = (size_t)of[0];
    m->instructions = (size_t)of[1];
    m->terms = (size_t)of[2];
    m->states = (size_t)of[3];
    m->parameters = of[4];
    m->value = calloc(m->variables, sizeof *m->value);
    m->start = calloc(m->variables, sizeof *m->start);
    m->result = calloc(m->instructions + 1, sizeof *m->result);
    m->program = calloc(m->instructions + 1, sizeof *m->program);
    m->term = calloc(2*m->terms + 1, sizeof *m->term);
    m->order = calloc(m->instructions + 1, sizeof *m->order);
    return m->value && m->start && m->result && m->program && m->term && m->order;
}

static int within(int32_t place, size_t count)
{
    return place >= 0 && (size_t)place < count;
}

/* Operations read earlier results only. */
static int sound(const model *m, const instruction *one, size_t at)
{
    int operands = 2;
    if (one->code < CONSTANT || one->code > PRODUCTS)
        return 0;
    if (one->code == INPUT)
        return within(one->operand[0], m->variables);
    if (one->code == PRODUCTS) {
        if (one->operand[1] < 0 || one->operand[1] > one->operand[2]
            || (size_t)one->operand[2] > m->terms)
            return 0;
        for (int32_t k = 2*one->operand[1]; k < 2*one->operand[2]; k++)
            if (!within(m->term[k], at))
                return 0;
        operands = 1;
    }
    if (one->code == CONSTANT)
        operands = 0;
    if (one->code >= LESS && one->code <= GREATER_OR_EQUAL)
        operands = 4;
    for (int k = 0; k < operands; k++)
        if (!within(one->operand[k], at))
            return 0;
    return 1;
}

static int all_within(const int32_t *place, size_t count, size_t most)
{
    for (size_t k = 0; k < count; k++)
        if (place[k] != -1 && !within(place[k], most))
            return 0;
    return 1;
}

static int contents(FILE *file, model *m)
{
    if (!whole(file, m->moving, m->states) || !numbers(file, m->start, m->variables))
        return 0;
    for (size_t k = 0; k < m->states; k++)
        if (!within(m->moving[k], STATES))
            return 0;
    for (size_t k = 0; k < m->instructions; k++) {
        instruction *one = m->program + k;
        if (!whole(file, &one->code, 1) || !whole(file, one->operand, 4)
            || !number(file, &one->constant))
            return 0;
    }
    if (!whole(file, m->term, 2*m->terms))
        return 0;
    for (size_t k = 0; k < m->instructions; k++)
        if (!sound(m, m->program + k, k))
            return 0;
    if (!whole(file, m->force, 4) || !whole(file, m->mass, 16) || !whole(file, m->added, 4)
        || !whole(file, m->kinematic, 4) || !whole(file, m->distance, 2))
        return 0;
    if (!all_within(m->force, 4, m->instructions) || !all_within(m->mass, 16, m->instructions)
        || !all_within(m->added, 4, m->instructions)
        || !all_within(m->kinematic, 4, m->instructions)
        || !all_within(m->distance, 1, m->instructions)
        || !all_within(m->distance + 1, 1, m->variables)
        || (m->distance[0] < 0) != (m->distance[1] < 0))
        return 0;
    if (!whole(file, &m->has_gear, 1) || !whole(file, &m->has_roll, 1)
        || !whole(file, &m->has_mobility, 1))
        return 0;
    if (!whole(file, m->gear, FIGURES))
        return 0;
    for (int k = 0; m->has_gear && k < FIGURES; k++)
        if (!within(m->gear[k], m->variables))
            return 0;
    return numbers(file, m->mobility, 16) && number(file, &m->most_speed)
        && number(file, &m->most_yaw) && number(file, &m->most_roll);
}

/* Whether an operation changes with time, states or inputs; `moves` holds that of earlier ones. */
static int moves_with(const model *m, const instruction *one, const char *moves)
{
    int operands = one->code >= LESS && one->code <= GREATER_OR_EQUAL ? 4 : 2;
    if (one->code == CONSTANT)
        return 0;
    if (one->code == INPUT)
        return one->operand[0] < m->parameters;
    if (one->code == PRODUCTS) {
        for (int32_t k = 2*one->operand[1]; k < 2*one->operand[2]; k++)
            if (moves[m->term[k]])
                return 1;
        operands = 1;
    }
    for (int k = 0; k < operands; k++)
        if (moves[one->operand[k]])
            return 1;
    return 0;
}

/* Puts the operations in order: first what need be calculated only when a parameter is set. */
static int ordered(model *m)
{
    char *moves = calloc(m->instructions + 1, 1);
    size_t next = 0;
    if (!moves)
        return 0;
    for (size_t k = 0; k < m->instructions; k++) {
        moves[k] = (char)moves_with(m, m->program + k, moves);
        if (!moves[k])
            m->order[next++] = k;
    }
    m->settled = next;
    for (size_t k = 0; k < m->instructions; k++)
        if (moves[k])
            m->order[next++] = k;
    free(moves);
    return 1;
}

static FILE *opened(const char *path)
{
#ifdef _WIN32
    /* Windows takes a path in UTF-16; one that is no UTF-8 is in the code page of the machine. */
    const int length = MultiByteToWideChar(CP_UTF8, MB_ERR_INVALID_CHARS, path, -1, NULL, 0);
    wchar_t *wide = length > 0 ? malloc((size_t)length*sizeof *wide) : NULL;
    if (wide) {
        MultiByteToWideChar(CP_UTF8, MB_ERR_INVALID_CHARS, path, -1, wide, length);
        FILE *file = _wfopen(wide, L"rb");
        free(wide);
        return file;
    }
#endif
    return fopen(path, "rb");
}

model *model_read(const char *path, char *why, size_t room)
{
    FILE *file = opened(path);
    model *m = calloc(1, sizeof *m);
    int read = file && m && sizes(file, m) && contents(file, m) && ordered(m);
    if (file)
        fclose(file);
    if (!read) {
        snprintf(why, room, file ? "%s is no model of this program" : "%s cannot be opened", path);
        model_free(m);
        return NULL;
    }
    model_reset(m);
    return m;
}

void model_free(model *m)
{
    if (!m)
        return;
    free(m->value);
    free(m->start);
    free(m->result);
    free(m->program);
    free(m->term);
    free(m->order);
    free(m);
}

void model_reset(model *m)
{
    model_restore(m, m->start);
}

void model_restore(model *m, const double *values)
{
    memcpy(m->value, values, m->variables*sizeof *m->value);
    m->unsettled = 1;
}

double model_longest(const model *m)
{
    return m->value[m->variables - 1];
}

static double compared(int32_t code, double a, double b, double c, double d)
{
    switch (code) {
    case LESS: return a < b ? c : d;
    case LESS_OR_EQUAL: return a <= b ? c : d;
    case GREATER: return a > b ? c : d;
    default: return a >= b ? c : d;
    }
}

static double products(const model *m, const instruction *one)
{
    double sum = m->result[one->operand[0]];
    for (int32_t k = one->operand[1]; k < one->operand[2]; k++)
        sum += m->result[m->term[2*k]]*m->result[m->term[2*k + 1]];
    return sum;
}

static double evaluated(const model *m, const instruction *one)
{
    const double *r = m->result;
    const double a = r[one->operand[0]];
    const double b = r[one->operand[1]];
    switch (one->code) {
    case NEGATE: return -a;
    case ADD: return a + b;
    case SUBTRACT: return a - b;
    case MULTIPLY: return a*b;
    case DIVIDE: return a/b;
    case POWER: return pow(a, b);
    case SIN: return sin(a);
    case COS: return cos(a);
    case TAN: return tan(a);
    case ATAN: return atan(a);
    case ATAN2: return atan2(a, b);
    case SQRT: return sqrt(a);
    case ABS: return fabs(a);
    case EXP: return exp(a);
    case LOG: return log(a);
    case TANH: return tanh(a);
    case MIN: return fmin(a, b);
    case MAX: return fmax(a, b);
    case SIGN: return (a > 0.0) - (a < 0.0);
    default: return compared(one->code, a, b, r[one->operand[2]], r[one->operand[3]]);
    }
}

static void run(model *m)
{
    for (size_t k = m->unsettled ? 0 : m->settled; k < m->instructions; k++) {
        const instruction *one = m->program + m->order[k];
        double *result = m->result + m->order[k];
        switch (one->code) {
        case CONSTANT: *result = one->constant; break;
        case INPUT: *result = m->value[one->operand[0]]; break;
        case PRODUCTS: *result = products(m, one); break;
        default: *result = evaluated(m, one);
        }
    }
    m->unsettled = 0;
}

static double at(const model *m, int32_t place, double otherwise)
{
    return place < 0 ? otherwise : m->result[place];
}

/* Gaussian elimination with row exchanges: four equations, each with its right-hand side. */
static void solve(double row[4][5], double *out)
{
    for (int k = 0; k < 4; k++) {
        int best = k;
        for (int i = k + 1; i < 4; i++)
            if (fabs(row[i][k]) > fabs(row[best][k]))
                best = i;
        for (int j = 0; j < 5; j++) {
            const double kept = row[k][j];
            row[k][j] = row[best][j];
            row[best][j] = kept;
        }
        for (int i = k + 1; i < 4; i++) {
            const double factor = row[i][k]/row[k][k];
            for (int j = k; j < 5; j++)
                row[i][j] -= factor*row[k][j];
        }
    }
    for (int k = 3; k >= 0; k--) {
        out[k] = row[k][4];
        for (int j = k + 1; j < 4; j++)
            out[k] -= row[k][j]*out[j];
        out[k] /= row[k][k];
    }
}

static void accelerate(const model *m, double *out)
{
    if (m->has_mobility) {
        for (int i = 0; i < 4; i++) {
            out[i] = 0.0;
            for (int j = 0; j < 4; j++)
                if (m->mobility[4*i + j] != 0.0)
                    out[i] += m->mobility[4*i + j]*at(m, m->force[j], 0.0);
        }
        return;
    }
    double row[4][5];
    for (int i = 0; i < 4; i++) {
        for (int j = 0; j < 4; j++)
            row[i][j] = at(m, m->mass[4*i + j], i == j);
        row[i][4] = at(m, m->force[i], 0.0);
    }
    solve(row, out);
}

static double limited(double value, double most)
{
    return fmin(fmax(value, -most), most);
}

static double rudder_rate(const model *m, double step_s)
{
    if (!m->has_gear)
        return 0.0;
    double gear[FIGURES];
    for (int k = 0; k < FIGURES; k++)
        gear[k] = m->value[m->gear[k]];
    const double angle = m->value[STATE + DELTA];
    const double wanted = limited(m->value[ORDER], gear[LIMIT]);
    const double order = fmin(fmax(angle, wanted - gear[BAND]), wanted + gear[BAND]);
    return limited((order - angle)/fmax(gear[LAG], step_s), gear[SPEED]);
}

void model_rates(model *m, double step_s)
{
    const double *s = m->value + STATE;
    double *rate = m->value + RATE;
    double acceleration[4];
    run(m);
    accelerate(m, acceleration);
    rate[U] = acceleration[0] + at(m, m->added[0], 0.0);
    rate[V] = acceleration[1] + at(m, m->added[1], 0.0);
    rate[P] = acceleration[2] + at(m, m->added[2], 0.0);
    rate[R] = acceleration[3] + at(m, m->added[3], 0.0);
    const double sine = sin(s[PSI]), cosine = cos(s[PSI]);
    rate[X] = at(m, m->kinematic[0], s[U]*cosine - s[V]*sine);
    rate[Y] = at(m, m->kinematic[1], s[U]*sine + s[V]*cosine);
    rate[PSI] = at(m, m->kinematic[2], s[R]);
    rate[PHI] = at(m, m->kinematic[3], m->has_roll ? s[P] : 0.0);
    rate[DELTA] = rudder_rate(m, step_s);
    if (m->distance[0] >= 0)
        m->value[m->distance[1]] = m->result[m->distance[0]];
}

int model_follows(const model *m, size_t variable)
{
    const int is_distance = m->distance[1] >= 0 && variable == (size_t)m->distance[1];
    return (variable >= RATE && variable < ORDER) || is_distance;
}

int model_set(model *m, size_t variable, double value)
{
    if (variable >= m->variables || model_follows(m, variable))
        return 0;
    m->value[variable] = value;
    if (variable >= (size_t)m->parameters)
        m->unsettled = 1;
    return 1;
}

const char *model_refusal(model *m)
{
    /* Written so that a step that is no number is refused, too. */
    if (!(model_longest(m) > 0.0))
        return "step_s is not above 0";
    for (int k = 0; m->has_gear && k < FIGURES; k++)
        if (!(m->value[m->gear[k]] >= 0.0))
            return "the figures of the steering gear (rudder_limit, rudder_rate, "
                "rudder_time_constant, rudder_dead_band) are not all 0 or above";
    model_rates(m, model_longest(m));
    for (int k = 0; k < STATES; k++)
        if (!isfinite(m->value[RATE + k]))
            return "these parameters, states and inputs give no accelerations: masses, lengths "
                "and densities are above 0, and every value is a number";
    return NULL;
}

static const char *check(const model *m)
{
    const double *s = m->value + STATE;
    for (int k = 0; k < STATES; k++)
        if (!isfinite(s[k]))
            return "the state is no longer a number";
    if (sqrt(s[U]*s[U] + s[V]*s[V]) > m->most_speed)
        return "the speed left the physical range";
    if (fabs(s[R]) > m->most_yaw)
        return "the yaw rate left the physical range";
    return fabs(s[PHI]) > m->most_roll ? "the ship has capsized" : NULL;
}

static void move(model *m, const double *from, const double *rate, double by_s)
{
    for (int k = 0; k < STATES; k++)
        m->value[STATE + k] = from[k] + rate[k]*by_s;
}

/* The classical Runge-Kutta method of fourth order, inputs held. */
static void one_step(model *m, double h)
{
    static const double share[3] = {0.5, 0.5, 1.0}, weight[4] = {1.0, 2.0, 2.0, 1.0};
    double from[STATES], sum[STATES] = {0};
    memcpy(from, m->value + STATE, sizeof from);
    for (int stage = 0; stage < 4; stage++) {
        model_rates(m, h);
        for (int k = 0; k < STATES; k++)
            sum[k] += weight[stage]*m->value[RATE + k];
        if (stage < 3)
            move(m, from, m->value + RATE, share[stage]*h);
    }
    move(m, from, sum, h/6.0);
}

const char *model_step(model *m, double length_s)
{
    const double end = m->value[TIME] + length_s;
    const double count = fmax(1.0, ceil(length_s/model_longest(m) - 1e-9));
    for (double k = 0.0; k < count; k += 1.0) {
        one_step(m, length_s/count);
        const char *why = check(m);
        if (why)
            return why;
    }
    m->value[TIME] = end;
    return NULL;
}
