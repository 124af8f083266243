/// @file panels.h
/// Panels: consecutive whole rows of one kind, which one worker assembles and multiplies.
///
/// Panels depend on the layout alone, so a sum over panels is the same for any number of workers.
#ifndef MSPRINGI_PANELS_H
#define MSPRINGI_PANELS_H

#include "store/network.h"

typedef struct mspringi_panel {
    uint32_t first_span, span_count;
    uint32_t below_first, below_count; ///< spans of the row before, if it carries into this one; else none
    bool is_lattice;                   ///< else chain
} mspringi_panel;

typedef struct mspringi_panels {
    mspringi_panel *list; ///< lattice and chain rows, in their order
    uint32_t count;
    float *sums; ///< [count] of each panel
} mspringi_panels;

mspring_result mspringi_panels_create(mspringi_panels *panels, const mspringi_topology *topology,
                                      mspringi_memory *memory, mspringi_message *message);
extern const mspringi_array_table mspringi_panels_columns;
void mspringi_panels_destroy(mspringi_panels *panels, mspringi_memory *memory);

#endif
