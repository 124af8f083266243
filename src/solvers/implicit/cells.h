/// @file cells.h
/// Cells: regions of the layout, candidates for tiles. They depend neither on broken springs nor on pins.
///
/// A block of rows and columns of a grid, a part of the chains, or a neighbourhood in the irregular part is divided
/// into cells: each is what springs connect there, and either all of it is on paths (paths.h) or nothing.
/// Loose particles lie in none, unless springs may be added; then each block of them is a cell. Cells ignore added
/// springs.
#ifndef MSPRINGI_CELLS_H
#define MSPRINGI_CELLS_H

#include "base/passes.h"
#include "solvers/implicit/paths.h"
#include "store/network.h"

/// A spring between two cells, or between a particle of a cell and one of its pinned ones.
typedef struct mspringi_cell_edge {
    uint32_t slot,
        other_slot;   ///< the end in the later cell, or the free one; the end in the earlier, or the pinned
    uint32_t factors; ///< index of its first factor (implicit.h)
} mspringi_cell_edge;

/// Rows and columns of a cell: a power of two.
#define MSPRINGI_LEAST_TILE_SIZE 8u
#define MSPRINGI_LARGEST_TILE_SIZE 256u

typedef struct mspringi_cells {
    uint32_t count, size;           ///< size: rows and columns of a cell in wide grids
    uint32_t *of_slot;              ///< [slots] MSPRING_NONE: none
    uint32_t *first_slot;           ///< [count + 1] in slots
    uint32_t *slots;                ///< by cell, ascending in each
    uint32_t *first_inner;          ///< [count + 1] in inner
    uint32_t *inner;                ///< springs inside a cell, by cell
    mspringi_cell_edge *cell_edges; ///< springs between cells, sorted by the two
    uint32_t cell_edge_count;
    uint32_t *first_cell_edge; ///< [count + 1] in joints, by the later cell
    uint32_t *first_before;    ///< [count + 1] in before
    uint32_t *before;          ///< by cell, earlier ones in its row of the coarse matrix's factor, ascending
    double cost;               ///< multiply-adds that factoring takes with a tile to a cell
    bool has_rows;             ///< false: that is too much, and before is empty
} mspringi_cells;

/// Most multiply-adds that factoring the coarse matrix may take, a few seconds.
#define MSPRINGI_MOST_COARSE_COST 0x1p34

/// Multiply-adds that three columns of the factor take with this many blocks.
static inline double mspringi_cells_column_cost(double entries) {
    return 13.5 * entries * entries;
}

/// An order in which cells are eliminated, and the columns of the factor.
typedef struct mspringi_cell_elimination {
    uint32_t *order;        ///< [cells] by place
    uint32_t *first_behind; ///< [cells + 1] in behind, by place
    uint32_t *behind;       ///< those that a cell is coupled to when it is eliminated
    size_t capacity;        ///< of behind
    uint32_t done;          ///< cells that are eliminated
    double cost;            ///< as in mspringi_cells
} mspringi_cell_elimination;

/// Intermediate results of a division into cells. While they are ordered, cells have the numbers of before.
typedef struct mspringi_cell_builder {
    const mspring_network *network;
    const mspringi_paths *paths;
    mspringi_memory *memory;
    mspringi_message *message;
    mspringi_cells *cells;
    mspringi_cursor cursor;
    double most_cost;            ///< what an order may cost at most
    bool *is_unused;             ///< [slots] no particle is there, nor was one that has been removed
    uint32_t *first, *neighbour; ///< of the slots of the irregular part, then of cells
    uint32_t *queue, grown;      ///< [grown] slots of the cell that grows
    uint32_t *parent;            ///< [slots] of a slot in the forest of parts of cells
    uint32_t listed;             ///< joints
    mspringi_cell_elimination by_degree, by_sweep;
    uint32_t *couplings;            ///< as neighbour: of a cell, cells that are left, then eliminated ones; behind
                                    ///< them all other arrays of the elimination, but mark and is_absorbed
    uint32_t *left, *eliminated;    ///< [cells] how many
    uint32_t *place;                ///< [cells] in the order; MSPRING_NONE: not eliminated
    uint32_t *mark, stamp;          ///< [cells]
    bool *is_absorbed;              ///< [cells] eliminated, and all that it couples is coupled by a later one, too
    uint32_t *first_of_degree;      ///< [cells] lists of cells by their degree
    uint32_t *next, *previous;      ///< [cells] in these lists
    uint32_t *degree, least_degree; ///< [cells] how many each is coupled to
} mspringi_cell_builder;

/// Divide a network into cells of size x size particles, numbered so that neighbours have near numbers: begin, run
/// until done, then end, on failure too. Rows of the factor are not listed if it costs more than most_cost.
void mspringi_cells_begin(mspringi_cell_builder *cutting, mspringi_cells *cells, const mspring_network *network,
                          const mspringi_paths *paths, uint32_t size, double most_cost, mspringi_memory *memory,
                          mspringi_message *message);
mspring_result mspringi_cells_run(mspringi_cell_builder *cutting, bool *is_done);
void mspringi_cells_end(mspringi_cell_builder *cutting);
extern const mspringi_array_table mspringi_cells_columns;
void mspringi_cells_destroy(mspringi_cells *cells, mspringi_memory *memory);

/// Index of a spring's first factor: lattice, chain and irregular ones lie end to end.
uint32_t mspringi_factors_of_spring_slot(mspringi_spring_slot spring_slot);

/// Number the cells in of_slot so that the factor of their coarse matrix has few entries, and list those. Call in
/// this order. Ranges are of springs, then of cells. @return false: no memory
bool mspringi_cells_begin_order(mspringi_cell_builder *cutting);
void mspringi_cells_count_neighbours(mspringi_cell_builder *cutting, uint32_t first, uint32_t end);
bool mspringi_cells_add_up(mspringi_cell_builder *cutting);
void mspringi_cells_list_neighbours(mspringi_cell_builder *cutting, uint32_t first, uint32_t end);
bool mspringi_cells_sweep(mspringi_cell_builder *cutting);

/* cell_elimination.c */

bool mspringi_cells_begin_elimination(mspringi_cell_builder *cutting);
bool mspringi_cells_eliminate_by_degree(mspringi_cell_builder *cutting, uint32_t first, uint32_t end);
bool mspringi_cells_eliminate_by_sweep(mspringi_cell_builder *cutting, uint32_t first, uint32_t end);
bool mspringi_cells_number(mspringi_cell_builder *cutting);
void mspringi_cells_list_rows(mspringi_cell_builder *cutting, uint32_t first, uint32_t end);

#endif
