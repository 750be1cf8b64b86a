// PLY, the polygon file format: ASCII and binary of both byte orders.
//
// The header describes every element's properties, so all of them can be passed over; of `vertex` x, y and z
// are taken, of `face` the list vertex_indices (or vertex_index), whatever their types.
//
// Limits:  triangle strips are no faces; vertices stand before faces; 64 properties an element, 32 elements.
// Checked: tests/test_readers.c, fuzz/fuzz_ply.c.
#include "mesh/gather.h"
#include "mesh/text.h"

#include <math.h>

enum { MOST_ELEMENTS = 32, MOST_PROPERTIES = 64 };

typedef enum number_type {
    INT8,
    UINT8,
    INT16,
    UINT16,
    INT32,
    UINT32,
    FLOAT32,
    FLOAT64,
    NUMBER_TYPES
} number_type;
static const int type_bytes[NUMBER_TYPES] = {1, 1, 2, 2, 4, 4, 4, 8};

typedef enum encoding { ASCII, LITTLE_ENDIAN_BYTES, BIG_ENDIAN_BYTES } encoding;

typedef struct property {
    number_type type, count_type; // of a list the items, and how many
    bool list;
    int axis;     // 0, 1, 2 for x, y, z of a vertex; else -1
    bool corners; // of a face
} property;

typedef struct element {
    bool vertices, faces;
    int64_t count;
    int32_t property_count;
    property property[MOST_PROPERTIES];
} element;

typedef struct ply {
    jali_context *ctx;
    const model_file *file;
    text in; // of a binary file: behind the header, the bytes
    encoding how;
    int32_t element_count;
    element *element; // [MOST_ELEMENTS]
    gathering g;
} ply;

bool looks_like_ply(const model_file *file)
{
    return file->size >= 4 && memcmp(file->data, "ply", 3) == 0 &&
           (file->data[3] == '\n' || file->data[3] == '\r');
}

// ---- the header ----

static jali_status refuse_header(const ply *p, const char *what)
{
    return fail(p->ctx, JALI_BAD_INPUT, "%s, line %lld: %s", p->file->name, (long long)p->in.line, what);
}

static bool take_word_of_line(text *in, char *word, size_t room)
{
    skip_blanks(in);
    if (in->at == in->end || *in->at == '\n') return false;
    return take_word(in, word, room);
}

static bool take_type(text *in, number_type *type)
{
    static const char *const names[2][NUMBER_TYPES] = {
        {"char", "uchar", "short", "ushort", "int", "uint", "float", "double"},
        {"int8", "uint8", "int16", "uint16", "int32", "uint32", "float32", "float64"}};
    char word[16];
    if (!take_word_of_line(in, word, sizeof word)) return false;
    for (int t = 0; t < NUMBER_TYPES; t++)
        if (strcmp(word, names[0][t]) == 0 || strcmp(word, names[1][t]) == 0) {
            *type = (number_type)t;
            return true;
        }
    return false;
}

static jali_status read_format(ply *p)
{
    static const char *const names[] = {"ascii", "binary_little_endian", "binary_big_endian"};
    char word[32];
    if (take_word_of_line(&p->in, word, sizeof word))
        for (int i = 0; i < 3; i++)
            if (strcmp(word, names[i]) == 0) {
                p->how = (encoding)i;
                return JALI_OK;
            }
    return refuse_header(p, "a format is ascii, binary_little_endian or binary_big_endian");
}

static jali_status read_element(ply *p)
{
    char word[32];
    if (p->element_count == MOST_ELEMENTS) return refuse_header(p, "more than 32 elements");
    element *e = &p->element[p->element_count];
    *e = (element){0};
    if (!take_word_of_line(&p->in, word, sizeof word) || !take_whole(&p->in, &e->count) || e->count < 0)
        return refuse_header(p, "an element is a name and how many there are");
    e->vertices = strcmp(word, "vertex") == 0;
    e->faces = strcmp(word, "face") == 0;
    p->element_count++;
    return JALI_OK;
}

static jali_status read_property(ply *p)
{
    char word[32];
    property q = {.axis = -1};
    if (p->element_count == 0) return refuse_header(p, "a property of no element");
    element *e = &p->element[p->element_count - 1];
    if (e->property_count == MOST_PROPERTIES) return refuse_header(p, "more than 64 properties");
    text before = p->in;
    q.list = take_word_of_line(&p->in, word, sizeof word) && strcmp(word, "list") == 0;
    if (!q.list) p->in = before;
    bool sound = !q.list || (take_type(&p->in, &q.count_type) && q.count_type < FLOAT32);
    if (!sound || !take_type(&p->in, &q.type) || !take_word_of_line(&p->in, word, sizeof word))
        return refuse_header(p, "a property is a type and a name, or list, two types and a name");
    for (int k = 0; k < 3 && e->vertices && !q.list; k++)
        if (word[0] == 'x' + k && !word[1]) q.axis = k;
    q.corners =
        e->faces && q.list && (strcmp(word, "vertex_indices") == 0 || strcmp(word, "vertex_index") == 0);
    e->property[e->property_count++] = q;
    return JALI_OK;
}

static jali_status read_header(ply *p)
{
    jali_status status = JALI_OK;
    char word[16];
    bool format = false;
    for (;;) {
        skip_line(&p->in);
        if (!take_word(&p->in, word, sizeof word)) TRY(refuse_header(p, "cut off: no end_header"));
        if (strcmp(word, "end_header") == 0) break;
        if (strcmp(word, "format") == 0) TRY(read_format(p));
        if (strcmp(word, "element") == 0) TRY(read_element(p));
        if (strcmp(word, "property") == 0) TRY(read_property(p));
        format |= strcmp(word, "format") == 0;
    }
    if (!format) TRY(refuse_header(p, "no format is given"));
    // Exactly one line end: the byte behind it may be any.
    if (p->in.at < p->in.end && *p->in.at == '\r') p->in.at++;
    if (p->in.at < p->in.end && *p->in.at == '\n') p->in.at++;
    p->in.line++;
done:
    return status;
}

// ---- the numbers ----

static double number_of(number_type type, uint64_t bits)
{
    float single;
    double value;
    uint32_t low = (uint32_t)bits;
    switch (type) {
    case INT8: return (int8_t)low;
    case INT16: return (int16_t)low;
    case INT32: return (int32_t)low;
    case FLOAT32: memcpy(&single, &low, sizeof single); return single;
    case FLOAT64: memcpy(&value, &bits, sizeof value); return value;
    default: return low;
    }
}

static bool take_binary(ply *p, number_type type, double *value)
{
    int bytes = type_bytes[type];
    uint64_t bits = 0;
    if (p->in.end - p->in.at < bytes) return false;
    for (int i = 0; i < bytes; i++) {
        int shift = 8 * (p->how == LITTLE_ENDIAN_BYTES ? i : bytes - 1 - i);
        bits |= (uint64_t)(uint8_t)p->in.at[i] << shift;
    }
    p->in.at += bytes;
    *value = number_of(type, bits);
    return true;
}

// A number that matters; of ASCII it may be on a later line.
static bool take(ply *p, number_type type, double *value)
{
    if (p->how != ASCII) return take_binary(p, type, value) && isfinite(*value);
    skip_space(&p->in);
    return take_number(&p->in, value);
}

static bool pass_over(ply *p, number_type type, int64_t count)
{
    char word[2];
    if (p->how != ASCII) {
        if ((p->in.end - p->in.at) / type_bytes[type] < count) return false;
        p->in.at += count * type_bytes[type];
        return true;
    }
    for (int64_t i = 0; i < count; i++)
        if (!take_word(&p->in, word, sizeof word)) return false;
    return true;
}

// ---- the elements ----

static jali_status refuse_row(const ply *p, const element *e, int64_t row, const char *what)
{
    const char *kind = e->vertices ? "vertex" : e->faces ? "face" : "element";
    return fail(p->ctx, JALI_BAD_INPUT, "%s: %s %lld of %lld %s", p->file->name, kind, (long long)row + 1,
                (long long)e->count, p->in.at == p->in.end ? "is cut off" : what);
}

static jali_status read_corners(ply *p, const element *e, const property *q, int64_t row, int64_t count)
{
    jali_status status = JALI_OK;
    for (int64_t c = 0; c < count; c++) {
        double vertex;
        if (!take(p, q->type, &vertex) || !(vertex >= 0 && vertex < (double)p->g.vertex_count) ||
            vertex != floor(vertex))
            TRY(refuse_row(p, e, row, "names a vertex that is not there"));
        TRY(gather_corner(p->ctx, &p->g, (int32_t)vertex, -1));
    }
    TRY(gather_polygon(p->ctx, &p->g, 0, row + 1));
done:
    return status;
}

static jali_status read_row(ply *p, const element *e, int64_t row)
{
    jali_status status = JALI_OK;
    double point[3] = {0};
    for (int32_t i = 0; i < e->property_count; i++) {
        const property *q = &e->property[i];
        double value = 1;
        if (q->list && (!take(p, q->count_type, &value) || value < 0 || value != floor(value) || value > 1e9))
            TRY(refuse_row(p, e, row, "has a list without a length"));
        if (q->axis >= 0) {
            if (!take(p, q->type, &value) || !isfinite((float)value))
                TRY(refuse_row(p, e, row, "has a coordinate that is not a finite number"));
            point[q->axis] = (float)value;
        } else if (q->corners) {
            TRY(read_corners(p, e, q, row, (int64_t)value));
        } else if (!pass_over(p, q->type, (int64_t)value)) {
            TRY(refuse_row(p, e, row, "is not complete"));
        }
    }
    if (e->vertices) TRY(gather_vertex(p->ctx, &p->g, point));
done:
    return status;
}

static bool has_axes(const element *e)
{
    int axes = 0;
    for (int32_t i = 0; i < e->property_count; i++)
        if (e->property[i].axis >= 0) axes |= 1 << e->property[i].axis;
    return axes == 7;
}

jali_status read_ply(jali_context *ctx, const model_file *file, jali_mesh *mesh)
{
    jali_status status;
    ply p = {.ctx = ctx, .file = file, .in = {file->data, file->data + file->size, 1}, .g = {.file = file}};
    TRY(ALLOCATE(ctx, p.element, MOST_ELEMENTS));
    TRY(read_header(&p));
    for (int32_t i = 0; i < p.element_count; i++) {
        const element *e = &p.element[i];
        if (e->property_count == 0) continue;
        if (e->vertices && !has_axes(e)) TRY(refuse_header(&p, "vertices without x, y or z"));
        for (int64_t row = 0; row < e->count; row++) {
            if (row % 65536 == 0) TRY(step(ctx, "read", 0));
            TRY(read_row(&p, e, row));
        }
    }
    TRY(gather_finish(ctx, &p.g, mesh, NULL));
done:
    gather_free(ctx, &p.g);
    release(ctx, p.element);
    return status;
}
