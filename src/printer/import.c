// Other programs' profiles in our form: PrusaSlicer's configuration, Orca's and Bambu Studio's JSON.
//
// Method:  a file becomes an object of texts, key by key; what says something of widths, sizes and material
// is
//          taken from it, each figure with how it was derived. Slicers do not know what comes out of the
//          machine: phi_e and phi_v are inherited from the built-in profile of the nearest nozzle, or of a
//          resin printer.
// Limits:  one profile a file, no bundles; what an Orca profile inherits lies in a file of Orca's that we do
// not
//          have, and is said to be missing.
// Checked: tests/test_printer.c.
#include "printer/profile.h"
#include "base/number.h"

#include <ctype.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <strings.h>

/// A profile on its way.
typedef struct foreign {
    const json_t *settings; // texts by key
    const char *slicer, *name;
    json_t *ours;
} foreign;

// --- Files as texts by key

/// Some characters of a file.
typedef struct stretch {
    const char *first, *end;
} stretch;

static bool is_space(char c)
{
    return c == ' ' || c == '\t' || c == '\r';
}

static stretch trimmed(stretch s)
{
    while (s.first < s.end && is_space(*s.first)) s.first++;
    while (s.first < s.end && is_space(*(s.end - 1))) s.end--;
    return s;
}

// `key = value`, also behind the `;` of a comment in G-code. False when the line says nothing of the kind.
static bool split_line(stretch line, stretch *key, stretch *value)
{
    line = trimmed(line);
    while (line.first < line.end && *line.first == ';') line.first++;
    const char *equals = memchr(line.first, '=', (size_t)(line.end - line.first));
    if (!equals) return false;
    *key = trimmed((stretch){line.first, equals});
    *value = trimmed((stretch){equals + 1, line.end});
    for (const char *c = key->first; c < key->end; c++)
        if (!isalnum((unsigned char)*c) && *c != '_') return false;
    return key->end > key->first && key->end - key->first < JALI_NAME_BYTES;
}

static bool begins_section(stretch line)
{
    return line.end - line.first > 1 && *line.first == '[' && isalpha((unsigned char)line.first[1]);
}

jali_status settings_of_ini(jali_context *ctx, const jali_bytes *file, const char *name, json_t **settings)
{
    char key_text[JALI_NAME_BYTES];
    const char *at = file->size > 0 ? (const char *)file->data : "", *end = at + file->size;
    stretch key, value;
    *settings = json_object();
    while (at < end) {
        const char *line_end = memchr(at, '\n', (size_t)(end - at));
        stretch line = {at, line_end ? line_end : end};
        at = line_end ? line_end + 1 : end;
        if (begins_section(line)) {
            json_decref(*settings);
            *settings = NULL;
            return fail(ctx, JALI_BAD_INPUT,
                        "%.100s is a bundle of several profiles; export a single configuration (in "
                        "PrusaSlicer: File, "
                        "Export, Export Config)",
                        name);
        }
        if (!split_line(line, &key, &value)) continue;
        snprintf(key_text, sizeof key_text, "%.*s", (int)(key.end - key.first), key.first);
        json_t *text = json_stringn(value.first, (size_t)(value.end - value.first)); // NULL when no UTF-8
        if (text) json_object_set_new(*settings, key_text, text);
    }
    return *settings ? JALI_OK : fail(ctx, JALI_NO_MEMORY, "no memory for a printer profile");
}

// Values may be lists of texts: joined by commas, as PrusaSlicer writes them.
jali_status settings_of_orca(jali_context *ctx, const json_t *profile, json_t **settings)
{
    jali_status status = JALI_OK;
    const char *key;
    json_t *value;
    jali_bytes joined = {0};
    *settings = json_object();
    json_object_foreach((json_t *)profile, key, value)
    {
        joined.size = 0;
        if (json_is_string(value)) TRY(bytes_print(ctx, &joined, "%s", json_string_value(value)));
        for (size_t i = 0; i < json_array_size(value); i++) {
            const char *item = json_string_value(json_array_get(value, i));
            if (item) TRY(bytes_print(ctx, &joined, "%s%s", joined.size > 0 ? "," : "", item));
        }
        if (joined.size > 0)
            json_object_set_new(*settings, key, json_stringn((const char *)joined.data, joined.size));
    }
    if (!*settings) status = fail(ctx, JALI_NO_MEMORY, "no memory for a printer profile");
done:
    if (status != JALI_OK) {
        json_decref(*settings);
        *settings = NULL;
    }
    jali_bytes_free(ctx, &joined);
    return status;
}

// --- What they say

// The text of the first key that says something; NULL when none does.
static const char *setting(const foreign *f, const char *key, const char *other_key)
{
    const char *text = json_string_value(json_object_get(f->settings, key));
    if (text && *text && strcmp(text, "nil")) return text;
    return other_key ? setting(f, other_key, NULL) : NULL;
}

// The number a text begins with, the first of a list; NaN when the key is not there. A percentage is a share
// of `whole`.
static jali_status number_of(jali_context *ctx, const foreign *f, const char *key, const char *other_key,
                             double whole, double *number)
{
    const char *text = setting(f, key, other_key), *at = text;
    *number = NAN;
    if (!text) return JALI_OK;
    if (!read_decimal(&at, text + strlen(text), number) || (*at && *at != '%' && *at != ',' && *at != ';'))
        return fail(ctx, JALI_BAD_INPUT, "the %s profile %.100s: \"%s\" is \"%.40s\"; a number is accepted",
                    f->slicer, f->name, setting(f, key, NULL) ? key : other_key, text);
    if (*at == '%') *number *= whole / 100;
    return JALI_OK;
}

static void put_figure(foreign *f, const char *key, double value, const char *format, ...)
    __attribute__((format(printf, 4, 5)));

static void put_figure(foreign *f, const char *key, double value, const char *format, ...)
{
    char source[JALI_SOURCE_BYTES];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(source, sizeof source, format, arguments);
    va_end(arguments);
    json_object_set_new(f->ours, key, json_pack("{s:f, s:s}", "value", value, "source", source));
}

static jali_status take_layer(jali_context *ctx, foreign *f)
{
    double layer_mm;
    jali_status status = number_of(ctx, f, "layer_height", NULL, 1, &layer_mm);
    if (layer_mm > 0) put_figure(f, "layer_mm", layer_mm, "%s, %.60s: layer_height", f->slicer, f->name);
    return status;
}

// The sides of the box around "0x0,250x0,250x210,0x210".
static bool read_bed(const char *text, double side_mm[2])
{
    double least[2] = {INFINITY, INFINITY}, most[2] = {-INFINITY, -INFINITY};
    const char *end = text + strlen(text);
    while (text < end) {
        for (int32_t k = 0; k < 2; k++) {
            double at_mm;
            if (!read_decimal(&text, end, &at_mm)) return false;
            least[k] = fmin(least[k], at_mm);
            most[k] = fmax(most[k], at_mm);
            if (k == 0 && (text >= end || *text++ != 'x')) return false;
        }
        if (text < end && *text++ != ',') return false;
    }
    for (int32_t k = 0; k < 2; k++) side_mm[k] = most[k] - least[k];
    return side_mm[0] > 0 && side_mm[1] > 0;
}

static jali_status take_bed(jali_context *ctx, foreign *f)
{
    jali_status status;
    double side_mm[2], height_mm;
    const char *shape = setting(f, "bed_shape", "printable_area");
    TRY(number_of(ctx, f, "max_print_height", "printable_height", 1, &height_mm));
    if (!shape || !(height_mm > 0)) goto done;
    if (!read_bed(shape, side_mm))
        return fail(ctx, JALI_BAD_INPUT,
                    "the %s profile %.100s: its bed is \"%.60s\"; points such as 0x0,250x0 are "
                    "accepted",
                    f->slicer, f->name, shape);
    char source[JALI_SOURCE_BYTES];
    snprintf(source, sizeof source, "%s, %.60s: the box around its bed, and its height", f->slicer, f->name);
    json_object_set_new(
        f->ours, "bed_mm",
        json_pack("{s:[f, f, f], s:s}", "value", side_mm[0], side_mm[1], height_mm, "source", source));
done:
    return status;
}

// Ours, by the slicer's word for it; the first of a list. What we do not know is left to the inherited
// profile.
static void take_material(foreign *f)
{
    char word[JALI_NAME_BYTES];
    const char *type = setting(f, "filament_type", NULL);
    if (!type) return;
    snprintf(word, sizeof word, "%.*s", (int)strcspn(type, ",;"), type);
    const jali_material *known = jali_material_find(word);
    if (known) json_object_set_new(f->ours, "material", json_string(known->name));
}

// The width of an outer line: as set, or the slicer's own choice for a nozzle.
static jali_status line_width(jali_context *ctx, const foreign *f, double nozzle_mm, double layer_mm,
                              double *width_mm)
{
    jali_status status;
    bool orca = setting(f, "outer_wall_line_width", "line_width") != NULL;
    double whole = orca ? nozzle_mm : layer_mm; // PrusaSlicer's percentages are of the layer's height
    TRY(number_of(ctx, f, "external_perimeter_extrusion_width", "outer_wall_line_width", whole, width_mm));
    if (!(*width_mm > 0)) TRY(number_of(ctx, f, "extrusion_width", "line_width", whole, width_mm));
    if (!(*width_mm > 0)) *width_mm = 1.125 * nozzle_mm; // what both choose for 0
done:
    return status;
}

// The narrowest solid that the slicer makes lines for.
static jali_status take_narrowest(jali_context *ctx, foreign *f, double nozzle_mm)
{
    jali_status status;
    double least_mm, width_mm, layer_mm;
    const char *generator = setting(f, "perimeter_generator", "wall_generator");
    const char *thin = setting(f, "thin_walls", "detect_thin_wall");
    TRY(number_of(ctx, f, "min_bead_width", NULL, nozzle_mm, &least_mm));
    TRY(number_of(ctx, f, "layer_height", NULL, 1, &layer_mm));
    TRY(line_width(ctx, f, nozzle_mm, layer_mm, &width_mm));
    if (generator && strcmp(generator, "arachne") == 0) {
        if (!(least_mm > 0)) least_mm = 0.85 * nozzle_mm;
        if (least_mm > 0)
            put_figure(f, "phi_s_mm", least_mm,
                       "%s, %.60s: min_bead_width, to which Arachne widens what is narrower, down to a "
                       "quarter of the "
                       "nozzle",
                       f->slicer, f->name);
    } else if (thin && strcmp(thin, "1") == 0 && nozzle_mm > 0) {
        put_figure(f, "phi_s_mm", nozzle_mm, "%s, %.60s: thin walls are single lines, as wide as the nozzle",
                   f->slicer, f->name);
    } else if (width_mm > 0) {
        put_figure(f, "phi_s_mm", 2 * width_mm,
                   "%s, %.60s: two outer lines of %g mm, the least it makes a wall of", f->slicer, f->name,
                   width_mm);
    }
done:
    return status;
}

// --- The two kinds of machine

// The built-in profile of the nearest nozzle.
static const char *base_of_nozzle(double nozzle_mm)
{
    static const struct {
        double below_mm;
        const char *name;
    } base[] = {{0.325, "fdm-0.25"}, {0.5, "fdm-0.4"}, {0.7, "fdm-0.6"}, {INFINITY, "fdm-0.8"}};
    int32_t i = 0;
    while (nozzle_mm >= base[i].below_mm) i++;
    return base[i].name;
}

static jali_status import_fdm(jali_context *ctx, foreign *f, const char **base)
{
    jali_status status;
    double nozzle_mm, width_mm = NAN;
    TRY(number_of(ctx, f, "nozzle_diameter", NULL, 1, &nozzle_mm));
    bool known = !isnan(nozzle_mm);
    if (!known) {
        TRY(line_width(ctx, f, NAN, NAN, &width_mm));
        nozzle_mm = width_mm > 0 ? width_mm / 1.125 : 0.4;
    }
    if (known)
        put_figure(f, "tool_mm", nozzle_mm, "%s, %.60s: nozzle_diameter", f->slicer, f->name);
    else
        put_figure(f, "tool_mm", nozzle_mm, "assumed%s: %.60s does not say the nozzle's diameter",
                   width_mm > 0 ? " from the width of a line, 1.125 nozzles" : "", f->name);
    *base = base_of_nozzle(nozzle_mm);
    if (known || width_mm > 0) TRY(take_narrowest(ctx, f, nozzle_mm));
    take_material(f);
done:
    return status;
}

static jali_status import_sla(jali_context *ctx, foreign *f, const char **base)
{
    jali_status status;
    double wide_mm, wide_px;
    *base = "msla";
    TRY(number_of(ctx, f, "display_width", NULL, 1, &wide_mm));
    TRY(number_of(ctx, f, "display_pixels_x", NULL, 1, &wide_px));
    if (wide_mm > 0 && wide_px > 0)
        put_figure(f, "tool_mm", wide_mm / wide_px, "%s, %.60s: display_width over display_pixels_x",
                   f->slicer, f->name);
done:
    return status;
}

// What it is called, and where it comes from.
static void take_name(foreign *f, const char *base)
{
    char what[JALI_SOURCE_BYTES];
    const char *name = setting(f, "printer_settings_id", "name"), *inherits = setting(f, "inherits", NULL);
    if (name && strlen(name) < JALI_NAME_BYTES) json_object_set_new(f->ours, "name", json_string(name));
    snprintf(what, sizeof what, "from %s; phi_e, phi_v and what else it does not say are those of %s",
             f->slicer, base);
    if (inherits && strlen(inherits) < 60)
        snprintf(what + strlen(what), sizeof what - strlen(what),
                 "; it inherits \"%s\", which is not at hand", inherits);
    json_object_set_new(f->ours, "what", json_string(what));
}

jali_status import_slicer(jali_context *ctx, const json_t *settings, const char *slicer, const char *name,
                          json_t **ours)
{
    jali_status status;
    const char *slash = strrchr(name, '/'), *base;
    foreign f = {settings, slicer, slash ? slash + 1 : name, json_object()};
    const char *technology = setting(&f, "printer_technology", NULL);
    bool sla = technology && strcasecmp(technology, "SLA") == 0;
    *ours = NULL;
    TRY(sla ? import_sla(ctx, &f, &base) : import_fdm(ctx, &f, &base));
    TRY(take_layer(ctx, &f));
    TRY(take_bed(ctx, &f));
    take_name(&f, base);
    json_object_set_new(f.ours, "jali_printer", json_integer(1));
    json_object_set_new(f.ours, "inherits", json_string(base));
    if (!f.ours) status = fail(ctx, JALI_NO_MEMORY, "no memory for a printer profile");
    *ours = f.ours;
    f.ours = NULL;
done:
    json_decref(f.ours);
    return status;
}
