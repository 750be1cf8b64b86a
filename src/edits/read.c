// Edits from JSON and back (docs/edits.md).
//
// Limits:  16 MB, 10,000 edits, 20,000 points; a point may lie one picture's size beyond the picture, so that
//          what is cropped away may keep its edits.
// Checked: tests/test_edits.c, fuzz/fuzz_edits.c.
#include <jali/edits.h>
#include "base/bytes.h"
#include "base/file.h"
#include "base/number.h"

#include <jansson.h>
#include <stdlib.h>

enum { MOST_BYTES = 1 << 24, MOST_EDITS = 10000, MOST_POINTS = 20000 };

static const double MOST_SIZE = 1e6, LEAST_SIZE = 1e-3;
static const char *const kind_name[JALI_EDIT_KINDS] = {"bridge", "forbid", "lock"};

typedef struct reading {
    const char *name;
    size_t edit_capacity, point_capacity;
    jali_edits *edits;
} reading;

static bool is_key_of(const char *key, const char *const *names)
{
    for (; *names; names++)
        if (strcmp(key, *names) == 0) return true;
    return false;
}

static jali_status check_keys(jali_context *ctx, const reading *r, json_t *object, const char *const *names,
                              const char *what)
{
    const char *key;
    json_t *value;
    json_object_foreach(object, key, value)
    {
        if (!is_key_of(key, names))
            return fail(ctx, JALI_BAD_INPUT, "%.200s: %s have no \"%.40s\"", r->name, what, key);
    }
    return JALI_OK;
}

static bool numbers_of(json_t *array, double pair[2])
{
    if (json_array_size(array) != 2) return false;
    for (size_t k = 0; k < 2; k++) {
        json_t *number = json_array_get(array, k);
        if (!json_is_number(number)) return false;
        pair[k] = json_number_value(number);
    }
    return true;
}

static jali_status read_size(jali_context *ctx, const reading *r, json_t *root)
{
    double *size = r->edits->size;
    if (!numbers_of(json_object_get(root, "size"), size))
        return fail(ctx, JALI_BAD_INPUT,
                    "%.200s has no \"size\": [width, height] of the picture, in the unit of the points",
                    r->name);
    for (int k = 0; k < 2; k++)
        if (!(size[k] >= LEAST_SIZE && size[k] <= MOST_SIZE))
            return fail(ctx, JALI_BAD_INPUT, "%.200s: \"size\" is %g x %g; %g to %g is accepted", r->name,
                        size[0], size[1], LEAST_SIZE, MOST_SIZE);
    return JALI_OK;
}

static jali_status read_kind(jali_context *ctx, const reading *r, json_t *object, jali_edit *e)
{
    const char *text = json_string_value(json_object_get(object, "kind"));
    for (int32_t kind = 0; text && kind < JALI_EDIT_KINDS; kind++)
        if (strcmp(text, kind_name[kind]) == 0) {
            e->kind = (jali_edit_kind)kind;
            return JALI_OK;
        }
    return fail(ctx, JALI_BAD_INPUT,
                "%.200s: \"kind\" of edit %d is %s%.40s; bridge, forbid and lock are accepted", r->name,
                r->edits->count + 1, text ? "" : "not there", text ? text : "");
}

static jali_status read_width(jali_context *ctx, const reading *r, json_t *object, jali_edit *e)
{
    json_t *width = json_object_get(object, "width");
    const double *size = r->edits->size;
    if (!width) return JALI_OK;
    e->width = json_number_value(width);
    if (json_is_number(width) && e->width >= 0 && e->width <= MAX(size[0], size[1])) return JALI_OK;
    return fail(ctx, JALI_BAD_INPUT,
                "%.200s: \"width\" of edit %d must be a number from 0 to the picture's size, %g", r->name,
                r->edits->count + 1, MAX(size[0], size[1]));
}

static jali_status read_points(jali_context *ctx, reading *r, json_t *object, jali_edit *e)
{
    jali_edits *edits = r->edits;
    json_t *points = json_object_get(object, "points"), *point;
    size_t i, count = json_array_size(points);
    size_t fewest = e->kind == JALI_EDIT_BRIDGE ? 2 : e->width > 0 ? 1 : 3;
    if (count < fewest || count > (size_t)(MOST_POINTS - edits->point_count))
        return fail(
            ctx, JALI_BAD_INPUT,
            "%.200s: edit %d has %zu \"points\"; a bridge takes 2 or more, a stroke 1, a region 3, and all "
            "together %d",
            r->name, edits->count + 1, count, MOST_POINTS);
    jali_status status = GROW(ctx, edits->point, r->point_capacity, (size_t)edits->point_count + count);
    if (status != JALI_OK) return status;
    e->first = edits->point_count;
    e->count = (int32_t)count;
    json_array_foreach(points, i, point)
    {
        double *at = edits->point[edits->point_count];
        bool near = numbers_of(point, at);
        for (int k = 0; near && k < 2; k++) near = at[k] >= -edits->size[k] && at[k] <= 2 * edits->size[k];
        if (!near)
            return fail(ctx, JALI_BAD_INPUT,
                        "%.200s: point %zu of edit %d is no [x, y] on the picture of %g x %g or beside it",
                        r->name, i + 1, edits->count + 1, edits->size[0], edits->size[1]);
        edits->point_count++;
    }
    return JALI_OK;
}

static jali_status read_edit(jali_context *ctx, reading *r, json_t *object)
{
    static const char *const keys[] = {"kind", "points", "width", "note", NULL};
    jali_status status;
    jali_edit e = {0};
    if (!json_is_object(object))
        return fail(ctx, JALI_BAD_INPUT, "%.200s: edit %d is no object", r->name, r->edits->count + 1);
    TRY(check_keys(ctx, r, object, keys, "edits"));
    TRY(read_kind(ctx, r, object, &e));
    TRY(read_width(ctx, r, object, &e));
    TRY(read_points(ctx, r, object, &e));
    TRY(GROW(ctx, r->edits->edit, r->edit_capacity, r->edits->count + 1));
    r->edits->edit[r->edits->count++] = e;
done:
    return status;
}

static jali_status read_all(jali_context *ctx, reading *r, json_t *root)
{
    static const char *const keys[] = {"version", "size", "edits", NULL};
    jali_status status;
    json_t *list = json_object_get(root, "edits"), *one;
    size_t i;
    TRY(check_keys(ctx, r, root, keys, "files of edits"));
    if (json_integer_value(json_object_get(root, "version")) != 1)
        return fail(ctx, JALI_BAD_INPUT, "%.200s has no \"version\": 1", r->name);
    TRY(read_size(ctx, r, root));
    if (!json_is_array(list) || json_array_size(list) > MOST_EDITS)
        return fail(ctx, JALI_BAD_INPUT, "%.200s has no \"edits\": a list of at most %d", r->name,
                    MOST_EDITS);
    json_array_foreach(list, i, one) TRY(read_edit(ctx, r, one));
done:
    return status;
}

jali_status jali_edits_read_bytes(jali_context *ctx, const uint8_t *bytes, size_t size, const char *name,
                                  jali_edits *edits)
{
    jali_status status;
    json_error_t error;
    reading r = {.name = name, .edits = edits};
    *edits = (jali_edits){0};
    json_t *root = json_loadb((const char *)bytes, size, JSON_REJECT_DUPLICATES, &error);
    status = json_is_object(root) ? read_all(ctx, &r, root)
                                  : fail(ctx, JALI_BAD_INPUT, "%.200s is no JSON object: line %d: %.100s",
                                         name, root ? 1 : error.line, root ? "something else" : error.text);
    json_decref(root);
    if (status != JALI_OK) jali_edits_free(ctx, edits);
    return status;
}

jali_status jali_edits_read(jali_context *ctx, const char *path, jali_edits *edits)
{
    jali_status status;
    jali_bytes file = {0};
    *edits = (jali_edits){0};
    TRY(file_read(ctx, path, MOST_BYTES, &file));
    TRY(jali_edits_read_bytes(ctx, file.data, file.size, strcmp(path, "-") == 0 ? "stdin" : path, edits));
done:
    jali_bytes_free(ctx, &file);
    return status;
}

// --- Writing

// write_decimal takes what happens to be a float32 for one, and then its few digits need not be the double's.
static jali_status append_number(jali_context *ctx, double value, jali_bytes *json)
{
    char digits[DECIMAL_BYTES];
    const char *at = digits;
    double back;
    int length = write_decimal(digits, value);
    if (read_decimal(&at, digits + length, &back) && back == value)
        return bytes_append(ctx, json, digits, (size_t)length);
    json_t *number = json_real(value);
    char *text = number ? json_dumps(number, JSON_ENCODE_ANY | JSON_REAL_PRECISION(17)) : NULL;
    jali_status status = text ? bytes_append(ctx, json, text, strlen(text))
                              : fail(ctx, JALI_NO_MEMORY, "no memory for the edits");
    free(text);
    json_decref(number);
    return status;
}

static jali_status append_pair(jali_context *ctx, const double pair[2], jali_bytes *json)
{
    jali_status status;
    TRY(bytes_print(ctx, json, "["));
    TRY(append_number(ctx, pair[0], json));
    TRY(bytes_print(ctx, json, ", "));
    TRY(append_number(ctx, pair[1], json));
    TRY(bytes_print(ctx, json, "]"));
done:
    return status;
}

jali_status jali_edits_write(jali_context *ctx, const jali_edits *edits, jali_bytes *json)
{
    jali_status status;
    TRY(bytes_print(ctx, json, "{\n  \"version\": 1,\n  \"size\": "));
    TRY(append_pair(ctx, edits->size, json));
    TRY(bytes_print(ctx, json, ",\n  \"edits\": ["));
    for (int32_t i = 0; i < edits->count; i++) {
        const jali_edit *e = &edits->edit[i];
        TRY(bytes_print(ctx, json, "%s\n    {\"kind\": \"%s\", \"points\": [", i ? "," : "",
                        kind_name[e->kind]));
        for (int32_t k = 0; k < e->count; k++) {
            if (k > 0) TRY(bytes_print(ctx, json, ", "));
            TRY(append_pair(ctx, edits->point[e->first + k], json));
        }
        TRY(bytes_print(ctx, json, "]"));
        if (e->width > 0) {
            TRY(bytes_print(ctx, json, ", \"width\": "));
            TRY(append_number(ctx, e->width, json));
        }
        TRY(bytes_print(ctx, json, "}"));
    }
    TRY(bytes_print(ctx, json, "%s]\n}\n", edits->count ? "\n  " : ""));
done:
    return status;
}
