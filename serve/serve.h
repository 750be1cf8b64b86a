// The server's own types: what it keeps, who may touch it, how much of each there is.
//
// Threads: MHD runs one a connection; the main thread looks after the jobs' processes (dispatch.c).
// Everything in
//          `server` but the constants is touched under its lock, and `changed` says that something was.
#ifndef SERVE_SERVE_H
#define SERVE_SERVE_H

#include "blob.h"
#include "files.h"

#include <jansson.h>
#include <microhttpd.h>
#include <pthread.h>
#include <sys/types.h>

#ifdef JALI_HOOKS
enum { SMALL = 1 }; // the test build comes to its limits sooner
#else
enum { SMALL = 0 };
#endif

enum {
    TOKEN_BYTES = 33, // hexadecimal digits and an end mark, of tokens and of names of things
    MOST_CONNECTIONS = 128,
    MOST_UPLOADS = 256,
    MOST_JOBS = 512, // kept, finished ones too
    MOST_JSON_BYTES = 1 << 20,
    MOST_UPLOAD_BYTES = SMALL ? 1 << 21 : 1 << 27,
    MOST_KEPT_BYTES = SMALL ? 1 << 23 : 1 << 29, // of uploads, and as much of results
    MOST_CLIENT_BYTES = 64,
    MOST_NAME_BYTES = 128,
    MOST_MESSAGE_BYTES = 512,
    HEADER_SECONDS = SMALL ? 2 : 20, // to send a request's head
    BODY_SECONDS = SMALL ? 2 : 20,   // to send its body, and
    BODY_BYTES_A_SECOND = 1 << 20,   // a second more for so many bytes
    WAIT_SECONDS = 20,               // for a file that is not made yet
    HEARTBEAT_SECONDS = 5,           // of a stream of events without events
};

typedef struct upload {
    char id[TOKEN_BYTES];
    char name[MOST_NAME_BYTES + 1]; // of its file
    blob *bytes;
    uint64_t used; // the server's clock when it was last
} upload;

typedef enum job_state { JOB_QUEUED, JOB_RUNNING, JOB_DONE, JOB_FAILED } job_state;

typedef struct result_file {
    const job_file *file;
    blob *bytes;
    bool complete;
} result_file;

/// One job, from the request to its results.
typedef struct task {
    char id[TOKEN_BYTES];
    char client[MOST_CLIENT_BYTES + 1];
    job_state state;
    uint32_t version; // counts changes, so that a stream of events knows one
    uint64_t used;
    char picture_name[MOST_NAME_BYTES + 1];
    char *request;                          // JSON for the worker
    blob *picture, *mesh, *printer, *edits; // what it reads; all but the first may be NULL
    char stage[64];
    double fraction;
    int exit;
    char message[MOST_MESSAGE_BYTES];
    result_file file[MOST_JOB_FILES];
    int32_t file_count;
    double asked_at, started_at, ended_at; // seconds
} task;

/// A connection's patience: when it is cut off. 0 = it is we who keep it waiting.
typedef struct patience {
    int socket;
    double until;
    bool open;
} patience;

typedef struct server {
    // Constants once it runs.
    int port;
    char token[TOKEN_BYTES];
    const settings *set;
    int wake;                  // an eventfd: the main thread shall look
    char picture[TOKEN_BYTES]; // the upload that the command line named; "" = none

    pthread_mutex_t lock;
    pthread_cond_t changed;
    bool closing;
    uint64_t clock; // counts uses
    budget upload_budget, result_budget;
    upload upload[MOST_UPLOADS];
    task *task[MOST_JOBS]; // [task_count] in the order they came
    int32_t task_count;
    patience patience[MOST_CONNECTIONS + 1];
} server;

double seconds_now(void);

/// 128 bits from the system, as text. False: it has none.
bool random_id(char id[TOKEN_BYTES]);

/// Wake those who wait for events; under the lock.
void server_changed(server *s);

/// Wake the main thread.
void server_wake(server *s);

#endif
