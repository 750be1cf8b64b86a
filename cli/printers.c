// The user's printer: --printer, what it means for the other options, jali printer and jali list printers.
#include "outputs.h"
#include "base/bytes.h"

#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

jali_status printers_folder(jali_context *ctx, jali_bytes *folder)
{
    jali_status status = JALI_OK;
    const char *config = getenv("XDG_CONFIG_HOME"), *home = getenv("HOME");
    if (config && *config == '/') // the specification ignores paths that are not absolute
        TRY(bytes_print(ctx, folder, "%s/jali/printers", config));
    else if (home && *home)
        TRY(bytes_print(ctx, folder, "%s/.config/jali/printers", home));
    if (folder->size > 0) TRY(bytes_append(ctx, folder, "", 1));
done:
    return status;
}

// What the options say outright takes the profile's place.
static void give_figure(double given, const char *option, jali_figure *figure)
{
    if (isnan(given)) return;
    memset(figure, 0, sizeof *figure);
    figure->value = given;
    snprintf(figure->source, sizeof figure->source, "%s", option);
}

jali_status settle_printer(jali_context *ctx, settings *set)
{
    jali_status status = JALI_OK;
    jali_bytes folder = {0};
    jali_printer *p = &set->make.printer;
    jali_optimise_options *optimise = &set->make.optimise;
    double *const phi_mm[3] = {&optimise->phi_e_mm, &optimise->phi_s_mm, &optimise->phi_v_mm};
    jali_material *material = &set->make.strengthen.analyse.material, of_printer;
    if (set->printer) {
        TRY(printers_folder(ctx, &folder));
        TRY(jali_printer_find(ctx, set->printer, (const char *)folder.data, p));
        give_figure(set->phi_given_mm[0], "--phi-e", &p->phi_e_solid_mm);
        give_figure(set->phi_given_mm[0], "--phi-e", &p->phi_e_void_mm);
        give_figure(set->phi_given_mm[1], "--phi-s", &p->phi_s_mm);
        give_figure(set->phi_given_mm[2], "--phi-v", &p->phi_v_mm);
        *phi_mm[0] = jali_printer_phi_e_mm(p);
        *phi_mm[1] = p->phi_s_mm.value;
        *phi_mm[2] = p->phi_v_mm.value;
        if (jali_printer_material(p, &of_printer)) *material = of_printer;
    }
    for (int32_t i = 0; i < 3; i++)
        if (!isnan(set->phi_given_mm[i])) *phi_mm[i] = set->phi_given_mm[i];
    if (set->material) *material = *set->material;
    if (set->limit_mpa > 0) material->limit_mpa = set->limit_mpa;
done:
    jali_bytes_free(ctx, &folder);
    return status;
}

// --- The printers there are

static int is_profile(const struct dirent *entry)
{
    const char *dot = strrchr(entry->d_name, '.');
    return entry->d_name[0] != '.' && dot && strcmp(dot, ".json") == 0;
}

typedef void see_printer(void *user, const char *folder, const char *file, const jali_printer *printer);

// The user's own, by name.
static jali_status each_own(jali_context *ctx, const char *folder, see_printer *see, void *user)
{
    jali_status status = JALI_OK;
    struct dirent **entry = NULL;
    int count = scandir(folder, &entry, is_profile, alphasort);
    for (int i = 0; i < count; i++) {
        jali_printer p;
        jali_bytes path = {0};
        if (status == JALI_OK) status = bytes_print(ctx, &path, "%s/%s%c", folder, entry[i]->d_name, 0);
        if (status == JALI_OK) {
            bool read = jali_printer_find(ctx, (const char *)path.data, folder, &p) == JALI_OK;
            see(user, folder, entry[i]->d_name, read ? &p : NULL);
        }
        jali_bytes_free(ctx, &path);
        free(entry[i]);
    }
    free(entry);
    return status;
}

jali_status each_printer(jali_context *ctx, see_printer *see, void *user)
{
    jali_status status = JALI_OK;
    jali_bytes folder = {0};
    int32_t count;
    const char *const *name = jali_printer_names(&count);
    for (int32_t i = 0; i < count; i++) {
        jali_printer p;
        TRY(jali_printer_find(ctx, name[i], NULL, &p));
        see(user, NULL, name[i], &p);
    }
    TRY(printers_folder(ctx, &folder));
    if (folder.size > 0) TRY(each_own(ctx, (const char *)folder.data, see, user));
done:
    jali_bytes_free(ctx, &folder);
    return status;
}

// --- jali printer

jali_status run_printer(jali_context *ctx, const settings *set)
{
    jali_status status;
    jali_bytes folder = {0}, json = {0};
    jali_printer printer;
    output out[MOST_OUTPUTS];
    TRY(printers_folder(ctx, &folder));
    TRY(jali_printer_find(ctx, set->operand, (const char *)folder.data, &printer));
    TRY(jali_printer_write(ctx, &printer, &json));
    for (int32_t i = 0; i < set->output_count; i++) out[i] = (output){set->output[i], &json};
    TRY(write_outputs(ctx, out, set->output_count));
    say(set, "%s: phi %.3g / %.3g / %.3g mm; %s", printer.name, jali_printer_phi_e_mm(&printer),
        printer.phi_s_mm.value, printer.phi_v_mm.value, printer.what);
done:
    jali_bytes_free(ctx, &folder);
    jali_bytes_free(ctx, &json);
    return status;
}

// --- jali list printers

typedef struct printing {
    jali_context *ctx;
    bool own; // their heading is printed
} printing;

static void print_printer(void *user, const char *folder, const char *file, const jali_printer *p)
{
    printing *state = user;
    if (folder && !state->own) printf("\nin %s:\n", folder);
    state->own = folder != NULL;
    if (p)
        printf("%-16s %-7s phi %5.3g / %4.3g / %4.3g mm  %s\n", p->name, jali_process_name(p->process),
               jali_printer_phi_e_mm(p), p->phi_s_mm.value, p->phi_v_mm.value, p->what);
    else
        printf("%-16s cannot be read: %s\n", file, jali_message(state->ctx));
}

jali_status list_printers(jali_context *ctx)
{
    printing state = {.ctx = ctx};
    return each_printer(ctx, print_printer, &state);
}
