// STL: binary and ASCII.
//
// Which of the two cannot be told from the first word: many binary files begin with "solid". A file whose
// length is exactly what its triangle count asks for is binary; else a text with "solid" and "facet" is
// ASCII; else it is a binary file that is cut off, or followed by something. Corners are float32 and welded
// where they are equal.
//
// Limits:  colours and attribute bytes are ignored, stored normals too: the order of the corners decides.
// Checked: tests/test_model.c, fuzz/fuzz_stl.c.
#include "mesh/readers.h"
#include "mesh/text.h"

#include <ctype.h>
#include <math.h>
#include <strings.h>

enum { HEADER_BYTES = 84, RECORD_BYTES = 50 };

static uint32_t little_endian(const char *at)
{
    const uint8_t *b = (const uint8_t *)at;
    return b[0] | (uint32_t)b[1] << 8 | (uint32_t)b[2] << 16 | (uint32_t)b[3] << 24;
}

static uint64_t announced_bytes(const model_file *file)
{
    return HEADER_BYTES + (uint64_t)RECORD_BYTES * little_endian(file->data + 80);
}

bool is_binary_stl(const model_file *file)
{
    return file->size >= HEADER_BYTES && announced_bytes(file) == file->size;
}

// "solid" first and "facet" or "endsolid" soon after, nothing but text up to there.
static bool is_ascii(const model_file *file)
{
    const char *at = file->data, *end = file->data + file->size;
    while (at < end && isspace((unsigned char)*at)) at++;
    if (end - at < 5 || strncasecmp(at, "solid", 5) != 0) return false;
    for (at += 5; at < end && at < file->data + 4096; at++) {
        if (end - at >= 5 && strncasecmp(at, "facet", 5) == 0) return true;
        if (end - at >= 8 && strncasecmp(at, "endsolid", 8) == 0) return true;
        if ((unsigned char)*at < 9) return false;
    }
    return at == end; // a short text: cut off, and the sentence shall say so
}

static bool is_text(const model_file *file)
{
    for (size_t i = 0; i < MIN(file->size, (size_t)512); i++) {
        unsigned char c = (unsigned char)file->data[i];
        if (c < 9 || (c > 13 && c < 32)) return false;
    }
    return true;
}

bool looks_like_stl(const model_file *file)
{
    if (is_ascii(file)) return true;
    if (file->size < HEADER_BYTES || memcmp(file->data, "\x89PNG", 4) == 0) return false;
    return is_binary_stl(file) || !is_text(file);
}

// Triangle soup to mesh: the corners are welded, corner i of triangle t being 3 t + i.
static jali_status weld_soup(jali_context *ctx, const double (*corner)[3], int32_t triangle_count,
                             jali_mesh *mesh)
{
    jali_status status;
    int32_t *first = NULL, distinct, next = 0;
    TRY(ALLOCATE(ctx, first, 3 * (size_t)triangle_count));
    TRY(weld_points(ctx, 3 * triangle_count, corner, first, &distinct));
    TRY(mesh_create(ctx, distinct, triangle_count, mesh));
    for (int32_t i = 0; i < 3 * triangle_count; i++) {
        if (first[i] == i) {
            memcpy(mesh->vertex[next], corner[i], sizeof *corner);
            first[i] = next++; // from here on the new number
        } else {
            first[i] = first[first[i]];
        }
        mesh->triangle[i / 3][i % 3] = first[i];
    }
done:
    release(ctx, first);
    return status;
}

static jali_status check_count(jali_context *ctx, const model_file *file, uint64_t triangles)
{
    if (triangles == 0) return fail(ctx, JALI_BAD_INPUT, "%s holds no triangles", file->name);
    if (triangles > (uint64_t)file->opt.max_triangles)
        return fail(ctx, JALI_LIMIT, "%s has %llu triangles, more than the limit of %d", file->name,
                    (unsigned long long)triangles, file->opt.max_triangles);
    return JALI_OK;
}

static jali_status read_binary(jali_context *ctx, const model_file *file, jali_mesh *mesh)
{
    jali_status status;
    double(*corner)[3] = NULL;
    uint32_t count = little_endian(file->data + 80);
    if (announced_bytes(file) > file->size)
        TRY(fail(ctx, JALI_BAD_INPUT, "%s is cut off, or no STL: %u triangles need %llu bytes, it has %zu",
                 file->name, count, (unsigned long long)announced_bytes(file), file->size));
    TRY(check_count(ctx, file, count));
    TRY(ALLOCATE(ctx, corner, 3 * (size_t)count));
    for (uint32_t t = 0; t < count; t++) {
        const char *record = file->data + HEADER_BYTES + (size_t)t * RECORD_BYTES + 12; // behind the normal
        for (int i = 0; i < 9; i++) {
            uint32_t bits = little_endian(record + 4 * i);
            float value;
            memcpy(&value, &bits, sizeof value);
            if (!isfinite(value))
                TRY(fail(ctx, JALI_BAD_INPUT,
                         "%s: triangle %u of %u has a coordinate that is not a finite number", file->name,
                         t + 1, count));
            corner[3 * (size_t)t + (size_t)i / 3][i % 3] = value;
        }
    }
    TRY(weld_soup(ctx, (const double(*)[3])corner, (int32_t)count, mesh));
done:
    release(ctx, corner);
    return status;
}

static jali_status take_corner(jali_context *ctx, const model_file *file, text *in, double corner[3])
{
    for (int k = 0; k < 3; k++) {
        double value;
        skip_space(in);
        if (!take_number(in, &value) || !isfinite((float)value))
            return fail(ctx, JALI_BAD_INPUT, "%s, line %lld: a vertex needs three finite numbers", file->name,
                        (long long)in->line);
        corner[k] = (float)value;
    }
    return JALI_OK;
}

// Only vertices and the ends of loops matter; the rest of the grammar carries nothing.
static jali_status read_ascii(jali_context *ctx, const model_file *file, jali_mesh *mesh)
{
    jali_status status = JALI_OK;
    double(*corner)[3] = NULL;
    size_t capacity = 0, count = 0;
    int32_t in_loop = 0;
    bool ended = false;
    char word[16];
    text in = {file->data, file->data + file->size, 1};
    while (take_word(&in, word, sizeof word)) {
        if (strcmp(word, "vertex") == 0) {
            TRY(GROW(ctx, corner, capacity, count + 1));
            TRY(take_corner(ctx, file, &in, corner[count++]));
            in_loop++;
            ended = false;
        } else if (strcmp(word, "endloop") == 0) {
            if (in_loop != 3)
                TRY(fail(ctx, JALI_BAD_INPUT, "%s, line %lld: a facet has %d vertices, not 3", file->name,
                         (long long)in.line, in_loop));
            in_loop = 0;
            TRY(check_count(ctx, file, count / 3));
        } else if (strcmp(word, "solid") == 0 || strcmp(word, "endsolid") == 0) {
            ended = word[0] == 'e';
            skip_line(&in); // the name may be any words
        }
    }
    if (in_loop || !ended)
        TRY(fail(ctx, JALI_BAD_INPUT, "%s is cut off at line %lld: no endsolid", file->name,
                 (long long)in.line));
    TRY(check_count(ctx, file, count / 3));
    TRY(weld_soup(ctx, (const double(*)[3])corner, (int32_t)(count / 3), mesh));
done:
    release(ctx, corner);
    return status;
}

jali_status read_stl(jali_context *ctx, const model_file *file, jali_mesh *mesh)
{
    return !is_binary_stl(file) && is_ascii(file) ? read_ascii(ctx, file, mesh)
                                                  : read_binary(ctx, file, mesh);
}
