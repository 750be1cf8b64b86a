// Which of all spans are worth an exact look: the stress that a beam alone would take off, with a guess at
// its flexibility: how far its ends move under all of the load.
//
// In batches: worths side by side, then a contest for each hot spot and width side by side, each in the order
// of the spans. Checked: tests/test_reinforce.c.
#include "reinforce/sieve.h"
#include "reinforce/plank.h"
#include "base/vector.h"

#include <math.h>

enum { WIDTHS = 4, MOST_PLACES = 16, BATCH = 4096 };

static const double times_wider[WIDTHS] = {1, 2, 4, 8};

static double length_of(const double v[6])
{
    return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

double visible_pixels(const span *s, const rank_options *opt)
{
    return fmax(1, s->length_mm * s->width_mm / (opt->pixel_mm * opt->pixel_mm));
}

// The force a unit of each mode's deformation without the beam, F guessed; by a visible pixel.
static void guess_forces(const beam *b, const span *s, const outlook *now, const rank_options *opt,
                         double force[BEAM_MODES])
{
    double softness = 4 * (length_of(now->u[b->node[0]]) + length_of(now->u[b->node[3]])) / now->load_n;
    for (int m = 0; m < b->mode_count; m++) {
        // A turn's softness: that of a place which a force moves so far a length away.
        bool turns = m == 0 || m == 1 || m == 3;
        double f = turns ? softness / (s->length_mm * s->length_mm + s->width_mm * s->width_mm) : softness;
        force[m] = 1 / (1 / b->stiffness[m] + f) / visible_pixels(s, opt);
    }
}

// Least distance between two straight connectors, each at nine places.
double spans_apart(const jali_sheet *sheet, const span *a, const span *b)
{
    enum { PLACES = 8 };
    double least2 = INFINITY;
    for (int i = 0; i <= PLACES; i++)
        for (int j = 0; j <= PLACES; j++) {
            double sum = 0;
            for (int k = 0; k < 3; k++) {
                double p = sheet->node[a->node[0]][k] +
                           (sheet->node[a->node[1]][k] - sheet->node[a->node[0]][k]) * i / PLACES;
                double q = sheet->node[b->node[0]][k] +
                           (sheet->node[b->node[1]][k] - sheet->node[b->node[0]][k]) * j / PLACES;
                sum += (p - q) * (p - q);
            }
            least2 = fmin(least2, sum);
        }
    return sqrt(least2);
}

static bool same_place(const jali_sheet *sheet, const span *a, const span *b)
{
    if (a->width_mm != b->width_mm) return false;
    double straight = fmax(distance(sheet->node[a->node[0]], sheet->node[b->node[0]]),
                           distance(sheet->node[a->node[1]], sheet->node[b->node[1]]));
    double turned = fmax(distance(sheet->node[a->node[0]], sheet->node[b->node[1]]),
                         distance(sheet->node[a->node[1]], sheet->node[b->node[0]]));
    return fmin(straight, turned) < 2 * a->width_mm;
}

// The best so far, the best first.
typedef struct podium {
    int32_t count, places;
    span best[MOST_PLACES];
} podium;

// Take a span in when it is among the best; of those in one place only the best stays.
static void compete(const jali_sheet *sheet, const borders *loops, podium *p, const span *s)
{
    int32_t at = p->count;
    if (s->worth <= 0 || (at == p->places && s->worth <= p->best[at - 1].worth)) return;
    if (!plank_has_room(sheet, loops, s)) return;
    for (int32_t i = 0; i < p->count; i++)
        if (same_place(sheet, s, &p->best[i])) {
            if (s->worth <= p->best[i].worth) return;
            memmove(p->best + i, p->best + i + 1, (size_t)(--p->count - i) * sizeof *p->best);
            i--;
        }
    p->count -= p->count == p->places;
    for (at = p->count++; at > 0 && p->best[at - 1].worth < s->worth; at--) p->best[at] = p->best[at - 1];
    p->best[at] = *s;
}

// The spans of a batch, and what each would be worth for each hot spot in each width.
typedef struct sieving {
    const jali_sheet *sheet;
    const borders *loops;
    const spans *all;
    const jali_material *material;
    bool bending_only;
    const outlook *now;
    const rank_options *opt;
    int32_t first, count;
    double (*worth)[MOST_HOTSPOTS][WIDTHS]; // [BATCH]
    podium *podium;                         // [hotspot_count * WIDTHS]
} sieving;

// Deformations are the same in every width.
static void guess_worths(void *shared, int32_t index)
{
    const sieving *v = shared;
    const outlook *now = v->now;
    beam b;
    span s = v->all->span[v->first + index];
    double moved[BEAM_MODES], influence[BEAM_MODES], force[WIDTHS][BEAM_MODES];
    s.width_mm = v->opt->width_mm;
    beam_along(v->sheet, v->loops, &s, v->material, v->bending_only, &b);
    beam_deformation(&b, now->u, moved);
    for (int w = 0; w < WIDTHS; w++) {
        s.width_mm = times_wider[w] * v->opt->width_mm;
        beam_stiffen(&b, v->material, s.width_mm);
        guess_forces(&b, &s, now, v->opt, force[w]);
        for (int m = 0; m < b.mode_count; m++) force[w][m] *= moved[m];
    }
    for (int32_t h = 0; h < now->hotspot_count; h++) {
        beam_deformation(&b, now->adjoint[h], influence);
        for (int w = 0; w < WIDTHS; w++) {
            v->worth[index][h][w] = 0;
            for (int m = 0; m < b.mode_count; m++) v->worth[index][h][w] += influence[m] * force[w][m];
        }
    }
}

static void hold_contest(void *shared, int32_t index)
{
    const sieving *v = shared;
    int32_t hotspot = index / WIDTHS, width = index % WIDTHS;
    for (int32_t i = 0; i < v->count; i++) {
        span s = v->all->span[v->first + i];
        s.width_mm = times_wider[width] * v->opt->width_mm;
        s.worth = v->worth[i][hotspot][width];
        compete(v->sheet, v->loops, &v->podium[index], &s);
    }
}

jali_status sieve_spans(jali_context *ctx, const jali_sheet *sheet, const borders *loops, const spans *all,
                        const jali_material *material, bool bending_only, const outlook *now,
                        const rank_options *opt, span best[SIEVED], int32_t *count)
{
    jali_status status;
    int32_t podiums = WIDTHS * now->hotspot_count, shares = WIDTHS * (now->hotspot_count + 1);
    sieving v = {sheet, loops, all, material, bending_only, now, opt, 0, 0, NULL, NULL};
    *count = 0;
    TRY(ALLOCATE(ctx, v.worth, BATCH));
    TRY(ALLOCATE(ctx, v.podium, podiums));
    for (int32_t k = 0; k < podiums; k++)
        v.podium[k] = (podium){.places = MIN((k < WIDTHS ? 2 : 1) * SIEVED / shares, MOST_PLACES)};
    for (v.first = 0; v.first < all->count; v.first += BATCH) {
        v.count = MIN(all->count - v.first, BATCH);
        parallel(ctx, v.count, guess_worths, &v);
        parallel(ctx, podiums, hold_contest, &v);
    }
    for (int32_t k = 0; k < podiums; k++)
        for (int32_t i = 0; i < v.podium[k].count; i++) {
            bool taken = false;
            for (int32_t j = 0; j < *count && !taken; j++)
                taken = same_place(sheet, &v.podium[k].best[i], &best[j]);
            if (!taken) best[(*count)++] = v.podium[k].best[i];
        }
done:
    release(ctx, v.worth);
    release(ctx, v.podium);
    return status;
}
