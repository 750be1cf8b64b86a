// Jobs: asked for, waiting, running, done; what they made is kept until there is no room.
#ifndef SERVE_JOBS_H
#define SERVE_JOBS_H

#include "serve.h"

void task_free(task *t);

/// Put a job at the end of the queue; earlier ones of the same client that are not done are cancelled: the
/// newest request wins. The task is taken.
///   fails  false: too many wait (the task is not taken)
bool jobs_add(server *s, task *t);

/// The following are called under the lock.
task *jobs_find(server *s, const char *id);
task *jobs_next(server *s); // to run; NULL: none waits
void jobs_end(server *s, task *t, int exit, const char *message);
void jobs_progress(server *s, task *t, const char *stage, double fraction);

/// A piece of a file; NULL data: it is complete. What earlier jobs made may have to go for it.
///   fails  false, and *why says why: a file that was not asked for, or no room
bool jobs_take(server *s, task *t, const char *name, const void *data, size_t size, const char **why);

/// Cancel a job that is not done.
void jobs_cancel(server *s, task *t, const char *why);

/// Cancel it and forget what it made. False: there is no such job.
bool jobs_forget(server *s, const char *id);

/// How many wait before it.
int32_t jobs_ahead(const server *s, const task *t);

const char *job_state_name(job_state state);

/// What is known of a job, as the API says it; NULL: no memory.
json_t *job_json(const server *s, const task *t);

void jobs_free(server *s);

#endif
