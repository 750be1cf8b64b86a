// What a profile says, put to use; and what kind of file it came in.
#include "printer/profile.h"

double jali_printer_phi_e_mm(const jali_printer *printer)
{
    return (printer->phi_e_solid_mm.value + printer->phi_e_void_mm.value) / 2;
}

bool jali_printer_material(const jali_printer *p, jali_material *material)
{
    int32_t count;
    const jali_material *known = *p->material ? jali_material_find(p->material) : NULL;
    bool said = known || *p->e_mpa.source;
    *material = known ? *known : jali_material_list(&count)[0];
    if (*p->e_mpa.source)
        *material =
            (jali_material){p->material,        p->e_mpa.value,     p->nu.value, p->density_g_cm3.value,
                            p->limit_mpa.value, p->limit_mpa.source};
    return said;
}

const char *const *jali_printer_names(int32_t *count)
{
    *count = builtin_count;
    return builtin_name;
}

// A slicer's profile says at least one of these.
static bool is_slicers(const json_t *settings)
{
    static const char *const key[] = {"nozzle_diameter", "layer_height",         "printable_area",
                                      "bed_shape",       "filament_type",        "printer_technology",
                                      "line_width",      "outer_wall_line_width"};
    for (size_t i = 0; i < sizeof key / sizeof *key; i++)
        if (json_object_get(settings, key[i])) return true;
    return false;
}

static jali_status no_profile(jali_context *ctx, const char *name, const json_error_t *error)
{
    return fail(ctx, JALI_BAD_INPUT,
                "%.100s is no printer profile: a JSON object with \"jali_printer\": 1, a PrusaSlicer "
                "configuration or "
                "an Orca or Bambu Studio profile is accepted%s%.60s",
                name, error ? "; as JSON: " : "", error ? error->text : "");
}

static jali_status from_json(jali_context *ctx, const jali_bytes *file, const char *name, json_t **ours)
{
    jali_status status = JALI_OK;
    json_error_t error;
    json_t *settings = NULL,
           *root = json_loadb((const char *)file->data, file->size, JSON_REJECT_DUPLICATES, &error);
    json_t *kind = json_object_get(root, "jali_printer");
    if (!root)
        status = no_profile(ctx, name, &error);
    else if (kind && json_integer_value(kind) != 1)
        status = fail(ctx, JALI_BAD_INPUT,
                      "the printer profile %.100s is of another kind: \"jali_printer\": 1 is accepted", name);
    else if (kind)
        *ours = json_incref(root);
    else if (!is_slicers(root))
        status = no_profile(ctx, name, NULL);
    else {
        TRY(settings_of_orca(ctx, root, &settings));
        TRY(import_slicer(ctx, settings, "Orca or Bambu Studio", name, ours));
    }
done:
    json_decref(settings);
    json_decref(root);
    return status;
}

static jali_status from_ini(jali_context *ctx, const jali_bytes *file, const char *name, json_t **ours)
{
    jali_status status;
    json_t *settings = NULL;
    TRY(settings_of_ini(ctx, file, name, &settings));
    if (is_slicers(settings))
        TRY(import_slicer(ctx, settings, "PrusaSlicer", name, ours));
    else
        status = no_profile(ctx, name, NULL);
done:
    json_decref(settings);
    return status;
}

jali_status profile_in_our_form(jali_context *ctx, const jali_bytes *file, const char *name, json_t **ours)
{
    size_t first = 0;
    *ours = NULL;
    while (first < file->size && strchr(" \t\r\n", file->data[first])) first++;
    return first < file->size && file->data[first] == '{' ? from_json(ctx, file, name, ours)
                                                          : from_ini(ctx, file, name, ours);
}
