/* What a person would write by hand in C for the scenes of scenes.py: the speed the compiled programs are held to. */
#include <math.h>

/* One RK4 step a tick of a mass on a virtual coupler (Fig. 23.4) against a wall; p = K, b, k_w, m, x_w; y = z, z'. */
static void coupler_rates(const double *y, const double *in, const double *p, double *rate)
{
    double coupler = p[0] * (in[0] - y[0]) + p[1] * (in[1] - y[1]);
    double wall = y[0] >= p[4] ? p[2] * (y[0] - p[4]) : 0.0;
    rate[0] = y[1];
    rate[1] = (coupler - wall) / p[3];
}

void coupler(long ticks, double h, const double *in, const double *p, double *force)
{
    double y[2] = {0, 0}, a[2], b[2], c[2], d[2], u[2];
    for (long n = 0; n < ticks; n++, in += 2) {
        force[n] = p[0] * (in[0] - y[0]) + p[1] * (in[1] - y[1]);
        coupler_rates(y, in, p, a);
        for (int i = 0; i < 2; i++) u[i] = y[i] + h / 2 * a[i];
        coupler_rates(u, in, p, b);
        for (int i = 0; i < 2; i++) u[i] = y[i] + h / 2 * b[i];
        coupler_rates(u, in, p, c);
        for (int i = 0; i < 2; i++) u[i] = y[i] + h * c[i];
        coupler_rates(u, in, p, d);
        for (int i = 0; i < 2; i++) y[i] += h / 6 * (a[i] + 2 * (b[i] + c[i]) + d[i]);
    }
}

/* The same, and a ball of mass p[3] that bounces on the handle, in four RK4 steps a tick; p = B, K, g, m; y = z, z'. */
static void ball_rates(const double *y, const double *in, const double *p, double *rate)
{
    double gap = y[0] - in[0], force = gap <= 0 ? -p[1] * gap - p[0] * (y[1] - in[1]) : 0.0;
    rate[0] = y[1];
    rate[1] = (force > 0 ? force : 0.0) / p[3] - p[2];
}

static inline __attribute__((always_inline)) void rk4(void (*rates)(const double *, const double *, const double *, double *),
                                                      double *y, const double *in, const double *p, double h)
{
    double a[2], b[2], c[2], d[2], u[2];
    rates(y, in, p, a);
    for (int i = 0; i < 2; i++) u[i] = y[i] + h / 2 * a[i];
    rates(u, in, p, b);
    for (int i = 0; i < 2; i++) u[i] = y[i] + h / 2 * b[i];
    rates(u, in, p, c);
    for (int i = 0; i < 2; i++) u[i] = y[i] + h * c[i];
    rates(u, in, p, d);
    for (int i = 0; i < 2; i++) y[i] += h / 6 * (a[i] + 2 * (b[i] + c[i]) + d[i]);
}

void coupler_x4(long ticks, double T, const double *in, const double *p, double *force)
{
    double y[2] = {0, 0};
    for (long n = 0; n < ticks; n++, in += 2) {
        force[n] = p[0] * (in[0] - y[0]) + p[1] * (in[1] - y[1]);
        for (int k = 0; k < 4; k++) rk4(coupler_rates, y, in, p, T / 4);
    }
}

void ball_x4(long ticks, double T, const double *in, const double *p, double *force)
{
    double y[2] = {0.05, 0};
    for (long n = 0; n < ticks; n++, in += 2) {
        double gap = y[0] - in[0], push = -p[1] * gap - p[0] * (y[1] - in[1]);
        force[n] = gap <= 0 && push > 0 ? push : 0.0;
        for (int k = 0; k < 4; k++) rk4(ball_rates, y, in, p, T / 4);
    }
}

/* Eight links in absolute angles, M(q) q'' = f solved by LDL^T; p = K, g, l, m, r; the handle twists the first link. */
enum { LINKS = 8 };

static void pendulum_rates(const double *y, double x, const double *p, double *rate)
{
    const double *q = y, *w = y + LINKS;
    double g = p[1], l = p[2], m = p[3], M[LINKS][LINKS], D[LINKS], s[LINKS], c[LINKS];
    double *f = rate + LINKS;
    for (int i = 0; i < LINKS; i++) {
        s[i] = sin(q[i]);
        c[i] = cos(q[i]);
        rate[i] = w[i];
        f[i] = -m * g * l * (LINKS - i) * s[i];
    }
    f[0] += p[0] * (x / p[4] - q[0]);
    for (int i = 0; i < LINKS; i++) {
        M[i][i] = m * l * l * (LINKS - i);
        for (int j = 0; j < i; j++) {
            double mass = m * l * l * (LINKS - i), twist = mass * (s[i] * c[j] - c[i] * s[j]);
            M[i][j] = mass * (c[i] * c[j] + s[i] * s[j]);
            f[i] -= twist * w[j] * w[j];
            f[j] += twist * w[i] * w[i];
        }
    }
    for (int j = 0; j < LINKS; j++) {
        double scaled[LINKS];
        D[j] = M[j][j];
        for (int k = 0; k < j; k++) {
            scaled[k] = M[j][k] * D[k];
            D[j] -= M[j][k] * scaled[k];
        }
        for (int i = j + 1; i < LINKS; i++) {
            double sum = M[i][j];
            for (int k = 0; k < j; k++) sum -= M[i][k] * scaled[k];
            M[i][j] = sum / D[j];
        }
    }
    for (int i = 0; i < LINKS; i++)
        for (int k = 0; k < i; k++) f[i] -= M[i][k] * f[k];
    for (int i = 0; i < LINKS; i++) f[i] /= D[i];
    for (int i = LINKS - 1; i >= 0; i--)
        for (int k = i + 1; k < LINKS; k++) f[i] -= M[k][i] * f[k];
}

void pendulum(long ticks, double h, const double *x, const double *p, double *force)
{
    enum { SIZE = 2 * LINKS };
    double y[SIZE] = {0}, a[SIZE], b[SIZE], c[SIZE], d[SIZE], u[SIZE];
    for (long n = 0; n < ticks; n++) {
        force[n] = p[0] * (x[n] / p[4] - y[0]) / p[4];
        pendulum_rates(y, x[n], p, a);
        for (int i = 0; i < SIZE; i++) u[i] = y[i] + h / 2 * a[i];
        pendulum_rates(u, x[n], p, b);
        for (int i = 0; i < SIZE; i++) u[i] = y[i] + h / 2 * b[i];
        pendulum_rates(u, x[n], p, c);
        for (int i = 0; i < SIZE; i++) u[i] = y[i] + h * c[i];
        pendulum_rates(u, x[n], p, d);
        for (int i = 0; i < SIZE; i++) y[i] += h / 6 * (a[i] + 2 * (b[i] + c[i]) + d[i]);
    }
}

/* The wall on a simulated paddle over many stiffnesses, and the largest force of each: the force in float32, as on a
   board, the paddle in float64 by its exact matrix phi (x, v from x, v, u). Two vectors hide the latency of one. */
typedef double v8d __attribute__((vector_size(64)));
typedef long long v8i __attribute__((vector_size(64)));
typedef float v8f __attribute__((vector_size(32)));
typedef int v8w __attribute__((vector_size(32)));
enum { WIDTH = 8, PAIR = 2 };

static inline v8f force_of(v8f x, v8f k)
{
    v8f zero = {0};
    return (v8f)((x >= zero) & (v8w)(k * x));
}

static inline v8d floor_of(v8d a)
{
    v8d r = a;
    for (int i = 0; i < WIDTH; i++) r[i] = __builtin_floor(a[i]);
    return r;
}

/* counts: per metre, or 0 for a perfect sensor */
static inline __attribute__((always_inline)) void sweep(long ticks, long lanes, const double *k, const double *phi, double push,
                                                        double counts, double v0, double *peak)
{
    float metres = counts > 0 ? (float)(1 / counts) : 0;
    for (long lane = 0; lane < lanes; lane += WIDTH * PAIR) {
        v8d x[PAIR], v[PAIR], top[PAIR];
        v8f stiffness[PAIR];
        for (int j = 0; j < PAIR; j++) {
            for (int i = 0; i < WIDTH; i++) stiffness[j][i] = (float)k[lane + j * WIDTH + i];
            x[j] = (v8d){0};
            v[j] = (v8d){0} + v0;
            top[j] = (v8d){0};
        }
        for (long n = 0; n < ticks; n++) {
            for (int j = 0; j < PAIR; j++) {
                v8f seen = counts > 0 ? __builtin_convertvector(floor_of(x[j] * counts), v8f) * metres
                                      : __builtin_convertvector(x[j], v8f);
                v8d F = __builtin_convertvector(force_of(seen, stiffness[j]), v8d), u = push - F;
                v8i more = F > top[j];
                v8d next = phi[0] * x[j] + phi[1] * v[j] + phi[2] * u;
                v[j] = phi[3] * x[j] + phi[4] * v[j] + phi[5] * u;
                x[j] = next;
                top[j] = (v8d)((more & (v8i)F) | (~more & (v8i)top[j]));
            }
        }
        for (int j = 0; j < PAIR; j++)
            for (int i = 0; i < WIDTH; i++) peak[lane + j * WIDTH + i] = top[j][i];
    }
}

void wall_lanes(long ticks, long lanes, const double *k, const double *phi, double v0, double *peak)
{
    sweep(ticks, lanes, k, phi, 0, 0, v0, peak);
}

void hand_lanes(long ticks, long lanes, const double *k, const double *phi, double push, double counts, double v0, double *peak)
{
    sweep(ticks, lanes, k, phi, push, counts, v0, peak);
}
