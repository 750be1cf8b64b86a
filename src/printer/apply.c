// From JSON to a printer: each key of an object in our form.
//
// A figure is {"value": number, "source": "sentence"}; a number alone is taken too, and then the source says
// that the file states it without one.
#include "printer/profile.h"

#include <math.h>
#include <stdio.h>

static const char *const process_names[JALI_PROCESSES] = {"", "fdm", "sla", "sls", "laser", "cutter"};

const char *jali_process_name(jali_process process)
{
    return process > JALI_PROCESS_NONE && process < JALI_PROCESSES ? process_names[process] : "";
}

static jali_status copy_text(jali_context *ctx, const json_t *value, const char *key, const char *name,
                             size_t room, char *text)
{
    const char *words = json_string_value(value);
    if (!words || !*words)
        return fail(ctx, JALI_BAD_INPUT, "the printer profile %.100s: \"%.40s\" takes a text", name, key);
    if (strlen(words) >= room)
        return fail(ctx, JALI_BAD_INPUT,
                    "the printer profile %.100s: the text of \"%.40s\" has %zu bytes; up to %zu are accepted",
                    name, key, strlen(words), room - 1);
    memset(text, 0, room); // equal profiles are equal bytes
    memcpy(text, words, strlen(words));
    return JALI_OK;
}

// The keys a figure may have, and its source.
static jali_status read_source(jali_context *ctx, json_t *figure, const char *key, const char *name,
                               char source[JALI_SOURCE_BYTES])
{
    const char *part;
    json_t *value;
    memset(source, 0, JALI_SOURCE_BYTES);
    snprintf(source, JALI_SOURCE_BYTES, "stated in %.100s without a source", name);
    if (!json_is_object(figure)) return JALI_OK;
    json_object_foreach(figure, part, value) if (strcmp(part, "value") && strcmp(part, "source")) return fail(
        ctx, JALI_BAD_INPUT,
        "the printer profile %.100s: \"%.40s\" has a \"%.40s\"; \"value\" and \"source\" are "
        "accepted",
        name, key, part);
    value = json_object_get(figure, "source");
    return value ? copy_text(ctx, value, key, name, JALI_SOURCE_BYTES, source) : JALI_OK;
}

static const json_t *value_of(const json_t *figure)
{
    return json_is_object(figure) ? json_object_get(figure, "value") : figure;
}

static jali_status read_figure(jali_context *ctx, json_t *figure, const figure_key *k, const char *name,
                               jali_printer *printer)
{
    jali_figure *f = figure_of(printer, k);
    const json_t *value = value_of(figure);
    f->value = json_number_value(value);
    if (!json_is_number(value) || !(f->value >= k->least && f->value <= k->most))
        return fail(ctx, JALI_BAD_INPUT, "the printer profile %.100s: \"%s\" takes a number, %g to %g%s",
                    name, k->key, k->least, k->most, k->unit);
    return read_source(ctx, figure, k->key, name, f->source);
}

static jali_status read_bed(jali_context *ctx, json_t *figure, const char *name, jali_printer *printer)
{
    const json_t *value = value_of(figure);
    for (size_t k = 0; k < 3; k++) {
        const json_t *side = json_array_get(value, k);
        printer->bed_mm[k].value = json_number_value(side);
        if (json_array_size(value) != 3 || !(json_number_value(side) > 0) ||
            json_number_value(side) > LARGEST_BED_MM)
            return fail(
                ctx, JALI_BAD_INPUT,
                "the printer profile %.100s: \"bed_mm\" takes three lengths, [x, y, z], each up to %d mm",
                name, LARGEST_BED_MM);
        jali_status status = read_source(ctx, figure, "bed_mm", name, printer->bed_mm[k].source);
        if (status != JALI_OK) return status;
    }
    return JALI_OK;
}

static jali_status read_process(jali_context *ctx, const json_t *value, const char *name,
                                jali_printer *printer)
{
    const char *typed = json_string_value(value);
    for (int32_t i = 1; typed && i < JALI_PROCESSES; i++)
        if (strcmp(typed, process_names[i]) == 0) {
            printer->process = (jali_process)i;
            return JALI_OK;
        }
    return fail(ctx, JALI_BAD_INPUT,
                "the printer profile %.100s: \"process\" takes fdm, sla, sls, laser or cutter%s%.40s", name,
                typed ? ", not " : "", typed ? typed : "");
}

static jali_status unknown_key(jali_context *ctx, const char *key, const char *name)
{
    char known[JALI_SOURCE_BYTES + 60] = "name, what, inherits, process, material, bed_mm";
    int32_t count;
    const figure_key *own = figure_keys(&count);
    for (int32_t i = 0; i < count; i++)
        snprintf(known + strlen(known), sizeof known - strlen(known), ", %s", own[i].key);
    return fail(ctx, JALI_BAD_INPUT, "the printer profile %.100s has a \"%.40s\"; the keys are %s", name, key,
                known);
}

// The figure of a list that has this key, read; or NULL in *found.
static jali_status read_listed(jali_context *ctx, const char *key, json_t *value, const figure_key *list,
                               int32_t count, const char *name, jali_printer *printer, bool *found)
{
    for (int32_t i = 0; i < count; i++)
        if (strcmp(key, list[i].key) == 0) {
            *found = true;
            return read_figure(ctx, value, &list[i], name, printer);
        }
    *found = false;
    return JALI_OK;
}

// One that is built in by its name; or an object with a name and all four figures.
static jali_status read_material(jali_context *ctx, json_t *value, const char *name, jali_printer *printer)
{
    jali_status status = JALI_OK;
    int32_t count;
    const figure_key *list = material_keys(&count);
    const char *key;
    json_t *part;
    bool found;
    for (int32_t i = 0; i < count; i++) *figure_of(printer, &list[i]) = (jali_figure){0};
    if (!json_is_object(value))
        return copy_text(ctx, value, "material", name, JALI_NAME_BYTES, printer->material);
    TRY(copy_text(ctx, json_object_get(value, "name"), "material\": {\"name", name, JALI_NAME_BYTES,
                  printer->material));
    json_object_foreach(value, key, part)
    {
        if (strcmp(key, "name") == 0) continue;
        TRY(read_listed(ctx, key, part, list, count, name, printer, &found));
        if (!found)
            return fail(
                ctx, JALI_BAD_INPUT,
                "the printer profile %.100s: its \"material\" has a \"%.40s\"; the keys are name, e_mpa, "
                "nu, density_g_cm3, limit_mpa",
                name, key);
    }
done:
    return status;
}

static jali_status apply_key(jali_context *ctx, const char *key, json_t *value, const char *name,
                             jali_printer *printer)
{
    int32_t count;
    const figure_key *own = figure_keys(&count);
    bool found;
    if (strcmp(key, "jali_printer") == 0 || strcmp(key, "inherits") == 0) return JALI_OK; // seen to already
    if (strcmp(key, "name") == 0) return copy_text(ctx, value, key, name, JALI_NAME_BYTES, printer->name);
    if (strcmp(key, "what") == 0) return copy_text(ctx, value, key, name, JALI_SOURCE_BYTES, printer->what);
    if (strcmp(key, "process") == 0) return read_process(ctx, value, name, printer);
    if (strcmp(key, "material") == 0) return read_material(ctx, value, name, printer);
    if (strcmp(key, "bed_mm") == 0) return read_bed(ctx, value, name, printer);
    jali_status status = read_listed(ctx, key, value, own, count, name, printer, &found);
    return status == JALI_OK && !found ? unknown_key(ctx, key, name) : status;
}

jali_status apply_profile(jali_context *ctx, json_t *ours, const char *name, jali_printer *printer)
{
    const char *key;
    json_t *value;
    memset(printer->name, 0, sizeof printer->name); // nobody inherits these
    memset(printer->what, 0, sizeof printer->what);
    json_object_foreach(ours, key, value)
    {
        jali_status status = apply_key(ctx, key, value, name, printer);
        if (status != JALI_OK) return status;
    }
    return JALI_OK;
}
