// The page's files, out of the program.
#include "page.h"
#include "reply.h"

#include <libdeflate.h>
#include <stdlib.h>
#include <string.h>

static const char *type_of(const char *path)
{
    static const char *const types[][2] = {
        {".html", "text/html; charset=utf-8"},
        {".js", "text/javascript; charset=utf-8"},
        {".mjs", "text/javascript; charset=utf-8"},
        {".css", "text/css; charset=utf-8"},
        {".json", "application/json"},
        {".svg", "image/svg+xml"},
        {".png", "image/png"},
        {".ico", "image/x-icon"},
        {".woff2", "font/woff2"},
        {".webmanifest", "application/manifest+json"},
        {".txt", "text/plain; charset=utf-8"},
    };
    const char *dot = strrchr(path, '.');
    for (size_t i = 0; dot && i < sizeof types / sizeof *types; i++)
        if (strcmp(dot, types[i][0]) == 0) return types[i][1];
    return "application/octet-stream";
}

// For the few programs that do not take gzip.
static enum MHD_Result reply_unpacked(struct MHD_Connection *connection, const page_file *file)
{
    struct libdeflate_decompressor *unpacker = libdeflate_alloc_decompressor();
    void *text = malloc(file->whole_size + 1);
    struct MHD_Response *response = NULL;
    if (unpacker && text &&
        libdeflate_gzip_decompress(unpacker, file->gzip, file->size, text, file->whole_size, NULL) ==
            LIBDEFLATE_SUCCESS)
        response = MHD_create_response_from_buffer(file->whole_size, text, MHD_RESPMEM_MUST_FREE);
    if (unpacker) libdeflate_free_decompressor(unpacker);
    if (!response) free(text);
    return reply_with(connection, MHD_HTTP_OK, response, type_of(file->path));
}

enum MHD_Result page_reply(struct MHD_Connection *connection, const char *path)
{
    const char *taken = MHD_lookup_connection_value(connection, MHD_HEADER_KIND, "Accept-Encoding");
    if (strcmp(path, "/") == 0) path = "/index.html";
    for (int32_t i = 0; i < page_file_count; i++) {
        const page_file *file = &page_files[i];
        if (strcmp(file->path, path) != 0) continue;
        if (!taken || !strstr(taken, "gzip")) return reply_unpacked(connection, file);
        return reply_constant(connection, file->gzip, file->size, type_of(path), "gzip");
    }
    return reply_error(connection, MHD_HTTP_NOT_FOUND, "there is nothing here of that name");
}
