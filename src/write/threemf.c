// 3MF: the mesh as XML, packed with its small picture.
//
// Source:  3MF Core Specification 1.3; Open Packaging Conventions for the two files beside the model.
// Order:   blocks of vertices and triangles are formatted in parallel, each into a place of its own, and put
//          together in order: the bytes do not depend on the threads.
// Checked: tests/test_write.c (read back, xmllint, unzip); PrusaSlicer opens it.
#include <jali/png.h>
#include <jali/render.h>
#include <jali/write.h>

#include "base/number.h"
#include "mesh/mesh.h"
#include "write/xml.h"
#include "write/zip.h"

#include <stdio.h>

enum {
    BLOCK = 4096,     // vertices or triangles
    BATCH = 32,       // blocks at a time
    LINE_BYTES = 128, // longest line: <vertex> with three numbers, 3 * 32 + 24
    LEVEL = 1,        // deflate: 6 takes twice as long for a tenth less
    THUMBNAIL_PX = 256
};

static const char content_types[] =
    "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
    "<Types xmlns=\"http://schemas.openxmlformats.org/package/2006/content-types\">"
    "<Default Extension=\"rels\" ContentType=\"application/vnd.openxmlformats-package.relationships+xml\"/>"
    "<Default Extension=\"model\" ContentType=\"application/vnd.ms-package.3dmanufacturing-3dmodel+xml\"/>"
    "<Default Extension=\"png\" ContentType=\"image/png\"/></Types>\n";

#define MODEL_RELATION                                                                                       \
    "<Relationship Target=\"/3D/3dmodel.model\" Id=\"model\" "                                               \
    "Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/>"
#define THUMBNAIL_RELATION                                                                                   \
    "<Relationship Target=\"/Metadata/thumbnail.png\" Id=\"thumbnail\" "                                     \
    "Type=\"http://schemas.openxmlformats.org/package/2006/relationships/metadata/thumbnail\"/>"
#define RELATIONS(...)                                                                                       \
    "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"                                                           \
    "<Relationships xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\">" __VA_ARGS__     \
    "</Relationships>\n"

typedef struct line_job {
    const jali_mesh *mesh;
    int32_t first_block; // of this batch
    bool triangles;      // else vertices
    char *text;          // [BATCH][BLOCK * LINE_BYTES]
    size_t length[BATCH];
} line_job;

static char *put_text(char *to, const char *text, size_t length)
{
    memcpy(to, text, length);
    return to + length;
}
#define PUT(to, literal) put_text((to), (literal), sizeof(literal) - 1)

static char *vertex_line(char *to, const double at[3])
{
    to = PUT(to, "<vertex x=\"");
    to += write_decimal(to, at[0]);
    to = PUT(to, "\" y=\"");
    to += write_decimal(to, at[1]);
    to = PUT(to, "\" z=\"");
    to += write_decimal(to, at[2]);
    return PUT(to, "\"/>\n");
}

static char *triangle_line(char *to, const int32_t t[3])
{
    to = PUT(to, "<triangle v1=\"");
    to += write_whole(to, (uint64_t)t[0]);
    to = PUT(to, "\" v2=\"");
    to += write_whole(to, (uint64_t)t[1]);
    to = PUT(to, "\" v3=\"");
    to += write_whole(to, (uint64_t)t[2]);
    return PUT(to, "\"/>\n");
}

static void write_block(void *shared, int32_t index)
{
    line_job *job = shared;
    const jali_mesh *mesh = job->mesh;
    char *start = job->text + (size_t)index * BLOCK * LINE_BYTES, *to = start;
    int32_t count = job->triangles ? mesh->triangle_count : mesh->vertex_count;
    int32_t first = (job->first_block + index) * BLOCK, end = first + MIN(BLOCK, count - first);
    for (int32_t i = first; i < end; i++)
        to = job->triangles ? triangle_line(to, mesh->triangle[i]) : vertex_line(to, mesh->vertex[i]);
    job->length[index] = (size_t)(to - start);
}

static jali_status write_lines(jali_context *ctx, line_job *job, bool triangles, jali_bytes *xml)
{
    jali_status status = JALI_OK;
    int32_t count = triangles ? job->mesh->triangle_count : job->mesh->vertex_count;
    int32_t blocks = count / BLOCK + (count % BLOCK != 0);
    job->triangles = triangles;
    for (job->first_block = 0; job->first_block < blocks; job->first_block += BATCH) {
        int32_t batch = MIN((int32_t)BATCH, blocks - job->first_block);
        TRY(step(ctx, "write", 0.4 * job->first_block / blocks));
        parallel(ctx, batch, write_block, job);
        for (int32_t i = 0; i < batch; i++)
            TRY(bytes_append(ctx, xml, job->text + (size_t)i * BLOCK * LINE_BYTES, job->length[i]));
    }
done:
    return status;
}

static jali_status write_metadata(jali_context *ctx, const char *name, const char *text, jali_bytes *xml)
{
    jali_status status = JALI_OK;
    if (!text) return JALI_OK;
    TRY(bytes_print(ctx, xml, "<metadata name=\"%s\">", name));
    TRY(xml_text(ctx, text, xml));
    TRY(bytes_print(ctx, xml, "</metadata>\n"));
done:
    return status;
}

static jali_status write_model(jali_context *ctx, const jali_mesh *mesh, const jali_write_options *opt,
                               jali_bytes *xml)
{
    jali_status status;
    char application[64];
    line_job job = {.mesh = mesh};
    snprintf(application, sizeof application, "jali %s", jali_version());
    // Lines of an ordinary plate are about so long; a wrong guess costs a copy.
    TRY(bytes_reserve(ctx, xml, 4096 + (size_t)mesh->vertex_count * 60 + (size_t)mesh->triangle_count * 50));
    TRY(ALLOCATE(ctx, job.text, (size_t)BATCH * BLOCK * LINE_BYTES));
    TRY(bytes_print(
        ctx, xml,
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<model unit=\"millimeter\" xml:lang=\"en-US\" "
        "xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\">\n"));
    TRY(write_metadata(ctx, "Title", opt->title, xml));
    TRY(write_metadata(ctx, "Application", application, xml));
    TRY(write_metadata(ctx, "Description", opt->parameters, xml));
    TRY(bytes_print(ctx, xml, "<resources><object id=\"1\" type=\"model\"><mesh><vertices>\n"));
    TRY(write_lines(ctx, &job, false, xml));
    TRY(bytes_print(ctx, xml, "</vertices><triangles>\n"));
    TRY(write_lines(ctx, &job, true, xml));
    TRY(bytes_print(ctx, xml,
                    "</triangles></mesh></object></resources>\n<build><item objectid=\"1\"/></build>\n"
                    "</model>\n"));
done:
    release(ctx, job.text);
    return status;
}

static jali_status write_thumbnail(jali_context *ctx, const jali_mesh *mesh, jali_bytes *png)
{
    jali_status status;
    uint8_t *rgb = NULL;
    jali_render_options opt = jali_render_defaults();
    opt.width_px = opt.height_px = THUMBNAIL_PX;
    opt.draft = true;
    TRY(ALLOCATE(ctx, rgb, 3 * THUMBNAIL_PX * THUMBNAIL_PX));
    TRY(jali_render(ctx, mesh, &opt, rgb));
    TRY(jali_rgb_png(ctx, THUMBNAIL_PX, THUMBNAIL_PX, rgb, png));
done:
    release(ctx, rgb);
    return status;
}

jali_status jali_write_3mf(jali_context *ctx, const jali_mesh *mesh, const jali_write_options *given,
                           jali_bytes *bytes)
{
    static const char bare[] = RELATIONS(MODEL_RELATION),
                      pictured[] = RELATIONS(MODEL_RELATION THUMBNAIL_RELATION);
    jali_status status;
    jali_write_options opt = given ? *given : jali_write_defaults();
    jali_bytes xml = {0}, png = {0};
    zip_writer zip = {0};
    bool picture = !opt.no_thumbnail;
    const char *relations = picture ? pictured : bare;
    TRY(mesh_validate(ctx, mesh));
    if (picture) TRY(write_thumbnail(ctx, mesh, &png));
    TRY(write_model(ctx, mesh, &opt, &xml));
    TRY(zip_add(ctx, &zip, "[Content_Types].xml", content_types, sizeof content_types - 1, LEVEL, bytes));
    TRY(zip_add(ctx, &zip, "_rels/.rels", relations, strlen(relations), LEVEL, bytes));
    TRY(zip_add(ctx, &zip, "3D/3dmodel.model", xml.data, xml.size, LEVEL, bytes));
    if (picture) TRY(zip_add(ctx, &zip, "Metadata/thumbnail.png", png.data, png.size, 0, bytes));
    TRY(zip_finish(ctx, &zip, bytes));
done:
    jali_bytes_free(ctx, &png);
    jali_bytes_free(ctx, &xml);
    return status;
}
