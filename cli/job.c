// Several pictures on one surface, from a JSON file: the same words as on the command line (docs/job.md).
#include "options.h"
#include "base/bytes.h"
#include "base/file.h"

#include <jansson.h>
#include <stdio.h>

enum { MOST_JOB_BYTES = 1 << 24, MOST_PICTURES = 1000 };

enum {
    OF_PICTURE =
        GROUP_PICTURE | GROUP_SIZE | GROUP_GRID | GROUP_METHOD | GROUP_SURFACE | GROUP_LOAD | GROUP_REINFORCE,
    OF_OBJECT = GROUP_SURFACE | GROUP_PLATE,
};

void job_free(jali_context *ctx, job *j)
{
    for (size_t i = 0; i < j->text_count; i++) release(ctx, j->text[i]);
    release(ctx, j->text);
    release(ctx, j->each);
    json_decref(j->root);
    *j = (job){0};
}

// Keep a text for as long as the job.
static jali_status keep_text(jali_context *ctx, job *j, const char *text, const char **kept)
{
    jali_status status;
    size_t size = strlen(text) + 1;
    TRY(GROW(ctx, j->text, j->text_capacity, j->text_count + 1));
    TRY(ALLOCATE(ctx, j->text[j->text_count], size));
    memcpy(j->text[j->text_count], text, size);
    *kept = j->text[j->text_count++];
done:
    return status;
}

// A value as it would stand on the command line: text, number, true, or an array of numbers.
static jali_status value_text(jali_context *ctx, job *j, json_t *value, const char *key, const char **text)
{
    jali_status status;
    char words[256] = "";
    *text = json_string_value(value);
    if (*text) return JALI_OK;
    if (json_is_number(value))
        snprintf(words, sizeof words, "%.17g", json_number_value(value));
    else if (json_is_boolean(value))
        snprintf(words, sizeof words, "%s", json_is_true(value) ? "true" : "false");
    else if (json_is_array(value) && json_array_size(value) <= 4)
        for (size_t i = 0; i < json_array_size(value); i++) {
            size_t used = strlen(words);
            snprintf(words + used, sizeof words - used, "%s%.17g", i ? "," : "",
                     json_number_value(json_array_get(value, i)));
        }
    else
        return fail(ctx, JALI_BAD_INPUT, "\"%.40s\" in the job is no text, number, true or list of numbers",
                    key);
    TRY(keep_text(ctx, j, words, text));
done:
    return status;
}

// A path in a job counts from the job's own folder.
static jali_status path_from_job(jali_context *ctx, const settings *set, job *j, const char *path,
                                 const char **full)
{
    jali_status status;
    jali_bytes joined = {0};
    const char *slash = strrchr(set->job, '/');
    TRY(slash && *path != '/' ? bytes_print(ctx, &joined, "%.*s/%s", (int)(slash - set->job), set->job, path)
                              : bytes_print(ctx, &joined, "%s", path));
    TRY(bytes_append(ctx, &joined, "", 1));
    TRY(keep_text(ctx, j, (const char *)joined.data, full));
done:
    jali_bytes_free(ctx, &joined);
    return status;
}

// The options in an object, all but some keys.
static jali_status set_all(jali_context *ctx, job *j, json_t *object, const char *const *but, uint32_t groups,
                           settings *set)
{
    const char *key, *text;
    json_t *value;
    char sentence[SENTENCE_BYTES];
    json_object_foreach(object, key, value)
    {
        bool skip = false;
        for (const char *const *name = but; *name; name++) skip |= strcmp(key, *name) == 0;
        if (skip) continue;
        jali_status status = value_text(ctx, j, value, key, &text);
        if (status != JALI_OK) return status;
        if (!set_option_named(key, text, groups, set, sentence))
            return fail(ctx, JALI_BAD_INPUT, "the job %.200s: %.200s", set->job, sentence);
    }
    return JALI_OK;
}

static jali_status read_picture(jali_context *ctx, settings *set, job *j, json_t *object)
{
    jali_status status;
    static const char *const own[] = {"picture", NULL};
    settings *one = &j->each[j->count];
    const char *name = json_string_value(json_object_get(object, "picture"));
    if (!name)
        return fail(ctx, JALI_BAD_INPUT, "picture %d of the job %.200s has no \"picture\": its file",
                    j->count + 1, set->job);
    *one = *set;
    TRY(path_from_job(ctx, set, j, name, &one->operand));
    one->make.place.width_mm = one->make.place.height_mm = 0;
    TRY(set_all(ctx, j, object, own, OF_PICTURE, one));
    if (one->printer != set->printer && jali_printer_is_file(one->printer))
        TRY(path_from_job(ctx, set, j, one->printer, &one->printer));
    if (one->edits != set->edits) TRY(path_from_job(ctx, set, j, one->edits, &one->edits));
    settle_options(one);
    TRY(settle_printer(ctx, one));
    j->count++;
done:
    return status;
}

static jali_status read_job(jali_context *ctx, settings *set, job *j)
{
    jali_status status;
    static const char *const own[] = {"version", "pictures", "surface", NULL};
    json_t *pictures = json_object_get(j->root, "pictures");
    const char *surface = json_string_value(json_object_get(j->root, "surface"));
    size_t count = json_array_size(pictures);
    if (json_integer_value(json_object_get(j->root, "version")) != 1)
        return fail(ctx, JALI_BAD_INPUT, "the job %.200s has no \"version\": 1", set->job);
    if (!surface && !set->surface)
        return fail(ctx, JALI_BAD_INPUT, "the job %.200s has no \"surface\"", set->job);
    if (count < 1 || count > MOST_PICTURES)
        return fail(ctx, JALI_BAD_INPUT, "the job %.200s has %zu \"pictures\"; 1 to %d are accepted",
                    set->job, count, MOST_PICTURES);
    if (!set->surface) set->surface = surface;
    TRY(set_all(ctx, j, j->root, own, OF_OBJECT, set));
    settle_options(set);
    TRY(ALLOCATE(ctx, j->each, count));
    for (size_t i = 0; i < count; i++) TRY(read_picture(ctx, set, j, json_array_get(pictures, i)));
done:
    return status;
}

jali_status load_job(jali_context *ctx, settings *set, job *j)
{
    jali_status status;
    jali_bytes file = {0};
    json_error_t error;
    *j = (job){0};
    TRY(file_read(ctx, set->job, MOST_JOB_BYTES, &file));
    j->root = json_loadb((const char *)file.data, file.size, JSON_REJECT_DUPLICATES, &error);
    if (!json_is_object((json_t *)j->root))
        status = fail(ctx, JALI_BAD_INPUT, "the job %.200s is no JSON object: line %d: %.100s", set->job,
                      error.line, j->root ? "something else" : error.text);
    else
        TRY(read_job(ctx, set, j));
done:
    jali_bytes_free(ctx, &file);
    if (status != JALI_OK) job_free(ctx, j);
    return status;
}
