// Output files.
#include "outputs.h"
#include "options.h"
#include "structure.h"
#include "base/file.h"
#include "raster/raster.h"
#include "sparse/solver.h"

#include <jali/png.h>
#include <stdio.h>
#include <sys/stat.h>
#include <unistd.h>

enum { LONGEST_SUFFIX = 8, LIST_BYTES = 96 };

const char *suffix_of(const verb *v, const char *path)
{
    if (strcmp(path, "-") == 0) return v->suffixes;
    const char *slash = strrchr(path, '/'), *dot = strrchr(slash ? slash : path, '.');
    return dot ? dot : "";
}

// The verb's suffixes stand one after the other: ".3mf.stl".
static bool knows_suffix(const verb *v, const char *suffix)
{
    char dotted[LONGEST_SUFFIX + 2], known[64];
    size_t length = strlen(suffix);
    if (length < 2 || length > LONGEST_SUFFIX) return false;
    snprintf(dotted, sizeof dotted, "%s.", suffix);
    snprintf(known, sizeof known, "%s.", v->suffixes);
    return strcasestr(known, dotted) != NULL;
}

static bool same_file(const char *a, const char *b)
{
    struct stat one, other;
    if (strcmp(a, b) == 0) return true;
    return stat(a, &one) == 0 && stat(b, &other) == 0 && one.st_dev == other.st_dev &&
           one.st_ino == other.st_ino;
}

// ".3mf.stl" as ".3mf, .stl".
static void list_suffixes(const char *suffixes, char list[LIST_BYTES])
{
    size_t at = 0;
    for (const char *c = suffixes; *c && at + 4 < LIST_BYTES; c++) {
        if (*c == '.' && c > suffixes) at += (size_t)snprintf(list + at, LIST_BYTES - at, ", ");
        list[at++] = *c;
    }
    list[at] = 0;
}

static bool check_output(const verb *v, const settings *set, const char *path, char *sentence)
{
    struct stat old;
    char list[LIST_BYTES];
    bool standard = strcmp(path, "-") == 0;
    list_suffixes(v->suffixes, list);
    if (!standard && !knows_suffix(v, suffix_of(v, path)))
        snprintf(sentence, SENTENCE_BYTES, "%s: jali %s does not write this type; it writes %s", path,
                 v->name, list);
    else if (standard && isatty(STDOUT_FILENO))
        snprintf(sentence, SENTENCE_BYTES, "stdout is a terminal; send it to a file or a program");
    else if (!standard && set->operand && same_file(path, set->operand))
        snprintf(sentence, SENTENCE_BYTES, "%s is the input; the output needs another name", path);
    else if (!standard && !set->force_overwrite && stat(path, &old) == 0 && S_ISREG(old.st_mode))
        snprintf(sentence, SENTENCE_BYTES, "%s exists; --force-overwrite replaces it", path);
    else
        return true;
    return false;
}

static bool check_output_beside(const settings *set, const char *path, char *sentence)
{
    struct stat old;
    if (!path || strcmp(path, "-") == 0) return true;
    if (set->operand && same_file(path, set->operand))
        snprintf(sentence, SENTENCE_BYTES, "%s is the input; the output needs another name", path);
    else if (!set->force_overwrite && stat(path, &old) == 0 && S_ISREG(old.st_mode))
        snprintf(sentence, SENTENCE_BYTES, "%s exists; --force-overwrite replaces it", path);
    else
        return true;
    return false;
}

bool check_outputs(const verb *v, const settings *set, char *sentence)
{
    const char *path[MOST_OUTPUTS + OUTPUTS_BESIDE];
    int32_t count = 0;
    for (int32_t i = 0; i < set->output_count; i++) {
        if (!check_output(v, set, set->output[i], sentence)) return false;
        path[count++] = set->output[i];
    }
    size_t length = set->render ? strlen(set->render) : 0;
    if (length && strcmp(set->render, "-") != 0 &&
        (length < 4 || strcasecmp(set->render + length - 4, ".png") != 0)) {
        snprintf(sentence, SENTENCE_BYTES, "%s: --render writes a PNG, so its name ends in .png",
                 set->render);
        return false;
    }
    const char *const maps[] = {set->map, set->moved_map};
    for (int32_t i = 0; i < 2; i++)
        if (maps[i] && !is_map(maps[i])) {
            snprintf(sentence, SENTENCE_BYTES, "%s: a map is a .png, .ply or .vtu", maps[i]);
            return false;
        }
    const char *const beside[] = {set->json,   set->report, set->bridges,
                                  set->render, set->map,    set->moved_map};
    for (int32_t i = 0; i < OUTPUTS_BESIDE; i++) {
        if (!check_output_beside(set, beside[i], sentence)) return false;
        if (beside[i]) path[count++] = beside[i];
    }
    for (int32_t i = 0; i < count; i++)
        for (int32_t k = 0; k < i; k++)
            if (same_file(path[i], path[k])) {
                snprintf(sentence, SENTENCE_BYTES, "%s is named twice as an output", path[i]);
                return false;
            }
    return true;
}

jali_status write_outputs(jali_context *ctx, const output *out, int32_t count)
{
    jali_status status = JALI_OK;
    output_file file[MOST_FILES] = {0};
    if (!solver_leads()) return JALI_OK;
    for (int32_t i = 0; i < count; i++) TRY(output_open(ctx, out[i].path, &file[i]));
    for (int32_t i = 0; i < count; i++)
        TRY(output_write(ctx, &file[i], out[i].bytes->data, out[i].bytes->size));
    for (int32_t i = 0; i < count; i++) TRY(output_commit(ctx, &file[i]));
done:
    for (int32_t i = 0; i < count; i++) output_abandon(ctx, &file[i]);
    return status;
}

jali_status without_margin(jali_context *ctx, const jali_bitmap *mask, int32_t margin, jali_bitmap *picture)
{
    jali_status status =
        jali_bitmap_create(ctx, mask->width_px - 2 * margin, mask->height_px - 2 * margin, picture);
    if (status != JALI_OK) return status;
    cut_out(ctx, mask, margin, margin, picture);
    return JALI_OK;
}

jali_status write_bitmaps(jali_context *ctx, const settings *set, const jali_bitmap *bitmap, double pixel_mm)
{
    jali_status status;
    jali_bytes png = {0};
    output out[MOST_OUTPUTS];
    TRY(jali_bitmap_png(ctx, bitmap, pixel_mm, &png));
    for (int32_t i = 0; i < set->output_count; i++) out[i] = (output){set->output[i], &png};
    TRY(write_outputs(ctx, out, set->output_count));
done:
    jali_bytes_free(ctx, &png);
    return status;
}
