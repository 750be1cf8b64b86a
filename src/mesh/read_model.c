// Reading a model: the format follows from the contents.
#include "mesh/readers.h"

#include "base/file.h"

jali_model_options jali_model_defaults(void)
{
    return (jali_model_options){.max_bytes = (uint64_t)1 << 31, .max_triangles = 50000000};
}

static bool begins_with(const model_file *file, const char *magic, size_t length)
{
    return file->size >= length && memcmp(file->data, magic, length) == 0;
}

// What the user may have meant, for the sentence.
static jali_status refuse_type(jali_context *ctx, const model_file *file)
{
    const struct {
        const char *magic;
        size_t length;
        const char *what;
    } known[] = {
        {"\x89PNG", 4, "a PNG picture"},
        {"\xff\xd8\xff", 3, "a JPEG picture"},
        {"RIFF", 4, "a WebP picture"},
        {"<", 1, "an XML text"},
        {"%PDF", 4, "a PDF"},
    };
    if (file->size == 0)
        return fail(ctx, JALI_BAD_INPUT, "%s is empty; a model is STL, 3MF, OBJ, PLY or OFF", file->name);
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        if (begins_with(file, known[i].magic, known[i].length))
            return fail(ctx, JALI_BAD_INPUT, "%s is %s; a model is STL, 3MF, OBJ, PLY or OFF", file->name,
                        known[i].what);
    return fail(ctx, JALI_BAD_INPUT, "%s is no STL, 3MF, OBJ, PLY or OFF", file->name);
}

jali_status read_any_model(jali_context *ctx, const model_file *file, jali_mesh *mesh, double (**uv)[3][2])
{
    *mesh = (jali_mesh){0};
    if (uv) *uv = NULL;
    if (file->opt.max_triangles < 1 || file->opt.max_triangles > INT32_MAX / 3)
        return fail(ctx, JALI_BAD_VALUE, "max_triangles = %d is outside 1 .. %d", file->opt.max_triangles,
                    INT32_MAX / 3);
    if (file->size > file->opt.max_bytes)
        return fail(ctx, JALI_LIMIT, "%s is larger than the limit of %.0f MB", file->name,
                    (double)file->opt.max_bytes / 1e6);
    if (looks_like_3mf(file)) return read_3mf(ctx, file, mesh);
    if (is_binary_stl(file)) return read_stl(ctx, file, mesh);
    if (looks_like_ply(file)) return read_ply(ctx, file, mesh);
    if (looks_like_off(file)) return read_off(ctx, file, mesh);
    if (looks_like_obj(file)) return read_obj(ctx, file, mesh, uv);
    if (looks_like_stl(file)) return read_stl(ctx, file, mesh);
    return refuse_type(ctx, file);
}

jali_status jali_read_model_bytes(jali_context *ctx, const void *data, size_t size, const char *name,
                                  const jali_model_options *opt, jali_mesh *mesh)
{
    const model_file file = {data, size, name, opt ? *opt : jali_model_defaults()};
    return read_any_model(ctx, &file, mesh, NULL);
}

jali_status jali_read_model(jali_context *ctx, const char *path, const jali_model_options *opt,
                            jali_mesh *mesh)
{
    jali_status status;
    jali_bytes bytes = {0};
    *mesh = (jali_mesh){0};
    uint64_t limit = opt ? opt->max_bytes : jali_model_defaults().max_bytes;
    TRY(file_read(ctx, path, (size_t)MIN(limit, SIZE_MAX / 4), &bytes));
    TRY(jali_read_model_bytes(ctx, bytes.data, bytes.size, strcmp(path, "-") ? path : "stdin", opt, mesh));
done:
    jali_bytes_free(ctx, &bytes);
    return status;
}
