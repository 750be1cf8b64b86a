// The files a job can be asked for.
#ifndef SERVE_FILES_H
#define SERVE_FILES_H

#include "options.h"

enum {
    MOST_JOB_FILES = 24,
    // What a job may set, as far as its verb takes them.
    JOB_OPTIONS = GROUP_PICTURE | GROUP_SIZE | GROUP_GRID | GROUP_METHOD | GROUP_PLATE | GROUP_SURFACE |
                  GROUP_LOAD | GROUP_REINFORCE | GROUP_VIEW | GROUP_SIDE | GROUP_SMALLEST
};

typedef struct job_file {
    const char *name, *type; // the type as HTTP says it
    enum { BY_SUFFIX, BY_FIELD, BY_LAYER } how;
    size_t offset;    // BY_FIELD: of the name in the settings
    const char *verb; // that alone makes it; NULL: those that have a method do
} job_file;

/// All of them; NULL behind the last name.
const job_file *job_files(void);
const job_file *job_file_named(const char *name);

/// Ask for a file in the settings of a run, as -o, --json and the others do.
///   out    sentence  what is wrong, when false comes back
bool ask_for_file(const job_file *file, const verb *v, settings *set, char sentence[SENTENCE_BYTES]);

#endif
