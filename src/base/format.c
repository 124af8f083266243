#include "base/format.h"

#include <stdbool.h>
#include <stdint.h>
#include <string.h>

typedef struct output {
    char *text;
    size_t size, length;
} output;

static void put(output *to, char letter) {
    if (to->length + 1 < to->size)
        to->text[to->length++] = letter;
}

static void put_text(output *to, const char *text) {
    while (*text)
        put(to, *text++);
}

static void put_integer(output *to, unsigned long long value, unsigned base) {
    char digits[20];
    int count = 0;
    do {
        digits[count++] = "0123456789abcdef"[value % base];
        value /= base;
    } while (value > 0);
    while (count > 0)
        put(to, digits[--count]);
}

/* ---------------------------------------------------------------------------------------------------- decimals */

// The smallest denormal is 5^1074 / 10^1074; with 53 bits in front of it that has 767 digits.
enum { WORDS = 86, WORD_DIGITS = 9, SMALLEST_EXPONENT = -1074, MANTISSA_BITS = 52 };
#define WORD_BASE 1000000000u

/// A natural number in base WORD_BASE, the lowest word first.
typedef struct natural {
    uint32_t words[WORDS];
    int count;
} natural;

static void multiply(natural *n, uint32_t factor) {
    uint64_t carry = 0;
    for (int i = 0; i < n->count; ++i) {
        carry += (uint64_t)n->words[i] * factor;
        n->words[i] = (uint32_t)(carry % WORD_BASE);
        carry /= WORD_BASE;
    }
    for (; carry > 0; carry /= WORD_BASE)
        n->words[n->count++] = (uint32_t)(carry % WORD_BASE);
}

static void multiply_by_power(natural *n, uint32_t factor, int power) {
    for (; power > 0; --power)
        multiply(n, factor);
}

/// Decimal digits without leading zeros: 0.d1 d2 d3 ... times 10^(exponent + 1).
typedef struct decimal {
    char digits[WORDS * WORD_DIGITS];
    int count, exponent;
} decimal;

/// Expand a finite number above 0 to all its decimal digits.
static void expand(decimal *d, uint64_t mantissa, int exponent) {
    natural n = {.words = {(uint32_t)(mantissa % WORD_BASE), (uint32_t)(mantissa / WORD_BASE)}, .count = 2};
    multiply_by_power(&n, 2, exponent);
    multiply_by_power(&n, 5, -exponent); // m / 2^e = m 5^e / 10^e
    d->count = 0;
    for (int i = n.count - 1; i >= 0; --i)
        for (uint32_t unit = WORD_BASE / 10; unit > 0; unit /= 10) {
            const char digit = (char)(n.words[i] / unit % 10);
            if (d->count > 0 || digit > 0)
                d->digits[d->count++] = digit;
        }
    d->exponent = d->count - 1 + (exponent < 0 ? exponent : 0);
}

/// Keep this many significant digits, rounded to nearest, ties to even, and no zeros at the end.
static void shorten(decimal *d, int significant) {
    if (d->count > significant) {
        bool is_above_half = d->digits[significant] > 5;
        for (int i = significant + 1; i < d->count && d->digits[significant] == 5; ++i)
            is_above_half |= d->digits[i] > 0;
        const bool is_tie = d->digits[significant] == 5 && !is_above_half;
        d->count = significant;
        if (is_above_half || (is_tie && d->digits[significant - 1] % 2 == 1)) {
            while (d->count > 0 && d->digits[d->count - 1] == 9)
                --d->count;
            if (d->count == 0) {
                d->digits[d->count++] = 0;
                ++d->exponent;
            }
            ++d->digits[d->count - 1];
        }
    }
    while (d->count > 1 && d->digits[d->count - 1] == 0)
        --d->count;
}

static void put_digits(output *to, const decimal *d, int first, int end) {
    for (int i = first; i < end; ++i)
        put(to, i >= 0 && i < d->count ? (char)('0' + d->digits[i]) : '0');
}

static void put_decimal(output *to, const decimal *d, int significant) {
    const bool is_short = d->exponent >= -4 && d->exponent < significant;
    const int before_point = is_short ? d->exponent + 1 : 1;
    if (before_point > 0)
        put_digits(to, d, 0, before_point);
    else
        put(to, '0');
    if (before_point < d->count) {
        put(to, '.');
        put_digits(to, d, before_point, d->count);
    }
    if (!is_short) {
        put(to, 'e');
        put(to, d->exponent < 0 ? '-' : '+');
        const unsigned exponent = (unsigned)(d->exponent < 0 ? -d->exponent : d->exponent);
        if (exponent < 10)
            put(to, '0');
        put_integer(to, exponent, 10);
    }
}

static void put_number(output *to, double value, int significant) {
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    const int biased = (int)(bits >> MANTISSA_BITS & 0x7ff);
    uint64_t mantissa = bits & (((uint64_t)1 << MANTISSA_BITS) - 1);
    if (biased == 0x7ff && mantissa > 0) {
        put_text(to, "nan");
        return;
    }
    if (bits >> 63)
        put(to, '-');
    if (biased == 0x7ff) {
        put_text(to, "inf");
        return;
    }
    int exponent = SMALLEST_EXPONENT;
    if (biased > 0) {
        mantissa |= (uint64_t)1 << MANTISSA_BITS;
        exponent += biased - 1;
    }
    decimal d = {.count = 1};
    if (mantissa > 0) {
        for (; mantissa % 2 == 0; mantissa /= 2)
            ++exponent;
        expand(&d, mantissa, exponent);
    }
    shorten(&d, significant);
    put_decimal(to, &d, significant);
}

/* ------------------------------------------------------------------------------------------------------ formats */

/// Part of a conversion between % and its letter, and the letter.
typedef struct conversion {
    bool is_alternate, is_size, is_wide;
    int precision; ///< -1 if there is none
    char letter;
} conversion;

/// Read a conversion from behind its %. Return the rest of the format.
static const char *read_conversion(const char *format, conversion *c) {
    *c = (conversion){.precision = -1};
    for (; *format == '#'; ++format)
        c->is_alternate = true;
    if (*format == '.')
        for (++format, c->precision = 0; *format >= '0' && *format <= '9'; ++format)
            c->precision = c->precision * 10 + (*format - '0');
    for (; *format == 'z' || *format == 'l'; ++format)
        *(*format == 'z' ? &c->is_size : &c->is_wide) = true;
    c->letter = *format;
    return *format ? format + 1 : format;
}

void mspringi_format(char *text, size_t size, const char *format, va_list arguments) {
    output to = {.text = text, .size = size};
    while (*format) {
        if (*format != '%') {
            put(&to, *format++);
            continue;
        }
        conversion c;
        format = read_conversion(format + 1, &c);
        if (c.letter == 'u' || c.letter == 'x') {
            const unsigned long long value = c.is_size   ? va_arg(arguments, size_t)
                                             : c.is_wide ? va_arg(arguments, unsigned long long)
                                                         : va_arg(arguments, unsigned);
            if (c.is_alternate && value > 0)
                put_text(&to, "0x");
            put_integer(&to, value, c.letter == 'x' ? 16 : 10);
        } else if (c.letter == 'd') {
            const int value = va_arg(arguments, int);
            if (value < 0)
                put(&to, '-');
            put_integer(&to, value < 0 ? 0u - (unsigned)value : (unsigned)value, 10);
        } else if (c.letter == 'g') {
            put_number(&to, va_arg(arguments, double), c.precision < 0 ? 6 : c.precision);
        } else if (c.letter == 's') {
            put_text(&to, va_arg(arguments, const char *));
        } else {
            put(&to, '%');
        }
    }
    text[to.length] = '\0';
}
