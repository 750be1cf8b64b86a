// Bridges on a factored structure against a factor of the joined sheet.
//
// A whole sheet is cut: some rectangles of it are taken out and put back as bridges.
#include "testing.h"

#include "sheets.h"

#include "structure/attach.h"

static const facet_material plastic = {.e_mpa = 2300, .nu = 0.35};

enum { BRIDGES = 4, CELLS = 18, NODES = (CELLS + 1) * (CELLS + 1), TRIANGLES = 2 * CELLS * CELLS };

static double random_in(uint64_t *seed, double low, double high)
{
    return low + (high - low) * (double)(next_random(seed) >> 11) / 9007199254740992.0;
}

// A sheet, what is cut out of it, and the two as one.
typedef struct cut_sheet {
    jali_sheet whole, rest;
    int8_t part[TRIANGLES]; // which bridge a triangle of the whole belongs to; -1: none
    uint8_t held[NODES];
    double load[NODES][NODE_UNKNOWNS];      // all of it
    double rest_load[NODES][NODE_UNKNOWNS]; // without what bridges' own nodes carry
    bridge bridge[BRIDGES];
    int32_t node[BRIDGES][NODES]; // of the whole, by a bridge's numbers
    int32_t end[BRIDGES][NODES], triangle[BRIDGES][TRIANGLES][3];
    double own[BRIDGES][NODES][3], thickness[BRIDGES][NODES], carried[BRIDGES][NODES][NODE_UNKNOWNS];
} cut_sheet;

// Which rectangle of 2 x 4 cells a place lies in: four of them, apart from each other and from the rim.
static int part_at(const double middle[2])
{
    static const double corner[BRIDGES][2] = {{2, 3}, {8, 2}, {13, 12}, {3, 11}};
    for (int b = 0; b < BRIDGES; b++)
        if (middle[0] > corner[b][0] && middle[0] < corner[b][0] + 2 && middle[1] > corner[b][1] &&
            middle[1] < corner[b][1] + 4)
            return b;
    return -1;
}

static void draw_bridge(cut_sheet *c, int b, const bool *in_rest)
{
    int32_t number[NODES];
    bridge *d = &c->bridge[b];
    *d = (bridge){.end = c->end[b],
                  .own = (const double(*)[3])c->own[b],
                  .thickness_mm = c->thickness[b],
                  .triangle = (const int32_t(*)[3])c->triangle[b],
                  .load = (const double(*)[NODE_UNKNOWNS])c->carried[b]};
    for (int32_t i = 0; i < c->whole.node_count; i++) number[i] = -1;
    for (int pass = 0; pass < 2; pass++) // ends first
        for (int32_t t = 0; t < c->whole.triangle_count; t++)
            for (int k = 0; k < 3; k++) {
                int32_t n = c->whole.triangle[t][k];
                if (c->part[t] != b || number[n] >= 0 || in_rest[n] != (pass == 0)) continue;
                number[n] = d->end_count + d->own_count;
                c->node[b][number[n]] = n;
                if (pass == 0) {
                    c->end[b][d->end_count++] = n;
                    continue;
                }
                memcpy(c->own[b][d->own_count], c->whole.node[n], sizeof c->own[b][0]);
                c->thickness[b][d->own_count++] = c->whole.thickness_mm[n];
                memcpy(c->carried[b][number[n]], c->load[n], sizeof c->load[n]);
                memset(c->rest_load[n], 0, sizeof c->rest_load[n]);
            }
    for (int32_t t = 0; t < c->whole.triangle_count; t++)
        for (int k = 0; c->part[t] == b && k < 3; k++) {
            c->triangle[b][d->triangle_count][k] = number[c->whole.triangle[t][k]];
            d->triangle_count += k == 2;
        }
}

// The rest keeps the nodes of the whole, some without a triangle.
static cut_sheet *cut(uint64_t seed, double radius_mm)
{
    cut_sheet *c = calloc(1, sizeof *c);
    pierced_options o = {.cells = CELLS, .size_mm = CELLS, .thickness_mm = 1, .radius_mm = radius_mm};
    CHECK_OK(pierced_sheet(ctx, &o, &c->whole));
    jali_sheet *whole = &c->whole;
    for (int32_t t = 0; t < whole->triangle_count; t++) {
        double middle[2] = {0, 0};
        for (int k = 0; k < 3; k++) {
            const double *p = whole->node[whole->triangle[t][k]];
            middle[0] += (radius_mm > 0 ? radius_mm * atan2(p[0], p[2]) + CELLS / 2.0 : p[0]) / 3;
            middle[1] += p[1] / 3;
        }
        c->part[t] = (int8_t)part_at(middle);
    }
    for (int32_t i = 0; i < whole->node_count; i++) {
        for (int k = 0; k < (whole->flat ? 2 : 3); k++) whole->node[i][k] += random_in(&seed, -0.2, 0.2);
        whole->thickness_mm[i] = random_in(&seed, 0.7, 1.3);
        c->held[i] = whole->border[i] ? HELD_ALL : 0;
        for (int k = 0; k < NODE_UNKNOWNS; k++) c->load[i][k] = c->rest_load[i][k] = random_in(&seed, -1, 1);
    }
    c->rest = *whole;
    c->rest.triangle_count = 0;
    CHECK_OK(ALLOCATE(ctx, c->rest.triangle, TRIANGLES));
    return c;
}

// Leave out of the rest what belongs to these bridges (a bit each); draw them.
static void leave_out(cut_sheet *c, unsigned bridges)
{
    bool in_rest[NODES] = {false};
    c->rest.triangle_count = 0;
    memcpy(c->rest_load, c->load, sizeof c->load);
    for (int32_t t = 0; t < c->whole.triangle_count; t++) {
        if (c->part[t] >= 0 && bridges >> c->part[t] & 1) continue;
        memcpy(c->rest.triangle[c->rest.triangle_count++], c->whole.triangle[t], sizeof *c->rest.triangle);
        for (int k = 0; k < 3; k++) in_rest[c->whole.triangle[t][k]] = true;
    }
    for (int b = 0; b < BRIDGES; b++)
        if (bridges >> b & 1) draw_bridge(c, b, in_rest);
}

static void free_cut(cut_sheet *c)
{
    release(ctx, c->rest.triangle);
    drop_sheet(ctx, &c->whole);
    free(c);
}

typedef double displacements[NODES][NODE_UNKNOWNS];

// The answer by a factor: the whole without these bridges.
static void refactored(cut_sheet *c, unsigned without, bool bending_only, displacements u)
{
    structure s;
    leave_out(c, without);
    CHECK_OK(structure_create(ctx, &c->rest, &plastic, c->held, bending_only, &s));
    CHECK_OK(structure_solve(ctx, &s, 1, (const double(*)[NODE_UNKNOWNS])c->rest_load, u));
    structure_free(ctx, &s);
}

// Differences relative to the largest displacement and the largest rotation, over nodes that are in use.
static double difference(const cut_sheet *c, unsigned without, displacements u, displacements v)
{
    double most[2] = {0, 0}, apart[2] = {0, 0};
    for (int32_t t = 0; t < c->whole.triangle_count; t++)
        for (int k = 0; k < 3 * NODE_UNKNOWNS; k++) {
            int32_t n = c->whole.triangle[t][k / NODE_UNKNOWNS];
            int at = k % NODE_UNKNOWNS, kind = at >= 3;
            if (c->part[t] >= 0 && without >> c->part[t] & 1) continue;
            most[kind] = fmax(most[kind], fabs(u[n][at]));
            apart[kind] = fmax(apart[kind], fabs(u[n][at] - v[n][at]));
        }
    return fmax(apart[0] / most[0], apart[1] / most[1]);
}

// What the attachments say, at all nodes of the whole.
static void joined(cut_sheet *c, attachments *a, const int32_t *name, displacements base, displacements u)
{
    displacements own;
    CHECK_OK(attached_solve(ctx, a, 1, (const double(*)[NODE_UNKNOWNS])c->rest_load,
                            (const double(*)[NODE_UNKNOWNS])base, true, u));
    for (int b = 0; b < BRIDGES; b++) {
        if (name[b] < 0) continue;
        own_displacements(a, name[b], 0, (const double(*)[NODE_UNKNOWNS])u, own);
        for (int32_t i = 0; i < c->bridge[b].own_count; i++)
            memcpy(u[c->node[b][c->bridge[b].end_count + i]], own[i], sizeof own[i]);
    }
}

TEST(bridges_act_as_if_they_were_in_the_mesh)
{
    static displacements base, u, wanted;
    for (uint64_t seed = 1; seed <= 6; seed++) {
        bool bending_only = seed % 3 == 0;
        cut_sheet *c = cut(seed, seed % 3 == 1 ? 12 : 0);
        structure s;
        attachments a;
        int32_t name[BRIDGES] = {-1, -1, -1, -1};
        unsigned without = 15;
        refactored(c, 15, bending_only, base);
        leave_out(c, 15);
        CHECK_OK(structure_create(ctx, &c->rest, &plastic, c->held, bending_only, &s));
        attachments_begin(&a, &s, 1);
        static const int rounds[][BRIDGES] = {
            {0, 1, -1}, {2, -1}, {3, 1, -1}, {1, 0, -1}}; // join or take back
        for (int round = 0; round < 4; round++) {
            for (const int *b = rounds[round]; *b >= 0; b++) {
                if (name[*b] >= 0) {
                    withdraw(&a, name[*b]);
                    name[*b] = -1;
                } else {
                    CHECK_OK(attach(ctx, &a, &c->bridge[*b], &name[*b]));
                }
                without ^= 1u << *b;
            }
            joined(c, &a, name, base, u);
            CHECK(a.residual < 1e-9);
            refactored(c, without, bending_only, wanted);
            leave_out(c, 15);
            CHECK(difference(c, without, wanted, u) < 1e-9);
        }
        attachments_free(ctx, &a);
        structure_free(ctx, &s);
        free_cut(c);
    }
}

TEST(worth_is_what_attaching_changes)
{
    static displacements base, u, unit, adjoint, now, then;
    for (uint64_t seed = 1; seed <= 4; seed++) {
        bool bending_only = seed % 2 == 0;
        cut_sheet *c = cut(seed, 0);
        structure s;
        attachments a;
        int32_t name[BRIDGES];
        double change[3];
        leave_out(c, 15);
        CHECK_OK(structure_create(ctx, &c->rest, &plastic, c->held, bending_only, &s));
        CHECK_OK(structure_solve(ctx, &s, 1, (const double(*)[NODE_UNKNOWNS])c->rest_load, base));
        attachments_begin(&a, &s, 1);
        memset(unit, 0, sizeof unit);
        unit[200][2] = 1;
        unit[90][3] = -2;
        for (int round = 0; round < 2; round++) { // without and with a bridge that is there already
            if (round == 1) CHECK_OK(attach(ctx, &a, &c->bridge[3], &name[3]));
            CHECK_OK(structure_solve(ctx, &s, 1, (const double(*)[NODE_UNKNOWNS])unit, u));
            CHECK_OK(attached_solve(ctx, &a, 1, (const double(*)[NODE_UNKNOWNS])unit,
                                    (const double(*)[NODE_UNKNOWNS])u, false, adjoint));
            CHECK_OK(attached_solve(ctx, &a, 1, (const double(*)[NODE_UNKNOWNS])c->rest_load,
                                    (const double(*)[NODE_UNKNOWNS])base, true, now));
            CHECK_OK(bridges_worth(ctx, &a, 3, c->bridge, 0, (const double(*)[NODE_UNKNOWNS])now,
                                   (const double(*)[NODE_UNKNOWNS])adjoint, change));
            for (int b = 0; b < 3; b++) {
                CHECK_OK(attach(ctx, &a, &c->bridge[b], &name[b]));
                CHECK_OK(attached_solve(ctx, &a, 1, (const double(*)[NODE_UNKNOWNS])c->rest_load,
                                        (const double(*)[NODE_UNKNOWNS])base, true, then));
                withdraw(&a, name[b]);
                double real = then[200][2] - now[200][2] - 2 * (then[90][3] - now[90][3]);
                CHECK(fabs(real) > 1e-6);
                CHECK(fabs(real - change[b]) < 1e-8 * fabs(real) + 1e-10);
            }
        }
        attachments_free(ctx, &a);
        structure_free(ctx, &s);
        free_cut(c);
    }
}

TEST(a_bridge_that_falls_apart_is_refused)
{
    cut_sheet *c = cut(3, 0);
    structure s;
    attachments a;
    int32_t name;
    leave_out(c, 15);
    CHECK_OK(structure_create(ctx, &c->rest, &plastic, c->held, false, &s));
    attachments_begin(&a, &s, 1);
    bridge broken = c->bridge[0];
    broken.triangle_count = 1;
    CHECK_STATUS(attach(ctx, &a, &broken, &name), JALI_NO_RESULT);
    CHECK(strstr(jali_message(ctx), "bridge near"));
    CHECK_INT((int)a.count, 0);
    attachments_free(ctx, &a);
    structure_free(ctx, &s);
    free_cut(c);
}

static jali_status attach_once(jali_context *limited, void *data)
{
    cut_sheet *c = data;
    static displacements base, u;
    jali_status status;
    structure s = {0};
    attachments a = {0};
    int32_t name;
    double change;
    TRY(structure_create(limited, &c->rest, &plastic, c->held, true, &s));
    attachments_begin(&a, &s, 1);
    TRY(attach(limited, &a, &c->bridge[0], &name));
    TRY(attached_solve(limited, &a, 1, (const double(*)[NODE_UNKNOWNS])c->rest_load,
                       (const double(*)[NODE_UNKNOWNS])base, true, u));
    TRY(attach(limited, &a, &c->bridge[1], &name));
    TRY(bridges_worth(limited, &a, 1, &c->bridge[2], 0, (const double(*)[NODE_UNKNOWNS])u,
                      (const double(*)[NODE_UNKNOWNS])u, &change));
    TRY(attached_solve(limited, &a, 1, (const double(*)[NODE_UNKNOWNS])c->rest_load,
                       (const double(*)[NODE_UNKNOWNS])base, true, u));
done:
    attachments_free(limited, &a);
    structure_free(limited, &s);
    return status;
}

TEST(every_allocation_may_fail)
{
    cut_sheet *c = cut(1, 0);
    leave_out(c, 15);
    refuse_each_allocation(attach_once, c);
    free_cut(c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bridges_act_as_if_they_were_in_the_mesh),
        cmocka_unit_test(worth_is_what_attaching_changes),
        cmocka_unit_test(a_bridge_that_falls_apart_is_refused),
        cmocka_unit_test(every_allocation_may_fail),
    };
    return cmocka_run_group_tests(tests, open_context, close_context);
}
