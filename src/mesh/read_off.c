// OFF, the object file format: counts, vertices, faces.
//
// Limits:  what stands behind three coordinates, or behind the corners of a face, is passed over (colours,
//          normals); the binary kind and the one in four dimensions are refused.
// Checked: tests/test_readers.c, fuzz/fuzz_off.c.
#include "mesh/gather.h"
#include "mesh/text.h"

static bool take_header(text *in)
{
    static const char *const words[] = {"off", "coff", "noff", "cnoff", "stoff"};
    char word[8];
    if (in->at < in->end && *in->at == '#' && !next_line(in)) return false;
    if (!take_word(in, word, sizeof word)) return false;
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        if (strcmp(word, words[i]) == 0) return true;
    return false;
}

bool looks_like_off(const model_file *file)
{
    text in = {file->data, file->data + file->size, 1};
    return take_header(&in);
}

static jali_status read_counts(jali_context *ctx, const model_file *file, text *in, int64_t count[2])
{
    skip_blanks(in); // the counts may stand behind the word
    if ((in->at == in->end || *in->at == '\n' || *in->at == '#') && !next_line(in))
        return fail(ctx, JALI_BAD_INPUT, "%s is cut off behind its first word", file->name);
    for (int k = 0; k < 2; k++)
        if (!take_whole(in, &count[k]) || count[k] < 0 || count[k] > INT32_MAX)
            return fail(ctx, JALI_BAD_INPUT, "%s, line %lld: the numbers of vertices and faces are needed",
                        file->name, (long long)in->line);
    return JALI_OK;
}

static jali_status read_face(jali_context *ctx, gathering *g, text *in)
{
    jali_status status = JALI_OK;
    int64_t corners, vertex;
    if (!take_whole(in, &corners) || corners < 0)
        TRY(fail(ctx, JALI_BAD_INPUT, "%s, line %lld: the number of a face's corners is needed",
                 g->file->name, (long long)in->line));
    for (int64_t c = 0; c < corners; c++) {
        if (!take_whole(in, &vertex) || vertex < 0 || vertex >= (int64_t)g->vertex_count)
            TRY(fail(ctx, JALI_BAD_INPUT,
                     "%s, line %lld: a face of %lld corners needs as many vertices of 0 .. %zu",
                     g->file->name, (long long)in->line, (long long)corners, g->vertex_count - 1));
        TRY(gather_corner(ctx, g, (int32_t)vertex, -1));
    }
    TRY(gather_polygon(ctx, g, in->line, 0));
done:
    return status;
}

jali_status read_off(jali_context *ctx, const model_file *file, jali_mesh *mesh)
{
    jali_status status = JALI_OK;
    gathering g = {.file = file};
    text in = {file->data, file->data + file->size, 1};
    int64_t count[2] = {0};
    take_header(&in);
    TRY(read_counts(ctx, file, &in, count));
    for (int64_t i = 0; i < count[0] + count[1]; i++) {
        double point[3];
        if (i % 65536 == 0) TRY(step(ctx, "read", 0));
        if (!next_line(&in))
            TRY(fail(ctx, JALI_BAD_INPUT,
                     "%s is cut off at line %lld: %lld vertices and %lld faces were announced", file->name,
                     (long long)in.line, (long long)count[0], (long long)count[1]));
        if (i >= count[0]) {
            TRY(read_face(ctx, &g, &in));
            continue;
        }
        if (!take_point(&in, point))
            TRY(fail(ctx, JALI_BAD_INPUT, "%s, line %lld: a vertex needs three finite numbers", file->name,
                     (long long)in.line));
        TRY(gather_vertex(ctx, &g, point));
    }
    TRY(gather_finish(ctx, &g, mesh, NULL));
done:
    gather_free(ctx, &g);
    return status;
}
