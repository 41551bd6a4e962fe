static @_state moved(const @_state *s, const @_state *rate, double by_s)
{
    @_state out;
    out.u = s->u + rate->u*by_s;
    out.v = s->v + rate->v*by_s;
    out.r = s->r + rate->r*by_s;
    out.p = s->p + rate->p*by_s;
    out.phi = s->phi + rate->phi*by_s;
    out.psi = s->psi + rate->psi*by_s;
    out.x = s->x + rate->x*by_s;
    out.y = s->y + rate->y*by_s;
    out.delta = s->delta + rate->delta*by_s;
    return out;
}

/* 0 where the simulation is believed, 1 where the state is no longer a number, 2 for too high a
 * speed, 3 for too high a yaw rate, 4 for a ship that has capsized. */
int @_check(const @_state *s)
{
    const double speed = hypot(s->u, s->v);
    if (!isfinite(speed + s->r + s->p + s->phi + s->psi + s->x + s->y + s->delta))
        return 1;
    if (speed > @@speed)
        return 2;
    if (fabs(s->r) > @@yaw)
        return 3;
    return fabs(s->phi) > @@roll ? 4 : 0;
}

/* One step of the classical Runge-Kutta method of fourth order, inputs held; answers as check. */
int @_step(@_state *s, const @_inputs *in, const @_coefficients *c, double step_s)
{
    @_state k1, k2, k3, k4, at, sum;
    @_rates(s, in, c, step_s, &k1);
    at = moved(s, &k1, 0.5*step_s);
    @_rates(&at, in, c, step_s, &k2);
    at = moved(s, &k2, 0.5*step_s);
    @_rates(&at, in, c, step_s, &k3);
    at = moved(s, &k3, step_s);
    @_rates(&at, in, c, step_s, &k4);
    sum = moved(&k1, &k2, 2.0);
    sum = moved(&sum, &k3, 2.0);
    sum = moved(&sum, &k4, 1.0);
    *s = moved(s, &sum, step_s/6.0);
    return @_check(s);
}

#ifdef SISTERSHIP_EXAMPLE
/* A turning circle as CSV:
 *   cc -DSISTERSHIP_EXAMPLE -O2 FILE.c -lm && ./a.out [RUDDER_DEG [DURATION_S [STEP_S]]] */
#include <stdio.h>
#include <stdlib.h>

int main(int argc, char **argv)
{
    const double rudder_deg = argc > 1 ? atof(argv[1]) : 35.0;
    const double duration_s = argc > 2 ? atof(argv[2]) : @@duration;
    const double step_s = argc > 3 ? atof(argv[3]) : @@step;
    const long steps = lround(duration_s/step_s);
    @_state s = @_approach_state();
    @_inputs in = @_approach_inputs();
    @@order
    printf("t_s,u_m_s,v_m_s,r_rad_s,p_rad_s,phi_rad,psi_rad,x_m,y_m,delta_rad\n");
    for (long k = 0; k <= steps; k++) {
        printf("%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g\n", (double)k*step_s,
            s.u, s.v, s.r, s.p, s.phi, s.psi, s.x, s.y, s.delta);
        if (@_step(&s, &in, &@_values, step_s) != 0)
            return 1;
    }
    return 0;
}
#endif
