// Answers: JSON, bytes that are held, a sentence that says what is wrong.
#ifndef SERVE_REPLY_H
#define SERVE_REPLY_H

#include "serve.h"

/// Answer with JSON (taken; NULL: no memory).
enum MHD_Result reply_json(struct MHD_Connection *connection, unsigned status, json_t *json);

/// {"error": {"status": ..., "message": "a sentence"}}
enum MHD_Result reply_error(struct MHD_Connection *connection, unsigned status, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/// Answer with bytes that the answer then holds (taken).
enum MHD_Result reply_blob(struct MHD_Connection *connection, blob *bytes, const char *type);

/// Answer with bytes that always exist.
///   in     encoding   NULL or "gzip"
enum MHD_Result reply_constant(struct MHD_Connection *connection, const void *data, size_t size,
                               const char *type, const char *encoding);

/// Queue any answer with the headers that all carry (taken).
enum MHD_Result reply_with(struct MHD_Connection *connection, unsigned status, struct MHD_Response *response,
                           const char *type);

#endif
