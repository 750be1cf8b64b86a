// What there is to choose from: printers, surfaces, materials, samples, options, files.
#include "lists.h"
#include "reply.h"
#include "store.h"
#include "values.h"

#include <jali/png.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SAMPLE_PX = 1000, LEAST_SAMPLE_PX = 16, MOST_SAMPLE_PX = 4096 };

static void add_printer(void *list, const char *folder, const char *file, const jali_printer *p)
{
    char name[256]; // by which it is found: the file's, of one's own
    if (!p) return; // it cannot be read, so it cannot be chosen
    snprintf(name, sizeof name, "%.*s", (int)(folder ? strrchr(file, '.') - file : (ptrdiff_t)strlen(file)),
             file);
    json_array_append_new(list, json_pack("{s:s, s:s, s:s, s:f, s:f, s:f, s:b}", "name", name, "what",
                                          p->what, "process", jali_process_name(p->process), "phi_e_mm",
                                          jali_printer_phi_e_mm(p), "phi_s_mm", p->phi_s_mm.value, "phi_v_mm",
                                          p->phi_v_mm.value, "own", folder != NULL));
}

static json_t *printers(jali_context *ctx)
{
    json_t *list = json_array();
    if (each_printer(ctx, add_printer, list) == JALI_OK) return list;
    json_decref(list);
    return NULL;
}

static json_t *surfaces(void)
{
    int32_t count;
    const jali_surface_info *info = jali_surface_list(&count);
    json_t *list = json_array();
    for (int32_t i = 0; i < count; i++)
        json_array_append_new(list, json_pack("{s:s, s:s}", "name", info[i].name, "what", info[i].what));
    return list;
}

static json_t *samples(void)
{
    int32_t count;
    const jali_sample_info *info = jali_sample_list(&count);
    json_t *list = json_array();
    for (int32_t i = 0; i < count; i++)
        json_array_append_new(list, json_pack("{s:s, s:s}", "name", info[i].name, "what", info[i].what));
    return list;
}

static json_t *materials(void)
{
    int32_t count;
    const jali_material *m = jali_material_list(&count);
    json_t *list = json_array();
    for (int32_t i = 0; i < count; i++)
        json_array_append_new(list, json_pack("{s:s, s:f, s:f, s:f, s:f, s:s}", "name", m[i].name, "e_mpa",
                                              m[i].e_mpa, "nu", m[i].nu, "density_g_cm3", m[i].density_g_cm3,
                                              "limit_mpa", m[i].limit_mpa, "source", m[i].source));
    return list;
}

// Those that a job takes: what names files is the server's.
static json_t *options(void)
{
    int32_t count;
    const option *o = option_list(&count);
    json_t *list = json_array();
    for (int32_t i = 0; i < count; i++) {
        json_t *one;
        if (!(o[i].group & JOB_OPTIONS) || o[i].offset == offsetof(settings, map) ||
            o[i].offset == offsetof(settings, moved_map))
            continue;
        one = json_pack("{s:s, s:s?, s:s}", "name", o[i].name, "value", o[i].value, "what", o[i].help);
        if (o[i].kind == NUMBER || o[i].kind == WHOLE)
            json_object_set_new(one, "range", json_pack("[f, f]", o[i].least, o[i].most));
        if (o[i].unit && *o[i].unit) json_object_set_new(one, "unit", json_string(o[i].unit));
        json_array_append_new(list, one);
    }
    return list;
}

static json_t *file_names(void)
{
    json_t *list = json_array();
    for (const job_file *file = job_files(); file->name; file++)
        json_array_append_new(list, json_pack("{s:s, s:s}", "name", file->name, "type", file->type));
    return list;
}

static jali_context *small_context(void)
{
    jali_context *ctx;
    jali_context_options opt = jali_context_defaults();
    opt.threads = 1;
    return jali_context_create(&opt, &ctx) == JALI_OK ? ctx : NULL;
}

// What the command line named, for as long as it is kept.
static json_t *named_picture(server *s)
{
    char name[MOST_NAME_BYTES + 1];
    blob *bytes = *s->picture ? store_find(s, s->picture, name) : NULL;
    if (!bytes) return json_null();
    blob_let_go(bytes);
    return json_pack("{s:s, s:s}", "id", s->picture, "name", name);
}

enum MHD_Result lists_reply(server *s, struct MHD_Connection *connection)
{
    jali_context *ctx = small_context();
    json_t *all =
        ctx ? json_pack("{s:i, s:o, s:o, s:o, s:o, s:o, s:o, s:o}", "version", 1, "picture", named_picture(s),
                        "printers", printers(ctx), "surfaces", surfaces(), "materials", materials(),
                        "samples", samples(), "options", options(), "files", file_names())
            : NULL;
    jali_context_free(ctx);
    return reply_json(connection, MHD_HTTP_OK, all);
}

static jali_status draw_sample(jali_context *ctx, const char *name, int32_t side_px, jali_bytes *png)
{
    jali_status status;
    jali_bitmap bitmap = {0};
    TRY(jali_sample(ctx, name, side_px, &bitmap));
    TRY(jali_bitmap_png(ctx, &bitmap, 0, png));
done:
    jali_bitmap_free(ctx, &bitmap);
    return status;
}

enum MHD_Result sample_reply(struct MHD_Connection *connection, const char *file, const char *size)
{
    char name[64];
    jali_bytes png = {0};
    enum MHD_Result replied;
    long side_px = size ? strtol(size, NULL, 10) : SAMPLE_PX;
    const char *dot = strrchr(file, '.');
    if (!dot || strcmp(dot, ".png") != 0)
        return reply_error(connection, MHD_HTTP_NOT_FOUND, "a sample is called NAME.png");
    if (side_px < LEAST_SAMPLE_PX || side_px > MOST_SAMPLE_PX)
        return reply_error(connection, MHD_HTTP_BAD_REQUEST, "size must be %d .. %d px", LEAST_SAMPLE_PX,
                           MOST_SAMPLE_PX);
    jali_context *ctx = small_context();
    if (!ctx) return MHD_NO;
    snprintf(name, sizeof name, "%.*s", (int)(dot - file), file);
    if (draw_sample(ctx, name, (int32_t)side_px, &png) != JALI_OK) {
        replied = reply_error(connection, MHD_HTTP_NOT_FOUND, "%s", jali_message(ctx));
    } else {
        struct MHD_Response *response =
            MHD_create_response_from_buffer(png.size, png.data, MHD_RESPMEM_MUST_COPY);
        replied = reply_with(connection, MHD_HTTP_OK, response, "image/png");
    }
    jali_bytes_free(ctx, &png);
    jali_context_free(ctx);
    return replied;
}
