// What every part of jali shares: status codes, the context, and how to cancel.
#ifndef JALI_BASE_H
#define JALI_BASE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define JALI_API __attribute__((visibility("default")))

typedef enum jali_status {
    JALI_OK = 0,
    JALI_BAD_VALUE, // an option or argument is out of its range
    JALI_BAD_INPUT, // a picture or model is rejected; the message says what, where and what is accepted
    JALI_NO_RESULT, // a valid question without an answer; the message says what would help
    JALI_NO_MEMORY, // the allocator refused
    JALI_IO,        // the system refused to read or write
    JALI_LIMIT,     // a limit on memory, time or size was reached
    JALI_CANCELLED, // jali_cancel() was called
    JALI_BROKEN     // a self-check found that a promise is not kept
} jali_status;

/// Everything a run shares: allocator, threads, limits, progress, the last message. One context serves one
/// call at a time; several contexts may run side by side.
typedef struct jali_context jali_context;

/// A file that is in memory.
typedef struct jali_file {
    const char *name;
    const void *data; // [size]
    size_t size;
} jali_file;

/// Files in memory in place of the system's, for a run that may open none.
typedef struct jali_files {
    int32_t count;
    const jali_file *file; // [count] all there is to read
    // Takes what is written, piece by piece; a file is complete with a call that has no data. False: no room.
    bool (*take)(void *user, const char *name, const void *data, size_t size);
    void *user;
} jali_files;

typedef struct jali_context_options {
    int32_t threads;           // worker threads, >= 1; 0 (default) = one a processor. Never changes a result
    uint64_t max_memory_bytes; // refuse to hold more than this; 0 (default) = no limit
    double timeout_seconds;    // stop with JALI_LIMIT after this long; 0 (default) = no limit
    void *(*allocate)(void *user, size_t bytes); // NULL (default) = malloc. These two are called from any of
    void (*release)(void *user, void *block);    // the threads, one at a time; NULL (default) = free
    void (*progress)(void *user, const char *stage, double fraction); // called on the caller's thread
    void *user;                                                       // handed to the three functions above
    const jali_files *files; // no file is opened: these are read and written; NULL (default) = the system's.
                             // Must outlive the context, and may change between calls
} jali_context_options;

/// The defaults, each explained at its field.
JALI_API jali_context_options jali_context_defaults(void);

/// Create a context.
///   in     opt   NULL means the defaults
///   out    ctx   free with jali_context_free
///   fails  JALI_BAD_VALUE, JALI_NO_MEMORY (no message: there is no context to hold it)
JALI_API jali_status jali_context_create(const jali_context_options *opt, jali_context **ctx);
JALI_API void jali_context_free(jali_context *ctx);

/// The sentence that belongs to the last failure; "" when there was none.
JALI_API const char *jali_message(const jali_context *ctx);

/// Ask the running call to stop with JALI_CANCELLED. Safe from any thread and from a signal handler.
JALI_API void jali_cancel(jali_context *ctx);

/// Most bytes held at one time since the context was created.
JALI_API uint64_t jali_peak_memory_bytes(const jali_context *ctx);

/// The version as "major.minor.patch".
JALI_API const char *jali_version(void);

#ifdef __cplusplus
}
#endif
#endif
