// jali analyse PICTURE|MODEL: what a load does to a picture carved and left as it is, or to a plate from a
// model file.
#include "outputs.h"
#include "figures.h"
#include "structure.h"
#include "base/bytes.h"

#include <jali/model.h>
#include <math.h>
#include <stdlib.h>
#include <strings.h>

static bool is_model(const char *path)
{
    static const char *const suffix[] = {".stl", ".3mf", ".obj", ".ply", ".off"};
    const char *dot = strrchr(path, '.');
    for (int i = 0; dot && i < 5; i++)
        if (strcasecmp(dot, suffix[i]) == 0) return true;
    return false;
}

// The figures of a model: what was read, and its structure.
static jali_status model_json(jali_context *ctx, const settings *set, const jali_strength *s,
                              double thickness_mm, jali_bytes *json)
{
    json_t *figures = json_pack("{s:i, s:s, s:f, s:o, s:{s:b}}", "version", 1, "model", name_of(set->operand),
                                "thickness_mm", thickness_mm, "structure", structure_of(set, s), "promises",
                                "sound", s->sound);
    return append_json(ctx, figures, json);
}

// One analysis, as the only round of a strengthening that lays nothing.
static jali_status judge_model(jali_context *ctx, const settings *set, jali_result *r, double *thickness_mm)
{
    jali_status status;
    jali_mesh mesh = {0};
    jali_strength *s = &r->strength;
    jali_analyse_options opt = set->make.strengthen.analyse;
    jali_sheet_options fine = {.phi_s_mm = set->make.optimise.phi_s_mm,
                               .across = set->make.strengthen.across};
    opt.phi_s_mm = fine.phi_s_mm;
    TRY(jali_read_model(ctx, set->operand, NULL, &mesh));
    TRY(jali_sheet_plate_model(ctx, &mesh, &fine, &r->chart, thickness_mm, &s->sheet));
    TRY(jali_analyse(ctx, &s->sheet, &opt, &s->analysis));
    TRY(ALLOCATE(ctx, s->round, 1));
    s->round[s->round_count++] = (jali_strength_round){s->analysis.stress.value, s->analysis.raw_stress.value,
                                                       s->analysis.moved.value, 0, s->sheet.node_count};
    s->change_mpa = NAN;
    s->limit_mpa = opt.material.limit_mpa;
    s->sound = s->analysis.stress.value <= s->limit_mpa;
done:
    jali_mesh_free(ctx, &mesh);
    return status;
}

static jali_status analyse_model(jali_context *ctx, const settings *given)
{
    jali_status status;
    settings set = *given;
    jali_result r = {0};
    jali_bytes bytes[3] = {0};
    output out[3];
    int32_t count = 0;
    double thickness_mm;
    jali_support *support = &set.make.strengthen.analyse.support;
    if (*support == JALI_SUPPORT_PICTURE) *support = JALI_SUPPORT_RIM; // there is no picture
    set.make.strengthen.advise = false;
    if (set.report)
        TRY(fail(ctx, JALI_BAD_VALUE,
                 "--report is of a picture; a model gives --json, --map and --displacement-map"));
    TRY(judge_model(ctx, &set, &r, &thickness_mm));
    if (set.json) TRY(model_json(ctx, &set, &r.strength, thickness_mm, &bytes[count]));
    if (set.json) out[count] = (output){set.json, &bytes[count]}, count++;
    if (set.map) TRY(map_bytes(ctx, &r, set.map, JALI_STRESS, &bytes[count]));
    if (set.map) out[count] = (output){set.map, &bytes[count]}, count++;
    if (set.moved_map) TRY(map_bytes(ctx, &r, set.moved_map, JALI_DISPLACEMENT, &bytes[count]));
    if (set.moved_map) out[count] = (output){set.moved_map, &bytes[count]}, count++;
    TRY(write_outputs(ctx, out, count));
    say(&set, "a plate %.4g mm thick", thickness_mm);
    tell_structure(&set, &r.strength);
    if (!r.strength.sound)
        TRY(fail(ctx, JALI_BROKEN, "done, but a promise is not kept: it does not bear the load;"));
done:
    for (int32_t i = 0; i < 3; i++) jali_bytes_free(ctx, &bytes[i]);
    jali_result_free(ctx, &r);
    return status;
}

jali_status run_analyse(jali_context *ctx, const settings *set)
{
    if (!set->make.structure)
        return fail(
            ctx, JALI_BAD_VALUE,
            "there is no load to analyse; --force, --pressure, --weight, --push or --pinch gives one");
    if (set->petsc && strcmp(set->operand, "-") == 0)
        return fail(ctx, JALI_BAD_VALUE, "stdin reaches one process alone; --solver petsc needs a file");
    return is_model(set->operand) ? analyse_model(ctx, set) : analyse_picture(ctx, set);
}
