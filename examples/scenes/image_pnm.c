/// @file image_pnm.c
/// The portable anymap formats, P1 to P6, read strictly.
///
/// SPDX-License-Identifier: MIT
#include "scenes/image_internal.h"
#include "scenes/internal.h"

#include <stdlib.h>
#include <string.h>

typedef struct pnm_reader {
    const uint8_t *at, *end;
    const char *name;
    bool plain;        // samples as text (P1, P2, P3)
    bool bitmap;       // one bit a pixel, 1 is black (P1, P4)
    uint32_t channels; // 1 or 3
    uint32_t width, height, max_value;
} pnm_reader;

static bool is_space(uint8_t c) {
    return c == ' ' || (c >= '\t' && c <= '\r');
}

static void skip_space(pnm_reader *pnm) {
    while (pnm->at < pnm->end && (is_space(*pnm->at) || *pnm->at == '#')) {
        if (*pnm->at == '#')
            while (pnm->at < pnm->end && *pnm->at != '\n')
                pnm->at++;
        else
            pnm->at++;
    }
}

static bool read_number(pnm_reader *pnm, const char *what, uint32_t *value, scene_error *error) {
    skip_space(pnm);
    if (pnm->at == pnm->end)
        return scene_fail(error, "%.200s: the image is cut off: the file ends where %s should be", pnm->name, what);
    text_span digits = {.start = (const char *)pnm->at};
    while (pnm->at < pnm->end && *pnm->at >= '0' && *pnm->at <= '9')
        pnm->at++;
    digits.length = (size_t)((const char *)pnm->at - digits.start);
    uint64_t number = 0;
    if (!number_parse_count(digits, &number) || number > UINT32_MAX)
        return scene_fail(error, "%.200s: %s is not a whole number below 2^32: the image is damaged", pnm->name,
                          what);
    *value = (uint32_t)number;
    return true;
}

// Bytes that the pixels take at the least, so that a short file is refused before memory is taken for them.
static uint64_t least_size(const pnm_reader *pnm) {
    uint64_t pixels = (uint64_t)pnm->width * pnm->height;
    if (pnm->plain)
        return pnm->bitmap ? pixels : 2 * pixels * pnm->channels - 1;
    if (pnm->bitmap)
        return (uint64_t)pnm->height * ((pnm->width + 7) / 8);
    return pixels * pnm->channels * (pnm->max_value > 255 ? 2 : 1);
}

static bool read_header(pnm_reader *pnm, scene_error *error) {
    uint8_t kind = pnm->at[1];
    pnm->at += 2;
    pnm->plain = kind <= '3';
    pnm->bitmap = kind == '1' || kind == '4';
    pnm->channels = kind == '3' || kind == '6' ? 3 : 1;
    pnm->max_value = 1;
    if (!read_number(pnm, "the width", &pnm->width, error) || !read_number(pnm, "the height", &pnm->height, error))
        return false;
    if (!pnm->bitmap && !read_number(pnm, "the largest value", &pnm->max_value, error))
        return false;
    if (pnm->max_value == 0 || pnm->max_value > 65535)
        return scene_fail(error, "%.200s: the largest value is %u: it must be 1 to 65535", pnm->name,
                          pnm->max_value);
    if (!image_check_size(pnm->name, pnm->width, pnm->height, error))
        return false;
    if (!pnm->plain) {
        if (pnm->at == pnm->end || !is_space(*pnm->at))
            return scene_fail(error, "%.200s: no white space between header and pixels: the image is damaged",
                              pnm->name);
        pnm->at++;
    }
    uint64_t left = (uint64_t)(pnm->end - pnm->at);
    if (left < least_size(pnm))
        return scene_fail(
            error, "%.200s: the image is cut off: %llu bytes of pixels, at least %llu needed for %u x %u",
            pnm->name, (unsigned long long)left, (unsigned long long)least_size(pnm), pnm->width, pnm->height);
    return true;
}

// The next sample, 0 to max_value. In the plain bitmap digits need no space between them.
static bool read_sample(pnm_reader *pnm, uint32_t *value, scene_error *error) {
    if (pnm->plain && pnm->bitmap) {
        skip_space(pnm);
        if (pnm->at == pnm->end)
            return scene_fail(error, "%.200s: the image is cut off in the middle of its pixels", pnm->name);
        *value = (uint32_t)(*pnm->at++ - '0');
    } else if (pnm->plain) {
        if (!read_number(pnm, "a pixel", value, error))
            return false;
    } else if (pnm->max_value > 255) {
        *value = (uint32_t)pnm->at[0] << 8 | pnm->at[1];
        pnm->at += 2;
    } else {
        *value = *pnm->at++;
    }
    if (*value > pnm->max_value)
        return scene_fail(error, "%.200s: a pixel's value is above the largest value, %u: the image is damaged",
                          pnm->name, pnm->max_value);
    return true;
}

static uint8_t to_byte(const pnm_reader *pnm, uint32_t value) {
    if (pnm->bitmap)
        return value ? 0 : 255;
    return (uint8_t)((value * 255 + pnm->max_value / 2) / pnm->max_value);
}

static bool read_samples(pnm_reader *pnm, uint8_t *rgba, scene_error *error) {
    size_t pixels = (size_t)pnm->width * pnm->height;
    for (size_t i = 0; i < pixels; i++, rgba += 4) {
        for (uint32_t channel = 0; channel < pnm->channels; channel++) {
            uint32_t value = 0;
            if (!read_sample(pnm, &value, error))
                return false;
            rgba[channel] = to_byte(pnm, value);
        }
        if (pnm->channels == 1)
            rgba[1] = rgba[2] = rgba[0];
        rgba[3] = 255;
    }
    return true;
}

static void read_packed_bits(pnm_reader *pnm, uint8_t *rgba) {
    for (uint32_t row = 0; row < pnm->height; row++) {
        for (uint32_t column = 0; column < pnm->width; column++, rgba += 4) {
            uint32_t bit = pnm->at[column / 8] >> (7 - column % 8) & 1;
            rgba[0] = rgba[1] = rgba[2] = to_byte(pnm, bit);
            rgba[3] = 255;
        }
        pnm->at += (pnm->width + 7) / 8;
    }
}

static bool refuse_rest(pnm_reader *pnm, scene_error *error) {
    while (pnm->at < pnm->end && is_space(*pnm->at))
        pnm->at++;
    if (pnm->at == pnm->end)
        return true;
    return scene_fail(error,
                      "%.200s: %zu bytes follow the last pixel of %u x %u: the header's size is wrong, or there "
                      "is more than one image",
                      pnm->name, (size_t)(pnm->end - pnm->at), pnm->width, pnm->height);
}

bool image_decode_pnm(const uint8_t *bytes, size_t length, const char *name, pixel_image *out, scene_error *error) {
    pnm_reader pnm = {.at = bytes, .end = bytes + length, .name = name};
    if (!read_header(&pnm, error))
        return false;
    uint8_t *rgba = malloc((size_t)pnm.width * pnm.height * 4);
    if (!rgba)
        return scene_fail(error, "%.200s: out of memory for %u x %u pixels", name, pnm.width, pnm.height);
    bool ok = true;
    if (pnm.bitmap && !pnm.plain)
        read_packed_bits(&pnm, rgba);
    else
        ok = read_samples(&pnm, rgba, error);
    if (ok && refuse_rest(&pnm, error)) {
        out->width = pnm.width;
        out->height = pnm.height;
        out->rgba = rgba;
        return true;
    }
    free(rgba);
    return false;
}
