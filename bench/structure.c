// The solver on pierced plates, 80 x 80 x 4 mm with 400 holes: time and memory an unknown, stage by stage.
//
//     structure [nodes in thousands ...]
//
// CPU time counts: what other programs do on the machine disturbs it little.
#include "sheets.h"

#include "analyse/assemble.h"

#include <stdio.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <time.h>
#include <unistd.h>

enum { STAGES = 3 };
static const char *const stage_names[STAGES] = {"assemble", "order", "factor"};

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

static void rim_held_under_pressure(const jali_sheet *sheet, uint8_t *held, double (*load)[NODE_UNKNOWNS])
{
    for (int32_t i = 0; i < sheet->node_count; i++) {
        held[i] = sheet->border[i] & JALI_BORDER_RIM ? HELD_ALL : 0;
        load[i][2] = -1e-3;
    }
}

static jali_status measure(jali_context *ctx, stopwatch *w, int32_t cells, bool bending_only)
{
    jali_status status;
    pierced_options o = {.cells = cells, .holes = 20, .size_mm = 80, .thickness_mm = 4, .hole_mm = 1.2};
    facet_material pla = {.e_mpa = 2300, .nu = 0.35};
    jali_sheet sheet;
    structure s = {0};
    uint8_t *held = NULL;
    double(*load)[NODE_UNKNOWNS] = NULL, (*u)[NODE_UNKNOWNS] = NULL, most = 0;
    peak_bytes(true);
    double before = peak_bytes(true);
    TRY(pierced_sheet(ctx, &o, &sheet));
    TRY(ALLOCATE(ctx, held, sheet.node_count));
    TRY(ALLOCATE_CLEARED(ctx, load, sheet.node_count));
    TRY(ALLOCATE(ctx, u, sheet.node_count));
    rim_held_under_pressure(&sheet, held, load);
    *w = (stopwatch){0};
    double start = cpu_seconds(), clock = wall_seconds();
    TRY(structure_create(ctx, &sheet, &pla, held, bending_only, &s));
    double made = cpu_seconds();
    TRY(structure_solve(ctx, &s, 1, (const double(*)[NODE_UNKNOWNS])load, u));
    double end = cpu_seconds(), unknowns = unknowns_of(&s.k), us = 1e6 / unknowns;
    clock = wall_seconds() - clock;
    for (int32_t i = 0; i < sheet.node_count; i++) most = fmax(most, fabs(u[i][2]));
    solver_figures cost = solver_cost(s.solver);
    printf("%7d %d %9.0f  %6.2f %6.2f %6.2f %6.2f  %6.2f %6.2f  %5.2f  %5.2f %6.2f %8.0e %.6f\n",
           sheet.node_count, bending_only ? 3 : 6, unknowns, us * w->spent[0], us * w->spent[1],
           us * w->spent[2], us * (end - made), us * (end - start), us * clock,
           (peak_bytes(false) - before) / unknowns / 1e3, 8 * (double)cost.entries / unknowns / 1e3,
           cost.flops / w->spent[2] / 1e9, s.residual, most);
    fflush(stdout);
done:
    structure_free(ctx, &s);
    release(ctx, held);
    release(ctx, load);
    release(ctx, u);
    drop_sheet(ctx, &sheet);
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
           "  nodes f  unknowns  assem.  order factor  solve     all    all   peak factor Gflop/s residual  "
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
