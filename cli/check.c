// jali check MODEL: is it a solid? Sentences on stdout, the figures as JSON where asked for.
#include "outputs.h"
#include "base/bytes.h"

#include <jali/check.h>
#include <jali/model.h>
#include <stdio.h>

// What --json - writes takes stdout for itself.
static bool json_on_stdout(const settings *set)
{
    return set->json && strcmp(set->json, "-") == 0;
}

static jali_status tell(jali_context *ctx, const settings *set, const jali_check_report *report)
{
    jali_status status = JALI_OK;
    jali_bytes text = {0}, json = {0};
    if (set->json) {
        TRY(jali_check_json(ctx, report, &json));
        TRY(bytes_append(ctx, &json, "\n", 1));
        TRY(write_outputs(ctx, &(output){set->json, &json}, 1));
    }
    if (set->quiet || json_on_stdout(set)) goto done;
    TRY(jali_check_sentences(ctx, report, &text));
    fwrite(text.data, 1, text.size, stdout);
done:
    jali_bytes_free(ctx, &text);
    jali_bytes_free(ctx, &json);
    return status;
}

jali_status run_check(jali_context *ctx, const settings *set)
{
    jali_status status;
    jali_mesh mesh = {0};
    jali_check_report report;
    jali_check_options opt = jali_check_defaults();
    opt.skip_intersections = set->skip_intersections;
    opt.walls = set->walls;
    TRY(jali_read_model(ctx, set->operand, NULL, &mesh));
    TRY(jali_check(ctx, &mesh, &opt, &report));
    TRY(tell(ctx, set, &report));
    if (!report.solid) status = fail(ctx, JALI_BROKEN, "%s is not a solid", set->operand);
done:
    jali_mesh_free(ctx, &mesh);
    return status;
}
