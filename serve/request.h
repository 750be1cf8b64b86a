// What a client asks of a job, from its JSON.
#ifndef SERVE_REQUEST_H
#define SERVE_REQUEST_H

#include "serve.h"

/// Make a task of the body of POST /api/v1/jobs.
///   out    why      what is wrong, when NULL comes back
///          status   and the status to say it with
task *task_from_json(server *s, const blob *body, char why[MOST_MESSAGE_BYTES], unsigned *status);

#endif
