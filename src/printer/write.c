// A profile as JSON: two spaces a level, keys in the order of the table, numbers in the fewest digits that
// read back.
#include "printer/figures.h"
#include "base/bytes.h"
#include "base/number.h"

#include <jansson.h>
#include <stdlib.h>

// Takes the value; NULL: it could not be made.
static jali_status append_value(jali_context *ctx, json_t *value, jali_bytes *json)
{
    char *text = value ? json_dumps(value, JSON_ENCODE_ANY | JSON_REAL_PRECISION(17)) : NULL;
    jali_status status = text ? bytes_append(ctx, json, text, strlen(text))
                              : fail(ctx, JALI_NO_MEMORY, "no memory for a printer profile");
    free(text);
    json_decref(value);
    return status;
}

// A text with its quotes and escapes.
static jali_status append_text(jali_context *ctx, const char *text, jali_bytes *json)
{
    json_t *value = json_string(text);
    if (!value) return fail(ctx, JALI_BAD_VALUE, "a text of the printer profile is no UTF-8");
    return append_value(ctx, value, json);
}

// write_decimal takes what happens to be a float32 for one, and then its few digits need not be the double's.
static jali_status append_number(jali_context *ctx, double value, jali_bytes *json)
{
    char digits[DECIMAL_BYTES];
    const char *at = digits;
    double back;
    int length = write_decimal(digits, value);
    if (!read_decimal(&at, digits + length, &back) || back != value)
        return append_value(ctx, json_real(value), json);
    return bytes_append(ctx, json, digits, (size_t)length);
}

// `,` and a key on a line of its own.
static jali_status append_key(jali_context *ctx, const char *indent, const char *key, jali_bytes *json)
{
    return bytes_print(ctx, json, ",\n%s\"%s\": ", indent, key);
}

// {"value": ..., "source": ...}; `count` values make a list.
static jali_status append_figure(jali_context *ctx, const char *indent, const char *key,
                                 const jali_figure *figure, int32_t count, jali_bytes *json)
{
    jali_status status = JALI_OK;
    if (!*figure->source) return status;
    TRY(append_key(ctx, indent, key, json));
    TRY(bytes_print(ctx, json, "{\"value\": %s", count > 1 ? "[" : ""));
    for (int32_t i = 0; i < count; i++) {
        if (i > 0) TRY(bytes_print(ctx, json, ", "));
        TRY(append_number(ctx, figure[i].value, json));
    }
    TRY(bytes_print(ctx, json, "%s, \"source\": ", count > 1 ? "]" : ""));
    TRY(append_text(ctx, figure->source, json));
    TRY(bytes_print(ctx, json, "}"));
done:
    return status;
}

// The name alone, or with the figures of its own as an object.
static jali_status append_material(jali_context *ctx, jali_printer *p, jali_bytes *json)
{
    jali_status status = JALI_OK;
    int32_t count;
    const figure_key *key = material_keys(&count);
    if (!*p->material && !*p->e_mpa.source) return status;
    TRY(append_key(ctx, "  ", "material", json));
    if (!*p->e_mpa.source) return append_text(ctx, p->material, json);
    TRY(bytes_print(ctx, json, "{\n    \"name\": "));
    TRY(append_text(ctx, p->material, json));
    for (int32_t i = 0; i < count; i++)
        TRY(append_figure(ctx, "    ", key[i].key, figure_of(p, &key[i]), 1, json));
    TRY(bytes_print(ctx, json, "\n  }"));
done:
    return status;
}

jali_status jali_printer_write(jali_context *ctx, const jali_printer *printer, jali_bytes *json)
{
    jali_status status;
    jali_printer p = *printer;
    int32_t count;
    const figure_key *key = figure_keys(&count);
    size_t before = json->size;
    TRY(check_printer(ctx, &p, p.name, JALI_BAD_VALUE));
    TRY(bytes_print(ctx, json, "{\n  \"jali_printer\": 1,\n  \"name\": "));
    TRY(append_text(ctx, p.name, json));
    if (*p.what) {
        TRY(append_key(ctx, "  ", "what", json));
        TRY(append_text(ctx, p.what, json));
    }
    if (p.process != JALI_PROCESS_NONE) {
        TRY(append_key(ctx, "  ", "process", json));
        TRY(append_text(ctx, jali_process_name(p.process), json));
    }
    for (int32_t i = 0; i < count; i++)
        TRY(append_figure(ctx, "  ", key[i].key, figure_of(&p, &key[i]), 1, json));
    TRY(append_figure(ctx, "  ", "bed_mm", p.bed_mm, 3, json));
    TRY(append_material(ctx, &p, json));
    TRY(bytes_print(ctx, json, "\n}\n"));
done:
    if (status != JALI_OK) json->size = before;
    return status;
}
