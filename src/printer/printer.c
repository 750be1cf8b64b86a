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

jali_status profile_in_our_form(jali_context *ctx, const jali_bytes *file, const char *name, json_t **ours)
{
    json_error_t error;
    *ours = json_loadb((const char *)file->data, file->size, JSON_REJECT_DUPLICATES, &error);
    if (json_is_object(*ours) && json_is_integer(json_object_get(*ours, "jali_printer"))) {
        if (json_integer_value(json_object_get(*ours, "jali_printer")) == 1) return JALI_OK;
        json_decref(*ours);
        *ours = NULL;
        return fail(ctx, JALI_BAD_INPUT, "the printer profile %.100s is of a later kind: 1 is accepted",
                    name);
    }
    json_decref(*ours);
    *ours = NULL;
    return fail(
        ctx, JALI_BAD_INPUT,
        "%.100s is no printer profile: a JSON object with \"jali_printer\": 1 is accepted (line %d: %.100s)",
        name, error.line, error.text);
}
