/// @file massspring_svg.h
/// A picture of a network: one function, in this header alone. The library does not contain it.
///
///     error |= mspring_svg_write(network, "network.svg");
///
/// Every browser opens the file. Springs are coloured by strain, from blue (shortened) over grey to red (stretched);
/// the scale below goes as far as 995 of 1,000 springs do. Pinned particles are squares, particles without springs are
/// dots, the floor is a brown line. Broken springs are not drawn. The bar has a round number of metres.
///
/// SPDX-License-Identifier: MIT
#ifndef MASSSPRING_SVG_H
#define MASSSPRING_SVG_H

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <massspring/massspring.h>

#if defined(__cplusplus) && defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wold-style-cast" /* it is C, too */
#endif

/// Numbers in the file are hundredths of a pixel: whole ones, so no locale puts commas into them.
#define MSPRING_SVG_UNIT 100.0
#define MSPRING_SVG_WIDTH 1200.0 ///< pixels
#define MSPRING_SVG_MARGIN 40.0  ///< pixels around the network
#define MSPRING_SVG_LEGEND 50.0  ///< pixels below
#define MSPRING_SVG_COLOURS 21

/// A picture that is being written, and what it shows.
typedef struct mspring_svg {
    FILE *file;
    uint32_t particles, springs;
    double *x, *y;                   /* [particles] m */
    uint32_t *kind;                  /* [particles] MSPRING_PARTICLE_FLAGS */
    uint32_t *a, *b, *flags;         /* [springs] */
    float *strain, *sorted;          /* [springs] */
    unsigned char *has_spring;       /* [particles] */
    double left, bottom, right, top; /* m */
    double zoom, width, height;      /* pixels a metre, pixels */
    double limit;                    /* strain at the ends of the scale */
    double line;                     /* width of a spring, pixels */
} mspring_svg;

static inline long mspring_svg_whole(double x) {
    const double down = floor(x + 0.5);
    return (long)down;
}

static inline long mspring_svg_x(const mspring_svg *s, double x) {
    return mspring_svg_whole((MSPRING_SVG_MARGIN + (x - s->left) * s->zoom) * MSPRING_SVG_UNIT);
}

static inline long mspring_svg_y(const mspring_svg *s, double y) {
    return mspring_svg_whole((MSPRING_SVG_MARGIN + (s->top - y) * s->zoom) * MSPRING_SVG_UNIT);
}

static inline long mspring_svg_size(double pixels) {
    return mspring_svg_whole(pixels * MSPRING_SVG_UNIT);
}

static inline int mspring_svg_compare(const void *a, const void *b) {
    const float x = *(const float *)a, y = *(const float *)b;
    return x < y ? -1 : x > y;
}

/* The largest of 1, 2, 5, 10 ... and 0.5, 0.2, 0.1 ... that is at most x > 0, as a mantissa and a power of ten. */
static inline double mspring_svg_round(double x, int *mantissa, int *power) {
    const int exponent = (int)mspring_svg_whole(log10(x) - 0.5 + 1e-9);
    const double unit = pow(10.0, exponent), times = x / unit * (1.0 + 1e-9);
    *mantissa = times >= 5.0 ? 5 : times >= 2.0 ? 2 : 1;
    *power = exponent;
    return *mantissa * unit;
}

/* Such a number as text, without what a locale makes of it. */
static inline void mspring_svg_number(FILE *file, int mantissa, int power) {
    if (power > 8 || power < -8) {
        fprintf(file, "%de%d", mantissa, power);
        return;
    }
    if (power < 0) {
        fputs("0.", file);
        for (int i = -1; i > power; --i)
            fputc('0', file);
    }
    fprintf(file, "%d", mantissa);
    for (int i = 0; i < power; ++i)
        fputc('0', file);
}

static inline int mspring_svg_is_drawn(const mspring_svg *s, uint32_t spring) {
    return s->a[spring] != MSPRING_NONE && !(s->flags[spring] & MSPRING_SPRING_BROKEN);
}

/* Colour of a step of the scale: blue, grey in the middle, red. */
static inline void mspring_svg_colour(FILE *file, int step) {
    static const int ends[2][3] = {{20, 60, 190}, {200, 30, 20}}, middle[3] = {170, 170, 175};
    const int half = MSPRING_SVG_COLOURS / 2, away = step < half ? half - step : step - half;
    const int *end = ends[step > half];
    fprintf(file, "#%02x%02x%02x", (unsigned)(middle[0] + (end[0] - middle[0]) * away / half),
        (unsigned)(middle[1] + (end[1] - middle[1]) * away / half),
        (unsigned)(middle[2] + (end[2] - middle[2]) * away / half));
}

static inline int mspring_svg_step(const mspring_svg *s, uint32_t spring) {
    const double half = (double)(MSPRING_SVG_COLOURS / 2), at = (double)s->strain[spring] / s->limit * half;
    return (int)mspring_svg_whole((at < -half ? -half : at > half ? half : at) + half);
}

static inline mspring_result mspring_svg_read(mspring_svg *s, const mspring_network *network) {
    const size_t particles = (size_t)s->particles + 1, springs = (size_t)s->springs + 1;
    s->x = (double *)malloc(particles * sizeof(double));
    s->y = (double *)malloc(particles * sizeof(double));
    s->kind = (uint32_t *)malloc(particles * sizeof(uint32_t));
    s->has_spring = (unsigned char *)calloc(particles, 1);
    s->a = (uint32_t *)malloc(springs * sizeof(uint32_t));
    s->b = (uint32_t *)malloc(springs * sizeof(uint32_t));
    s->flags = (uint32_t *)malloc(springs * sizeof(uint32_t));
    s->strain = (float *)malloc(springs * sizeof(float));
    s->sorted = (float *)malloc(springs * sizeof(float));
    if (!s->x || !s->y || !s->kind || !s->has_spring || !s->a || !s->b || !s->flags || !s->strain || !s->sorted)
        return MSPRING_ERROR_MEMORY;
    const mspring_column columns[] = {{MSPRING_END_A, 1, s->a}, {MSPRING_END_B, 1, s->b},
        {MSPRING_SPRING_FLAGS, 1, s->flags}, {MSPRING_STRAIN, 1, s->strain}};
    mspring_result result = mspring_network_get_positions(network, NULL, 0, s->particles, s->x, s->y, 1);
    if (result == MSPRING_OK)
        result = mspring_network_get_integers(network, MSPRING_PARTICLE_FLAGS, NULL, 0, s->particles, s->kind, 1);
    if (result == MSPRING_OK)
        result = mspring_network_get_columns(network, NULL, 0, s->springs, columns, 4);
    return result;
}

/* The box around all particles, the scale of strains, and the width of lines. */
static inline void mspring_svg_fit(mspring_svg *s) {
    double total = 0.0, most;
    uint32_t count = 0;
    int mantissa, power;
    s->left = s->bottom = HUGE_VAL;
    s->right = s->top = -HUGE_VAL;
    for (uint32_t p = 0; p < s->particles; ++p) {
        if (s->kind[p] & MSPRING_PARTICLE_REMOVED)
            continue;
        s->left = fmin(s->left, s->x[p]);
        s->right = fmax(s->right, s->x[p]);
        s->bottom = fmin(s->bottom, s->y[p]);
        s->top = fmax(s->top, s->y[p]);
    }
    if (!(s->left <= s->right))
        s->left = s->bottom = s->right = s->top = 0.0;
    for (uint32_t i = 0; i < s->springs; ++i) {
        if (!mspring_svg_is_drawn(s, i))
            continue;
        s->sorted[count++] = fabsf(s->strain[i]);
        s->has_spring[s->a[i]] = s->has_spring[s->b[i]] = 1;
        total += hypot(s->x[s->a[i]] - s->x[s->b[i]], s->y[s->a[i]] - s->y[s->b[i]]);
    }
    qsort(s->sorted, count, sizeof(float), mspring_svg_compare);
    most = count > 0 ? (double)s->sorted[(size_t)(count - 1) * 995 / 1000] : 0.0;
    s->limit = 0.001;
    if (most > 1e-6)
        s->limit = mspring_svg_round(most * (1.0 - 1e-6), &mantissa, &power);
    if (most > s->limit * (1.0 + 1e-6))
        s->limit *= most > s->limit * 2.0 * (1.0 + 1e-6) ? 2.5 : 2.0;
    const double wide = s->right - s->left, high = s->top - s->bottom;
    double room = MSPRING_SVG_WIDTH - 2.0 * MSPRING_SVG_MARGIN;
    const double size = fmax(wide, high);
    s->zoom = size > 0.0 ? room / size : room / 2.0;
    s->width = fmax(wide * s->zoom, 320.0) + 2.0 * MSPRING_SVG_MARGIN;
    s->height = high * s->zoom + 2.0 * MSPRING_SVG_MARGIN + MSPRING_SVG_LEGEND;
    s->left -= 0.5 * ((s->width - 2.0 * MSPRING_SVG_MARGIN) / s->zoom - wide);
    room = count > 0 ? total / count * s->zoom : 10.0;
    s->line = room > 20.0 ? 3.0 : room < 2.0 ? 0.3 : 0.15 * room;
}

/* Height of the floor at x, as far as a picture's height above and below the picture. */
static inline long mspring_svg_height(const mspring_svg *s, const mspring_floor_def *def, double x) {
    const double at = (x - def->heights_x) / def->spacing, last = (double)def->height_count - 1.0;
    const double within = fmin(fmax(at, 0.0), last), part = fmin(floor(within), last - 1.0), share = within - part;
    const float *h = def->heights + (size_t)part;
    const double y = def->heights_y + (double)h[0] + share * ((double)h[1] - (double)h[0]), high = s->height / s->zoom;
    return mspring_svg_y(s, fmin(fmax(y, s->top - 2.0 * high), s->top + high));
}

static inline void mspring_svg_floor(const mspring_svg *s, const mspring_network *network) {
    mspring_floor_def def = mspring_floor_def_default();
    if (mspring_network_get_floor(network, &def) != MSPRING_OK || (def.plane_count == 0 && def.height_count == 0))
        return;
    const double wide = s->width / s->zoom, from = s->left - 0.1 * wide, to = s->left + 1.1 * wide;
    fprintf(s->file, "<path fill='none' stroke='#8a6d4b' stroke-width='%ld' d='", mspring_svg_size(3.0));
    for (uint32_t i = 0; i < def.plane_count; ++i) {
        /* From the point of the plane that is closest to the picture's middle. */
        const double *p = def.planes + 4 * (size_t)i, size = hypot(p[2], p[3]);
        const double tx = p[3] / size, ty = -p[2] / size, cx = 0.5 * (from + to), cy = 0.5 * (s->top + s->bottom);
        const double at = (cx - p[0]) * tx + (cy - p[1]) * ty, x = p[0] + at * tx, y = p[1] + at * ty;
        const double reach = hypot(s->width, s->height) / s->zoom;
        if (hypot(x - cx, y - cy) < reach)
            fprintf(s->file, "M%ld %ldL%ld %ld", mspring_svg_x(s, x - reach * tx), mspring_svg_y(s, y - reach * ty),
                mspring_svg_x(s, x + reach * tx), mspring_svg_y(s, y + reach * ty));
    }
    if (def.height_count > 0) {
        fprintf(s->file, "M%ld %ld", mspring_svg_x(s, from), mspring_svg_height(s, &def, from));
        for (uint32_t i = 0; i < def.height_count; ++i) {
            const double x = def.heights_x + (double)i * def.spacing;
            if (x > from && x < to)
                fprintf(s->file, "L%ld %ld", mspring_svg_x(s, x), mspring_svg_height(s, &def, x));
        }
        fprintf(s->file, "L%ld %ld", mspring_svg_x(s, to), mspring_svg_height(s, &def, to));
    }
    fputs("'/>\n", s->file);
}

/* One path for each colour, those of large strains last. */
static inline void mspring_svg_springs(const mspring_svg *s) {
    const int half = MSPRING_SVG_COLOURS / 2;
    for (int i = 0; i < MSPRING_SVG_COLOURS; ++i) {
        const int step = i % 2 ? half + (i + 1) / 2 : half - i / 2;
        int is_open = 0;
        for (uint32_t spring = 0; spring < s->springs; ++spring) {
            if (!mspring_svg_is_drawn(s, spring) || mspring_svg_step(s, spring) != step)
                continue;
            if (!is_open) {
                fputs("<path fill='none' stroke='", s->file);
                mspring_svg_colour(s->file, step);
                fprintf(s->file, "' stroke-width='%ld' stroke-linecap='round' d='", mspring_svg_size(s->line));
                is_open = 1;
            }
            fprintf(s->file, "M%ld %ldL%ld %ld\n", mspring_svg_x(s, s->x[s->a[spring]]),
                mspring_svg_y(s, s->y[s->a[spring]]), mspring_svg_x(s, s->x[s->b[spring]]),
                mspring_svg_y(s, s->y[s->b[spring]]));
        }
        if (is_open)
            fputs("'/>\n", s->file);
    }
}

static inline void mspring_svg_particles(const mspring_svg *s) {
    const long size = mspring_svg_size(fmin(fmax(2.0 * s->line, 1.0), 6.0));
    for (uint32_t p = 0; p < s->particles; ++p) {
        const int is_pinned = (s->kind[p] & MSPRING_PARTICLE_PINNED) != 0;
        if ((s->has_spring[p] && !is_pinned) || (s->kind[p] & MSPRING_PARTICLE_REMOVED))
            continue;
        const long x = mspring_svg_x(s, s->x[p]), y = mspring_svg_y(s, s->y[p]);
        if (is_pinned)
            fprintf(s->file, "<path fill='#222' d='M%ld %ldh%ldv%ldh-%ldz'/>\n", x - size, y - size, 2 * size, 2 * size,
                2 * size);
        else
            fprintf(s->file, "<circle fill='#456' cx='%ld' cy='%ld' r='%ld'/>\n", x, y, size);
    }
}

/* A bar of so many metres, the scale of strains, and what there is. */
static inline void mspring_svg_legend(const mspring_svg *s) {
    const double y = s->height - MSPRING_SVG_LEGEND + 14.0;
    int mantissa, power;
    const double metres = mspring_svg_round(100.0 / s->zoom, &mantissa, &power);
    fprintf(s->file, "<rect y='%ld' width='100%%' height='100%%' fill='#fff'/>\n",
        mspring_svg_size(s->height - MSPRING_SVG_LEGEND));
    const long left = mspring_svg_size(MSPRING_SVG_MARGIN), base = mspring_svg_size(y + 22.0);
    long at = mspring_svg_size(MSPRING_SVG_MARGIN + 160.0);
    fprintf(s->file, "<path stroke='#222' stroke-width='200' d='M%ld %ldh%ld'/>\n", left, mspring_svg_size(y),
        mspring_svg_size(metres * s->zoom));
    fprintf(s->file, "<g fill='#222' font-family='sans-serif' font-size='1300'><text x='%ld' y='%ld'>", left, base);
    mspring_svg_number(s->file, mantissa, power);
    fputs(" m</text>", s->file);
    for (int i = 0; s->springs > 0 && i < MSPRING_SVG_COLOURS; ++i, at += 800) {
        fprintf(s->file, "<path fill='");
        mspring_svg_colour(s->file, i);
        fprintf(s->file, "' d='M%ld %ldh800v800h-800z'/>", at, mspring_svg_size(y - 4.0));
    }
    if (s->springs > 0) {
        (void)mspring_svg_round(s->limit * 100.0, &mantissa, &power);
        fprintf(s->file, "<text x='%ld' y='%ld'>-", at - 800 * MSPRING_SVG_COLOURS, base);
        mspring_svg_number(s->file, mantissa, power);
        fprintf(s->file, " %%</text><text x='%ld' y='%ld' text-anchor='end'>strain ", at, base);
        mspring_svg_number(s->file, mantissa, power);
        fputs(" %</text>", s->file);
    }
    fputs("</g>\n", s->file);
}

/// Write a picture of a network to a file, which is replaced if it is there.
/// Threads: shared. Allocates: yes, with malloc, and frees it. Errors: ARGUMENT for NULL, or if the file cannot be
/// written (errno says why); MEMORY.
static inline mspring_result mspring_svg_write(const mspring_network *network, const char *path) {
    mspring_svg s;
    mspring_result result = MSPRING_ERROR_ARGUMENT;
    if (!network || !path)
        return result;
    memset(&s, 0, sizeof s);
    s.particles = mspring_network_count(network, MSPRING_PARTICLES);
    s.springs = mspring_network_count(network, MSPRING_SPRINGS);
    result = mspring_svg_read(&s, network);
    if (result == MSPRING_OK && !(s.file = fopen(path, "wb")))
        result = MSPRING_ERROR_ARGUMENT;
    if (result == MSPRING_OK) {
        mspring_svg_fit(&s);
        fprintf(s.file, "<svg xmlns='http://www.w3.org/2000/svg' width='%ld' height='%ld' viewBox='0 0 %ld %ld'>\n",
            (long)s.width, (long)s.height, mspring_svg_size(s.width), mspring_svg_size(s.height));
        fputs("<rect width='100%' height='100%' fill='#fff'/>\n", s.file);
        mspring_svg_floor(&s, network);
        mspring_svg_springs(&s);
        mspring_svg_particles(&s);
        mspring_svg_legend(&s);
        fputs("</svg>\n", s.file);
        const int is_wrong = ferror(s.file);
        if (fclose(s.file) != 0 || is_wrong)
            result = MSPRING_ERROR_ARGUMENT;
    }
    free(s.x);
    free(s.y);
    free(s.kind);
    free(s.has_spring);
    free(s.a);
    free(s.b);
    free(s.flags);
    free(s.strain);
    free(s.sorted);
    return result;
}

#if defined(__cplusplus) && defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

#endif
