// jali smallest PICTURE: the smallest size at which nothing of it is lost.
#include "figures.h"
#include "outputs.h"

static json_t *tries_of(const jali_smallest *s)
{
    json_t *tries = json_array();
    for (int32_t i = 0; i < s->try_count; i++) {
        const jali_smallest_try *t = &s->tried[i];
        json_array_append_new(tries, json_pack("{s:f, s:f, s:b, s:o, s:b}", "width_mm", t->width_mm,
                                               "pixel_mm", t->pixel_mm, "coarse", t->coarse, "lost",
                                               t->pixel_mm > 0 ? lost_of(&t->white, &t->black) : json_null(),
                                               "whole", t->whole));
    }
    return tries;
}

static json_t *millimetres(double mm)
{
    return mm > 0 ? json_real(mm) : json_null();
}

static jali_status smallest_json(jali_context *ctx, const settings *set, const jali_picture *picture,
                                 const jali_smallest *s, jali_bytes *json)
{
    double shape = (double)picture->height_px / picture->width_px;
    return append_json(ctx,
                       json_pack("{s:i, s:{s:i, s:i}, s:o, s:{s:o, s:o, s:o, s:b, s:i, s:o}}", "version", 1,
                                 "input", "width_px", picture->width_px, "height_px", picture->height_px,
                                 "printer", printer_of(set), "smallest", "width_mm", millimetres(s->width_mm),
                                 "height_mm", millimetres(s->width_mm * shape), "confirmed_mm",
                                 millimetres(s->confirmed_mm), "monotone", s->monotone, "speck_px",
                                 set->smallest.least_px, "tried", tries_of(s)),
                       json);
}

static void tell_tries(const settings *set, const jali_smallest *s)
{
    for (int32_t i = 0; i < s->try_count; i++) {
        const jali_smallest_try *t = &s->tried[i];
        if (t->whole)
            say(set, "%6.1f mm: nothing is lost", t->width_mm);
        else if (t->pixel_mm > 0)
            say(set, "%6.1f mm: lost are %d solid and %d void parts, %d solid and %d void stretches of lines",
                t->width_mm, t->white.parts, t->black.parts, t->white.stretches, t->black.stretches);
        else
            say(set, "%6.1f mm: nothing of it would print", t->width_mm);
    }
}

static jali_status answer(jali_context *ctx, const settings *set, const jali_picture *picture,
                          const jali_smallest *s)
{
    jali_status status;
    jali_bytes json = {0};
    tell_tries(set, s);
    if (set->json) {
        TRY(smallest_json(ctx, set, picture, s, &json));
        TRY(write_outputs(ctx, &(output){set->json, &json}, 1));
    }
    if (s->width_mm == 0)
        say(set, "something is lost at every width up to %g mm", set->smallest.most_mm);
    else
        say(set, "nothing is lost from a width of %.4g mm on%s", s->width_mm,
            s->monotone ? "" : "; the sizes between lose something that a smaller one keeps");
    status = JALI_OK;
done:
    jali_bytes_free(ctx, &json);
    return status;
}

jali_status run_smallest(jali_context *ctx, const settings *set)
{
    jali_status status;
    jali_picture picture = {0};
    jali_smallest s;
    TRY(load_picture(ctx, set, &picture));
    TRY(jali_find_smallest(ctx, &picture, &set->make, &set->smallest, &s));
    TRY(answer(ctx, set, &picture, &s));
done:
    jali_picture_free(ctx, &picture);
    return status;
}
