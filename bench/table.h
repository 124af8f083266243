/// @file table.h
/// Rows of results, printed as they come: aligned for people, as CSV, or as Markdown.
///
/// SPDX-License-Identifier: MIT
#ifndef BENCH_TABLE_H
#define BENCH_TABLE_H

typedef enum bench_format { BENCH_ALIGNED, BENCH_CSV, BENCH_MARKDOWN } bench_format;

typedef struct bench_column {
    const char *csv_name; ///< NULL: not in CSV
    const char *title;    ///< NULL: not in tables for people
    int width;            ///< characters; < 0: text, set to the left
} bench_column;

typedef struct bench_cell {
    char text[96];
} bench_cell;

/// A cell, written as printf does.
#if defined(__GNUC__)
__attribute__((format(printf, 1, 2)))
#endif
bench_cell
bench_cell_of(const char *format, ...);

/// Print the names of the columns, or one row of as many cells.
void bench_table_head(bench_format format, const bench_column *columns, int count);
void bench_table_row(bench_format format, const bench_column *columns, int count, const bench_cell *cells);

/// Print a line of explanation above a table; CSV has none.
#if defined(__GNUC__)
__attribute__((format(printf, 2, 3)))
#endif
void bench_table_note(bench_format format, const char *text, ...);

/// Print the library, processor, compiler and baseline.
void bench_table_machine(bench_format format);

/// Print what most tables need to be understood: that, and the clock of the scene.
void bench_table_preamble(bench_format format);

#endif
