// Wavefront OBJ: vertices, texture points, faces.
//
// Limits:  curves, groups, materials and normals are passed over; a face names vertices that stand above it.
// Checked: tests/test_readers.c, fuzz/fuzz_obj.c.
#include "mesh/gather.h"
#include "mesh/text.h"

#include <strings.h>

// Is the first word that is no comment one that an OBJ begins with, and something behind it?
bool looks_like_obj(const model_file *file)
{
    static const char *const words[] = {"v", "vt", "vn", "f", "o", "g", "s", "mtllib", "usemtl"};
    text in = {file->data, file->data + file->size, 1};
    char word[16];
    skip_space(&in);
    if (in.at < in.end && *in.at == '#' && !next_line(&in))
        return true; // only comments: it holds no triangles
    if (!take_word(&in, word, sizeof word)) return false;
    skip_blanks(&in);
    if (in.at == in.end || (unsigned char)*in.at < 32) return false;
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        if (strcmp(word, words[i]) == 0) return true;
    return false;
}

// A reference from 1, or from -1 backwards, to one of `count`.
static jali_status resolve(jali_context *ctx, const model_file *file, const text *in, const char *what,
                           int64_t reference, size_t count, int32_t *index)
{
    int64_t place = reference < 0 ? (int64_t)count + reference : reference - 1;
    if (place < 0 || place >= (int64_t)count)
        return fail(ctx, JALI_BAD_INPUT, "%s, line %lld: the face names %s %lld; there are %zu above it",
                    file->name, (long long)in->line, what, (long long)reference, count);
    *index = (int32_t)place;
    return JALI_OK;
}

static bool take_slash(text *in)
{
    bool there = in->at < in->end && *in->at == '/';
    in->at += there;
    return there;
}

// v, v/vt, v//vn or v/vt/vn.
static jali_status read_face(jali_context *ctx, gathering *g, text *in)
{
    jali_status status = JALI_OK;
    int64_t line = in->line, reference, skipped;
    while (take_whole(in, &reference)) {
        int32_t vertex = 0, texture = -1;
        TRY(resolve(ctx, g->file, in, "vertex", reference, g->vertex_count, &vertex));
        if (take_slash(in)) {
            if (in->at < in->end && *in->at != '/' && take_whole(in, &reference))
                TRY(resolve(ctx, g->file, in, "texture point", reference, g->texture_count, &texture));
            if (take_slash(in)) take_whole(in, &skipped);
        }
        TRY(gather_corner(ctx, g, vertex, texture));
    }
    skip_blanks(in);
    bool clean = in->at == in->end || *in->at == '\n' || *in->at == '#';
    if (!clean || g->corner_count < 3)
        TRY(fail(ctx, JALI_BAD_INPUT, "%s, line %lld: a face is three or more of v, v/vt, v//vn or v/vt/vn",
                 g->file->name, (long long)line));
    TRY(gather_polygon(ctx, g, line, 0));
done:
    return status;
}

static jali_status read_texture(jali_context *ctx, gathering *g, text *in)
{
    double point[2] = {0};
    if (!take_number(in, &point[0]))
        return fail(ctx, JALI_BAD_INPUT, "%s, line %lld: a texture point needs a finite number",
                    g->file->name, (long long)in->line);
    take_number(in, &point[1]); // a line texture has one
    return gather_texture(ctx, g, point);
}

static jali_status read_vertex(jali_context *ctx, gathering *g, text *in)
{
    double point[3];
    if (!take_point(in, point))
        return fail(ctx, JALI_BAD_INPUT, "%s, line %lld: a vertex needs three finite numbers", g->file->name,
                    (long long)in->line);
    return gather_vertex(ctx, g, point);
}

jali_status read_obj(jali_context *ctx, const model_file *file, jali_mesh *mesh, double (**uv)[3][2])
{
    jali_status status = JALI_OK;
    gathering g = {.file = file};
    text in = {file->data, file->data + file->size, 1};
    int32_t lines = 0;
    for (skip_space(&in); in.at < in.end; next_line(&in)) {
        if (lines++ % 65536 == 0) TRY(step(ctx, "read", 0));
        char word[8];
        if (*in.at == '#' || !take_word(&in, word, sizeof word)) continue;
        if (strcmp(word, "v") == 0) TRY(read_vertex(ctx, &g, &in));
        if (strcmp(word, "vt") == 0) TRY(read_texture(ctx, &g, &in));
        if (strcmp(word, "f") == 0) TRY(read_face(ctx, &g, &in));
    }
    TRY(gather_finish(ctx, &g, mesh, uv));
done:
    gather_free(ctx, &g);
    return status;
}
