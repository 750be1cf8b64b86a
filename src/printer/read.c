// Where profiles are, and what they inherit.
//
// A profile and what it inherits make a chain, at most DEEPEST long: it is read from the end, each link
// replacing what those before it have said. Other slicers' files are put into our form first (import.c), so
// that there is one way in.
// Checked: tests/test_printer.c.
#include "printer/profile.h"
#include "base/file.h"
#include "base/words.h"

#include <stdio.h>

enum { MOST_PROFILE_BYTES = 1 << 24, DEEPEST = 8 };

// A profile before it is read: its bytes, and what it is called. Built-in ones have names in <>.
typedef struct profile_file {
    jali_bytes bytes;
    jali_bytes name; // with an end mark
} profile_file;

static void profile_file_free(jali_context *ctx, profile_file *f)
{
    jali_bytes_free(ctx, &f->bytes);
    jali_bytes_free(ctx, &f->name);
}

static const char *text_of(const profile_file *f)
{
    return (const char *)f->name.data;
}

static bool ends_in(const char *text, const char *end)
{
    return strlen(text) >= strlen(end) && strcmp(text + strlen(text) - strlen(end), end) == 0;
}

bool jali_printer_is_file(const char *name)
{
    return strchr(name, '/') || ends_in(name, ".json") || ends_in(name, ".ini") || ends_in(name, ".gcode");
}

static jali_status open_file(jali_context *ctx, profile_file *f)
{
    return file_read(ctx, text_of(f), MOST_PROFILE_BYTES, &f->bytes);
}

static jali_status no_such_printer(jali_context *ctx, const char *name)
{
    int32_t count;
    const char *const *list = jali_printer_names(&count);
    const char *near = nearest_name(name, list, count);
    if (near) return fail(ctx, JALI_BAD_VALUE, "there is no printer \"%.60s\"; did you mean %s?", name, near);
    return fail(ctx, JALI_BAD_VALUE, "there is no printer \"%.60s\" (jali list printers)", name);
}

// NAME.json of the user, else what is built in.
static jali_status open_name(jali_context *ctx, const char *name, const char *folder, profile_file *f)
{
    jali_status status;
    if (folder) {
        TRY(bytes_print(ctx, &f->name, "%s/%s.json", folder, name));
        TRY(bytes_append(ctx, &f->name, "", 1));
        if (file_exists(ctx, text_of(f))) return open_file(ctx, f);
        f->name.size = 0;
    }
    TRY(bytes_print(ctx, &f->name, "<%s>", name));
    TRY(bytes_append(ctx, &f->name, "", 1));
    for (int32_t i = 0; i < builtin_count; i++)
        if (strcmp(name, builtin_name[i]) == 0)
            return bytes_append(ctx, &f->bytes, builtin_profiles[i].json, builtin_profiles[i].size);
    status = no_such_printer(ctx, name);
done:
    return status;
}

// A file is looked for beside the one that names it.
static jali_status open_profile(jali_context *ctx, const char *name, const char *beside, const char *folder,
                                profile_file *f)
{
    jali_status status;
    const char *slash = beside ? strrchr(beside, '/') : NULL;
    if (!jali_printer_is_file(name)) return open_name(ctx, name, folder, f);
    TRY(slash && *name != '/' ? bytes_print(ctx, &f->name, "%.*s/%s", (int)(slash - beside), beside, name)
                              : bytes_print(ctx, &f->name, "%s", name));
    TRY(bytes_append(ctx, &f->name, "", 1));
    TRY(open_file(ctx, f));
done:
    return status;
}

/// A profile and all that it inherits; the last one inherits nothing.
typedef struct chain {
    int32_t count;
    json_t *ours[DEEPEST];
    profile_file file[DEEPEST];
} chain;

static jali_status add_link(jali_context *ctx, chain *c)
{
    const profile_file *f = &c->file[c->count];
    jali_status status = profile_in_our_form(ctx, &f->bytes, text_of(f), &c->ours[c->count]);
    if (status == JALI_OK) c->count++;
    return status;
}

// A sentence of something that an inherited profile is at fault for says so.
static jali_status check_circle(jali_context *ctx, const chain *c, const profile_file *f)
{
    for (int32_t i = 0; i < c->count; i++)
        if (strcmp(text_of(&c->file[i]), text_of(f)) == 0)
            return fail(ctx, JALI_BAD_INPUT, "the printer profile %.150s inherits itself, by way of %.150s",
                        text_of(f), text_of(&c->file[c->count - 1]));
    return JALI_OK;
}

static jali_status follow_chain(jali_context *ctx, const char *folder, chain *c)
{
    jali_status status = JALI_OK;
    json_t *inherits;
    while ((inherits = json_object_get(c->ours[c->count - 1], "inherits"))) {
        const char *here = text_of(&c->file[c->count - 1]), *name = json_string_value(inherits);
        if (!name || !*name)
            return fail(ctx, JALI_BAD_INPUT,
                        "the printer profile %.100s: \"inherits\" takes the name of a printer or a file",
                        here);
        if (c->count == DEEPEST)
            return fail(
                ctx, JALI_BAD_INPUT,
                "the printer profile %.100s is the %dth of a chain in which each inherits the next; %d are "
                "accepted",
                here, DEEPEST, DEEPEST);
        TRY(open_profile(ctx, name, here, folder, &c->file[c->count]));
        TRY(check_circle(ctx, c, &c->file[c->count]));
        TRY(add_link(ctx, c));
    }
done:
    return status;
}

// A profile without a name is called as its file.
static void name_by_file(const char *path, jali_printer *printer)
{
    const char *slash = strrchr(path, '/'), *base = slash ? slash + 1 : path;
    const char *dot = strrchr(base, '.');
    size_t length = dot && dot > base ? (size_t)(dot - base) : strlen(base);
    snprintf(printer->name, sizeof printer->name, "%.*s", (int)MIN(length, sizeof printer->name - 1), base);
}

// Read the first link's file and all that it inherits.
static jali_status read_chain(jali_context *ctx, const char *folder, chain *c, jali_printer *printer)
{
    jali_status status;
    *printer = (jali_printer){0};
    TRY(add_link(ctx, c));
    TRY(follow_chain(ctx, folder, c));
    for (int32_t i = c->count; i-- > 0;) TRY(apply_profile(ctx, c->ours[i], text_of(&c->file[i]), printer));
    if (!*printer->name) name_by_file(text_of(&c->file[0]), printer);
    TRY(check_printer(ctx, printer, text_of(&c->file[0]), JALI_BAD_INPUT));
done:
    if (status != JALI_OK) *printer = (jali_printer){0};
    return status;
}

static void chain_free(jali_context *ctx, chain *c)
{
    for (int32_t i = 0; i < DEEPEST; i++) {
        json_decref(c->ours[i]);
        profile_file_free(ctx, &c->file[i]);
    }
}

jali_status jali_printer_read(jali_context *ctx, const uint8_t *bytes, size_t size, const char *name,
                              const char *folder, jali_printer *printer)
{
    jali_status status;
    chain c = {0};
    *printer = (jali_printer){0};
    TRY(bytes_append(ctx, &c.file[0].bytes, bytes, size));
    TRY(bytes_append(ctx, &c.file[0].name, name, strlen(name) + 1));
    TRY(read_chain(ctx, folder, &c, printer));
done:
    chain_free(ctx, &c);
    return status;
}

jali_status jali_printer_find(jali_context *ctx, const char *name, const char *folder, jali_printer *printer)
{
    jali_status status;
    chain c = {0};
    *printer = (jali_printer){0};
    TRY(open_profile(ctx, name, NULL, folder, &c.file[0]));
    TRY(read_chain(ctx, folder, &c, printer));
done:
    chain_free(ctx, &c);
    return status;
}
