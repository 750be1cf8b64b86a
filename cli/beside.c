// Where files of this program lie: told from where the program itself does, so an installed tree may be
// moved.
#include "beside.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

bool path_beside(int32_t place, const char *name, char path[PATH_MAX])
{
    static const char *const places[] = {"", JALI_LIBEXEC "/"};
    char folder[PATH_MAX];
    ssize_t length = readlink("/proc/self/exe", folder, sizeof folder - 1);
    if (length <= 0 || place >= (int32_t)(sizeof places / sizeof *places)) return false;
    folder[length] = 0;
    *strrchr(folder, '/') = 0;
    int written = snprintf(path, PATH_MAX, "%s/%s%s", folder, places[place], name);
    return written > 0 && written < PATH_MAX;
}
