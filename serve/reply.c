// Answers: JSON, bytes that are held, a sentence that says what is wrong.
#include "reply.h"
#include "guard.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum MHD_Result reply_with(struct MHD_Connection *connection, unsigned status, struct MHD_Response *response,
                           const char *type)
{
    if (!response) return MHD_NO;
    guard_headers(response);
    MHD_add_response_header(response, "Content-Type", type);
    enum MHD_Result queued = MHD_queue_response(connection, status, response);
    MHD_destroy_response(response);
    return queued;
}

enum MHD_Result reply_json(struct MHD_Connection *connection, unsigned status, json_t *json)
{
    char *text = json ? json_dumps(json, JSON_COMPACT | JSON_REAL_PRECISION(9)) : NULL;
    json_decref(json);
    if (!text) return MHD_NO;
    return reply_with(connection, status,
                      MHD_create_response_from_buffer(strlen(text), text, MHD_RESPMEM_MUST_FREE),
                      "application/json");
}

enum MHD_Result reply_error(struct MHD_Connection *connection, unsigned status, const char *format, ...)
{
    char words[MOST_MESSAGE_BYTES];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(words, sizeof words, format, arguments);
    va_end(arguments);
    json_t *message = json_string(words); // NULL when what it quotes is no UTF-8
    if (!message) message = json_string("what was asked for is no UTF-8");
    return reply_json(connection, status,
                      json_pack("{s:{s:i, s:o}}", "error", "status", (int)status, "message", message));
}

static void let_go(void *bytes)
{
    blob_let_go(bytes);
}

enum MHD_Result reply_blob(struct MHD_Connection *connection, blob *bytes, const char *type)
{
    struct MHD_Response *response =
        MHD_create_response_from_buffer_with_free_callback_cls(bytes->size, bytes->data, let_go, bytes);
    if (!response) blob_let_go(bytes);
    return reply_with(connection, MHD_HTTP_OK, response, type);
}

enum MHD_Result reply_constant(struct MHD_Connection *connection, const void *data, size_t size,
                               const char *type, const char *encoding)
{
    struct MHD_Response *response =
        MHD_create_response_from_buffer(size, (void *)(uintptr_t)data, MHD_RESPMEM_PERSISTENT);
    if (response && encoding) {
        MHD_add_response_header(response, "Content-Encoding", encoding);
        MHD_add_response_header(response, "Vary", "Accept-Encoding");
    }
    return reply_with(connection, MHD_HTTP_OK, response, type);
}
