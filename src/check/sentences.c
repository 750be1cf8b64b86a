// The report of a check, in plain sentences and as JSON.
#include <jali/check.h>

#include "base/bytes.h"

#include <jansson.h>
#include <math.h>
#include <stdlib.h>

typedef struct flaw {
    const jali_finding *found;
    const char *one, *many; // what is said of one and of several
} flaw;

static jali_status say_flaw(jali_context *ctx, const flaw *f, const char *at_least, jali_bytes *text)
{
    if (f->found->count == 0) return JALI_OK;
    const double *at = f->found->at_mm;
    return bytes_print(ctx, text, "%s%lld %s; %s at (%.6g, %.6g, %.6g) mm.\n", at_least,
                       (long long)f->found->count, f->found->count == 1 ? f->one : f->many,
                       f->found->count == 1 ? "it is" : "the first is", at[0], at[1], at[2]);
}

static jali_status say_thickness(jali_context *ctx, const jali_thickness *t, const char *what,
                                 const char *how, jali_bytes *text)
{
    const double *at = t->at_mm;
    if (!t->measured) return JALI_OK;
    if (!(t->thinnest_mm < INFINITY)) return bytes_print(ctx, text, "There is no %s to measure.\n", what);
    return bytes_print(
        ctx, text,
        "The %s %s measures %.3g mm, at (%.5g, %.5g, %.5g) mm; the %s hundredth of all up to %.3g "
        "mm.\n",
        how, what, t->thinnest_mm, at[0], at[1], at[2], how, t->percentile1_mm);
}

static jali_status say_measures(jali_context *ctx, const jali_check_report *r, jali_bytes *text)
{
    jali_status status;
    TRY(bytes_print(ctx, text, "%d vertices, %d triangles; %.6g x %.6g x %.6g mm, area %.6g mm2", r->vertices,
                    r->triangles, r->high_mm[0] - r->low_mm[0], r->high_mm[1] - r->low_mm[1],
                    r->high_mm[2] - r->low_mm[2], r->area_mm2));
    if (r->closed) TRY(bytes_print(ctx, text, ", volume %.6g mm3", r->volume_mm3));
    TRY(bytes_print(ctx, text, ".\n%d piece%s", r->pieces, r->pieces == 1 ? "" : "s"));
    if (r->voids) TRY(bytes_print(ctx, text, ", %d inner void%s", r->voids, r->voids == 1 ? "" : "s"));
    if (r->genus >= 0)
        TRY(bytes_print(ctx, text, ", %lld hole%s through", (long long)r->genus, r->genus == 1 ? "" : "s"));
    TRY(bytes_print(ctx, text, ".\n"));
    if (r->repeated_vertices)
        TRY(bytes_print(ctx, text,
                        "%d vertices stand at the place of an earlier one and were taken as one.\n",
                        r->repeated_vertices));
    TRY(say_thickness(ctx, &r->walls, "wall", "thinnest", text));
    TRY(say_thickness(ctx, &r->gaps, "gap", "narrowest", text));
    if (!r->coordinates_exact)
        TRY(bytes_print(ctx, text, "The coordinates span more than 60 bits and were rounded to %.3g mm.\n",
                        ldexp(1, r->unit_log2)));
done:
    return status;
}

jali_status jali_check_sentences(jali_context *ctx, const jali_check_report *r, jali_bytes *text)
{
    jali_status status;
    const flaw flaws[] = {
        {&r->open_edges, "edge is open (in one triangle only)", "edges are open (in one triangle only)"},
        {&r->crowded_edges, "edge is in more than two triangles", "edges are in more than two triangles"},
        {&r->crowded_vertices, "vertex joins parts that meet nowhere else",
         "vertices join parts that meet nowhere else"},
        {&r->repeated_triangles, "triangle is there twice", "triangles are there twice"},
        {&r->misdirected_edges, "edge has triangles that face opposite ways",
         "edges have triangles that face opposite ways"},
        {&r->misplaced_shells, "shell is inside out or lies within solid",
         "shells are inside out or lie within solid"},
        {&r->degenerate_triangles, "triangle has no area", "triangles have no area"},
    };
    const flaw crossing = {&r->intersections, "pair of triangles intersects", "pairs of triangles intersect"};
    TRY(say_measures(ctx, r, text));
    for (size_t i = 0; i < sizeof flaws / sizeof *flaws; i++) TRY(say_flaw(ctx, &flaws[i], "", text));
    TRY(say_flaw(ctx, &crossing, r->intersections_capped ? "At least " : "", text));
    if (r->intersections_skipped) TRY(bytes_print(ctx, text, "Self-intersections were not looked for.\n"));
    if (r->triangles == 0)
        TRY(bytes_print(ctx, text, "The mesh is empty.\n"));
    else if (r->solid)
        TRY(bytes_print(ctx, text, "The mesh is a solid: closed, manifold, outward%s.\n",
                        r->intersections_skipped ? "" : ", free of self-intersections"));
    else
        TRY(bytes_print(ctx, text, "The mesh is not a sound solid.\n"));
done:
    return status;
}

static json_t *json_point(const double at[3])
{
    return json_pack("[fff]", at[0], at[1], at[2]);
}

static json_t *json_finding(const jali_finding *f, bool at_least)
{
    json_t *object = json_pack("{sI so}", "count", (json_int_t)f->count, "first_mm",
                               f->count ? json_point(f->at_mm) : json_null());
    if (at_least) json_object_set_new(object, "at_least", json_true());
    return object;
}

static json_t *json_thickness(const jali_thickness *t)
{
    if (!t->measured) return json_null();
    if (!(t->thinnest_mm < INFINITY))
        return json_pack("{sn sn sn}", "thinnest_mm", "at_mm", "percentile1_mm");
    return json_pack("{sf so sf}", "thinnest_mm", t->thinnest_mm, "at_mm", json_point(t->at_mm),
                     "percentile1_mm", t->percentile1_mm);
}

// NULL when memory runs out anywhere: half a report would pass for a whole one.
static json_t *json_report(const jali_check_report *r)
{
    bool whole = true;
    json_t *o =
        json_pack("{si sb sb sb sb sb sb}", "version", 1, "closed", r->closed, "manifold", r->manifold,
                  "oriented", r->oriented, "clean", r->clean, "apart", r->apart, "solid", r->solid);
    json_t *counts =
        json_pack("{si si si si si si si sI}", "vertices", r->vertices, "triangles", r->triangles, "edges",
                  r->edges, "repeated_vertices", r->repeated_vertices, "pieces", r->pieces, "shells",
                  r->shells, "voids", r->voids, "euler", (json_int_t)r->euler);
    json_t *measures =
        json_pack("{sf sf s{so so} sf sb}", "volume_mm3", r->volume_mm3, "area_mm2", r->area_mm2, "bounds_mm",
                  "low", json_point(r->low_mm), "high", json_point(r->high_mm), "unit_mm",
                  ldexp(1, r->unit_log2), "coordinates_exact", r->coordinates_exact);
    const struct {
        const char *key;
        const jali_finding *found;
    } findings[] = {
        {"open_edges", &r->open_edges},
        {"crowded_edges", &r->crowded_edges},
        {"crowded_vertices", &r->crowded_vertices},
        {"misdirected_edges", &r->misdirected_edges},
        {"misplaced_shells", &r->misplaced_shells},
        {"degenerate_triangles", &r->degenerate_triangles},
        {"repeated_triangles", &r->repeated_triangles},
    };
    whole &= json_object_update(o, counts) == 0;
    whole &= json_object_set_new(o, "genus", r->genus >= 0 ? json_integer(r->genus) : json_null()) == 0;
    for (size_t i = 0; i < sizeof findings / sizeof *findings; i++)
        whole &= json_object_set_new(o, findings[i].key, json_finding(findings[i].found, false)) == 0;
    json_t *crossings =
        r->intersections_skipped ? json_null() : json_finding(&r->intersections, r->intersections_capped);
    whole &= json_object_set_new(o, "self_intersections", crossings) == 0;
    whole &= json_object_update(o, measures) == 0;
    whole &= json_object_set_new(o, "walls", json_thickness(&r->walls)) == 0;
    whole &= json_object_set_new(o, "gaps", json_thickness(&r->gaps)) == 0;
    json_decref(counts);
    json_decref(measures);
    if (!whole) json_decref(o);
    return whole ? o : NULL;
}

jali_status jali_check_json(jali_context *ctx, const jali_check_report *report, jali_bytes *json)
{
    json_t *object = json_report(report);
    char *text = object ? json_dumps(object, JSON_INDENT(2) | JSON_REAL_PRECISION(15)) : NULL;
    jali_status status = text ? bytes_append(ctx, json, text, strlen(text))
                              : fail(ctx, JALI_NO_MEMORY, "no memory for the report");
    free(text);
    json_decref(object);
    return status;
}
