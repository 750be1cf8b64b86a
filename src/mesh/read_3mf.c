// 3MF: a ZIP archive with an XML model; objects of triangles, components that place objects, a build that
// places both.
//
// Source:  3MF Core Specification 1.3 (units, transforms as rows, objects defined before they are used).
// Limits:  coordinates are rounded to float32 once placed, as slicers do: what is judged is what gets
//          printed. No production extension (parts in other files), no slices, no beams: what they say is not
//          read. Nothing with a document type is accepted, so there are no entities to expand.
// Checked: tests/test_model.c, fuzz/fuzz_3mf.c.
#include "mesh/scene.h"

#include "base/number.h"
#include "mesh/archive.h"

#include <expat.h>

#define CORE "http://schemas.microsoft.com/3dmanufacturing/core/2015/02|"

static const transform identity = {{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}};

typedef struct model {
    jali_context *ctx;
    const model_file *file;
    XML_Parser parser;
    jali_status status;
    scene scene;
    int32_t *by_id; // [object_count], the objects by ascending ids
    size_t vertex_room, triangle_room, object_room, part_room, item_room, by_id_room;
    bool in_object, in_build, is_model;
    char start_part[256];
} model;

static void refuse(model *m, jali_status status)
{
    if (m->status == JALI_OK) m->status = status;
    XML_StopParser(m->parser, XML_FALSE);
}

#define REFUSE(m, ...) refuse((m), fail((m)->ctx, JALI_BAD_INPUT, __VA_ARGS__))
#define LINE(m)        ((unsigned long)XML_GetCurrentLineNumber((m)->parser))

static const char *attribute(const XML_Char **attributes, const char *name)
{
    for (; *attributes; attributes += 2)
        if (strcmp(attributes[0], name) == 0) return attributes[1];
    return NULL;
}

static bool whole_number(const char *text, uint32_t limit, uint32_t *value)
{
    uint64_t number = 0;
    if (!text || !*text) return false;
    for (; *text >= '0' && *text <= '9' && number <= limit; text++)
        number = number * 10 + (uint64_t)(*text - '0');
    *value = (uint32_t)number;
    return *text == 0 && number <= limit;
}

static bool decimal(const char *text, double *value)
{
    if (!text) return false;
    const char *end = text + strlen(text);
    return read_decimal(&text, end, value) && text == end;
}

static bool transform_of(const char *text, transform *t)
{
    *t = identity;
    if (!text) return true;
    const char *end = text + strlen(text);
    for (int i = 0; i < 12; i++) {
        while (*text == ' ') text++;
        if (!read_decimal(&text, end, &t->m[i])) return false;
    }
    while (*text == ' ') text++;
    return *text == 0;
}

// Where in by_id the id is, or would be.
static size_t place_of_id(const model *m, uint32_t id)
{
    size_t low = 0, high = m->scene.object_count;
    while (low < high) {
        size_t middle = (low + high) / 2;
        if (m->scene.object[m->by_id[middle]].id < id)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

static int32_t object_with(const model *m, const char *text)
{
    uint32_t id;
    if (!whole_number(text, INT32_MAX, &id)) return -1;
    size_t place = place_of_id(m, id);
    return place < m->scene.object_count && m->scene.object[m->by_id[place]].id == id ? m->by_id[place] : -1;
}

static void start_object(model *m, const XML_Char **attributes)
{
    uint32_t id;
    const char *text = attribute(attributes, "id");
    if (m->in_object || !whole_number(text, INT32_MAX, &id) || object_with(m, text) >= 0) {
        REFUSE(m, "%s, line %lu: an object needs an id of its own", m->file->name, LINE(m));
        return;
    }
    if (m->scene.object_count == MAX_OBJECTS) {
        refuse(m, fail(m->ctx, JALI_LIMIT, "%s has more than %d objects", m->file->name, MAX_OBJECTS));
        return;
    }
    jali_status status = GROW(m->ctx, m->scene.object, m->object_room, m->scene.object_count + 1);
    if (status == JALI_OK) status = GROW(m->ctx, m->by_id, m->by_id_room, m->scene.object_count + 1);
    if (status != JALI_OK) {
        refuse(m, status);
        return;
    }
    size_t place = place_of_id(m, id);
    memmove(m->by_id + place + 1, m->by_id + place, (m->scene.object_count - place) * sizeof *m->by_id);
    m->by_id[place] = (int32_t)m->scene.object_count;
    m->scene.object[m->scene.object_count++] = (object){.id = id,
                                                        .first_vertex = (int32_t)m->scene.vertex_count,
                                                        .first_triangle = (int32_t)m->scene.triangle_count,
                                                        .first_part = (int32_t)m->scene.part_count};
    m->in_object = true;
}

static void add_vertex(model *m, const XML_Char **attributes)
{
    static const char *const axis[] = {"x", "y", "z"};
    double at[3];
    for (int k = 0; k < 3; k++)
        if (!decimal(attribute(attributes, axis[k]), &at[k])) {
            REFUSE(m, "%s, line %lu: a vertex needs a finite number as %s", m->file->name, LINE(m), axis[k]);
            return;
        }
    jali_status status = m->scene.vertex_count >= (size_t)3 * (size_t)m->file->opt.max_triangles
                             ? fail(m->ctx, JALI_LIMIT, "%s has more vertices than %d triangles can use",
                                    m->file->name, m->file->opt.max_triangles)
                             : GROW(m->ctx, m->scene.vertex, m->vertex_room, m->scene.vertex_count + 1);
    if (status == JALI_OK)
        memcpy(m->scene.vertex[m->scene.vertex_count++], at, sizeof at);
    else
        refuse(m, status);
}

static void add_triangle(model *m, const XML_Char **attributes)
{
    static const char *const corner[] = {"v1", "v2", "v3"};
    uint32_t index;
    int32_t t[3];
    int64_t known = (int64_t)m->scene.vertex_count - m->scene.object[m->scene.object_count - 1].first_vertex;
    for (int k = 0; k < 3; k++) {
        if (!whole_number(attribute(attributes, corner[k]), INT32_MAX, &index) || index >= known) {
            REFUSE(m, "%s, line %lu: %s is not one of the object's %lld vertices", m->file->name, LINE(m),
                   corner[k], (long long)known);
            return;
        }
        t[k] = (int32_t)index;
    }
    jali_status status = m->scene.triangle_count >= (size_t)m->file->opt.max_triangles
                             ? fail(m->ctx, JALI_LIMIT, "%s has more than %d triangles", m->file->name,
                                    m->file->opt.max_triangles)
                             : GROW(m->ctx, m->scene.triangle, m->triangle_room, m->scene.triangle_count + 1);
    if (status == JALI_OK)
        memcpy(m->scene.triangle[m->scene.triangle_count++], t, sizeof t);
    else
        refuse(m, status);
}

// A component or an item of the build: both place an object that was defined before.
static void add_placed(model *m, const XML_Char **attributes, bool component)
{
    placed p = {.object = object_with(m, attribute(attributes, "objectid"))};
    bool itself = component && p.object == (int32_t)m->scene.object_count - 1;
    if (p.object < 0 || itself || !transform_of(attribute(attributes, "transform"), &p.at)) {
        REFUSE(m, "%s, line %lu: %s needs the id of an earlier object, and 12 numbers if it has a transform",
               m->file->name, LINE(m), component ? "a component" : "an item");
        return;
    }
    size_t *count = component ? &m->scene.part_count : &m->scene.item_count;
    jali_status status =
        *count >= MAX_PLACED
            ? fail(m->ctx, JALI_LIMIT, "%s places objects more than %d times", m->file->name, MAX_PLACED)
        : component ? GROW(m->ctx, m->scene.part, m->part_room, *count + 1)
                    : GROW(m->ctx, m->scene.item, m->item_room, *count + 1);
    if (status == JALI_OK)
        (component ? m->scene.part : m->scene.item)[(*count)++] = p;
    else
        refuse(m, status);
}

static void start_model(model *m, const XML_Char **attributes)
{
    static const struct {
        const char *name;
        double mm;
    } units[] = {
        {"micron", 1e-3}, {"millimeter", 1}, {"centimeter", 10},
        {"inch", 25.4},   {"foot", 304.8},   {"meter", 1000},
    };
    const char *unit = attribute(attributes, "unit");
    m->is_model = true;
    m->scene.unit_mm = unit ? 0 : 1;
    for (size_t i = 0; unit && i < sizeof units / sizeof *units; i++)
        if (strcmp(unit, units[i].name) == 0) m->scene.unit_mm = units[i].mm;
    if (m->scene.unit_mm == 0) REFUSE(m, "%s: unknown unit \"%.40s\"", m->file->name, unit);
}

static void XMLCALL on_start(void *user, const XML_Char *name, const XML_Char **attributes)
{
    model *m = user;
    if (m->status != JALI_OK || strncmp(name, CORE, strlen(CORE)) != 0) return;
    name += strlen(CORE);
    if (strcmp(name, "vertex") == 0 && m->in_object)
        add_vertex(m, attributes);
    else if (strcmp(name, "triangle") == 0 && m->in_object)
        add_triangle(m, attributes);
    else if (strcmp(name, "object") == 0)
        start_object(m, attributes);
    else if (strcmp(name, "component") == 0 && m->in_object)
        add_placed(m, attributes, true);
    else if (strcmp(name, "build") == 0)
        m->in_build = true;
    else if (strcmp(name, "item") == 0 && m->in_build)
        add_placed(m, attributes, false);
    else if (strcmp(name, "model") == 0)
        start_model(m, attributes);
}

// The sizes of an object with all its components, which are complete because they came before.
static void finish_object(model *m)
{
    object *o = &m->scene.object[m->scene.object_count - 1];
    m->in_object = false;
    o->vertex_count = (int32_t)m->scene.vertex_count - o->first_vertex;
    o->triangle_count = (int32_t)m->scene.triangle_count - o->first_triangle;
    o->part_count = (int32_t)m->scene.part_count - o->first_part;
    o->all_vertices = o->vertex_count;
    o->all_triangles = o->triangle_count;
    o->instances = o->depth = 1;
    for (int32_t i = 0; i < o->part_count; i++) {
        const object *p = &m->scene.object[m->scene.part[o->first_part + i].object];
        o->all_vertices = MIN(o->all_vertices + p->all_vertices, INT32_MAX);
        o->all_triangles = MIN(o->all_triangles + p->all_triangles, INT32_MAX);
        o->instances = MIN(o->instances + p->instances, INT32_MAX);
        o->depth = MAX(o->depth, p->depth + 1);
    }
    if (o->depth > MAX_DEPTH)
        refuse(m,
               fail(m->ctx, JALI_LIMIT, "%s nests components more than %d deep", m->file->name, MAX_DEPTH));
}

static void XMLCALL on_end(void *user, const XML_Char *name)
{
    model *m = user;
    if (m->status != JALI_OK || strncmp(name, CORE, strlen(CORE)) != 0) return;
    name += strlen(CORE);
    if (strcmp(name, "object") == 0 && m->in_object)
        finish_object(m);
    else if (strcmp(name, "build") == 0)
        m->in_build = false;
}

static void XMLCALL on_doctype(void *user, const XML_Char *name, const XML_Char *system_id,
                               const XML_Char *public_id, int has_internal_subset)
{
    (void)name, (void)system_id, (void)public_id, (void)has_internal_subset;
    model *m = user;
    REFUSE(m, "%s declares a document type, which a 3MF must not", m->file->name);
}

// In _rels/.rels: the name of the part that holds the model.
static void XMLCALL on_relationship(void *user, const XML_Char *name, const XML_Char **attributes)
{
    static const char kind[] = "/3dmodel";
    model *m = user;
    const char *bar = strrchr(name, '|'), *type = attribute(attributes, "Type");
    const char *target = attribute(attributes, "Target");
    if (!bar || strcmp(bar, "|Relationship") != 0 || !type || !target || m->start_part[0]) return;
    size_t length = strlen(type);
    if (length < sizeof kind || strcmp(type + length - (sizeof kind - 1), kind) != 0) return;
    while (*target == '/') target++;
    if (strlen(target) < sizeof m->start_part) strcpy(m->start_part, target);
}

static jali_status feed(void *user, const char *piece, size_t size, bool last)
{
    model *m = user;
    if (XML_Parse(m->parser, piece, (int)size, last) == XML_STATUS_OK) return JALI_OK;
    if (m->status != JALI_OK) return m->status;
    enum XML_Error error = XML_GetErrorCode(m->parser);
    if (error == XML_ERROR_NO_MEMORY)
        return fail(m->ctx, JALI_NO_MEMORY, "no memory to parse %s", m->file->name);
    return fail(m->ctx, JALI_BAD_INPUT, "%s, line %lu: %s", m->file->name, LINE(m), XML_ErrorString(error));
}

static jali_status parse_part(model *m, zip_t *archive, const char *part, XML_StartElementHandler start,
                              XML_EndElementHandler end)
{
    m->parser = XML_ParserCreateNS(NULL, '|');
    if (!m->parser) return fail(m->ctx, JALI_NO_MEMORY, "no memory to parse %s", m->file->name);
    XML_SetUserData(m->parser, m);
    XML_SetElementHandler(m->parser, start, end);
    XML_SetStartDoctypeDeclHandler(m->parser, on_doctype);
    jali_status status =
        archive_unpack(m->ctx, archive, m->file->name, part, m->file->opt.max_bytes, feed, m);
    XML_ParserFree(m->parser);
    m->parser = NULL;
    return status;
}

bool looks_like_3mf(const model_file *file)
{
    return file->size >= 4 && memcmp(file->data, "PK\3\4", 4) == 0;
}

jali_status read_3mf(jali_context *ctx, const model_file *file, jali_mesh *mesh)
{
    jali_status status;
    model m = {.ctx = ctx, .file = file};
    zip_t *archive = NULL;
    TRY(archive_open(ctx, file->data, file->size, file->name, &archive));
    if (archive_has(archive, "_rels/.rels"))
        TRY(parse_part(&m, archive, "_rels/.rels", on_relationship, NULL));
    if (!m.start_part[0]) strcpy(m.start_part, "3D/3dmodel.model");
    TRY(parse_part(&m, archive, m.start_part, on_start, on_end));
    if (!m.is_model) TRY(fail(ctx, JALI_BAD_INPUT, "%s: %s is no 3MF model", file->name, m.start_part));
    TRY(scene_mesh(ctx, &m.scene, file, mesh));
done:
    if (status != JALI_OK) jali_mesh_free(ctx, mesh);
    archive_close(archive);
    release(ctx, m.scene.vertex);
    release(ctx, m.scene.triangle);
    release(ctx, m.scene.object);
    release(ctx, m.scene.part);
    release(ctx, m.scene.item);
    release(ctx, m.by_id);
    return status;
}
