// What options take: numbers with their unit, names, lists, vectors, a camera, a push.
#include "values.h"

#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

bool wrong(char sentence[SENTENCE_BYTES], const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(sentence, SENTENCE_BYTES, format, arguments);
    va_end(arguments);
    return false;
}

static bool parse_number(const option *o, const char *text, double *number, char *sentence)
{
    char *end;
    *number = strtod(text, &end);
    if (end == text || !isfinite(*number))
        return wrong(sentence, "--%s takes a number, not \"%.40s\"", o->name, text);
    if (o->unit && strcmp(end, o->unit) == 0) end += strlen(end);
    if (*end != 0 && o->unit)
        return wrong(sentence, "--%s takes a number in %s, not \"%.40s\"", o->name, o->unit, text);
    if (*end != 0) return wrong(sentence, "--%s takes a number, not \"%.40s\"", o->name, text);
    if (*number < o->least || *number > o->most)
        return wrong(sentence, "--%s must be %g .. %g%s%s, not %.40s", o->name, o->least, o->most,
                     o->unit ? " " : "", o->unit ? o->unit : "", text);
    if (o->kind != NUMBER && *number != floor(*number))
        return wrong(sentence, "--%s takes a whole number, not %.40s", o->name, text);
    return true;
}

static bool parse_threshold(const option *o, const char *text, settings *set, char *sentence)
{
    double level = 0;
    if (strcmp(text, "auto") == 0)
        set->make.threshold.method = JALI_THRESHOLD_AUTO;
    else if (strcmp(text, "local") == 0)
        set->make.threshold.method = JALI_THRESHOLD_LOCAL;
    else {
        if (!parse_number(o, text, &level, sentence)) return false;
        set->make.threshold.method = JALI_THRESHOLD_FIXED;
        set->make.threshold.level = (int32_t)level;
    }
    return true;
}

// "1,2,3": whole numbers from `least` on, all of them.
static bool parse_list(const char *text, int32_t count, const int32_t *least, int32_t *number)
{
    for (int32_t i = 0; i < count; i++) {
        char *end;
        errno = 0;
        long one = strtol(text, &end, 10);
        if (end == text || errno || one < least[i] || one > 1 << 20) return false;
        if (*end != (i + 1 < count ? ',' : 0)) return false;
        number[i] = (int32_t)one;
        text = end + 1;
    }
    return true;
}

static bool parse_crop(const char *text, settings *set, char *sentence)
{
    if (parse_list(text, 4, (int32_t[]){0, 0, 1, 1}, set->read.crop_px)) return true;
    return wrong(sentence, "--crop takes left,top,width,height in pixels, not \"%.60s\"", text);
}

static bool parse_kernels(const char *text, settings *set, char *sentence)
{
    if (parse_list(text, 3, (int32_t[]){1, 1, 1}, set->make.optimise.kernels_px)) return true;
    return wrong(sentence, "--kernels takes omega_c,omega_w,omega_b in pixels, not \"%.60s\"", text);
}

static bool parse_rotate(const option *o, const char *text, settings *set, char *sentence)
{
    double degrees;
    if (!parse_number(o, text, &degrees, sentence)) return false;
    if ((int32_t)degrees % 90 != 0)
        return wrong(sentence, "--rotate takes 0, 90, 180 or 270, not %.40s", text);
    set->read.quarter_turns = (int32_t)degrees / 90;
    return true;
}

// One of three names, as the number of its place.
static bool parse_name(const char *option_name, const char *const name[3], const char *text, int32_t *number,
                       char *sentence)
{
    for (*number = 0; *number < 3; ++*number)
        if (strcmp(text, name[*number]) == 0) return true;
    return wrong(sentence, "--%s takes %s, %s or %s, not \"%.40s\"", option_name, name[0], name[1], name[2],
                 text);
}

static bool parse_progress(const char *text, settings *set, char *sentence)
{
    static const char *const names[] = {"auto", "plain", "none"};
    return parse_name("progress", names, text, &set->progress, sentence);
}

static bool parse_placing(const char *text, settings *set, char *sentence)
{
    static const char *const names[] = {"auto", "project", "wrap"};
    int32_t number;
    if (!parse_name("place", names, text, &number, sentence)) return false;
    set->make.place.placing = (jali_placing)number;
    return true;
}

// Three finite numbers with commas between them; *end is where they end.
static bool read_vector(const char *text, double vector[3], const char **end)
{
    for (int32_t k = 0; k < 3; k++) {
        char *after;
        vector[k] = strtod(text, &after);
        if (after == text || !isfinite(vector[k]) || fabs(vector[k]) > 1e6) return false;
        if (k < 2 && *after != ',') return false;
        text = k < 2 ? after + 1 : after;
    }
    *end = text;
    return true;
}

static bool parse_vector(const option *o, const char *text, double vector[3], char *sentence)
{
    const char *end;
    if (read_vector(text, vector, &end) && *end == 0) return true;
    return wrong(sentence, "--%s takes three numbers such as 0,-40,25, not \"%.60s\"", o->name, text);
}

// from=X,Y,Z, then to=X,Y,Z and fov=DEGREES in any order.
static bool parse_camera(const char *text, settings *set, char *sentence)
{
    jali_place_options *place = &set->make.place;
    const char *rest = text;
    place->camera.perspective = false;
    while (*rest) {
        bool fits = false;
        if (strncmp(rest, "from=", 5) == 0) {
            fits = place->camera.perspective = read_vector(rest + 5, place->camera.from, &rest);
        } else if (strncmp(rest, "to=", 3) == 0) {
            fits = place->at_given = read_vector(rest + 3, place->at_mm, &rest);
        } else if (strncmp(rest, "fov=", 4) == 0) {
            char *after;
            place->camera.fov_deg = strtod(rest + 4, &after);
            fits = after != rest + 4 && place->camera.fov_deg > 0 && place->camera.fov_deg < 170;
            rest = after;
        }
        if (!fits || (*rest && *rest++ != ','))
            return wrong(sentence, "--camera takes from=X,Y,Z[,to=X,Y,Z][,fov=DEGREES], not \"%.80s\"", text);
    }
    if (place->camera.perspective) return true;
    return wrong(sentence, "--camera needs from=X,Y,Z, where the eye is");
}

// X,Y,Z,N
static bool parse_push(const char *text, settings *set, char *sentence)
{
    jali_load *load = &set->make.strengthen.analyse.load;
    const char *rest;
    char *end;
    if (read_vector(text, load->push_at_mm, &rest) && *rest == ',') {
        load->push_n = strtod(rest + 1, &end);
        if (end != rest + 1 && (*end == 0 || strcmp(end, "N") == 0) && isfinite(load->push_n)) return true;
    }
    return wrong(sentence, "--push takes a place and a force such as 0,-40,25,10, not \"%.60s\"", text);
}

static bool parse_material(const char *text, settings *set, char *sentence)
{
    int32_t count;
    const jali_material *list = jali_material_list(&count), *found = jali_material_find(text);
    char names[200] = "";
    if (found) {
        set->material = found;
        return true;
    }
    for (int32_t i = 0; i < count; i++)
        snprintf(names + strlen(names), sizeof names - strlen(names), "%s%s", i ? ", " : "", list[i].name);
    return wrong(sentence, "--material takes one of %s, not \"%.40s\"", names, text);
}

static bool parse_support(const char *text, settings *set, char *sentence)
{
    static const char *const names[] = {"picture", "rim", "base"};
    int32_t number;
    if (!parse_name("support", names, text, &number, sentence)) return false;
    set->make.strengthen.analyse.support = (jali_support)number;
    return true;
}

static bool parse_reinforce(const char *text, settings *set, char *sentence)
{
    static const char *const names[] = {"best", "paper", "none"};
    int32_t number;
    if (!parse_name("reinforce", names, text, &number, sentence)) return false;
    set->make.strengthen.reinforce.rule = (jali_reinforcing)number;
    return true;
}

static bool parse_solver(const char *text, settings *set, char *sentence)
{
    set->petsc = strcmp(text, "petsc") == 0;
    if (set->petsc || strcmp(text, "direct") == 0) return true;
    return wrong(sentence, "--solver takes direct or petsc, not \"%.40s\"", text);
}

static bool add_output(const char *text, settings *set, char *sentence)
{
    if (set->output_count == MOST_OUTPUTS)
        return wrong(sentence, "at most %d output files can be given", MOST_OUTPUTS);
    set->output[set->output_count++] = text;
    return true;
}

bool set_option(const option *o, const char *text, settings *set, char *sentence)
{
    void *field = (char *)set + o->offset;
    double number = 0;
    if (text && *text == 0) return wrong(sentence, "--%s needs a value (%s)", o->name, o->value);
    switch (o->kind) {
    case FLAG: *(bool *)field = true; return true;
    case FLAG_OFF: *(bool *)field = false; return true;
    case TEXT: *(const char **)field = text; return true;
    case OUTPUT: return add_output(text, set, sentence);
    case THRESHOLD: return parse_threshold(o, text, set, sentence);
    case KERNELS: return parse_kernels(text, set, sentence);
    case CROP: return parse_crop(text, set, sentence);
    case ROTATE: return parse_rotate(o, text, set, sentence);
    case PROGRESS: return parse_progress(text, set, sentence);
    case PLACING: return parse_placing(text, set, sentence);
    case CAMERA: return parse_camera(text, set, sentence);
    case MATERIAL: return parse_material(text, set, sentence);
    case SUPPORT: return parse_support(text, set, sentence);
    case PUSH: return parse_push(text, set, sentence);
    case REINFORCE: return parse_reinforce(text, set, sentence);
    case SOLVER: return parse_solver(text, set, sentence);
    case VECTOR: return parse_vector(o, text, field, sentence);
    case AT: return set->make.place.at_given = parse_vector(o, text, set->make.place.at_mm, sentence);
    case NUMBER:
        if (!parse_number(o, text, &number, sentence)) return false;
        *(double *)field = number;
        return true;
    default:
        if (!parse_number(o, text, &number, sentence)) return false;
        *(int32_t *)field = (int32_t)number;
        return true;
    }
}
