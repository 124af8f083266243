/// @file cells.h
/// Cells: regions of the layout, candidates for tiles. They depend neither on broken springs nor on pins.
///
/// A cell is a block of rows and columns of a grid, a part of the chains, or a neighbourhood in the irregular part.
/// Loose particles lie in none, unless springs may be added; then each block of them is a cell. Cells ignore added
/// springs.
#ifndef MSPRINGI_CELLS_H
#define MSPRINGI_CELLS_H

#include "base/passes.h"
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
    uint32_t *lowest;          ///< [count] lowest of a cell and its neighbours
} mspringi_cells;

/// Intermediate results of a division into cells.
typedef struct mspringi_cell_builder {
    const mspring_network *network;
    mspringi_memory *memory;
    mspringi_message *message;
    mspringi_cells *cells;
    mspringi_cursor cursor;
    bool *is_unused;             ///< [slots] no particle is there, nor was one that has been removed
    uint32_t *first, *neighbour; ///< of the slots of the irregular part, then of cells
    uint32_t *queue, grown;      ///< [grown] slots of the cell that grows
    uint32_t listed;             ///< joints
} mspringi_cell_builder;

/// Divide a network into cells of size x size particles, numbered so that neighbours have near numbers: begin, run
/// until done, then end, on failure too.
void mspringi_cells_begin(mspringi_cell_builder *cutting, mspringi_cells *cells, const mspring_network *network,
                          uint32_t size, mspringi_memory *memory, mspringi_message *message);
mspring_result mspringi_cells_run(mspringi_cell_builder *cutting, bool *is_done);
void mspringi_cells_end(mspringi_cell_builder *cutting);
extern const mspringi_array_table mspringi_cells_columns;
void mspringi_cells_destroy(mspringi_cells *cells, mspringi_memory *memory);

/// Index of a spring's first factor: lattice, chain and irregular ones lie end to end.
uint32_t mspringi_factors_of_spring_slot(mspringi_spring_slot spring_slot);

/// Number the cells in of_slot so that neighbours get near numbers (Cuthill and McKee 1969). Call in this order.
/// Ranges are of springs. @return false: no memory
bool mspringi_cells_begin_order(mspringi_cell_builder *cutting);
void mspringi_cells_count_neighbours(mspringi_cell_builder *cutting, uint32_t first, uint32_t end);
bool mspringi_cells_add_up(mspringi_cell_builder *cutting);
void mspringi_cells_list_neighbours(mspringi_cell_builder *cutting, uint32_t first, uint32_t end);
bool mspringi_cells_order(mspringi_cell_builder *cutting);

#endif
