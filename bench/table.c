/// @file table.c
/// Printing tables.
///
/// SPDX-License-Identifier: MIT
#include "table.h"

#include <massspring/massspring.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>

#include "machine.h"
#include "network.h"

bench_cell bench_cell_of(const char *format, ...) {
    bench_cell cell;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(cell.text, sizeof cell.text, format, arguments);
    va_end(arguments);
    return cell;
}

static void print_cell(bench_format format, const bench_column *column, const char *text, bool first, bool last) {
    if (format == BENCH_CSV) {
        printf("%s%s", first ? "" : ",", text);
    } else if (format == BENCH_MARKDOWN) {
        printf("%s %s |", first ? "|" : "", text);
    } else if (column->width < 0 && last) {
        printf("%s%s", first ? "" : "  ", text);
    } else if (column->width < 0) {
        printf("%s%-*s", first ? "" : "  ", -column->width, text);
    } else {
        printf("%s%*s", first ? "" : "  ", column->width, text);
    }
}

static const char *heading(bench_format format, const bench_column *column) {
    return format == BENCH_CSV ? column->csv_name : column->title;
}

void bench_table_head(bench_format format, const bench_column *columns, int count) {
    bool first = true;
    for (int i = 0; i < count; i++) {
        if (heading(format, &columns[i]) != NULL) {
            print_cell(format, &columns[i], heading(format, &columns[i]), first, i == count - 1);
            first = false;
        }
    }
    putchar('\n');
    if (format == BENCH_MARKDOWN) {
        for (int i = 0; i < count; i++) {
            if (columns[i].title != NULL) {
                printf("%s", columns[i].width < 0 ? "|:---" : "|---:");
            }
        }
        puts("|");
    }
    fflush(stdout);
}

void bench_table_row(bench_format format, const bench_column *columns, int count, const bench_cell *cells) {
    bool first = true;
    for (int i = 0; i < count; i++) {
        if (heading(format, &columns[i]) != NULL) {
            print_cell(format, &columns[i], cells[i].text, first, i == count - 1);
            first = false;
        }
    }
    putchar('\n');
    fflush(stdout);
}

void bench_table_note(bench_format format, const char *text, ...) {
    if (format == BENCH_CSV) {
        return;
    }
    va_list arguments;
    va_start(arguments, text);
    if (format == BENCH_MARKDOWN) {
        fputs("- ", stdout);
    }
    vprintf(text, arguments);
    putchar('\n');
    va_end(arguments);
}

void bench_table_machine(bench_format format) {
    char cpu[128];
    bench_table_note(format, "massspring %s on %s", mspring_version_string(), bench_cpu_name(cpu, sizeof cpu));
    bench_table_note(format, "bench built by %s; baseline compiled with %s", bench_compiler(), BENCH_NAIVE_FLAGS);
}

void bench_table_preamble(bench_format format) {
    bench_table_machine(format);
    bench_table_note(format, "a step is %g s; times are wall time", BENCH_DT);
    if (format != BENCH_CSV) {
        putchar('\n');
    }
}
