// The solver on pierced plates, 80 x 80 x 4 mm with 400 holes: time and memory an unknown, stage by stage.
//
//     structure [nodes in thousands ...]
//
// CPU time counts: what other programs do on the machine disturbs it little.
#include "calculix.h"
#include "sheets.h"

#include "structure/attach.h"

#include <stdio.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <time.h>

enum { FACTOR, STAGES, BRIDGES = 8, PEER_NODES = 60000 };
static const char *const stage_names[STAGES] = {"factor"};

typedef struct stopwatch {
    double begin, spent[STAGES];
} stopwatch;

static double cpu_seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static double wall_seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void note(void *user, const char *stage, double fraction)
{
    stopwatch *w = user;
    for (int i = 0; i < STAGES; i++) {
        if (strcmp(stage, stage_names[i]) != 0) continue;
        if (fraction <= 0) w->begin = cpu_seconds();
        if (fraction >= 1) w->spent[i] += cpu_seconds() - w->begin;
    }
}

// Most memory of the process since the last reset, which Linux allows by writing 5 to clear_refs.
static double peak_bytes(bool reset)
{
    double kilobytes = 0;
    char line[256];
    FILE *f = fopen("/proc/self/status", "r");
    while (f && fgets(line, sizeof line, f)) (void)sscanf(line, "VmHWM: %lf", &kilobytes);
    if (f) fclose(f);
    f = reset ? fopen("/proc/self/clear_refs", "w") : NULL;
    if (f) {
        fputs("5", f);
        fclose(f);
    }
    return 1024 * kilobytes;
}

// A pierced plate with strips over some of its holes: the whole, and without the strips.
typedef struct plate {
    jali_sheet whole, rest; // the same nodes, and memory
    int32_t first[BRIDGES + 1];
    uint8_t *held;
    double (*load)[NODE_UNKNOWNS], (*u)[NODE_UNKNOWNS], (*joined)[NODE_UNKNOWNS], (*again)[NODE_UNKNOWNS];
} plate;

static jali_status make_plate(jali_context *ctx, int32_t cells, plate *p)
{
    jali_status status;
    pierced_options o = {.cells = cells,
                         .holes = 20,
                         .size_mm = 80,
                         .thickness_mm = 4,
                         .hole_mm = 1.2,
                         .bridges = BRIDGES,
                         .strip_mm = 0.6};
    *p = (plate){0};
    TRY(pierced_sheet_parts(ctx, &o, &p->whole, p->first));
    p->rest = p->whole;
    p->rest.triangle_count = p->first[0];
    int32_t nodes = p->whole.node_count;
    TRY(ALLOCATE_CLEARED(ctx, p->held, nodes));
    TRY(ALLOCATE_CLEARED(ctx, p->load, nodes));
    TRY(ALLOCATE(ctx, p->u, nodes));
    TRY(ALLOCATE(ctx, p->joined, nodes));
    TRY(ALLOCATE(ctx, p->again, nodes));
    for (int32_t i = 0; i < nodes; i++)
        if (p->whole.border[i] & JALI_BORDER_RIM) p->held[i] = HELD_ALL;
    for (int32_t t = 0; t < p->rest.triangle_count; t++) // 0.01 MPa
        for (int k = 0; k < 3; k++)
            p->load[p->rest.triangle[t][k]][2] -= 0.01 * 0.5 / 3 * (80.0 / cells) * (80.0 / cells);
done:
    return status;
}

static void drop_plate(jali_context *ctx, plate *p)
{
    release(ctx, p->held);
    release(ctx, p->load);
    release(ctx, p->u);
    release(ctx, p->joined);
    release(ctx, p->again);
    drop_sheet(ctx, &p->whole);
}

static double largest(const plate *p, double (*u)[NODE_UNKNOWNS], double (*less)[NODE_UNKNOWNS])
{
    double most = 0;
    for (int32_t t = 0; t < p->rest.triangle_count; t++)
        for (int k = 0; k < 9; k++) {
            int32_t n = p->rest.triangle[t][k / 3];
            most = fmax(most, fabs(u[n][k % 3] - (less ? less[n][k % 3] : 0)));
        }
    return most;
}

// A strip as a bridge; nodes that the rest uses as well are its ends. In the arena.
static jali_status draw_strip(jali_context *ctx, const plate *p, int32_t b, const bool *in_rest,
                              int32_t *number, bridge *drawn)
{
    jali_status status;
    int32_t count = p->first[b + 1] - p->first[b], *end, (*triangle)[3];
    double(*own)[3], *thickness;
    bridge d = {.triangle_count = count};
    TRY(ARENA(ctx, end, 3 * count));
    TRY(ARENA(ctx, triangle, count));
    TRY(ARENA(ctx, own, 3 * count));
    TRY(ARENA(ctx, thickness, 3 * count));
    const int32_t *corner = p->whole.triangle[p->first[b]];
    for (int pass = 0; pass < 2; pass++) // ends first
        for (int32_t i = 0; i < 3 * count; i++) {
            int32_t n = corner[i];
            if (in_rest[n] != (pass == 0) || number[n] >= 0) continue;
            number[n] = d.end_count + d.own_count;
            if (pass == 0) {
                end[d.end_count++] = n;
                continue;
            }
            memcpy(own[d.own_count], p->whole.node[n], sizeof *own);
            thickness[d.own_count++] = p->whole.thickness_mm[n];
        }
    for (int32_t i = 0; i < 3 * count; i++) triangle[i / 3][i % 3] = number[corner[i]];
    d.end = end;
    d.own = (const double(*)[3])own;
    d.thickness_mm = thickness;
    d.triangle = (const int32_t(*)[3])triangle;
    *drawn = d;
done:
    return status;
}

// A round of bridges by the correction, and by a factor of the joined sheet.
static jali_status measure_round(jali_context *ctx, structure *s, plate *p)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    attachments a;
    structure joined = {0};
    bool *in_rest;
    int32_t *number, nodes = p->whole.node_count, name;
    bridge drawn[BRIDGES];
    double change[BRIDGES];
    attachments_begin(&a, s, 1);
    TRY(ARENA(ctx, in_rest, nodes));
    TRY(ARENA(ctx, number, nodes));
    memset(in_rest, 0, (size_t)nodes * sizeof *in_rest);
    for (int32_t i = 0; i < nodes; i++) number[i] = -1;
    for (int32_t i = 0; i < 3 * p->rest.triangle_count; i++) in_rest[p->rest.triangle[i / 3][i % 3]] = true;
    for (int32_t b = 0; b < BRIDGES; b++) TRY(draw_strip(ctx, p, b, in_rest, number, &drawn[b]));
    double begin = cpu_seconds(), wall = wall_seconds();
    TRY(bridges_worth(ctx, &a, BRIDGES, drawn, 0, (const double(*)[NODE_UNKNOWNS])p->u,
                      (const double(*)[NODE_UNKNOWNS])p->u, change));
    double judged = cpu_seconds() - begin;
    begin = cpu_seconds(), wall = wall_seconds();
    for (int32_t b = 0; b < BRIDGES; b++) TRY(attach(ctx, &a, &drawn[b], &name));
    TRY(attached_solve(ctx, &a, 1, (const double(*)[NODE_UNKNOWNS])p->load,
                       (const double(*)[NODE_UNKNOWNS])p->u, true, p->joined));
    double round = cpu_seconds() - begin, round_wall = wall_seconds() - wall;
    begin = cpu_seconds(), wall = wall_seconds();
    TRY(structure_create(ctx, &p->whole, &s->made_of, p->held, s->bending_only, &joined));
    TRY(structure_solve(ctx, &joined, 1, (const double(*)[NODE_UNKNOWNS])p->load, p->again));
    double refactor = cpu_seconds() - begin, refactor_wall = wall_seconds() - wall;
    printf("          %d bridges, rank %d: %.2f s (wall %.2f), a factor of the joined sheet %.2f (%.2f): "
           "ratio 1/%.1f, "
           "apart by %.0e; a candidate is judged in %.0f ms\n",
           BRIDGES, a.rank, round, round_wall, refactor, refactor_wall, refactor / round,
           largest(p, p->joined, p->again) / largest(p, p->again, NULL), 1e3 * judged / BRIDGES);
done:
    attachments_free(ctx, &a);
    structure_free(ctx, &joined);
    arena_rewind(ctx, mark);
    return status;
}

static jali_status measure(jali_context *ctx, stopwatch *w, int32_t cells, bool bending_only)
{
    jali_status status;
    facet_material pla = {.e_mpa = 2300, .nu = 0.35};
    plate p;
    structure s = {0};
    double before = peak_bytes(true);
    before = peak_bytes(true);
    TRY(make_plate(ctx, cells, &p));
    *w = (stopwatch){0};
    double start = cpu_seconds(), wall = wall_seconds();
    TRY(structure_create(ctx, &p.rest, &pla, p.held, bending_only, &s));
    double made = cpu_seconds();
    TRY(structure_solve(ctx, &s, 1, (const double(*)[NODE_UNKNOWNS])p.load, p.u));
    double end = cpu_seconds(), unknowns = unknowns_of(&s.k), us = 1e6 / unknowns;
    wall = wall_seconds() - wall;
    solver_figures cost = solver_cost(s.solver);
    double assembled = made - start - w->spent[FACTOR]; // and ordered
    printf("%7d %d %9.0f  %6.2f %6.2f %6.2f  %6.2f %6.2f  %5.2f  %5.2f %6.2f %8.0e %.6f\n", p.rest.node_count,
           bending_only ? 3 : 6, unknowns, us * assembled, us * w->spent[FACTOR], us * (end - made),
           us * (end - start), us * wall, (peak_bytes(false) - before) / unknowns / 1e3,
           8 * (double)cost.entries / unknowns / 1e3, cost.flops / w->spent[FACTOR] / 1e9, s.residual,
           largest(&p, p.u, NULL));
    TRY(measure_round(ctx, &s, &p));
    if (!bending_only && p.rest.node_count < PEER_NODES && calculix_there())
        for (int six = 0; six < 2; six++) {
            calculix_case peer = {.sheet = &p.rest,
                                  .kind = six ? CALCULIX_S6 : CALCULIX_S3,
                                  .e_mpa = pla.e_mpa,
                                  .nu = pla.nu,
                                  .pressure_mpa = 0.01,
                                  .held = JALI_BORDER_RIM};
            calculix_answer c = calculix_run(&peer);
            printf("          CalculiX S%d: %.1f s, %.1f times as long; %.6f mm\n", six ? 6 : 3, c.seconds,
                   c.seconds / (end - start), c.displacement_mm);
            calculix_free(&c);
        }
    fflush(stdout);
done:
    structure_free(ctx, &s);
    drop_plate(ctx, &p);
    return status;
}

int main(int argc, char **argv)
{
    static const double usual[] = {29, 53, 202, 496};
    stopwatch watch;
    jali_context *ctx;
    jali_context_options opt = jali_context_defaults();
    opt.progress = note;
    opt.user = &watch;
    if (jali_context_create(&opt, &ctx) != JALI_OK) return 1;
    printf("                       us of CPU an unknown                  wall   kB an unknown\n"
           "  nodes f  unknowns   made factor  solve     all    all   peak factor Gflop/s residual  "
           "most mm\n");
    jali_status status = JALI_OK;
    for (int i = 0; i < (argc > 1 ? argc - 1 : 4) && status == JALI_OK; i++) {
        double thousands = argc > 1 ? atof(argv[i + 1]) : usual[i];
        int32_t cells = (int32_t)(sqrt(thousands * 1e3 / 0.835));
        for (int three = 0; three < 2 && status == JALI_OK; three++)
            status = measure(ctx, &watch, cells, three);
    }
    if (status != JALI_OK) fprintf(stderr, "structure: %s\n", jali_message(ctx));
    jali_context_free(ctx);
    return status != JALI_OK;
}
