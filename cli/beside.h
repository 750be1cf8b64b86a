// Files that belong to this program: beside it in the build tree, in libexec once installed.
#ifndef CLI_BESIDE_H
#define CLI_BESIDE_H

#include <limits.h>
#include <stdbool.h>
#include <stdint.h>

/// The path of such a file in the place'th place to look at, from 0 on; false: there are no more.
bool path_beside(int32_t place, const char *name, char path[PATH_MAX]);

#endif
