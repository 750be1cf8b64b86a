// jali sample NAME, jali list KIND.
#include "outputs.h"

#include <jali/sample.h>
#include <stdio.h>

jali_status run_sample(jali_context *ctx, const settings *set)
{
    jali_status status;
    jali_bitmap bitmap = {0};
    TRY(jali_sample(ctx, set->operand, set->size_px, &bitmap));
    TRY(write_bitmaps(ctx, set, &bitmap, 0));
done:
    jali_bitmap_free(ctx, &bitmap);
    return status;
}

jali_status run_list(jali_context *ctx, const settings *set)
{
    int32_t count;
    if (strcmp(set->operand, "samples") == 0) {
        const jali_sample_info *info = jali_sample_list(&count);
        for (int32_t i = 0; i < count; i++) printf("%-14s %s\n", info[i].name, info[i].what);
    } else if (strcmp(set->operand, "surfaces") == 0) {
        const jali_surface_info *info = jali_surface_list(&count);
        for (int32_t i = 0; i < count; i++) printf("%-14s %s\n", info[i].name, info[i].what);
    } else if (strcmp(set->operand, "materials") == 0) {
        const jali_material *material = jali_material_list(&count);
        for (int32_t i = 0; i < count; i++)
            printf("%-10s E %6g MPa, nu %.2f, %5.2f g/cm3, limit %5g MPa: %s\n", material[i].name,
                   material[i].e_mpa, material[i].nu, material[i].density_g_cm3, material[i].limit_mpa,
                   material[i].source);
    } else if (strcmp(set->operand, "printers") == 0) {
        return list_printers(ctx);
    } else {
        return fail(ctx, JALI_BAD_VALUE,
                    "there is no list of \"%.40s\"; there are samples, surfaces, materials and printers",
                    set->operand);
    }
    return JALI_OK;
}
