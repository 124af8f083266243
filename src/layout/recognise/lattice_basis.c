/// Lattice bases.
#include "layout/recognise/lattice_basis.h"

#include <math.h>

/// Largest distance of a neighbour from its cell's centre, in cells.
#define CELL_TOLERANCE 0.3f

/// Weight of the mean of the neighbours' bases, in neighbours.
#define MEAN_WEIGHT 4.0f

/// Smallest sine of the angle between basis vectors.
#define MIN_SINE 0.8f

static mspringi_grid_step scaled(mspringi_grid_step a, float by) {
    return (mspringi_grid_step){a.x * by, a.y * by};
}

static mspringi_grid_step sum(mspringi_grid_step a, mspringi_grid_step b) {
    return (mspringi_grid_step){a.x + b.x, a.y + b.y};
}

float mspringi_square_length(mspringi_grid_step step) {
    return step.x * step.x + step.y * step.y;
}

static float cross(mspringi_grid_step a, mspringi_grid_step b) {
    return a.x * b.y - a.y * b.x;
}

mspringi_lattice_basis mspringi_lattice_basis_aligned(float spacing) {
    return (mspringi_lattice_basis){{spacing, 0.0f}, {0.0f, spacing}};
}

mspringi_lattice_basis mspringi_lattice_basis_of(mspringi_grid_step a, mspringi_grid_step b) {
    const bool is_in_order = fabsf(a.x) * fabsf(b.y) >= fabsf(a.y) * fabsf(b.x);
    const mspringi_grid_step column = is_in_order ? a : b, row = is_in_order ? b : a;
    return (mspringi_lattice_basis){scaled(column, column.x < 0.0f ? -1.0f : 1.0f),
                                    scaled(row, row.y < 0.0f ? -1.0f : 1.0f)};
}

bool mspringi_lattice_basis_is_spanned(mspringi_grid_step column, mspringi_grid_step row) {
    const float area = cross(column, row),
                longest = sqrtf(mspringi_square_length(column)) * sqrtf(mspringi_square_length(row));
    return fabsf(area) >= MIN_SINE * longest && longest > 0.0f;
}

static bool round_to_cell(float offset, int32_t *cell) {
    *cell = offset > 0.5f ? 1 : offset < -0.5f ? -1 : 0;
    return fabsf(offset - (float)*cell) <= CELL_TOLERANCE;
}

bool mspringi_lattice_basis_round(mspringi_lattice_basis basis, mspringi_grid_step vector, int32_t *columns,
                                  int32_t *rows) {
    const float area = cross(basis.column, basis.row);
    return round_to_cell(cross(vector, basis.row) / area, columns) &&
           round_to_cell(cross(basis.column, vector) / area, rows);
}

void mspringi_basis_fit_add(mspringi_basis_fit *fit, mspringi_lattice_basis basis, mspringi_grid_step vector,
                            int32_t columns, int32_t rows) {
    fit->bases.column = sum(fit->bases.column, basis.column);
    fit->bases.row = sum(fit->bases.row, basis.row);
    fit->vectors.column = sum(fit->vectors.column, scaled(vector, (float)columns));
    fit->vectors.row = sum(fit->vectors.row, scaled(vector, (float)rows));
    fit->columns += (float)(columns * columns);
    fit->rows += (float)(rows * rows);
    fit->both_counts += (float)(columns * rows);
    fit->count++;
}

// Minimise the squares of columns * column + rows * row - way, and of the difference from the mean basis.
mspringi_lattice_basis mspringi_basis_fit_result(const mspringi_basis_fit *fit) {
    const float share = 1.0f / (float)fit->count;
    const mspringi_lattice_basis mean = {scaled(fit->bases.column, share), scaled(fit->bases.row, share)};
    const float columns = fit->columns + MEAN_WEIGHT, rows = fit->rows + MEAN_WEIGHT, both = fit->both_counts;
    const float per = 1.0f / (columns * rows - both * both);
    const mspringi_grid_step of_column = sum(fit->vectors.column, scaled(mean.column, MEAN_WEIGHT));
    const mspringi_grid_step of_row = sum(fit->vectors.row, scaled(mean.row, MEAN_WEIGHT));
    const mspringi_lattice_basis best = {scaled(sum(scaled(of_column, rows), scaled(of_row, -both)), per),
                                         scaled(sum(scaled(of_row, columns), scaled(of_column, -both)), per)};
    return mspringi_lattice_basis_is_spanned(best.column, best.row) ? best : mean;
}
