// The page's files, in the program: web/dist as the build found it, compressed.
#ifndef SERVE_PAGE_H
#define SERVE_PAGE_H

#include "serve.h"

typedef struct page_file {
    const char *path; // "/index.html"
    const unsigned char *gzip;
    size_t size, whole_size; // compressed, and not
} page_file;

extern const page_file page_files[]; // [page_file_count], made by cmake/page.cmake
extern const int32_t page_file_count;

/// Answer with the file of this path; "/" is index.html. What is not in the list is not there.
enum MHD_Result page_reply(struct MHD_Connection *connection, const char *path);

#endif
