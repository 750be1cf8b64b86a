// Files: read whole under a limit; written so that nobody ever sees half of one.
//
// Writing:  a temporary name in the same folder, fsync, rename, fsync of the folder. Until the rename the
//           earlier file is untouched; after it the new one is complete. A killed process leaves only *.part
//           behind.
// In memory: a run with jali_files opens nothing at all.
// Limits:   devices and pipes cannot be renamed over, so they are written straight.
// Checked:  tests/test_write.c: full disk, unwritable folder, cancel, links, modes.
#include "base/file.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

enum { PIECE_BYTES = 1 << 22, NAMES_TRIED = 100 };

static jali_status refused(jali_context *ctx, const char *verb, const char *name, int reason)
{
    char text[128];
    return fail(ctx, JALI_IO, "cannot %s %s: %s", verb, name, strerror_r(reason, text, sizeof text));
}

const jali_file *file_in_memory(jali_context *ctx, const char *name)
{
    const jali_files *files = files_of(ctx);
    for (int32_t i = 0; i < files->count; i++)
        if (strcmp(files->file[i].name, name) == 0) return &files->file[i];
    fail(ctx, JALI_IO, "cannot read %.200s: this run opens no files but those it was given", name);
    return NULL;
}

bool file_exists(jali_context *ctx, const char *path)
{
    if (files_of(ctx)) return file_in_memory(ctx, path) != NULL;
    return access(path, F_OK) == 0;
}

static jali_status copy_text(jali_context *ctx, const char *text, size_t extra, char **copy)
{
    size_t length = strlen(text);
    jali_status status = ALLOCATE(ctx, *copy, length + extra + 1);
    if (status == JALI_OK) memcpy(*copy, text, length + 1);
    return status;
}

// A fresh name beside the target. Not mkstemp: its 0600 would outlive the rename.
static int open_beside(const char *target, char *temporary, size_t room, mode_t mode)
{
    size_t length = strlen(target);
    for (int32_t i = 0; i < NAMES_TRIED; i++) {
        snprintf(temporary + length, room, ".%ld-%d.part", (long)getpid(), i);
        int descriptor = open(temporary, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode);
        if (descriptor >= 0 || errno != EEXIST) return descriptor;
    }
    return -1;
}

jali_status output_open(jali_context *ctx, const char *path, output_file *file)
{
    enum { SUFFIX_BYTES = 48 };
    jali_status status = JALI_OK;
    char resolved[PATH_MAX];
    struct stat old;
    *file = (output_file){.descriptor = -1, .name = path};
    file->in_memory = files_of(ctx) != NULL;
    if (file->in_memory) return JALI_OK;
    if (strcmp(path, "-") == 0) {
        file->name = "stdout";
        file->descriptor = STDOUT_FILENO;
        file->open = true;
        return JALI_OK;
    }
    bool exists = stat(path, &old) == 0;
    if (exists && S_ISDIR(old.st_mode)) return refused(ctx, "write", path, EISDIR);
    if (exists && !S_ISREG(old.st_mode)) {
        file->descriptor = open(path, O_WRONLY | O_CLOEXEC);
        if (file->descriptor < 0) return refused(ctx, "write", path, errno);
        file->open = true;
        return JALI_OK;
    }
    // The rename would pass over a write protection that a plain open respects.
    if (exists && access(path, W_OK) != 0) return refused(ctx, "write", path, errno);
    TRY(copy_text(ctx, exists && realpath(path, resolved) ? resolved : path, 0, &file->target));
    TRY(copy_text(ctx, file->target, SUFFIX_BYTES, &file->temporary));
    file->descriptor = open_beside(file->target, file->temporary, SUFFIX_BYTES, 0666);
    if (file->descriptor < 0) {
        int reason = errno;
        release(ctx, file->temporary);
        file->temporary = NULL; // it is not ours: nothing to remove
        TRY(refused(ctx, "write", path, reason));
    }
    file->open = true;
    if (exists) (void)!fchmod(file->descriptor, old.st_mode & 07777);
done:
    if (status != JALI_OK) output_abandon(ctx, file);
    return status;
}

jali_status output_write(jali_context *ctx, output_file *file, const void *data, size_t size)
{
    const char *at = data;
    while (size > 0) {
        jali_status status = step(ctx, "write", 0);
        if (status != JALI_OK) return status;
        if (file->in_memory) {
            const jali_files *files = files_of(ctx);
            if (!files->take(files->user, file->name, at, size))
                return fail(ctx, JALI_IO, "there is no room for %.200s", file->name);
            return JALI_OK;
        }
        ssize_t written = write(file->descriptor, at, MIN(size, (size_t)PIECE_BYTES));
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) return refused(ctx, "write", file->name, errno);
        at += written;
        size -= (size_t)written;
    }
    return JALI_OK;
}

// The folder's entry is durable only once the folder is; some file systems refuse this, which is no failure.
static void sync_folder_of(char *path)
{
    char *slash = strrchr(path, '/');
    char kept = 0;
    if (slash) {
        kept = slash[1];
        slash[1] = 0;
    }
    int folder = open(slash ? path : ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (slash) slash[1] = kept;
    if (folder < 0) return;
    fsync(folder);
    close(folder);
}

jali_status output_commit(jali_context *ctx, output_file *file)
{
    jali_status status = JALI_OK;
    const jali_files *files = files_of(ctx);
    if (file->in_memory && !files->take(files->user, file->name, NULL, 0))
        TRY(fail(ctx, JALI_IO, "there is no room for %.200s", file->name));
    if (file->target) {
        if (fsync(file->descriptor) != 0) TRY(refused(ctx, "write", file->name, errno));
        file->open = false;
        if (close(file->descriptor) != 0) TRY(refused(ctx, "write", file->name, errno));
        if (rename(file->temporary, file->target) != 0) TRY(refused(ctx, "write", file->name, errno));
        sync_folder_of(file->target);
        release(ctx, file->temporary);
        file->temporary = NULL;
    }
done:
    output_abandon(ctx, file);
    return status;
}

void output_abandon(jali_context *ctx, output_file *file)
{
    if (file->open && file->descriptor != STDOUT_FILENO) close(file->descriptor);
    if (file->temporary) unlink(file->temporary);
    release(ctx, file->temporary);
    release(ctx, file->target);
    *file = (output_file){.descriptor = -1};
}

jali_status file_write(jali_context *ctx, const char *path, const void *data, size_t size)
{
    jali_status status;
    output_file file = {0};
    TRY(output_open(ctx, path, &file));
    TRY(output_write(ctx, &file, data, size));
    TRY(output_commit(ctx, &file));
done:
    if (status != JALI_OK) output_abandon(ctx, &file);
    return status;
}

static jali_status too_large(jali_context *ctx, const char *name, size_t limit_bytes)
{
    return fail(ctx, JALI_LIMIT, "%s is larger than the limit of %.0f MB", name, (double)limit_bytes / 1e6);
}

static jali_status read_descriptor(jali_context *ctx, int descriptor, const char *name, size_t limit_bytes,
                                   jali_bytes *bytes)
{
    jali_status status = JALI_OK;
    struct stat known;
    if (fstat(descriptor, &known) != 0) return refused(ctx, "read", name, errno);
    if (S_ISDIR(known.st_mode)) return refused(ctx, "read", name, EISDIR);
    if (S_ISREG(known.st_mode)) TRY(bytes_reserve(ctx, bytes, MIN((size_t)known.st_size, limit_bytes) + 2));
    for (;;) {
        TRY(step(ctx, "read", 0));
        if (bytes->capacity - bytes->size < 2) TRY(bytes_reserve(ctx, bytes, 1 << 16));
        size_t room = MIN(bytes->capacity - bytes->size - 1, (size_t)PIECE_BYTES);
        ssize_t got = read(descriptor, bytes->data + bytes->size, room);
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) TRY(refused(ctx, "read", name, errno));
        bytes->size += (size_t)got;
        if (bytes->size > limit_bytes) TRY(too_large(ctx, name, limit_bytes));
        if (got == 0) break;
    }
    bytes->data[bytes->size] = 0;
done:
    return status;
}

static jali_status copy_file(jali_context *ctx, const char *name, size_t limit_bytes, jali_bytes *bytes)
{
    const jali_file *file = file_in_memory(ctx, name);
    if (!file) return JALI_IO;
    if (file->size > limit_bytes) return too_large(ctx, name, limit_bytes);
    jali_status status = bytes_reserve(ctx, bytes, file->size + 1);
    if (status != JALI_OK) return status;
    memcpy(bytes->data, file->data, file->size);
    bytes->size = file->size;
    bytes->data[bytes->size] = 0;
    return JALI_OK;
}

jali_status file_read(jali_context *ctx, const char *path, size_t limit_bytes, jali_bytes *bytes)
{
    *bytes = (jali_bytes){0};
    if (files_of(ctx)) return copy_file(ctx, path, limit_bytes, bytes);
    bool standard = strcmp(path, "-") == 0;
    int descriptor = standard ? STDIN_FILENO : open(path, O_RDONLY | O_CLOEXEC);
    if (descriptor < 0) return refused(ctx, "read", path, errno);
    jali_status status = read_descriptor(ctx, descriptor, standard ? "stdin" : path, limit_bytes, bytes);
    if (!standard) close(descriptor);
    if (status != JALI_OK) jali_bytes_free(ctx, bytes);
    return status;
}
