/// @file figure_svg.c
/// A figure as SVG.
///
/// SPDX-License-Identifier: MIT
#include "draw/internal.h"

// Half the pixel size of text is what browsers give its capitals a little less than.
static const double font_size_of_height = 1.38;

// On dark pages light and dark change places, and hues stay what they are. Viewers that know no filters show a
// light picture, which can be read there too.
static const char *const dark_style =
    "<style>@media(prefers-color-scheme:dark){g{filter:invert(.95)hue-rotate(180deg)}}</style>\n";

// One path for a run of lines of the same colour and width: networks have hundreds of thousands of lines.
static size_t write_lines(FILE *stream, const figure *source, size_t first) {
    const figure_item *start = &source->items[first];
    fprintf(stream, "<path stroke=\"#%06x\" stroke-width=\"%.3g\" d=\"", (unsigned)start->colour, start->size);
    float x = 0;
    float y = 0;
    size_t i = first;
    for (; i < source->item_count; i++) {
        const figure_item *item = &source->items[i];
        if (item->kind != FIGURE_LINE || item->colour != start->colour || item->size != start->size)
            break;
        if (i == first || item->x != x || item->y != y)
            fprintf(stream, "M%.2f %.2f", item->x, item->y);
        fprintf(stream, "L%.2f %.2f", item->x2, item->y2);
        x = item->x2;
        y = item->y2;
    }
    fprintf(stream, "\"/>\n");
    return i;
}

static void write_text(FILE *stream, const figure_item *item, const char *text) {
    static const char *const anchors[] = {
        [FIGURE_LEFT] = "start", [FIGURE_CENTRE] = "middle", [FIGURE_RIGHT] = "end"};
    fprintf(stream, "<text x=\"%.2f\" y=\"%.2f\" font-size=\"%.3g\" text-anchor=\"%s\" fill=\"#%06x\">", item->x,
            item->y, item->size * font_size_of_height, anchors[item->align], (unsigned)item->colour);
    for (; *text; text++) {
        switch (*text) {
        case '<':
            fputs("&lt;", stream);
            break;
        case '>':
            fputs("&gt;", stream);
            break;
        case '&':
            fputs("&amp;", stream);
            break;
        default:
            fputc(*text, stream);
        }
    }
    fputs("</text>\n", stream);
}

static size_t write_item(FILE *stream, const figure *source, size_t index) {
    const figure_item *item = &source->items[index];
    switch (item->kind) {
    case FIGURE_LINE:
        return write_lines(stream, source, index);
    case FIGURE_DISC:
        fprintf(stream, "<circle cx=\"%.2f\" cy=\"%.2f\" r=\"%.3g\" fill=\"#%06x\"/>\n", item->x, item->y,
                item->size, (unsigned)item->colour);
        break;
    case FIGURE_RECTANGLE:
        fprintf(stream, "<rect x=\"%.6g\" y=\"%.6g\" width=\"%.6g\" height=\"%.6g\" fill=\"#%06x\"/>\n", item->x,
                item->y, item->x2, item->y2, (unsigned)item->colour);
        break;
    case FIGURE_TEXT:
        write_text(stream, item, source->characters + item->text);
        break;
    }
    return index + 1;
}

bool figure_write_svg(const figure *source, const char *path, draw_error *error) {
    if (source->out_of_memory)
        return draw_fail(error, "out of memory for the picture %.200s", path);
    FILE *stream = draw_open(path, error);
    if (!stream)
        return false;
    fprintf(stream,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%u\" height=\"%u\" viewBox=\"0 0 %u %u\" "
            "font-family=\"Helvetica, Arial, sans-serif\">\n"
            "%s<g fill=\"none\" stroke-linecap=\"round\">\n"
            "<rect width=\"%u\" height=\"%u\" fill=\"#%06x\"/>\n",
            source->width, source->height, source->width, source->height, dark_style, source->width, source->height,
            (unsigned)source->background);
    for (size_t i = 0; i < source->item_count;)
        i = write_item(stream, source, i);
    fputs("</g>\n</svg>\n", stream);
    return draw_close(stream, path, error);
}
