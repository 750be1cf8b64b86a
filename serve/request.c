// What a client asks of a job, from its JSON (docs/serve.md). Options are left to the worker, which says what
// is wrong with them as the command line does.
#include "jobs.h"
#include "request.h"
#include "store.h"
#include "values.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct reading {
    server *s;
    task *t;
    json_t *root, *worker; // what came, what the worker gets
    char *why;
    unsigned status;
} reading;

static bool refuse(reading *r, unsigned status, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(r->why, MOST_MESSAGE_BYTES, format, arguments);
    va_end(arguments);
    r->status = status;
    return false;
}

static bool known_keys(reading *r)
{
    static const char *const known[] = {"picture", "mesh", "printer", "options", "files",
                                        "client",  "verb", "name",    "edits",
#ifdef JALI_HOOKS
                                        "hook",
#endif
                                        NULL};
    const char *key;
    json_t *value;
    json_object_foreach(r->root, key, value)
    {
        bool found = false;
        for (int32_t i = 0; known[i]; i++) found |= strcmp(key, known[i]) == 0;
        if (!found) return refuse(r, MHD_HTTP_BAD_REQUEST, "there is no key \"%.40s\" in a job", key);
    }
    return true;
}

// A text of some bytes at most; NULL and true when there is none.
static bool text_of(reading *r, const char *key, size_t most_bytes, const char **text)
{
    json_t *value = json_object_get(r->root, key);
    *text = json_string_value(value);
    if (!value || json_is_null(value)) return true;
    if (!*text) return refuse(r, MHD_HTTP_BAD_REQUEST, "\"%s\" of a job is a text", key);
    if (strlen(*text) > most_bytes || strlen(*text) != json_string_length(value))
        return refuse(r, MHD_HTTP_BAD_REQUEST, "\"%s\" of a job has at most %zu bytes, none of them 0", key,
                      most_bytes);
    return true;
}

static bool read_uploads(reading *r)
{
    const char *picture, *mesh, *name;
    char mesh_name[MOST_NAME_BYTES + 1];
    if (!text_of(r, "picture", TOKEN_BYTES, &picture) || !text_of(r, "mesh", TOKEN_BYTES, &mesh) ||
        !text_of(r, "name", MOST_NAME_BYTES, &name))
        return false;
    if (!picture) return refuse(r, MHD_HTTP_BAD_REQUEST, "a job needs a \"picture\": the id of an upload");
    r->t->picture = store_find(r->s, picture, r->t->picture_name);
    if (name && name_is_fit(name)) snprintf(r->t->picture_name, sizeof r->t->picture_name, "%s", name);
    if (mesh) r->t->mesh = store_find(r->s, mesh, mesh_name);
    if (!r->t->picture)
        return refuse(r, MHD_HTTP_NOT_FOUND, "there is no upload \"%s\"; send it again", picture);
    if (mesh && !r->t->mesh)
        return refuse(r, MHD_HTTP_NOT_FOUND, "there is no upload \"%s\"; send it again", mesh);
    return true;
}

static bool read_client(reading *r)
{
    const char *client;
    if (!text_of(r, "client", MOST_CLIENT_BYTES, &client)) return false;
    if (client) snprintf(r->t->client, sizeof r->t->client, "%s", client);
    return true;
}

static bool read_files(reading *r)
{
    json_t *files = json_object_get(r->root, "files"), *name;
    size_t i, count = json_array_size(files);
    if (count < 1 || count > MOST_JOB_FILES)
        return refuse(r, MHD_HTTP_BAD_REQUEST, "a job needs \"files\": the names of 1 to %d files",
                      MOST_JOB_FILES);
    json_array_foreach(files, i, name)
    {
        const char *text = json_string_value(name);
        const job_file *file = text ? job_file_named(text) : NULL;
        if (!file)
            return refuse(r, MHD_HTTP_BAD_REQUEST,
                          "there is no file \"%.40s\"; /api/v1/lists says which there are",
                          text ? text : "?");
        for (int32_t k = 0; k < r->t->file_count; k++)
            if (r->t->file[k].file == file)
                return refuse(r, MHD_HTTP_BAD_REQUEST, "%s is asked for twice", text);
        r->t->file[r->t->file_count++].file = file;
    }
    json_object_set(r->worker, "files", files);
    return true;
}

static bool verb_is_fit(const char *name)
{
    static const char *const fit[] = {"carve", "adapt", "analyse", "read", "printer", "smallest"};
    for (size_t i = 0; i < sizeof fit / sizeof *fit; i++)
        if (strcmp(name, fit[i]) == 0) return true;
    return false;
}

static bool read_options(reading *r)
{
    const char *name;
    json_t *options = json_object_get(r->root, "options");
    if (!text_of(r, "verb", 16, &name)) return false;
    if (name && !verb_is_fit(name))
        return refuse(r, MHD_HTTP_BAD_REQUEST,
                      "\"verb\" is carve, adapt, analyse, read, printer or smallest");
    if (options && !json_is_object(options))
        return refuse(r, MHD_HTTP_BAD_REQUEST, "\"options\" of a job is an object, such as {\"width\": 60}");
    json_t *given = options ? json_copy(options) : json_object();
    if (r->t->mesh && !json_object_get(given, "surface"))
        json_object_set_new(given, "surface", json_string("model.mesh"));
    json_object_set_new(r->worker, "options", given);
    json_object_set_new(r->worker, "verb", json_string(name ? name : "carve"));
#ifdef JALI_HOOKS
    json_object_set(r->worker, "hook", json_object_get(r->root, "hook"));
#endif
    return true;
}

// The profile of a name, with all it inherits, as one file: the worker opens none.
static jali_status named_printer(jali_context *ctx, const char *name, jali_bytes *json)
{
    jali_status status;
    jali_bytes folder = {0};
    jali_printer printer;
    if (jali_printer_is_file(name))
        return fail(ctx, JALI_BAD_VALUE,
                    "a printer here is a name of the list, or a profile itself, not a file");
    TRY(printers_folder(ctx, &folder));
    TRY(jali_printer_find(ctx, name, (const char *)folder.data, &printer));
    TRY(jali_printer_write(ctx, &printer, json));
done:
    jali_bytes_free(ctx, &folder);
    return status;
}

static bool keep_printer(reading *r, const void *json, size_t size)
{
    r->t->printer = store_room(r->s, size);
    if (!r->t->printer || !blob_append(r->t->printer, json, size))
        return refuse(r, MHD_HTTP_SERVICE_UNAVAILABLE, "there is no room for the printer's profile");
    json_object_set_new(r->worker, "printer", json_string("printer.json"));
    return true;
}

static bool find_printer(reading *r, const char *name)
{
    jali_context *ctx;
    jali_context_options opt = jali_context_defaults();
    jali_bytes json = {0};
    bool kept = false;
    opt.threads = 1;
    if (jali_context_create(&opt, &ctx) != JALI_OK)
        return refuse(r, MHD_HTTP_SERVICE_UNAVAILABLE, "no memory for the printer's profile");
    if (named_printer(ctx, name, &json) == JALI_OK)
        kept = keep_printer(r, json.data, json.size);
    else
        refuse(r, MHD_HTTP_BAD_REQUEST, "%s", jali_message(ctx));
    jali_bytes_free(ctx, &json);
    jali_context_free(ctx);
    return kept;
}

static bool read_printer(reading *r)
{
    json_t *printer = json_object_get(r->root, "printer");
    if (!printer || json_is_null(printer)) return true;
    if (json_is_string(printer)) return find_printer(r, json_string_value(printer));
    if (!json_is_object(printer))
        return refuse(r, MHD_HTTP_BAD_REQUEST, "\"printer\" of a job is a name, or a profile as an object");
    char *text = json_dumps(printer, JSON_COMPACT);
    bool kept = text ? keep_printer(r, text, strlen(text))
                     : refuse(r, MHD_HTTP_SERVICE_UNAVAILABLE, "no memory for the printer's profile");
    free(text);
    return kept;
}

// They go to the worker as a file of their own, which says what is wrong with them.
static bool read_edits(reading *r)
{
    json_t *edits = json_object_get(r->root, "edits");
    if (!edits || json_is_null(edits)) return true;
    if (!json_is_object(edits))
        return refuse(r, MHD_HTTP_BAD_REQUEST, "\"edits\" of a job is an object (docs/edits.md)");
    char *text = json_dumps(edits, JSON_COMPACT | JSON_REAL_PRECISION(9));
    r->t->edits = text ? store_room(r->s, strlen(text)) : NULL;
    bool kept = r->t->edits && blob_append(r->t->edits, text, strlen(text));
    free(text);
    if (!kept) return refuse(r, MHD_HTTP_SERVICE_UNAVAILABLE, "there is no room for the edits");
    json_object_set_new(r->worker, "edits", json_string("edits.json"));
    return true;
}

static bool read_all(reading *r, const blob *body)
{
    json_error_t error;
    r->root = json_loadb((const char *)body->data, body->size, JSON_REJECT_DUPLICATES, &error);
    if (!r->root)
        return refuse(r, MHD_HTTP_BAD_REQUEST, "this is no JSON: line %d: %.200s", error.line, error.text);
    if (!json_is_object(r->root)) return refuse(r, MHD_HTTP_BAD_REQUEST, "a job is a JSON object");
    if (!known_keys(r) || !read_client(r) || !read_files(r) || !read_uploads(r) || !read_options(r) ||
        !read_printer(r) || !read_edits(r))
        return false;
    r->t->request = json_dumps(r->worker, JSON_COMPACT);
    if (!r->t->request || !random_id(r->t->id))
        return refuse(r, MHD_HTTP_SERVICE_UNAVAILABLE, "no memory for the job");
    return true;
}

task *task_from_json(server *s, const blob *body, char why[MOST_MESSAGE_BYTES], unsigned *status)
{
    reading r = {.s = s, .t = calloc(1, sizeof(task)), .worker = json_object(), .why = why};
    if (!r.t || !r.worker)
        refuse(&r, MHD_HTTP_SERVICE_UNAVAILABLE, "no memory for the job");
    else if (read_all(&r, body))
        r.status = MHD_HTTP_OK;
    json_decref(r.root);
    json_decref(r.worker);
    *status = r.status;
    if (r.status == MHD_HTTP_OK) return r.t;
    task_free(r.t);
    return NULL;
}
