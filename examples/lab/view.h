/// @file view.h
/// The model as a picture.
///
/// SPDX-License-Identifier: MIT
#ifndef LAB_VIEW_H
#define LAB_VIEW_H

#include "lab/layout.h"
#include "lab/text.h"

/// What the mouse is about to do: shown over the networks.
typedef enum pointer_kind { POINTER_NONE, POINTER_CIRCLE, POINTER_CUT } pointer_kind;
typedef struct lab_pointer {
    pointer_kind kind;
    double x, y, x2, y2, radius; ///< world coordinates; of a cut, its ends
    lab_colour colour;
    bool hovers;    ///< no button is down:
    int at_x, at_y; ///< what lies under this pixel is explained
} lab_pointer;

/// What frames take.
typedef struct lab_costs {
    double frame;      ///< seconds from its beginning to its end, without waiting
    double steps;      ///< of these until both sides have stepped; the rest is drawing
    double per_second; ///< frames
} lab_costs;

/// How the world lies in a view.
typedef struct lab_camera {
    double scale;            ///< pixels per metre
    double x, y;             ///< world coordinates of the view's middle
    double pixel_x, pixel_y; ///< and its pixel
} lab_camera;

/// What is kept for drawing a side.
typedef struct view_side {
    float *x, *y;         ///< [particles] pixels
    uint8_t *tint;        ///< [particles] place in the colours
    float *extreme;       ///< [particles] of the springs' values the one with the largest absolute value
    uint32_t *number;     ///< [particles] component, or row of the plan
    const void *numbered; ///< the network that number holds the rows of, or NULL
    lab_layer layer;
    // What lies behind the network, as long as the camera stands still.
    uint32_t *behind; ///< [height][width] of its box
    size_t behind_capacity;
    lab_box behind_box;
    double behind_camera[3];
    const void *behind_network;
} view_side;

typedef struct lab_view {
    lab_raster target;
    lab_layout layout;
    lab_font small, normal, large;
    view_side sides[2];
    uint32_t capacity; ///< particles that the sides have room for
    double limit[2];   ///< of strain and force, the ends of the colours
    double bent_limit; ///< of plastic strain
    double speed_limit;
    double min_x, min_y, max_x, max_y; ///< what a camera that sees everything has seen so far
    const void *seen;                  ///< of which network
    lab_box filled[4];                 ///< parts between which the window has been filled
    bool shows_costs;                  ///< figures that differ from run to run
} lab_view;

bool view_make(lab_view *made, int width, int height);
void view_free(lab_view *unwanted);
bool view_resize(lab_view *view, int width, int height);

/// Before the sides are drawn: where all is. Returns false when out of memory.
bool view_begin(lab_view *view, const lab_model *model);
/// Draw one side; different sides may be drawn at the same time.
void view_draw_side(lab_view *view, const lab_model *model, int side);
/// Draw the rest.
void view_end(lab_view *view, const lab_model *model, const lab_pointer *pointer, const lab_costs *costs);

lab_camera view_camera(const lab_view *view, const lab_model *model, int side);
void camera_to_world(const lab_camera *camera, double pixel_x, double pixel_y, double *x, double *y);
void camera_to_pixel(const lab_camera *camera, double x, double y, double *pixel_x, double *pixel_y);

/* view_network.c, view_panel.c, view_plots.c, view_tip.c, view_help.c */

void view_draw_network(lab_view *view, const lab_model *model, int side);
void view_draw_panel(lab_view *view, const lab_model *model);
void view_draw_plots(lab_view *view, const lab_model *model);
/// What the plot under a pixel shows there; false if there is none.
bool view_describe_plot(lab_view *view, const lab_model *model, int x, int y, char *text, size_t size);
/// What a control does, and its key.
const char *view_hint(const lab_control *control);
/// What the spring that was clicked bears.
void view_draw_spring(lab_view *view, const lab_model *model, int side, const lab_camera *camera);
/// What lies under the mouse.
void view_draw_hover(lab_view *view, const lab_model *model, const lab_pointer *pointer);
void view_draw_help(lab_view *view);

/// A number as people write it: three digits, and k, M, G.
const char *view_number(double value, char buffer[32]);

#endif
